// What a run says of deformable blocks that are strained too far.

#include "child_process.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gcpdda::strain_test {
namespace {

using testing::count_of;
using testing::file_text;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

// Eight courses press the lowest bricks by 0.2 MPa: by 2e-5 of their height, and flat where the unit of E is
// wrong.
const std::string wall = R"([run]
fidelity = "deformable"
[material.brick]
density = 2500
youngs_modulus = 1e10
poissons_ratio = 0.2
[joint.default]
allowed_overlap = 1e-3
friction_angle_deg = 35
[[block]]
name = "floor"
material = "brick"
fixed = true
vertices = [[-1, -1], [9, -1], [9, 0], [-1, 0]]
[[wall]]
name = "w"
material = "brick"
origin = [0, 0]
rows = 8
columns = 4
block_size = [2, 1]
[output]
interval = 0.2
[[stage]]
name = "rest"
kind = "settle"
limit = 2.0
solver = "dynamic"
)";

std::string line_with(const std::string &text, const std::string &word) {
  const std::size_t at = text.find(word);
  if (at == std::string::npos) {
    return "";
  }
  const std::size_t begin = text.rfind('\n', at) + 1; // 0 in the first line
  return text.substr(begin, text.find('\n', at) - begin);
}

TEST(Strain, IsToldOnceAndAlikeOnAnyRanks) {
  const WorkFolder folder;
  folder.write("wall.toml", wall);
  std::vector<std::string> told;
  for (const int ranks : {0, 2, 3}) {
    const Outcome outcome = run_gcpdda(
        ranks,
        {"run", "wall.toml", "--out", "out", "--overwrite", "--set", "material.brick.youngs_modulus=1e5"},
        folder);
    ASSERT_EQ(outcome.exit_code, 7) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "is strained by"), 1) << outcome.err;
    told.push_back(line_with(outcome.err, "is strained by"));
    EXPECT_EQ(told.back(), line_with(file_text(folder / "out/run.log"), "is strained by"));
    EXPECT_EQ(told.back(), told.front());
  }
  EXPECT_EQ(told.front().find("warning: block 'w."), 0U) << told.front();
  EXPECT_EQ(count_of(told.front(),
                     " at t = 0.4 s, linear elasticity is meant for small strains, below 0.1, use a "
                     "larger material.brick.youngs_modulus, or check its unit, Pa"),
            1)
      << told.front();
}

TEST(Strain, IsNotToldOfRock) {
  const WorkFolder folder;
  folder.write("wall.toml", wall);
  const Outcome outcome = run_gcpdda(0, {"run", "wall.toml", "--out", "out"}, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "is strained by"), 0) << outcome.err;
}

// A smaller time step does not help blocks that are crushed, as these are by their weight: k_n L/E is 1e5.
TEST(Strain, IsNamedAsTheCauseOfAFailure) {
  const WorkFolder folder;
  folder.write("wall.toml", wall);
  const Outcome outcome = run_gcpdda(
      0,
      {"run", "wall.toml", "--out", "out", "--set", "material.brick.youngs_modulus=2e3", "--set",
       "stage.rest.solver=static", "--set", "stage.rest.limit=20.0", "--set", "output.interval=2.0"},
      folder);
  ASSERT_EQ(outcome.exit_code, 5) << outcome.err;
  const std::string words = line_with(outcome.err, "its state is no longer finite");
  EXPECT_NE(words.find("deformable blocks are strained by up to"), std::string::npos) << outcome.err;
  EXPECT_NE(words.find("try a larger youngs_modulus, or check its unit, Pa"), std::string::npos) << words;
}

} // namespace
} // namespace gcpdda::strain_test
