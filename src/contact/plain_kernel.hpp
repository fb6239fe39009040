#pragma once

// What plain_batch.hpp promises, with one contact in each lane.

#include "lane_motion.hpp"
#include "lane_stretch.hpp"
#include "plain_batch.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// a b^T added by entries xx, xy, yx, yy.
[[gnu::always_inline]] inline void add_outer(FourLanes &dyad, const LaneVec &a, const LaneVec &b) {
  dyad[0] += a.x * b.x;
  dyad[1] += a.x * b.y;
  dyad[2] += a.y * b.x;
  dyad[3] += a.y * b.y;
}

/// int q ds and int q s ds of a linear q.
struct LaneTraction {
  Lanes total;
  Lanes along;

  LaneTraction()
      : total(0.0), along(0.0) {} // written out: an implied one is not compiled for the lanes' instructions

  [[gnu::always_inline]] void add_linear(const Lanes &s0, const Lanes &q0, const Lanes &s1, const Lanes &q1) {
    const Lanes length = s1 - s0;
    const Lanes stretch = Lanes(0.5) * length * (q0 + q1);
    total += stretch;
    along += s0 * stretch + length * length * (q0 + Lanes(2.0) * q1) * Lanes(1.0 / 6.0);
  }
};

/// Of q = max(-p, d) over a piece, p >= 0 and d linear.
inline LaneTraction integrate_without_tension(const Lanes &length, const Lanes &p0, const Lanes &p1,
                                              const Lanes &d0, const Lanes &d1) {
  const Lanes sum0 = p0 + d0;
  const Lanes sum1 = p1 + d1;
  const Mask changes = ((sum0 > 0.0) & (sum1 < 0.0)) | ((sum0 < 0.0) & (sum1 > 0.0));
  const Lanes q0 = max(-p0, d0);
  const Lanes q1 = max(-p1, d1);
  LaneTraction q;
  if (!changes.any()) {
    q.add_linear(0.0, q0, length, q1);
    return q;
  }
  const Lanes share = sum0 / (sum0 - sum1);
  const Lanes cut = select(changes, share * length, length);
  const Lanes at_cut = select(changes, -(p0 + share * (p1 - p0)), q1);
  q.add_linear(0.0, q0, cut, at_cut);
  q.add_linear(cut, at_cut, length, q1);
  return q;
}

class LaneBatch final : public PlainBatch {
public:
  static_assert(num_lanes <= most_lanes);
  [[nodiscard]] std::size_t width() const override { return num_lanes; }
  unsigned evaluate(const PlainScene &scene, std::span<const std::uint32_t> entries,
                    std::span<const CandidatePair *const> constants) override;
  void store(const Results &results) override;
  [[nodiscard]] Mat2 damping_dyad(std::size_t lane) const override;

private:
  struct Constants;
  using Torques = std::array<Lanes, 2>; ///< on the lower and the higher block

  void integrate();
  void measure();
  template <class AnyMotion> void add_friction(const Constants &constants, const AnyMotion &motion);
  template <class AnyMotion> void add_dashpot(const Constants &constants, const AnyMotion &motion);
  template <class AnyMotion>
  void add_friction_and_dashpots(const Constants &constants, const AnyMotion &motion);

  LaneSide lower_;
  LaneSide higher_;
  LaneStretches on_lower_;
  LaneStretches on_higher_;

  // RegionForce and RegionMemory, one in each lane.
  Mask touches_;
  Mask undefined_;
  LaneVec origin_;
  LaneVec force_;
  FourLanes dyad_;
  Lanes pressure_;
  LaneVec point_;
  LaneVec normal_;
  Lanes normal_force_;
  Lanes overlap_;
  Lanes extent_begin_;
  Lanes extent_end_;
  Lanes longest_;
  Lanes elastic_;
  Lanes shear_;
  Lanes slip_;
  Lanes cap_;
  Mask slips_;
  LaneVec damping_force_;
  FourLanes damping_dyad_; ///< of pairs with a deformable block
  Torques torque_;
  Torques shear_torque_;
  Torques damping_torque_;
  RegionForce unwanted_; ///< takes what lanes write that no one asks
};

struct LaneBatch::Constants {
  Lanes half_stiffness;
  Lanes tangential_stiffness;
  Lanes tan_friction;
  Lanes cohesion;
  Lanes damping;
  Lanes mass;
  double damping_ratio;
  double stiffness_damping;
  Lanes was_there; ///< 1 where the region has a memory
  Lanes shear;
  Lanes longest;
  Lanes slip;
};

