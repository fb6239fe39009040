#pragma once

// What is known of the blocks of as many pairs as there are lanes: their edges and how they move.

#include "contact/lanes/lane_stretch.hpp"
#include "contact/lanes/plain_batch.hpp"
#include "geometry/lane_mat.hpp"
#include "geometry/lane_turn.hpp"

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
  std::array<std::size_t, num_lanes> first_vertex; ///< entries of BlockSystem::reference_vertex
  std::array<const std::uint8_t *, num_lanes> chain;

  [[nodiscard, gnu::always_inline]] std::size_t vertex(std::size_t i, std::size_t k) const {
    return first_vertex[i] + chain[i][k];
  }
};

[[gnu::always_inline]] inline void load_box(const LaneBlocks &blocks, LaneChain &chain) {
  const FourLanes box = load_by_lane([&](std::size_t i) { return &blocks.motion[i]->box.low.x; });
  chain.low = {box[0], box[1]};
  chain.high = {box[2], box[3]};
}

/// Where rigid blocks stand: their outlines follow to the bits of pose().
class LanePlace {
public:
  [[gnu::always_inline]] explicit LanePlace(const LaneBlocks &blocks)
      : centroid_(LaneVec::of([&](std::size_t i) { return &blocks.motion[i]->centroid; })),
        rotation_(LaneVec::of([&](std::size_t i) { return &blocks.motion[i]->turn[1]; })) {}

  [[nodiscard, gnu::always_inline]] LaneVec turned(const LaneVec &a) const {
    return rotation_.x * a + rotation_.y * perp(a);
  }
  [[nodiscard, gnu::always_inline]] LaneVec point(const LaneVec &a) const { return centroid_ + turned(a); }

private:
  LaneVec centroid_;
  LaneVec rotation_; ///< cosine and sine
};

/// Edges of one block of each pair, either of pairs where one deforms or of others.
class LaneOutline {
public:
  [[gnu::always_inline]] LaneOutline(const BlockSystem &system, const PlainPair::Kind &kind,
                                     const LaneBlocks &blocks)
      : system_(system), blocks_(blocks), place_(blocks), is_deformable_(kind.is_deformable) {}

  /// The vertex of that number in the chains.
  [[nodiscard, gnu::always_inline]] LaneVec vertex(std::size_t number) const {
    return vertex(places(number));
  }
  /// Edge `number` of the chains in memory as edge k of `chain`; without its length where none deforms.
  [[gnu::always_inline]] void load_edge(std::size_t number, std::size_t k, LaneChain &chain) const {
    const Places at = places(number);
    chain.vertex[k] = vertex(at);
    if (is_deformable_) {
      const DeformedEdge *edge = system_.deformed_edge.data();
      const FourLanes four = load_by_lane([&](std::size_t i) { return &edge[at[i]].slope.x; });
      chain.slope[k] = {four[0], four[1]};
      chain.length[k] = four[2];
      chain.normal[k] = four[3] * chain.slope[k];
      return;
    }
    const Vec2 *normal = system_.reference_normal.data();
    chain.normal[k] = place_.turned(LaneVec::of([&](std::size_t i) { return normal + at[i]; }));
    chain.slope[k] = chain.normal[k];
  }

private:
  using Places = std::array<std::size_t, num_lanes>;
  [[nodiscard, gnu::always_inline]] Places places(std::size_t number) const {
    Places at;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      at[i] = blocks_.vertex(i, number);
    }
    return at;
  }
  [[nodiscard, gnu::always_inline]] LaneVec vertex(const Places &at) const {
    const Vec2 *vertex = is_deformable_ ? system_.vertex.data() : system_.reference_vertex.data();
    const LaneVec point = LaneVec::of([&](std::size_t i) { return vertex + at[i]; });
    return is_deformable_ ? point : place_.point(point);
  }

  const BlockSystem &system_;
  const LaneBlocks &blocks_;
  LanePlace place_;
  bool is_deformable_;
};

