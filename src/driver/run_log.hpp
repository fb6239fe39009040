#pragma once

// The log of a run: on the terminal and in run.log.

#include "gcpdda/base/diagnostic.hpp"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace gcpdda {

/// The root's voice: lines to stderr and run.log; on a terminal a progress line that is overwritten. Silent
/// on other ranks.
class RunLog {
public:
  /// @param mode  std::ios::trunc, or std::ios::app to go on with an earlier run.log
  /// @param quiet  nothing to stderr ...
  /// @param progress_of  ... but progress, which begins with this there; empty for none
  RunLog(bool speaks, const std::filesystem::path &directory, std::ios::openmode mode, bool quiet = false,
         std::string progress_of = {});

  void line(const std::string &text);
  void diagnostic(const Diagnostic &diagnostic);
  /// A progress line: at most every 0.2 s on a terminal, every 10 s elsewhere.
  [[nodiscard]] bool progress_due() const;
  void progress(const std::string &text);

private:
  using Clock = std::chrono::steady_clock;
  void end_progress();

  bool speaks_;
  bool quiet_;
  std::string progress_of_;
  bool terminal_;
  bool in_progress_ = false;
  std::ofstream file_;
  Clock::time_point last_progress_ = Clock::now();
};

} // namespace gcpdda
