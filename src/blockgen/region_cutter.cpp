#include "blockgen/region_cutter.hpp"

#include "base/check.hpp"
#include "blockgen/tile.hpp"
#include "geometry/point_text.hpp"
#include "geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace gcpdda {

namespace {

/// Where GEOS has its origin: at [0, 0], or, for a region far from there, at a point whose distances from all
/// vertices have no rounding error and give these vertices back.
Vec2 origin_for(const Aabb &box) {
  const Vec2 extent = box.extent();
  const double size = std::max(extent.x, extent.y);
  const double unit = std::exp2(std::ceil(std::log2(size)));
  const auto coordinate = [&](double low, double high) {
    constexpr double far = 8.0;
    return std::max(std::abs(low), std::abs(high)) <= far * size
               ? 0.0
               : std::round(0.5 * (low + high) / unit) * unit;
  };
  return {coordinate(box.low.x, box.high.x), coordinate(box.low.y, box.high.y)};
}

bool any_fixed(const RockRegion &region) {
  return std::find(region.fixed.begin(), region.fixed.end(), true) != region.fixed.end();
}

/// The traces of a joint set that reach into what is seen of one tile.
struct FamilyInTile {
  double count = 0.0;
  Vec2 box; ///< of one trace, m
};

FamilyInTile family_in_tile(const JointSet &set, Vec2 region, Vec2 seen) {
  const Vec2 along{std::abs(std::cos(set.dip.mean)), std::abs(std::sin(set.dip.mean))};
  const double lines = (seen.x * along.y + seen.y * along.x) / set.spacing.mean;
  const double whole = std::min(region.x / along.x, region.y / along.y);
  const double length = set.through_going ? whole : std::min(whole, set.trace.mean);
  const double period = set.trace.mean + set.gap.mean;
  const double on_line =
      set.through_going ? 1.0 : 1.0 + (seen.x * along.x + seen.y * along.y + length) / period;
  return {lines * on_line, length * along};
}

Diagnostic sliver_fault(const RockRegion &region, Vec2 at) {
  return {Severity::error, region.where, fmt::format("the block at {} is a sliver", point_text(at, 9)),
          fmt::format("its mean width is below {:g} m or its area below {:g} m2, and slivers = \"refuse\"",
                      region.min_width, region.min_area),
          "move a joint, lower min_width and min_area, or use slivers = \"merge\""};
}

} // namespace

RegionCutter::RegionCutter(const Scene &scene, std::int64_t blocks_per_tile)
    : region_(scene.region), laws_(scene.joints), around_(bounding_box(region_.outline)),
      origin_(origin_for(around_)) {
  for (const JointMap &map : region_.maps) { // else it would cut nothing, without a word
    expect(!map.lines.empty(), "a joint map has been read (read_joint_map) before it cuts");
  }
  const double expected = expected_blocks();
  const double area = signed_area(region_.outline);
  constexpr double halo_in_blocks = 3.0;
  halo_ = halo_in_blocks * std::sqrt(area / expected);
  // The smallest vertex of a block may lie on the upper side: it belongs to the last row.
  constexpr double beyond = 1e-9;
  const Vec2 extent = around_.extent();
  around_ = around_.inflated(beyond * std::max(extent.x, extent.y));
  const double tiles = std::ceil(expected / static_cast<double>(blocks_per_tile));
  const double columns = std::clamp(std::round(std::sqrt(tiles * extent.x / extent.y)), 1.0, tiles);
  num_columns_ = static_cast<std::int64_t>(columns);
  num_rows_ = static_cast<std::int64_t>(std::ceil(tiles / columns));
}

std::int64_t RegionCutter::num_tiles() const {
  return num_columns_ * num_rows_ + (any_fixed(region_) ? 1 : 0);
}

double RegionCutter::expected_blocks() const {
  return gcpdda::expected_blocks(region_);
}

// A block costs the same everywhere. What grows faster are pairs of joints: noding looks at all whose boxes
// meet, and the boxes of long joints at an angle to the axes nearly all do. One family alone cuts strips as
// long as the region, for which the halo grows until it sees all of it.
double RegionCutter::expected_seconds() const {
  constexpr double per_block = 120e-6; // s, measured
  constexpr double per_pair = 0.8e-6;
  const Vec2 extent = around_.extent();
  const Vec2 seen{std::min(extent.x, extent.x / static_cast<double>(num_columns_) + 2.0 * halo_),
                  std::min(extent.y, extent.y / static_cast<double>(num_rows_) + 2.0 * halo_)};
  std::vector<FamilyInTile> families;
  for (const JointSet &set : region_.joint_sets) {
    families.push_back(family_in_tile(set, extent, seen));
  }
  double pairs = 0.0;
  for (const FamilyInTile &a : families) {
    for (const FamilyInTile &b : families) {
      pairs += 0.5 * a.count * b.count * std::min(1.0, (a.box.x + b.box.x) / seen.x) *
               std::min(1.0, (a.box.y + b.box.y) / seen.y);
    }
  }
  const double tiles = static_cast<double>(num_columns_ * num_rows_);
  const bool are_strips = families.size() == 1 && region_.voronoi.empty() && region_.bricks.empty();
  const double rounds =
      are_strips && tiles > 1.0 ? 1.0 + std::max(0.0, std::log2(std::max(extent.x, extent.y) / halo_)) : 1.0;
  return per_block * expected_blocks() + per_pair * tiles * rounds * pairs;
}

