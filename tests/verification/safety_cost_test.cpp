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

} // namespace
} // namespace gcpdda::testing::safety_cost_test
