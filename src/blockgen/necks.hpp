#pragma once

// Blocks that hang together by a narrow neck are cut there.

#include "blockgen/planar_graph.hpp"

#include <span>
#include <vector>

namespace gcpdda::blockgen {

/// A vertex on an edge of a ring, at which the edge has been cut.
struct NeckCut {
  Vec2 from;
  Vec2 to;
  Vec2 vertex;
};

/// A simple ring cut apart where it is no wider than rounding: where a vertex lies on an edge that it is no
/// end of. Two joints that meet on a third one do so up to rounding only; where that falls on the wrong side,
/// the rock on both sides of the third is one face with a neck there, and the block would touch itself.
/// @param cuts  those made are appended, in order
/// @return rings that begin with their smallest vertex; `ring` as it is where it has no neck
std::vector<Ring> without_necks(const Ring &ring, double rounding, std::vector<NeckCut> &cuts);

/// The faces on the other side of the edges that have been cut get the vertices, too: neighbours share whole
/// edges, by which slivers find those to become part of, and two faces become one without a slit.
void share_vertices(std::span<const NeckCut> cuts, std::vector<PlaneFace> &faces);

} // namespace gcpdda::blockgen
