#pragma once

// What is known of the blocks of as many pairs as there are lanes: their edges and how they move.

#include "lane_stretch.hpp"
#include "plain_batch.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

using Rows = std::array<std::size_t, num_lanes>;

/// A dyad or a gradient, by entries xx, xy, yx, yy.
struct LaneMat {
  FourLanes entry;

  /// Lane i holds *get(i).
  template <class Get> [[gnu::always_inline]] static LaneMat of(Get &&get) {
    LaneMat result;
    result.entry = load_by_lane([&](std::size_t i) { return &get(i)->xx; });
    return result;
  }
  [[gnu::always_inline]] LaneVec operator()(const LaneVec &a) const {
    return {entry[0] * a.x + entry[1] * a.y, entry[2] * a.x + entry[3] * a.y};
  }
};

using Chains = std::array<const std::uint32_t *, num_lanes>;

inline void load_side(const BlockSystem &system, const Rows &rows, const Chains &chain, std::size_t edges,
                      LaneSide &side) {
  side.edges = edges;
  for (std::size_t k = 0; k <= edges; ++k) {
    side.vertex[k] = LaneVec::of([&](std::size_t i) { return &system.vertex[chain[i][k]]; });
  }
  for (std::size_t k = 0; k < edges; ++k) {
    side.normal[k] = LaneVec::of([&](std::size_t i) { return &system.normal[chain[i][k]]; });
    side.slope[k] = side.normal[k];
    side.length[k] = Lanes::of([&](std::size_t i) { return system.edge_length[chain[i][k]]; });
  }
  const FourLanes box = load_by_lane([&](std::size_t i) { return &system.box[rows[i]].low.x; });
  side.low = {box[0], box[1]};
  side.high = {box[2], box[3]};
}

/// Depths inside a deformable block are those in its reference polygon over J.
inline void load_deformed_slopes(const PlainScene &scene, const Rows &rows, const Chains &chain,
                                 LaneSide &side) {
  static constexpr Mat2 identity = Mat2::identity();
  const BlockSystem &system = scene.system;
  std::array<const Vec2 *, num_lanes> normals;
  std::array<const Mat2 *, num_lanes> slopes;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    const bool deforms = system.is_deformable(rows[i]);
    normals[i] = deforms ? system.reference_normal.data() : system.normal.data();
    slopes[i] = deforms ? &scene.deforming[system.deformation_begin[rows[i]]].slopes : &identity;
  }
  const LaneMat of_normals = LaneMat::of([&](std::size_t i) { return slopes[i]; });
  for (std::size_t k = 0; k < side.edges; ++k) {
    side.slope[k] = of_normals(LaneVec::of([&](std::size_t i) { return normals[i] + chain[i][k]; }));
  }
}

/// How two blocks move, as far as it does not matter whether they deform.
struct TranslatingMotion {
  LaneVec lower_centroid;
  LaneVec higher_centroid;
  LaneVec lower_velocity;
  LaneVec higher_velocity;
  LaneVec lower_step;
  LaneVec higher_step;

  TranslatingMotion(const PlainScene &scene, const Rows &a, const Rows &b) {
    const BlockSystem &system = scene.system;
    lower_centroid = LaneVec::of([&](std::size_t i) { return &system.trial_centroid[a[i]]; });
    higher_centroid = LaneVec::of([&](std::size_t i) { return &system.trial_centroid[b[i]]; });
    lower_velocity = LaneVec::of([&](std::size_t i) { return &system.velocity[a[i]].u; });
    higher_velocity = LaneVec::of([&](std::size_t i) { return &system.velocity[b[i]].u; });
  }
};

/// Velocities and increments of two rigid blocks.
struct RigidMotion : TranslatingMotion {
  Lanes lower_spin;
  Lanes higher_spin;
  Lanes lower_sine;
  Lanes higher_sine;
  Lanes lower_versine;
  Lanes higher_versine;

