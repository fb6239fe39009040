// The same members whoever runs them, at once or one call after another.

#include "base/check.hpp"
#include "driver/ensemble.hpp"
#include "gcpdda/io/scene_reader.hpp"
#include "shared_folder.hpp"
#include "simulation/simulation.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace gcpdda::ensemble_test {
namespace {

namespace fs = std::filesystem;

using testing::SharedFolder;

class Members {
public:
  explicit Members(std::vector<std::string> sets) : sets_(std::move(sets)) {}

  int run(const Communicator &communicator, const fs::path &folder, std::int64_t count) const {
    const Scene scene = scene_with({"ensemble.count=" + std::to_string(count)});
    const auto member_scene = [&](const Communicator & /*group*/, const std::vector<double> &values) {
      return scene_with({assignment(scene.ensemble.variations[0], values[0]),
                         assignment(scene.ensemble.variations[1], values[1])});
    };
    return run_ensemble(communicator, scene, member_scene, {folder, false, "text"});
  }

private:
  [[nodiscard]] Scene scene_with(std::vector<std::string> more) const {
    more.insert(more.begin(), sets_.begin(), sets_.end());
    // Ten times as soft as the shipped one: a third of the steps.
    more.insert(more.begin(), {"joint.default.normal_stiffness=2e7", "fos.limit=3.0"});
    const SceneReading reading = read_scene(testing::shipped_toml("plane_failure"), "plane.toml", more);
    if (has_errors(reading.diagnostics)) {
      throw SceneError(reading.diagnostics);
    }
    return reading.scene;
  }
  std::vector<std::string> sets_;
};

/// The rows of all members without what they have cost.
std::vector<std::string> rows_in(const fs::path &folder) {
  std::vector<std::string> rows;
  for (std::string row : testing::lines_of(testing::file_text(folder / "ensemble_members.csv"))) {
    std::size_t at = 0;
    for (int commas = 0; commas < 5; ++commas) {
      at = row.find(',', at) + 1;
    }
    rows.push_back(row.erase(at, row.find(',', at) - at));
  }
  return rows;
}

TEST(Ensemble, MembersAreTheSameOnAnyNumberOfRanks) {
  const Communicator world = Communicator::world();
  if (world.size() > 4) { // one to four will do
    return;
  }
  const SharedFolder folder(world);
  const testing::CapturedLog log;
  const testing::CapturedOutput output;
  const std::string soon = "stage.weight.limit=1.5"; // some are undecided then
  const Members members({soon});
  EXPECT_EQ(members.run(world, folder.path("dealt"), 5), 0);
  const Members together({soon, "ensemble.ranks=" + std::to_string(world.size())});
  EXPECT_EQ(together.run(world, folder.path("together"), 2), 0);
  EXPECT_EQ(together.run(world, folder.path("together"), 5), 0) << "goes on with three more";
  world.barrier();
  if (!world.is_root()) {
    return;
  }
  EXPECT_EQ(members.run(Communicator::self(), folder.path("alone"), 5), 0);
  const std::vector<std::string> alone = rows_in(folder.path("alone"));
  ASSERT_EQ(alone.size(), 6U) << "a header and five members";
  EXPECT_EQ(rows_in(folder.path("dealt")), alone);
  EXPECT_EQ(rows_in(folder.path("together")), alone);
  EXPECT_NE(log.text().find("2 of 5 members are there already"), std::string::npos) << log.text();
  EXPECT_FALSE(fs::exists(folder.path("alone") / "members/member_000000")) << "what is not to be kept";
}

// One by a search of all ranks at once, one in which each has its own.
TEST(Ensemble, FactorsAreTheSameOnAnyNumberOfRanks) {
  const Communicator world = Communicator::world();
  if (world.size() == 1 || world.size() > 4) { // two, three and four will do
    return;
  }
  const SharedFolder folder(world);
  const testing::CapturedLog log;
  const testing::CapturedOutput output;
  const std::vector<std::string> coarse{"ensemble.measure=factor", "fos.tolerance=0.7", "fos.from=0.5",
                                        "fos.to=2.0"};
  const Members members(coarse);
  EXPECT_EQ(members.run(world, folder.path("dealt"), 2), 0);
  world.barrier();
  if (!world.is_root()) {
    return;
  }
  EXPECT_EQ(members.run(Communicator::self(), folder.path("alone"), 2), 0);
  EXPECT_EQ(rows_in(folder.path("dealt")), rows_in(folder.path("alone")));
  EXPECT_EQ(testing::json_value(folder.path("alone") / "ensemble.json", "factors"), "2");
  EXPECT_NE(testing::file_text(folder.path("alone") / "ensemble.svg").find("<polygon"), std::string::npos);
}

// Members that are refused, here for a friction angle above 90 degrees, are told and counted apart.
TEST(Ensemble, GoesOnBeyondMembersThatCannotRun) {
  const Communicator world = Communicator::world();
  const SharedFolder folder(world);
  const testing::CapturedLog log;
  const testing::CapturedOutput output;
  const Members members(
      {"ensemble.vary=[{key=\"joint.default.friction_angle_deg\", distribution=\"uniform\", "
       "min=40, max=130}, {key=\"joint.default.cohesion\", distribution=\"uniform\", min=0, "
       "max=1}]"});
  EXPECT_EQ(members.run(world, folder.path("e"), 6), 0);
  if (!world.is_root()) {
    return;
  }
  int refused = 0;
  for (const std::string &row :
       testing::lines_of(testing::file_text(folder.path("e") / "ensemble_members.csv"))) {
    if (row.find("cannot_run") != std::string::npos) {
      ++refused;
      EXPECT_NE(row.find("it must be at least 0 and below 90"), std::string::npos) << row;
    }
  }
  EXPECT_GE(refused, 1);
  EXPECT_LT(refused, 6);
  EXPECT_EQ(testing::json_value(folder.path("e") / "ensemble.json", "cannot_run"), std::to_string(refused));
  EXPECT_EQ(testing::json_value(folder.path("e") / "ensemble.json", "holds"), std::to_string(6 - refused));
}

TEST(Ensemble, TroubleWithItsFolderEndsItOnAllRanks) {
  const Communicator world = Communicator::world();
  const SharedFolder folder(world);
  const testing::CapturedLog log;
  const testing::CapturedOutput output;
  const Members members({});
  if (world.is_root()) {
    fs::create_directories(folder.path("e"));
    std::ofstream(folder.path("e") / "scene.toml") << "a run";
  }
  world.barrier();
  EXPECT_THROW(members.run(world, folder.path("e"), 2), FileError);
  if (world.is_root()) { // a file where a member wants its folder
    fs::create_directories(folder.path("f") / "members");
    std::ofstream(folder.path("f") / "members/member_000001") << "in the way";
  }
  world.barrier();
  EXPECT_THROW(members.run(world, folder.path("f"), 2), FileError);
}

} // namespace
} // namespace gcpdda::ensemble_test
