#include "base/program_facts.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>
#include <vector>

// CMakeLists.txt defines GCPDDA_VERSION and GCPDDA_BUILD_VERSIONS for this file alone: another version
// compiles no other file again.

namespace gcpdda {

namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
         std::string_view("_-./=,:+@%").find(c) != std::string_view::npos;
}

} // namespace

std::string program_version() {
  return GCPDDA_VERSION;
}

std::string build_versions() {
  return GCPDDA_BUILD_VERSIONS;
}

std::string shell_line(std::span<const std::string> words) {
  std::string line;
  for (const std::string &word : words) {
    line += line.empty() ? "" : " ";
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) {
      line += c == '\'' ? std::string(R"('\'')") : std::string(1, c);
    }
    line += '\'';
  }
  return line;
}

std::string command_line() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary); // words, each with a zero byte at its end
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) {
    words.push_back(word);
  }
  return shell_line(words);
}

} // namespace gcpdda
