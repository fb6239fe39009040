#include "statics/stiffness_solver.hpp"

#include "base/exact_sum.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace gcpdda::statics {

namespace {

template <int places> using LeanRow = Eigen::Matrix<float, places, 1>;
template <int places> using LeanMatrix = Eigen::Matrix<float, places, places == 4 ? 3 : 6>;

template <int places> Eigen::Map<LeanRow<places>> row_of(LeanField &field, std::size_t row) {
  return Eigen::Map<LeanRow<places>>(field.of(row));
}

/// matrix p of a row.
template <int places>
LeanRow<places> product_of(const LeanField &matrices, std::size_t row, const LeanRow<places> &p) {
  const Eigen::Map<const LeanMatrix<places>> matrix(matrices.of(row));
  LeanRow<places> sum = matrix.col(0) * p[0];
  for (Eigen::Index j = 1; j < matrix.cols(); ++j) {
    sum += matrix.col(j) * p[j];
  }
  return sum;
}

/// In double precision: rows far from all that moves have products that a single one does not hold.
template <int places> double dot_product(const LeanRow<places> &a, const LeanRow<places> &b) {
  return a.template cast<double>().dot(b.template cast<double>());
}

/// Fields whose rows have four places are those of rigid blocks.
template <int places> bool deforms(const BlockSystem &system, std::size_t row) {
  if constexpr (places == 4) {
    return false;
  } else {
    return system.is_deformable(row);
  }
}

template <class From, class To> void copy_row(const From *from, std::size_t num_places, To *to) {
  std::transform(from, from + num_places, to, [](From value) { return static_cast<To>(value); });
}

void take_columns(const BlockMatrices &from, std::size_t row, LeanField &to) {
  const std::size_t width = from.width();
  for (std::size_t j = 0; j < width; ++j) { // a symmetric matrix
    copy_row(from.of(row) + j * width, width, to.of(row) + j * lean_width(width));
  }
}

/// Of products whose rows are not added up.
template <int places> void leave(std::size_t, const LeanRow<places> &, const LeanRow<places> &) {}

} // namespace

template <class Moves> void StiffnessSolver::take_moving_ghosts(const BlockSystem &system, Moves &&moves) {
  moving_ghosts_.clear();
  for (std::size_t row = system.num_owned; row < system.first_fixed(); ++row) {
    if (moves(row)) {
      append_row(moving_ghosts_, row);
    }
  }
}

void StiffnessSolver::lay(const BlockSystem &system, std::vector<RowRun> moving, BlockMatrices mass,
                          std::vector<BorderRows> border) {
  moving_ = std::move(moving);
  take_moving_ghosts(system, [&](std::size_t row) { return !system.properties[row].keeps_its_velocity(); });
  mass_ = std::move(mass);
  border_.take(std::move(border));
  coarse_.lay(system);
  diagonal_ = BlockMatrices(system.num_owned, mass_.width());
  const std::size_t places = lean_width(mass_.width());
  for (LeanField *matrices : {&own_, &inverse_}) {
    *matrices = LeanField(system.num_owned, places * mass_.width());
  }
  for (LeanField *field : {&x_, &w_, &p_, &q_}) {
    *field = LeanField(system.num_rows(), places);
  }
}

void StiffnessSolver::choose(const BlockSystem &system, std::vector<RowRun> moving,
                             std::span<const std::uint8_t> moves) {
  moving_ = std::move(moving);
  take_moving_ghosts(system, [&](std::size_t row) { return moves[row] != 0; });
  coarse_.choose(system, moves);
  std::fill(p_.values().begin(), p_.values().end(), 0.0F);
}

