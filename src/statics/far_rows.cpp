#include "statics/far_rows.hpp"

#include "base/exact_sum.hpp"
#include "statics/cells.hpp"
#include "statics/unbalanced_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace gcpdda::statics {

namespace {

constexpr std::int64_t squares_a_line = std::int64_t{1} << 31;

/// What nothing balances on a row, in a measure of forces, N/m.
double far_from_balance(const BlockSystem &system, std::size_t row) {
  const std::array<double, 6> f = unbalanced_forces(system, row);
  const double turning = system.is_deformable(row) ? norm(Mat2{f[2], f[3], f[4], f[5]}) : std::abs(f[2]);
  return std::max(norm(Vec2{f[0], f[1]}), turning / system.properties[row].radius);
}

} // namespace

void FarRows::lay(const BlockSystem &system, std::vector<RowRun> mobile) {
  mobile_ = std::move(mobile);
  num_mobile_ = 0;
  ExactSum area;
  for_rows(mobile_, [&](std::size_t row) {
    area.add(system.properties[row].area);
    ++num_mobile_;
  });
  communicator_.sum(area.limbs());
  communicator_.sum(std::span(&num_mobile_, 1));
  side_ = num_mobile_ > 0 ? blocks_a_side * std::sqrt(area.value() / static_cast<double>(num_mobile_)) : 1.0;
}

std::int64_t FarRows::square_of(const BlockSystem &system, std::size_t row) const {
  const Vec2 x = (1.0 / side_) * (system.properties[row].centroid + system.trial[row].u);
  return static_cast<std::int64_t>(std::floor(x.y)) * squares_a_line +
         static_cast<std::int64_t>(std::floor(x.x));
}

std::optional<std::vector<std::uint8_t>> FarRows::find(const BlockSystem &system,
                                                       const BlockMatrices &boundary, double balanced) const {
  double largest = 0.0;
  for_rows(mobile_, [&](std::size_t row) { largest = std::max(largest, far_from_balance(system, row)); });
  largest = communicator_.max(largest);
  const double level = std::max(balanced, rules_.share_of_largest * largest);
  std::int64_t num_far = 0;
  std::vector<std::int64_t> squares;
  for_rows(mobile_, [&](std::size_t row) {
    if (far_from_balance(system, row) > level) {
      ++num_far;
      const std::int64_t middle = square_of(system, row);
      for (const std::int64_t line : {-squares_a_line, std::int64_t{0}, squares_a_line}) {
        for (const std::int64_t column : {-1, 0, 1}) {
          squares.push_back(middle + line + column);
        }
      }
    }
  });
  communicator_.sum(std::span(&num_far, 1));
  const auto mobile = static_cast<double>(num_mobile_);
  if (num_far == 0 || static_cast<double>(num_far) > rules_.most_far * mobile) {
    return std::nullopt;
  }
  squares = united(communicator_, std::move(squares));
  std::vector<std::uint8_t> around(system.num_owned, 0);
  std::int64_t num_around = 0;
  for_rows(mobile_, [&](std::size_t row) {
    if (boundary.of(row)[0] * length_of_step(system, row) > largest ||
        std::binary_search(squares.begin(), squares.end(), square_of(system, row))) {
      around[row] = 1;
      ++num_around;
    }
  });
  communicator_.sum(std::span(&num_around, 1));
  return static_cast<double>(num_around) <= rules_.most_around * mobile ? std::optional(std::move(around))
                                                                        : std::nullopt;
}

} // namespace gcpdda::statics
