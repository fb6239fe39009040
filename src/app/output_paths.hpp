#pragma once

// Files that a call writes beside what it reads.

#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <string>
#include <utility>
#include <vector>

namespace gcpdda {

/// Whether every output of a call is a file of its own: none is the scene file, a file that the scene names,
/// or another output of the call. The root says on standard error what is not. Collective.
/// @param outputs  option and path; an empty path is no output
bool are_files_of_their_own(const Communicator &world, const std::string &scene_file, const Scene &scene,
                            const std::vector<std::pair<std::string, std::string>> &outputs);

} // namespace gcpdda
