// Stages: verdicts on scenes whose answer is known, what stages change at once, what they make of the rest.

#include "simulation/energy_ledger.hpp"
#include "simulation/stages.hpp"
#include "support/incline.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gcpdda::testing::stages_test {
namespace {

const std::string settle = "[[stage]]\nkind = \"settle\"\nlimit = 40.0\nsolver = \"dynamic\"\n";
const std::string wait_undamped = "[[stage]]\nkind = \"run\"\nlimit = 20.0\n";

struct Slope {
  double friction_deg;
  std::string stage;
  Verdict verdict;
};

class VerdictOnASlope : public ::testing::TestWithParam<Slope> {};

// Of 30 degrees. The nearest ones miss it by 0.1 degrees: 0.4 % of the driving force.
TEST_P(VerdictOnASlope, IsThatOfCoulomb) {
  const Incline incline{.slope_deg = 30.0, .friction_deg = GetParam().friction_deg};
  const std::string toml = without_duration(
      incline.toml(incline.flat_square(0.0), {.run_keys = "local_damping = 0.0", .interval = 0.5}));
  Simulation simulation(Communicator::self(), scene_of(toml + GetParam().stage));
  run_stages(simulation);
  ASSERT_FALSE(simulation.fault().has_value());
  const StageResult result = simulation.stage_results().back();
  EXPECT_EQ(result.verdict, GetParam().verdict)
      << "after " << result.steps << " steps, r = " << result.unbalanced_ratio << ", moved " << result.moved;
}

INSTANTIATE_TEST_SUITE_P(
    Stages, VerdictOnASlope,
    ::testing::Values(Slope{35.0, settle, Verdict::settled}, Slope{30.1, settle, Verdict::settled},
                      // Local damping lets it creep by 4 mm/s.
                      Slope{29.9, settle + "failure_motion = 0.05\n", Verdict::failed},
                      Slope{15.0, settle, Verdict::failed}, Slope{35.0, wait_undamped, Verdict::settled},
                      Slope{30.1, wait_undamped, Verdict::settled},
                      Slope{29.9, wait_undamped, Verdict::failed},
                      // Too short for what creeps to be told.
                      Slope{29.9, "[[stage]]\nkind = \"settle\"\nlimit = 1.0\nsolver = \"dynamic\"\n",
                            Verdict::undecided},
                      Slope{29.9, "[[stage]]\nkind = \"run\"\nlimit = 1.0\n", Verdict::undecided}),
    [](const auto &slope) {
      return fmt::format("Case{}_{}deg", slope.index, static_cast<int>(slope.param.friction_deg));
    });

/// What a trial that has moved by `moved(t)` sizes is called at the end of its windows without drag.
template <class Motion> Verdict verdict_by_windows(Motion &&moved, double fall_of_ratio) {
  Stage stage;
  stage.drag_limit = 1.0;
  LookMemory memory;
  for (int k = 1; k <= 900; ++k) {
    const double time = 0.01 * k;
    StageLook look;
    look.unbalanced_ratio = 1e-3 * std::exp(-fall_of_ratio * time);
    look.moved = look.moved_beyond_sag = moved(time);
    if (judge_without_drag(stage, look, time, memory) == Verdict::failed) {
      return Verdict::failed;
    }
  }
  return Verdict::undecided;
}

// However little it has moved: what is bounded, or grows as a logarithm, is not called failed.
TEST(Stages, WindowsTellWhatGoesOnFromWhatFades) {
  EXPECT_EQ(verdict_by_windows([](double t) { return 1e-3 * t * t; }, 0.0), Verdict::failed) << "accelerates";
  EXPECT_EQ(verdict_by_windows([](double t) { return 1e-3 * t; }, 0.0), Verdict::failed) << "goes on";
  EXPECT_EQ(verdict_by_windows([](double t) { return 1e-3 * t; }, 0.2), Verdict::undecided)
      << "what drives it fades";
  EXPECT_EQ(verdict_by_windows([](double t) { return 1.0 - std::exp(-t); }, 0.0), Verdict::undecided);
  EXPECT_EQ(verdict_by_windows([](double t) { return std::log(1.0 + t); }, 0.0), Verdict::undecided);
  EXPECT_EQ(verdict_by_windows([](double t) { return 0.01 + 1e-3 * std::sin(30.0 * t); }, 0.0),
            Verdict::undecided)
      << "sways";
  EXPECT_EQ(verdict_by_windows([](double) { return 0.0; }, 0.0), Verdict::undecided) << "does not move";
}

/// Looks at a trial until it is called settled, at most 40; motion between two looks as it is given.
/// @param fall  by which a block falls in the first look, m; 0: nobody asks
template <class Motion> int looks_until_settled(const Stage &stage, Motion &&motion, double fall = 0.0) {
  LookMemory memory;
  for (int k = 1; k <= 40; ++k) {
    StageLook look;
    look.unbalanced_ratio = 0.1 * stage.tolerance;
    look.overlap = 1e-3;
    look.force = 1e6;
    look.motion = motion(k);
    look.kinetic = 1e10 * look.motion * look.motion;
    look.fall = (2.0 * k - 1.0) * fall;
    if (judge(stage, look, looks_at_loose_blocks(false), memory) == Verdict::settled) {
      return k;
    }
  }
  return 0;
}

// Motion of a thousandth of the overlap is rest. From rest on, a swing of more that fades is no way out of
// it.
TEST(Stages, ATrialFromRestNeedsNotWaitForTheEndOfASwing) {
  Stage trial;
  trial.drag_limit = 1.0;
  Stage from_rest = trial;
  from_rest.begins_at_rest = true;
  const auto swing = [](int k) { return 1e-5 * std::exp(-0.1 * k); };
  const auto slide = [](int k) { return 1e-7 * (2.0 * k - 1.0); };
  const auto far_slide = [](int k) { return 2e-6 * (2.0 * k - 1.0); };
  EXPECT_EQ(looks_until_settled(from_rest, swing), 3);
  EXPECT_EQ(looks_until_settled(trial, swing), 25)
      << "the first of two looks at less than 1e-6 m is the 24th";
  EXPECT_EQ(looks_until_settled(from_rest, slide), 0) << "it gains speed";
  EXPECT_EQ(looks_until_settled(from_rest, far_slide), 0);
}

// A swing that friction feeds gains energy for long; a slide under a thousandth of the weight moves no less
// at first. From the fourth look on they are told apart by how far blocks have moved.
TEST(Stages, AStateOfRestIsConfirmedWhereHardlyAForceDrivesIt) {
  Stage trial;
  trial.drag_limit = 1.0;
  Stage from_rest = trial;
  from_rest.begins_at_rest = true;
  constexpr double fall = 0.008; // m, in 0.04 s
  const auto fed_swing = [](int k) { return 4e-7 * std::pow(1.15, k); };
  const auto slide_under = [&](double share) {
    return [share](int k) { return share * fall * (2.0 * k - 1.0); };
  };
  EXPECT_EQ(looks_until_settled(from_rest, fed_swing), 0);
  EXPECT_EQ(looks_until_settled(from_rest, fed_swing, fall), 4);
  EXPECT_EQ(looks_until_settled(from_rest, slide_under(1e-3), fall), 0);
  EXPECT_EQ(looks_until_settled(from_rest, slide_under(3e-4), fall), 0);
  EXPECT_EQ(looks_until_settled(from_rest, slide_under(1e-4), fall), 4);
}

const std::string stack_head = R"([run]
fidelity = "rigid"
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 30.0
[output]
interval = 0.1
)";

