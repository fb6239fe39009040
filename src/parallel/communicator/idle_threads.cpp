#include "parallel/communicator/idle_threads.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <unistd.h>

namespace gcpdda {

namespace {

/// How often each other thread has given its processor away; nothing if one of them runs or waits for a
/// processor.
std::optional<std::string> switches_if_all_sleep() {
  const std::string own = std::to_string(gettid());
  std::string switches;
  std::error_code trouble;
  for (std::filesystem::directory_iterator task("/proc/self/task", trouble), end; !trouble && task != end;
       task.increment(trouble)) {
    if (task->path().filename() == own) {
      continue;
    }
    std::ifstream file(task->path() / "status");
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("State:") && line.find_first_of("RD") != std::string::npos) {
        return std::nullopt;
      }
      if (line.find("ctxt_switches:") != std::string::npos) {
        switches += line;
      }
    }
  }
  return switches;
}

} // namespace

// Threads are looked at one after the other, and may wake each other in between: all of them sleep where a
// second look finds that none has woken since the first.
void wait_for_idle_threads(std::chrono::seconds at_most) {
  const auto deadline = std::chrono::steady_clock::now() + at_most;
  std::optional<std::string> before = switches_if_all_sleep();
  std::optional<std::string> after = switches_if_all_sleep();
  while ((!after.has_value() || before != after) && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    before = after;
    after = switches_if_all_sleep();
  }
}

} // namespace gcpdda
