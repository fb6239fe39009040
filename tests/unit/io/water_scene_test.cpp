// What is said of [water.NAME].

#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

namespace gcpdda::water_scene_test {
namespace {

using namespace testing;

TEST(WaterScene, ReadsLinesAndFamilies) {
  const Scene scene =
      good(small_scene + "[water.a]\nphreatic = [[0, 1], [3, 2]]\n" +
           "[water.b]\nphreatic = [[0, 1], [3, 2]]\njoints = [\"default\"]\nactive = false\n");
  ASSERT_EQ(scene.water.size(), 2U);
  EXPECT_EQ(scene.water[0].name, "a");
  EXPECT_TRUE(scene.water[0].joints.empty());
  EXPECT_TRUE(scene.water[0].active);
  EXPECT_EQ(scene.water[1].joints, std::vector<std::int32_t>{0});
  EXPECT_FALSE(scene.water[1].active);
  EXPECT_EQ(scene.water[0].head(-1.0), 1.0);
  EXPECT_EQ(scene.water[0].head(1.5), 1.5);
  EXPECT_EQ(scene.water[0].head(9.0), 2.0);
}

TEST(WaterScene, FaultsAreToldAllAtOnce) {
  const std::string text = small_scene + R"([water.one]
phreatic = [[0, 1]]
[water.back]
phreatic = [[0, 1], [3, 1], [3, 2]]
joints = ["defult"]
)";
  const std::vector<std::string> expected{
      "s.toml:12:12: error: 'phreatic' in [water.one] has one point, a line has at least two, add its other "
      "end",
      "s.toml:14:29: error: point 2 of 'phreatic' in [water.back] does not lie to the right of the one "
      "before, the line gives one height for each x, write its points from left to right",
      "s.toml:15:11: error: no joint is named 'defult', did you mean 'default'?"};
  EXPECT_EQ(messages(read_scene(text, "s.toml", {})), expected);
}

TEST(WaterScene, GravityAsideHasNoDepth) {
  const SceneReading reading = read_scene(small_scene + "[water.lake]\nphreatic = [[0, 1], [3, 1]]\n",
                                          "s.toml", {"run.gravity=[1, -9]"});
  ASSERT_EQ(reading.diagnostics.size(), 1U);
  EXPECT_EQ(to_string(reading.diagnostics[0]),
            "s.toml:11:1: error: [water.lake] needs gravity along -y, its pressure grows downwards from a "
            "line of heights, write gravity = [0.0, -9.81], or leave the water out");
}

// A stage may tilt gravity where no water is there. What the stage sets is at fault, not the table.
TEST(WaterScene, GravityAsideNeedsWaterThatIsActiveInItsStage) {
  std::string staged = small_scene;
  staged.erase(staged.find("duration"), std::string("duration = 2.0\n").size());
  const std::string lake = staged + "[water.lake]\nphreatic = [[0, 1], [3, 1]]\n";
  const std::string first = "[[stage]]\nkind = \"settle\"\nlimit = 1\n";
  const auto stage = [&](const std::string &set) { return first + "set = { " + set + " }\n"; };
  const std::string aside = "\"run.gravity\" = [1, -9]";
  const std::string dry = "\"water.lake.active\" = false";
  const std::string wet = "\"water.lake.active\" = true";
  const auto told = [](const std::string &text) { return messages(read_scene(text, "s.toml", {})); };
  const std::vector<std::string> none;
  EXPECT_EQ(told(lake + "active = false\n" + first + stage(aside)), none);
  EXPECT_EQ(told(lake + first + stage(dry) + stage(aside)), none);
  EXPECT_EQ(told(lake + first + stage(aside + ", " + dry)), none);
  const std::string what =
      ": error: [water.lake] needs gravity along -y, its pressure grows downwards from a "
      "line of heights, set run.gravity = [0.0, -9.81], or water.lake.active = false";
  EXPECT_EQ(told(lake + first + stage(aside)), std::vector{"s.toml:18:9" + what});
  EXPECT_EQ(told(lake + first + stage(dry) + stage(aside) + stage(wet)), std::vector{"s.toml:26:9" + what});
  EXPECT_EQ(told(lake + first + stage(aside) + stage("\"run.gravity\" = [0, -9]")),
            std::vector{"s.toml:18:9" + what});
}

} // namespace
} // namespace gcpdda::water_scene_test
