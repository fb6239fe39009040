// What a search for a factor of safety takes, counted in evaluations and steps.

#include "problem.hpp"
#include "safety_limits.hpp"

#include "blockgen/region_cutter.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

namespace gcpdda::testing::safety_cost_test {
namespace {

/// Of one bench of the large slope, 473 blocks, of which a wedge slides.
SafetyOutcome search_of_one_bench() {
  Scene scene = shipped_scene("slope_large", {"region.slope.bench=[{height = 20.0, face_angle_deg = 72.0}]",
                                              "region.slope.toe_length=8.0", "region.slope.crest_length=17.0",
                                              "region.slope.depth=5.0", "output.contacts=false"});
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  return search_quietly(scene);
}

// All trials take some 2,000 evaluations and steps together. Where a slide is damped by what chatters
// elsewhere (statics/pseudo_time.hpp), the one next to the limit alone takes 7,800, and all of them 10,000.
// The dynamic step, 70 steps and more to see that a motion goes on, looks at the ends of the bracket alone.
TEST(SafetyCost, TrialsNextToTheLimitTakeFewSteps) {
  const SafetyOutcome outcome = search_of_one_bench();
  EXPECT_EQ(outcome.exit_code, exit_code::done) << outcome.message;
  std::int64_t steps = 0;
  for (const StrengthTrial &trial : outcome.report.trials) {
    steps += trial.steps;
    const bool is_end = trial.factor == outcome.report.holds || trial.factor == outcome.report.fails;
    EXPECT_EQ(trial.decided_by.ends_with("dynamic step"), is_end) << trial.factor << " " << trial.decided_by;
  }
  EXPECT_GE(outcome.report.trials.size(), 5U);
  EXPECT_LT(steps, 4000);
}

} // namespace
} // namespace gcpdda::testing::safety_cost_test
