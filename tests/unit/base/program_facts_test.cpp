// What results record of the program: a version that names the project's, and a command that a shell reads
// back.

#include "base/program_facts.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

using namespace gcpdda;

TEST(ProgramFacts, VersionBeginsWithThatOfTheProject) {
  std::ifstream file(GCPDDA_SOURCE_DIR "/CMakeLists.txt");
  const std::regex project(R"(project\(gcpdda VERSION (\S+) .*)");
  std::smatch match;
  std::string line;
  while (std::getline(file, line) && !std::regex_match(line, match, project)) {
  }
  ASSERT_FALSE(match.empty());
  EXPECT_TRUE(std::regex_match(program_version(), std::regex(match[1].str() + R"((\+\S+)?)")))
      << program_version();
}

TEST(ProgramFacts, ALineQuotesWhatAShellWouldChange) {
  const std::vector<std::string> words{
      "build/gcpdda", "run",   "my scene.toml", "--set", "block.a.fixed=true",
      "it's",         "$HOME", "[0, -9.81]",    ""};
  EXPECT_EQ(shell_line(words),
            R"(build/gcpdda run 'my scene.toml' --set block.a.fixed=true 'it'\''s' '$HOME' '[0, -9.81]' '')");
}

TEST(ProgramFacts, TheCommandIsThatOfThisProcess) {
  EXPECT_NE(command_line().find("unit_tests"), std::string::npos) << command_line();
}

} // namespace
