#include "driver/odd_blocks.hpp"

#include "simulation/rank_facts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gcpdda {

namespace {

/// Sharpest convex corner of a row, degrees.
double sharpest_corner(const BlockSystem &blocks, std::size_t row) {
  const auto normal = blocks.of_row(blocks.reference_normal, row);
  double sharpest = 180.0;
  for (std::size_t i = 0; i < normal.size(); ++i) {
    const Vec2 a = normal[i];
    const Vec2 b = normal[(i + 1) % normal.size()];
    const double turn = std::atan2(cross(a, b), dot(a, b)) * 180.0 / std::numbers::pi;
    sharpest = std::min(sharpest, 180.0 - std::max(0.0, turn));
  }
  return sharpest;
}

} // namespace

void Oddity::see(double value, double limit, std::int64_t id) {
  count += value < limit ? 1 : 0;
  if (value < worst || (value == worst && id < block)) {
    worst = value;
    block = id;
  }
}

void Oddity::agree(const Communicator &communicator) {
  count = total(communicator, count);
  Oddity all;
  for (const auto &other : communicator.all_gather(std::vector<Oddity>{*this})) {
    if (other[0].block >= 0) {
      all.see(other[0].worst, 0.0, other[0].block);
    }
  }
  worst = all.worst;
  block = all.block;
}

OddBlocks odd_blocks(const Communicator &communicator, const BlockSystem &blocks) {
  OddBlocks odd;
  for (std::size_t row = 0; row < blocks.num_rows(); ++row) {
    if (row < blocks.num_owned || (blocks.is_fixed(row) && communicator.is_root())) {
      const BlockProperties &block = blocks.properties[row];
      odd.needles.see(sharpest_corner(blocks, row), needle_angle, block.id.value);
      odd.slivers.see(block.width / std::sqrt(block.area), sliver_ratio, block.id.value);
    }
  }
  odd.needles.agree(communicator);
  odd.slivers.agree(communicator);
  return odd;
}

} // namespace gcpdda
