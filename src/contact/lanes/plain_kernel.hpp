#pragma once

// What plain_batch.hpp promises, with one contact in each lane.

#include "contact/lanes/lane_corners.hpp"
#include "contact/lanes/lane_energies.hpp"
#include "contact/lanes/lane_motion.hpp"
#include "contact/lanes/lane_region.hpp"
#include "contact/lanes/lane_stretch.hpp"
#include "contact/lanes/lane_sums.hpp"
#include "contact/lanes/plain_batch.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

class LaneBatch final : public PlainBatch {
public:
  static_assert(num_lanes <= most_lanes);
  [[nodiscard]] std::size_t width() const override { return num_lanes; }
  bool find_motions(BlockSystem &system, std::size_t first) const override {
    return find_rigid_motions(system, first);
  }
  void find_deforming_motions(BlockSystem &system, std::size_t first,
                              std::span<Mat2> velocity_gradients) const override {
    gcpdda::GCPDDA_INSTRUCTIONS::find_deforming_motions(system, first, velocity_gradients);
  }
  Seen evaluate(const PlainScene &scene, const PlainLanes &lanes) override;
  Seen evaluate_corners(const PlainScene &scene, const PlainLanes &lanes) override;
  Energies find_corner_energies(const BlockSystem &system, const Candidates &candidates,
                                const PlainLanes &lanes) override;
  Energies find_energies(const BlockSystem &system, const Candidates &candidates,
                         const PlainLanes &lanes) override;
  unsigned store(const PlainResults &results) override { return regions_.store(results); }
  [[nodiscard]] double overlap(std::size_t lane) const override { return regions_.overlap(lane); }
  Extremes take_extremes() override { return regions_.take_extremes(); }
  void add_group(GroupToAdd &group) const override {
    const bool some_wait = !group.is_added.empty();
    if (group.dyads == nullptr) {
      some_wait ? add_pairs<false, true>(group) : add_pairs<false, false>(group);
    } else {
      some_wait ? add_pairs<true, true>(group) : add_pairs<true, false>(group);
    }
  }

private:
  struct Pairs;
  static LaneConstants load_constants(const PlainScene &scene, const Pairs &pairs);
  void integrate();
  void measure(const LaneConstants &constants);
  template <class AnyMotion> void add_dashpot(const LaneConstants &constants, const AnyMotion &motion);
  template <std::size_t edges> Seen evaluate_corners(const PlainScene &scene, const Pairs &pairs);
  /// Of the lanes whose overlap is known, which touch.
  template <std::size_t edges>
  unsigned evaluate_overlap(const PlainScene &scene, const Pairs &pairs, const CornerOverlap<edges> &overlap,
                            const Mask &known);
  template <std::size_t edges> struct PairChains;
  static Energies by_lane(const Mask &known, const Lanes &energy);
  /// visit(edges) with the number of edges of the longer chain, where there are few.
  template <class Visit> static auto with_few_edges(const PlainPair &pair, Visit &&visit);
  template <std::size_t edges>
  void measure(const CornerOverlap<edges> &overlap, const LaneConstants &constants);
  template <std::size_t edges, class AnyMotion>
  void add_dashpot(const CornerOverlap<edges> &overlap, const LaneConstants &constants,
                   const AnyMotion &motion);
  template <class AddDashpot>
  void add_friction_and_dashpots(const PlainScene &scene, const Pairs &pairs, const LaneConstants &constants,
                                 AddDashpot &&add_dashpot);

  LaneChain lower_;
  LaneChain higher_;
  LaneStretches on_lower_;
  LaneStretches on_higher_;
  LaneRegions regions_;
};

/// The blocks of the pair in each lane.
struct LaneBatch::Pairs {
  const PlainLanes &lanes;
  const PlainPair &first; ///< all are like it
  LaneBlocks lower;
  LaneBlocks higher;

