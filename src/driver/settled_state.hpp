#pragma once

// The state of rest from which all trials of a search for the factor of safety begin.

#include "driver/safety_factor.hpp"
#include "gcpdda/base/exit_code.hpp"
#include "gcpdda/driver/run.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "io/results/safety_report.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gcpdda {

/// Tells users what a search does: root alone, on standard error, and nothing where it is quiet.
void say(const Communicator &world, const SafetyOptions &options, const std::string &text);

/// Outlived by the communicator, the scene and the options.
class SettledState {
public:
  SettledState(const Communicator &world, const Scene &scene, const SafetyOptions &options)
      : world_(world), scene_(scene), options_(options) {}

  /// Let the blocks settle with full strength, or where they do not come to rest so, with the most that is
  /// tried; or take the state of options.settled. A scene that is refused, or a state that cannot be taken,
  /// leaves no folder behind and removes nothing. Collective.
  ///
  /// @param prepare  makes the folder of the search, on the root
  /// @return done; undecided: the blocks do not rest, see message(); or why the run has ended
  ExitCode find(const std::function<void()> &prepare);

  /// The run up to the state, or the last one that did not come there.
  [[nodiscard]] const StrengthTrial &run() const { return run_; }
  [[nodiscard]] std::filesystem::path directory() const;
  /// Of its settle stages, what users are told.
  [[nodiscard]] const std::vector<EarlierSlide> &slides() const { return slides_; }
  /// Largest slide of a block in one of them, in sizes of it.
  [[nodiscard]] double slide() const { return slide_; }
  [[nodiscard]] double end_time() const { return end_time_; } ///< s
  [[nodiscard]] std::int64_t num_blocks() const { return num_blocks_; }
  /// The factor at which blocks have failed on the way.
  [[nodiscard]] std::optional<double> fails() const { return fails_; }
  [[nodiscard]] bool has_failed() const { return run_.verdict == Verdict::failed; }
  /// Why there is no state; empty where there is one.
  [[nodiscard]] const std::string &message() const { return message_; }

private:
  ExitCode settle_as_it_can(const std::function<void()> &prepare);
  ExitCode settle(double factor, bool overwrite, const std::function<void()> &prepare);
  ExitCode take();
  void note_slides(const std::vector<RunSummary::StageLine> &stages);
  void note_failure();
  [[nodiscard]] bool has_settled() const { return run_.verdict == Verdict::settled; }

  const Communicator &world_;
  const Scene &scene_;
  const SafetyOptions &options_;
  StrengthTrial run_;
  std::vector<EarlierSlide> slides_;
  double slide_ = 0.0;
  double end_time_ = 0.0;
  std::int64_t num_blocks_ = 0;
  std::optional<double> fails_;
  std::string message_;
};

} // namespace gcpdda
