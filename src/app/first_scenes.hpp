#pragma once

// Commented scenes that `gcpdda new` writes, for users to begin with.

#include "gcpdda/parallel/communicator.hpp"

#include <string>
#include <vector>

namespace gcpdda {

/// Names of the scenes: slope, tunnel, wall.
std::vector<std::string> first_scene_names();

/// Writes the scene of this name. Collective; throws FileError where something has this path already.
void write_first_scene(const Communicator &world, const std::string &name, const std::string &path);

} // namespace gcpdda