inline void LaneBatch::integrate() {
  for (std::size_t k = higher_.edges; k-- > 0;) {
    origin_ = select(on_higher_[k].valid, on_higher_[k].begin, origin_);
  }
  for (std::size_t k = lower_.edges; k-- > 0;) {
    origin_ = select(on_lower_[k].valid, on_lower_[k].begin, origin_);
  }
  force_ = {0.0, 0.0};
  FourLanes dyad{0.0, 0.0, 0.0, 0.0};
  pressure_ = 0.0;
  LaneVec pressure_moment{0.0, 0.0};
  const auto add = [&](const LaneStretch &stretch, const LaneVec &normal, const LaneVec &direction) {
    if (!stretch.valid.any()) {
      return;
    }
    const LaneVec arm = stretch.begin - origin_;
    const LaneVec moment = stretch.pressure * arm + stretch.moment * perp(normal);
    force_ += stretch.pressure * direction;
    add_outer(dyad, moment, direction);
    pressure_ += stretch.pressure;
    pressure_moment += moment;
  };
  for (std::size_t k = 0; k < lower_.edges; ++k) {
    add(on_lower_[k], lower_.normal[k], -lower_.normal[k]);
  }
  for (std::size_t k = 0; k < higher_.edges; ++k) {
    add(on_higher_[k], higher_.normal[k], higher_.normal[k]);
  }
  dyad_ = dyad;
  touches_ = pressure_ > 0.0;
  const Lanes resultant = sqrt(dot(force_, force_));
  undefined_ = touches_ & (resultant <= Lanes(ContactForces::least_resultant) * pressure_);
  const Mask defined = touches_ & !undefined_;
  const Lanes whole = select(touches_, pressure_, 1.0);
  point_ = origin_ + LaneVec{pressure_moment.x / whole, pressure_moment.y / whole};
  normal_force_ = resultant;
  const Lanes inverse = Lanes(1.0) / select(defined, resultant, 1.0);
  normal_ = select(defined, inverse * force_, LaneVec{0.0, 0.0});
}

inline void LaneBatch::measure() {
  const LaneVec tangent = perp(normal_);
  Lanes low_n = infinite;
  Lanes low_t = infinite;
  Lanes high_n = -infinite;
  Lanes high_t = -infinite;
  Lanes deepest = 0.0;
  const auto add = [&](const LaneStretch &stretch) {
    if (!stretch.valid.any()) {
      return;
    }
    deepest = max(deepest, stretch.deepest);
    for (const LaneVec &end : {stretch.begin, stretch.end}) {
      const LaneVec x = end - point_;
      const Lanes along_n = dot(x, normal_);
      const Lanes along_t = dot(x, tangent);
      low_n = select(stretch.valid, min(low_n, along_n), low_n);
      high_n = select(stretch.valid, max(high_n, along_n), high_n);
      low_t = select(stretch.valid, min(low_t, along_t), low_t);
      high_t = select(stretch.valid, max(high_t, along_t), high_t);
    }
  };
  for (std::size_t k = 0; k < lower_.edges; ++k) {
    add(on_lower_[k]);
  }
  for (std::size_t k = 0; k < higher_.edges; ++k) {
    add(on_higher_[k]);
  }
  overlap_ = select(undefined_, Lanes(2.0) * deepest, min(high_n - low_n, Lanes(4.0) * deepest));
  extent_begin_ = low_t;
  extent_end_ = high_t;
}

template <class AnyMotion> void LaneBatch::add_friction(const Constants &constants, const AnyMotion &motion) {
  const LaneVec tangent = perp(normal_);
  const Lanes extent = extent_end_ - extent_begin_;
  const Mask defined = touches_ & !undefined_;
  longest_ = select(defined, max(constants.longest, extent), constants.longest);
  cap_ = select(defined, normal_force_ * constants.tan_friction + constants.cohesion * extent, 0.0);
  const Mask holds = cap_ > 0.0;
  slips_ = !holds;
  const Lanes stiffness = constants.tangential_stiffness * longest_;
  const LaneVec slide = motion.slide_at(point_);
  Lanes shear = select((constants.was_there > 0.0) & holds, constants.shear + stiffness * dot(slide, tangent),
                       constants.shear);
  const Mask breaks = holds & (abs(shear) > cap_);
  slips_ = slips_ | breaks;
  slip_ = select(breaks, constants.slip + (abs(shear) - cap_) / stiffness, constants.slip);
  shear = select(breaks, select(shear < 0.0, -cap_, cap_), shear);
  elastic_ = select(holds, shear, 0.0);
  Lanes viscous = 0.0;
  if (constants.damping_ratio > 0.0 || constants.stiffness_damping > 0.0) {
    const LaneVec velocity = motion.velocity_at(point_);
    const Lanes drag = (Lanes(2.0 * constants.damping_ratio) * sqrt(stiffness * constants.mass) +
                        Lanes(constants.stiffness_damping) * stiffness) *
                       dot(velocity, tangent);
    viscous = select(holds, clamp(elastic_ + drag, -cap_, cap_) - elastic_, 0.0);
  }
  shear_ = elastic_ + viscous;
  const LaneVec friction = -shear_ * tangent;
  force_ += friction;
  add_outer(dyad_, point_ - origin_, friction);
  // A force at x_r has the torque of its size along t_r.
  const Lanes lower_lever = cross(point_ - motion.lower_centroid, tangent);
  const Lanes higher_lever = cross(point_ - motion.higher_centroid, tangent);
  shear_torque_ = {-elastic_ * lower_lever, elastic_ * higher_lever};
  damping_torque_ = {-viscous * lower_lever, viscous * higher_lever};
  damping_force_ = -viscous * tangent;
  if constexpr (std::is_same_v<AnyMotion, DeformingMotion>) {
    damping_dyad_ = {0.0, 0.0, 0.0, 0.0};
    add_outer(damping_dyad_, point_ - origin_, damping_force_);
  }
}

