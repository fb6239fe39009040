#pragma once

// Friction at t = 0. Depth and tilt of a resting block are the user's; the stick springs are ours. Starting
// them at zero would let every resting block jump by about mu m g/k_t, so each touching region without
// relative tangential velocity gets the stick force, cut at its cap, that brings its relative tangential
// acceleration to zero; a sliding region starts on the cap. The unknowns couple through the blocks, hence
// damped Jacobi sweeps
//     F += a_t / (n_A w_A + n_B w_B),    w = b_t^T M^-1 b_t,    n = number of contacts of the block
// (undamped sweeps diverge on a pyramid). Both ranks of a border contact sweep it from the same bits.
//
// Bonds take part where the loads act at once. A run that begins with the static solver lets them in by
// parts: a bond that began with all the shear would keep what joints bear that close under the weight.

#include "contact/contact_forces.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

class InitialStick {
public:
  /// Regions with friction among the evaluated pairs; sliding ones are put on their cap at once. The
  /// arguments are to outlive it. Whenever shear has changed, here and below, sums of contacts are to be
  /// finished once more.
  /// @param with_bonds  else they begin without shear
  InitialStick(const BlockSystem &system, const Candidates &candidates, ContactForces &forces,
               ContactHistory &history, bool with_bonds);

  /// Frictional contacts of each row; correct for owned rows, to be copied to ghosts by the caller.
  [[nodiscard]] std::vector<double> &contact_counts() { return contact_counts_; }

  /// One sweep over all sticking regions, from accelerations of owned rows and ghosts in the system.
  /// @return largest change of relative tangential acceleration (m/s2) that a full correction of one region,
  /// cut at its cap, would have made; if zero, nothing has changed
  double sweep();
  /// Back to no stick force anywhere.
  void reset();

private:
  using Region = ContactForces::ShearToSet;
  /// Relative velocity along the tangent, m/s; 0 up to rounding.
  [[nodiscard]] double sliding_of(const Region &region) const;
  /// Whether it can bear shear. A region without extent along its tangent (faces that coincide up to
  /// rounding) has no spring yet.
  [[nodiscard]] bool takes_part(const Region &region) const;
  [[nodiscard]] bool sticks(const Region &region) const;
  /// Give change(region) to all that stick.
  template <class Change> void change_sticking(Change &&change);
  /// w of both blocks, 1/kg; 0 of a fixed one.
  struct Yields {
    double lower = 0.0;
    double higher = 0.0;
  };
  [[nodiscard]] Yields yields_of(const Region &region) const;
  [[nodiscard]] double tangential_acceleration(const Region &region) const;
  static double corrected(const Region &region, double change);

  const BlockSystem &system_;
  const Candidates &candidates_;
  ContactForces &forces_;
  ContactHistory &history_;
  bool with_bonds_;
  std::vector<double> contact_counts_;
};

} // namespace gcpdda
