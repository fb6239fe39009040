// A run under in-situ stress: the same files on any number of ranks and through a restart, which finds the
// shapes of the blocks anew.

#include "child_process.hpp"

#include "io/results/run_comparison.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda::in_situ_test {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

const std::string tunnel = R"([run]
accepted_error = 0.1
[material.rock]
density = 2600
youngs_modulus = 20e9
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 2e10
friction_angle_deg = 35
[in_situ]
level = 60
k0 = 0.6
[region]
material = "rock"
polygon = [[0, 0], [24, 0], [24, 18], [0, 18]]
fixed = ["bottom", "left", "right", "top"]
[[joint_set]]
dip_deg = 60
spacing = 2.3
[[joint_set]]
dip_deg = -20
spacing = 2.1
[[opening]]
name = "tunnel"
shape = "circle"
centre = [12, 9]
width = 5
[output]
interval = 0.002
[[stage]]
kind = "run"
duration = 0.002
[[stage]]
kind = "excavate"
openings = ["tunnel"]
relax = 0.002
[[stage]]
kind = "run"
duration = 0.004
)";

const std::vector<std::string> none;

TEST(InSituRun, IsTheSameOnAnyNumberOfRanksAndThroughARestart) {
  WorkFolder folder;
  folder.write("tunnel.toml", tunnel);
  const Outcome alone = run_gcpdda(1, {"run", "tunnel.toml", "--out", "one"}, folder);
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  const fs::path one = folder / "one";
  const Outcome three = run_gcpdda(3, {"run", "tunnel.toml", "--out", "three"}, folder);
  ASSERT_EQ(three.exit_code, 0) << three.err;
  EXPECT_EQ(compare_runs(one, folder / "three"), none);
  std::vector<fs::path> files;
  for (const auto &entry : fs::directory_iterator(one / "checkpoints")) {
    files.push_back(entry.path());
  }
  ASSERT_EQ(files.size(), 2U) << "one before the tunnel, one at the end";
  fs::remove(std::max(files[0], files[1]));
  const Outcome again = run_gcpdda(2, {"restart", "one"}, folder);
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(compare_runs(folder / "three", one), none);

  const Outcome changed = run_gcpdda(1, {"restart", "one", "--set", "in_situ.k0=0.7"}, folder);
  EXPECT_EQ(changed.exit_code, 3);
  EXPECT_NE(changed.err.find("a restart cannot change [in_situ]"), std::string::npos) << changed.err;
}

// Cut blocks have steps of millimetres, where a joint ends just beside another one. They are no legs: the
// stress may close joints by more than 5 % of such a step.
TEST(InSituRun, BeginsThoughABlockHasAStepOfMillimetres) {
  WorkFolder folder;
  folder.write("step.toml", R"([run]
fidelity = "rigid"
duration = 1e-3
[material.rock]
density = 2600
[joint.default]
normal_stiffness = 2e10
friction_angle_deg = 35
[in_situ]
level = 150
k0 = 0.6
[[block]]
name = "stepped"
material = "rock"
vertices = [[0, 0], [1, 0], [0.9999, 0.0023], [3, 1.4], [3, 2], [0, 2]]
[[block]]
name = "wedge"
material = "rock"
vertices = [[1, 0], [3, 0], [3, 1.4], [0.9999, 0.0023]]
[[block]]
name = "floor"
material = "rock"
fixed = true
vertices = [[-1, -1], [4, -1], [4, 0], [-1, 0]]
[[block]]
name = "left"
material = "rock"
fixed = true
vertices = [[-1, 0], [0, 0], [0, 2], [-1, 2]]
[[block]]
name = "right"
material = "rock"
fixed = true
vertices = [[3, 0], [4, 0], [4, 2], [3, 2]]
[[block]]
name = "lid"
material = "rock"
fixed = true
vertices = [[-1, 2], [4, 2], [4, 3], [-1, 3]]
)");
  const Outcome outcome = run_gcpdda(1, {"run", "step.toml", "--out", "step"}, folder);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

} // namespace
} // namespace gcpdda::in_situ_test
