#include "app/root_file.hpp"

#include "base/check.hpp"
#include "base/input_file.hpp"

#include <fstream>
#include <utility>

namespace gcpdda {

std::string read_on_root(const Communicator &world, const std::string &path, const std::string &who,
                         std::int64_t most_bytes) {
  std::string text;
  std::string trouble;
  if (world.is_root()) {
    InputFile file = read_input_file(path, most_bytes);
    if (!file.trouble.empty()) {
      trouble = path + ": error: cannot open " + who + ", " + file.trouble + ", check the path";
    }
    text = std::move(file.text);
  }
  world.broadcast(trouble);
  if (!trouble.empty()) {
    throw FileError(trouble);
  }
  world.broadcast(text);
  return text;
}

void write_on_root(const Communicator &world, const std::string &path, const std::string &text,
                   const std::string &who) {
  std::string trouble;
  if (world.is_root()) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    trouble = file ? "" : path + ": error: cannot write " + who + ", check path and rights";
  }
  world.broadcast(trouble);
  if (!trouble.empty()) {
    throw FileError(trouble);
  }
}

} // namespace gcpdda
