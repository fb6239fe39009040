// Strong dashpots under stress: rock that is pressed together comes to rest with any ratio that users may ask
// for.

#include "problem.hpp"

#include "blockgen/region_cutter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

namespace gcpdda::testing::strong_dashpots_test {
namespace {

std::string pressed_rock(const std::string &fidelity, double ratio) {
  return fmt::format(R"([run]
fidelity = "{}"
contact_damping = {}
[material.rock]
density = 2600.0
youngs_modulus = 5e10
poissons_ratio = 0.25
[joint.default]
normal_stiffness = 1e10
friction_angle_deg = 35.0
[region]
material = "rock"
polygon = [[0, 0], [6, 0], [6, 6], [0, 6]]
fixed = ["bottom", "left", "right", "top"]
[[joint_set]]
dip_deg = 10.0
spacing = 0.5
[[joint_set]]
dip_deg = 80.0
spacing = 1.5
[in_situ]
vertical_stress = 1e6
k0 = 0.7
[output]
interval = 0.02
[[stage]]
kind = "settle"
solver = "dynamic"
limit = 0.2
)",
                     fidelity, ratio);
}

// A block is held by all of its neighbours. With the dashpots of one joint alone in the stable step, blocks
// swing for ever with three to five times the force that presses them from a ratio of 0.5 on.
TEST(StrongDashpots, LetPressedRockRest) {
  for (const char *fidelity : {"rigid", "deformable"}) {
    for (const double ratio : {0.2, 0.5, 2.0}) {
      Scene scene = scene_of(pressed_rock(fidelity, ratio));
      scene.region_blocks = std::make_shared<RegionCutter>(scene);
      Simulation simulation(Communicator::self(), std::move(scene));
      run_stages(simulation);
      EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled) << fidelity << ", " << ratio;
    }
  }
}

} // namespace
} // namespace gcpdda::testing::strong_dashpots_test
