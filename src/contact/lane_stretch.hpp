#pragma once

// Edges of convex rigid blocks inside one another, several contacts at a time: what overlap.hpp derives, one
// contact in each lane. Every step is taken by all lanes and counts where it applies, so the bits of a
// contact do not depend on which others are computed with it.

#include "lanes.hpp"

#include "gcpdda/contact/candidates.hpp"

#include <array>

namespace gcpdda {

/// One side of as many contacts as there are lanes: the edges of one block that can take part.
struct LaneSide {
  std::size_t edges = 0;
  std::array<LaneVec, most_plain_edges + 1> vertex; ///< ends of the edges, in order
  std::array<LaneVec, most_plain_edges> normal;
  std::array<Lanes, most_plain_edges> length;
  LaneVec low; ///< corners of the block's box
  LaneVec high;
};

/// Linear depth along part of a stretch.
struct LanePiece {
  Lanes begin; ///< from the begin of the stretch, m
  Lanes length;
  Lanes depth_begin;
  Lanes depth_end;
};

/// The part of an edge inside the other block. Where there is none all lengths and depths are 0.
struct LaneStretch {
  Mask valid;
  LaneVec begin;
  LaneVec end;
  Lanes length;
  Lanes pressure; ///< int d ds, m2
  Lanes moment;   ///< int d s ds, s from `begin`, m3
  Lanes deepest;
  std::size_t num_pieces = 0;
  std::array<LanePiece, most_plain_edges> piece;
};

using LaneStretches = std::array<LaneStretch, most_plain_edges>;

/// The stretches of all edges of `own` inside `other`.
void cut_edges(const LaneSide &own, const LaneSide &other, LaneStretches &stretches);

} // namespace gcpdda
