#pragma once

#include <algorithm>
#include <filesystem>
#include <vector>

namespace gcpdda::restart_test {

/// Everything in the folder of a run's checkpoints, sorted.
inline std::vector<std::filesystem::path> checkpoints(const std::filesystem::path &run) {
  std::vector<std::filesystem::path> found;
  if (std::filesystem::exists(run / "checkpoints")) {
    for (const std::filesystem::directory_entry &entry :
         std::filesystem::directory_iterator(run / "checkpoints")) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

} // namespace gcpdda::restart_test
