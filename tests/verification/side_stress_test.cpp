// A stage changes the stress on the sides of a region: the blocks follow by equilibrium, slowly without slip
// that equilibrium does not ask for, at once with it.

#include "problem.hpp"

#include "simulation/energy_ledger.hpp"
#include "simulation/results.hpp"
#include "support/contact_regions.hpp"
#include "support/regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::side_stress_test {
namespace {

constexpr double stiffness = 5e9; ///< k_n, Pa/m

struct Region {
  std::string fidelity = "rigid";
  std::string sides; ///< of [region]
  std::string cuts;
  double friction_deg = 30.0;
  std::string in_situ;
  std::string stages;
  std::string outline = "[[0, 0], [10, 0], [10, 10], [0, 10]]";

  [[nodiscard]] Simulation simulation() const {
    Scene scene =
        scene_of(fmt::format(R"([run]
gravity = [0.0, 0.0]
fidelity = "{}"
[material.rock]
density = 2600.0
youngs_modulus = 20e9
poissons_ratio = 0.25
[joint.default]
normal_stiffness = {}
friction_angle_deg = {}
[output]
interval = 0.01
[region]
material = "rock"
polygon = {}
{}{}[in_situ]
{}{})",
                             fidelity, stiffness, friction_deg, outline, sides, cuts, in_situ, stages));
    scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
    return {Communicator::self(), std::move(scene)};
  }
};

std::vector<FrameRow> rows_of(Simulation &simulation) {
  const SimulationFrame frame(simulation);
  std::vector<FrameRow> rows;
  std::vector<Vec2> vertices;
  frame.append(0, simulation.num_blocks(), rows, vertices);
  std::erase_if(rows, [](const FrameRow &row) { return row.kind == 0; });
  return rows;
}

/// Largest difference of a mean stress from -(xx, yy, 0), Pa.
double farthest_stress(Simulation &simulation, double xx, double yy) {
  double farthest = 0.0;
  for (const FrameRow &row : rows_of(simulation)) {
    farthest = std::max(
        {farthest, std::abs(row.stress[0] + xx), std::abs(row.stress[1] + yy), std::abs(row.stress[2])});
  }
  return farthest;
}

const std::string grid = R"([[joint_set]]
dip_deg = 0
spacing = 2.0
[[joint_set]]
dip_deg = 90
spacing = 2.5
)";

const std::string settle = "[[stage]]\nkind = \"settle\"\nlimit = 2.0\n";

// 1 and 2 MPa on rock in a corner of rollers; then the vertical stress is doubled, and then one that is half
// way there the horizontal one too. What stays is the force that a joint loses at its ends, where overlaps of
// d = sigma/k_n fall off: d/l of 4 MPa on 2 m is 4e-4 of the stress, on two ends of a block. The stress is
// there before the last verdict, and so are the ramps: 0.1 s before the last change, which lasts 0.2 s.
TEST(SideStress, BlocksFollowTheSidesByEquilibrium) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const Region region{.fidelity = fidelity,
                        .sides = "roller = [\"bottom\", \"left\"]\nstress = [\"top\", \"right\"]\n",
                        .cuts = grid,
                        .in_situ = "principal_stresses = [1e6, 2e6]\n",
                        .stages = settle +
                                  "[[stage]]\nkind = \"change\"\nramp = 0.2\n"
                                  "set = { \"in_situ.principal_stresses\" = [1e6, 4e6] }\n" +
                                  settle + "[[stage]]\nkind = \"change\"\nramp = 0.2\n" +
                                  "set = { \"in_situ.principal_stresses\" = [1e6, 3e6] }\n" +
                                  "[[stage]]\nkind = \"run\"\nduration = 0.1\n" +
                                  "[[stage]]\nkind = \"change\"\nramp = 0.2\n" +
                                  "set = { \"in_situ.principal_stresses\" = [2e6, 2e6] }\n" + settle};
    Simulation simulation = region.simulation();
    const std::string what = "side stress changed by stages, " + fidelity + ": ";
    const std::array<std::array<double, 2>, 7> expected{{{1e6, 2e6}, {}, {1e6, 4e6}, {}, {}, {}, {2e6, 2e6}}};
    double error = farthest_stress(simulation, 1e6, 2e6);
    double unequal = 0.0;
    while (!simulation.finished()) {
      if (!simulation.stage_is_over()) {
        step(simulation);
        continue;
      }
      const auto done = static_cast<std::size_t>(simulation.stage().index);
      if (expected.at(done)[0] > 0.0) {
        error = std::max(error, farthest_stress(simulation, expected.at(done)[0], expected.at(done)[1]));
      }
      simulation.end_stage();
      simulation.begin_next_stage();
    }
    error = std::max(error, farthest_stress(simulation, 2e6, 2e6));
    for (const FrameRow &row : rows_of(simulation)) {
      unequal = std::max(unequal, std::abs(row.rotation));
    }
    expect_below(what + "largest error of a block's mean stress, Pa", 2.0 * 4e6 / stiffness / 2.0 * 4e6,
                 error);
    expect_below(what + "largest turn of a block, rad", 1e-6, unequal);
    const std::vector<StageResult> results = simulation.stage_results();
    ASSERT_EQ(results.size(), 7U);
    for (const std::size_t stage : {0U, 2U, 6U}) {
      EXPECT_EQ(results[stage].verdict, Verdict::settled) << stage;
    }
    EXPECT_GE(results[2].time - results[1].time, 0.2) << "no verdict while the stress changes";
    EXPECT_GE(results[6].time - results[5].time, 0.2);
  }
}