std::string stack(int height) {
  std::string toml = stack_head + block_toml("floor", rectangle({-2.0, -1.0}, {3.0, 0.0}), "fixed = true");
  for (int k = 0; k < height; ++k) {
    toml += block_toml(fmt::format("s{}", k), rectangle({0.0, 1.0 * k}, {1.0, k + 1.0}));
  }
  return toml;
}

// The weight above each joint: k_n d (1 - d) = w between equal faces, without 1/2 d on the wide floor.
TEST(Stages, AStackSettlesAtItsOverlaps) {
  Simulation simulation(Communicator::self(), scene_of(stack(4) + settle));
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  double down = 0.0;
  for (int k = 0; k < 4; ++k) {
    const double weight = (4 - k) * rock_density * earth_gravity / 1e9;
    down += weight * (1.0 + (k == 0 ? 0.5 : 1.0) * weight);
    // The tolerance lets 1e-5 of the weight be out of balance, on each of four joints.
    EXPECT_NEAR(-displacement_of(simulation, k + 1).u.y, down, 1e-4 * down) << k;
    EXPECT_EQ(velocity_of(simulation, k + 1), RigidDof{}) << "set to rest";
  }
}

// Gravity at once and gravity that rises in ten of the wall's slowest periods: no joint slips on either way.
TEST(Stages, AWallSettlesWhereSlowDynamicsLeavesIt) {
  const std::string wall =
      stack_head.substr(stack_head.find("fidelity")) +
      block_toml("floor", rectangle({-1.0, -1.0}, {9.0, 0.0}), "fixed = true") +
      "[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 6\ncolumns = 8\n"
      "block_size = [1.0, 0.5]\n";
  Simulation settled(Communicator::self(), scene_of("[run]\n" + wall + settle));
  run_stages(settled);
  ASSERT_EQ(settled.stage_results().back().verdict, Verdict::settled);
  Simulation slow(Communicator::self(), scene_of("[run]\nduration = 0.7\ngravity_ramp = 0.5\n" + wall));
  while (!slow.finished()) {
    slow.step();
  }
  double largest = 0.0;
  double apart = 0.0;
  for (std::size_t row = 0; row < slow.blocks().num_owned; ++row) {
    const Vec2 moved = slow.blocks().displacement[row].u;
    largest = std::max(largest, norm(moved));
    apart = std::max(apart, norm(moved - settled.blocks().displacement[row].u));
  }
  EXPECT_LE(apart, 1e-3 * largest);
  EXPECT_LE(2 * settled.step_count(), slow.step_count()); // it pays more the higher the wall
}

