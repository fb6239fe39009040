// Warnings about earthquakes that are hardly meant.

#include "simulation/shaking_doubts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gcpdda::testing::shaking_doubts_test {
namespace {

/// A block on a plane.
std::string scene_toml(const std::string &earthquake, const std::string &stages,
                       const std::string &run = "") {
  return "[run]\ncontact_damping = 0.3\n" + run +
         "[material.rock]\ndensity = 2600\n[joint.default]\nnormal_stiffness = 1e9\nfriction_angle_deg = "
         "30\n" +
         block_toml("floor", rectangle({-9.0, -1.0}, {9.0, 0.0}), "fixed = true") +
         block_toml("slab", rectangle({0.0, 0.0}, {2.0, 1.0})) + "[output]\ninterval = 0.1\n" +
         "[earthquake]\nrecord = \"r.csv\"\n" + earthquake + stages;
}

const std::string accelerations = "quantity = \"acceleration\"\n";
const std::string settle = "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 5\n";
const std::string rest = "[[stage]]\nname = \"rest\"\nkind = \"settle\"\nlimit = 5\n";

std::string shaking(double duration) {
  return fmt::format("[[stage]]\nname = \"shaking\"\nkind = \"run\"\nduration = {}\n", duration);
}

/// Rows every 0.1 s for 2 s that take the values peak and -peak by turns and end at zero.
std::vector<RecordRow> record_of(double peak) {
  std::vector<RecordRow> rows;
  for (int k = 0; k <= 20; ++k) {
    rows.push_back({0.1 * k, {k == 20 ? 0.0 : k % 2 == 0 ? peak : -peak, 0.0}});
  }
  return rows;
}

std::vector<std::string> doubts_of(const std::string &toml, const std::vector<RecordRow> &record) {
  Scene scene = scene_of(toml);
  scene.earthquake.record = record;
  std::vector<std::string> texts;
  for (const Diagnostic &doubt : doubts_of_shaking(scene)) {
    texts.push_back(to_string(doubt));
  }
  return texts;
}

void expect_one(const std::vector<std::string> &texts, const std::string &what, const std::string &hint) {
  ASSERT_EQ(texts.size(), 1U) << fmt::format("{}", fmt::join(texts, "\n"));
  EXPECT_NE(texts[0].find("warning: " + what), std::string::npos) << texts[0];
  EXPECT_TRUE(texts[0].ends_with(hint)) << texts[0];
}

TEST(ShakingDoubts, OfTheUsualStagesGiveNoAlarm) {
  const std::vector<std::string> none;
  const std::string by_name = accelerations + "stage = \"shaking\"\n";
  EXPECT_EQ(doubts_of(scene_toml(by_name, settle + shaking(2.0) + rest), record_of(5.0)), none);
  EXPECT_EQ(doubts_of(scene_toml(by_name, settle + shaking(3.0)), record_of(5.0)), none);
  EXPECT_EQ(doubts_of(scene_toml(accelerations, shaking(2.0) + rest), record_of(5.0)), none);
  EXPECT_EQ(doubts_of(scene_toml(accelerations + "start = 5.0\n", settle + shaking(7.0)), record_of(5.0)),
            none);
  EXPECT_EQ(doubts_of(scene_toml(accelerations, "", "duration = 2.0\n"), record_of(5.0)), none);
  EXPECT_EQ(doubts_of(scene_toml("", shaking(2.0)), record_of(0.3)), none) << "of velocities";
}

TEST(ShakingDoubts, OfRecordsThatPlayInASettleStage) {
  const std::string why = "a settle stage looks for equilibrium, and its damping takes the motion";
  for (const char *begin : {"", "stage = \"weight\"\n"}) {
    const std::vector<std::string> texts =
        doubts_of(scene_toml(accelerations + begin, settle + shaking(2.0)), record_of(5.0));
    expect_one(texts, "the record plays in stage 'weight', which is a settle stage, " + why,
               "write earthquake.stage = \"shaking\"");
  }
  expect_one(
      doubts_of(scene_toml(accelerations + "start = 1.0\n", settle + shaking(9.0)), record_of(5.0)),
      "the record begins at t = 1 s and may play in settle stage 'weight', which may last until t = 5 s",
      "write earthquake.stage = \"shaking\"");
  expect_one(doubts_of(scene_toml(accelerations, settle), record_of(5.0)),
             "the record plays in stage 'weight'", "and name it in earthquake.stage");
}

TEST(ShakingDoubts, OfRecordsThatAreCut) {
  const std::string by_name = accelerations + "stage = \"shaking\"\n";
  const std::string what = "stage 'shaking' ends after 1 s of the record, which moves the ground for 2 s, ";
  expect_one(doubts_of(scene_toml(by_name, settle + shaking(1.0)), record_of(5.0)),
             what + "the run ends before", "use stage.shaking.duration = 2 or more");
  expect_one(doubts_of(scene_toml(by_name, settle + shaking(1.0) + rest), record_of(5.0)),
             what + "settle stage 'rest' follows", "use stage.shaking.duration = 2 or more");
  expect_one(doubts_of(scene_toml(accelerations + "start = 0.5\n", "", "duration = 2.0\n"), record_of(5.0)),
             "the run ends after 1.5 s of the record", "use run.duration = 2.5 or more");
  // Rows in which nothing moves any more may be cut.
  std::vector<RecordRow> quiet = record_of(5.0);
  quiet.push_back({4.0, {}});
  EXPECT_EQ(doubts_of(scene_toml(by_name, settle + shaking(2.0)), quiet), std::vector<std::string>{});
}

TEST(ShakingDoubts, OfTheDampingThatNobodyHasChosen) {
  const auto told = [](const std::string &damping, const std::string &set) {
    std::string toml = scene_toml(accelerations + "stage = \"shaking\"\n", settle + shaking(2.0) + set);
    const std::string given = "contact_damping = 0.3\n";
    return doubts_of(toml.replace(toml.find(given), given.size(), damping), record_of(5.0));
  };
  expect_one(told("", ""), "the ground shakes with the default contact_damping of 0.05",
             "run.contact_damping = 0.05 keeps it");
  for (const char *damping : {"contact_damping = 0.05\n", "rayleigh = {ratio = 0.02, frequency = 5.0}\n"}) {
    EXPECT_EQ(told(damping, ""), std::vector<std::string>{});
  }
  EXPECT_EQ(told("", "set = {\"run.contact_damping\" = 0.3}\n"), std::vector<std::string>{});
}

TEST(ShakingDoubts, OfDragInTheStageThatShakes) {
  const std::string by_name = accelerations + "stage = \"shaking\"\n";
  const std::string drag = "local_damping = 0.3\n";
  expect_one(doubts_of(scene_toml(by_name, settle + shaking(2.0) + drag), record_of(5.0)),
             "stage 'shaking', in which the ground may shake, has a local damping of 0.3",
             "run.contact_damping and run.rayleigh damp as joints and rock do");
  EXPECT_EQ(
      doubts_of(scene_toml(by_name, settle + "solver = \"dynamic\"\n" + drag + shaking(2.0)), record_of(5.0)),
      std::vector<std::string>{});
}

TEST(ShakingDoubts, OfTheStrengthOfARecord) {
  const std::string stages = shaking(2.0);
  const std::string cm = "if the record is in cm, set earthquake.scale = 0.01; in mm, 0.001";
  const std::string other = "if the record holds accelerations, write earthquake.quantity = \"acceleration\"";
  expect_one(doubts_of(scene_toml(accelerations, stages), record_of(25.0)),
             "the peak of the record is 25 m/s2, records of strong shaking have peaks of 1 to 20 m/s2", cm);
  expect_one(doubts_of(scene_toml(accelerations + "scale = 100\n", stages), record_of(5.0)),
             "the peak of the record is 500 m/s2", "set earthquake.scale = 1; in mm, 0.1");
  expect_one(doubts_of(scene_toml("", stages), record_of(5.0)), "the peak of the record is 5 m/s",
             other + "; " + cm);
  expect_one(doubts_of(scene_toml("", stages), record_of(2.0)),
             "the record, read as velocities, has a peak acceleration of 40 m/s2",
             other + "; if it holds velocities, write \"velocity\"");
  EXPECT_EQ(doubts_of(scene_toml("quantity = \"velocity\"\n", stages), record_of(2.0)),
            std::vector<std::string>{});
  EXPECT_EQ(doubts_of(scene_toml(accelerations, stages, "gravity = [0, -1]\n"), record_of(25.0)),
            std::vector<std::string>{})
      << "normalised units";
}

} // namespace
} // namespace gcpdda::testing::shaking_doubts_test
