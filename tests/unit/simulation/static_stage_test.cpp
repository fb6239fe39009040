// Settle stages with the static solver, on scenes whose equilibrium is known.

#include "blockgen/region_cutter.hpp"
#include "dynamics/deformable.hpp"
#include "simulation/energy_ledger.hpp"
#include "support/contact_regions.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace gcpdda::testing::static_stage_test {
namespace {

const std::string settle = "[[stage]]\nkind = \"settle\"\nlimit = 40.0\nsolver = \"static\"\n";

std::string head(const std::string &run_keys = "", double friction_deg = 30.0) {
  return fmt::format("[run]\nfidelity = \"rigid\"\n{}[material.rock]\ndensity = 2600.0\n[joint.default]\n"
                     "normal_stiffness = 1e9\nfriction_angle_deg = {}\n[output]\ninterval = 0.1\n",
                     run_keys, friction_deg);
}

/// @param closed  by which each joint has closed at the beginning, m
std::string stack(int height, const std::string &run_keys = "", double closed = 0.0) {
  std::string toml =
      head(run_keys) + block_toml("floor", rectangle({-2.0, -1.0}, {3.0, 0.0}), "fixed = true");
  for (int k = 0; k < height; ++k) {
    const double low = k - (k + 1) * closed;
    toml += block_toml(fmt::format("s{}", k), rectangle({0.0, low}, {1.0, low + 1.0}));
  }
  return toml;
}

bool has_note(const Simulation &simulation, const std::string &part) {
  const Diagnostics &notes = simulation.notes();
  return std::any_of(notes.begin(), notes.end(), [&](const Diagnostic &note) {
    return (note.what + note.why).find(part) != std::string::npos;
  });
}

/// True where the dynamic solver has taken over.
bool has_fallen_back(const Simulation &simulation) {
  return has_note(simulation, "goes on with solver = \"dynamic\"");
}

// The weight above each joint: k_n d (1 - d) = w between equal faces, without 1/2 d on the wide floor.
TEST(StaticStage, AStackSettlesAtItsOverlaps) {
  Simulation simulation(Communicator::self(), scene_of(stack(4) + settle));
  run_stages(simulation);
  const StageResult result = simulation.stage_results().back();
  EXPECT_EQ(result.verdict, Verdict::settled);
  EXPECT_LT(result.steps, 150); // 50 of them let the load in; damped motion takes thousands
  EXPECT_FALSE(has_fallen_back(simulation));
  double down = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double weight = (4 - k) * rock_density * earth_gravity / 1e9;
    down += weight * (1.0 + (k == 0 ? 0.5 : 1.0) * weight);
    // The tolerance lets 1e-5 of the weight be out of balance, on each of four joints.
    EXPECT_NEAR(-displacement_of(simulation, k + 1).u.y, down, 1e-4 * down) << k;
    EXPECT_EQ(velocity_of(simulation, k + 1), RigidDof{}) << "set to rest";
  }
}

// Joints of a high pile that begin open close in the first evaluations. What these solve for takes at most
// twice the products of the next ones, since the coarse level sees the joints that have closed. A
// coarse level without them asks for more.
TEST(StaticStage, AJointThatClosesAtFirstIsNoHarderThanLater) {
  Simulation simulation(
      Communicator::self(),
      scene_of(head() + block_toml("floor", rectangle({-1.0, -1.0}, {21.0, 0.0}), "fixed = true") +
               "[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 30\ncolumns = 20\n"
               "block_size = [1.0, 0.5]\n" +
               settle));
  const auto products_of_five = [&] {
    const std::int64_t before = simulation.counters().products;
    for (int k = 0; k < 5; ++k) {
      simulation.step();
    }
    return simulation.counters().products - before;
  };
  const std::int64_t first = products_of_five();
  const std::int64_t next = products_of_five();
  EXPECT_GT(first, 0);
  EXPECT_LE(first, 2 * next);
}

