#include "app/output_paths.hpp"

#include <filesystem>
#include <iostream>
#include <system_error>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

/// Also of files that are not there yet, and through links.
bool are_one_file(const std::string &a, const std::string &b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) {
    return true;
  }
  const auto whole = [](const std::string &path) {
    std::error_code none;
    const fs::path found = fs::weakly_canonical(fs::absolute(path, none), none);
    return none ? fs::path(path).lexically_normal() : found;
  };
  return whole(a) == whole(b);
}

std::string trouble_of(const std::string &scene_file, const Scene &scene,
                       const std::vector<std::pair<std::string, std::string>> &outputs) {
  std::vector<std::pair<std::string, std::string>> taken{
      {"the scene", scene_file},
      {"the block file of the scene", scene.block_file.path},
      {"the record of the earthquake", scene.earthquake.file}};
  for (const JointMap &map : scene.region.maps) {
    taken.emplace_back("a joint map of the scene", map.path);
  }
  for (const auto &[option, path] : outputs) {
    for (const auto &[what, other] : taken) {
      if (!path.empty() && !other.empty() && are_one_file(path, other)) {
        return option + ' ' + path + ": error: this is " + what +
               ", which would be lost, give another file\n";
      }
    }
    taken.emplace_back("the file of " + option, path);
  }
  return {};
}

} // namespace

bool are_files_of_their_own(const Communicator &world, const std::string &scene_file, const Scene &scene,
                            const std::vector<std::pair<std::string, std::string>> &outputs) {
  std::string trouble;
  if (world.is_root()) {
    trouble = trouble_of(scene_file, scene, outputs);
    std::cerr << trouble << std::flush;
  }
  world.broadcast(trouble);
  return trouble.empty();
}

} // namespace gcpdda
