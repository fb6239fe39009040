// SIGUSR1 while the program starts: it is remembered until the first step.

#include "child_process.hpp"
#include "support/plane_failure.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

namespace gcpdda::early_signal_test {
namespace {

namespace fs = std::filesystem;
using testing::gcpdda_words;
using testing::Outcome;
using testing::Process;
using testing::run_gcpdda;
using testing::WorkFolder;

/// True from the middle of MPI_Init, which starts threads, until the process has ended.
bool has_threads(pid_t process) {
  const fs::path tasks = fs::path("/proc") / std::to_string(process) / "task";
  std::error_code error;
  const fs::directory_iterator begin(tasks, error);
  return !error && std::distance(begin, fs::directory_iterator()) > 1;
}

class EarlySignal : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(EarlySignal, StopsInAStateThatCanBeRead) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::plane_failure_toml(0.0));
  Process process(gcpdda_words(0, GetParam()), folder.path());
  process.wait_until([&] { return has_threads(process.id()); });
  kill(process.id(), SIGUSR1);
  const Outcome stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 6) << stopped.err;
  const bool is_run = GetParam().front() == "run";
  std::vector<std::string> next = GetParam();
  next = is_run ? std::vector<std::string>{"restart", "o"} : next;
  if (GetParam().front() == "fos") {
    next.push_back("--overwrite");
  }
  const Outcome after = run_gcpdda(0, next, folder);
  EXPECT_EQ(after.exit_code, 0) << after.err;
}

INSTANTIATE_TEST_SUITE_P(
    Commands, EarlySignal,
    ::testing::Values(std::vector<std::string>{"run", "plane.toml", "--out", "o"},
                      std::vector<std::string>{"fos", "plane.toml", "--from", "0.8", "--to", "2.5",
                                               "--tolerance", "0.3", "--out", "o"},
                      std::vector<std::string>{"ensemble", "plane.toml", "--count", "3", "--out", "o"}),
    [](const auto &row) { return row.param.front(); });

} // namespace
} // namespace gcpdda::early_signal_test
