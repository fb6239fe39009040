#pragma once

#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <filesystem>
#include <string>

namespace gcpdda {

/// What the command line says about a run.
struct RunOptions {
  std::filesystem::path directory;
  bool overwrite = false;
};

/// Run a valid scene to its end and write everything. Collective.
/// @return exit code: 0 done, 5 numerical failure
/// @throws SceneError, FileError
int run_scene(const Communicator &communicator, const Scene &scene, const RunOptions &options);

} // namespace gcpdda
