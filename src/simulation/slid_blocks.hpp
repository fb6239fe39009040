#pragma once

// Blocks that a settle stage has brought to rest somewhere else than where it found them.
//
// A factor of safety is that of the place where blocks rest, however they came there: a block that slides
// down its plane to a wall while it settles holds there with any strength. The slide of a block in a stage is
//     the motion of the block in the stage, but at most the largest slip of a contact of the block, or
//     all of the motion, where that is a tenth of the size of the block or more.
// Joints that close under weight or stress move whole regions by many times what each of them closes. Such a
// motion slips little, and by itself it is no slide; nor is any motion that is within what the pile may sag
// (largest_sag()), as the slip of columns that sag beside each other: 2 % of a block in a slope of 100 m.
// Slip that goes to and fro is no slide either, since the motion bounds it. The second line counts blocks
// that topple or fall, whose contacts need not slip. What blocks slide once the ground has begun to shake is
// told as permanent displacement (ground.hpp).

#include "simulation/run_state.hpp"

namespace gcpdda {

/// Fills in what the result of the stage at hand says of slides. Of blocks with equal slides, in sizes of
/// them, it names the one with the smallest id. Collective.
void note_slide(const RunState &run, StageResult &result);

} // namespace gcpdda
