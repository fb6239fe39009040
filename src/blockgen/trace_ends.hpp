#pragma once

// Ends of traces that rounding keeps from the traces at which they end.

#include "blockgen/edge_joints.hpp"
#include "blockgen/planar_graph.hpp"

namespace gcpdda::blockgen {

/// Lines of a few roundings that join the ends of traces to the traces that they miss by rounding. The end
/// of a fault on a slanted outline has coordinates that are rounded: half of such ends fall short of the
/// outline, and a fault that ends in rock cuts nothing. The traces themselves stay, bit by bit, so that they
/// cross others where they do in any other tile. Sides of outlines have no ends.
///
/// @param near      index of the traces
/// @param box       ends beyond it are not looked at
/// @param rounding  of coordinates, m
std::vector<Trace> bridges(const PlanarGraph &graph, std::span<const Trace> traces, const EdgeJoints &near,
                           const Aabb &box, double rounding);

} // namespace gcpdda::blockgen
