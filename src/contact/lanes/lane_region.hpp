#pragma once

// What is known of the contact regions of as many pairs as there are lanes, once their normal pressure is
// integrated: resultant, friction, dashpots and the torques of it all. The laws are those of
// pair_forces.hpp.

#include "base/lanes.hpp"
#include "contact/lanes/lane_grip.hpp"
#include "contact/lanes/lane_motion.hpp"
#include "contact/lanes/plain_batch.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <span>
#include <type_traits>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// a b^T added by entries xx, xy, yx, yy.
[[gnu::always_inline]] inline void add_outer(FourLanes &dyad, const LaneVec &a, const LaneVec &b) {
  dyad[0] += a.x * b.x;
  dyad[1] += a.x * b.y;
  dyad[2] += a.y * b.x;
  dyad[3] += a.y * b.y;
}

/// int q ds and int q s ds, s from the begin of a stretch.
struct LaneTraction {
  Lanes total;
  Lanes along;

  LaneTraction()
      : total(0.0), along(0.0) {} // written out: an implied one is not compiled for the lanes' instructions

  /// A piece of length L from s0 on with the positive part of a linear g, which is g0 and g1 at its ends:
  /// with a = max(0, g0), b = max(0, g1) and the share l = (a + b)/(|g0| + |g1|) where g > 0, int q ds = l L
  /// (a + b)/2 and int q (s - s0) ds = l L^2 (l a + (3 - l) b)/6, of whatever sign g0 and g1.
  [[gnu::always_inline]] void add_positive(const Lanes &s0, const Lanes &length, const Lanes &a,
                                           const Lanes &b, const Lanes &share) {
    const Lanes part = share * length;
    const Lanes piece = Lanes(0.5) * part * (a + b);
    total += piece;
    along += s0 * piece + part * length * (share * a + (Lanes(3.0) - share) * b) * Lanes(1.0 / 6.0);
  }
};

/// What a pair's law and its past give.
struct LaneConstants {
  Lanes half_stiffness;
  Lanes tangential_stiffness;
  Lanes tan_friction;
  Lanes cohesion;
  Lanes damping;
  Lanes mass;
  Lanes allowed_overlap;
  double damping_ratio;
  double stiffness_damping;
  Mask has_memory;   ///< the region is not new
  Mask is_stretched; ///< the slide of this step stretches its spring
  Lanes shear;
  Lanes longest;
  Lanes slip;

  [[nodiscard]] bool has_dashpots() const { return damping_ratio > 0.0 || stiffness_damping > 0.0; }
};

/// RegionForce and RegionState, one in each lane.
class LaneRegions {
public:
  using Torques = std::array<Lanes, 2>; ///< on the lower and the higher block

  LaneRegions() : max_overlap_(0.0), max_overlap_share_(0.0) {} // written out, as that of LaneTraction

  Mask touches;
  Mask undefined;
  LaneVec origin;

  void start(const LaneVec &about) {
    origin = about;
    force_ = {0.0, 0.0};
    dyad_ = {0.0, 0.0, 0.0, 0.0};
    pressure_ = 0.0;
    pressure_moment_ = {0.0, 0.0};
  }
  /// int d ds along an edge and int d (x - origin) ds, acting on the lower block along `direction`.
  [[gnu::always_inline]] void add_pressure(const Lanes &pressure, const LaneVec &moment,
                                           const LaneVec &direction) {
    force_ += pressure * direction;
    add_outer(dyad_, moment, direction);
    pressure_ += pressure;
    pressure_moment_ += moment;
  }
  [[nodiscard]] Mask has_pressure() const { return pressure_ > 0.0; }
  /// With the pressure whole: direction, size and place of the resultant where `touches`.
  void find_resultant();
  void take_stiffness(const Lanes &half_stiffness);
  /// Of the boundary of the overlap along n_r and t_r from x_r.
  struct Extent {
    Lanes low_n;
    Lanes low_t;
    Lanes high_n;
    Lanes high_t;
  };
  void take_extent(const Extent &extent, const Lanes &deepest, const LaneConstants &constants);
  template <class AnyMotion> void add_friction(const LaneConstants &constants, const AnyMotion &motion);
  /// The traction `total` along n_r with its moment about the origin.
  template <class AnyMotion>
  void add_dashpot(const Lanes &total, const LaneVec &moment, const AnyMotion &motion);
  /// With all forces in place.
  template <class AnyMotion> void find_torques(const AnyMotion &motion);
  void find_dyads(const LaneVec &centroid);
  unsigned store(const PlainResults &results);
  PlainBatch::Extremes take_extremes();

