#include "gcpdda/io/scene_reader.hpp"

#include "base/edit_distance.hpp"
#include "unit/scene_texts.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace gcpdda::scene_sets_test {
namespace {

using namespace gcpdda::testing;

std::vector<std::string> faults(const Sets &sets) {
  return messages(read_scene(small_scene, "s.toml", sets));
}

TEST(SceneSets, ReplaceAndCreate) {
  const Scene scene =
      good(small_scene, {"run.duration=3", "run.duration = 4", "output.contacts=false",
                         "joint.self.materials=[\"granite\", 'granite']", "joint.self.friction_angle_deg=45",
                         "run.potential=\"linear\"", "run.contact_time=predictor-end"});
  EXPECT_EQ(scene.run.duration, 4.0); // the last one counts
  EXPECT_EQ(scene.output.interval, 0.04);
  EXPECT_FALSE(scene.output.contacts);
  EXPECT_EQ(scene.joints.between(0, 0), 1);
  EXPECT_EQ(scene.joints.laws[1].normal_stiffness, 1e9);
  EXPECT_EQ(scene.run.potential, PotentialKind::linear);
  EXPECT_EQ(scene.run.contact_time, ContactTime::predictor_end);
}

TEST(SceneSets, AddressBlocksByName) {
  EXPECT_TRUE(good(small_scene, {"block.slider.fixed=true"}).blocks[0].fixed);
  EXPECT_FALSE(good(full_scene, {"block.b1.fixed=false"}).blocks[1].fixed);
  const std::array<double, 3> still{};
  EXPECT_EQ(good(full_scene, {"block.slider.1.velocity=[0, 0, 0]"}).blocks[0].velocity, still);
  EXPECT_EQ(good(full_scene, {"block.'slider.1'.velocity=[0, 0, 0]"}).blocks[0].velocity, still);
}

TEST(SceneSets, CanMendAScene) {
  EXPECT_EQ(read_scene("[run]\nduration = -1\n", "s.toml",
                       {"run.duration=1", "material.m.density=1", "joint.default.normal_stiffness=1",
                        "block=[{material='m', vertices=[[0,0],[1,0],[0,1]]}]"})
                .diagnostics.size(),
            0U);
}

TEST(SceneSets, FaultsNameTheArgument) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"run.time_step",
       "not of the form path=value, a path is made of names joined by dots, for example --set "
       "run.time_step=1e-4"},
      {"run..safety=1",
       "not of the form path=value, a path is made of names joined by dots, for example --set "
       "run.time_step=1e-4"},
      {"run.time_step=-1",
       "'time_step' in [run] is -1, it must be above 0 and at most 1e+12, for example time_step "
       "= 1e-4"},
      {"run.time_step=1e-4s", "'time_step' in [run] is '1e-4s', it must be a number or \"auto\", for example "
                              "time_step = 1e-4"},
      {"run.accepted_error=nan",
       "'accepted_error' in [run] is nan, it must be finite, for example accepted_error = "
       "0.01"},
      {"run.saftey=1", "unknown key 'saftey' in [run], did you mean 'safety'?"},
      {"rum.safety=1", "unknown key 'rum', did you mean 'run'?"},
      {"run.gravity=[0,", "not valid TOML, Error while parsing array: encountered end-of-file, check quotes, "
                          "brackets and = up to this place"},
      {"run.duration.x=1", "'duration' is not a table, the path goes on below it, shorten the path"},
      {"run.safety=0.5\nrun.x=1",
       "the value is more than one TOML value, give every assignment its own --set"},
      {"block.slidr.fixed=true", "no block is named 'slidr', did you mean 'slider'?"},
      {"block.slider=1", "'block.slider' names no key of a block, for example --set block.slider.fixed=true"},
      {"block.slider.vertices=[[0,0],[1,1],[1,0],[0,1]]",
       "block 'slider' crosses itself, two of its edges meet away from a common vertex, list the vertices in "
       "order "
       "around the block"},
      {"material.clay.youngs_modulus=1",
       "'density' in [material.clay] is missing, it is required, for example "
       "density = 2600.0"},
      {"wall.rows=3", "'wall.rows' names no key of a wall, for example --set wall.wall0.rows=20"},
      {"pyramid.p.rows=3", "no pyramid is named 'p', unnamed pyramids are pyramid<n>, from 0 in file order"}};
  for (const auto &[set, message] : cases) {
    std::string label = set;
    if (const std::size_t line_break = label.find('\n'); line_break != std::string::npos) {
      label[line_break] = ' ';
    }
    EXPECT_EQ(faults({set}), std::vector<std::string>{"--set " + label + ": error: " + message});
  }
}

