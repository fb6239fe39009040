#include "statics/coarse_grid.hpp"

#include "base/exact_sum.hpp"
#include "contact/block_sums.hpp"
#include "statics/cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda::statics {

namespace {

/// The power of two of which the largest contribution is about 2^bits.
double unit_of(double largest, int bits) {
  return largest > 0.0 ? std::ldexp(1.0, std::ilogb(largest) - bits) : 1.0;
}

bool moves(const BlockSystem &system, std::size_t row) {
  return row < system.first_fixed() && !system.properties[row].keeps_its_velocity();
}

} // namespace

// The least centroid of all ranks, the mean size of a block, and how many columns there are.
bool CoarseGrid::lay_cells(const BlockSystem &system) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  std::array<double, 3> largest{none, none, none};
  auto &[minus_left, minus_low, right] = largest;
  ExactSum area;
  std::int64_t count = 0;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (moves(system, row)) {
      const Vec2 x = system.properties[row].centroid;
      minus_left = std::max(minus_left, -x.x);
      minus_low = std::max(minus_low, -x.y);
      right = std::max(right, x.x);
      area.add(system.properties[row].area);
      ++count;
    }
  }
  communicator_.max(largest);
  communicator_.sum(area.limbs());
  communicator_.sum(std::span(&count, 1));
  if (count == 0) {
    return false;
  }
  origin_ = {-minus_left, -minus_low};
  side_ = blocks_a_side * std::sqrt(area.value() / static_cast<double>(count));
  per_side_ = 1.0 / side_;
  columns_ = static_cast<std::int64_t>((right + minus_left) / side_) + 1;
  return true;
}

std::array<std::int64_t, 2> CoarseGrid::place_of(const BlockSystem &system, std::size_t row) const {
  const Vec2 x = (1.0 / side_) * (system.properties[row].centroid - origin_);
  return {static_cast<std::int64_t>(x.x), static_cast<std::int64_t>(x.y)};
}

void CoarseGrid::lay(const BlockSystem &system) {
  has_cells_ = lay_cells(system);
  std::vector<std::uint8_t> all(system.num_rows());
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    all[row] = moves(system, row) ? 1 : 0;
  }
  choose(system, all);
}

void CoarseGrid::choose(const BlockSystem &system, std::span<const std::uint8_t> moves) {
  keys_.clear();
  cell_of_.assign(system.num_rows(), -1);
  arms_.assign(system.num_rows(), {});
  forces_.clear();
  residual_.clear();
  if (!has_cells_) {
    return;
  }
  std::vector<std::int64_t> mine;
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (moves[row] != 0) {
      const auto [column, line] = place_of(system, row);
      mine.push_back(line * columns_ + column);
    }
  }
  keys_ = united(communicator_, std::move(mine));
  forces_.assign(3 * keys_.size(), 0);
  residual_.assign(3 * keys_.size(), 0.0);
  lean_motions_.assign(3 * keys_.size(), 0.0F);
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    if (moves[row] != 0) {
      const auto [column, line] = place_of(system, row);
      const auto found = std::lower_bound(keys_.begin(), keys_.end(), line * columns_ + column);
      cell_of_[row] = static_cast<std::int32_t>(found - keys_.begin());
      const Vec2 middle{static_cast<double>(column) + 0.5, static_cast<double>(line) + 0.5};
      const Vec2 arm = (1.0 / side_) * (system.properties[row].centroid - origin_) - middle;
      arms_[row] = {static_cast<float>(arm.x), static_cast<float>(arm.y)};
    }
  }
}

std::array<CoarseGrid::Three, 3> CoarseGrid::forces_on_cell(std::size_t row, Vec2 arm, Vec2 normal) const {
  const Vec2 tangent = perp(normal);
  const Vec2 from_middle = Vec2{arms_[row].x, arms_[row].y} + (1.0 / side_) * arm;
  return {{{normal.x, normal.y, cross(from_middle, normal)},
           {tangent.x, tangent.y, cross(from_middle, tangent)},
           {0.0, 0.0, -1.0 / side_}}}; // e_r of a rotation is n.(J t)
}

