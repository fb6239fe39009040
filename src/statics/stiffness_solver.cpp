#include "statics/stiffness_solver.hpp"

#include "base/exact_sum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace gcpdda::statics {

namespace {

/// Fields whose rows are three wide are those of rigid blocks.
template <std::size_t width> bool deforms(const BlockSystem &system, std::size_t row) {
  if constexpr (width == 3) {
    return false;
  } else {
    return system.is_deformable(row);
  }
}

template <std::size_t width> double row_product(const double *a, const double *b) {
  double product = a[0] * b[0];
  for (std::size_t i = 1; i < width; ++i) {
    product += a[i] * b[i];
  }
  return product;
}

struct NoSum {
  void add(double) {}
};

} // namespace

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

void StiffnessSolver::choose(const BlockSystem &system, std::vector<RowRun> moving,
                             std::span<const std::uint8_t> moves) {
  moving_ = std::move(moving);
  coarse_.choose(system, moves);
  std::fill(p_.values().begin(), p_.values().end(), 0.0);
}

void StiffnessSolver::set(const BlockSystem &system, const ContactSprings &springs, double rho,
                          bool with_coarse) {
  const std::size_t width = mass_.width();
  rho_ = rho;
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

void StiffnessSolver::damp_strains(const BlockSystem &system, const ContactSprings &springs, double gamma,
                                   double momentum, Field &force) {
  const std::size_t width = mass_.width();
  for_rows(moving_, [&](std::size_t row) { // p of rows that rest is zero
    std::copy_n(system.pseudo[row].velocity.data(), width, p_.of(row));
  });
  border_.copy(p_);
  for_places(moving_, width, [&](std::size_t i) { q_.values()[i] = 0.0; });
  take_lean(springs, SlipSprings::none_tangential, lean_);
  add_product(system, lean_, p_, q_);
  ExactSum strained;
  for_rows(moving_, [&](std::size_t row) {
    const std::size_t freedoms = num_freedoms(system, row);
    std::array<double, 6> of_mass{};
    add_block_product(own_.of(row), freedoms, width, p_.of(row), q_.of(row));
    add_block_product(mass_.of(row), freedoms, width, p_.of(row), of_mass.data());
    double product = 0.0;
    for (std::size_t i = 0; i < freedoms; ++i) {
      q_.of(row)[i] -= rho_ * of_mass[i];
      product += q_.of(row)[i] * p_.of(row)[i];
    }
    strained.add(product);
  });
  communicator_.sum(strained.limbs());
  const double slides = std::clamp(1.0 - strained.value() / momentum, 0.0, 1.0);
  for_rows(moving_, [&](std::size_t row) {
    for (std::size_t i = 0; i < num_freedoms(system, row); ++i) {
      force.of(row)[i] -= gamma * slides * q_.of(row)[i];
    }
  });
}

template <std::size_t width, class Sum>
void StiffnessSolver::multiply_by(const BlockSystem &system, Field &p, Field &y, Sum &sum) {
  border_.copy(p);
  for_places(moving_, width, [&](std::size_t i) { y.values()[i] = 0.0; });
  add_product(system, lean_, p, y);
  for_rows(moving_, [&](std::size_t row) {
    const std::size_t freedoms = deforms<width>(system, row) ? 6 : 3;
    add_block_product(own_.of(row), freedoms, width, p.of(row), y.of(row));
    sum.add(row_product<width>(p.of(row), y.of(row)));
  });
}

void StiffnessSolver::multiply(const BlockSystem &system, const ContactSprings &springs, Field &p, Field &y) {
  NoSum none;
  take_lean(springs, SlipSprings::all, lean_);
  mass_.width() == 3 ? multiply_by<3>(system, p, y, none) : multiply_by<6>(system, p, y, none);
}

template <std::size_t width>
void StiffnessSolver::begin_preconditioning(const BlockSystem &system, std::size_t row) {
  const bool is_deformable = deforms<width>(system, row);
  const double *const r = r_.values().data() + width * row;
  double *const z = z_.values().data() + width * row;
  std::fill_n(z, width, 0.0);
  add_block_product(inverse_.of(row), is_deformable ? 6 : 3, width, r, z);
  coarse_.add_forces(row, is_deformable, r);
}

template <std::size_t width, class Sum>
void StiffnessSolver::precondition(const BlockSystem &system, Sum &sum) {
  coarse_.solve();
  for_rows(moving_, [&](std::size_t row) {
    double *const z = z_.values().data() + width * row;
    coarse_.add_motion(row, deforms<width>(system, row), z);
    sum.add(row_product<width>(r_.values().data() + width * row, z));
  });
}

template <std::size_t width>
std::int64_t StiffnessSolver::solve_by(const BlockSystem &system, const Field &force, Field &solution) {
  double *const x = solution.values().data();
  double *const r = r_.values().data();
  double *const p = p_.values().data();
  const double *const q = q_.values().data();
  const double *const z = z_.values().data();
  coarse_.set_unit(system, moving_, force);
  coarse_.clear_forces();
  for_rows(moving_, [&](std::size_t row) {
    for (std::size_t i = width * row; i < width * (row + 1); ++i) {
      x[i] = 0.0;
      r[i] = force.values()[i];
    }
    begin_preconditioning<width>(system, row);
  });
  ExactSum first;
  precondition<width>(system, first);
  communicator_.sum(first.limbs());
  double size = first.value();
  for_places(moving_, width, [&](std::size_t i) { p[i] = z[i]; });
  const double enough = accuracy * accuracy * size;
  std::int64_t products = 0;
  while (size > enough && products < most_products) {
    SumInUnits along_p(size);
    multiply_by<width>(system, p_, q_, along_p);
    ++products;
    const double curvature = along_p.over(communicator_);
    if (!(curvature > 0.0)) {
      break;
    }
    const double step = size / curvature;
    coarse_.clear_forces();
    for_rows(moving_, [&](std::size_t row) {
      for (std::size_t i = width * row; i < width * (row + 1); ++i) {
        x[i] += step * p[i];
        r[i] -= step * q[i];
      }
      begin_preconditioning<width>(system, row);
    });
    SumInUnits along_z(size);
    precondition<width>(system, along_z);
    const double before = std::exchange(size, along_z.over(communicator_));
    const double share = size / before;
    for_places(moving_, width, [&](std::size_t i) { p[i] = z[i] + share * p[i]; });
  }
  return products;
}

std::int64_t StiffnessSolver::solve(const BlockSystem &system, const ContactSprings &springs,
                                    const Field &force, Field &solution) {
  take_lean(springs, SlipSprings::all, lean_);
  return mass_.width() == 3 ? solve_by<3>(system, force, solution) : solve_by<6>(system, force, solution);
}

} // namespace gcpdda::statics