// The same state whether the stress comes at once, within a ramp, or is there from the start.
TEST(SideStress, TheEndDoesNotDependOnTheWayWhereNothingSlips) {
  const std::string to = "set = { \"in_situ.principal_stresses\" = [1e6, 4e6] }\n";
  const auto settled = [&](const std::string &in_situ, const std::string &change) {
    const Region region{.sides = "roller = [\"bottom\", \"left\"]\nstress = [\"top\", \"right\"]\n",
                        .cuts = grid,
                        .in_situ = in_situ,
                        .stages = settle + change + settle};
    Simulation simulation = region.simulation();
    run_stages(simulation, step);
    return rows_of(simulation);
  };
  const auto slowly =
      settled("principal_stresses = [1e6, 2e6]\n", "[[stage]]\nkind = \"change\"\nramp = 0.2\n" + to);
  const auto at_once = settled("principal_stresses = [1e6, 2e6]\n", "[[stage]]\nkind = \"change\"\n" + to);
  double apart = 0.0;
  double largest = 0.0;
  for (std::size_t k = 0; k < slowly.size(); ++k) {
    apart = std::max(apart, norm(Vec2{slowly[k].displacement.x - at_once[k].displacement.x,
                                      slowly[k].displacement.y - at_once[k].displacement.y}));
    largest = std::max(largest, norm(Vec2{slowly[k].displacement.x, slowly[k].displacement.y}));
  }
  // Five joints close by 2 MPa/k_n; the tolerance of a verdict is 1e-5 of the force.
  expect_value("side stress doubled: largest displacement, m", 5.0 * 2e6 / stiffness, largest, 0.02);
  expect_below("side stress doubled: slowly and at once apart over that", 1e-4, apart / largest);
}

// So small and slow a change is at rest on its way by every other measure of a verdict.
TEST(SideStress, NoVerdictFallsWhileItChanges) {
  const Region region{.sides = "roller = [\"bottom\", \"left\"]\nstress = [\"top\", \"right\"]\n",
                      .cuts = grid,
                      .in_situ = "principal_stresses = [1e6, 2e6]\n",
                      .stages = settle +
                                "[[stage]]\nkind = \"change\"\nramp = 0.4\n"
                                "set = { \"in_situ.principal_stresses\" = [1e6, 2.00001e6] }\n" +
                                settle};
  Simulation simulation = region.simulation();
  run_stages(simulation, step);
  const std::vector<StageResult> results = simulation.stage_results();
  ASSERT_EQ(results.size(), 3U);
  EXPECT_LT(results[0].time, 0.2);
  EXPECT_EQ(results[2].verdict, Verdict::settled);
  EXPECT_GE(results[2].time - results[1].time, 0.4);
}