// Where every side of a block is in contact the bound of the step is nearly sharp: a step that local damping
// cannot take keeps the pile awake for ever.
TEST(Stages, APyramidSettlesAtTheStepTheProgramTakes) {
  const std::string pyramid =
      "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600.0\n[joint.default]\n"
      "allowed_overlap = 1e-3\nfriction_angle_deg = 31.0\n[output]\ninterval = 1.0\n" +
      block_toml("floor", rectangle({-2.0, -2.0}, {16.0, 0.0}), "fixed = true") +
      "[[pyramid]]\nname = \"p\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 14\nblock_size = [1.0, 1.0]\n";
  for (const char *damping : {"", "local_damping = 0.3\n", "kinetic_damping = true\n"}) {
    Simulation simulation(Communicator::self(), scene_of(pyramid + settle + damping));
    run_stages(simulation);
    EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled) << damping;
  }
}

// Gravity acts at once: the large block goes past the place where it rests, nearly twice as far, and the
// stone on it moves by more than half of its own size. It rides on the sag and does not fail.
TEST(Stages, ASmallStoneOnALargeBlockSettlesWithIt) {
  const std::string toml = "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500.0\n[joint.default]\n"
                           "allowed_overlap = 1e-3\nfriction_angle_deg = 30.0\n[output]\ninterval = 3.0\n" +
                           block_toml("floor", rectangle({-50.0, -10.0}, {150.0, 0.0}), "fixed = true") +
                           block_toml("large", rectangle({0.0, 0.0}, {100.0, 100.0})) +
                           block_toml("stone", rectangle({50.0, 100.0}, {50.2, 100.2}));
  Simulation simulation(Communicator::self(), scene_of(toml + settle));
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled)
      << simulation.stage_results().back().time;
}

// Where a stage settles the step need not be accurate; a safety below the default is heeded all the same.
TEST(Stages, ASettleStageTakesLongStepsUnlessShortOnesAreAskedFor) {
  const std::string toml = stack(2) + "[[stage]]\nkind = \"settle\"\nlimit = 10.0\nlocal_damping = 0.0\n";
  for (const auto &[given, taken] : {std::pair{0.25, 0.25}, {0.55, 0.9}, {0.7, 0.9}}) {
    const Simulation simulation(Communicator::self(), scene_of(toml, {fmt::format("run.safety={}", given)}));
    const StepBound &bound = simulation.bound();
    EXPECT_EQ(bound.safety, taken);
    EXPECT_EQ(bound.time_step, taken * bound.limit / bound.omega_max);
    EXPECT_LE(simulation.plan().time_step, bound.time_step);
  }
}