// A square on a slope of 30 degrees carries its weight by N = w cos a and F_t = w sin a, as long as friction
// allows it; the nearest case misses the slope by 0.1 degrees.
TEST(StaticStage, ASquareSticksOnASlopeWithKnownForces) {
  for (const double friction_deg : {45.0, 35.0, 30.1}) {
    const Incline incline{.slope_deg = 30.0, .friction_deg = friction_deg};
    const std::string toml =
        without_duration(incline.toml(incline.flat_square(0.0), {.run_keys = "", .interval = 0.5}));
    Simulation simulation(Communicator::self(), scene_of(toml + settle));
    run_stages(simulation);
    const StageResult result = simulation.stage_results().back();
    EXPECT_EQ(result.verdict, Verdict::settled)
        << friction_deg << " after " << result.steps << " steps, r = " << result.unbalanced_ratio
        << ", moved " << result.moved;
    EXPECT_FALSE(has_fallen_back(simulation)) << friction_deg;
    const auto regions = regions_of(simulation);
    ASSERT_EQ(regions.size(), 1U);
    const double normal = regions[0].normal_force;
    const double shear = std::abs(regions[0].shear);
    // Up to the tolerance, 1e-5 of the largest force; the block tilts by the moment of its friction alone.
    EXPECT_NEAR(shear / normal, std::tan(std::numbers::pi / 6.0), 1e-4) << friction_deg;
  }
}

// What slides is no equilibrium: the iteration hands over, and the dynamic solver says that it has failed.
TEST(StaticStage, WhatSlidesIsLeftToTheDynamicSolver) {
  const Incline incline{.slope_deg = 30.0, .friction_deg = 15.0};
  const std::string toml =
      without_duration(incline.toml(incline.flat_square(0.0), {.run_keys = "", .interval = 0.5}));
  Simulation simulation(Communicator::self(), scene_of(toml + settle));
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::failed);
  EXPECT_TRUE(has_fallen_back(simulation));
}

// No joint slips on either way: the equilibrium is the only one.
TEST(StaticStage, AWallSettlesWhereDampedMotionLeavesIt) {
  const std::string wall =
      head() + block_toml("floor", rectangle({-1.0, -1.0}, {9.0, 0.0}), "fixed = true") +
      "[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 6\ncolumns = 8\n"
      "block_size = [1.0, 0.5]\n[[stage]]\nkind = \"settle\"\nlimit = 40.0\ntolerance = 1e-7\n";
  Simulation damped(Communicator::self(), scene_of(wall + "solver = \"dynamic\"\n"));
  Simulation iterated(Communicator::self(), scene_of(wall + "solver = \"static\"\n"));
  run_stages(damped);
  run_stages(iterated);
  EXPECT_EQ(iterated.stage_results().back().verdict, Verdict::settled);
  EXPECT_LT(iterated.step_count(), damped.step_count() / 4);
  double sag = 0.0;
  double apart = 0.0;
  for (std::size_t row = 0; row < damped.blocks().num_owned; ++row) {
    sag = std::max(sag, norm(damped.blocks().displacement[row].u));
    apart =
        std::max(apart, norm(damped.blocks().displacement[row].u - iterated.blocks().displacement[row].u));
  }
  EXPECT_LT(apart, 0.04 * sag);
}

// A wall and a block that falls beside it settle by the static solver alone, and the block lies where its
// weight presses it.
TEST(StaticStage, ABlockFallsBesideAWallAndLies) {
  for (const std::string kind : {"rigid", "deformable"}) {
    const std::string toml =
        fmt::format("[run]\nfidelity = \"{}\"\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 2e9\n"
                    "poissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = 1e9\n"
                    "friction_angle_deg = 30.0\n[output]\ninterval = 10\n",
                    kind) +
        block_toml("floor", rectangle({-1.0, -1.0}, {31.0, 0.0}), "fixed = true") +
        block_toml("falls", rectangle({26.0, 0.3}, {27.0, 1.3})) +
        "[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 20\ncolumns = 20\n"
        "block_size = [1.0, 0.5]\n" +
        settle;
    Simulation simulation(Communicator::self(), scene_of(toml));
    run_stages(simulation);
    EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled) << kind;
    EXPECT_LT(simulation.stage_results().back().steps, 250) << kind; // 50 of the load, 50 of the fall
    EXPECT_FALSE(has_fallen_back(simulation)) << kind;
    // It has closed its joint by w/k_n, and a deformable one has shortened by about half of w/E.
    const double weight = rock_density * earth_gravity;
    const double down = -displacement_of(simulation, 1).u.y - 0.3;
    EXPECT_GT(down, 0.9 * weight / 1e9) << kind;
    EXPECT_LT(down, 1.1 * (weight / 1e9 + weight / 2e9)) << kind;
  }
}