  [[nodiscard]] const LaneVec &point() const { return point_; }
  [[nodiscard]] const LaneVec &normal() const { return normal_; }
  [[nodiscard]] const Lanes &normal_force() const { return normal_force_; }
  [[nodiscard]] double overlap(std::size_t lane) const { return overlap_[lane]; }

private:
  LaneGrip find_grip(const LaneConstants &constants, const DeformingMotion &motion, const LaneVec &tangent,
                     const Lanes &extent) const;
  [[gnu::always_inline]] LaneNoGrip find_grip(const LaneConstants &, const RigidMotion &, const LaneVec &,
                                              const Lanes &) const {
    return LaneNoGrip(point_);
  }

  using Places = std::array<std::byte *, num_lanes>;
  template <class Part>
  static Places places(const PlainResults &results, const std::array<Part *, most_lanes> &wanted,
                       Part &unwanted);
  void store_details(const PlainResults &results);
  void store_dyads(const PlainResults &results);

  LaneVec force_;
  FourLanes dyad_;
  Lanes pressure_;
  LaneVec pressure_moment_;
  LaneVec point_;
  LaneVec normal_;
  Lanes normal_force_;
  Lanes overlap_;
  Lanes overlap_share_; ///< of the narrowest width
  Lanes extent_begin_;
  Lanes extent_end_;
  Lanes longest_;
  Lanes elastic_;
  Lanes shear_;
  Lanes slip_;
  Lanes cap_;
  Mask slips_;
  LaneVec grip_;           ///< where friction acts
  LaneVec reference_grip_; ///< the same in the axes of ContactHistory::grips, where a block deforms
  LaneVec damping_force_;
  FourLanes damping_dyad_;               ///< this and the next of pairs with a deformable block
  std::array<FourLanes, 3> on_gradient_; ///< RegionDyads
  Torques torque_;
  Torques shear_torque_;
  Torques damping_torque_;
  Lanes max_overlap_; ///< so far
  Lanes max_overlap_share_;
  std::int64_t normals_undefined_ = 0;
  // Take what lanes write that no one asks.
  RegionSums unwanted_sums_;
  RegionState unwanted_memory_;
  RegionDetails unwanted_details_;
  RegionDyads unwanted_dyads_;
  Vec2 unwanted_grip_;
};

inline void LaneRegions::find_resultant() {
  const Lanes resultant = sqrt(dot(force_, force_));
  undefined = touches & (resultant <= Lanes(least_resultant) * pressure_);
  const Mask defined = touches & !undefined;
  const Lanes whole = select(touches, pressure_, 1.0);
  point_ = origin + LaneVec{pressure_moment_.x / whole, pressure_moment_.y / whole};
  normal_force_ = resultant;
  const Lanes inverse = Lanes(1.0) / select(defined, resultant, 1.0);
  normal_ = select(defined, inverse * force_, LaneVec{0.0, 0.0});
}

inline void LaneRegions::take_stiffness(const Lanes &half_stiffness) {
  force_ = half_stiffness * force_;
  for (Lanes &entry : dyad_) {
    entry = half_stiffness * entry;
  }
  normal_force_ = half_stiffness * normal_force_;
}

inline void LaneRegions::take_extent(const Extent &extent, const Lanes &deepest,
                                     const LaneConstants &constants) {
  overlap_ = select(undefined, Lanes(2.0) * deepest, min(extent.high_n - extent.low_n, Lanes(4.0) * deepest));
  extent_begin_ = extent.low_t;
  extent_end_ = extent.high_t;
  overlap_share_ = Lanes(0.5) * overlap_ / constants.allowed_overlap;
}

[[gnu::always_inline]] inline LaneGrip LaneRegions::find_grip(const LaneConstants &constants,
                                                              const DeformingMotion &motion,
                                                              const LaneVec &tangent,
                                                              const Lanes &extent) const {
  const Mask is_new = (!constants.has_memory) | (extent > constants.longest);
  return {motion, point_, tangent, extent_begin_, extent_end_, is_new};
}