TEST(SceneSets, AskForAListWholeWhoseTablesHaveNoNames) {
  const std::string scene = small_scene + "[[block.load]]\npoint = [1, 1]\nforce = [0, -1]\n"
                                          "[[monitor]]\nname = \"roof\"\npoint = [0.5, 0.5]\n";
  for (const auto &[set, list] : {std::pair("monitor.roof.point=[8, 7.4]", "monitor"),
                                  std::pair("block.slider.load.0.force=[0, 1]", "block.slider.load")}) {
    EXPECT_EQ(messages(read_scene(scene, "s.toml", {set})),
              std::vector<std::string>{fmt::format(
                  "--set {}: error: '{}' is a list of tables, --set cannot change a key of a single table of "
                  "it, give the whole list as --set '{}=[{{...}}]'",
                  set, list, list)});
  }
  EXPECT_EQ(good(scene, {"monitor=[{name = 'roof', point = [0.5, 0.75]}]"}).monitors[0].point.y, 0.75);
}

TEST(SceneSets, FaultsComeAfterThoseOfTheFileInTheOrderOfTheSets) {
  const SceneReading reading =
      read_scene("[run]\nduration = 0\n" + small_scene.substr(small_scene.find("[mat")), "s.toml",
                 {"zzz=1", "run.safety=2", "aaa=1"});
  ASSERT_EQ(reading.diagnostics.size(), 4U);
  EXPECT_EQ(reading.diagnostics[0].where.file, "s.toml");
  EXPECT_EQ(reading.diagnostics[0].where.line, 2);
  EXPECT_EQ(reading.diagnostics[1].where.file, "--set zzz=1");
  EXPECT_EQ(reading.diagnostics[1].where.line, 0);
  EXPECT_EQ(reading.diagnostics[2].where.file, "--set run.safety=2");
  EXPECT_EQ(reading.diagnostics[3].where.file, "--set aaa=1");
}

/// What is said of two stages of which the second one has these values.
std::vector<std::string> faults_of_stage(const std::string &scene, const std::string &values) {
  return messages(read_scene(scene +
                                 "[[stage]]\nkind = \"run\"\nduration = 1\n[[stage]]\nkind = "
                                 "\"run\"\nduration = 1\nset = { " +
                                 values + " }\n",
                             "s.toml", {}));
}

TEST(StageSets, NameTheTableThatIsNotThere) {
  const std::string scene = "[run]\n" + small_scene.substr(small_scene.find("[material"));
  for (const auto &[table, key] :
       {std::pair("water.lake", "density"), std::pair("support.bar", "axial_yield"),
        std::pair("joint.fault", "cohesion"), std::pair("material.clay", "density")}) {
    const std::vector<std::string> said = faults_of_stage(scene, fmt::format("\"{}.{}\" = 1.0", table, key));
    ASSERT_EQ(said.size(), 1U) << table;
    EXPECT_NE(said[0].find(fmt::format(", [{}] is not there, check the name", table)), std::string::npos)
        << said[0];
  }
}

TEST(StageSets, SayWhichBlocksHaveValues) {
  const std::string scene = "[run]\n" + small_scene.substr(small_scene.find("[material")) +
                            "[[wall]]\nname = \"w\"\nmaterial = \"granite\"\norigin = [5, 5]\nrows = "
                            "4\ncolumns = 4\nblock_size = [1, 1]\n";
  const std::vector<std::string> said = faults_of_stage(scene, "\"block.w.3.0.fixed\" = true");
  ASSERT_EQ(said.size(), 1U);
  EXPECT_NE(
      said[0].find("error: no [[block]] is named 'w.3.0', values can be set of blocks that have a [[block]] "
                   "table, not of those that walls, pyramids, a block file or a region make, write the "
                   "block as a [[block]] of its own"),
      std::string::npos)
      << said[0];
  EXPECT_NE(faults_of_stage(scene, "\"block.slidr.fixed\" = true").at(0).find("did you mean 'slider'?"),
            std::string::npos);
}

TEST(EditDistance, PrefersSwappedCharacters) {
  EXPECT_EQ(nearest_word("jsc", {"jrc", "jcs"}), "jcs");
  EXPECT_EQ(nearest_word("jsc", {"jcs", "jrc"}), "jcs");
  EXPECT_EQ(nearest_word("jrx", {"jrc", "jcs"}), "jrc");
}

TEST(EditDistance, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("saftey", "safety"), 1U);
  EXPECT_EQ(nearest_word("colour", {"cohesion", "density"}), "");
  EXPECT_EQ(nearest_word("grav", {"duration", "gravity"}), "gravity");
}

} // namespace
} // namespace gcpdda::scene_sets_test
