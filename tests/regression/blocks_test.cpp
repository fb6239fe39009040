// gcpdda blocks, and runs of scenes with a region, as a person sees them.

#include "child_process.hpp"
#include "io/results/run_comparison.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

namespace gcpdda::blocks_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::json_value;
using testing::listing;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

const std::string scene = R"([run]
duration = 0.02
time_step = 2e-4
[material.rock]
density = 2600
[joint.default]
normal_stiffness = 1e8
friction_angle_deg = 30
[joint.beds]
friction_angle_deg = 20
[[block]]
name = "boulder"
material = "rock"
vertices = [[2, 6], [4, 6], [4, 7], [2, 7]]
[region]
material = "rock"
polygon = [[0, 0], [10, 0], [10, 6], [0, 6]]
fixed = ["bottom"]
[[joint_set]]
joint = "beds"
dip_deg = 15
spacing = 1
[[joint_set]]
dip_deg = 100
spacing = 1
trace_length = 3
gap = 0.5
[[joint_map]]
file = "map.csv"
[[opening]]
name = "drift"
shape = "d"
centre = [6, 3]
width = 2
[[monitor]]
block = "b5"
[[monitor]]
name = "line"
along = [[0.5, 3], [9.5, 4]]
points = 7
[output]
interval = 0.01
checkpoint_interval = 0.01
)";

class Blocks : public ::testing::Test {
protected:
  Blocks() {
    folder_.write("scene.toml", scene);
    folder_.write("map.csv", "trace,x,y\na,-1,2.5\na,4,3\na,11,2.5\n");
  }
  WorkFolder folder_;
};

TEST_F(Blocks, AreReportedAndDrawnAlikeOnAnyNumberOfRanks) {
  const Outcome one = run_gcpdda(0, {"blocks", "scene.toml", "--svg", "1.svg", "--json", "1.json"}, folder_);
  const Outcome three =
      run_gcpdda(3, {"blocks", "scene.toml", "--svg", "3.svg", "--json", "3.json"}, folder_);
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(three.exit_code, 0) << three.err;
  EXPECT_EQ(one.out, three.out);
  EXPECT_EQ(file_text(folder_ / "1.svg"), file_text(folder_ / "3.svg"));
  EXPECT_EQ(file_text(folder_ / "1.json"), file_text(folder_ / "3.json"));
  for (const char *line : {"scene 'scene'\nblocks ", " and 1 fixed along the sides\n",
                           "opening    'drift': ", "60 m2 of blocks + 0 m2 excavated = 60 m2 of region"}) {
    EXPECT_EQ(count_of(one.out, line), 1) << line << "\nin " << one.out;
  }
  const std::string json = file_text(folder_ / "1.json");
  EXPECT_EQ(count_of(json, "\"region_area\": 60,"), 1) << json;
  EXPECT_EQ(count_of(json, "\"first_id\": 1,"), 1) << json;
  EXPECT_EQ(count_of(one.out, "'joint_set1' asks spacing 1 m, P21 0.8571 m/m2, mean trace length 3 m"), 1)
      << one.out;
  EXPECT_EQ(count_of(one.out, " has  spacing 1 m"), 2) << one.out;
  EXPECT_EQ(count_of(json, "\"joint_sets\": [{\"name\": \"joint_set0\", \"asked\": {\"spacing\": 1,"), 1)
      << json;
  EXPECT_EQ(count_of(one.err, "error"), 0);
}

TEST_F(Blocks, RunAndGoOnTheSameOnAnyNumberOfRanks) {
  EXPECT_EQ(run_gcpdda(0, {"run", "scene.toml", "--out", "one"}, folder_).exit_code, 0);
  const Outcome three = run_gcpdda(3, {"run", "scene.toml", "--out", "three"}, folder_);
  EXPECT_EQ(three.exit_code, 0) << three.err;
  EXPECT_EQ(compare_runs(folder_ / "one", folder_ / "three"), std::vector<std::string>());
  // The joints that are in the run are those that gcpdda blocks reports.
  run_gcpdda(0, {"blocks", "scene.toml", "--json", "blocks.json"}, folder_);
  for (const char *run : {"one", "three"}) {
    const fs::path summary = folder_ / run / "summary.json";
    EXPECT_EQ(count_of(file_text(summary), "\"name\": \"joint_set"), 2);
    EXPECT_EQ(std::stod(json_value(summary, "p21")), std::stod(json_value(folder_ / "blocks.json", "p21")));
    EXPECT_EQ(json_value(summary, "joints"), json_value(folder_ / "blocks.json", "joints"));
    EXPECT_EQ(count_of(file_text(folder_ / run / "run.log"), "joint set 'joint_set1' has  spacing 1 m"), 1);
  }
  EXPECT_GT(file_text(folder_ / "one/history/b5.csv").size(), 100U);
  EXPECT_EQ(count_of(file_text(folder_ / "one/history/line.csv"), "\n"), 1 + 3 * 7); // t = 0, 0.01, 0.02
  // From half way, on other ranks, in another folder than that of the joint map.
  EXPECT_EQ(
      run_gcpdda(2, {"run", "scene.toml", "--out", "half", "--set", "run.duration=0.01"}, folder_).exit_code,
      0);
  const Outcome rest = run_gcpdda(2, {"restart", "half", "--set", "run.duration=0.02"}, folder_);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(compare_runs(folder_ / "one", folder_ / "half"), std::vector<std::string>());
  EXPECT_EQ(json_value(folder_ / "half/summary.json", "joint_sets"),
            json_value(folder_ / "one/summary.json", "joint_sets"));
}

