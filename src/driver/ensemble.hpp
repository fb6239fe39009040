#pragma once

// Many members of one scene in one call: each draws its values (model/ensemble.hpp), and runs or is searched
// for its factor of safety. They are dealt to groups of ranks and need nothing of each other. A member is the
// same bits whatever group takes it; its row is on the disk as soon as it is done, so that a call that was
// stopped or killed is gone on with by the same call.

#include "gcpdda/base/exit_code.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gcpdda {

/// The scene with these values, ready to run on this communicator. Collective on it.
/// @throws SceneError where it is no valid one
using MemberScene = std::function<Scene(const Communicator &communicator, const std::vector<double> &values)>;

struct EnsembleOptions {
  std::filesystem::path directory;
  bool overwrite = false;
  std::string identity; ///< text that is the same for ensembles whose members are
};

/// Groups of ranks that compute members at one time.
double copies_in(const Ensemble &ensemble, int ranks);

/// Run what is missing of an ensemble and write `members` and the report. Collective.
/// @return done, stopped (by the signal), or undecided where all members are done and none has an outcome
/// @throws SceneError where the scene says nothing of members, or has no state of rest to search from;
/// FileError
ExitCode run_ensemble(const Communicator &communicator, const Scene &scene, const MemberScene &member_scene,
                      const EnsembleOptions &options);

} // namespace gcpdda