  [[gnu::always_inline]] Pairs(const BlockSystem &system, const Candidates &candidates,
                               const PlainLanes &given)
      : lanes(given), first(*given.pair[0]) {
    const std::uint32_t *vertex_begin = system.vertex_begin.data();
    const BlockMotion *motions = system.motion.data();
    for (std::size_t i = 0; i < num_lanes; ++i) {
      const PlainPair &plain = *lanes.pair[i];
      const CandidatePair &pair = candidates.pairs[plain.pair];
      lower.row[i] = pair.lower.value;
      higher.row[i] = pair.higher.value;
      lower.motion[i] = motions + lower.row[i];
      higher.motion[i] = motions + higher.row[i];
      lower.first_vertex[i] = vertex_begin[lower.row[i]];
      higher.first_vertex[i] = vertex_begin[higher.row[i]];
      lower.chain[i] = &rings[plain.lower_ends];
      higher.chain[i] = &rings[plain.higher_ends];
    }
  }
  [[gnu::always_inline]] Pairs(const PlainScene &scene, const PlainLanes &given)
      : Pairs(scene.system, scene.candidates, given) {}
};

inline LaneConstants LaneBatch::load_constants(const PlainScene &scene, const Pairs &pairs) {
  // Each with what stands behind it.
  const LawConstants *laws = scene.candidates.laws.data();
  const FourLanes strength =
      load_by_lane([&](std::size_t i) { return &laws[pairs.lanes.constants[i]->law].half_stiffness; });
  const FourLanes dashpot = load_by_lane([&](std::size_t i) { return &pairs.lanes.constants[i]->damping; });
  const FourLanes known = load_by_lane([&](std::size_t i) { return &pairs.lanes.memory[i]->shear; });
  return {strength[0],
          strength[1],
          strength[2],
          strength[3],
          dashpot[0],
          dashpot[1],
          dashpot[2],
          scene.damping_ratio,
          scene.stiffness_damping,
          known[2] >= 0.0,
          scene.is_known ? Mask{} : known[2] >= 0.0,
          known[0],
          known[1],
          max(0.0, known[2])};
}

inline void LaneBatch::integrate() {
  LaneVec origin = lower_.vertex[0];
  for (std::size_t k = higher_.edges; k-- > 0;) {
    origin = select(on_higher_[k].valid, on_higher_[k].begin, origin);
  }
  for (std::size_t k = lower_.edges; k-- > 0;) {
    origin = select(on_lower_[k].valid, on_lower_[k].begin, origin);
  }
  regions_.start(origin);
  const auto add = [&](const LaneStretch &stretch, const LaneVec &normal, const LaneVec &direction) {
    if (stretch.valid.any()) {
      const LaneVec arm = stretch.begin - origin;
      regions_.add_pressure(stretch.pressure, stretch.pressure * arm + stretch.moment * perp(normal),
                            direction);
    }
  };
  for (std::size_t k = 0; k < lower_.edges; ++k) {
    add(on_lower_[k], lower_.normal[k], -lower_.normal[k]);
  }
  for (std::size_t k = 0; k < higher_.edges; ++k) {
    add(on_higher_[k], higher_.normal[k], higher_.normal[k]);
  }
  regions_.touches = regions_.has_pressure();
  regions_.find_resultant();
}

inline void LaneBatch::measure(const LaneConstants &constants) {
  const LaneVec normal = regions_.normal();
  const LaneVec tangent = perp(normal);
  const LaneVec point = regions_.point();
  constexpr double infinite = std::numeric_limits<double>::infinity();
  LaneRegions::Extent extent{infinite, infinite, -infinite, -infinite};
  Lanes deepest = 0.0;
  const auto add = [&](const LaneStretch &stretch) {
    if (!stretch.valid.any()) {
      return;
    }
    deepest = max(deepest, stretch.deepest);
    for (const LaneVec &end : {stretch.begin, stretch.end}) {
      const LaneVec x = end - point;
      const Lanes along_n = dot(x, normal);
      const Lanes along_t = dot(x, tangent);
      extent.low_n = select(stretch.valid, min(extent.low_n, along_n), extent.low_n);
      extent.high_n = select(stretch.valid, max(extent.high_n, along_n), extent.high_n);
      extent.low_t = select(stretch.valid, min(extent.low_t, along_t), extent.low_t);
      extent.high_t = select(stretch.valid, max(extent.high_t, along_t), extent.high_t);
    }
  };
  for (std::size_t k = 0; k < lower_.edges; ++k) {
    add(on_lower_[k]);
  }
  for (std::size_t k = 0; k < higher_.edges; ++k) {
    add(on_higher_[k]);
  }
  regions_.take_extent(extent, deepest, constants);
}

