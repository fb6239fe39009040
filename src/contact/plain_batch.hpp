#pragma once

// Contact forces of plain pairs (candidates.hpp), several at a time. The laws are those of
// contact_forces.hpp, for rigid blocks and one region a pair.

#include "lane_stretch.hpp"

#include "gcpdda/contact/contact_forces.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace gcpdda {

/// What plain pairs are evaluated from.
struct PlainScene {
  const BlockSystem &system;
  const Candidates &candidates;
  const ContactHistory &history;
  std::span<const TrialIncrement> increments;
  double damping_ratio = 0.0;
};

class PlainBatch {
public:
  /// Evaluate up to `num_lanes` entries of Candidates::plain with like numbers of edges.
  void evaluate(const PlainScene &scene, std::span<const std::uint32_t> entries);
  [[nodiscard]] bool touches(std::size_t lane) const { return touches_[lane]; }
  /// Write the result of a lane that touches: all of the force but its pair and its birth, and what of the
  /// memory two convex blocks have.
  void store(std::size_t lane, RegionForce &force, RegionMemory &memory) const;

private:
  struct Constants;
  struct Motion;

  void integrate();
  void measure();
  void add_friction(const Constants &constants, const Motion &motion);
  void add_dashpot(const Constants &constants, const Motion &motion);

  LaneSide lower_;
  LaneSide higher_;
  LaneStretches on_lower_;
  LaneStretches on_higher_;

  // RegionForce and RegionMemory, one in each lane.
  Mask touches_;
  Mask undefined_;
  LaneVec origin_;
  LaneVec force_;
  std::array<Lanes, 4> dyad_;
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
  std::array<Lanes, 4> damping_dyad_;
};

} // namespace gcpdda