// Only under local damping a share of the limit is kept back, whatever the scene asks for.
TEST(Stages, ARunTakesTheSafetyThatIsGiven) {
  const std::string stages = "[[stage]]\nkind = \"run\"\nduration = 1.0\n";
  for (const double given : {0.25, 0.55, 0.95, 1.0}) {
    const std::vector<std::string> sets{fmt::format("run.safety={}", given), "run.contact_damping=0"};
    const Simulation plain(Communicator::self(), scene_of(stack(2) + stages, sets));
    EXPECT_EQ(plain.bound().safety, given);
    const Simulation damped(Communicator::self(),
                            scene_of(stack(2) + stages + "local_damping = 0.8\n", sets));
    const double most = 0.9 / std::sqrt(1.8); // 2/sqrt(1 + a) is the limit under local damping of share a
    EXPECT_LT(damped.bound().time_step, (most + 0.01) * plain.bound().limit / plain.bound().omega_max);
  }
}

// The stage that finds nothing to take away is told of, and only that one.
TEST(Stages, ExcavationsThatRemoveNothingAreToldOf) {
  const std::string dig = "kind = \"excavate\"\nregion = [[-9, 0.2], [9, 0.2], [9, 9], [-9, 9]]\n";
  Simulation simulation(Communicator::self(),
                        scene_of(stack(2) +
                                 "[[stage]]\nkind = \"run\"\nduration = 0.01\n[[stage]]\nname = "
                                 "\"dig\"\n" +
                                 dig + "[[stage]]\nname = \"again\"\n" + dig));
  run_stages(simulation);
  std::vector<std::string> warnings;
  for (const Diagnostic &note : simulation.notes()) {
    if (note.what.find("removes no blocks") != std::string::npos) {
      EXPECT_EQ(note.severity, Severity::warning);
      warnings.push_back(note.what);
    }
  }
  EXPECT_EQ(warnings, std::vector<std::string>{"stage 'again' removes no blocks"});
}

const std::string settle_kinetically = settle + "kinetic_damping = true\n";

// Sudden gravity on a touching block: half a swing about the overlap that bears it, fastest in its middle.
TEST(Stages, KineticDampingStopsABlockWhereItIsFastest) {
  const std::string toml = stack_head +
                           block_toml("floor", rectangle({-2.0, -1.0}, {3.0, 0.0}), "fixed = true") +
                           block_toml("stone", rectangle({0.0, 0.0}, {1.0, 1.0})) + settle_kinetically;
  Simulation simulation(Communicator::self(), scene_of(toml));
  do {
    simulation.step();
  } while (velocity_of(simulation, 1) != RigidDof{} && simulation.step_count() < 100);
  const double omega = std::sqrt(1e9 / rock_density);
  const double weight = rock_density * earth_gravity / 1e9;
  const double dt = simulation.plan().time_step;
  // The peak is known when it has passed: at most one step and a half later.
  EXPECT_NEAR(simulation.time(), 0.5 * std::numbers::pi / omega + dt, dt);
  EXPECT_NEAR(-displacement_of(simulation, 1).u.y, weight, 1.5 * omega * dt * weight);
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  EXPECT_NEAR(-displacement_of(simulation, 1).u.y, weight * (1.0 + 0.5 * weight), 1e-5 * weight);
}

// The same place, since no joint slips, at less than half of the cost.
TEST(Stages, KineticDampingLeavesAWallWhereLocalDampingDoes) {
  const std::string wall =
      stack_head + block_toml("floor", rectangle({-1.0, -1.0}, {9.0, 0.0}), "fixed = true") +
      "[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 16\ncolumns = 8\n"
      "block_size = [1.0, 0.5]\n";
  Simulation local(Communicator::self(), scene_of(wall + settle));
  Simulation kinetic(Communicator::self(), scene_of(wall + settle_kinetically));
  double largest = 0.0;
  double apart = 0.0;
  run_stages(local);
  run_stages(kinetic);
  EXPECT_EQ(kinetic.stage_results().back().verdict, Verdict::settled);
  for (std::size_t row = 0; row < local.blocks().num_owned; ++row) {
    const Vec2 moved = local.blocks().displacement[row].u;
    largest = std::max(largest, norm(moved));
    apart = std::max(apart, norm(moved - kinetic.blocks().displacement[row].u));
  }
  EXPECT_LE(apart, 1e-3 * largest);
  EXPECT_LE(2 * kinetic.step_count(), local.step_count());
}

