// What holds for every document: README.md is read in five minutes, and history is git's, so no document
// names commits.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path &path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    lines.push_back(line);
  }
  return lines;
}

/// README.md and all documents below the folders of the sources; what a run writes is none.
std::vector<fs::path> documents() {
  const fs::path top = GCPDDA_SOURCE_DIR;
  std::vector<fs::path> found{top / "README.md"};
  for (const char *folder : {"src", "run", "tests", "partition", "include"}) {
    for (auto entry = fs::recursive_directory_iterator(top / folder);
         entry != fs::recursive_directory_iterator(); ++entry) {
      const bool is_result =
          entry->path().parent_path() == top / "run/results" && entry->path().filename() != "studies";
      if (is_result && entry->is_directory()) {
        entry.disable_recursion_pending();
      } else if (entry->path().extension() == ".md") {
        found.push_back(entry->path());
      }
    }
  }
  return found;
}

/// The word of a line that looks like an abbreviated commit: 7 to 10 hexadecimal digits, a letter and a digit
/// among them.
std::string commit_in(const std::string &line) {
  static const std::regex words(R"(\b[0-9a-f]{7,10}\b)");
  for (std::sregex_iterator word(line.begin(), line.end(), words), end; word != end; ++word) {
    const std::string text = word->str();
    if (text.find_first_of("abcdef") != std::string::npos &&
        text.find_first_of("0123456789") != std::string::npos) {
      return text;
    }
  }
  return {};
}

TEST(Documents, ReadmeTakesFiveMinutes) {
  EXPECT_LE(lines_of(fs::path(GCPDDA_SOURCE_DIR) / "README.md").size(), 150U);
}

TEST(Documents, NameNoCommits) {
  EXPECT_EQ(commit_in("took 0.95 of the time of 05aa0df"), "05aa0df");
  EXPECT_EQ(commit_in("2000000 blocks, 1.2e-05 m, the facade"), "");
  const std::vector<fs::path> all = documents();
  EXPECT_GE(all.size(), 8U); // README.md, pages of the studies, scene keys
  for (const fs::path &path : all) {
    const std::vector<std::string> lines = lines_of(path);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_EQ(commit_in(lines[i]), "") << path << ":" << i + 1;
    }
  }
}

} // namespace