// The same blocks with the same families, from the file instead of the region: the same motion.
TEST_F(Blocks, MakeABlockFileThatRunsTheSame) {
  const Outcome cut = run_gcpdda(2, {"blocks", "scene.toml", "--out", "cut.h5"}, folder_);
  EXPECT_EQ(cut.exit_code, 0) << cut.err;
  const std::string without_region = scene.substr(0, scene.find("[region]"));
  const std::string rest = scene.substr(scene.find("[[monitor]]"));
  folder_.write("file.toml", without_region + "[blocks]\nfile = \"cut.h5\"\n" + rest);
  EXPECT_EQ(run_gcpdda(0, {"run", "scene.toml", "--out", "region"}, folder_).exit_code, 0);
  const Outcome run = run_gcpdda(0, {"run", "file.toml", "--out", "file"}, folder_);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(compare_runs(folder_ / "region", folder_ / "file"), std::vector<std::string>());
}

TEST_F(Blocks, FaultsOfAMapHaveItsLines) {
  folder_.write("map.csv", "trace,x,y\na,1,1\na,2\nb,x,3\n");
  const std::vector<std::string> before = listing(folder_.path());
  const Outcome outcome = run_gcpdda(2, {"run", "scene.toml"}, folder_);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(count_of(outcome.err, "map.csv:3:1: error: a row with 2 fields, a row is trace,x,y"), 1)
      << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "map.csv:4:3: error: 'x' is no coordinate"), 1) << outcome.err;
  EXPECT_EQ(listing(folder_.path()), before);
}

// Coordinates of a map are rounded by 1e-9 m.
TEST_F(Blocks, ASampleAtMapCoordinatesIsSound) {
  folder_.write("sample.toml", R"([run]
duration = 1
[material.rock]
density = 2600
[joint.default]
normal_stiffness = 1e9
[region]
material = "rock"
polygon = [[500123, 5200456], [500124, 5200456], [500124, 5200457]]
[[joint_set]]
dip_deg = 47
spacing = 0.1
origin = [500123, 5200456]
[[joint_set]]
dip_deg = 101
spacing = 0.1
origin = [500123, 5200456]
)");
  const Outcome outcome = run_gcpdda(2, {"blocks", "sample.toml", "--svg", "sample.svg"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_GT(count_of(outcome.out, " at [500123."), 0) << "metres and millimetres of places\n" << outcome.out;
  EXPECT_GT(count_of(outcome.out, ", 5200456."), 0) << outcome.out;
  EXPECT_GT(count_of(file_text(folder_ / "sample.svg"), ">5200456.2<"), 0) << "a number of the axis";
}

TEST_F(Blocks, AMissingMapIsFileTrouble) {
  const Outcome outcome =
      run_gcpdda(2, {"blocks", "scene.toml", "--set", "joint_map=[{file='none.csv'}]"}, folder_);
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_EQ(count_of(outcome.err, "none.csv: error: cannot open the joint map"), 1) << outcome.err;
}

TEST_F(Blocks, NeedARegion) {
  folder_.write("wall.toml",
                "[run]\nduration = 1\n[material.rock]\ndensity = 2600\n[joint.default]\n"
                "normal_stiffness = 1e8\n[[wall]]\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 2\n"
                "columns = 2\nblock_size = [1, 1]\n");
  const Outcome outcome = run_gcpdda(0, {"blocks", "wall.toml"}, folder_);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(count_of(outcome.err, "wall.toml: error: the scene has no region"), 1) << outcome.err;
}

TEST_F(Blocks, TellWhatIsImplausible) {
  folder_.write("far.toml", scene + "[[fault]]\nname = \"far\"\npoints = [[20, 0], [21, 5]]\n"
                                    "[[joint_set]]\nname = \"away\"\ndip_deg = 80\nspacing = 1\n"
                                    "within = [[30, 0], [40, 0], [40, 9]]\n");
  const Outcome outcome = run_gcpdda(2, {"blocks", "far.toml"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "warning: fault.far lies from [20, 0] to [21, 5], outside of the region"),
            1)
      << outcome.err;
  EXPECT_EQ(count_of(outcome.err,
                     "warning: joint_set.away.within lies from [30, 0] to [40, 9], outside of the region"),
            1)
      << outcome.err;
}

TEST_F(Blocks, AMonitorOfNoBlockIsAFault) {
  const Outcome outcome = run_gcpdda(0, {"run", "scene.toml", "--set", "monitor=[{block='b5000'}]"}, folder_);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(count_of(outcome.err, "no block is named 'b5000'"), 1) << outcome.err;
}

TEST_F(Blocks, InspectKnowsThem) {
  const Outcome outcome = run_gcpdda(2, {"inspect", "scene.toml"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.out, " mobile, 1 fixed, "), 1) << outcome.out;
  EXPECT_EQ(count_of(outcome.out, " has  spacing 1 m"), 2) << outcome.out;
}

} // namespace
} // namespace gcpdda::blocks_test
