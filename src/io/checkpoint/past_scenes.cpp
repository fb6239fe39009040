
#include "io/checkpoint/past_scenes.hpp"

#include "io/hdf5/durable_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <set>

namespace gcpdda {

namespace {

std::filesystem::path path_of_past_scenes(const std::filesystem::path &directory) {
  return directory / "checkpoints" / "past_scenes.txt";
}

} // namespace

// What is no number is of no scene.
std::vector<std::uint64_t> past_scenes(const std::filesystem::path &directory) {
  std::ifstream stream(path_of_past_scenes(directory));
  std::vector<std::uint64_t> prints;
  for (std::uint64_t print = 0; stream >> std::hex >> print;) {
    prints.push_back(print);
  }
  return prints;
}

void remember_scenes(const std::filesystem::path &directory, const std::vector<std::uint64_t> &prints) {
  const std::vector<std::uint64_t> before = past_scenes(directory);
  std::set<std::uint64_t> all(before.begin(), before.end());
  all.insert(prints.begin(), prints.end());
  std::string text;
  for (const std::uint64_t print : all) {
    text += fmt::format("{:016x}\n", print);
  }
  write_file(path_of_past_scenes(directory), text);
}

} // namespace gcpdda
