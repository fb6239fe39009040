#pragma once

// What is known of the blocks of as many pairs as there are lanes: their edges and how they move.

#include "lane_stretch.hpp"
#include "plain_batch.hpp"

#include "gcpdda/geometry/lane_mat.hpp"
#include "gcpdda/geometry/lane_turn.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// One block of each pair.
struct LaneBlocks {
  std::array<std::size_t, num_lanes> row;
  std::array<const BlockMotion *, num_lanes> motion;
  std::array<std::size_t, num_lanes> first_vertex; ///< entries of BlockSystem::vertex
  std::array<const std::uint8_t *, num_lanes> chain;

  [[nodiscard, gnu::always_inline]] std::size_t vertex(std::size_t i, std::size_t k) const {
    return first_vertex[i] + chain[i][k];
  }
};

/// Of *get(i).
template <class Get> [[gnu::always_inline]] inline void load_box_of(Get &&get, LaneSide &side) {
  const FourLanes box = load_by_lane([&](std::size_t i) { return &get(i)->low.x; });
  side.low = {box[0], box[1]};
  side.high = {box[2], box[3]};
}
[[gnu::always_inline]] inline void load_box(const LaneBlocks &blocks, LaneSide &side) {
  load_box_of([&](std::size_t i) { return &blocks.motion[i]->box; }, side);
}
[[gnu::always_inline]] inline void load_box(const BlockSystem &system, const LaneBlocks &blocks,
                                            LaneSide &side) {
  load_box_of([&](std::size_t i) { return &system.motion[blocks.row[i]].box; }, side);
}

[[gnu::always_inline]] inline LaneVec load_vertex(const BlockSystem &system, const LaneBlocks &blocks,
                                                  std::size_t k) {
  const Vec2 *vertex = system.vertex.data();
  return LaneVec::of([&](std::size_t i) { return vertex + blocks.vertex(i, k); });
}

/// Edge `number` of the chains as edge k of the side, of pairs where a block deforms or none; then without
/// its length.
[[gnu::always_inline]] inline void load_edge(const BlockSystem &system, const PlainPair::Kind &kind,
                                             const LaneBlocks &blocks, std::size_t number, std::size_t k,
                                             LaneSide &side) {
  std::array<std::size_t, num_lanes> at;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    at[i] = blocks.vertex(i, number);
  }
  const Vec2 *vertex = system.vertex.data();
  side.vertex[k] = LaneVec::of([&](std::size_t i) { return vertex + at[i]; });
  if (kind.is_deformable) {
    const DeformedEdge *edge = system.deformed_edge.data();
    const FourLanes four = load_by_lane([&](std::size_t i) { return &edge[at[i]].slope.x; });
    side.slope[k] = {four[0], four[1]};
    side.length[k] = four[2];
    side.normal[k] = four[3] * side.slope[k];
    return;
  }
  const Vec2 *normal = system.normal.data();
  side.normal[k] = LaneVec::of([&](std::size_t i) { return normal + at[i]; });
  side.slope[k] = side.normal[k];
}

/// Of edge k that ends there: a list of lengths would take longer to read.
[[gnu::always_inline]] inline void find_length(std::size_t k, const LaneVec &end, LaneSide &side) {
  side.length[k] = dot(end - side.vertex[k], perp(side.normal[k]));
}

/// All edges of the chains.
inline void load_chain(const BlockSystem &system, const PlainPair::Kind &kind, const LaneBlocks &blocks,
                       std::size_t edges, LaneSide &side) {
  side.edges = edges;
  for (std::size_t k = 0; k < edges; ++k) {
    load_edge(system, kind, blocks, k, k, side);
  }
  side.vertex[edges] = load_vertex(system, blocks, edges);
  for (std::size_t k = 0; k < edges && !kind.is_deformable; ++k) {
    find_length(k, side.vertex[k + 1], side);
  }
}

/// As many edges, with copies of the last one; the end of the chain and lengths of rigid blocks alone.
template <std::size_t edges>
[[gnu::always_inline]] inline void load_side(const BlockSystem &system, const PlainPair::Kind &kind,
                                             const LaneBlocks &blocks, std::size_t last, LaneSide &side) {
  each<edges>([&](auto k) __attribute__((always_inline)) {
    load_edge(system, kind, blocks, std::min<std::size_t>(k, last), k, side);
  });
  if (!kind.is_deformable) {
    side.vertex[edges] = load_vertex(system, blocks, last + 1);
    each<edges>([&](auto k) __attribute__((always_inline)) {
      find_length(k, side.vertex[k < last ? k + 1 : edges], side);
    });
  }
}

