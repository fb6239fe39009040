#pragma once

// A run from its scene to its result folder.

#include "gcpdda/base/exit_code.hpp"
#include "gcpdda/io/result_manifest.hpp"
#include "gcpdda/io/run_summary.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gcpdda {

/// What the command line says about a run.
struct RunOptions {
  std::filesystem::path directory;
  bool overwrite = false;
  bool restart = false; ///< go on from the newest checkpoint in the folder
  /// A run of its own that begins with the newest checkpoint of this folder; empty for t = 0.
  std::filesystem::path from = {};
  bool quiet = false; ///< the log goes to its file alone
  bool bare = false;  ///< no frames, histories and checkpoints: what the summary says is all that is wanted
  bool once = false;  ///< nobody goes on from it: no checkpoints, and a last frame where the signal stops it
  bool keeps_end = false; ///< but a checkpoint at the end of each stage that takes steps
  /// The scene that the state to begin with was computed with; null: that of the run.
  const Scene *computed_with = nullptr;
  EarlierResults earlier = EarlierResults::must_be_whole; ///< of the run that a restart goes on with
  std::vector<JointSetSummary> joint_sets = {};           ///< of the region, for summary.json; of the root
  std::vector<std::string> words_on_joint_sets = {};      ///< the same for run.log, one string a line
  std::string progress_of = {}; ///< what lines of progress of a quiet run begin with; empty for no such lines
  /// What else the root has to make or to remove once the scene is accepted, before the run writes anything.
  std::function<void()> prepare = {};
};

/// How a run ended.
struct RunOutcome {
  /// done, numerical_failure, stopped (by the signal, with a checkpoint unless RunOptions::once), or
  /// undecided
  ExitCode exit_code = exit_code::done;
  RunSummary summary;
};

/// The same as run_scene() with all that is known of the run. Collective.
RunOutcome run_and_tell(const Communicator &communicator, const Scene &scene, const RunOptions &options);

/// Run a valid scene to its end and write everything, with checkpoints by output.checkpoint_interval and when
/// SIGUSR1 comes (stop_signal.hpp). Collective.
/// @return done, numerical_failure, stopped (by the signal, with a checkpoint), or undecided
/// @throws SceneError, FileError
ExitCode run_scene(const Communicator &communicator, const Scene &scene, const RunOptions &options);

} // namespace gcpdda
