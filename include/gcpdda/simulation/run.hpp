#pragma once

#include "gcpdda/base/diagnostic.hpp"
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

/// Overlaps of the initial configuration: an error for each pair deeper than 5 % of the narrower block's
/// width (two fixed blocks excepted), an info with the deepest of the others. Not collective.
Diagnostics check_initial_overlaps(const Scene &scene);

/// Run a valid scene to its end and write everything. Collective.
/// @return exit code: 0 done, 5 numerical failure
/// @throws SceneError, FileError
int run_scene(const Communicator &communicator, const Scene &scene, const RunOptions &options);

} // namespace gcpdda
