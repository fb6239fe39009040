// Joint maps in DXF drawings, with a stand-in for GDAL's ogr2ogr and, where it is installed, with the real
// one.

#include "child_process.hpp"
#include "io/results/run_comparison.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fmt/format.h>

namespace gcpdda::joint_drawing_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::gcpdda_words;
using testing::Outcome;
using testing::run_program;
using testing::WorkFolder;

const std::string scene = R"([run]
duration = 0.01
[material.rock]
density = 2600
[joint.default]
normal_stiffness = 1e8
[joint.beds]
friction_angle_deg = 20
[joint.miners]
friction_angle_deg = 25
[region]
material = "rock"
polygon = [[0, 0], [10, 0], [10, 6], [0, 6]]
)";

std::string map_of(const std::string &file, const std::string &layer, const std::string &joint) {
  return fmt::format("[[joint_map]]\nfile = \"{}\"\nlayer = \"{}\"\njoint = \"{}\"\n", file, layer, joint);
}

/// One line on the layer J1, a polyline of three points on "miner's", a text on "notes".
const std::string drawing =
    "0\nSECTION\n2\nENTITIES\n"
    "0\nLINE\n8\nJ1\n10\n-1.0\n20\n2.5\n11\n11.0\n21\n3.5\n"
    "0\nPOLYLINE\n8\nminer's\n66\n1\n10\n0.0\n20\n0.0\n"
    "0\nVERTEX\n8\nminer's\n10\n4.0\n20\n-1.0\n0\nVERTEX\n8\nminer's\n10\n5.0\n20\n4.0\n"
    "0\nVERTEX\n8\nminer's\n10\n4.5\n20\n7.0\n0\nSEQEND\n8\nminer's\n"
    "0\nTEXT\n8\nnotes\n10\n1.0\n20\n1.0\n40\n0.5\n1\nnorth\n"
    "0\nENDSEC\n0\nEOF\n";

/// What ogr2ogr does with the drawing: its third word is the file to write.
const std::string stand_in = R"sh(#!/bin/sh
echo "$@" >> "$HERE/calls"
line() { printf '{"type":"Feature","geometry":{"type":"LineString","coordinates":[%s]}}' "$1"; }
j1='[-1,2.5],[11,3.5]'
miners='[4,-1],[5,4],[4.5,7]'
case "$*" in
  *broken.dxf*) echo "ERROR 1: no DXF" >&2; exit 1 ;;
  *DISTINCT*) printf 'Layer\nJ1\n"miner'"'"'s"\nnotes\n' > "$3"; exit 0 ;;
  *"Layer = 'J1'"*) features=$(line "$j1") ;;
  *"Layer = 'miner''s'"*) features=$(line "$miners") ;;
  *Layer*) features= ;;
  *) features="$(line "$j1"),$(line "$miners")" ;;
esac
printf '{"type":"FeatureCollection","features":[%s]}' "$features" > "$3"
)sh";

class JointDrawing : public ::testing::TestWithParam<bool> {
protected:
  void SetUp() override {
    fs::create_directory(folder_ / "tmp");
    fs::create_directory(folder_ / "bin");
    folder_.write("j.dxf", drawing);
    folder_.write("broken.dxf", "this is no drawing\n");
    folder_.write("bin/ogr2ogr", stand_in);
    fs::permissions(folder_ / "bin/ogr2ogr", fs::perms::owner_all);
  }
  Outcome call(int ranks, const std::vector<std::string> &arguments, const std::string &maps) {
    folder_.write("scene.toml", scene + maps);
    std::vector<std::string> environment{"TMPDIR=" + (folder_ / "tmp").string(),
                                         "HERE=" + folder_.path().string()};
    if (GetParam()) {
      environment.push_back(fmt::format("PATH={}:{}", (folder_ / "bin").string(), std::getenv("PATH")));
    }
    return run_program(gcpdda_words(ranks, arguments), folder_.path(), environment);
  }
  [[nodiscard]] bool nothing_is_left() const { return fs::is_empty(folder_ / "tmp"); }
  WorkFolder folder_;
};

// The same blocks with the same families, coloured by them, as from files with the same lines.
TEST_P(JointDrawing, LayersAreFamilies) {
  const Outcome from_drawing = call(0, {"blocks", "scene.toml", "--svg", "dxf.svg"},
                                    map_of("j.dxf", "J1", "beds") + map_of("j.dxf", "miner's", "miners"));
  ASSERT_EQ(from_drawing.exit_code, 0) << from_drawing.err;
  folder_.write("j1.csv", "a,-1,2.5\na,11,3.5\n");
  folder_.write("m.csv", "a,4,-1\na,5,4\na,4.5,7\n");
  const Outcome from_files = call(0, {"blocks", "scene.toml", "--svg", "csv.svg"},
                                  "[[joint_map]]\nfile = \"j1.csv\"\njoint = \"beds\"\n[[joint_map]]\nfile = "
                                  "\"m.csv\"\njoint = \"miners\"\n");
  ASSERT_EQ(from_files.exit_code, 0) << from_files.err;
  EXPECT_EQ(from_drawing.out, from_files.out);
  EXPECT_EQ(file_text(folder_ / "dxf.svg"), file_text(folder_ / "csv.svg"));
  EXPECT_EQ(count_of(from_drawing.out, "blocks     4 cut"), 1) << from_drawing.out;
}