struct Course {
  std::vector<RigidDof> places; ///< by row
  std::vector<double> forces;   ///< normal ones, by region
  std::int64_t steps = 0;
  std::int64_t evaluations = 0; ///< of pairs
};

/// A block falls from a shelf that is taken away, beside a wall that is at rest.
/// @param all_move  at each evaluation
Course course_beside_a_fall(const std::string &kind, bool all_move) {
  Simulation simulation(Communicator::self(),
                        scene_of(fall_from_shelf_toml(kind, 20, 20, "interval = 10\n")));
  while (simulation.stage().index < 2) {
    simulation.end_stage();
    simulation.stage_is_over() ? simulation.begin_next_stage() : simulation.step();
  }
  const std::int64_t steps = simulation.step_count();
  const std::int64_t evaluations = simulation.counters().evaluations;
  simulation.step();
  statics::IterationRules &rules = simulation.state().statics->rules();
  rules.all_move = all_move ? rules.window : rules.all_move;
  rules.all_move_near_rest = all_move ? rules.window : rules.all_move_near_rest;
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  EXPECT_FALSE(has_fallen_back(simulation));
  Course course{simulation.blocks().displacement,
                {},
                simulation.step_count() - steps,
                simulation.counters().evaluations - evaluations};
  for (const auto &region : regions_of(simulation)) {
    course.forces.push_back(region.normal_force);
  }
  return course;
}

// Forces may differ by a millionth of the largest and places by a millionth of a block: that is what is asked
// of it. From the 50 evaluations of the load on, the wall is evaluated in one of three.
TEST(StaticStage, EndsWhereItWouldIfAllBlocksMoved) {
  for (const std::string kind : {"rigid", "deformable"}) {
    const Course few = course_beside_a_fall(kind, false);
    const Course all = course_beside_a_fall(kind, true);
    EXPECT_LT(static_cast<double>(few.evaluations) / static_cast<double>(few.steps),
              0.8 * static_cast<double>(all.evaluations) / static_cast<double>(all.steps));
    ASSERT_EQ(few.forces.size(), all.forces.size());
    const double largest = *std::max_element(all.forces.begin(), all.forces.end());
    for (std::size_t k = 0; k < few.forces.size(); ++k) {
      EXPECT_NEAR(few.forces[k], all.forces[k], 1e-6 * largest) << kind << k;
    }
    for (std::size_t row = 0; row < few.places.size(); ++row) {
      EXPECT_LT(norm(few.places[row].u - all.places[row].u), 1e-6) << kind << row;
    }
  }
}

// A column of a deformable block on a rigid one: u = w/2 (1 - nu^2)/E of its own weight (plane strain, sides
// free) and the joints. The block of constant strain feels half its weight.
TEST(StaticStage, ADeformableBlockShortensUnderItsWeight) {
  const double modulus = 1e8;
  std::string toml = "[run]\nfidelity = \"deformable\"\n[material.rock]\ndensity = 2600.0\n"
                     "youngs_modulus = 1e8\npoissons_ratio = 0.0\n[joint.default]\nnormal_stiffness = 1e9\n"
                     "friction_angle_deg = 0.0\n[output]\ninterval = 0.1\n";
  toml += block_toml("floor", rectangle({-2.0, -1.0}, {3.0, 0.0}), "fixed = true");
  toml += block_toml("block", rectangle({0.0, 0.0}, {1.0, 1.0}));
  Simulation simulation(Communicator::self(), scene_of(toml + settle));
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  EXPECT_FALSE(has_fallen_back(simulation));
  const Deformation &d = simulation.blocks().deformation_of(0);
  const double weight = rock_density * earth_gravity;
  EXPECT_NEAR(d.gradient.yy - 1.0, -0.5 * weight / modulus, 1e-3 * weight / modulus);
}

