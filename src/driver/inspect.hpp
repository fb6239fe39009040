#pragma once

// The program `gcpdda inspect`: what a scene will take and what it will do, without a run.

#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <filesystem>
#include <string>

namespace gcpdda {

/// What the command line says about an inspection.
struct InspectOptions {
  int ranks = 0;             ///< subdomains to report; 0 means as many as there are ranks
  std::filesystem::path svg; ///< picture of blocks and subdomains; empty for none
};

/// Everything a person wants to know of a valid scene before running it, as text for the root: blocks and
/// kinds and why, stiffness, step and what limits it, memory, predicted run time and output size, subdomains,
/// oddities of the geometry. Steps a few times in memory; writes nothing but the picture. Collective.
/// @throws SceneError, FileError
std::string inspect_scene(const Communicator &communicator, const Scene &scene,
                          const InspectOptions &options);

} // namespace gcpdda
