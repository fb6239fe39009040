// Every shipped scene with blocks that deform: it ends as with rigid ones. Sizes are those of a test; the
// scenes as they ship, and more stiffnesses, are run/study/scenes.py's.

#include "problem.hpp"

#include "support/cut_region.hpp"
#include "support/thinning.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace gcpdda::testing::deforming_scenes_test {
namespace {

struct Case {
  std::string name;
  std::vector<std::string> sets{}; ///< make it smaller
  std::size_t num_stages = 99;     ///< those that are run, at most
};

std::vector<Verdict> verdicts(const Case &c, const std::vector<std::string> &more) {
  std::vector<std::string> sets = c.sets;
  sets.insert(sets.end(), more.begin(), more.end());
  Scene scene = shipped_scene(c.name, sets);
  scene.stages.resize(std::min(scene.stages.size(), c.num_stages));
  scene.monitors.clear(); // some lie outside of what is left
  prepare_region(scene);
  Simulation simulation(Communicator::self(), std::move(scene));
  run_stages(simulation, step);
  EXPECT_FALSE(simulation.fault().has_value()) << c.name;
  std::vector<Verdict> found;
  for (const StageResult &stage : simulation.stage_results()) {
    found.push_back(stage.verdict);
  }
  return found;
}

/// With all materials of a scene of that stiffness, and all blocks that may deform.
std::vector<std::string> deforming(const std::string &name, double modulus) {
  std::vector<std::string> sets{"run.fidelity=auto", "run.accepted_error=1e-6"};
  for (const Material &material : shipped_scene(name).materials) {
    sets.push_back(fmt::format("material.{}.youngs_modulus={}", material.name, modulus));
    sets.push_back(fmt::format("material.{}.poissons_ratio=0.25", material.name));
  }
  return sets;
}

class DeformingScenes : public ::testing::TestWithParam<Case> {};

TEST_P(DeformingScenes, EndAsRigidOnesDo) {
  const Case &c = GetParam();
  const std::vector<Verdict> rigid = verdicts(c, {"run.fidelity=rigid"});
  const std::vector<double> moduli = thinning > 1 ? std::vector{5e9} : std::vector{5e9, 30e9, 300e9};
  for (const double modulus : moduli) {
    EXPECT_EQ(verdicts(c, deforming(c.name, modulus)), rigid) << c.name << ", E = " << modulus << " Pa";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shipped, DeformingScenes,
    ::testing::Values(
        Case{"bolted_tunnel", {}, 1}, Case{"goodman_bray", {"run.duration=3.0", "run.gravity_ramp=0.5"}},
        Case{"incline"}, Case{"lined_tunnel", {}, 1},
        Case{"jointed_bench", {"run.duration=0.05", "output.interval=0.05"}}, Case{"kinds"},
        Case{"masonry_wall", {}, 3}, Case{"opening"}, Case{"overhang", {"run.duration=1.0"}},
        Case{"plane_failure"}, Case{"rock_mass", {"region.polygon=[[0, 0], [8, 0], [8, 6], [0, 6]]"}},
        Case{"rockfall", {"run.duration=2.0"}}, Case{"seismic_slope", {}, 1},
        Case{"slope_jointed",
             {"region.slope.bench=[{height=20, face_angle_deg=72}]", "region.slope.toe_length=10",
              "region.slope.crest_length=25", "region.slope.depth=6"}},
        Case{"slope_large",
             {"region.slope.bench=[{height=20, face_angle_deg=72}]", "region.slope.toe_length=10",
              "region.slope.crest_length=25", "region.slope.depth=6"},
             1},
        Case{"slope_seeds", {}, 1}, Case{"stacked_wedge", {"run.duration=2.0"}}, Case{"toppling", {}, 2},
        Case{"tunnel_jointed", {"region.polygon=[[-11, -10], [11, -10], [11, 11], [-11, 11]]"}},
        Case{"tunnel_large",
             {"region.polygon=[[-12, -12], [12, -12], [12, 12], [-12, 12]]",
              "opening=[{name=\"tunnel\", shape=\"horseshoe\", centre=[0, 0], width=10, height=10}]"},
             1},
        Case{"wedge_roof", {"run.duration=1.0"}}, Case{"wet_slope", {}, 1}),
    [](const auto &one) { return one.param.name; });

// A new scene joins the list.
TEST(DeformingScenes, AreAll) {
  const std::set<std::string> deform_already{"deformable_slope", "deformable_tunnel"};
  const std::filesystem::path folder = std::filesystem::path(GCPDDA_SOURCE_DIR) / "run" / "scenes";
  std::size_t count = 0;
  for (const auto &entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().stem();
    count += entry.path().extension() == ".toml" && !deform_already.contains(name) ? 1 : 0;
  }
  EXPECT_EQ(count, 22U) << "scenes above";
}

} // namespace
} // namespace gcpdda::testing::deforming_scenes_test