// Loads that take their time are complete when a static stage begins, and a later stage finds them so.
Scene soft_slope_with_stiff_joints(int seed) {
  Scene scene = scene_of(fmt::format(R"(
[run]
fidelity = "deformable"
[material.rock]
density = 2600.0
youngs_modulus = 2e9
poissons_ratio = 0.25
[joint.default]
normal_stiffness = 1e11
friction_angle_deg = 45.0
[region]
material = "rock"
fixed = ["bottom", "left", "right"]
fixed_thickness = 2.0
min_width = 0.4
[region.slope]
toe_length = 8.0
crest_length = 14.0
depth = 5.0
[[region.slope.bench]]
height = 12.0
face_angle_deg = 70.0
[[joint_set]]
name = "bedding"
dip_deg = 25.0
spacing = 1.5
spacing_scatter = {{kind = "lognormal", deviation = 0.3}}
[[joint_set]]
name = "cross"
dip_deg = 80.0
dip_scatter = {{kind = "normal", deviation_deg = 4.0}}
spacing = 2.0
trace_length = 10.0
gap = 1.0
seed = {}
)",
                                     seed) +
                         settle);
  scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
  return scene;
}

// k_n L/E = 75: blocks strain by far more than joints close. With friction in the middle of what is closed K
// has less than a quarter of the stiffness of some joints that gape: one of these three slopes then goes on
// with the dynamic solver, and one takes 317 evaluations.
TEST(StaticStage, SoftBlocksBetweenStiffJointsSettle) {
  for (const int seed : {3, 4, 5}) {
    Simulation simulation(Communicator::self(), soft_slope_with_stiff_joints(seed));
    run_stages(simulation);
    const StageResult result = simulation.stage_results().back();
    EXPECT_EQ(result.verdict, Verdict::settled) << seed;
    EXPECT_EQ(result.loose, 0) << seed;
    EXPECT_LT(result.steps, 250) << seed;
    EXPECT_FALSE(has_fallen_back(simulation)) << seed;
  }
}

/// Two blocks on a plane of 36.87 degrees; a cable and two grouted bars hold them once friction has fallen.
std::string bolted_slab(const std::string &fidelity, double density, double weak_deg) {
  const std::vector<Vec2> lower{{4.0, 3.0}, {8.0, 6.0}, {6.5, 8.0}, {2.5, 5.0}};
  const std::vector<Vec2> upper{{8.0, 6.0}, {12.0, 9.0}, {10.5, 11.0}, {6.5, 8.0}};
  const std::vector<Vec2> base{{-8.0, -6.0}, {20.0, -6.0}, {20.0, 15.0}, {0.0, 0.0}, {-8.0, 0.0}};
  std::string toml = fmt::format(R"([run]
fidelity = "{}"
[material.rock]
density = {}
youngs_modulus = 20e9
poissons_ratio = 0.25
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 40.0
[support.cable]
kind = "anchored"
axial_rigidity = 5.6e7
axial_yield = 4.5e5
pretension = 1e5
spacing = 2.0
[support.bar]
kind = "grouted"
axial_rigidity = 9.8e7
axial_yield = 2.45e5
active_length = 0.5
shear_stiffness = 5e7
shear_yield = 1.2e5
bond_strength = 3e5
plate = true
spacing = 2.0
)",
                                 fidelity, density);
  std::string active;
  const auto add_bolt = [&](const char *name, const char *kind, const char *ends) {
    toml += fmt::format("[[bolt]]\nname = \"{}\"\nsupport = \"{}\"\n{}\nactive = false\n", name, kind, ends);
    active += fmt::format("{}\"bolt.{}.active\" = true", active.empty() ? "" : ", ", name);
  };
  add_bolt("cable", "cable", "from = [4.0, 6.125]\nto = [10.0, 0.125]");
  add_bolt("bar1", "bar", "from = [7.5, 8.75]\nto = [12.5, 6.75]");
  add_bolt("bar2", "bar", "from = [9.0, 9.875]\nto = [14.0, 7.875]");
  return toml + block_toml("base", base, "fixed = true") + block_toml("lower", lower) +
         block_toml("upper", upper) + settle + "[[stage]]\nkind = \"change\"\nset = { " + active + " }\n" +
         settle + fmt::format("set = {{ \"joint.default.friction_angle_deg\" = {} }}\n", weak_deg);
}