// What each stop takes is booked as damping, but for how the force changes in the step that begins from rest.
TEST(Stages, KineticDampingKeepsTheLedger) {
  std::string deformable = stack_head;
  deformable.replace(deformable.find("rigid"), 5, "deformable");
  deformable.insert(deformable.find("[joint"), "youngs_modulus = 1e10\npoissons_ratio = 0.25\n");
  for (const std::string &head : {stack_head, deformable}) {
    Simulation simulation(
        Communicator::self(),
        scene_of(head + block_toml("floor", rectangle({-1.0, -1.0}, {9.0, 0.0}), "fixed = true") +
                 "[[wall]]\nname = \"w\"\nmaterial = \"rock\"\norigin = [0, 0]\nrows = 16\ncolumns = 8\n"
                 "block_size = [1.0, 0.5]\n" +
                 settle_kinetically));
    const EnergyLedger ledger(simulation.state());
    while (!simulation.stage_is_over()) {
      simulation.step();
    }
    const EnergyRow row = ledger.row(simulation.state());
    EXPECT_LT(std::abs(row.residual), 2e-3 * row.damping_loss) << row.residual;
    EXPECT_GT(row.damping_loss, 0.3 * -row.gravity);
  }
}

TEST(Stages, AFallingBlockFails) {
  const std::string toml = stack_head + block_toml("stone", rectangle({0.0, 0.0}, {1.0, 1.0}));
  for (const std::string &stage : {settle, wait_undamped}) {
    Simulation simulation(Communicator::self(), scene_of(toml + stage));
    run_stages(simulation);
    EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::failed);
  }
}

// Forty layers whose joints close by up to a twentieth of their height: the top comes down by more than a
// block that has failed may move, which is no failure. One that falls beside them is one.
TEST(Stages, ATallPileMaySag) {
  std::string pile = stack_head;
  pile.replace(pile.find("1e9"), 3, "2e7");
  pile += block_toml("floor", rectangle({-10.0, -1.0}, {40.0, 0.0}), "fixed = true");
  for (int k = 0; k < 40; ++k) {
    pile += block_toml(fmt::format("s{}", k), rectangle({0.0, 1.0 * k}, {20.0, k + 1.0}));
  }
  const std::string settle_soon = settle + "failure_motion = 0.2\n";
  for (const char *damping : {"local_damping = 0.3\n", "kinetic_damping = true\n"}) {
    Simulation simulation(Communicator::self(), scene_of(pile + settle_soon + damping));
    run_stages(simulation);
    const StageResult result = simulation.stage_results().back();
    EXPECT_EQ(result.verdict, Verdict::settled) << damping;
    EXPECT_GT(result.moved, 0.2);
  }
  const std::string falling = block_toml("falling", rectangle({25.0, 38.0}, {29.0, 40.0}));
  Simulation simulation(Communicator::self(), scene_of(pile + falling + settle_soon));
  run_stages(simulation);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::failed);
}

// A pile of 4: what is cut off below carries no more, what is above follows; ids stay.
TEST(Stages, AnExcavatedBlockIsGone) {
  const std::string toml =
      stack(4) + settle +
      "[[stage]]\nkind = \"excavate\"\nblocks = [\"s2\"]\nregion = [[0.1, 2.9], [0.9, 2.9], "
      "[0.9, 3.9], [0.1, 3.9]]\n" +
      settle;
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation);
  ASSERT_EQ(simulation.stage_results().size(), 3U);
  EXPECT_EQ(simulation.stage_results()[1].removed, 2);
  EXPECT_EQ(simulation.stage().removed, (std::vector<std::int64_t>{3, 4}));
  EXPECT_EQ(simulation.blocks().num_owned, 2U);
  EXPECT_EQ(simulation.stage_results().back().verdict, Verdict::settled);
  const double weight = 2.0 * rock_density * earth_gravity / 1e9;
  EXPECT_NEAR(-displacement_of(simulation, 1).u.y, weight * (1.0 + 0.5 * weight), 1e-4 * weight);
}

