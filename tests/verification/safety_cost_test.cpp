// What a search for a factor of safety takes, counted in evaluations and steps.

#include "problem.hpp"
#include "safety_limits.hpp"

#include "blockgen/region_cutter.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <vector>

namespace gcpdda::testing::safety_cost_test {
namespace {

/// A search with so many benches of the large slope.
SafetyOutcome search_of_benches(int count, const std::vector<std::string> &more = {}) {
  const std::string bench = "{height = 20.0, face_angle_deg = 72.0";
  std::string benches;
  for (int k = 1; k < count; ++k) {
    benches += bench + ", width = 7.0}, ";
  }
  std::vector<std::string> sets{"region.slope.bench=[" + benches + bench + "}]",
                                fmt::format("region.slope.toe_length={:.1f}", 8.0 * count),
                                fmt::format("region.slope.crest_length={:.1f}", 17.0 * count),
                                fmt::format("region.slope.depth={:.1f}", 5.0 * count),
                                "output.contacts=false"};
  sets.insert(sets.end(), more.begin(), more.end());
  Scene scene = shipped_scene("slope_large", sets);
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  return search_quietly(scene);
}

std::int64_t steps_of(const SafetyOutcome &outcome) {
  std::int64_t steps = 0;
  for (const StrengthTrial &trial : outcome.report.trials) {
    steps += trial.steps;
  }
  return steps;
}

// Of 473 blocks, of which a wedge slides. All trials take some 2,000 evaluations and steps together. Where a
// slide is damped by what chatters elsewhere (statics/pseudo_time.hpp), the one next to the limit alone takes
// 7,800, and all of them 10,000. The dynamic step, 70 steps and more to see that a motion goes on, looks at
// the ends of the bracket alone.
TEST(SafetyCost, TrialsNextToTheLimitTakeFewSteps) {
  const SafetyOutcome outcome = search_of_benches(1);
  EXPECT_EQ(outcome.exit_code, exit_code::done) << outcome.message;
  for (const StrengthTrial &trial : outcome.report.trials) {
    const bool is_end = trial.factor == outcome.report.holds || trial.factor == outcome.report.fails;
    EXPECT_EQ(trial.decided_by.ends_with("dynamic step"), is_end) << trial.factor << " " << trial.decided_by;
  }
  EXPECT_GE(outcome.report.trials.size(), 5U);
  EXPECT_LT(steps_of(outcome), 4000);
}

// Of 6,873 blocks some on a bench slide to their rest by a tenth of their size, under a force that hardly
// changes. Two trials just below the limit (1.592 holds and 1.623 fails at the end of a whole search) take
// some 2,600 evaluations and steps together, 2,000 to 2,600 at other factors nearby. Where the springs of
// joints that slip keep the share that they have after 20 evaluations (statics/springs.hpp) it is 19,000, and
// 3,700 to 9,000 nearby: the dynamic step has to go on.
TEST(SafetyCost, AFewBlocksThatSlideToRestTakeFewSteps) {
  const SafetyOutcome outcome = search_of_benches(4, {"fos.from=1.593", "fos.to=1.59302"});
  EXPECT_EQ(outcome.exit_code, exit_code::undecided) << outcome.message;
  ASSERT_EQ(outcome.report.trials.size(), 2U);
  for (const StrengthTrial &trial : outcome.report.trials) {
    EXPECT_EQ(trial.verdict, Verdict::settled) << trial.factor;
  }
  EXPECT_LT(steps_of(outcome), 5000);
}

/// A search between two factors next to each other, of a slope with all else by default.
SafetyOutcome search_at(double factor, const std::string &slope) {
  Scene scene = scene_of(slope +
                         "[output]\ninterval = 20.0\ncontacts = false\n"
                         "[[stage]]\nkind = \"settle\"\nlimit = 20.0\n" +
                         fmt::format("[fos]\nfrom = {}\nto = {}\n", factor, factor * (1.0 + 1e-5)));
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  return search_quietly(scene);
}

// Of 278 blocks that deform and ride up on their joints, just below the limit: two trials of 500 evaluations
// each. Where normal springs of joints that dilate do not lean to their slip (statics/springs.hpp) they take
// 64,000 steps together, and one of them fails.
TEST(SafetyCost, BlocksThatRideUpTakeFewSteps) {
  const SafetyOutcome outcome = search_at(1.276, R"(
[run]
fidelity = "deformable"
[material.rock]
density = 2373.0
youngs_modulus = 4.5e9
poissons_ratio = 0.19
[joint.default]
normal_stiffness = 7.67e9
tangential_ratio = 1.03
friction_angle_deg = 34.7
dilation_angle_deg = 2.2
dilation_limit = 0.02
[in_situ]
level = 34.1
k0 = 1.52
[region]
material = "rock"
fixed = ["bottom", "left", "right"]
min_width = 0.232
[region.slope]
toe_length = 16.8
crest_length = 30.3
depth = 11.8
[[region.slope.bench]]
height = 33.69
face_angle_deg = 67.2
[[joint_set]]
name = "flat"
dip_deg = -29.6
spacing = 1.94
spacing_scatter = {kind = "lognormal", deviation = 0.387}
seed = 1028
[[joint_set]]
name = "cross"
dip_deg = 26.8
dip_scatter = {kind = "normal", deviation_deg = 3.0}
spacing = 2.86
trace_length = 21.71
gap = 2.34
seed = 1029
)");
  EXPECT_EQ(outcome.exit_code, exit_code::undecided) << outcome.message;
  ASSERT_EQ(outcome.report.trials.size(), 2U);
  for (const StrengthTrial &trial : outcome.report.trials) {
    EXPECT_EQ(trial.verdict, Verdict::settled) << trial.factor;
  }
  EXPECT_LT(steps_of(outcome), 5000);
}

// Of 1,223 blocks with bonds, just above the limit: the part that slides keeps its speed and fails after 650
// evaluations. Where its blocks are stopped because they are nearly balanced (statics/far_rows.hpp) it takes
// 46,000 steps.
TEST(SafetyCost, ASlideOfBondedBlocksTakesFewSteps) {
  const SafetyOutcome outcome = search_at(3.73739, R"(
[run]
gravity_ramp = 0.7
[material.rock]
density = 2662.0
youngs_modulus = 3.94e10
poissons_ratio = 0.31
[joint.default]
normal_stiffness = 1.14e10
tangential_ratio = 0.75
friction_angle_deg = 33.8
cohesion = 4.67e4
tension = 2.33e4
residual_friction_angle_deg = 30.8
[region]
material = "rock"
fixed = ["bottom", "left", "right"]
min_width = 0.11
[region.slope]
toe_length = 10.8
crest_length = 19.5
depth = 7.6
[[region.slope.bench]]
height = 10.83
face_angle_deg = 57.7
width = 5.4
[[region.slope.bench]]
height = 10.83
face_angle_deg = 66.1
[[joint_set]]
name = "flat"
dip_deg = -19.8
spacing = 0.92
spacing_scatter = {kind = "lognormal", deviation = 0.184}
seed = 1008
[[joint_set]]
name = "steep"
dip_deg = 74.3
dip_scatter = {kind = "normal", deviation_deg = 3.0}
spacing = 0.98
seed = 1009
[[joint_set]]
name = "back"
dip_deg = -72.7
spacing = 6.55
seed = 1010
)");
  ASSERT_FALSE(outcome.report.trials.empty()) << outcome.message;
  for (const StrengthTrial &trial : outcome.report.trials) {
    EXPECT_EQ(trial.verdict, Verdict::failed) << trial.factor;
  }
  EXPECT_LT(steps_of(outcome), 5000);
}

} // namespace
} // namespace gcpdda::testing::safety_cost_test
