#pragma once

// Energies of overlaps, many at a time.
//
// That of two corners, V of block A and W of block B, follows from its forces.
//
// Where the two lines of W are the nearest ones of B's boundary, phi_B is homogeneous of degree 1 about W, so
// div(phi_B (x - W)) = 3 phi_B, and by Gauss over the overlap S
//     3 int_S phi_B dA = sum over A's edges in S of (V - W).N_i int phi_B ds,
// since (x - W).N_i is the same all along an edge line through V, and B's own edges have phi_B = 0. Together
// with the same of A, and D = W - V,
//     int_S (phi_A + phi_B) dA = D.f/3,      f = sum N_j int phi_A ds - sum N_i int phi_B ds,
// f the contact force on A for p_n = 1. That is Euler's theorem: scaled by D, without turning, everything is
// scaled alike, and f is the gradient by D. Nothing is cut, nothing cancels, however short D is.

#include "contact/candidates.hpp"
#include "contact/contact_forces.hpp"

#include <memory>
#include <span>
#include <vector>

namespace gcpdda {

/// overlap_energy() (m3), as the blocks are posed, of plain pairs of rigid blocks with no more than
/// most_corner_edges edges: those that overlap with one corner of each, as above, most others as
/// src/contact/lanes/lane_energies.hpp says. Which those are, and every bit, depends on the shapes alone, not
/// on the edges that a refresh leaves in a chain.
class PairEnergies {
public:
  explicit PairEnergies(Instructions instructions = Instructions::widest);
  ~PairEnergies();
  PairEnergies(const PairEnergies &) = delete;
  PairEnergies &operator=(const PairEnergies &) = delete;

  /// Of one PlainPair::group, by number of the pair in it. Not a number for all other pairs.
  std::span<const double> of_group(const BlockSystem &system, const Candidates &candidates,
                                   std::uint32_t group);

private:
  std::unique_ptr<PlainBatch> batch_;
  std::vector<const PlainPair *> corners_;
  std::vector<const PlainPair *> others_;
  std::vector<double> energies_;
};

} // namespace gcpdda
