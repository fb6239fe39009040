#pragma once

// What block_lanes.hpp promises, with one block in each lane.

#include "dynamics/lanes/lane_deformable.hpp"
#include "dynamics/lanes/lane_free_deformable.hpp"
#include "dynamics/lanes/lane_pose.hpp"
#include "dynamics/lanes/lane_predict.hpp"
#include "dynamics/lanes/lane_rigid.hpp"

namespace gcpdda::GCPDDA_INSTRUCTIONS {

constexpr BlockLanes blocks{num_lanes,
                            pose_rigid_quads,
                            pose_deformable_quads,
                            step_deformables,
                            step_free_rows,
                            step_free_deformables,
                            predict_rigids,
                            predict_deformables,
                            add_half_works_of_rigids,
                            add_half_works_of_deformables};

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
