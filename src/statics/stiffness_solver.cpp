#include "statics/stiffness_solver.hpp"

#include "base/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace gcpdda::statics {

namespace {

template <std::size_t width, class Visit>
void for_row_products(std::span<const RowRun> rows, const Field &a, const Field &b, Visit &&visit) {
  const double *const x = a.values().data();
  const double *const y = b.values().data();
  for_rows(rows, [&](std::size_t row) {
    double product = x[row * width] * y[row * width];
    for (std::size_t i = 1; i < width; ++i) {
      product += x[row * width + i] * y[row * width + i];
    }
    visit(product);
  });
}

template <std::size_t width>
std::uint64_t sum_in_units(std::span<const RowRun> rows, const Field &a, const Field &b, double per_unit) {
  constexpr double most = 0x1p62;
  std::uint64_t sum = 0; // that parts of a sum run over does not matter, the whole is small
  for_row_products<width>(rows, a, b, [&](double product) {
    sum += static_cast<std::uint64_t>(std::llrint(std::clamp(product * per_unit, -most, most)));
  });
  return sum;
}

} // namespace

double exact_product(const Communicator &communicator, std::span<const RowRun> rows, const Field &a,
                     const Field &b) {
  ExactSum sum;
  const auto add = [&](double product) { sum.add(product); };
  a.width() == 3 ? for_row_products<3>(rows, a, b, add) : for_row_products<6>(rows, a, b, add);
  communicator.sum(sum.limbs());
  return sum.value();
}

double product_near(const Communicator &communicator, std::span<const RowRun> rows, const Field &a,
                    const Field &b, double size) {
  const int exponent = std::ilogb(size) - 44;
  const double per_unit = std::ldexp(1.0, -exponent);
  const std::uint64_t mine =
      a.width() == 3 ? sum_in_units<3>(rows, a, b, per_unit) : sum_in_units<6>(rows, a, b, per_unit);
  auto sum = static_cast<std::int64_t>(mine);
  communicator.sum(std::span(&sum, 1));
  return std::ldexp(static_cast<double>(sum), exponent);
}

void StiffnessSolver::lay(const BlockSystem &system, std::vector<RowRun> moving, BlockMatrices mass,
                          BlockMatrices bolts, std::vector<BorderRows> border) {
  moving_ = std::move(moving);
  mass_ = std::move(mass);
  bolts_ = std::move(bolts);
  border_.take(std::move(border));
  coarse_.lay(system);
  own_ = BlockMatrices(system.num_owned, mass_.width());
  inverse_ = own_;
  for (Field *field : {&r_, &z_, &p_, &q_}) {
    *field = Field(system.num_rows(), mass_.width());
  }
}

void StiffnessSolver::set(const BlockSystem &system, const ContactSprings &springs, double rho,
                          bool with_coarse) {
  const std::size_t width = mass_.width();
  for_rows(moving_, [&](std::size_t row) {
    double *const own = own_.of(row);
    const double *const mass = mass_.of(row);
    const double *const bolts = bolts_.of(row);
    for (std::size_t i = 0; i < width * width; ++i) {
      own[i] = rho * mass[i] + bolts[i];
    }
    add_own_springs(system, row, own, width);
  });
  if (with_coarse) {
    constexpr double holds_cells = 1e-4;
    for_rows(moving_, [&](std::size_t row) { // the places of B
      for (std::size_t i = 0; i < width * width; ++i) {
        inverse_.of(row)[i] = own_.of(row)[i] + holds_cells * mass_.of(row)[i];
      }
    });
    std::vector<ContactSpring> all;
    springs.for_lists(
        [&](std::span<const ContactSpring> list) { all.insert(all.end(), list.begin(), list.end()); });
    coarse_.factorise(system, all, inverse_);
  }
  for_rows(moving_, [&](std::size_t row) { std::copy_n(own_.of(row), width * width, inverse_.of(row)); });
  springs.for_lists([&](std::span<const ContactSpring> list) { add_diagonal(system, list, inverse_); });
  for_rows(moving_, [&](std::size_t row) { invert(inverse_.of(row), num_freedoms(system, row), width); });
}

void StiffnessSolver::precondition(const BlockSystem &system, const Field &r, Field &z) {
  const std::size_t width = mass_.width();
  for_rows(moving_, [&](std::size_t row) {
    double *const to = z.of(row);
    std::fill_n(to, width, 0.0);
    add_block_product(inverse_.of(row), num_freedoms(system, row), width, r.of(row), to);
  });
  coarse_.add_correction(system, r, z);
}

void StiffnessSolver::multiply(const BlockSystem &system, const ContactSprings &springs, Field &p, Field &y) {
  border_.copy(p);
  const std::size_t width = mass_.width();
  for_places(moving_, width, [&](std::size_t i) { y.values()[i] = 0.0; });
  springs.add_product(system, p, y);
  for_rows(moving_, [&](std::size_t row) {
    add_block_product(own_.of(row), num_freedoms(system, row), width, p.of(row), y.of(row));
  });
}

std::int64_t StiffnessSolver::solve(const BlockSystem &system, const ContactSprings &springs,
                                    const Field &force, Field &solution) {
  const std::size_t width = mass_.width();
  double *const x = solution.values().data();
  double *const r = r_.values().data();
  double *const p = p_.values().data();
  const double *const q = q_.values().data();
  const double *const z = z_.values().data();
  for_places(moving_, width, [&](std::size_t i) {
    x[i] = 0.0;
    r[i] = force.values()[i];
  });
  precondition(system, r_, z_);
  for_places(moving_, width, [&](std::size_t i) { p[i] = z[i]; });
  double size = exact_product(communicator_, moving_, r_, z_);
  const double enough = accuracy * accuracy * size;
  std::int64_t products = 0;
  while (size > enough && products < most_products) {
    multiply(system, springs, p_, q_);
    ++products;
    const double curvature = product_near(communicator_, moving_, p_, q_, size);
    if (!(curvature > 0.0)) {
      break;
    }
    const double step = size / curvature;
    for_places(moving_, width, [&](std::size_t i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    });
    precondition(system, r_, z_);
    const double before = std::exchange(size, product_near(communicator_, moving_, r_, z_, size));
    const double share = size / before;
    for_places(moving_, width, [&](std::size_t i) { p[i] = z[i] + share * p[i]; });
  }
  return products;
}

} // namespace gcpdda::statics
