#pragma once

// Edges of two blocks that lie on each other at t = 0, and what they share.

#include "contact/candidates.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace gcpdda {

/// Edges lie on each other where they are no farther apart than this share of the length they share.
constexpr double coincidence = 1e-3;

/// What two edges share at t = 0.
struct SharedStretch {
  std::array<Vec2, 2> lower_ends;  ///< X of the ends on the lower block's edge, in its order, m
  std::array<Vec2, 2> higher_ends; ///< of the points opposite
  std::array<double, 2> gap{};     ///< between them along the normal, m
  Vec2 normal;                     ///< outward of the lower block, at t = 0
  double length = 0.0;             ///< m
};

/// Of two edges that face each other over some length, near or far.
std::optional<SharedStretch> shared_stretch(const BlockSystem &system, const CandidatePair &pair,
                                            std::int32_t lower_edge, std::int32_t higher_edge);

/// Whether they lie on each other.
/// @param pressed  overlap that a stress in the rock has given them (in_situ.hpp), m
bool lie_on_each_other(const SharedStretch &shared, double pressed);

/// Calls visit(lower_edge, higher_edge, shared) for each two edges that lie on each other, in the order of
/// the edges.
/// @param pair  its two rows are enough
template <class Visit>
void for_touching_edges(const BlockSystem &system, const CandidatePair &pair, double pressed, Visit visit) {
  constexpr double opposite = -0.9; // of the two normals; edges that lie on each other come far below
  const auto lower_normals = system.of_row(system.reference_normal, pair.lower.value);
  const auto higher_normals = system.of_row(system.reference_normal, pair.higher.value);
  for (std::size_t a = 0; a < lower_normals.size(); ++a) {
    for (std::size_t b = 0; b < higher_normals.size(); ++b) {
      if (dot(lower_normals[a], higher_normals[b]) > opposite) {
        continue;
      }
      const auto lower_edge = static_cast<std::int32_t>(a);
      const auto higher_edge = static_cast<std::int32_t>(b);
      const auto shared = shared_stretch(system, pair, lower_edge, higher_edge);
      if (shared && lie_on_each_other(*shared, pressed)) {
        visit(lower_edge, higher_edge, *shared);
      }
    }
  }
}

} // namespace gcpdda
