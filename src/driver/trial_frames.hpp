#pragma once

// What blocks and joints have done in a trial of a search for the factor of safety, by the frames of the
// settled run and of the trial. Frames are the same on any number of ranks, and so is all of this.

#include "driver/svg.hpp"
#include "gcpdda/model/scene.hpp"
#include "io/results/safety_report.hpp"

#include <filesystem>
#include <vector>

namespace gcpdda {

/// What the picture of a trial shows.
struct DrawnTrial {
  std::vector<FailingBlock> blocks; ///< by BlockId
  FailingJoints joints;
};

/// @param settled       folder of the run that the trial begins with
/// @param trial         folder of the trial, whose frames have contacts
/// @param ignored_area  of blocks that fall by themselves, m^2
/// @throws FileError
DrawnTrial drawn_trial_of(const Scene &scene, const std::filesystem::path &settled,
                          const std::filesystem::path &trial, double ignored_area);

/// Area of the blocks that end farther than a share of their size (the root of their area) from where they
/// began, m^2.
/// @param region  only blocks that began in it count; empty for all
/// @throws FileError
double area_moved_by(double share, const std::vector<Vec2> &region, const std::filesystem::path &settled,
                     const std::filesystem::path &trial);

} // namespace gcpdda
