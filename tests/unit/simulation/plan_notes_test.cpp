// What is said of the time step, in runs of several stages.

#include "simulation/simulation.hpp"
#include "support/scenes.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace gcpdda::testing::plan_notes_test {
namespace {

/// How often a run of a square on a floor says that the rows of its histories shorten the time step, and that
/// checkpoints are not written when asked for.
struct Said {
  int of_histories = 0;
  int of_checkpoints = 0;
  bool operator==(const Said &) const = default;
};

/// @param more  blocks
Said said_of_steps(const std::string &stages, const std::string &more = "") {
  Simulation simulation(
      Communicator::self(),
      scene_of("[run]\nfidelity = \"rigid\"\n[output]\ninterval = 0.1\nhistory_interval = 0.001\n"
               "checkpoint_interval = 0.1234567\n[material.rock]\ndensity = 2600\n[joint.default]\n"
               "normal_stiffness = 1e7\nfriction_angle_deg = 30\n" +
               block_toml("floor", rectangle({-1.0, -1.0}, {2.0, 0.0}), "fixed = true") +
               block_toml("square", rectangle({0.0, 0.0}, {1.0, 1.0})) + more + stages));
  run_stages(simulation);
  Said said;
  for (const Diagnostic &note : simulation.notes()) {
    said.of_histories += note.what.find("shortens the time step") != std::string::npos ? 1 : 0;
    said.of_checkpoints += note.what.find("checkpoints are written") != std::string::npos ? 1 : 0;
  }
  return said;
}

TEST(PlanNotes, AreGivenOnceWhereStepsAreTaken) {
  const std::string dynamic = "[[stage]]\nkind = \"run\"\nduration = 0.1\n";
  const std::string change = "[[stage]]\nkind = \"change\"\nset = { \"joint.default.cohesion\" = 1e4 }\n";
  const std::string at_rest = "[[stage]]\nkind = \"settle\"\nlimit = 20\nsolver = \"static\"\n";
  EXPECT_EQ(said_of_steps(dynamic), (Said{1, 1}));
  EXPECT_EQ(said_of_steps(dynamic + change + dynamic + dynamic), (Said{1, 1}));
  EXPECT_EQ(said_of_steps(at_rest + change + at_rest), (Said{0, 0})) << "no time passes in steps";
  EXPECT_EQ(said_of_steps(at_rest + change + dynamic), (Said{1, 1}));
}

// Where the static solver leaves its stage to the dynamic step, that takes the steps of the plan.
TEST(PlanNotes, AreGivenWhereTheDynamicStepTakesOver) {
  const std::string driven =
      block_toml("driven", rectangle({5.0, 5.0}, {6.0, 6.0}), "prescribed_velocity = [0.1, 0.0, 0.0]");
  EXPECT_EQ(said_of_steps("[[stage]]\nkind = \"settle\"\nlimit = 20\nsolver = \"static\"\n", driven),
            (Said{1, 1}));
}

} // namespace
} // namespace gcpdda::testing::plan_notes_test