// A block that is not cut from the region but lies on its upper side: 2 MPa on 5 m, and what a stage adds.
// The stress may change in the same stage, within the same time. Round-off.
TEST(SideStress, StaysOnABlockWhoseLoadsAStageSets) {
  const Region region{.sides = "roller = [\"bottom\", \"left\"]\nstress = [\"top\", \"right\"]\n",
                      .cuts = block_toml("cap", rectangle({0.0, 8.0}, {5.0, 10.0})),
                      .in_situ = "principal_stresses = [1e6, 2e6]\n",
                      .stages = "[[stage]]\nkind = \"run\"\nduration = 0.01\n"
                                "[[stage]]\nkind = \"run\"\nduration = 0.02\nramp = 0.01\n"
                                "set = { \"block.cap.load\" = [ { point = [2, 9], force = [1e5, 2e5] } ], "
                                "\"in_situ.principal_stresses\" = [1e6, 3e6] }\n",
                      .outline = "[[0, 0], [10, 0], [10, 10], [5, 10], [5, 8], [0, 8]]"};
  Simulation simulation = region.simulation();
  const auto load = [&] { return applied_forces(simulation.blocks(), 0).load.u; };
  EXPECT_LE(norm(load() - Vec2{0.0, -1e7}), 1e-15 * 1e7);
  while (!simulation.finished()) {
    if (simulation.stage_is_over()) {
      simulation.end_stage();
      simulation.begin_next_stage();
      EXPECT_LE(norm(load() - Vec2{0.0, -1e7}), 1e-15 * 1e7) << "when the change begins";
      continue;
    }
    step(simulation);
  }
  EXPECT_LE(norm(load() - Vec2{1e5, 2e5 - 1.5e7}), 1e-15 * 1.5e7);
}

/// A square cut by one joint at 30 degrees, on a fixed base; isotropic stress, then twice the vertical one.
struct Sheared {
  double traction = 0.0; ///< mean shear of the joint, Pa
  double friction_loss = 0.0;
};
Sheared shear(const std::string &ramp) {
  const Region region{.sides = "fixed = [\"bottom\"]\nstress = [\"top\", \"left\", \"right\"]\n",
                      .cuts = "[[fault]]\npoints = [[-1, 1.4226497], [11, 8.3508529]]\n",
                      .friction_deg = 17.2,
                      .in_situ = "principal_stresses = [1e6, 1e6]\n",
                      .stages = "[[stage]]\nkind = \"run\"\nduration = 0.02\n"
                                "[[stage]]\nkind = \"change\"\n" +
                                ramp + "set = { \"in_situ.principal_stresses\" = [1e6, 2e6] }\n" +
                                "[[stage]]\nkind = \"run\"\nduration = 0.6\n"};
  Simulation simulation = region.simulation();
  EnergyLedger ledger(simulation.state());
  Sheared sheared;
  run_stages(simulation, step);
  sheared.friction_loss = ledger.row(simulation.state()).friction_loss;
  for (std::size_t k = 0; k < simulation.candidates().pairs.size(); ++k) {
    const CandidatePair &pair = simulation.candidates().pairs[k];
    if (simulation.blocks().is_fixed(pair.lower.value) || simulation.blocks().is_fixed(pair.higher.value)) {
      continue;
    }
    for_regions(simulation.state(), k, k + 1, [&](std::uint32_t, std::span<const RegionForce> regions) {
      for (const RegionForce &force : regions) {
        sheared.traction += norm(force.shear_force) / (10.0 / std::cos(30.0 * degree));
      }
    });
  }
  return sheared;
}

// sigma_n = 2 cos^2 30 + sin^2 30 = 1.75 MPa and tau = sin 30 cos 30 = 0.433 MPa: 0.8 of its strength. At
// once the stress swings to nearly 3 MPa on top, 0.346 of shear over normal against tan 17.2 = 0.310.
TEST(SideStress, AtOnceAJointSlipsThatEquilibriumDoesNotAskToSlip) {
  const double expected = 1e6 * std::sin(30.0 * degree) * std::cos(30.0 * degree);
  const double length = 10.0 / std::cos(30.0 * degree);
  const double stored = 0.5 * expected * expected / (0.5 * stiffness) * length; // k_t = 0.5 k_n
  const Sheared slow = shear("ramp = 0.4\n");
  expect_value("inclined joint, stress within a ramp: shear stress, Pa", expected, slow.traction, 2e-3);
  expect_below("inclined joint, stress within a ramp: friction loss over the energy of shear", 1e-6,
               std::abs(slow.friction_loss) / stored);
  const Sheared sudden = shear("");
  expect_above("inclined joint, stress at once: friction loss over the energy of shear", 0.1,
               sudden.friction_loss / stored);
}

} // namespace
} // namespace gcpdda::testing::side_stress_test
