// The same factor of safety whatever runs at once.

#include "driver/safety_factor.hpp"
#include "shared_folder.hpp"
#include "support/plane_failure.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace gcpdda::safety_factor_test {
namespace {

namespace fs = std::filesystem;

/// Blocks, joints that slip or have opened, and legend.
void expect_same_picture(const fs::path &one, const fs::path &other) {
  const std::string picture = testing::file_text(one / "fos.svg");
  EXPECT_EQ(picture, testing::file_text(other / "fos.svg"));
  constexpr int of_legend = 1;
  EXPECT_GT(testing::count_of(picture, "#7a0fa8"), of_legend) << "a joint slips";
}

TEST(SafetyFactor, IsTheSameOnAnyNumberOfRanks) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const testing::CapturedOutput output;
  const Scene scene = testing::scene_of(testing::plane_failure_toml(0.5),
                                        {"fos.tolerance=0.05", "fos.from=1.6", "fos.to=2.4"});
  EXPECT_EQ(find_safety_factor(world, scene, {folder.path("together"), false}), 0);
  world.barrier();
  if (!world.is_root()) {
    return;
  }
  EXPECT_EQ(find_safety_factor(Communicator::self(), scene, {folder.path("alone"), false}), 0);
  const auto value = [&](const char *run, const char *key) {
    return testing::json_value(folder.path(run) / "fos.json", key);
  };
  for (const char *key : {"factor", "holds", "fails", "undecided", "moving"}) {
    EXPECT_EQ(value("together", key), value("alone", key)) << key;
  }
  expect_same_picture(folder.path("together"), folder.path("alone"));
  EXPECT_NEAR(std::stod(value("alone", "factor")), testing::plane_failure_factor(0.5), 0.05);
  const int together =
      testing::count_of(testing::file_text(folder.path("together") / "fos.json"), "\"ranks\"");
  const int alone = testing::count_of(testing::file_text(folder.path("alone") / "fos.json"), "\"ranks\"");
  EXPECT_GE(together, alone) << "ranks to spare try factors that might be next";
}

// Masonry on the plane, a trial by one rank or by all of them.
TEST(SafetyFactor, IsTheSameWhenRanksShareATrial) {
  const Communicator world = Communicator::world();
  if (world.size() == 1 || world.size() > 4) { // two, three and four will do
    return;
  }
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const testing::CapturedOutput output;
  const Scene scene = testing::scene_of(
      testing::plane_failure_toml(0.0),
      {"fos.tolerance=0.9", "fos.from=1.0", "fos.to=1.9", "fos.limit=2.0",
       "joint.default.normal_stiffness=2e7",
       "wall=[{material=\"rock\", origin=[4.0, 0.0], rows=2, columns=3, block_size=[1.0, 0.5]}]"});
  EXPECT_EQ(find_safety_factor(world, scene, {folder.path("shared"), false, false, 1}), 0);
  world.barrier();
  if (!world.is_root()) {
    return;
  }
  EXPECT_EQ(find_safety_factor(Communicator::self(), scene, {folder.path("alone"), false}), 0);
  for (const char *key : {"factor", "holds", "fails", "undecided", "moving"}) {
    EXPECT_EQ(testing::json_value(folder.path("shared") / "fos.json", key),
              testing::json_value(folder.path("alone") / "fos.json", key))
        << key;
  }
  expect_same_picture(folder.path("shared"), folder.path("alone"));
  EXPECT_EQ(testing::json_value(folder.path("shared") / "fos.json", "ranks"), std::to_string(world.size()));
}

TEST(SafetyFactor, SearchThatCannotRunEndsOnAllRanks) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  Scene scene = testing::scene_of(testing::plane_failure_toml(0.0));
  scene.stages.front().kind = StageKind::run;
  EXPECT_THROW(find_safety_factor(world, scene, {folder.path("fos"), false}), std::runtime_error);
}

} // namespace
} // namespace gcpdda::safety_factor_test