template <class AnyMotion> void LaneBatch::add_dashpot(const Constants &constants, const AnyMotion &motion) {
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
    share = max(0.0, Lanes(sign) * dot(normal_, normal));
    facing_pressure += share * stretch.pressure;
  });
  const Lanes kept = min(1.0, normal_force_ / constants.half_stiffness /
                                  select(facing_pressure > 0.0, facing_pressure, 1.0));
  const LaneVec velocity = motion.velocity_at(origin_);
  Lanes total = 0.0;
  LaneVec moment{0.0, 0.0};
  each([&](const LaneStretch &stretch, const LaneVec &normal, const Lanes &share, double) {
    if (!(stretch.valid & (share > 0.0)).any()) {
      return;
    }
    const LaneVec begin = stretch.begin - origin_;
    const Lanes rate = constants.damping * share;
    const Lanes closing = -rate * dot(velocity + motion.velocity_change(begin), normal_);
    const Lanes slope = -rate * dot(motion.velocity_change(perp(normal)), normal_);
    const Lanes closing_end = closing + slope * stretch.length;
    LaneTraction q;
    q.add_linear(0.0, closing, stretch.length, closing_end);
    const Mask closes = (!stretch.valid) | ((closing >= 0.0) & (closing_end >= 0.0));
    if ((!closes).any()) {
      const Lanes releasable = kept * share * constants.half_stiffness;
      LaneTraction cut;
      for (std::size_t p = 0; p < stretch.num_pieces; ++p) {
        const LanePiece &piece = stretch.piece[p];
        const Lanes d = closing + slope * piece.begin;
        const LaneTraction part =
            integrate_without_tension(piece.length, releasable * piece.depth_begin,
                                      releasable * piece.depth_end, d, d + slope * piece.length);
        cut.total += part.total;
        cut.along += part.along + piece.begin * part.total;
      }
      q.total = select(closes, q.total, cut.total);
      q.along = select(closes, q.along, cut.along);
    }
    total += q.total;
    moment += q.total * begin + q.along * perp(normal);
  });
  const LaneVec push = total * normal_;
  force_ += push;
  add_outer(dyad_, moment, normal_);
  damping_force_ += push;
  if constexpr (std::is_same_v<AnyMotion, DeformingMotion>) {
    add_outer(damping_dyad_, moment, normal_);
  }
  const Lanes about_origin = cross(moment, normal_);
  damping_torque_[0] += about_origin + cross(origin_ - motion.lower_centroid, push);
  damping_torque_[1] += -about_origin - cross(origin_ - motion.higher_centroid, push);
}

template <class AnyMotion>
void LaneBatch::add_friction_and_dashpots(const Constants &constants, const AnyMotion &motion) {
  add_friction(constants, motion);
  if (constants.damping_ratio > 0.0 || constants.stiffness_damping > 0.0) {
    add_dashpot(constants, motion);
  }
  const Lanes about_origin = dyad_[1] - dyad_[2];
  torque_[0] = about_origin + cross(origin_ - motion.lower_centroid, force_);
  torque_[1] = -about_origin - cross(origin_ - motion.higher_centroid, force_);
}

