#pragma once

// The verdict of a trial of gcpdda fos on a part of the blocks: what fails matters.
//
// One loose block at the crest fails long before the slope does. A trial with Stage::ignored_area A or
// Stage::watched_region therefore comes to two verdicts: one on any block, which is that of a trial without
// these (stages.hpp), and one on the mechanism, which is the trial's own.
//
// Watched are blocks whose centroid lay in the region when the trial began. At each look the watched blocks
// that have moved farther than a pile sags are put in order, those that have moved most of their size first.
// The first ones, as many as have together an area of less than A, are left out, wherever they are by then:
// they may fall, bounce and come to rest again. Over the others are taken r, D, T and M, and they are judged
// by the same rules: M is thereby the motion that blocks of the area A have reached together, so that what
// fails is at least so large, and what is smaller cannot fail the slope, in whatever pieces. A block that
// falls also stirs what it hits. The others therefore rest as well where at four looks in a row all blocks
// that are left out or loose (loose_blocks.hpp) have together an area of less than A.
//
// The trial goes on until both verdicts are known, or the mechanism has failed.

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Verdict of the trial at hand by a look at all blocks. Collective.
/// @param look    at all blocks; RunState::looks is at each of them
/// @param of_any  verdict on all of them
Verdict judge_mechanism(RunState &run, const StageLook &look, Verdict of_any);

} // namespace gcpdda
