#include "blockgen/quality.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda {

double sharpest_corner(std::span<const Vec2> vertices) {
  const std::size_t n = vertices.size();
  double sharpest = 360.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = vertices[i] - vertices[(i + n - 1) % n];
    const Vec2 out = vertices[(i + 1) % n] - vertices[i];
    const double turn = std::atan2(cross(in, out), dot(in, out)) * 180.0 / std::numbers::pi;
    sharpest = std::min(sharpest, 180.0 - turn);
  }
  return sharpest;
}

void PowerHistogram::add(double x) {
  const int power = x > 0.0 ? std::ilogb(x) : lowest;
  ++counts_[static_cast<std::size_t>(std::clamp(power, lowest, highest) - lowest)];
}

double PowerHistogram::low(std::size_t bin) {
  return std::ldexp(1.0, static_cast<int>(bin) + lowest);
}

void BlockQuality::add(std::int64_t id, const SceneBlock &block) {
  if (block.fixed) {
    ++num_fixed;
    return;
  }
  const Moments moments = polygon_moments(block.vertices);
  const double corner = sharpest_corner(block.vertices);
  const double slender = mean_width(moments.area, block.vertices) / std::sqrt(moments.area);
  ++num_blocks;
  num_vertices += static_cast<std::int64_t>(block.vertices.size());
  num_non_convex += is_convex(block.vertices) ? 0 : 1;
  num_needles += corner < needle_angle ? 1 : 0;
  num_slivers += slender < sliver_ratio ? 1 : 0;
  area.add(moments.area);
  areas.add(moments.area);
  all_areas.push_back(moments.area);
  for (std::size_t k = 0; k < block.vertices.size(); ++k) {
    const double length = norm(block.vertices[(k + 1) % block.vertices.size()] - block.vertices[k]);
    edges.add(length);
    perimeter.add(length);
  }
  const auto enter = [&](std::vector<PoorBlock> &worst, double value) {
    const PoorBlock poor{id, value, moments.centroid};
    if (worst.size() < num_worst || poor < worst.back()) {
      worst.push_back(poor);
      keep_worst(worst);
    }
  };
  enter(sharpest, corner);
  enter(narrowest, slender);
}

void keep_worst(std::vector<PoorBlock> &blocks) {
  std::sort(blocks.begin(), blocks.end());
  blocks.resize(std::min(blocks.size(), BlockQuality::num_worst));
}

} // namespace gcpdda
