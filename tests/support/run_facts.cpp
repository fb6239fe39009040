#include "run_facts.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace gcpdda::testing {

namespace fs = std::filesystem;

std::string file_text(const fs::path &path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw std::runtime_error("cannot read " + path.string());
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string &text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

int count_of(const std::string &text, const std::string &part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) {
    ++count;
  }
  return count;
}

std::string json_value(const fs::path &file, const std::string &key) {
  const std::string text = file_text(file);
  const std::string quoted = "\"" + key + "\": ";
  const std::size_t found = text.find(quoted);
  if (found == std::string::npos) {
    throw std::runtime_error("no key " + key + " in " + file.string());
  }
  const std::size_t begin = found + quoted.size();
  std::size_t end = begin;
  int depth = 0;
  bool in_string = false;
  for (; end < text.size(); ++end) {
    const char c = text[end];
    if (in_string) {
      end += c == '\\' ? 1 : 0;
      in_string = c != '"';
      continue;
    }
    in_string = c == '"';
    depth += c == '{' || c == '[' ? 1 : 0;
    if (depth == 0 && (c == ',' || c == '}' || c == ']')) {
      break;
    }
    depth -= c == '}' || c == ']' ? 1 : 0;
  }
  return text.substr(begin, end - begin);
}

std::string summary_text(const fs::path &directory, const std::string &key) {
  return json_value(directory / "summary.json", key);
}

double summary_number(const fs::path &directory, const std::string &key) {
  return std::stod(summary_text(directory, key));
}

std::vector<std::string> listing(const fs::path &directory) {
  std::vector<std::string> names;
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(directory)) {
    names.push_back(entry.path().lexically_relative(directory).string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

} // namespace gcpdda::testing
