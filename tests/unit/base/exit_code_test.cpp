// The table of exit codes and the page that explains them to users list the same codes.

#include "gcpdda/base/exit_code.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>

namespace {

using namespace gcpdda;

TEST(ExitCodes, AreThoseOfTheGuide) {
  std::ifstream guide(GCPDDA_SOURCE_DIR "/run/guide/11_errors_and_exit_codes.md");
  const std::regex row(R"(\| ([0-9]+) \| ([^|]+) \|.*)");
  std::size_t found = 0;
  std::smatch cells;
  for (std::string line; std::getline(guide, line);) {
    if (std::regex_match(line, cells, row)) {
      ASSERT_LT(found, exit_codes.size()) << line;
      const auto &[code, meaning] = exit_codes[found++];
      EXPECT_EQ(std::stoi(cells[1]), code);
      EXPECT_TRUE(cells[2].str().starts_with(meaning)) << line << "\nis about: " << meaning;
    }
  }
  EXPECT_EQ(found, exit_codes.size());
}

} // namespace
