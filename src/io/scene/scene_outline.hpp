#pragma once

// Outlines of blocks as a scene gives them, checked and made counter-clockwise.

#include "gcpdda/geometry/vec2.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gcpdda::scene_text {

/// What is wrong with the outline of a block, wherever the block comes from.
struct OutlineFault {
  std::optional<std::size_t> vertex; ///< none: the outline as a whole
  std::string what;
  std::string why;
  std::string hint;
};

/// Faults of an outline of at least three finite vertices; one without faults is left counter-clockwise.
/// @param edge_joint  laws of the edges, which turn round with the vertices, or none
/// @param who         how messages call the block
std::vector<OutlineFault> check_outline(std::vector<Vec2> &vertices, std::vector<std::int32_t> &edge_joint,
                                        const std::string &who);
/// The same of an outline whose edges have no laws.
std::vector<OutlineFault> check_outline(std::vector<Vec2> &vertices, const std::string &who);

/// Rounding of coordinates up to `largest`, as a length: what is shorter is no edge.
double coordinate_rounding(double largest);

} // namespace gcpdda::scene_text