// Joints at their cap that turn go from stick to slip and back where a motion that begins anew sees a
// sixteenth of their stiffness: most of these do then not come to rest.
TEST(StaticStage, ABoltedSlabSettlesWhoseFrictionFalls) {
  for (const char *fidelity : {"rigid", "deformable"}) {
    for (const double weak_deg : {25.0, 24.0, 22.0}) {
      for (const double density : {2600.0, 2606.0, 2613.0}) {
        Simulation simulation(Communicator::self(), scene_of(bolted_slab(fidelity, density, weak_deg)));
        run_stages(simulation);
        const StageResult result = simulation.stage_results().back();
        const std::string which = fmt::format("{}, {} degrees, {} kg/m3", fidelity, weak_deg, density);
        EXPECT_EQ(result.verdict, Verdict::settled) << which;
        EXPECT_LT(result.steps, 600) << which;
        EXPECT_FALSE(has_fallen_back(simulation)) << which;
      }
    }
  }
}

// All of the weight at once closes the joints of a thin plate by more than half of it, where they would come
// to rest at 0.4.
TEST(StaticStage, BlocksThatRunIntoEachOtherAreTakenBack) {
  constexpr double stiffness = 1e6;
  constexpr double width = 0.1;
  const double density = 0.4 * width * stiffness / (4.0 * earth_gravity);
  std::string toml = fmt::format("[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = {}\n"
                                 "[joint.default]\nnormal_stiffness = {}\nfriction_angle_deg = 30.0\n",
                                 density, stiffness) +
                     block_toml("floor", rectangle({-2.0, -1.0}, {3.0, 0.0}), "fixed = true") +
                     block_toml("plate", rectangle({0.0, 0.0}, {1.0, width}));
  for (int k = 0; k < 4; ++k) {
    toml += block_toml(fmt::format("s{}", k), rectangle({0.0, width + k}, {1.0, width + k + 1.0}));
  }
  Simulation simulation(Communicator::self(), scene_of(toml + settle + "increments = 1\n"));
  const EnergyLedger ledger(simulation.state());
  run_stages(simulation);
  EXPECT_FALSE(simulation.fault());
  EXPECT_TRUE(has_note(simulation, "would have closed by more than half of a block"));
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  const EnergyRow row = ledger.row(simulation.state());
  EXPECT_LT(std::abs(row.residual), 0.02 * -row.gravity);
}

TEST(StaticStage, BeginsWhenItsLoadsAreComplete) {
  const std::string toml =
      stack(3, "gravity_ramp = 2.0\n") + settle + "[[stage]]\nkind = \"run\"\nduration = 0.01\n";
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation);
  EXPECT_GT(simulation.stage_results()[0].time, 2.0);
  const double weight = 3.0 * rock_density * earth_gravity;
  const auto regions = regions_of(simulation);
  const double largest = std::max_element(regions.begin(), regions.end(), [](const auto &a, const auto &b) {
                           return a.normal_force < b.normal_force;
                         })->normal_force;
  EXPECT_NEAR(largest, weight, 1e-4 * weight);
}

// What the energies of a stage come from: nothing moves at its end, and what the weight has done is stored,
// lost in friction or taken by the iteration. Contact forces k_n d (1 - d) are hardly curved over an
// increment of the load. Joints touch from the beginning, by a hundredth of the largest overlap at rest: of
// those with a gap of zero last bits decide whether a block falls at first, and a joint that closes in the
// middle of a step leaves some percent of the work.
TEST(StaticStage, EnergiesAddUp) {
  Simulation simulation(Communicator::self(), scene_of(stack(4, "", 1e-6) + settle));
  const EnergyLedger ledger(simulation.state());
  run_stages(simulation);
  const EnergyRow row = ledger.row(simulation.state());
  EXPECT_EQ(row.kinetic, 0.0);
  EXPECT_LT(row.gravity, 0.0);
  EXPECT_GT(row.contact_normal, 0.0);
  EXPECT_GT(row.damping_loss, 0.0);
  EXPECT_LT(std::abs(row.residual), 1e-6 * -row.gravity);
}