CoarseGrid::Square CoarseGrid::on_cell(const BlockSystem &system, std::size_t row,
                                       const BlockMatrices &matrices, const BlockMatrices &mass) const {
  constexpr double holds_cells = 1e-4;
  const std::size_t width = matrices.width();
  std::array<double, 36> held;
  for (std::size_t i = 0; i < width * width; ++i) {
    held[i] = matrices.of(row)[i] + holds_cells * mass.of(row)[i];
  }
  const bool is_deformable = system.is_deformable(row);
  const Arm arm = arms_[row];
  std::array<std::array<double, 6>, 3> motions{};
  motions[0][0] = 1.0;
  motions[1][1] = 1.0;
  motions[2][0] = -arm.y;
  motions[2][1] = arm.x;
  if (is_deformable) {
    motions[2][3] = -1.0 / side_;
    motions[2][4] = 1.0 / side_;
  } else {
    motions[2][2] = 1.0 / side_;
  }
  Square square{};
  for (std::size_t j = 0; j < 3; ++j) {
    std::array<double, 6> forces{};
    add_block_product(held.data(), num_freedoms(system, row), width, motions[j].data(), forces.data());
    const Three column = to_cell(row, is_deformable, forces.data());
    for (std::size_t i = 0; i < 3; ++i) {
      square[i][j] = column[i];
    }
  }
  return square;
}

CoarseGrid::Square CoarseGrid::product(const ContactSpring &spring, const std::array<Three, 3> &a,
                                       const std::array<Three, 3> &b, double sign) {
  const std::array<double, 3> stiffness{spring.normal_stiffness, spring.tangential, spring.bending};
  Square square{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        square[i][j] += sign * stiffness[k] * a[k][i] * b[k][j];
      }
    }
  }
  return square;
}

template <class Visit> void CoarseGrid::for_parts_of(const ContactSpring &spring, Visit &&visit) const {
  const std::int64_t lower = cell_of_[spring.lower];
  const std::int64_t higher = cell_of_[spring.higher];
  if (lower < 0 && higher < 0) { // an element of a liner between blocks that rest
    return;
  }
  const auto forces_on = [&](std::int64_t cell, std::size_t row, Vec2 arm) {
    return cell >= 0 ? forces_on_cell(row, arm, spring.normal) : std::array<Three, 3>{};
  };
  std::array<Three, 3> on_lower = forces_on(lower, spring.lower, spring.lower_arm);
  const std::array<Three, 3> on_higher = forces_on(higher, spring.higher, spring.higher_arm);
  if (lower == higher) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        on_lower[k][i] -= on_higher[k][i];
      }
    }
    visit(lower, lower, product(spring, on_lower, on_lower, 1.0));
    return;
  }
  if (lower >= 0) {
    visit(lower, lower, product(spring, on_lower, on_lower, 1.0));
  }
  if (higher >= 0) {
    visit(higher, higher, product(spring, on_higher, on_higher, 1.0));
  }
  if (lower > higher && higher >= 0) {
    visit(lower, higher, product(spring, on_lower, on_higher, -1.0));
  } else if (higher > lower && lower >= 0) {
    visit(higher, lower, product(spring, on_higher, on_lower, -1.0));
  }
}

template <class Visit>
void CoarseGrid::for_parts(const BlockSystem &system, const ContactSprings &springs,
                           const BlockMatrices &matrices, const BlockMatrices &mass, Visit &&visit) const {
  springs.for_lists([&](std::span<const ContactSpring> list) {
    for (const ContactSpring &spring : list) {
      if (counts_here(system, BlockIndex{spring.lower})) {
        for_parts_of(spring, visit);
      }
    }
  });
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    if (has_cell(row)) {
      visit(std::int64_t{cell_of_[row]}, std::int64_t{cell_of_[row]}, on_cell(system, row, matrices, mass));
    }
  }
}

