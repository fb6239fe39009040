#pragma once

// Ends and corners of traces that rounding keeps from the traces on which they lie.

#include "blockgen/edge_joints.hpp"
#include "blockgen/planar_graph.hpp"

namespace gcpdda::blockgen {

/// Lines of a few roundings that join the ends and corners of traces to the traces that they miss by
/// rounding. The end of a fault on a slanted outline has coordinates that are rounded: half of such ends fall
/// short of the outline, and a fault that ends in rock cuts nothing. A fault through the toe of a slope, or
/// the corner of an opening, passes it by rounding on either side: on that of the rock it would not touch the
/// outline. The traces themselves stay, bit by bit, so that they cross others where they do in any other
/// tile.
///
/// @param near      index of the traces
/// @param box       points beyond it are not looked at
/// @param rounding  of coordinates, m
std::vector<Trace> bridges(const PlanarGraph &graph, std::span<const Trace> traces, const EdgeJoints &near,
                           const Aabb &box, double rounding);

} // namespace gcpdda::blockgen