template <class AnyMotion>
void LaneRegions::add_friction(const LaneConstants &constants, const AnyMotion &motion) {
  const LaneVec tangent = perp(normal_);
  const Lanes extent = extent_end_ - extent_begin_;
  const Mask defined = touches & !undefined;
  longest_ = select(defined, max(constants.longest, extent), constants.longest);
  cap_ = select(defined, normal_force_ * constants.tan_friction + constants.cohesion * extent, 0.0);
  const Mask holds = cap_ > 0.0;
  slips_ = !holds;
  const Lanes stiffness = constants.tangential_stiffness * longest_;
  auto grip = find_grip(constants, motion, tangent, extent);
  grip.move_to_middle(slips_);
  grip_ = grip.point();
  const LaneVec slide = motion.slide_at(grip_);
  Lanes shear = select(constants.is_stretched & holds, constants.shear + stiffness * dot(slide, tangent),
                       constants.shear);
  const Mask breaks = holds & (abs(shear) > cap_);
  slips_ = slips_ | breaks;
  slip_ = select(breaks, constants.slip + (abs(shear) - cap_) / stiffness, constants.slip);
  grip.slip(breaks, abs(shear) - cap_, cap_);
  grip_ = grip.point();
  reference_grip_ = grip.reference();
  shear = select(breaks, select(shear < 0.0, -cap_, cap_), shear);
  elastic_ = select(holds, shear, 0.0);
  Lanes viscous = 0.0;
  if (constants.has_dashpots()) {
    const LaneVec velocity = motion.velocity_at(grip_);
    const Lanes drag = (Lanes(2.0 * constants.damping_ratio) * sqrt(stiffness * constants.mass) +
                        Lanes(constants.stiffness_damping) * stiffness) *
                       dot(velocity, tangent);
    viscous = select(holds, clamp(elastic_ + drag, -cap_, cap_) - elastic_, 0.0);
  }
  shear_ = elastic_ + viscous;
  const LaneVec friction = -shear_ * tangent;
  force_ += friction;
  add_outer(dyad_, grip_ - origin, friction);
  // A force along t_r has the same torque at x_r and at the grip.
  const Lanes lower_lever = cross(point_ - motion.lower_centroid, tangent);
  const Lanes higher_lever = cross(point_ - motion.higher_centroid, tangent);
  shear_torque_ = {-elastic_ * lower_lever, elastic_ * higher_lever};
  damping_torque_ = {-viscous * lower_lever, viscous * higher_lever};
  damping_force_ = -viscous * tangent;
  if constexpr (std::is_same_v<AnyMotion, DeformingMotion>) {
    damping_dyad_ = {0.0, 0.0, 0.0, 0.0};
    add_outer(damping_dyad_, grip_ - origin, damping_force_);
  }
}

template <class AnyMotion>
void LaneRegions::add_dashpot(const Lanes &total, const LaneVec &moment, const AnyMotion &motion) {
  const LaneVec push = total * normal_;
  force_ += push;
  add_outer(dyad_, moment, normal_);
  damping_force_ += push;
  if constexpr (std::is_same_v<AnyMotion, DeformingMotion>) {
    add_outer(damping_dyad_, moment, normal_);
  }
  const Lanes about_origin = cross(moment, normal_);
  damping_torque_[0] += about_origin + cross(origin - motion.lower_centroid, push);
  damping_torque_[1] += -about_origin - cross(origin - motion.higher_centroid, push);
}

template <class AnyMotion> void LaneRegions::find_torques(const AnyMotion &motion) {
  const Lanes about_origin = dyad_[1] - dyad_[2];
  torque_[0] = about_origin + cross(origin - motion.lower_centroid, force_);
  torque_[1] = -about_origin - cross(origin - motion.higher_centroid, force_);
  if constexpr (std::is_same_v<AnyMotion, DeformingMotion>) {
    find_dyads(motion.lower_centroid);
  }
}

inline void LaneRegions::find_dyads(const LaneVec &centroid) {
  const LaneVec arm = origin - centroid;
  on_gradient_ = {dyad_, {0.0, 0.0, 0.0, 0.0}, damping_dyad_};
  add_outer(on_gradient_[0], arm, force_);
  add_outer(on_gradient_[1], grip_ - centroid, -elastic_ * perp(normal_));
  add_outer(on_gradient_[2], arm, damping_force_);
}