void CoarseGrid::find_pattern(const ContactSprings &springs) {
  std::vector<std::int64_t> mine;
  springs.for_lists([&](std::span<const ContactSpring> list) {
    for (const ContactSpring &spring : list) {
      const std::int64_t a = cell_of_[spring.lower];
      const std::int64_t b = cell_of_[spring.higher];
      if (a >= 0 && b >= 0 && a != b) {
        const std::int64_t key = key_of(std::max(a, b), std::min(a, b));
        if (mine.empty() || mine.back() != key) {
          mine.push_back(key);
        }
      }
    }
  });
  for (std::int64_t cell = 0; cell < std::ssize(keys_); ++cell) {
    mine.push_back(key_of(cell, cell));
  }
  pattern_ = united(communicator_, std::move(mine));
  first_of_cell_.clear();
  for (std::size_t place = 0; place < pattern_.size(); ++place) {
    if (pattern_[place] / std::ssize(keys_) == std::ssize(first_of_cell_)) { // each cell has its own block
      first_of_cell_.push_back(place);
    }
  }
}

void CoarseGrid::factorise(const BlockSystem &system, const ContactSprings &springs,
                           const BlockMatrices &matrices, const BlockMatrices &mass) {
  if (keys_.empty()) { // no block of any rank moves
    return;
  }
  find_pattern(springs);
  double largest = 0.0;
  for_parts(system, springs, matrices, mass, [&](std::int64_t, std::int64_t, const Square &square) {
    for (const Three &line : square) {
      for (const double value : line) {
        largest = std::max(largest, std::abs(value));
      }
    }
  });
  communicator_.max(std::span(&largest, 1));
  const double unit = unit_of(largest, 40);
  const double per_one = 1.0 / unit;
  sums_.assign(9 * pattern_.size(), 0);
  for_parts(system, springs, matrices, mass,
            [&](std::int64_t higher, std::int64_t lower, const Square &square) {
              std::int64_t *to = sums_.data() + 9 * place_in_pattern(higher, lower);
              for (const Three &line : square) {
                for (const double value : line) {
                  *to++ += std::llrint(value * per_one);
                }
              }
            });
  if (communicator_.size() > 1) {
    communicator_.sum(sums_);
  }
  factorise_sums(unit);
}

void CoarseGrid::factorise_sums(double unit) {
  if (analysed_ != pattern_) {
    const auto num_cells = std::ssize(keys_);
    std::vector<CoarseFactors::Place> places;
    for (const std::int64_t key : pattern_) {
      places.push_back(
          {static_cast<std::int32_t>(key / num_cells), static_cast<std::int32_t>(key % num_cells)});
    }
    factors_.analyse(keys_.size(), places);
    analysed_ = pattern_;
  }
  std::vector<double> blocks(sums_.size());
  std::transform(sums_.begin(), sums_.end(), blocks.begin(),
                 [&](std::int64_t sum) { return unit * static_cast<double>(sum); });
  factors_.factorise(blocks);
}

double CoarseGrid::largest(const BlockSystem &system, std::span<const RowRun> rows,
                           const Field &forces) const {
  double largest = 0.0;
  for_rows(rows, [&](std::size_t row) {
    for (const double value : to_cell(row, system.is_deformable(row), forces.of(row))) {
      largest = std::max(largest, std::abs(value));
    }
  });
  communicator_.max(std::span(&largest, 1));
  return largest;
}

void CoarseGrid::sum_forces(std::span<std::int64_t> others) {
  if (communicator_.size() == 1) {
    return;
  }
  const std::size_t num_forces = forces_.size();
  forces_.insert(forces_.end(), others.begin(), others.end());
  communicator_.sum(forces_);
  std::copy_n(forces_.end() - std::ssize(others), others.size(), others.begin());
  forces_.resize(num_forces);
}

double CoarseGrid::begin() {
  std::fill(residual_.begin(), residual_.end(), 0.0);
  return subtract(-1.0);
}

double CoarseGrid::subtract(double times) {
  if (residual_.empty()) {
    return 0.0;
  }
  std::transform(residual_.begin(), residual_.end(), forces_.begin(), residual_.begin(),
                 [&](double r, std::int64_t q) { return r - times * (static_cast<double>(q) / units); });
  return factors_.solve(residual_, lean_motions_);
}

} // namespace gcpdda::statics