inline unsigned LaneBatch::evaluate(const PlainScene &scene, std::span<const std::uint32_t> entries,
                                    std::span<const CandidatePair *const> given) {
  const BlockSystem &system = scene.system;
  Rows a;
  Rows b;
  Chains lower_chain;
  Chains higher_chain;
  std::array<const CandidatePair *, num_lanes> candidate;
  static constexpr RegionMemory no_memory;
  std::array<const RegionMemory *, num_lanes> memory;
  std::array<double, num_lanes> was_there;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    const std::size_t entry = std::min(i, entries.size() - 1);
    const PlainPair &plain = scene.candidates.plain[entries[entry]];
    candidate[i] = given[entry];
    a[i] = plain.lower.value;
    b[i] = plain.higher.value;
    lower_chain[i] = scene.candidates.chain_vertices.data() + plain.chain;
    higher_chain[i] = lower_chain[i] + plain.lower_edges + 1;
    const auto old = scene.history.of_pair(plain.pair);
    memory[i] = old.empty() ? &no_memory : old.data();
    was_there[i] = old.empty() ? 0.0 : 1.0;
  }
  const PlainPair &first = scene.candidates.plain[entries[0]];
  load_side(system, a, lower_chain, first.lower_edges, lower_);
  load_side(system, b, higher_chain, first.higher_edges, higher_);
  if (first.is_deformable) {
    load_deformed_slopes(scene, a, lower_chain, lower_);
    load_deformed_slopes(scene, b, higher_chain, higher_);
  }
  cut_edges(lower_, higher_, on_lower_);
  cut_edges(higher_, lower_, on_higher_);
  origin_ = lower_.vertex[0];
  integrate();
  const unsigned touching = touches_.by_lane();
  if (touching == 0) {
    return 0;
  }
  const FourLanes strength =
      load_by_lane([&](std::size_t i) { return &candidate[i]->half_stiffness; }); // and what stands behind it
  const LaneVec dashpot = LaneVec::of([&](std::size_t i) { return &candidate[i]->damping; });
  const FourLanes known = load_by_lane([&](std::size_t i) { return &memory[i]->shear; });
  const Constants constants{strength[0],
                            strength[1],
                            strength[2],
                            strength[3],
                            dashpot.x,
                            dashpot.y,
                            scene.damping_ratio,
                            scene.stiffness_damping,
                            Lanes::of([&](std::size_t i) { return was_there[i]; }),
                            known[0],
                            known[1],
                            known[2]};
  force_ = constants.half_stiffness * force_;
  for (Lanes &entry : dyad_) {
    entry = constants.half_stiffness * entry;
  }
  normal_force_ = constants.half_stiffness * normal_force_;
  measure();
  if (first.is_deformable) {
    add_friction_and_dashpots(constants, DeformingMotion(scene, a, b));
  } else {
    add_friction_and_dashpots(constants, RigidMotion(scene, a, b));
  }
  return touching;
}

inline void LaneBatch::store(const Results &results) {
  std::array<std::byte *, num_lanes> to;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    to[i] = reinterpret_cast<std::byte *>(results.force[i] != nullptr ? results.force[i] : &unwanted_);
  }
  const auto put = [&](std::size_t offset, const Lanes &a, const Lanes &b, const Lanes &c, const Lanes &d)
      __attribute__((always_inline)) {
    store_by_lane(to, offset, a, b, c, d);
  };
  const LaneVec shear_force = -elastic_ * perp(normal_);
  put(offsetof(RegionForce, force), force_.x, force_.y, torque_[0], torque_[1]);
  put(offsetof(RegionForce, shear_force), shear_force.x, shear_force.y, shear_torque_[0], shear_torque_[1]);
  put(offsetof(RegionForce, damping_force), damping_force_.x, damping_force_.y, damping_torque_[0],
      damping_torque_[1]);
  put(offsetof(RegionForce, dyad), dyad_[0], dyad_[1], dyad_[2], dyad_[3]);
  put(offsetof(RegionForce, origin), origin_.x, origin_.y, point_.x, point_.y);
  put(offsetof(RegionForce, normal), normal_.x, normal_.y, normal_force_, shear_);
  put(offsetof(RegionForce, cap), cap_, overlap_, select(undefined_, 0.0, extent_begin_),
      select(undefined_, 0.0, extent_end_));
  const unsigned undefined = undefined_.by_lane();
  const unsigned slips = slips_.by_lane();
  for (std::size_t i = 0; i < num_lanes; ++i) {
    if (results.force[i] == nullptr) {
      continue;
    }
    results.force[i]->normal_undefined = (undefined >> i & 1U) != 0;
    RegionMemory &memory = *results.memory[i];
    memory.shear = elastic_[i];
    memory.longest = longest_[i];
    memory.slip = slip_[i];
    memory.state = (slips >> i & 1U) != 0 ? ContactState::slip : ContactState::stick;
  }
}

inline Mat2 LaneBatch::damping_dyad(std::size_t lane) const {
  return {damping_dyad_[0][lane], damping_dyad_[1][lane], damping_dyad_[2][lane], damping_dyad_[3][lane]};
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
