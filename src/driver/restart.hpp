#pragma once

// The program `gcpdda restart`: a run goes on from its newest checkpoint.

#include "gcpdda/base/exit_code.hpp"
#include "gcpdda/driver/run.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda {

/// What a changed scene asks of a state that was computed with another one: an error for every change under
/// which the state would mean nothing, or that would do nothing. Where the state was is not looked at.
Diagnostics unfit_changes(const Scene &before, const Scene &after);

/// Go on with the run in a result folder from its newest checkpoint, to the end of the scene. Collective.
///
/// @param before  the scene of the folder
/// @param after   the scene to go on with
/// @param run     what summary.json and run.log are to tell of joint sets, and what holds for histories and
///                frames from before the checkpoint; the rest of it is not looked at
/// @return done (by this call or before), numerical_failure, or stopped (by the signal)
/// @throws SceneError, FileError
ExitCode restart_scene(const Communicator &communicator, const Scene &before, const Scene &after,
                       const std::filesystem::path &directory, RunOptions run = {});

/// Default intervals follow from the duration or the limits: a run that goes on with other settings (--set)
/// keeps those that the settings do not name.
void keep_intervals(const OutputSettings &before, std::vector<std::string> &sets);

} // namespace gcpdda
