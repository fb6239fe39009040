// Loads and stress that change with time: what the scene says of them, what is wrong with it, and the course.

#include "gcpdda/model/load_course.hpp"

#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::load_courses_test {
namespace {

using testing::expect_same;
using testing::good;
using testing::messages;

const std::string head = R"([run]
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
)";
const std::string block = R"([[block]]
name = "a"
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
)";
const std::string region = R"([region]
material = "rock"
polygon = [[0, 0], [4, 0], [4, 4], [0, 4]]
roller = ["left", "bottom"]
stress = ["top"]
[in_situ]
vertical_stress = 1e6
k0 = 0.5
)";
const std::string first = "[[stage]]\nkind = \"settle\"\nlimit = 1.0\n";

TEST(LoadCourse, RisesSmoothly) {
  const LoadCourse course{.begin = 2.0, .ramp = 4.0};
  EXPECT_EQ(course.factor(1.0), 0.0);
  EXPECT_EQ(course.factor(2.0), 0.0);
  EXPECT_EQ(course.factor(3.0), 3.0 / 16.0 - 2.0 / 64.0);
  EXPECT_EQ(course.factor(4.0), 0.5);
  EXPECT_EQ(course.factor(6.0), 1.0);
  EXPECT_EQ(course.factor(7.0), 1.0);
  EXPECT_EQ(course.end(), 6.0);
  EXPECT_EQ(LoadCourse{}.factor(0.0), 1.0);
  EXPECT_EQ(LoadCourse{}.end(), 0.0);
}

TEST(LoadCourse, IsLinearBetweenTheRowsOfItsTable) {
  const LoadCourse course{.begin = 1.0, .table = {{0.0, 0.5}, {1.0, 2.0}, {3.0, -2.0}}};
  EXPECT_EQ(course.factor(1.0), 0.5);
  EXPECT_EQ(course.factor(1.5), 1.25);
  EXPECT_EQ(course.factor(2.0), 2.0);
  EXPECT_EQ(course.factor(3.0), 0.0);
  EXPECT_EQ(course.factor(4.0), -2.0);
  EXPECT_EQ(course.factor(9.0), -2.0);
  EXPECT_EQ(course.end(), 4.0);
}

// Three stresses, the last change of which comes while the one before lasts. Round-off.
TEST(LoadCourse, ChangesShareOneWhole) {
  const Rise second{.begin = 1.0, .duration = 2.0};
  const Rise third{.begin = 2.0, .duration = 2.0};
  const LoadCourse courses[] = {{.out = {second, third}}, {.in = second, .out = {third}}, {.in = third}};
  EXPECT_EQ(courses[0].end(), 3.0);
  EXPECT_EQ(courses[1].end(), 4.0);
  for (const double time : {0.0, 1.0, 1.3, 2.0, 2.6, 3.0, 3.9, 4.0, 5.0}) {
    const double of_first = courses[0].factor(time);
    const double of_second = courses[1].factor(time);
    const double of_third = courses[2].factor(time);
    EXPECT_NEAR(of_first + of_second + of_third, 1.0, 1e-15) << time;
    EXPECT_GE(std::min({of_first, of_second, of_third}), 0.0) << time;
  }
  EXPECT_EQ(courses[0].factor(1.0), 1.0);
  EXPECT_EQ(courses[2].factor(4.0), 1.0);
}

