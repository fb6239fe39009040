#include "statics/stiffness_solver.hpp"

#include "base/exact_sum.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gcpdda::statics {

double exact_product(const Communicator &communicator, const BlockSystem &system, const Field &a,
                     const Field &b) {
  ExactSum sum;
  const std::size_t width = a.width();
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    const double *const x = a.of(row);
    const double *const y = b.of(row);
    double product = x[0] * y[0];
    for (std::size_t i = 1; i < width; ++i) {
      product += x[i] * y[i];
    }
    sum.add(product);
  }
  communicator.sum(sum.limbs());
  return sum.value();
}

void StiffnessSolver::lay(const BlockSystem &system, BlockMatrices mass, BlockMatrices bolts,
                          std::vector<BorderRows> border) {
  mass_ = std::move(mass);
  bolts_ = std::move(bolts);
  border_.take(std::move(border));
  coarse_.lay(system);
  for (Field *field : {&r_, &z_, &p_, &q_}) {
    *field = Field(system.num_rows(), mass_.width());
  }
}

void StiffnessSolver::set(const BlockSystem &system, const ContactSprings &springs, double rho,
                          bool with_coarse) {
  const std::size_t width = mass_.width();
  rho_ = rho;
  own_ = BlockMatrices(system.num_owned, width);
  BlockMatrices with_rest(with_coarse ? system.num_owned : 0, width);
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    double *const own = own_.of(row);
    const double *const mass = mass_.of(row);
    const double *const bolts = bolts_.of(row);
    for (std::size_t i = 0; i < width * width; ++i) {
      own[i] = rho * mass[i] + bolts[i];
    }
    add_own_springs(system, row, own, width);
    if (with_coarse) {
      constexpr double holds_cells = 1e-4;
      double *const rest = with_rest.of(row);
      for (std::size_t i = 0; i < width * width; ++i) {
        rest[i] = own[i] + holds_cells * mass[i];
      }
    }
  }
  if (with_coarse) {
    coarse_.factorise(system, springs.springs(), with_rest);
  }
  inverse_ = own_;
  add_diagonal(system, springs.springs(), inverse_);
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (!system.properties[row].keeps_its_velocity()) {
      invert(inverse_.of(row), num_freedoms(system, row), width);
    } else {
      std::fill_n(inverse_.of(row), width * width, 0.0);
    }
  }
}

void StiffnessSolver::precondition(const BlockSystem &system, const Field &r, Field &z) {
  const std::size_t width = mass_.width();
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    double *const to = z.of(row);
    std::fill_n(to, width, 0.0);
    add_block_product(inverse_.of(row), num_freedoms(system, row), width, r.of(row), to);
  }
  coarse_.add_correction(system, r, z);
}

void StiffnessSolver::multiply(const BlockSystem &system, const ContactSprings &springs, Field &p, Field &y) {
  border_.copy(p);
  const std::size_t width = mass_.width();
  std::fill(y.values().begin(), y.values().end(), 0.0);
  springs.add_product(system, p, y);
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (system.properties[row].keeps_its_velocity()) {
      std::fill_n(y.of(row), width, 0.0);
    } else {
      add_block_product(own_.of(row), num_freedoms(system, row), width, p.of(row), y.of(row));
    }
  }
}

std::int64_t StiffnessSolver::solve(const BlockSystem &system, const ContactSprings &springs,
                                    const Field &force, Field &solution) {
  const std::size_t width = mass_.width();
  const std::size_t end = system.num_owned * width;
  std::fill(solution.values().begin(), solution.values().end(), 0.0);
  std::copy_n(force.values().begin(), end, r_.values().begin());
  precondition(system, r_, z_);
  std::copy_n(z_.values().begin(), end, p_.values().begin());
  double size = exact_product(communicator_, system, r_, z_);
  const double enough = accuracy * accuracy * size;
  std::int64_t products = 0;
  while (size > enough && products < most_products) {
    multiply(system, springs, p_, q_);
    ++products;
    const double curvature = exact_product(communicator_, system, p_, q_);
    if (!(curvature > 0.0)) {
      break;
    }
    const double step = size / curvature;
    double *const x = solution.values().data();
    double *const r = r_.values().data();
    double *const p = p_.values().data();
    const double *const q = q_.values().data();
    for (std::size_t i = 0; i < end; ++i) {
      x[i] += step * p[i];
      r[i] -= step * q[i];
    }
    precondition(system, r_, z_);
    const double before = std::exchange(size, exact_product(communicator_, system, r_, z_));
    const double share = size / before;
    const double *const z = z_.values().data();
    for (std::size_t i = 0; i < end; ++i) {
      p[i] = z[i] + share * p[i];
    }
  }
  return products;
}

} // namespace gcpdda::statics
