#pragma once

// pose() of blocks with four edges, one in each lane, to the same bits.

#include "base/lanes.hpp"
#include "dynamics/lanes/block_lanes.hpp"
#include "geometry/lane_mat.hpp"
#include "geometry/lane_turn.hpp"

#include <array>
#include <cstddef>
#include <limits>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// The four vertices of each block.
class LaneQuads {
public:
  [[gnu::always_inline]] LaneQuads(BlockSystem &system, const RowsAtOnce &rows) : system_(system) {
    for (std::size_t i = 0; i < num_lanes; ++i) { // lanes beyond repeat the last one
      row[i] = rows[i < rows.size() ? i : rows.size() - 1];
      first_[i] = system.vertex_begin[row[i]];
    }
  }

  std::array<std::size_t, num_lanes> row;

  [[nodiscard, gnu::always_inline]] std::array<LaneVec, 4> load(const std::vector<Vec2> &list) const {
    std::array<LaneVec, 4> points;
    for (std::size_t k = 0; k < 4; k += 2) {
      const FourLanes two = load_by_lane([&](std::size_t i) { return &list[first_[i] + k].x; });
      points[k] = {two[0], two[1]};
      points[k + 1] = {two[2], two[3]};
    }
    return points;
  }
  [[gnu::always_inline]] void store_vertices(const std::array<LaneVec, 4> &points) const {
    const auto to = places([&](std::size_t i) { return &system_.vertex[first_[i]]; });
    store_by_lane(to, 0, points[0].x, points[0].y, points[1].x, points[1].y);
    store_by_lane(to, 2 * sizeof(Vec2), points[2].x, points[2].y, points[3].x, points[3].y);
  }
  [[gnu::always_inline]] void store_rotations(const Lanes &c, const Lanes &s) const {
    store_pairs(places([&](std::size_t i) { return &system_.motion[row[i]].turn[1]; }), 0, c, s);
  }
  [[gnu::always_inline]] void store_edges(std::size_t k, const LaneVec &slope, const Lanes &length,
                                          const Lanes &unit) const {
    store_by_lane(places([&](std::size_t i) { return &system_.deformed_edge[first_[i] + k]; }), 0, slope.x,
                  slope.y, length, unit);
  }
  [[gnu::always_inline]] void store_boxes(const std::array<LaneVec, 4> &vertex) const {
    LaneVec low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    LaneVec high = -low;
    for (const LaneVec &v : vertex) {
      low = {min(v.x, low.x), min(v.y, low.y)};
      high = {max(v.x, high.x), max(v.y, high.y)};
    }
    store_by_lane(places([&](std::size_t i) { return &system_.motion[row[i]].box; }), 0, low.x, low.y, high.x,
                  high.y);
  }
  /// Where get(i) points to.
  template <class Get> [[gnu::always_inline]] static std::array<std::byte *, num_lanes> places(Get &&get) {
    std::array<std::byte *, num_lanes> to;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      to[i] = reinterpret_cast<std::byte *>(get(i));
    }
    return to;
  }

private:
  BlockSystem &system_;
  std::array<std::size_t, num_lanes> first_;
};

inline void pose_rigid_quads(BlockSystem &system, const RowsAtOnce &rows) {
  const LaneQuads quads(system, rows);
  const auto &row = quads.row;
  const Lanes angle = Lanes::of([&](std::size_t i) { return system.trial[row[i]].r; });
  const LaneTurn turn = LaneTurn::of(angle);
  Lanes c = Lanes(1.0) - turn.versine;
  Lanes s = turn.sine;
  if ((!LaneTurn::is_small(angle)).any()) {
    c = Lanes::of([&](std::size_t i) { return Rotation::of(angle[i]).c; });
    s = Lanes::of([&](std::size_t i) { return Rotation::of(angle[i]).s; });
  }
  const LaneVec centre = LaneVec::of([&](std::size_t i) { return &system.motion[row[i]].centroid; });
  const std::array<LaneVec, 4> reference = quads.load(system.reference_vertex);
  std::array<LaneVec, 4> vertex;
  for (std::size_t k = 0; k < 4; ++k) {
    vertex[k] = centre + (c * reference[k] + s * perp(reference[k]));
  }
  quads.store_rotations(c, s);
  quads.store_boxes(vertex);
  if (!system.deformed_edge.empty()) {
    quads.store_vertices(vertex);
    const std::array<LaneVec, 4> normal = quads.load(system.reference_normal);
    for (std::size_t k = 0; k < 4; ++k) {
      const Lanes length = dot(reference[(k + 1) % 4] - reference[k], perp(normal[k]));
      quads.store_edges(k, c * normal[k] + s * perp(normal[k]), length, 1.0);
    }
  }
}

inline void pose_deformable_quads(BlockSystem &system, const RowsAtOnce &rows) {
  const LaneQuads quads(system, rows);
  const auto &row = quads.row;
  const LaneMat gradient = LaneMat::of([&](std::size_t i) { return &system.deformation_of(row[i]).trial; });
  const LaneMat inverted = inverse(gradient);
  store_by_lane(LaneQuads::places(
                    [&](std::size_t i) { return &system.trial_inverse[system.deformation_begin[row[i]]]; }),
                0, inverted.xx(), inverted.xy(), inverted.yx(), inverted.yy());
  const LaneVec centre = LaneVec::of([&](std::size_t i) { return &system.motion[row[i]].centroid; });
  const LaneMat of_slopes = determinant(inverted) * transposed(inverted);
  const std::array<LaneVec, 4> reference = quads.load(system.reference_vertex);
  const std::array<LaneVec, 4> reference_normal = quads.load(system.reference_normal);
  std::array<LaneVec, 4> vertex;
  for (std::size_t k = 0; k < 4; ++k) {
    const LaneVec edge = gradient(reference[(k + 1) % 4] - reference[k]);
    vertex[k] = centre + gradient(reference[k]);
    const LaneVec slope = of_slopes(reference_normal[k]);
    const Lanes unit = Lanes(1.0) / sqrt(dot(slope, slope));
    quads.store_edges(k, slope, dot(edge, perp(unit * slope)), unit);
  }
  quads.store_vertices(vertex);
  quads.store_boxes(vertex);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
