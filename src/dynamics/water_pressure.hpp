#pragma once

// What water does to a block. Below the phreatic line h(x) it presses on every edge it wets with
//     p = rho_w g (h(x) - y),
// normal to the edge, on either face of a joint and on free faces alike. It needs no coupling with contacts:
// the water in a joint pushes its two blocks apart, so the overlap between them carries what the water does
// not, which is the effective normal force, and the friction cap is that of the effective force by itself.
// A block with water all around has its buoyancy, by Gauss' theorem.
//
// The head along a joint is that of the phreatic line above it, not that of a flow through the joint: a line
// that falls straight from the level in a tension crack to the toe of a slide gives the triangle of uplift
// that Hoek and Bray assume on its plane.
//
// Settle stages and trials of a search for the factor of safety ask whether blocks rest under the water that
// presses them where they are. There p is that of where each point of a block was when the stage began,
// normal to the edge as it lies: a block that slides keeps its pressure, as in limit equilibrium, and finds
// no hold by leaving the line behind. (With p where it is, slides with a filled tension crack held at 1.30 in
// place of 1.145, a tenth of their size farther.)
//
// A table with a list of laws wets the stretches of edges that face a contact of such a law at the start, on
// both faces whichever of them names the law, and the other edges that name it themselves
// (contact/start_contacts.hpp). Stretches are shares of an edge: they move and deform with it.
//
// Along an edge p is linear between the points of the line and where it vanishes; the integrals are exact for
// the edges as they lie in the trial configuration.

#include "gcpdda/model/water.hpp"
#include "model/block_system.hpp"

#include <cstddef>
#include <span>

namespace gcpdda {

/// Resultant of the water around one block.
struct WaterLoad {
  Vec2 force; ///< N/m
  Mat2 dyad;  ///< int t (x - x_c)^T ds about the trial centroid, t the traction, N

  [[nodiscard]] double torque() const { return dyad.yx - dyad.xy; }
};

/// visit(k, begin, end) for each stretch that a table wets if it lies below the line: edge k from one share
/// of its length to another one, ascending. Stretches that meet are one.
template <class Visit>
void for_wet_stretches(const BlockSystem &system, std::size_t row, const Water &water, Visit &&visit) {
  const std::span<const std::int32_t> joints = system.edge_joints(row);
  const std::span<const WaterStretch> stretches =
      water.joints.empty() ? std::span<const WaterStretch>() : system.water_stretches(row);
  std::size_t next = 0;
  for (std::size_t k = 0; k < system.num_vertices(row); ++k) {
    const auto is_on_edge = [&](std::size_t i) {
      return i < stretches.size() && static_cast<std::size_t>(stretches[i].edge) == k;
    };
    if (!is_on_edge(next)) {
      if (water.wets(joints.empty() ? -1 : joints[k])) {
        visit(k, 0.0, 1.0);
      }
      continue;
    }
    while (is_on_edge(next)) {
      if (!water.wets(stretches[next].law)) {
        ++next;
        continue;
      }
      const double begin = stretches[next].begin;
      while (is_on_edge(next + 1) && water.wets(stretches[next + 1].law)) {
        ++next;
      }
      visit(k, begin, stretches[next].end);
      ++next;
    }
  }
}

/// @param gravity  downwards acceleration, m/s2
/// @param from  displacement of the row (m, and its angle) where the line is looked up; null: where it is
/// @param outline  place for the row's outline
WaterLoad water_load(const BlockSystem &system, std::size_t row, std::span<const Water> water, double gravity,
                     const RigidDof *from, TrialOutline &outline);

} // namespace gcpdda
