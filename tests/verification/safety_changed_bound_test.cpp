// Upper bounds of the factor of safety where stages behind the last settle stage change the scene at once,
// each beside what limit equilibrium gives for the scene as changed.

#include "problem.hpp"
#include "safety_limits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gcpdda::testing::safety_changed_bound_test {
namespace {

constexpr double friction_deg = 35.0;
constexpr double density = 2000.0;
constexpr double push = 1e4; // N/m, level, on the lower block

/// A change of two blocks, of 2 m x 1 m and of 1 m x 1 m on top of it, on a level floor.
struct Change {
  std::string name;
  std::string stage; ///< keys of the stage without steps
  double normal;     ///< on the floor afterwards, N/m
  double shear;      ///< there, N/m
  double friction_deg = safety_changed_bound_test::friction_deg;
  bool has_stop = false; ///< a fixed block before the lower one

  [[nodiscard]] double factor() const {
    return normal * std::tan(friction_deg * std::numbers::pi / 180.0) / shear;
  }
  [[nodiscard]] Scene scene(const std::string &fidelity) const {
    std::string toml = fmt::format(R"(
[run]
fidelity = "{}"
[material.stone]
density = {}
youngs_modulus = 2e10
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 1e11
friction_angle_deg = {}
[fos]
to = 12.0
[[block]]
material = "stone"
vertices = [[-9, -1], [19, -1], [19, 0], [-9, 0]]
fixed = true
[[block]]
name = "lower"
material = "stone"
vertices = [[0, 0], [2, 0], [2, 1], [0, 1]]
[[block.load]]
point = [0.0, 0.1]
force = [{}, 0.0]
[[block]]
name = "upper"
material = "stone"
vertices = [[0.5, 1], [1.5, 1], [1.5, 2], [0.5, 2]]
)",
                                   fidelity, density, safety_changed_bound_test::friction_deg, push);
    if (has_stop) {
      toml +=
          "[[block]]\nname = \"stop\"\nmaterial = \"stone\"\nvertices = [[2, 0], [3, 0], [3, 1], [2, 1]]\n"
          "fixed = true\n";
    }
    return scene_of(toml + "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 10.0\n" +
                    "[[stage]]\nname = \"change\"\n" + stage);
  }
};

std::vector<Change> changes() {
  constexpr double block = 2.0 * density * earth_gravity; // weight of the lower one, N/m
  const std::string set = "kind = \"change\"\nset = ";
  const std::string two_pushes =
      set + "{\"block.lower.load\" = [{point = [0.0, 0.1], force = [2e4, 0.0]}]}\n";
  const std::string excavate = "kind = \"excavate\"\nblocks = [\"upper\"]\n";
  return {
      {"less friction", set + "{\"joint.default.friction_angle_deg\" = 20.0}\n", 1.5 * block, push, 20.0},
      {"more friction", set + "{\"joint.default.friction_angle_deg\" = 50.0}\n", 1.5 * block, push, 50.0},
      {"twice the load", two_pushes, 1.5 * block, 2.0 * push},
      {"twice the load, gradually", two_pushes + "ramp = 0.2\n", 1.5 * block, 2.0 * push},
      {"half the density", set + "{\"material.stone.density\" = 1000.0}\n", 0.75 * block, push},
      {"gravity that leans", set + "{\"run.gravity\" = [0.5, -5.0]}\n", 1.5 * block / earth_gravity * 5.0,
       push + 1.5 * block / earth_gravity * 0.5},
      {"rock taken away", excavate, block, push},
      {"rock taken away gradually", excavate + "relax = 0.2\n", block, push},
      {"a stop set free", set + "{\"block.stop.fixed\" = false}\n", 2.0 * block, push, friction_deg, true},
  };
}

// Bounds are found to 0.1 % from above; a turn of the blocks by overlaps of 1e-6 m moves them by far less.
TEST(SafetyChangedBound, IsThatOfTheSceneAsChanged) {
  for (const char *fidelity : {"rigid", "deformable"}) {
    for (const Change &change : changes()) {
      const double bound = search_quietly(change.scene(fidelity), true).report.bound.value_or(0.0);
      const std::string name = fmt::format("{}, {}", change.name, fidelity);
      EXPECT_GE(bound, (1.0 - 1e-4) * change.factor()) << name;
      EXPECT_LE(bound, (1.0 + 2e-3) * change.factor()) << name;
    }
  }
}

} // namespace
} // namespace gcpdda::testing::safety_changed_bound_test
