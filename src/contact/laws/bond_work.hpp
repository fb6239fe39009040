#pragma once

// A bond of the pair at hand during an evaluation (pair_forces.hpp, bonds.hpp).

#include "contact/laws/bonds.hpp"
#include "contact/pair_forces.hpp"
#include "contact/pair_motion.hpp"

namespace gcpdda {

struct PairForces::BondAtWork {
  RegionMemory memory;
  LawConstants constants; ///< of its law
  double damping = 0.0;   ///< CandidatePair::damping for it
  BondOpening stretched;
  double pull = 0.0;        ///< int k_n max(0, o) ds, N/m
  double pull_moment = 0.0; ///< int k_n max(0, o) s ds, s from the first end, N
  double cap = 0.0;         ///< strength in shear, N/m
  bool broken = false;

  /// Of the dashpots along the normal, on the lower block, at points begin + s along.
  [[nodiscard]] TractionIntegral drag(const RelativeVelocity &velocity, Vec2 along) const;
  [[nodiscard]] Vec2 middle() const { return 0.5 * (stretched.end[0] + stretched.end[1]); }
  [[nodiscard]] std::int32_t lower_edge() const { return -1 - memory.lower_stretch; }
  [[nodiscard]] std::int32_t higher_edge() const { return -1 - memory.higher_stretch; }
};

} // namespace gcpdda