/// RegionState's law, the only one a pair can have, and state in the place of one number.
constexpr double only_law_and(ContactState state) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(state) << 32U | 0xffffffffU);
}

template <class Part>
[[gnu::always_inline]] inline LaneRegions::Places
LaneRegions::places(const PlainResults &results, const std::array<Part *, most_lanes> &wanted,
                    Part &unwanted) {
  Places to;
  for (std::size_t i = 0; i < num_lanes; ++i) {
    const bool is_wanted = (results.wanted >> i & 1U) != 0;
    to[i] = reinterpret_cast<std::byte *>(is_wanted ? wanted[i] : &unwanted);
  }
  return to;
}

inline void LaneRegions::store_details(const PlainResults &results) {
  const Places known = places(results, results.details, unwanted_details_);
  store_by_lane(known, offsetof(RegionDetails, dyad), dyad_[0], dyad_[1], dyad_[2], dyad_[3]);
  store_by_lane(known, offsetof(RegionDetails, origin), origin.x, origin.y, point_.x, point_.y);
  store_by_lane(known, offsetof(RegionDetails, normal), normal_.x, normal_.y, normal_force_, shear_);
  store_by_lane(known, offsetof(RegionDetails, cap), cap_, overlap_, select(undefined, 0.0, extent_begin_),
                select(undefined, 0.0, extent_end_));
  store_pairs(known, offsetof(RegionDetails, grip), grip_.x, grip_.y);
  const unsigned cancels = undefined.by_lane();
  for_bits(results.wanted,
           [&](std::size_t i) { results.details[i]->normal_undefined = (cancels >> i & 1U) != 0; });
}

inline void LaneRegions::store_dyads(const PlainResults &results) {
  static_assert(sizeof(RegionDyads) == 3 * sizeof(Mat2));
  const Places known = places(results, results.dyads, unwanted_dyads_);
  for (std::size_t k = 0; k < 3; ++k) {
    const FourLanes &m = on_gradient_[k];
    store_by_lane(known, k * sizeof(Mat2), m[0], m[1], m[2], m[3]);
  }
  store_pairs(places(results, results.grips, unwanted_grip_), 0, reference_grip_.x, reference_grip_.y);
}

inline unsigned LaneRegions::store(const PlainResults &results) {
  const Places sums = places(results, results.sums, unwanted_sums_);
  const LaneVec shear_force = -elastic_ * perp(normal_);
  store_by_lane(sums, offsetof(RegionSums, force), force_.x, force_.y, torque_[0], torque_[1]);
  store_by_lane(sums, offsetof(RegionSums, shear_force), shear_force.x, shear_force.y, shear_torque_[0],
                shear_torque_[1]);
  store_by_lane(sums, offsetof(RegionSums, damping_force), damping_force_.x, damping_force_.y,
                damping_torque_[0], damping_torque_[1]);
  static_assert(offsetof(RegionState, law) == 3 * sizeof(double) &&
                offsetof(RegionState, state) == offsetof(RegionState, law) + sizeof(std::int32_t) &&
                sizeof(RegionState) == 4 * sizeof(double) && std::endian::native == std::endian::little);
  store_by_lane(
      places(results, results.memory, unwanted_memory_), offsetof(RegionState, shear), elastic_, longest_,
      slip_,
      select(slips_, Lanes(only_law_and(ContactState::slip)), Lanes(only_law_and(ContactState::stick))));
  const Mask wanted = Mask::from(results.wanted);
  max_overlap_ = select(wanted, max(max_overlap_, overlap_), max_overlap_);
  max_overlap_share_ = select(wanted, max(max_overlap_share_, overlap_share_), max_overlap_share_);
  normals_undefined_ += std::popcount(undefined.by_lane() & results.wanted);
  if (results.has_details) {
    store_details(results);
  }
  if (results.has_dyads) {
    store_dyads(results);
  }
  return (wanted & (overlap_share_ > 0.5)).by_lane();
}