// While the load of the excavated block is there nothing has changed; then the stack springs back by what it
// had been pressed: never past it, since the load falls slowly beside the period of 3 ms.
TEST(Stages, GradualUnloadingBringsNoJump) {
  const std::string toml = stack(2) + settle +
                           "[[stage]]\nkind = \"excavate\"\nblocks = [\"s1\"]\nrelax = 0.5\n[[stage]]\nkind "
                           "= \"run\"\nduration = 1.0\n";
  Simulation simulation(Communicator::self(), scene_of(toml));
  const double weight = rock_density * earth_gravity / 1e9;
  double highest = -1.0;
  double just_after = 0.0;
  while (simulation.end_stage(), !simulation.finished()) {
    if (simulation.stage_is_over()) {
      simulation.begin_next_stage();
      continue;
    }
    simulation.step();
    if (simulation.stage().index == 2) {
      highest = std::max(highest, displacement_of(simulation, 1).u.y);
      just_after = simulation.stage_step() == 10 ? displacement_of(simulation, 1).u.y : just_after;
    }
  }
  EXPECT_NEAR(just_after, -2.0 * weight, 0.02 * weight); // 10 steps of 0.4 ms of 0.5 s
  EXPECT_NEAR(displacement_of(simulation, 1).u.y, -weight, 1e-3 * weight);
  EXPECT_LT(highest, -weight * (1.0 - 0.02)); // the ramp sets off a ripple of period/relax
}

// Strength and weight change where a stage says so; a fixed block is let go and held again.
TEST(Stages, ParametersChange) {
  const Incline incline{.slope_deg = 30.0, .friction_deg = 35.0};
  const std::string toml =
      without_duration(incline.toml(incline.flat_square(0.0), {.interval = 0.5})) + settle +
      "[[stage]]\nkind = \"run\"\nduration = 1.0\nset = { \"joint.default.friction_angle_deg\" = 15.0, "
      "\"material.rock.density\" = 1300.0 }\n";
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation);
  const double way = norm(displacement_of(simulation, 1).u);
  // It starts at rest in the depth of the old weight: to a few overlaps.
  const Incline weak{.slope_deg = 30.0, .friction_deg = 15.0};
  EXPECT_NEAR(way, 0.5 * weak.acceleration(), 1e-3 * way);
  EXPECT_EQ(simulation.blocks().properties[row_of(simulation, 1)].mass, 1300.0);
}

TEST(Stages, AFixedBlockIsLetGoAndHeldAgain) {
  const std::string toml =
      stack_head + block_toml("stone", rectangle({0.0, 0.0}, {1.0, 1.0}), "fixed = true") +
      block_toml("other", rectangle({5.0, 0.0}, {6.0, 1.0}), "fixed = true") +
      "[[stage]]\nkind = \"run\"\nduration = 0.1\n"
      "[[stage]]\nkind = \"run\"\nduration = 0.2\nset = { \"block.stone.fixed\" = false }\n"
      "[[stage]]\nkind = \"run\"\nduration = 0.1\nset = { \"block.stone.fixed\" = true }\n";
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation);
  EXPECT_NEAR(displacement_of(simulation, 0).u.y, -0.5 * earth_gravity * 0.04, 1e-12); // exact, a_0 too
  EXPECT_EQ(velocity_of(simulation, 0), RigidDof{});
  EXPECT_EQ(simulation.blocks().num_fixed, 1U);
}

TEST(Stages, GoThroughNumbersUnchanged) {
  StageState state;
  state.index = 2;
  state.ended = true;
  state.verdict = Verdict::failed;
  state.memory.settled_looks = 1;
  state.memory.last.motion = 0.25;
  state.results = {{Verdict::settled, 1.5, 7, 8, 1e-6, 2.0, 3.0, 0}, {Verdict::done, 1.5, 0, 0, 0, 0, 0, 4}};
  state.results[0].slide = 0.25;
  state.results[0].slid_block = 17;
  state.removed = {3, 5, 9, 11};
  state.unloading = {{4, {{1.0, 2.0}, 3.0}, {4.0, 5.0, 6.0, 7.0}, 8.0, 9.0}};
  const StageNumbers numbers = to_numbers(state);
  const StageState again = to_state(numbers);
  EXPECT_EQ(to_numbers(again).counts, numbers.counts);
  EXPECT_EQ(to_numbers(again).reals, numbers.reals);
  EXPECT_EQ(again.verdict, Verdict::failed);
  EXPECT_EQ(again.results[1].removed, 4);
  EXPECT_EQ(again.results[0].slide, 0.25);
  EXPECT_EQ(again.results[0].slid_block, 17);
  EXPECT_EQ(again.unloading[0].gradient.yy, 7.0);
}

} // namespace
} // namespace gcpdda::testing::stages_test
