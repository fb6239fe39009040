#pragma once

// How good the blocks of a region are: areas, widths, angles.

#include "base/exact_sum.hpp"
#include "gcpdda/model/scene.hpp"
#include "geometry/mean_width.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// Smallest inner angle of a polygon, degrees.
double sharpest_corner(std::span<const Vec2> vertices);

/// How many numbers lie between one power of two and the next.
class PowerHistogram {
public:
  static constexpr int lowest = -40; ///< 2^-40; smaller ones count as that
  static constexpr int highest = 40;
  static constexpr std::size_t num_bins = highest - lowest + 1;

  void add(double x);
  [[nodiscard]] std::span<std::int64_t, num_bins> counts() { return counts_; }
  [[nodiscard]] std::span<const std::int64_t, num_bins> counts() const { return counts_; }
  /// Lower end of a bin.
  static double low(std::size_t bin);

private:
  std::array<std::int64_t, num_bins> counts_{};
};

/// A block with what is bad about it.
struct PoorBlock {
  std::int64_t id = -1;
  double value = 0.0; ///< the smaller the worse
  Vec2 centroid;

  friend bool operator<(const PoorBlock &a, const PoorBlock &b) {
    return a.value != b.value ? a.value < b.value : a.id < b.id;
  }
};

/// Quality of some blocks; of several ranks the parts are added by whoever knows them.
struct BlockQuality {
  static constexpr double needle_angle = 15.0; ///< degrees
  static constexpr double sliver_ratio = 0.1;  ///< mean width over sqrt(area)
  static constexpr std::size_t num_worst = 5;

  std::int64_t num_blocks = 0; ///< mobile
  std::int64_t num_fixed = 0;
  std::int64_t num_vertices = 0;
  std::int64_t num_non_convex = 0;
  std::int64_t num_needles = 0;
  std::int64_t num_slivers = 0;
  ExactSum area;      ///< m2
  ExactSum perimeter; ///< m
  PowerHistogram areas;
  PowerHistogram edges;
  std::vector<double> all_areas;    ///< for the median
  std::vector<PoorBlock> sharpest;  ///< by degrees, the worst first
  std::vector<PoorBlock> narrowest; ///< by mean width over sqrt(area)

  /// Counts the block in; fixed ones only by their number.
  void add(std::int64_t id, const SceneBlock &block);
};

/// Keeps the worst of a list.
void keep_worst(std::vector<PoorBlock> &blocks);

} // namespace gcpdda