double RegionCutter::rounding() const {
  return blockgen::rounding_of(region_);
}

RegionCutter::Made RegionCutter::make(std::int64_t first, std::int64_t last) const {
  CutReport report;
  return make(first, last, report);
}

RegionCutter::Made RegionCutter::make(std::int64_t first, std::int64_t last, CutReport &report) const {
  Aabb share;
  const std::int64_t last_cut = std::min(last, num_columns_ * num_rows_);
  for (std::int64_t tile = first; tile < last_cut; ++tile) {
    share.include(tile_box(tile));
  }
  // Joints are drawn once for all tiles of the share, and once more where a halo must grow beyond it.
  const Aabb known = share.inflated(2.0 * halo_);
  const std::vector<blockgen::Trace> traces =
      first < last_cut ? blockgen::traces_in(region_, known) : std::vector<blockgen::Trace>();
  blockgen::TileCutter cutter(region_, laws_, origin_, [&](const Aabb &box) {
    if (!known.holds(box.low) || !known.holds(box.high)) {
      return blockgen::traces_in(region_, box);
    }
    std::vector<blockgen::Trace> near;
    for (std::size_t k = 0; k < traces.size(); ++k) {
      if (k < region_.outline.size() || traces[k].meets(box)) { // the outline always: traces_in()
        near.push_back(traces[k]);
      }
    }
    return near;
  });
  Made made;
  for (std::int64_t tile = first; tile < last_cut; ++tile) {
    std::vector<SceneBlock> blocks = cutter.cut({tile_box(tile), halo_}, report);
    std::move(blocks.begin(), blocks.end(), std::back_inserter(made.blocks));
  }
  if (last_cut < last) {
    std::vector<SceneBlock> blocks = fixed_blocks();
    std::move(blocks.begin(), blocks.end(), std::back_inserter(made.blocks));
  }
  if (region_.slivers == SliverRule::refuse) {
    for (const Vec2 at : report.kept_slivers) {
      made.faults.push_back(sliver_fault(region_, at));
    }
  }
  return made;
}

Aabb RegionCutter::tile_box(std::int64_t tile) const {
  const Vec2 extent = around_.extent();
  const std::int64_t row_number = tile / num_columns_;
  const auto column = static_cast<double>(tile % num_columns_);
  const auto row = static_cast<double>(row_number);
  const double width = extent.x / static_cast<double>(num_columns_);
  const double height = extent.y / static_cast<double>(num_rows_);
  return {{around_.low.x + column * width, around_.low.y + row * height},
          {around_.low.x + (column + 1.0) * width, around_.low.y + (row + 1.0) * height}};
}

// Along the part of each side that the region touches; those below and above reach over the corners. At a
// side that it touches in one vertex, blocks on the left and right reach beyond the vertex, but not into
// those.
std::vector<SceneBlock> RegionCutter::fixed_blocks() const {
  const Aabb box = bounding_box(region_.outline);
  const double t = region_.fixed_thickness;
  std::vector<SceneBlock> blocks;
  const auto is_fixed = [&](Side side) { return region_.fixed[static_cast<std::size_t>(side)]; };
  const auto add = [&](Vec2 low, Vec2 high) {
    SceneBlock block;
    block.material = region_.material;
    block.fixed = true;
    block.vertices = {low, {high.x, low.y}, high, {low.x, high.y}};
    blocks.push_back(std::move(block));
  };
  const auto touched = [&](auto is_on_side, auto along) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Vec2 p : region_.outline) {
      if (is_on_side(p)) {
        low = std::min(low, along(p));
        high = std::max(high, along(p));
      }
    }
    return std::pair(low, high);
  };
  const auto upright = [&](std::pair<double, double> part) {
    const auto [low, high] = part;
    return low < high ? part : std::pair(std::max(low - t, box.low.y), std::min(high + t, box.high.y));
  };
  const auto x_of = [](Vec2 p) { return p.x; };
  const auto y_of = [](Vec2 p) { return p.y; };
  if (is_fixed(Side::bottom)) {
    const auto [low, high] = touched([&](Vec2 p) { return p.y == box.low.y; }, x_of);
    add({low - t, box.low.y - t}, {high + t, box.low.y});
  }
  if (is_fixed(Side::left)) {
    const auto [low, high] = upright(touched([&](Vec2 p) { return p.x == box.low.x; }, y_of));
    add({box.low.x - t, low}, {box.low.x, high});
  }
  if (is_fixed(Side::right)) {
    const auto [low, high] = upright(touched([&](Vec2 p) { return p.x == box.high.x; }, y_of));
    add({box.high.x, low}, {box.high.x + t, high});
  }
  if (is_fixed(Side::top)) {
    const auto [low, high] = touched([&](Vec2 p) { return p.y == box.high.y; }, x_of);
    add({low - t, box.high.y}, {high + t, box.high.y + t});
  }
  return blocks;
}

} // namespace gcpdda