TEST_P(JointDrawing, AllLayersTogetherOnAnyNumberOfRanks) {
  const std::string all = "[[joint_map]]\nfile = \"j.dxf\"\n";
  const Outcome one = call(0, {"blocks", "scene.toml"}, all);
  const Outcome three = call(3, {"blocks", "scene.toml"}, all);
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(three.exit_code, 0) << three.err;
  EXPECT_EQ(one.out, three.out);
  EXPECT_EQ(count_of(one.out, "blocks     4 cut"), 1) << one.out;
  EXPECT_TRUE(nothing_is_left());
  if (GetParam()) {
    EXPECT_EQ(count_of(file_text(folder_ / "calls"), "\n"), 2) << "one process calls it, once a run";
  }
}

// The drawing is gone and ogr2ogr fails, and the run goes on with the lines that it has kept.
TEST_P(JointDrawing, ARestartTakesTheLinesThatTheRunHasKept) {
  const std::string maps = map_of("j.dxf", "J1", "beds") + map_of("j.dxf", "miner's", "miners");
  const auto run_to = [&](const std::string &end, const std::string &out) {
    return call(0,
                {"run", "scene.toml", "--out", out, "--set", "run.duration=" + end, "--set",
                 "run.time_step=1e-4", "--set", "output.interval=0.005", "--set",
                 "output.checkpoint_interval=0.005"},
                maps);
  };
  ASSERT_EQ(run_to("0.01", "whole").exit_code, 0);
  ASSERT_EQ(run_to("0.005", "cut").exit_code, 0);
  fs::remove(folder_ / "j.dxf");
  folder_.write("bin/ogr2ogr", "#!/bin/sh\nexit 1\n");
  const Outcome rest = call(3, {"restart", "cut", "--set", "run.duration=0.01"}, maps);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_EQ(compare_runs(folder_ / "whole", folder_ / "cut"), std::vector<std::string>());
}

TEST_P(JointDrawing, ALayerWithoutLinesIsAFault) {
  const Outcome missing = call(2, {"run", "scene.toml"}, map_of("j.dxf", "minrs", "beds"));
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_EQ(
      count_of(missing.err,
               "scene.toml:15:8: error: the drawing 'j.dxf' has nothing on a layer 'minrs', its layers are "
               "'J1', 'miner's', 'notes', did you mean 'miner's'?"),
      1)
      << missing.err;
  const Outcome empty = call(0, {"run", "scene.toml"}, map_of("j.dxf", "notes", "beds"));
  EXPECT_EQ(empty.exit_code, 3);
  EXPECT_EQ(count_of(empty.err,
                     "scene.toml:15:8: error: layer 'notes' of the drawing 'j.dxf' holds no lines, "
                     "a map without traces cuts nothing"),
            1)
      << empty.err;
  EXPECT_FALSE(fs::exists(folder_ / "results"));
  EXPECT_TRUE(nothing_is_left());
}

TEST_P(JointDrawing, OneThatCannotBeReadIsAFault) {
  const Outcome broken = call(2, {"inspect", "scene.toml"}, "[[joint_map]]\nfile = \"broken.dxf\"\n");
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_EQ(count_of(broken.err, "scene.toml:15:8: error: ogr2ogr cannot read the drawing 'broken.dxf'"), 1)
      << broken.err;
  const Outcome none = call(2, {"blocks", "scene.toml"}, "[[joint_map]]\nfile = \"none.dxf\"\n");
  EXPECT_EQ(none.exit_code, 4);
  EXPECT_EQ(count_of(none.err, "none.dxf: error: cannot open the joint map"), 1) << none.err;
}

/// The stand-in, and the real one where it is installed.
std::vector<bool> kinds() {
  const int missing = std::system("command -v ogr2ogr > /dev/null"); // NOLINT: words of this test
  return missing == 0 ? std::vector<bool>{true, false} : std::vector<bool>{true};
}

INSTANTIATE_TEST_SUITE_P(OfOgr, JointDrawing, ::testing::ValuesIn(kinds()),
                         [](const ::testing::TestParamInfo<bool> &is_stand_in) {
                           return is_stand_in.param ? "StandIn" : "Real";
                         });

TEST(JointDrawingWithoutOgr, SaysHowToReadIt) {
  const WorkFolder folder;
  folder.write("j.dxf", drawing);
  folder.write("scene.toml", scene + "[[joint_map]]\nfile = \"j.dxf\"\n");
  const Outcome outcome = run_program(gcpdda_words(0, {"blocks", "scene.toml"}), folder.path(),
                                      {"PATH=" + folder.path().string()});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(
      count_of(outcome.err, "scene.toml:15:8: error: the drawing 'j.dxf' cannot be read without ogr2ogr"), 1)
      << outcome.err;
  for (const char *help : {"gdal-bin", "run/dxf_to_geojson.sh IN.dxf OUT.geojson LAYER"}) {
    EXPECT_EQ(count_of(outcome.err, help), 1) << outcome.err;
  }
}

TEST(JointDrawingWithoutOgr, OnlyDrawingsHaveLayers) {
  const WorkFolder folder;
  folder.write("j.csv", "a,0,0\na,1,1\n");
  folder.write("scene.toml", scene + map_of("j.csv", "J1", "beds"));
  const Outcome outcome = testing::run_gcpdda(0, {"blocks", "scene.toml"}, folder);
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(count_of(outcome.err,
                     "scene.toml:16:9: error: 'layer' in joint_map 'joint_map0' has no meaning, only a "
                     ".dxf drawing has layers, leave it out"),
            1)
      << outcome.err;
}

} // namespace
} // namespace gcpdda::joint_drawing_test