inline PlainBatch::Extremes LaneRegions::take_extremes() {
  PlainBatch::Extremes extremes{normals_undefined_};
  for (std::size_t i = 0; i < num_lanes; ++i) {
    extremes.max_overlap = max_overlap_[i] > extremes.max_overlap ? max_overlap_[i] : extremes.max_overlap;
    extremes.max_overlap_share = max_overlap_share_[i] > extremes.max_overlap_share
                                     ? max_overlap_share_[i]
                                     : extremes.max_overlap_share;
  }
  normals_undefined_ = 0;
  max_overlap_ = 0.0;
  max_overlap_share_ = 0.0;
  return extremes;
}

/// Damping traction along n_r of as many stretches as follow one another: q = max(-p, d), that is d and the
/// positive part of -(p + d), with the pressure p >= 0 that can be released and the dashpot's linear d.
class LaneDashpot {
public:
  template <class AnyMotion>
  LaneDashpot(const LaneRegions &regions, const LaneConstants &constants, const Lanes &facing_pressure,
              const AnyMotion &motion)
      : total(0.0), moment{0.0, 0.0}, constants_(constants),
        velocity_(dot(motion.velocity_at(regions.origin), regions.normal())),
        velocity_change_(motion.velocity_change_along(regions.normal())),
        releasable_(min(constants.half_stiffness,
                        regions.normal_force() / select(facing_pressure > 0.0, facing_pressure, 1.0))) {}

  Lanes total;
  LaneVec moment; ///< about the origin

  /// A stretch from `begin` (from the origin) on along `direction` with the share w of its normal along n_r.
  template <class Pieces>
  [[gnu::always_inline]] void add(const LaneVec &begin, const LaneVec &direction, const Pieces &pieces,
                                  const Lanes &share) {
    const Lanes &length = pieces.length;
    const Lanes rate = constants_.damping * share;
    const Lanes closing = -rate * (velocity_ + dot(velocity_change_, begin));
    const Lanes slope = -rate * dot(velocity_change_, direction);
    LaneTraction q;
    q.total = Lanes(0.5) * length * (Lanes(2.0) * closing + slope * length);
    q.along = length * length * (Lanes(3.0) * closing + Lanes(2.0) * slope * length) * Lanes(1.0 / 6.0);
    if (((closing < 0.0) | (closing + slope * length < 0.0)).any()) { // else nothing pulls
      add_excess(pieces, releasable_ * share, closing, slope, q);
    }
    total += q.total;
    moment += q.total * begin + q.along * direction;
  }

private:
  /// Of -(p + d): the first two pieces by one division; there are seldom more.
  template <class Pieces>
  [[gnu::always_inline]] static void add_excess(const Pieces &pieces, const Lanes &releasable,
                                                const Lanes &closing, const Lanes &slope, LaneTraction &q) {
    struct End {
      Lanes s;
      Lanes g;
      Lanes positive;
    };
    const auto end = [&](std::size_t k) __attribute__((always_inline)) {
      const Lanes s = pieces.start(k);
      const Lanes g = -(releasable * pieces.depth(k) + (closing + slope * s));
      return End{s, g, max(0.0, g)};
    };
    const auto whole = [](const End &a, const End &b) __attribute__((always_inline)) {
      constexpr double least = 1e-100; // no traction, and its square is not 0
      return max(least, abs(a.g) + abs(b.g));
    };
    const auto add = [&](const End &a, const End &b, const Lanes &inverse) __attribute__((always_inline)) {
      q.add_positive(a.s, b.s - a.s, a.positive, b.positive, (a.positive + b.positive) * inverse);
    };
    if (pieces.count() == 0) {
      return;
    }
    const End begin = end(0);
    const End middle = end(1);
    End last = end(2);
    const Lanes first = whole(begin, middle);
    const Lanes second = whole(middle, last);
    const Lanes inverse = Lanes(1.0) / (first * second);
    add(begin, middle, inverse * second);
    add(middle, last, inverse * first);
    for (std::size_t k = 2; k < pieces.count(); ++k) {
      const End next = end(k + 1);
      if ((next.s > last.s).any()) {
        add(last, next, Lanes(1.0) / whole(last, next));
      }
      last = next;
    }
  }

  const LaneConstants &constants_;
  Lanes velocity_;          ///< along n_r at the origin, of the lower block against the higher one
  LaneVec velocity_change_; ///< by that dotted into the way from there
  Lanes releasable_;        ///< over the depth at w = 1, Pa/m
};

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