// A beam of length L and height h, glued to a pier, hangs by M = rho g h L^2/2, whose pull at the upper end
// of the joint is 6 M/h^2 = 3 rho g L^2/h. Bonds break for good, so that a swing beyond the load would show:
// 1 % is what the beam may turn and shift its weight, and what the iteration may swing.
TEST(StaticStage, BondsBreakWhereTheirStrengthEnds) {
  constexpr double length = 4.0;
  constexpr double height = 0.5;
  const double pull = 3.0 * rock_density * earth_gravity * length * length / height;
  const auto settle_beam = [&](double strength, const std::string &fidelity) {
    const std::string toml =
        fmt::format("[run]\nfidelity = \"{}\"\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 20e9\n"
                    "poissons_ratio = 0.25\n[joint.default]\n"
                    "normal_stiffness = 1e10\nfriction_angle_deg = 35.0\ncohesion = 5e6\ntension = {}\n"
                    "[output]\ninterval = 0.1\n",
                    fidelity, strength * pull) +
        block_toml("pier", rectangle({-1.0, -2.0}, {0.0, 1.0}), "fixed = true") +
        block_toml("beam", rectangle({0.0, 0.0}, {length, height}));
    Simulation simulation(Communicator::self(), scene_of(toml + settle));
    run_stages(simulation);
    const StageResult result = simulation.stage_results().back();
    EXPECT_EQ(result.verdict, strength < 1.0 ? Verdict::failed : Verdict::settled)
        << strength << ' ' << fidelity;
    EXPECT_EQ(has_fallen_back(simulation), strength < 1.0) << "only damped motion says that it has failed";
  };
  for (const char *fidelity : {"rigid", "deformable"}) {
    settle_beam(0.99, fidelity);
    settle_beam(1.01, fidelity);
  }
}

// A slab between a floor and a smooth wall, with gravity along and onto the floor: friction takes N tan(phi)
// of what drives it, the wall the rest. The floor opens by tan(psi) times the slip, which is the slab's
// motion less the stretch of the tangential spring.
TEST(StaticStage, ASlabThatSlipsOpensADilatingJoint) {
  constexpr double length = 10.0; // and 1 m high
  constexpr double stiffness = 1e9;
  const double slope = std::numbers::pi / 6.0;
  const double friction = std::tan(std::numbers::pi / 9.0);
  const double dilation = std::tan(std::numbers::pi / 18.0);
  const std::string toml =
      fmt::format(
          "[run]\nfidelity = \"rigid\"\ngravity = [{}, {}]\n[material.rock]\ndensity = 2600.0\n"
          "[joint.default]\nnormal_stiffness = 1e9\ntangential_ratio = 0.5\nfriction_angle_deg = 20.0\n"
          "dilation_angle_deg = 10.0\ndilation_limit = 0.01\n[joint.smooth]\nfriction_angle_deg = 0.0\n"
          "dilation_angle_deg = 0.0\n[output]\ninterval = 0.1\n",
          earth_gravity * std::sin(slope), -earth_gravity * std::cos(slope)) +
      block_toml("floor", rectangle({-2.0, -1.0}, {12.0, 0.0}), "fixed = true") +
      block_toml("wall", rectangle({10.0, 0.0}, {12.0, 2.0}), "fixed = true") +
      block_toml("slab", rectangle({0.0, 0.0}, {length, 1.0}),
                 "edge_joints = [\"\", \"smooth\", \"\", \"\"]");
  Simulation simulation(Communicator::self(), scene_of(toml + settle + "increments = 800\n"));
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  EXPECT_FALSE(has_fallen_back(simulation));
  const double weight = rock_density * earth_gravity * length;
  const double normal = weight * std::cos(slope);
  const double shear = normal * friction;
  const RigidDof moved = displacement_of(simulation, 2);
  // A swing that falls with the increments, and 1e-5 of the forces.
  EXPECT_NEAR(moved.u.x, (weight * std::sin(slope) - shear) / stiffness, 2e-3 * moved.u.x);
  const double slip = moved.u.x + 0.5 * moved.r - shear / (0.5 * stiffness * length);
  EXPECT_NEAR(moved.u.y + normal / (stiffness * length), dilation * slip, 2e-3 * dilation * slip);
}

TEST(StaticStage, SaysWhatItDoesNotServe) {
  const std::string toml = stack(2) + "[[block]]\nname = \"ram\"\nmaterial = \"rock\"\n"
                                      "vertices = [[5, 0], [6, 0], [6, 1], [5, 1]]\n"
                                      "velocity_table = [[0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]\n";
  Simulation simulation(Communicator::self(), scene_of(toml + settle));
  run_stages(simulation);
  EXPECT_TRUE(has_fallen_back(simulation));
  EXPECT_TRUE(has_note(simulation, "velocities that are given"));
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
}

} // namespace
} // namespace gcpdda::testing::static_stage_test