/// How two blocks move, as far as it does not matter whether they deform.
struct TranslatingMotion {
  LaneVec lower_centroid;
  LaneVec higher_centroid;
  LaneVec lower_velocity;
  LaneVec higher_velocity;

  TranslatingMotion(const LaneBlocks &lower, const LaneBlocks &higher) {
    take(lower, lower_centroid, lower_velocity);
    take(higher, higher_centroid, higher_velocity);
  }

private:
  [[gnu::always_inline]] static void take(const LaneBlocks &blocks, LaneVec &centroid, LaneVec &velocity) {
    const FourLanes both = load_by_lane([&](std::size_t i) { return &blocks.motion[i]->centroid.x; });
    centroid = {both[0], both[1]};
    velocity = {both[2], both[3]};
  }
};

/// Velocities and increments of two rigid blocks.
struct RigidMotion : TranslatingMotion {
  LaneVec lower_step;
  LaneVec higher_step;
  Lanes lower_spin;
  Lanes higher_spin;
  Lanes lower_sine;
  Lanes higher_sine;
  Lanes lower_versine;
  Lanes higher_versine;

  RigidMotion(const LaneBlocks &lower, const LaneBlocks &higher) : TranslatingMotion(lower, higher) {
    take_turn(lower, lower_spin, lower_step, lower_sine, lower_versine);
    take_turn(higher, higher_spin, higher_step, higher_sine, higher_versine);
  }
  /// Of the lower block's material point against the higher one's.
  [[nodiscard, gnu::always_inline]] LaneVec velocity_at(const LaneVec &x) const {
    return (lower_velocity + lower_spin * perp(x - lower_centroid)) -
           (higher_velocity + higher_spin * perp(x - higher_centroid));
  }
  /// The gradient of that velocity along a direction.
  [[nodiscard, gnu::always_inline]] LaneVec velocity_change_along(const LaneVec &normal) const {
    const Lanes spin = lower_spin - higher_spin;
    return {spin * normal.y, -spin * normal.x};
  }
  [[nodiscard, gnu::always_inline]] LaneVec slide_at(const LaneVec &x) const {
    const LaneVec r = x - lower_centroid;
    const LaneVec q = x - higher_centroid;
    return (lower_step + (lower_versine * r + lower_sine * perp(r))) -
           (higher_step + (higher_versine * q + higher_sine * perp(q)));
  }

private:
  [[gnu::always_inline]] static void take_turn(const LaneBlocks &blocks, Lanes &spin, LaneVec &step,
                                               Lanes &sine, Lanes &versine) {
    const FourLanes increment = load_by_lane([&](std::size_t i) { return &blocks.motion[i]->increment.u.x; });
    spin = Lanes::of([&](std::size_t i) { return blocks.motion[i]->spin; });
    step = {increment[0], increment[1]};
    versine = increment[2]; // a small turn is {versine, -sine; sine, versine}
    sine = -increment[3];
  }
};

/// The same where one of two blocks deforms.
struct DeformingMotion : TranslatingMotion {
  LaneMat lower_rate; ///< velocity gradients, 1/s
  LaneMat higher_rate;
  LaneVec lower_step;
  LaneVec higher_step;
  LaneMat lower_turn;
  LaneMat higher_turn;