TEST(LoadScene, IsReadAndWrittenAgain) {
  const Scene scene = good(
      head + block + "[[block.load]]\npoint = [0.5, 1]\nforce = [0, -1e5]\nramp = 0.5\n" +
      "[[block.load]]\npoint = [0.5, 1]\nforce = [1e5, 0]\ntable = [[0, 0], [0.25, 1.5], [1, -1]]\n" + first +
      "[[stage]]\nkind = \"change\"\nramp = 0.25\n" +
      "set = { \"block.a.load\" = [ { point = [0.5, 1], force = [0, -2e5], table = [[0, 1], [2, 3]] } ] }\n");
  ASSERT_EQ(scene.blocks.at(0).loads.size(), 2U);
  EXPECT_EQ(scene.blocks[0].loads[0].ramp, 0.5);
  EXPECT_TRUE(scene.blocks[0].loads[0].table.empty());
  EXPECT_EQ(scene.blocks[0].loads[1].ramp, 0.0);
  EXPECT_EQ(scene.blocks[0].loads[1].table, (std::vector<LoadRow>{{0.0, 0.0}, {0.25, 1.5}, {1.0, -1.0}}));
  EXPECT_EQ(scene.stages.at(1).ramp, 0.25);
  EXPECT_FALSE(scene.stages[1].changes_stress);
  EXPECT_EQ(scene.stages[1].after->blocks[0].loads.at(0).table,
            (std::vector<LoadRow>{{0.0, 1.0}, {2.0, 3.0}}));
  const Scene again = good(scene.resolved);
  expect_same(scene, again);
  EXPECT_EQ(again.stages.at(1).ramp, 0.25);
  expect_same(*scene.stages[1].after, *again.stages[1].after);
}

TEST(LoadScene, StagesSayTheStressFromThereOn) {
  const Scene scene =
      good(head + region + first + "[[stage]]\nkind = \"change\"\nramp = 0.5\n" +
           "set = { \"in_situ.vertical_stress\" = 3e6, \"region.stress\" = [\"top\", \"right\"] }\n" +
           "[[stage]]\nkind = \"run\"\nduration = 1.0\nset = { \"run.contact_damping\" = 0.1 }\n" +
           "[[stage]]\nkind = \"change\"\nset = { \"in_situ\" = { principal_stresses = [2e6, 1e6] } }\n");
  const InSituStress &start = scene.in_situ;
  ASSERT_EQ(start.boundaries.size(), 1U);
  EXPECT_EQ(start.compression_at({1.0, 1.0}), (Mat2{0.5e6, 0.0, 0.0, 1e6}));
  ASSERT_TRUE(scene.stages.at(1).changes_stress);
  const InSituStress &second = scene.stages[1].after->in_situ;
  EXPECT_EQ(second.boundaries.size(), 2U);
  EXPECT_EQ(second.compression_at({1.0, 1.0}), (Mat2{1.5e6, 0.0, 0.0, 3e6}));
  EXPECT_FALSE(scene.stages.at(2).changes_stress);
  ASSERT_TRUE(scene.stages.at(3).changes_stress);
  EXPECT_EQ(scene.stages[3].after->in_situ.compression_at({1.0, 1.0}), (Mat2{2e6, 0.0, 0.0, 1e6}));
  EXPECT_EQ(scene.stages[3].after->in_situ.boundaries.size(), 2U) << "sides stay";
  EXPECT_EQ(good(scene.resolved).stages.at(1).after->in_situ.at_level, second.at_level);
}

struct Bad {
  const char *name;
  std::string text;
  std::string message; ///< without the file
};

class BadLoads : public ::testing::TestWithParam<Bad> {};

TEST_P(BadLoads, SayWhatIsWrong) {
  const SceneReading reading = read_scene(GetParam().text, "s", {});
  const std::vector<std::string> found = messages(reading);
  ASSERT_EQ(found.size(), 1U) << ::testing::PrintToString(found);
  EXPECT_EQ(found[0], "s:" + GetParam().message);
}

/// The keys begin at line 14.
std::string loaded(const std::string &keys) {
  return "[run]\nduration = 1.0\n" + head.substr(head.find('\n') + 1) + block +
         "[[block.load]]\npoint = [0.5, 1]\nforce = [0, -1e5]\n" + keys;
}

