#include "statics/stiffness_solver.hpp"

#include "base/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gcpdda::statics {

namespace {

template <std::size_t width> ExactSum products(std::span<const RowRun> rows, const Field &a, const Field &b) {
  ExactSum sum;
  const double *const x = a.values().data();
  const double *const y = b.values().data();
  for_rows(rows, [&](std::size_t row) {
    double product = x[row * width] * y[row * width];
    for (std::size_t i = 1; i < width; ++i) {
      product += x[row * width + i] * y[row * width + i];
    }
    sum.add(product);
  });
  return sum;
}

} // namespace

double exact_product(const Communicator &communicator, std::span<const RowRun> rows, const Field &a,
                     const Field &b) {
  ExactSum sum = a.width() == 3 ? products<3>(rows, a, b) : products<6>(rows, a, b);
  communicator.sum(sum.limbs());
  return sum.value();
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
    const double curvature = exact_product(communicator_, moving_, p_, q_);
    if (!(curvature > 0.0)) {
      break;
    }
    const double step = size / curvature;
    for_places(moving_, width, [&](std::size_t i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    });
    precondition(system, r_, z_);
    const double before = std::exchange(size, exact_product(communicator_, moving_, r_, z_));
    const double share = size / before;
    for_places(moving_, width, [&](std::size_t i) { p[i] = z[i] + share * p[i]; });
  }
  return products;
}

} // namespace gcpdda::statics