/// Of edge k that ends there: a list of lengths would take longer to read.
[[gnu::always_inline]] inline void find_length(std::size_t k, const LaneVec &end, LaneChain &chain) {
  chain.length[k] = dot(end - chain.vertex[k], perp(chain.normal[k]));
}

/// All edges of the chains.
inline void load_chain(const BlockSystem &system, const PlainPair::Kind &kind, const LaneBlocks &blocks,
                       std::size_t edges, LaneChain &chain) {
  const LaneOutline outline(system, kind, blocks);
  chain.edges = edges;
  for (std::size_t k = 0; k < edges; ++k) {
    outline.load_edge(k, k, chain);
  }
  chain.vertex[edges] = outline.vertex(edges);
  for (std::size_t k = 0; k < edges && !kind.is_deformable; ++k) {
    find_length(k, chain.vertex[k + 1], chain);
  }
}

/// As many edges, with copies of the last one; the end of the chain and lengths of rigid blocks alone.
template <std::size_t edges>
[[gnu::always_inline]] inline void load_padded_chain(const BlockSystem &system, const PlainPair::Kind &kind,
                                                     const LaneBlocks &blocks, std::size_t last,
                                                     LaneChain &chain) {
  const LaneOutline outline(system, kind, blocks);
  each<edges>([&](auto k) __attribute__((always_inline)) {
    outline.load_edge(std::min<std::size_t>(k, last), k, chain);
  });
  if (!kind.is_deformable) {
    chain.vertex[edges] = outline.vertex(last + 1);
    each<edges>([&](auto k) __attribute__((always_inline)) {
      find_length(k, chain.vertex[k < last ? k + 1 : edges], chain);
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
    const FourLanes moved = load_by_lane([&](std::size_t i) { return &blocks.motion[i]->step.x; });
    const LaneVec turn = LaneVec::of([&](std::size_t i) { return &blocks.motion[i]->turn[0]; });
    step = {moved[0], moved[1]};
    spin = moved[3];
    versine = turn.x; // a small turn is {versine, -sine; sine, versine}
    sine = -turn.y;
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
  LaneVec grip;           ///< the one that is remembered, in the lower block's reference axes (grip.hpp)
  LaneMat lower_gradient; ///< F of the lower block, which turns a rigid one
  LaneMat lower_to_reference;

  DeformingMotion(const PlainScene &scene, const PlainLanes &lanes, const LaneBlocks &lower,
                  const LaneBlocks &higher)
      : TranslatingMotion(lower, higher) {
    take_gradients(scene, lower, lower_rate, lower_step, lower_turn);
    take_gradients(scene, higher, higher_rate, higher_step, higher_turn);
    take_grip(scene, lanes, lower);
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
  [[gnu::always_inline]] static void take_gradients(const PlainScene &scene, const LaneBlocks &blocks,
                                                    LaneMat &rate, LaneVec &step, LaneMat &turn) {
    std::array<Mat2, num_lanes> rigid_rate;
    std::array<Mat2, num_lanes> rigid_turn;
    std::array<const double *, num_lanes> rates;
    std::array<const double *, num_lanes> turns;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      const std::size_t row = blocks.row[i];
      if (scene.system.is_deformable(row)) {
        rates[i] = &scene.velocity_gradients[scene.system.deformation_begin[row]].xx;
        turns[i] = &blocks.motion[i]->turn[0].x;
      } else {
        const double spin = blocks.motion[i]->spin;
        rigid_rate[i] = {0.0, -spin, spin, 0.0};
        rigid_turn[i] = scene.system.increment_of(row).turn;
        rates[i] = &rigid_rate[i].xx;
        turns[i] = &rigid_turn[i].xx;
      }
    }
    rate = LaneMat{load_by_lane([&](std::size_t i) { return rates[i]; })};
    turn = LaneMat{load_by_lane([&](std::size_t i) { return turns[i]; })};
    step = LaneVec::of([&](std::size_t i) { return &blocks.motion[i]->step; });
  }
  [[gnu::always_inline]] void take_grip(const PlainScene &scene, const PlainLanes &lanes,
                                        const LaneBlocks &lower) {
    std::array<Mat2, num_lanes> rotation; // of rigid blocks, and its inverse
    std::array<Mat2, num_lanes> back;
    std::array<const double *, num_lanes> gradients;
    std::array<const double *, num_lanes> inverses;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      const std::size_t row = lower.row[i];
      if (scene.system.is_deformable(row)) {
        const std::size_t entry = scene.system.deformation_begin[row];
        gradients[i] = &scene.system.deformation[entry].trial.xx;
        inverses[i] = &scene.system.trial_inverse[entry].xx;
      } else {
        const Vec2 turn = lower.motion[i]->turn[1];
        rotation[i] = {turn.x, -turn.y, turn.y, turn.x};
        back[i] = {turn.x, turn.y, -turn.y, turn.x};
        gradients[i] = &rotation[i].xx;
        inverses[i] = &back[i].xx;
      }
    }
    lower_gradient = LaneMat{load_by_lane([&](std::size_t i) { return gradients[i]; })};
    lower_to_reference = LaneMat{load_by_lane([&](std::size_t i) { return inverses[i]; })};
    grip = LaneVec::of([&](std::size_t i) { return lanes.grip[i]; });
  }
};

/// What PlainBatch::find_motions() says.
inline bool find_rigid_motions(BlockSystem &system, std::size_t first) {
  static_assert(sizeof(RigidDof) == 3 * sizeof(double));
  static_assert(offsetof(BlockMotion, rotated) == offsetof(BlockMotion, step) + 2 * sizeof(double) &&
                offsetof(BlockMotion, spin) == offsetof(BlockMotion, rotated) + sizeof(double));
  const ThreeLanes velocity = load_triples(&system.velocity[first].u.x);
  const FourLanes moved = load_by_lane([&](std::size_t i) { return &system.motion[first + i].step.x; });
  const Lanes &turn = moved[2];
  if ((!LaneTurn::is_small(turn)).any()) {
    return false;
  }
  const auto [sine, versine] = LaneTurn::of(turn);
  std::array<std::byte *, num_lanes> to;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    to[i] = reinterpret_cast<std::byte *>(&system.motion[first + i]);
  }
  store_pairs(to, offsetof(BlockMotion, velocity), velocity[0], velocity[1]);
  store_pairs(to, offsetof(BlockMotion, rotated), turn, velocity[2]);
  store_pairs(to, offsetof(BlockMotion, turn), versine, -sine);
  return true;
}

/// What PlainBatch::find_deforming_motions() says.
inline void find_deforming_motions(BlockSystem &system, std::size_t first,
                                   std::span<Mat2> velocity_gradients) {
  const std::size_t entry = system.deformation_begin[first];
  const Deformation *deformation = &system.deformation[entry];
  const ThreeLanes velocity = load_triples(&system.velocity[first].u.x);
  const LaneMat rate = LaneMat::of([&](std::size_t i) { return &deformation[i].rate; }) *
                       LaneMat::of([&](std::size_t i) { return &system.trial_inverse[entry + i]; });
  std::array<std::byte *, num_lanes> to;
  std::array<std::byte *, num_lanes> to_gradients;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    to[i] = reinterpret_cast<std::byte *>(&system.motion[first + i]);
    to_gradients[i] = reinterpret_cast<std::byte *>(&velocity_gradients[entry + i]);
  }
  store_pairs(to, offsetof(BlockMotion, velocity), velocity[0], velocity[1]);
  store_by_lane(to_gradients, 0, rate.xx(), rate.xy(), rate.yx(), rate.yy());
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
