// Loads and strengths that change in time: what the static solver does with loads, what is said of those that
// a run is too short for, and which contacts learn of strengths that fall.

#include "simulation/stage_changes.hpp"
#include "support/contact_regions.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace gcpdda::testing::load_times_test {
namespace {

const std::string statically = "solver = \"static\"\n";
const std::string dynamically = "solver = \"dynamic\"\n";

std::string settle(const std::string &keys) {
  return "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n" + keys;
}

/// A block of 2 m x 1 m on a level floor, with a level force on its lower part that friction can bear for
/// factors below 0.87: it has a weight of 51 kN and a friction angle of 35 degrees.
Scene pushed_block(const std::string &course, const std::string &stages) {
  return scene_of("[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600.0\n[joint.default]\n"
                  "normal_stiffness = 1e10\nfriction_angle_deg = 35.0\n[output]\ninterval = 0.1\n" +
                  block_toml("floor", rectangle({-9.0, -1.0}, {9.0, 0.0}), "fixed = true") +
                  block_toml("b", rectangle({0.0, 0.0}, {2.0, 1.0})) +
                  "[[block.load]]\npoint = [0.0, 0.1]\nforce = [4.1e4, 0.0]\n" + course + stages);
}

bool has_note(const Simulation &simulation, const std::string &part) {
  const Diagnostics &notes = simulation.notes();
  return std::any_of(notes.begin(), notes.end(), [&](const Diagnostic &note) {
    return (note.what + " " + note.why).find(part) != std::string::npos;
  });
}

struct Course {
  std::string table;
  bool is_pulse;
};

// A stage in which a load has an extreme on its way is one of damped motion. So is one that begins with a
// jump to more than what stays. A load that grows, or one of a stage before that only falls, is not.
TEST(LoadTimes, ATableThatRisesAndFallsIsLeftToDampedMotion) {
  for (const Course &course :
       {Course{"[[0, 0], [0.5, 1], [2, 1], [2.1, 0]]", true},
        Course{"[[0, 0], [0.2, 0.3], [0.4, -0.3]]", true}, Course{"[[0, 0], [0.2, -0.3], [0.4, 0.3]]", true},
        Course{"[[0, 0.5], [0.3, 0.1]]", true},
        Course{"[[0, 0], [0.1, 0.1], [0.3, 0.3], [0.7, 0.3], [0.8, 0.5]]", false},
        Course{"[[0, 0], [0.1, -0.1], [0.3, -0.3]]", false}, Course{"[[0, 0.5], [0.3, 0.5]]", false}}) {
    Simulation simulation(Communicator::self(),
                          pushed_block("table = " + course.table + "\n", settle(statically)));
    simulation.step();
    EXPECT_EQ(has_note(simulation, "block 'b' rises and falls"), course.is_pulse) << course.table;
    EXPECT_EQ(simulation.stage().iteration.is_left, course.is_pulse ? 1 : 0) << course.table;
  }
}

// The greatest force is 41 kN, beyond the 35.7 kN that friction bears, for 0.2 s. Of the rest local damping
// takes 0.8, so that a block of 5.2 t slides by about 0.2 (41 - 35.7)/5.2 m/s2 (0.2 s)^2/2 = 4 mm meanwhile.
// The last value of the table would leave it where it is.
TEST(LoadTimes, TheGreatestValueOfATableActsInASettleStage) {
  Simulation simulation(Communicator::self(),
                        pushed_block("table = [[0, 0], [0.1, 1], [0.3, 1], [0.4, 0]]\n", settle(statically)));
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  EXPECT_GT(displacement_of(simulation, 1).u.x, 1e-3);
}

// Once a stage before has brought the load in, a later one has nothing to follow.
TEST(LoadTimes, ATableThatIsOverIsNoPulse) {
  Simulation simulation(Communicator::self(), pushed_block("table = [[0, 0], [0.1, 0.5], [0.2, 0.1]]\n",
                                                           settle(dynamically) + settle(statically)));
  run_stages(simulation);
  EXPECT_FALSE(has_note(simulation, "rises and falls"));
  EXPECT_EQ(simulation.stage_results().back().means, VerdictMeans::static_solver);
}

// The time of a static stage begins when its loads are complete, so that none is too long for it.
TEST(LoadTimes, AreTooLongForDampedMotionAlone) {
  const std::string ramp = "ramp = 20.0\n";
  const std::string late = "table = [[0, 0], [15, 0], [16, 0.5]]\n";
  const std::string in_full = "never acts in full";
  const auto has = [](const std::string &course, const std::string &keys, const std::string &part) {
    return has_note(Simulation(Communicator::self(), pushed_block(course, settle(keys))), part);
  };
  EXPECT_TRUE(has(ramp, dynamically, in_full));
  EXPECT_FALSE(has(ramp, statically, in_full));
  EXPECT_TRUE(has(late, dynamically, "the force never acts"));
  EXPECT_FALSE(has(late, statically, "the force never acts"));
  EXPECT_FALSE(has("table = [[0, 0], [5, 0], [16, 0.5]]\n", dynamically, "the force never acts"));
}

// Two stiffnesses meet at the edges of one pair: kernels know the law of such a region by a number of its
// own.
TEST(LoadTimes, StrengthsThatFallReachRegionsOfTwoStiffnesses) {
  const std::string toml =
      "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600.0\n[joint.default]\n"
      "normal_stiffness = 1e10\nfriction_angle_deg = 35.0\n[joint.soft]\nnormal_stiffness = 1e9\n"
      "friction_angle_deg = 20.0\n[output]\ninterval = 0.1\n" +
      block_toml("floor", rectangle({-9.0, -1.0}, {9.0, 0.0}),
                 "fixed = true\nedge_joints = [\"\", \"\", \"soft\", \"\"]") +
      block_toml("b", rectangle({0.0, 0.0}, {2.0, 1.0})) + settle(dynamically);
  Simulation simulation(Communicator::self(), scene_of(toml));
  std::vector<JointLaw> laws = simulation.scene().joints.laws;
  for (JointLaw &law : laws) {
    law.weaken(2.0);
  }
  change_strengths(simulation.state(), laws);
  const std::vector<LawConstants> &known = simulation.candidates().laws;
  const std::size_t count = laws.size();
  ASSERT_EQ(known.size(), count * (1 + count));
  for (std::size_t k = 0; k < known.size(); ++k) {
    const double largest = std::max(laws[0].tan_friction, laws[1].tan_friction);
    EXPECT_LE(known[k].tan_friction, largest) << "number " << k;
  }
}

} // namespace
} // namespace gcpdda::testing::load_times_test