void StiffnessSolver::set(const BlockSystem &system, const ContactSprings &springs, double rho,
                          bool with_coarse) {
  const std::size_t width = mass_.width();
  rho_ = rho;
  for_rows(moving_, [&](std::size_t row) {
    double *const own = diagonal_.of(row);
    const double *const mass = mass_.of(row);
    for (std::size_t i = 0; i < width * width; ++i) {
      own[i] = rho * mass[i];
    }
    add_own_springs(system, row, own, width);
    take_columns(diagonal_, row, own_);
  });
  if (with_coarse) {
    coarse_.factorise(system, springs, diagonal_, mass_);
  }
  springs.for_lists([&](std::span<const ContactSpring> list) { add_diagonal(system, list, diagonal_); });
  for_rows(moving_, [&](std::size_t row) {
    invert(diagonal_.of(row), num_freedoms(system, row), width);
    take_columns(diagonal_, row, inverse_);
  });
}

void StiffnessSolver::damp_strains(const BlockSystem &system, const ContactSprings &springs, double gamma,
                                   double momentum, Field &force) {
  const std::size_t width = mass_.width();
  for_rows(moving_, [&](std::size_t row) { // p of rows that rest is zero
    copy_row(system.pseudo[row].velocity.data(), width, p_.of(row));
  });
  border_.copy(p_);
  springs_.take(system, springs, SlipSprings::none_tangential, width);
  width == 3 ? multiply_by<4>(p_, q_, leave<4>) : multiply_by<8>(p_, q_, leave<8>);
  ExactSum strained;
  for_rows(moving_, [&](std::size_t row) {
    const double *const v = system.pseudo[row].velocity.data();
    std::array<double, 6> of_mass{};
    add_block_product(mass_.of(row), num_freedoms(system, row), width, v, of_mass.data());
    double product = 0.0;
    for (std::size_t i = 0; i < width; ++i) {
      q_.of(row)[i] -= static_cast<float>(rho_ * of_mass[i]);
      product += v[i] * static_cast<double>(q_.of(row)[i]);
    }
    strained.add(product);
  });
  communicator_.sum(strained.limbs());
  const double slides = std::clamp(1.0 - strained.value() / momentum, 0.0, 1.0);
  for_rows(moving_, [&](std::size_t row) {
    for (std::size_t i = 0; i < width; ++i) {
      force.of(row)[i] -= gamma * slides * static_cast<double>(q_.of(row)[i]);
    }
  });
}

template <int places, class Visit>
void StiffnessSolver::multiply_by(LeanField &p, LeanField &y, Visit &&visit) {
  for_places(moving_, places, [&](std::size_t i) { y.values()[i] = 0.0F; });
  springs_.add(p, y);
  for_rows(moving_, [&](std::size_t row) {
    const LeanRow<places> of_row = row_of<places>(p, row);
    const LeanRow<places> product = row_of<places>(y, row) + product_of<places>(own_, row, of_row);
    row_of<places>(y, row) = product;
    visit(row, of_row, product);
  });
}

void StiffnessSolver::multiply(const BlockSystem &system, const ContactSprings &springs, LeanField &p,
                               LeanField &y) {
  border_.copy(p);
  springs_.take(system, springs, SlipSprings::all, mass_.width());
  mass_.width() == 3 ? multiply_by<4>(p, y, leave<4>) : multiply_by<8>(p, y, leave<8>);
}

template <int places>
double StiffnessSolver::begin(const BlockSystem &system, const Field &force, double scale) {
  const std::size_t width = mass_.width();
  coarse_.clear_forces();
  ExactSum sum;
  for_rows(moving_, [&](std::size_t row) {
    LeanRow<places> r = LeanRow<places>::Zero();
    for (std::size_t i = 0; i < width; ++i) {
      x_.of(row)[i] = 0.0F;
      r[static_cast<Eigen::Index>(i)] = static_cast<float>(scale * force.of(row)[i]);
    }
    const LeanRow<places> w = product_of<places>(inverse_, row, r);
    row_of<places>(w_, row) = w;
    coarse_.add_forces(row, deforms<places>(system, row), r.data());
    sum.add(dot_product<places>(r, w));
  });
  border_.start(w_);
  coarse_.sum_forces(sum.limbs());
  border_.finish(w_);
  return sum.value();
}