template <class AnyMotion>
void LaneBatch::add_dashpot(const LaneConstants &constants, const AnyMotion &motion) {
  Lanes facing_pressure = 0.0;
  std::array<Lanes, 2 * most_plain_edges> facing;
  const auto each = [&](auto &&visit) {
    for (std::size_t k = 0; k < lower_.edges; ++k) {
      visit(on_lower_[k], lower_.normal[k], facing[k], -1.0);
    }
    for (std::size_t k = 0; k < higher_.edges; ++k) {
      visit(on_higher_[k], higher_.normal[k], facing[most_plain_edges + k], 1.0);
    }
  };
  each([&](const LaneStretch &stretch, const LaneVec &normal, Lanes &share, double sign) {
    share = max(0.0, Lanes(sign) * dot(regions_.normal(), normal));
    facing_pressure += share * stretch.pressure;
  });
  LaneDashpot dashpot(regions_, constants, facing_pressure, motion);
  each([&](const LaneStretch &stretch, const LaneVec &normal, const Lanes &share, double) {
    if ((stretch.valid & (share > 0.0)).any()) {
      dashpot.add(stretch.begin - regions_.origin, perp(normal), stretch, share);
    }
  });
  regions_.add_dashpot(dashpot.total, dashpot.moment, motion);
}

template <class AddDashpot>
void LaneBatch::add_friction_and_dashpots(const PlainScene &scene, const Pairs &pairs,
                                          const LaneConstants &constants, AddDashpot &&add_dashpot) {
  const auto add_with = [&](const auto &motion) {
    regions_.add_friction(constants, motion);
    if (constants.has_dashpots()) {
      add_dashpot(motion);
    }
    regions_.find_torques(motion);
  };
  if (pairs.first.kind.is_deformable) {
    add_with(DeformingMotion(scene, pairs.lanes, pairs.lower, pairs.higher));
  } else {
    add_with(RigidMotion(pairs.lower, pairs.higher));
  }
}

inline PlainBatch::Seen LaneBatch::evaluate(const PlainScene &scene, const PlainLanes &lanes) {
  const Pairs pairs(scene, lanes);
  const auto load = [&](const LaneBlocks &blocks, std::size_t edges, LaneChain &chain) {
    load_chain(scene.system, pairs.first.kind, blocks, edges, chain);
    load_box(blocks, chain);
  };
  load(pairs.lower, pairs.first.kind.lower_edges, lower_);
  load(pairs.higher, pairs.first.kind.higher_edges, higher_);
  cut_edges(lower_, higher_, on_lower_);
  cut_edges(higher_, lower_, on_higher_);
  integrate();
  const Mask meets = boxes_meet(lower_, higher_);
  regions_.touches = regions_.touches & meets;
  const CornersInside of_lower = count_corners(lower_, higher_);
  const CornersInside of_higher = count_corners(higher_, lower_);
  Seen seen;
  seen.touching = regions_.touches.by_lane();
  seen.meeting = meets.by_lane();
  seen.with_corners = (meets & of_lower.any & of_higher.any & !(of_lower.two | of_higher.two)).by_lane();
  if (seen.touching == 0) {
    return seen;
  }
  const LaneConstants constants = load_constants(scene, pairs);
  regions_.take_stiffness(constants.half_stiffness);
  measure(constants);
  add_friction_and_dashpots(scene, pairs, constants,
                            [&](const auto &motion) { add_dashpot(constants, motion); });
  return seen;
}

