// What static stages take, counted in evaluations and refreshes.

#include "problem.hpp"

#include "blockgen/region_cutter.hpp"
#include "driver/safety_search.hpp"
#include "support/cut_region.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

namespace gcpdda::testing::static_cost_test {
namespace {

// Between two joints a wedge slips on both of them as it is strained. Where that is damped as if nothing
// slipped (statics/pseudo_time.hpp), the last stage of each takes 1,000 evaluations in place of 300.
TEST(StaticCost, OfAWedgeThatSlipsOnBothOfItsJoints) {
  for (const char *name : {"bolted_tunnel", "lined_tunnel"}) {
    Scene scene = shipped_scene(name);
    prepare_region(scene);
    Simulation simulation(Communicator::self(), scene);
    run_stages(simulation);
    const StageResult &last = simulation.stage_results().back();
    EXPECT_EQ(last.verdict, Verdict::settled) << name;
    EXPECT_EQ(last.means, VerdictMeans::static_solver) << name;
    EXPECT_LT(last.steps, 600) << name;
  }
}

// The slide of a bench takes 14 refreshes in its 268 evaluations. With the skin of the dynamic step, which
// grows with velocities that there are none of in pseudo-time, they were 69.
TEST(StaticCost, ASlideFindsItsPairsSeldom) {
  Scene scene = shipped_scene("slope_large", {"region.slope.bench=[{height = 20.0, face_angle_deg = 72.0}]",
                                              "region.slope.toe_length=8.0", "region.slope.crest_length=17.0",
                                              "region.slope.depth=5.0"});
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  Simulation simulation(Communicator::self(), weakened_scene(scene, 2.0));
  run_stages(simulation);
  std::int64_t evaluations = 0;
  for (const StageResult &stage : simulation.stage_results()) {
    evaluations += stage.steps;
  }
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::failed);
  EXPECT_EQ(simulation.stage_results().back().means, VerdictMeans::static_solver);
  EXPECT_LT(10 * simulation.counters().refreshes, evaluations);
}

} // namespace
} // namespace gcpdda::testing::static_cost_test
