// Where the program writes what it is asked for: never over what it reads, nor over another output, and it
// says so where standard output takes nothing.

#include "child_process.hpp"
#include "support/plane_failure.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

namespace gcpdda::outputs_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::listing;
using testing::Outcome;
using testing::run_gcpdda;
using testing::run_program;
using testing::WorkFolder;

constexpr const char *scene = R"([run]
duration = 0.1
[material.rock]
density = 2500.0
[joint.default]
normal_stiffness = 1e8
[region]
material = "rock"
polygon = [[0, 0], [4, 0], [4, 4], [0, 4]]
fixed = ["bottom"]
[[joint_map]]
file = "map.csv"
)";
constexpr const char *map = "a,1,-1\na,2,5\n";

class Outputs : public ::testing::Test {
protected:
  Outputs() {
    folder_.write("s.toml", scene);
    folder_.write("map.csv", map);
    fs::create_directory(folder_ / "sub");
    fs::create_symlink(folder_ / "s.toml", folder_ / "link");
  }

  void expect_refusal(const std::vector<std::string> &arguments, const std::string &said,
                      int ranks = 0) const {
    const std::vector<std::string> before = listing(folder_.path());
    const Outcome outcome = run_gcpdda(ranks, arguments, folder_);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, said), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(listing(folder_.path()), before);
    EXPECT_EQ(file_text(folder_ / "s.toml"), scene);
    EXPECT_EQ(file_text(folder_ / "map.csv"), map);
  }

  WorkFolder folder_;
};

TEST_F(Outputs, DoNotReplaceWhatIsRead) {
  expect_refusal({"inspect", "s.toml", "--svg", "s.toml"}, "--svg s.toml: error: this is the scene");
  expect_refusal({"inspect", "s.toml", "--svg", "link"}, "--svg link: error: this is the scene");
  expect_refusal({"inspect", "s.toml", "--svg", "sub/../s.toml"}, "error: this is the scene", 2);
  for (const char *option : {"--svg", "--json", "--out"}) {
    expect_refusal({"blocks", "s.toml", option, "./s.toml"},
                   std::string(option) + " ./s.toml: error: this is the scene");
    expect_refusal({"blocks", "s.toml", option, "map.csv"},
                   std::string(option) + " map.csv: error: this is a joint map");
  }
}

TEST_F(Outputs, DoNotReplaceTheBlockFile) {
  ASSERT_EQ(run_gcpdda(0, {"blocks", "s.toml", "--out", "b.h5"}, folder_).exit_code, 0);
  const std::string blocks = file_text(folder_ / "b.h5");
  folder_.write("cut.toml", R"([run]
duration = 0.1
[material.rock]
density = 2500.0
[joint.default]
normal_stiffness = 1e8
[blocks]
file = "b.h5"
)");
  expect_refusal({"inspect", "cut.toml", "--svg", "b.h5"}, "--svg b.h5: error: this is the block file");
  EXPECT_EQ(file_text(folder_ / "b.h5"), blocks);
}

TEST_F(Outputs, DoNotReplaceEachOther) {
  expect_refusal({"blocks", "s.toml", "--svg", "same", "--json", "same"},
                 "--json same: error: this is the file of --svg");
  expect_refusal({"blocks", "s.toml", "--json", "same", "--out", "sub/../same"},
                 "--out sub/../same: error: this is the file of --json", 2);
}

/// gcpdda in a shell that lets standard output go to a place.
Outcome run_into(const std::string &place, const std::string &arguments, const WorkFolder &folder) {
  return run_program({"sh", "-c", std::string(GCPDDA_EXECUTABLE) + " " + arguments + " " + place},
                     folder.path());
}

TEST_F(Outputs, OfStandardOutputAreNotLostInSilence) {
  folder_.write("plane.toml", testing::plane_failure_toml(0.0));
  for (const char *call :
       {"reference", "reference --values", "--version", "--help", "run --help", "inspect s.toml",
        "blocks s.toml", "new slope", "fos plane.toml --from 1.2 --to 1.6 --tolerance 0.3",
        "ensemble plane.toml --count 1"}) {
    const Outcome outcome = run_into("> /dev/full", call, folder_);
    EXPECT_EQ(outcome.exit_code, 4) << call << ": " << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "stdout: cannot be written"), 1) << call << ": " << outcome.err;
  }
  EXPECT_TRUE(fs::exists(folder_ / "results/plane_fos/fos.txt")) << "files are written all the same";
}

} // namespace
} // namespace gcpdda::outputs_test