// The corners and the places where the boundaries cross.
template <std::size_t edges>
void LaneBatch::measure(const CornerOverlap<edges> &overlap, const LaneConstants &constants) {
  const LaneVec normal = regions_.normal();
  const LaneVec tangent = perp(normal);
  const LaneVec to_point = regions_.point() - regions_.origin;
  const LaneVec start = -to_point;
  LaneRegions::Extent extent{dot(start, normal), dot(start, tangent), dot(start, normal),
                             dot(start, tangent)};
  overlap.for_corners([&](const LaneVec &end) __attribute__((always_inline)) {
    const LaneVec x = end - to_point;
    const Lanes along_n = dot(x, normal);
    const Lanes along_t = dot(x, tangent);
    extent.low_n = min(extent.low_n, along_n);
    extent.high_n = max(extent.high_n, along_n);
    extent.low_t = min(extent.low_t, along_t);
    extent.high_t = max(extent.high_t, along_t);
  });
  Lanes deepest = 0.0;
  overlap.for_stretches([&](auto, const auto &stretch, const LaneVec &)
                            __attribute__((always_inline)) { deepest = max(deepest, stretch.deepest); });
  regions_.take_extent(extent, deepest, constants);
}

template <std::size_t edges, class AnyMotion>
void LaneBatch::add_dashpot(const CornerOverlap<edges> &overlap, const LaneConstants &constants,
                            const AnyMotion &motion) {
  std::array<Lanes, 4> share;
  Lanes facing_pressure = 0.0;
  overlap.for_stretches([&](auto i, const auto &stretch, const LaneVec &push) __attribute__((always_inline)) {
    share[i] = max(0.0, dot(regions_.normal(), push));
    facing_pressure += share[i] * stretch.pressure;
  });
  LaneDashpot dashpot(regions_, constants, facing_pressure, motion);
  overlap.for_stretches([&](auto i, const auto &stretch, const LaneVec &) __attribute__((always_inline)) {
    dashpot.add(stretch.begin, stretch.direction, stretch, share[i]);
  });
  regions_.add_dashpot(dashpot.total, dashpot.moment, motion);
}

template <std::size_t edges>
unsigned LaneBatch::evaluate_overlap(const PlainScene &scene, const Pairs &pairs,
                                     const CornerOverlap<edges> &overlap, const Mask &known) {
  regions_.start(overlap.origin());
  overlap.for_stretches([&](auto, const auto &stretch, const LaneVec &push) __attribute__((always_inline)) {
    regions_.add_pressure(stretch.pressure, stretch.moment, push);
  });
  regions_.touches = known & regions_.has_pressure();
  regions_.find_resultant();
  if (regions_.touches.any()) {
    const LaneConstants constants = load_constants(scene, pairs);
    regions_.take_stiffness(constants.half_stiffness);
    measure(overlap, constants);
    add_friction_and_dashpots(scene, pairs, constants,
                              [&](const auto &motion) { add_dashpot(overlap, constants, motion); });
  }
  return regions_.touches.by_lane();
}

// The shorter chain goes on with copies of its last edge: no line is next to itself, and a corner is found
// where it is first.
template <std::size_t edges> struct LaneBatch::PairChains {
  LaneChain lower;
  LaneChain higher;
  std::size_t last_lower;
  std::size_t last_higher;

  [[gnu::always_inline]] PairChains(const BlockSystem &system, const Pairs &pairs)
      : last_lower(pairs.first.kind.lower_edges - std::size_t{1}),
        last_higher(pairs.first.kind.higher_edges - std::size_t{1}) {
    load_padded_chain<edges>(system, pairs.first.kind, pairs.lower, last_lower, lower);
    load_padded_chain<edges>(system, pairs.first.kind, pairs.higher, last_higher, higher);
    load_box(pairs.lower, lower);
    load_box(pairs.higher, higher);
  }
  /// Where the chains end: pairs of rigid blocks know it, for their lengths.
  void load_ends(const BlockSystem &system, const Pairs &pairs) {
    if (pairs.first.kind.is_deformable) {
      lower.vertex[edges] = LaneOutline(system, pairs.first.kind, pairs.lower).vertex(last_lower + 1);
      higher.vertex[edges] = LaneOutline(system, pairs.first.kind, pairs.higher).vertex(last_higher + 1);
    }
  }
};