INSTANTIATE_TEST_SUITE_P(
    Loads, BadLoads,
    ::testing::Values(
        Bad{"Both", loaded("ramp = 0.5\ntable = [[0, 1]]\n"),
            "14:8: error: load 0 of block 'a' has both ramp and table, each says how its force changes with "
            "time, leave one of them out"},
        Bad{"NegativeRamp", loaded("ramp = -1\n"),
            "14:8: error: 'ramp' in load 0 of block 'a' is -1, it must be at least 0 and at most 1e+12, for "
            "example ramp = 0.5"},
        Bad{"NoArray", loaded("table = 3\n"),
            "14:9: error: 'table' in load 0 of block 'a' is an integer, it must be an array of rows [t, "
            "factor], for example table = [[0, 0.0], [0.5, 1.0], [2.0, 1.0], [2.1, 0.0]]"},
        Bad{"Empty", loaded("table = []\n"),
            "14:9: error: 'table' in load 0 of block 'a' has 0 rows, it must have 1 to 100000, for example "
            "table = [[0, 0.0], [0.5, 1.0], [2.0, 1.0], [2.1, 0.0]]"},
        Bad{"Width", loaded("table = [[0, 1, 2]]\n"),
            "14:10: error: row 0 of 'table' in load 0 of block 'a' has length 3, it must have length 2, for "
            "example table = [[0, 0.0], [0.5, 1.0], [2.0, 1.0], [2.1, 0.0]]"},
        Bad{"LateBegin", loaded("table = [[1, 1]]\n"),
            "14:11: error: row 0 of 'table' in load 0 of block 'a' has the time 1, the table must begin at "
            "0, "
            "add a row for the time 0"},
        Bad{"Backwards", loaded("table = [[0, 1], [2, 1], [2, 3]]\n"),
            "14:27: error: row 2 of 'table' in load 0 of block 'a' has the time 2, it must be above that of "
            "the row before, 2, order the rows by time"},
        Bad{"RampOfNothing",
            head + block + first +
                "[[stage]]\nkind = \"change\"\nramp = 0.5\nset = { \"run.gravity\" = [1, -9] }\n",
            "15:8: error: 'ramp' in stage 'stage1' has no meaning, it belongs to stages that set "
            "in_situ.KEY, "
            "region.stress or block.NAME.load: everything else changes at once, leave it out"},
        Bad{"NoInSitu",
            head + block + first + "[[stage]]\nkind = \"change\"\nset = { \"in_situ.k0\" = 2.0 }\n",
            "15:9: error: 'in_situ.k0' names no in_situ of the scene, [in_situ] is not there, write the "
            "table "
            "into the scene"},
        Bad{"OtherKeyOfTheRegion",
            head + region + first + "[[stage]]\nkind = \"change\"\nset = { \"region.roller\" = [\"top\"] }\n",
            "19:9: error: a stage cannot set 'region.roller', it sets values of joints, materials, water and "
            "support, in_situ.KEY, region.stress, block.NAME.fixed, block.NAME.load, bolt.NAME.active, "
            "bolt_pattern.NAME.active, liner.NAME.active and some of [run], for example set = { "
            "\"joint.default.friction_angle_deg\" = 25.0 }"},
        Bad{"HeldSide",
            head + region + first +
                "[[stage]]\nkind = \"change\"\nset = { \"region.stress\" = [\"top\", \"left\"] }\n",
            "19:35: error: the left side of [region] is a roller and under stress, what holds it bears "
            "whatever acts on it, leave it out of 'roller' or of 'stress'"},
        Bad{"NoSide",
            head + region.substr(0, region.find("stress = ")) + region.substr(region.find("[in_situ]")) +
                first + "[[stage]]\nkind = \"change\"\nset = { \"in_situ.k0\" = 2.0 }\n",
            "18:9: error: the change of stress acts on nothing, it acts on the sides of [region] that are "
            "under stress, and blocks follow by equilibrium, name sides in region.stress, for example stress "
            "= [\"top\"]"},
        Bad{"Pull",
            head + region + "level = 10.0\n" + first +
                "[[stage]]\nkind = \"change\"\nset = { \"in_situ.level\" = 2.0, "
                "\"in_situ.vertical_stress\" = 0.0 }\n",
            "20:32: error: the stress would pull at [4, 4] with 5.1e+04 Pa, a side of [region] under stress "
            "is only pushed, raise in_situ.level or in_situ.vertical_stress"}),
    [](const auto &param) { return std::string(param.param.name); });

} // namespace
} // namespace gcpdda::load_courses_test
