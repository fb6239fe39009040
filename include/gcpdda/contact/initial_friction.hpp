#pragma once

// Friction at t = 0. Depth and tilt of a resting block are the user's; the stick springs are ours. Starting
// them at zero would let every resting block jump by about mu m g/k_t, so each touching region without
// relative tangential velocity gets the stick force, cut at its cap, that brings its relative tangential
// acceleration to zero; a sliding region starts on the cap. The unknowns couple through the blocks, hence
// damped Jacobi sweeps
//     F += a_t / (n_A w_A + n_B w_B),    w = b_t^T M^-1 b_t,    n = number of contacts of the block
// (undamped sweeps diverge on a pyramid). Both ranks of a border contact sweep it from the same bits.

#include "gcpdda/contact/contact_forces.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

class InitialStick {
public:
  /// Regions with friction among the evaluated pairs; sliding ones are put on their cap at once. The
  /// arguments are to outlive it.
  InitialStick(const BlockSystem &system, const Candidates &candidates, ContactForces &forces,
               ContactHistory &history);

  /// Frictional contacts of each row; correct for owned rows, to be copied to ghosts by the caller.
  [[nodiscard]] std::vector<double> &contact_counts() { return contact_counts_; }
  [[nodiscard]] bool empty() const { return sticking_.empty(); }

  /// Largest change of relative tangential acceleration (m/s2) that a full correction of one region, cut at
  /// its cap, would still make. Accelerations of owned rows and ghosts stand in the system.
  [[nodiscard]] double residual(const BlockSystem &system) const;
  /// One sweep over all sticking regions.
  void sweep(const BlockSystem &system);
  /// Back to no stick force anywhere.
  void reset(const BlockSystem &system);

private:
  struct Region {
    std::size_t number = 0; ///< of the region
    RegionState *memory = nullptr;
    Vec2 tangent;
    Vec2 arm_lower;
    Vec2 arm_higher;
    double cap = 0.0;
    std::size_t lower = 0;
    std::size_t higher = 0;
  };

  /// w of both blocks, 1/kg; 0 of a fixed one.
  struct Yields {
    double lower = 0.0;
    double higher = 0.0;
  };
  static Yields yields_of(const BlockSystem &system, const Region &region);
  static double tangential_acceleration(const BlockSystem &system, const Region &region);
  static double corrected(const Region &region, double change);
  /// Made from its details each time: there are as many as contacts.
  [[nodiscard]] Region region_of(const BlockSystem &system, std::size_t number) const;
  void set_shear(const Region &region, double shear);

  ContactForces &forces_;
  const Candidates &candidates_;
  ContactHistory &history_;
  std::vector<std::uint32_t> sticking_; ///< numbers of regions
  std::vector<double> contact_counts_;
};

} // namespace gcpdda