  DeformingMotion(const PlainScene &scene, const LaneBlocks &lower, const LaneBlocks &higher)
      : TranslatingMotion(lower, higher) {
    const BlockSystem &system = scene.system;
    const auto rates_of = [&](const LaneBlocks &blocks) __attribute__((always_inline)) {
      std::array<Mat2, num_lanes> turning; // of rigid blocks
      std::array<const Mat2 *, num_lanes> rates;
      for (std::size_t i = 0; i < num_lanes; ++i) {
        rates[i] = &turning[i];
        if (system.is_deformable(blocks.row[i])) {
          rates[i] = &scene.velocity_gradients[system.deformation_begin[blocks.row[i]]];
        } else {
          const double spin = blocks.motion[i]->spin;
          turning[i] = {0.0, -spin, spin, 0.0};
        }
      }
      return LaneMat::of([&](std::size_t i) { return rates[i]; });
    };
    lower_rate = rates_of(lower);
    higher_rate = rates_of(higher);
    take_turn(lower, lower_step, lower_turn);
    take_turn(higher, higher_step, higher_turn);
  }
  [[nodiscard, gnu::always_inline]] LaneVec velocity_at(const LaneVec &x) const {
    return (lower_velocity + lower_rate(x - lower_centroid)) -
           (higher_velocity + higher_rate(x - higher_centroid));
  }
  [[nodiscard, gnu::always_inline]] LaneVec velocity_change_along(const LaneVec &normal) const {
    return transposed(lower_rate - higher_rate)(normal);
  }
  [[nodiscard, gnu::always_inline]] LaneVec slide_at(const LaneVec &x) const {
    return (lower_step + lower_turn(x - lower_centroid)) - (higher_step + higher_turn(x - higher_centroid));
  }

private:
  [[gnu::always_inline]] static void take_turn(const LaneBlocks &blocks, LaneVec &step, LaneMat &turn) {
    step = LaneVec::of([&](std::size_t i) { return &blocks.motion[i]->increment.u; });
    turn = LaneMat::of([&](std::size_t i) { return &blocks.motion[i]->increment.turn; });
  }
};

/// What PlainBatch::find_motions() says.
inline bool find_rigid_motions(BlockSystem &system, std::size_t first) {
  static_assert(sizeof(RigidDof) == 3 * sizeof(double));
  const ThreeLanes trial = load_triples(&system.trial[first].u.x);
  const ThreeLanes previous = load_triples(&system.trial_previous[first].u.x);
  const ThreeLanes velocity = load_triples(&system.velocity[first].u.x);
  const Lanes turn = trial[2] - previous[2];
  if ((!LaneTurn::is_small(turn)).any()) {
    return false;
  }
  const auto [sine, versine] = LaneTurn::of(turn);
  std::array<std::byte *, num_lanes> to;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    to[i] = reinterpret_cast<std::byte *>(&system.motion[first + i]);
  }
  static_assert(offsetof(BlockMotion, increment) == 4 * sizeof(double) &&
                offsetof(BlockMotion, spin) == 10 * sizeof(double));
  store_pairs(to, offsetof(BlockMotion, velocity), velocity[0], velocity[1]);
  store_by_lane(to, 4 * sizeof(double), trial[0] - previous[0], trial[1] - previous[1], versine, -sine);
  store_by_lane(to, 8 * sizeof(double), sine, versine, velocity[2], 0.0);
  return true;
}

/// What PlainBatch::find_deforming_motions() says.
inline void find_deforming_motions(BlockSystem &system, std::size_t first,
                                   std::span<Mat2> velocity_gradients) {
  const std::size_t entry = system.deformation_begin[first];
  const Deformation *deformation = &system.deformation[entry];
  const auto load = [&](Mat2 Deformation::*field) __attribute__((always_inline)) {
    return LaneMat::of([&](std::size_t i) { return &(deformation[i].*field); });
  };
  const ThreeLanes trial = load_triples(&system.trial[first].u.x);
  const ThreeLanes previous = load_triples(&system.trial_previous[first].u.x);
  const ThreeLanes velocity = load_triples(&system.velocity[first].u.x);
  const LaneMat to_reference = LaneMat::of([&](std::size_t i) { return &system.trial_inverse[entry + i]; });
  const LaneMat turn = (load(&Deformation::trial) - load(&Deformation::trial_previous)) * to_reference;
  const LaneMat rate = load(&Deformation::rate) * to_reference;
  std::array<std::byte *, num_lanes> to;
  std::array<std::byte *, num_lanes> to_gradients;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    to[i] = reinterpret_cast<std::byte *>(&system.motion[first + i]);
    to_gradients[i] = reinterpret_cast<std::byte *>(&velocity_gradients[entry + i]);
  }
  store_pairs(to, offsetof(BlockMotion, velocity), velocity[0], velocity[1]);
  store_by_lane(to, 4 * sizeof(double), trial[0] - previous[0], trial[1] - previous[1], turn.xx(), turn.xy());
  store_by_lane(to, 8 * sizeof(double), turn.yx(), turn.yy(), velocity[2], 0.0);
  store_by_lane(to_gradients, 0, rate.xx(), rate.xy(), rate.yx(), rate.yy());
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