template <int places> void StiffnessSolver::find_first_p(const BlockSystem &system) {
  const auto find = [&](std::size_t row) {
    row_of<places>(p_, row) = row_of<places>(w_, row);
    coarse_.add_motion(row, deforms<places>(system, row), p_.of(row));
  };
  for_rows(moving_, find);
  for_rows(moving_ghosts_, find);
}

template <int places>
StiffnessSolver::AlongQ StiffnessSolver::find_q_and_u(const BlockSystem &system, double size) {
  SumInUnits along_p(size);
  SumInUnits along_w(size);
  SumInUnits along_u(size);
  coarse_.clear_forces();
  multiply_by<places>(p_, q_, [&](std::size_t row, const LeanRow<places> &p, const LeanRow<places> &q) {
    const LeanRow<places> u = product_of<places>(inverse_, row, q);
    along_p.add(dot_product<places>(p, q));
    along_w.add(dot_product<places>(row_of<places>(w_, row), q));
    along_u.add(dot_product<places>(u, q));
    coarse_.add_forces(row, deforms<places>(system, row), q.data());
    row_of<places>(q_, row) = u;
  });
  std::array<std::int64_t, 3> units{along_p.units(), along_w.units(), along_u.units()};
  border_.start(q_);
  coarse_.sum_forces(units);
  border_.finish(q_);
  return {along_p.value(units[0]), along_w.value(units[1]), along_u.value(units[2])};
}

template <int places>
void StiffnessSolver::advance(const BlockSystem &system, float step, float share, bool goes_on) {
  const auto find_next_p = [&](std::size_t row, const LeanRow<places> &p) {
    const LeanRow<places> w = row_of<places>(w_, row) - step * row_of<places>(q_, row);
    row_of<places>(w_, row) = w;
    row_of<places>(p_, row) = w + share * p;
    coarse_.add_motion(row, deforms<places>(system, row), p_.of(row));
  };
  for_rows(moving_, [&](std::size_t row) {
    const LeanRow<places> p = row_of<places>(p_, row);
    row_of<places>(x_, row) += step * p;
    if (goes_on) {
      find_next_p(row, p);
    }
  });
  if (goes_on) {
    for_rows(moving_ghosts_, [&](std::size_t row) { find_next_p(row, row_of<places>(p_, row)); });
  }
}

template <int places>
std::int64_t StiffnessSolver::solve_by(const BlockSystem &system, const Field &force, Field &solution) {
  const double largest = coarse_.largest(system, moving_, force);
  const double scale = largest > 0.0 ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
  double in_rows = begin<places>(system, force, scale); // r^T w
  double size = in_rows + coarse_.begin();              // r^T z
  find_first_p<places>(system);
  const double enough = accuracy * accuracy * size;
  std::int64_t products = 0;
  while (size > enough && products < most_products) {
    const AlongQ q = find_q_and_u<places>(system, size);
    ++products;
    if (!(q.p > 0.0)) {
      break;
    }
    const auto step = static_cast<float>(size / q.p);
    const double exact_step = step;
    in_rows += exact_step * (exact_step * q.u - 2.0 * q.w);
    const double before = std::exchange(size, in_rows + coarse_.subtract(exact_step));
    advance<places>(system, step, static_cast<float>(size / before), size > enough);
  }
  for_rows(moving_, [&](std::size_t row) {
    for (std::size_t i = 0; i < mass_.width(); ++i) {
      solution.of(row)[i] = static_cast<double>(x_.of(row)[i]) / scale;
    }
  });
  return products;
}

std::int64_t StiffnessSolver::solve(const BlockSystem &system, const ContactSprings &springs,
                                    const Field &force, Field &solution) {
  springs_.take(system, springs, SlipSprings::all, mass_.width());
  return mass_.width() == 3 ? solve_by<4>(system, force, solution) : solve_by<8>(system, force, solution);
}

} // namespace gcpdda::statics