  RigidMotion(const PlainScene &scene, const Rows &a, const Rows &b) : TranslatingMotion(scene, a, b) {
    lower_spin = Lanes::of([&](std::size_t i) { return scene.system.velocity[a[i]].r; });
    higher_spin = Lanes::of([&](std::size_t i) { return scene.system.velocity[b[i]].r; });
    take_increments(scene, a, lower_step, lower_sine, lower_versine);
    take_increments(scene, b, higher_step, higher_sine, higher_versine);
  }
  [[gnu::always_inline]] static void take_increments(const PlainScene &scene, const Rows &rows, LaneVec &step,
                                                     Lanes &sine, Lanes &versine) {
    const FourLanes increment = load_by_lane([&](std::size_t i) { return &scene.increments[rows[i]].u.x; });
    step = {increment[0], increment[1]};
    versine = increment[2]; // a small turn is {versine, -sine; sine, versine}
    sine = -increment[3];
  }
  /// Of the lower block's material point against the higher one's.
  [[nodiscard, gnu::always_inline]] LaneVec velocity_at(const LaneVec &x) const {
    return (lower_velocity + lower_spin * perp(x - lower_centroid)) -
           (higher_velocity + higher_spin * perp(x - higher_centroid));
  }
  /// How that velocity differs at an offset.
  [[nodiscard, gnu::always_inline]] LaneVec velocity_change(const LaneVec &offset) const {
    return (lower_spin - higher_spin) * perp(offset);
  }
  [[nodiscard, gnu::always_inline]] LaneVec slide_at(const LaneVec &x) const {
    const LaneVec r = x - lower_centroid;
    const LaneVec q = x - higher_centroid;
    return (lower_step + (lower_versine * r + lower_sine * perp(r))) -
           (higher_step + (higher_versine * q + higher_sine * perp(q)));
  }
};

/// The same where one of two blocks deforms.
struct DeformingMotion : TranslatingMotion {
  LaneMat lower_rate; ///< velocity gradients, 1/s
  LaneMat higher_rate;
  LaneMat lower_turn;
  LaneMat higher_turn;

  DeformingMotion(const PlainScene &scene, const Rows &a, const Rows &b) : TranslatingMotion(scene, a, b) {
    const BlockSystem &system = scene.system;
    const auto rates_of = [&](const Rows &rows) {
      std::array<Mat2, num_lanes> rates;
      for (std::size_t i = 0; i < num_lanes; ++i) {
        const double spin = system.velocity[rows[i]].r;
        rates[i] = system.is_deformable(rows[i]) ? scene.deforming[system.deformation_begin[rows[i]]].rate
                                                 : Mat2{0.0, -spin, spin, 0.0};
      }
      return LaneMat::of([&](std::size_t i) { return &rates[i]; });
    };
    lower_rate = rates_of(a);
    higher_rate = rates_of(b);
    lower_step = LaneVec::of([&](std::size_t i) { return &scene.increments[a[i]].u; });
    higher_step = LaneVec::of([&](std::size_t i) { return &scene.increments[b[i]].u; });
    lower_turn = LaneMat::of([&](std::size_t i) { return &scene.increments[a[i]].turn; });
    higher_turn = LaneMat::of([&](std::size_t i) { return &scene.increments[b[i]].turn; });
  }
  [[nodiscard, gnu::always_inline]] LaneVec velocity_at(const LaneVec &x) const {
    return (lower_velocity + lower_rate(x - lower_centroid)) -
           (higher_velocity + higher_rate(x - higher_centroid));
  }
  [[nodiscard, gnu::always_inline]] LaneVec velocity_change(const LaneVec &offset) const {
    return lower_rate(offset) - higher_rate(offset);
  }
  [[nodiscard, gnu::always_inline]] LaneVec slide_at(const LaneVec &x) const {
    return (lower_step + lower_turn(x - lower_centroid)) - (higher_step + higher_turn(x - higher_centroid));
  }
};

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
