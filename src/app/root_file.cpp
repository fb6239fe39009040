#include "root_file.hpp"

#include "gcpdda/base/check.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace gcpdda {

std::string read_on_root(const Communicator &world, const std::string &path, const std::string &who) {
  std::string text;
  std::string trouble;
  if (world.is_root()) {
    std::error_code ignored;
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path, ignored)) {
      trouble =
          path + ": error: cannot open " + who + ", no such file or no right to read it, check the path";
    } else {
      std::ostringstream content;
      content << file.rdbuf();
      text = content.str();
    }
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
