#pragma once

// The values in which two scenes differ, for a restart that changes values.

#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda {

/// A value of a scene that another scene has otherwise.
struct SceneChange {
  std::string
      path; ///< as with --set: "joint.default.cohesion", "stage.dig.relax"; "stage.dig" of a whole stage
  std::string before;      ///< TOML text, or words where the scene does not give the value
  std::string after;       ///< the same of the other scene
  std::int64_t stage = -1; ///< number of the stage that the value belongs to, -1 for none
  /// Numbers of the stages of the other scene whose `set` has this path, ascending.
  std::vector<std::int64_t> set_in{};
};

/// Compare the texts of two resolved scenes: named tables by their names, stages by their positions.
std::vector<SceneChange> changes_between(const std::string &before, const std::string &after);

} // namespace gcpdda
