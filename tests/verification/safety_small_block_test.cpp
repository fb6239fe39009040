// The factor of a small block does not depend on what other blocks bear.

#include "problem.hpp"
#include "safety_limits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace gcpdda::testing::safety_small_block_test {
namespace {

constexpr double friction_deg = 40.0;
constexpr double dip_deg = 30.0;

/// A stone of 0.3 m on a plane, and out of its reach a pier of 10 m under a load (N/m).
std::string stone_and_pier(const std::string &fidelity, const std::string &solver, double load) {
  return fmt::format(R"(
[run]
fidelity = "{}"
[material.rock]
density = 2500.0
youngs_modulus = 50e9
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 1e10
friction_angle_deg = {}
[[block]]
material = "rock"
fixed = true
vertices = [[-50, -10], [250, -10], [250, 0], [-50, 0]]
[[block]]
material = "rock"
fixed = true
vertices = [[0, 0], [100, 0], [100, 2.2649730810374393], [0, 60]]
[[block]]
name = "stone"
material = "rock"
vertices = [[50.0, 31.13248654051872], [50.25980762113533, 30.98248654051872],
            [50.40980762113533, 31.24229416165405], [50.15, 31.39229416165405]]
[[block]]
name = "pier"
material = "rock"
vertices = [[-20, 0], [-10, 0], [-10, 10], [-20, 10]]
[[block.load]]
point = [-15, 10]
force = [0, {}]
[[stage]]
kind = "settle"
limit = 60.0
solver = "{}"
)",
                     fidelity, friction_deg, -load, solver);
}

// 200 MN/m are 90,000 times the weight of the stone: what drives it a percent beyond its limit is a 20
// millionth of that.
TEST(SafetySmallBlocks, AreMeasuredByTheirOwnForces) {
  const double factor = std::tan(friction_deg * degree) / std::tan(dip_deg * degree);
  for (const std::string fidelity : {"rigid", "deformable"}) {
    for (const std::string solver : {"static", "dynamic"}) {
      const SafetyOutcome found = search_quietly(scene_of(stone_and_pier(fidelity, solver, 2e8)));
      ASSERT_TRUE(found.report.holds && found.report.fails) << fidelity << ", " << solver;
      EXPECT_LE(*found.report.holds, 1.002 * factor) << fidelity << ", " << solver;
      EXPECT_GE(*found.report.fails, 0.998 * factor) << fidelity << ", " << solver;
    }
  }
}

} // namespace
} // namespace gcpdda::testing::safety_small_block_test
