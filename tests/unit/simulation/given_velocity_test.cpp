// The step of scenes whose blocks begin or are driven so fast that they could pass through others in the
// step that joints and outputs allow.

#include "driver/run_words.hpp"
#include "simulation/simulation.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gcpdda::testing::given_velocity_test {
namespace {

/// A block of 0.1 m before a thin wall: no point may move by more than a quarter of 0.05 m in a step. The run
/// ends before they meet.
std::string before_a_wall(const std::string &run_keys, const std::string &block_keys) {
  return "[run]\nduration = 0.05\nfidelity = \"rigid\"\ngravity = [0, 0]\n" + run_keys +
         "[material.rock]\ndensity = 2000\n[joint.default]\nnormal_stiffness = 1e7\nfriction_angle_deg = "
         "30\n[output]\ninterval = 0.001\n" +
         block_toml("wall", rectangle({3.0, -1.0}, {3.05, 1.0}), "fixed = true") +
         block_toml("block", rectangle({0.0, -0.05}, {0.1, 0.05}), block_keys);
}
constexpr double fast_step = 0.9 * 0.25 * 0.05 / 50.0; ///< of 50 m/s, s

Simulation begun(const std::string &toml) {
  return Simulation(Communicator::self(), scene_of(toml));
}

void expect_a_run_without_faults(const std::string &toml) {
  Simulation simulation = begun(toml);
  while (!simulation.finished() && !simulation.fault()) {
    simulation.step();
  }
  EXPECT_FALSE(simulation.fault()) << fault_message(simulation);
}

TEST(GivenVelocity, SetsTheStepWhereItIsTheFirstToDoSo) {
  const std::string fast = before_a_wall("", "velocity = [50, 0, 0]");
  const Simulation simulation = begun(fast);
  EXPECT_EQ(simulation.bound().fastest.block, 1);
  EXPECT_NEAR(simulation.bound().time_step, fast_step, 1e-12);
  EXPECT_DOUBLE_EQ(simulation.plan().time_step, 2e-4);
  EXPECT_NE(
      words_on_time_step(simulation)
          .find("recommended at most 0.000225 s, set by block 'block': at its 50 m/s it moves 0.01125 m"),
      std::string::npos)
      << words_on_time_step(simulation);
  expect_a_run_without_faults(fast);

  const Simulation slow = begun(before_a_wall("", "velocity = [1, 0, 0]"));
  const Simulation resting = begun(before_a_wall("", ""));
  EXPECT_FALSE(slow.bound().is_set_by_motion());
  EXPECT_EQ(slow.bound().time_step, resting.bound().time_step);
  EXPECT_EQ(slow.plan().time_step, resting.plan().time_step);
  EXPECT_EQ(words_on_time_step(slow), words_on_time_step(resting));
}

TEST(GivenVelocity, OfADrivenBlockSetsTheStepOfItsStage) {
  const Simulation steady = begun(before_a_wall("", "prescribed_velocity = [0, 50, 0]"));
  EXPECT_NEAR(steady.bound().time_step, fast_step, 1e-12);
  const std::string table =
      "velocity_table = [[0, 0, 0, 0], [0.025, 0, 50, 0], [0.04, 0, 0, 0], [5, 0, 900, 0]]";
  const Simulation driven = begun(before_a_wall("", table));
  EXPECT_NEAR(driven.bound().time_step, fast_step, 1e-12) << "what follows the end does not count";
  expect_a_run_without_faults(before_a_wall("", table));
}

// The block moves on in stages of kind run, and rests after one of kind settle.
TEST(GivenVelocity, CountsUntilAStageBringsBlocksToRest) {
  std::string toml = before_a_wall("", "velocity = [50, 0, 0]");
  toml.erase(toml.find("duration"), std::string("duration = 0.05\n").size());
  const std::string stage = "[[stage]]\nkind = \"run\"\nduration = 0.01\n";
  const auto steps_by_stage = [](const std::string &text) {
    Simulation simulation = begun(text);
    std::vector<bool> set_by_motion{simulation.bound().is_set_by_motion()};
    while (!simulation.finished() && !simulation.fault()) {
      if (simulation.stage_is_over()) {
        simulation.begin_next_stage();
        set_by_motion.push_back(simulation.bound().is_set_by_motion());
      } else {
        simulation.step();
      }
    }
    EXPECT_FALSE(simulation.fault());
    return set_by_motion;
  };
  EXPECT_EQ(steps_by_stage(toml + stage + stage), (std::vector{true, true}));
  const std::string settle = "[[stage]]\nkind = \"settle\"\nlimit = 0.05\nlocal_damping = 0.8\nsolver = ";
  // Also with the static solver damped motion takes a block that is under way; on a floor it comes to rest.
  const std::string floor =
      "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2000\n[joint.default]\nnormal_stiffness = "
      "1e7\nfriction_angle_deg = 30\n[output]\ninterval = 0.001\n" +
      block_toml("floor", rectangle({-1.0, -1.0}, {60.0, 0.0}), "fixed = true") +
      block_toml("plate", rectangle({-1.0, 1.0}, {0.0, 1.05}), "fixed = true") +
      block_toml("block", rectangle({0.0, 0.0}, {0.1, 0.1}), "velocity = [20, 0, 0]") +
      "[[stage]]\nkind = \"settle\"\nlimit = 20\nfailure_motion = 1e3\nlocal_damping = 0.8\nsolver = ";
  EXPECT_EQ(steps_by_stage(floor + "\"static\"\n" + stage), (std::vector{true, false}));
  EXPECT_TRUE(begun(toml + settle + "\"dynamic\"\n" + stage).bound().is_set_by_motion());
}

// Whatever step was given, the one that the message names works.
TEST(GivenVelocity, MeetsAHintThatHelps) {
  for (const char *step : {"0.001", "0.0005", "0.00026"}) {
    Simulation failing = begun(before_a_wall(fmt::format("time_step = {}\n", step), "velocity = [50, 0, 0]"));
    failing.step();
    ASSERT_TRUE(failing.fault()) << step;
    const std::string message = fault_message(failing);
    const std::string key = "try run.time_step = ";
    ASSERT_NE(message.find(key), std::string::npos) << message;
    const double shorter = std::stod(message.substr(message.find(key) + key.size()));
    EXPECT_LE(shorter, 0.5 * std::stod(step)) << message;
    expect_a_run_without_faults(
        before_a_wall(fmt::format("time_step = {}\n", shorter), "velocity = [50, 0, 0]"));
  }
}

} // namespace
} // namespace gcpdda::testing::given_velocity_test
