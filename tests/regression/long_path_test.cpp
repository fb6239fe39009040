// Result folders whose paths are longer than what Open MPI has room for in some of its parts.

#include "child_process.hpp"

#include <gtest/gtest.h>

namespace gcpdda::long_path_test {
namespace {

namespace fs = std::filesystem;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

constexpr const char *scene = R"([run]
duration = 0.1
[material.rock]
density = 2500.0
[joint.default]
normal_stiffness = 1e8
[[block]]
material = "rock"
vertices = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
fixed = true
[[block]]
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
[output]
interval = 0.02
checkpoint_interval = 0.04
)";

TEST(LongPath, TakesFramesAndCheckpoints) {
  const WorkFolder folder;
  folder.write("s.toml", scene);
  for (const int ranks : {0, 2, 3}) {
    // As long with the folder before it as without: Open MPI looks at the path as it is given.
    const std::string out = std::to_string(ranks) + std::string(114, 'a') + "/" + std::string(114, 'b');
    const Outcome outcome = run_gcpdda(ranks, {"run", "s.toml", "--out", out}, folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(folder / out / "frames/frame_000005.hdf"));
    EXPECT_FALSE(fs::is_empty(folder / out / "checkpoints"));
  }
}

} // namespace
} // namespace gcpdda::long_path_test
