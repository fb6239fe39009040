#pragma once

// Blocks that hang together by a narrow neck are cut there.

#include "blockgen/planar_graph.hpp"

#include <vector>

namespace gcpdda::blockgen {

/// A simple ring cut apart where it is no wider than rounding: where a vertex lies on an edge that it is no
/// end of. Two joints that meet on a third one do so up to rounding only; where that falls on the wrong side,
/// the rock on both sides of the third is one face with a neck there, and the block would touch itself.
/// @return rings that begin with their smallest vertex; `ring` as it is where it has no neck
std::vector<Ring> without_necks(const Ring &ring, double rounding);

} // namespace gcpdda::blockgen