template <std::size_t edges>
PlainBatch::Seen LaneBatch::evaluate_corners(const PlainScene &scene, const Pairs &pairs) {
  PairChains<edges> chains(scene.system, pairs);
  CornerOverlap<edges> overlap;
  const Mask meets = boxes_meet(chains.lower, chains.higher);
  const Mask valid = meets & overlap.find(chains.lower, chains.higher);
  Seen seen;
  seen.meeting = meets.by_lane();
  seen.apart = (!meets).by_lane();
  if ((!valid).any()) {
    chains.load_ends(scene.system, pairs);
    seen.apart |= (are_apart<edges>(chains.lower, chains.higher) & !valid).by_lane();
    if (!valid.any()) {
      return seen;
    }
  }
  seen.touching = evaluate_overlap(scene, pairs, overlap, valid);
  return seen;
}

template <class Visit> auto LaneBatch::with_few_edges(const PlainPair &pair, Visit &&visit) {
  static_assert(most_corner_edges == 4);
  switch (std::max(pair.kind.lower_edges, pair.kind.higher_edges)) {
  case 2:
    return visit(std::integral_constant<std::size_t, 2>{});
  case 3:
    return visit(std::integral_constant<std::size_t, 3>{});
  default:
    return visit(std::integral_constant<std::size_t, 4>{});
  }
}

inline PlainBatch::Seen LaneBatch::evaluate_corners(const PlainScene &scene, const PlainLanes &lanes) {
  const Pairs pairs(scene, lanes);
  return with_few_edges(pairs.first, [&](auto edges) { return evaluate_corners<edges>(scene, pairs); });
}

inline PlainBatch::Energies LaneBatch::by_lane(const Mask &known, const Lanes &energy) {
  Energies energies{known.by_lane(), {}};
  for (std::size_t i = 0; i < num_lanes; ++i) {
    energies.energy[i] = energy[i];
  }
  return energies;
}

inline PlainBatch::Energies LaneBatch::find_corner_energies(const BlockSystem &system,
                                                            const Candidates &candidates,
                                                            const PlainLanes &lanes) {
  const Pairs pairs(system, candidates, lanes);
  return with_few_edges(pairs.first, [&](auto edges) {
    const PairChains<edges> chains(system, pairs);
    CornerOverlap<edges> overlap;
    const Mask overlaps = overlap.find(chains.lower, chains.higher);
    return by_lane(overlaps & overlap.has_two_lines_each(), overlap.energy());
  });
}

inline PlainBatch::Energies LaneBatch::find_energies(const BlockSystem &system, const Candidates &candidates,
                                                     const PlainLanes &lanes) {
  const Pairs pairs(system, candidates, lanes);
  load_chain(system, pairs.first.kind, pairs.lower, pairs.first.kind.lower_edges, lower_);
  load_chain(system, pairs.first.kind, pairs.higher, pairs.first.kind.higher_edges, higher_);
  load_box(pairs.lower, lower_);
  load_box(pairs.higher, higher_);
  cut_edges(lower_, higher_, on_lower_);
  cut_edges(higher_, lower_, on_higher_);
  const LaneEnergy of_higher = find_field_energy(lower_, on_lower_, higher_);
  const LaneEnergy of_lower = find_field_energy(higher_, on_higher_, lower_);
  return by_lane(of_higher.known & of_lower.known, of_higher.energy + of_lower.energy);
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
