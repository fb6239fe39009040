#pragma once

// The program `gcpdda blocks`: cut the region of a scene and tell of its blocks.

#include "gcpdda/driver/run.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <string>

namespace gcpdda {

/// What the command line says of gcpdda blocks.
struct BlocksOptions {
  std::string svg;  ///< picture; empty for none, as below
  std::string json; ///< report for programs
  std::string out;  ///< block file, for [blocks] of another scene
};

/// Reads what the region of a valid scene needs and gives the scene what cuts it. Without a region nothing
/// happens. Collective.
/// @param kept_in  folder of a run that has kept the lines of drawings; empty to convert them
/// @throws SceneError, FileError
void prepare_region(const Communicator &world, Scene &scene, const std::string &kept_in = {});

/// What summary.json and run.log tell of the joint sets of a prepared scene; on the root only.
void tell_joint_sets(const Communicator &world, const Scene &scene, RunOptions &options);

/// Lines of a report on what the joint sets of the region ask and draw; empty without joint sets.
std::string words_on_joint_sets(const Scene &scene);

/// Cuts the region of a prepared scene, checks and draws its blocks and prints a report on the root.
/// Collective.
/// @throws SceneError, FileError, InternalError where the areas of the blocks do not add up to that of the
/// region
void cut_blocks(const Communicator &world, const Scene &scene, const BlocksOptions &options);

} // namespace gcpdda
