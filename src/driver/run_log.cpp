#include "driver/run_log.hpp"

#include <iostream>
#include <unistd.h>
#include <utility>

namespace gcpdda {

RunLog::RunLog(bool speaks, const std::filesystem::path &directory, std::ios::openmode mode, bool quiet,
               std::string progress_of)
    : speaks_(speaks), quiet_(quiet), progress_of_(std::move(progress_of)),
      terminal_(speaks && (!quiet || !progress_of_.empty()) && isatty(STDERR_FILENO) != 0) {
  if (speaks_) {
    file_.open(directory / "run.log", std::ios::out | mode);
  }
}

void RunLog::line(const std::string &text) {
  if (speaks_) {
    end_progress();
    if (!quiet_) {
      std::cerr << text << '\n';
    }
    file_ << text << std::endl;
  }
}

void RunLog::diagnostic(const Diagnostic &diagnostic) {
  line(to_string(diagnostic));
}

bool RunLog::progress_due() const {
  const std::chrono::duration<double> since = Clock::now() - last_progress_;
  return speaks_ && since.count() >= (terminal_ ? 0.2 : 10.0);
}

void RunLog::progress(const std::string &text) {
  last_progress_ = Clock::now();
  if (terminal_) {
    std::cerr << '\r' << progress_of_ << text << "\033[K" << std::flush;
    in_progress_ = true;
    return;
  }
  if (quiet_ && !progress_of_.empty()) {
    std::cerr << progress_of_ << text << std::endl;
  }
  line(text);
}

void RunLog::end_progress() {
  if (in_progress_) {
    std::cerr << '\n';
    in_progress_ = false;
  }
}

} // namespace gcpdda
