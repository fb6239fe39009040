// Loads, driven blocks, fixed points and local damping through the whole Simulation, and their energies.

#include "problem.hpp"

#include "dynamics/deformable.hpp"
#include "simulation/energy_ledger.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::loads_test {
namespace {

constexpr double modulus = 1e9; ///< E, Pa

std::string load_toml(Vec2 point, Vec2 force) {
  return fmt::format("[[block.load]]\npoint = [{:.17g}, {:.17g}]\nforce = [{:.17g}, {:.17g}]\n", point.x,
                     point.y, force.x, force.y);
}

Setting elastic(Setting setting, const std::string &fidelity, double youngs_modulus = modulus) {
  setting.fidelity = fidelity;
  setting.youngs_modulus = youngs_modulus;
  setting.poissons_ratio = 0.25;
  return setting;
}

std::string floor_toml() {
  return block_toml("floor", rectangle({-9.0, -2.0}, {9.0, 0.0}), "fixed = true");
}

/// A right triangle with legs 3 m along x and 2 m along y, and what is known of it [std].
struct Triangle {
  Vec2 corner{4.0, -7.0};
  double mass = 3.0 * rock_density;
  Vec2 centroid = corner + Vec2{1.0, 2.0 / 3.0};
  /// S = rho int X X^T dA: A b^2/18, A h^2/18, -A b h/36.
  Mat2 second_moment = rock_density * Mat2{1.5, -0.5, -0.5, 2.0 / 3.0};

  [[nodiscard]] std::string toml(const std::string &extra) const {
    return block_toml("triangle", {corner, corner + Vec2{3.0, 0.0}, corner + Vec2{0.0, 2.0}}, extra);
  }
};

// Newton and Euler for a rigid block; F'' S = f X^T for a deformable one, with the same torque. Round-off.
TEST(DeadLoad, AcceleratesAFreeBlock) {
  const Triangle triangle;
  const Vec2 force{3e4, -7e4};
  for (const std::string fidelity : {"rigid", "deformable"}) {
    for (const Vec2 arm : {Vec2{}, Vec2{-1.0, 4.0 / 3.0}, Vec2{0.5, -0.25}}) {
      const Setting setting = elastic({.duration = 1.0, .time_step = 1e-3, .gravity = {0.0, -2.0}}, fidelity);
      const Simulation simulation(
          Communicator::self(),
          scene_of(head(setting) + triangle.toml(load_toml(triangle.centroid + arm, force))));
      const BlockSystem &blocks = simulation.blocks();
      const Vec2 expected = (1.0 / triangle.mass) * force + setting.gravity;
      const double polar = triangle.second_moment.xx + triangle.second_moment.yy;
      const std::string what = fmt::format("dead load, {}, arm ({:.2g}, {:.2g}): ", fidelity, arm.x, arm.y);
      expect_below(what + "error of the acceleration", 1e-14,
                   norm(blocks.acceleration[0].u - expected) / norm(expected));
      double torque = polar * blocks.acceleration[0].r;
      if (fidelity == "deformable") {
        const Mat2 got = blocks.deformation_of(0).acceleration * triangle.second_moment;
        expect_below(what + "error of F'' S over |f|", 1e-14, norm(got - outer(force, arm)) / norm(force));
        torque = got.yx - got.xy;
      }
      expect_below(what + "error of the torque over |f|", 1e-14,
                   std::abs(torque - cross(arm, force)) / norm(force));
    }
  }
}

// Constant acceleration: x = a t^2/2 but for the sum of 1000 rounded steps. The trial configurations are
// x*(t) = (a/2) [(t + c1 dt)^2 + (2 c2 - c1^2) dt^2], and the ledger takes all in the middle of two of them:
// its offset is (c1^2 - 2 c2 - 1/4) dt^2 f^2/(2 m), to the rounding of a work 5e7
// times as large, 1e-13 of it.
TEST(DeadLoad, ThroughTheCentroidMovesABlockStraight) {
  const Triangle triangle;
  const Vec2 force{3e4, -7e4};
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const Setting setting = elastic({.duration = 1.0, .time_step = 1e-3, .gravity = {}}, fidelity);
    Simulation simulation(Communicator::self(),
                          scene_of(head(setting) + triangle.toml(load_toml(triangle.centroid, force))));
    EnergyLedger ledger(simulation.state());
    run(simulation);
    const std::string what = "dead load through the centroid, " + fidelity + ": ";
    const Vec2 expected = (0.5 / triangle.mass) * force;
    expect_below(what + "error of the distance", 1e-12,
                 norm(displacement_of(simulation, 0).u - expected) / norm(expected));
    expect_below(what + "turn, rad", 1e-12, std::abs(displacement_of(simulation, 0).r));
    const EnergyRow row = ledger.row(simulation.state());
    const double c1 = simulation.scheme().trial_velocity;
    const double c2 = simulation.scheme().trial_acceleration;
    const double unit = setting.time_step * setting.time_step * dot(force, force) / triangle.mass;
    expect_value(what + "residual, J/m", 0.5 * (c1 * c1 - 2.0 * c2 - 0.25) * unit, row.residual, 2e-5);
  }
}

// Off the centroid a free block tumbles under a load of fixed direction. Work and kinetic energy agree to the
// leapfrog's O(dt^2). The work is force times way of the material point; the ledger takes it about one step
// after t_n, where it is larger by up to 2 dt/t.
TEST(DeadLoad, OffTheCentroidKeepsTheEnergyLedger) {
  const Triangle triangle;
  const Vec2 force{3e4, -7e4};
  for (const std::string fidelity : {"rigid", "deformable"}) {
    std::vector<double> residual;
    for (const double time_step : {1e-3, 5e-4}) {
      // At a radius of 0.5 elasticity dissipates: the residual is as small, but falls faster than by four.
      const Setting setting = elastic(
          {.duration = 4.0, .time_step = time_step, .gravity = {}, .run_keys = "spectral_radius = 0.8\n"},
          fidelity, 1e7);
      Simulation simulation(Communicator::self(),
                            scene_of(head(setting) + triangle.toml(load_toml(triangle.corner, force))));
      EnergyLedger ledger(simulation.state());
      double largest = 0.0;
      while (!simulation.finished()) {
        step(simulation);
        largest = std::max(largest, std::abs(ledger.row(simulation.state()).residual));
      }
      EXPECT_GT(std::abs(displacement_of(simulation, 0).r), 1.0) << "it has tumbled";
      const double done = ledger.row(simulation.state()).boundary_work;
      residual.push_back(largest / done);
      const Vec2 way = current_vertices(simulation.blocks(), 0)[0] - triangle.corner;
      expect_value("tumbling under a dead load, " + fidelity + ": work of the force on its point, J/m",
                   dot(force, way), done, 0.75 * time_step);
    }
    expect_below("tumbling under a dead load, " + fidelity + ": largest residual over work, dt = 0.5 ms",
                 1e-4, residual[1]);
    expect_value("tumbling under a dead load, " + fidelity + ": residual of dt over that of dt/2", 4.0,
                 residual[0] / residual[1], 0.1);
  }
}

// Hooke [std]: at rest int t X^T = area sigma, and with E = U - I exactly linear. What oscillation is left
// after 500 periods of local damping and the round-off of F - I, 1e-16/1e-4, stay below 1e-10.
TEST(DeadLoad, OppositeLoadsStrainADeformableBlockByHooke) {
  constexpr double tension = 1e5; // N/m on faces of 1 m: Pa
  constexpr double shear = 4e4;   // Pa
  constexpr double nu = 0.25;
  for (const bool plane_strain : {true, false}) {
    Setting setting = elastic({.duration = 40.0, .time_step = 2e-4, .gravity = {}}, "deformable");
    setting.run_keys = "local_damping = 0.5\n";
    setting.run_keys += plane_strain ? "plane = \"strain\"\n" : "plane = \"stress\"\n";
    // 2 m x 1 m; the resultants of the shear tractions are 2 tau on the long faces, tau on the short ones.
    const std::string loads =
        load_toml({1.0, 0.0}, {tension, shear}) + load_toml({-1.0, 0.0}, {-tension, -shear}) +
        load_toml({0.0, 0.5}, {2.0 * shear, 0.0}) + load_toml({0.0, -0.5}, {-2.0 * shear, 0.0});
    Simulation simulation(
        Communicator::self(),
        scene_of(head(setting) + block_toml("slab", rectangle({-1.0, -0.5}, {1.0, 0.5}), loads)));
    run(simulation);
    const Deformation &d = simulation.blocks().deformation_of(0);
    const Mat2 strain = transposed(rotation_of(d.gradient)) * d.gradient - Mat2::identity();
    const std::string what = fmt::format("Hooke, plane {}: ", plane_strain ? "strain" : "stress");
    const double along = plane_strain ? 1.0 - nu * nu : 1.0;
    const double across = plane_strain ? nu * (1.0 + nu) : nu;
    expect_value(what + "eps_x", along * tension / modulus, strain.xx, 1e-10);
    expect_value(what + "eps_y", -across * tension / modulus, strain.yy, 1e-10);
    expect_value(what + "gamma_xy", 2.0 * (1.0 + nu) * shear / modulus, strain.xy + strain.yx, 1e-10);
    EXPECT_LE(std::abs(displacement_of(simulation, 0).r), 1e-12);
  }
}

// A driven block hits a free one. It keeps its path: v t but for the rounded sum. Momentum: the free block
// has got all of the driving force, so the work is v m v'; exact in the leapfrog. Energy: O(W^2) of the
// impact, with the bound of a single bounce (A6), and the loss of the dashpots.
TEST(DrivenBlock, PushesAFreeOne) {
  constexpr double speed = 0.8;
  constexpr double k_n = 1e8;
  for (const double damping : {0.0, 0.1}) {
    for (const double w : {0.05, 0.1}) {
      const double dt = w / std::sqrt(k_n / rock_density);
      const Setting setting{.duration = 40.0 / w * dt,
                            .time_step = dt,
                            .gravity = {},
                            .normal_stiffness = k_n,
                            .damping = damping};
      Simulation simulation(Communicator::self(),
                            scene_of(head(setting) +
                                     block_toml("ram", rectangle({-1.0, -0.5}, {0.0, 1.5}),
                                                fmt::format("prescribed_velocity = [{}, 0.0, 0.0]", speed)) +
                                     block_toml("square", rectangle({0.001, 0.0}, {1.001, 1.0}))));
      EnergyLedger ledger(simulation.state());
      double off_path = 0.0;
      while (!simulation.finished()) {
        step(simulation);
        const RigidDof &moved = displacement_of(simulation, 0);
        off_path = std::max({off_path, std::abs(moved.u.x - speed * simulation.time()), std::abs(moved.u.y),
                             std::abs(moved.r)});
      }
      ASSERT_FALSE(simulation.fault().has_value());
      const std::string what = fmt::format("driven block, W = {}, damping {}: ", w, damping);
      expect_below(what + "distance from v t, m", 1e-14, off_path);
      const double got = velocity_of(simulation, 1).u.x;
      EXPECT_GT(got, 1.5 * speed);
      const EnergyRow row = ledger.row(simulation.state());
      expect_value(what + "boundary work, J/m", speed * rock_density * got, row.boundary_work, 1e-12);
      expect_below(what + "residual over work", 0.5 * w * w, std::abs(row.residual / row.boundary_work));
      EXPECT_GE(row.damping_loss, damping > 0.0 ? 0.01 * row.boundary_work : 0.0);
    }
  }
}

// A table of one velocity is that velocity, at every moment within the step at which somebody looks.
TEST(DrivenBlock, FollowsItsTable) {
  const auto pushed = [](const std::string &motion) {
    Simulation simulation(
        Communicator::self(),
        scene_of(head({.duration = 0.05, .time_step = 2e-4, .gravity = {}, .normal_stiffness = 1e8}) +
                 block_toml("ram", rectangle({-1.0, -0.5}, {0.0, 1.5}), motion) +
                 block_toml("square", rectangle({0.001, 0.0}, {1.001, 1.0}))));
    run(simulation);
    return displacement_of(simulation, 1).u.x;
  };
  expect_value("driven block: what a table of one velocity pushes, against that velocity, m",
               pushed("prescribed_velocity = [0.8, 0, 0]"),
               pushed("velocity_table = [[0, 0.8, 0, 0], [0.02, 0.8, 0, 0], [0.03, 0.8, 0, 0]]"), 1e-11);
}

// What keeps its velocity meets nothing else of that kind: the user hears of it before the run. A way along
// the ground or away from it is none through it.
TEST(DrivenBlock, SaysThatItPassesThroughTheGround) {
  const auto warnings = [](const std::string &motion) {
    const Simulation simulation(
        Communicator::self(),
        scene_of(head({.duration = 4.0, .time_step = 1e-3}) +
                 block_toml("ground", {{-9, -2}, {9, -2}, {9, 3}, {8, 3}, {8, 0}, {-9, 0}}, "fixed = true") +
                 block_toml("ram", rectangle({0.0, 0.0}, {1.0, 1.0}), motion)));
    std::string text;
    for (const Diagnostic &note : simulation.notes()) {
      text += note.severity == Severity::warning ? note.what + "\n" : "";
    }
    return text;
  };
  EXPECT_EQ(warnings("prescribed_velocity = [2, 0, 0]"),
            "driven block 'ram' passes through block 'ground' at about t = 3.53 s\n");
  EXPECT_EQ(warnings("prescribed_velocity = [1.7, 0, 0]"), "");
  EXPECT_EQ(warnings("velocity_table = [[0, 2, 0, 0], [3.4, 2, 0, 0], [3.5, -2, 0, 0]]"), "");
  EXPECT_EQ(warnings("prescribed_velocity = [0, 2, 1]"), "");
}

const std::vector<Vec2> slab_corners = rectangle({-1.0, -0.5}, {1.0, 0.5});
constexpr double slab_weight = 2.0 * rock_density * earth_gravity;

// Released with unloaded springs, each taking half the weight: it swings about w/2/stiffness and is never
// beyond twice that (own_springs.cpp makes them 100 k_n L stiff). The alpha scheme damps W >> 1 out.
TEST(FixedPoints, TwoHoldABlock) {
  const Setting setting{.duration = 10.0, .time_step = 1e-3};
  Simulation simulation(Communicator::self(),
                        scene_of(head(setting) + floor_toml() +
                                 block_toml("hung", placed(slab_corners, 0.0, {0.0, 3.0}),
                                            "fixed_points = [[-0.8, 3.4], [0.8, 3.4]]")));
  EnergyLedger ledger(simulation.state());
  const double settled = 0.5 * slab_weight / (100.0 * setting.normal_stiffness * std::sqrt(2.0));
  double largest = 0.0;
  while (simulation.step_count() < 5000) {
    step(simulation);
    largest = std::max(largest, norm(displacement_of(simulation, 1).u));
  }
  const RigidDof rest = displacement_of(simulation, 1);
  run(simulation);
  const RigidDof moved = displacement_of(simulation, 1) - rest;
  expect_below("hung block: largest move over the settled one", 2.0 + 1e-6, largest / settled);
  expect_value("hung block: settled depth, m", settled, -rest.u.y, 1e-6);
  expect_below("hung block: creep from 5 to 10 s over its size", 1e-15,
               (norm(moved.u) + std::abs(moved.r)) / std::sqrt(2.0));
  expect_below("hung block: residual over m g L", 1e-12,
               std::abs(ledger.row(simulation.state()).residual) / (slab_weight * std::sqrt(2.0)));
}

/// Released from rest at `start` from its lowest place, hung 0.9 m from its centre.
struct Swing {
  double period = 0.0;
  double residual = 0.0; ///< largest, over m g times the drop
};
Swing swing(const std::string &fidelity, double start, double time_step) {
  constexpr double arm = 0.9;
  constexpr int num_periods = 10;
  // The pivot is the point (0.9, 0) of the slab; it hangs when the slab is turned by +90 degrees.
  const double angle = 0.5 * std::numbers::pi + start;
  const Vec2 pivot{0.0, 5.0};
  const Vec2 centre = pivot - Rotation::of(angle)(Vec2{arm, 0.0});
  const Setting setting =
      elastic({.duration = 25.0, .time_step = time_step, .normal_stiffness = 1e8}, fidelity);
  Simulation simulation(Communicator::self(),
                        scene_of(head(setting) + floor_toml() +
                                 block_toml("pendulum", placed(slab_corners, angle, centre),
                                            fmt::format("fixed_points = [[{}, {}]]", pivot.x, pivot.y))));
  EnergyLedger ledger(simulation.state());
  Swing result;
  double first = 0.0;
  double last = 0.0;
  int crossings = 0;
  double before = start;
  while (!simulation.finished() && crossings <= num_periods) {
    step(simulation);
    const double now = start + displacement_of(simulation, 1).r;
    if (before > 0.0 && now <= 0.0) {
      last = simulation.time() - time_step * now / (now - before);
      first = crossings++ == 0 ? last : first;
    }
    before = now;
    if (simulation.step_count() % 50 == 0) {
      result.residual = std::max(result.residual, std::abs(ledger.row(simulation.state()).residual));
    }
  }
  EXPECT_EQ(crossings, num_periods + 1);
  result.period = (last - first) / num_periods;
  result.residual /= slab_weight * arm * (1.0 - std::cos(start));
  return result;
}

// [std] physical pendulum with the first terms of its amplitude; the next one is 2e-9 at 0.1 rad. The springs
// stretch by w/(100 k_n L) = 4e-6 m of 0.9 m; of the deformable slab the stretch under its weight, rho g L/E
// = 5e-5, shifts the centroid. Energy: (omega dt)^2 = 7e-6 for the rigid one; the deformable one is let go
// unstrained, and the implicit step takes away the half of the weight's work that would shake it: the strain
// energy (0.9 w)^2/(2 area E'), E' = E/(1 - nu^2) of plane strain.
TEST(FixedPoints, OneMakesAPendulum) {
  constexpr double start = 0.1;
  const double length = 0.9 + (4.0 + 1.0) / 12.0 / 0.9; // arm + I/(m arm)
  const double exact = 2.0 * std::numbers::pi * std::sqrt(length / earth_gravity) *
                       (1.0 + start * start / 16.0 + 11.0 * std::pow(start, 4) / 3072.0);
  const Swing rigid = swing("rigid", start, 1e-3);
  expect_value("rigid pendulum: period, s", exact, rigid.period, 1e-5);
  expect_below("rigid pendulum: residual over m g drop", 1e-5, rigid.residual);
  const Swing soft = swing("deformable", start, 1e-3);
  expect_value("deformable pendulum: period, s", exact, soft.period, 6e-5);
  const double strain = 0.5 * std::pow(0.9 * slab_weight, 2) / (2.0 * modulus) * 15.0 / 16.0;
  expect_below("deformable pendulum: residual over m g drop",
               1.1 * strain / (slab_weight * 0.9 * (1.0 - std::cos(start))), soft.residual);
}

/// Three unit squares on a floor, the middle one deformable, the highest one pushed sideways.
std::string stack_toml(const std::string &run_keys, double damping, double push) {
  Setting setting = elastic({.duration = 20.0,
                             .time_step = 5e-4,
                             .normal_stiffness = 1e8,
                             .friction_deg = 30.0,
                             .damping = damping},
                            "rigid");
  setting.run_keys = run_keys;
  return head(setting) + floor_toml() + block_toml("b0", rectangle({0.0, 0.0}, {1.0, 1.0})) +
         block_toml("b1", rectangle({0.0, 1.0}, {1.0, 2.0}), "fidelity = \"deformable\"") +
         block_toml("b2", rectangle({0.0, 2.0}, {1.0, 3.0}), fmt::format("velocity = [{}, 0.0, 0.0]", push));
}

// Nothing but local damping takes energy. At rest nothing is kinetic, so what gravity and the push gave and
// springs do not hold has been lost, all of it counted; to W^2 of the start, measured 5e-5.
TEST(LocalDamping, SettlesAStackAndTellsWhatItTook) {
  constexpr double push = 0.003; // m/s: within friction
  Simulation simulation(Communicator::self(),
                        scene_of(stack_toml("local_damping = 0.5\nspectral_radius = 0.8", 0.0, push)));
  EnergyLedger ledger(simulation.state());
  run(simulation);
  const EnergyRow row = ledger.row(simulation.state());
  expect_below("settled stack: fastest, m/s", 1e-12, row.max_speed);
  expect_below("settled stack: net force over the largest", 1e-9, row.unbalanced_ratio);
  EXPECT_GT(row.damping_loss, 0.0);
  const double given = 0.5 * rock_density * push * push - row.gravity;
  expect_value("settled stack: loss is what was given and springs do not hold, J/m",
               given - row.contact_normal - row.strain - row.contact_stick - row.friction_loss,
               row.damping_loss, 2e-4);
  // A dead weight let go on a linear spring loses half of the work of gravity; joints are linear to d/L =
  // 8e-4, and the push has 3e-4 of that work.
  expect_value("settled stack: loss over the work of gravity", 0.5, -row.damping_loss / row.gravity, 2e-3);
}

// Where it comes to rest is a matter of forces: the same with local damping as with dashpots alone and a slow
// ramp. Round-off of what is left of the oscillation.
TEST(LocalDamping, DoesNotMoveTheEquilibrium) {
  Simulation damped(Communicator::self(), scene_of(stack_toml("local_damping = 0.5", 0.05, 0.0)));
  Simulation slow(Communicator::self(), scene_of(stack_toml("gravity_ramp = 5.0", 0.3, 0.0)));
  run(damped);
  run(slow);
  const double pressure = 3.0 * rock_density * earth_gravity / 1e8; // as B1
  expect_value("stack under local damping: sinking of the lowest block, m",
               std::sqrt(1.0 - 2.0 * pressure) - 1.0, displacement_of(damped, 1).u.y, 1e-10);
  for (const int block : {1, 2, 3}) {
    expect_value(fmt::format("stack with and without local damping: sinking of block {}, m", block),
                 displacement_of(slow, block).u.y, displacement_of(damped, block).u.y, 1e-9);
  }
}

/// Largest |residual| over the initial kinetic energy of a deformable square that falls on the floor.
double bounce_residual(const std::string &elasticity, double w) {
  constexpr double k_n = 1e8;
  constexpr double speed = 1.0;
  const double dt = w / std::sqrt(k_n / rock_density);
  Setting setting =
      elastic({.duration = 8.0 / w * dt, .time_step = dt, .normal_stiffness = k_n, .damping = 0.0},
              "deformable", 1e8);
  setting.run_keys = "elasticity = \"" + elasticity + "\"";
  Simulation simulation(Communicator::self(),
                        scene_of(head(setting) + floor_toml() +
                                 block_toml("square", rectangle({0.0, 0.0}, {1.0, 1.0}),
                                            fmt::format("velocity = [0.0, {}, 0.0]", -speed))));
  EnergyLedger ledger(simulation.state());
  double largest = 0.0;
  double strain = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    const EnergyRow row = ledger.row(simulation.state());
    largest = std::max(largest, std::abs(row.residual));
    strain = std::max(strain, row.strain);
  }
  EXPECT_FALSE(simulation.fault().has_value());
  EXPECT_GT(velocity_of(simulation, 1).u.y, 0.1 * speed) << "it has bounced";
  const double energy = 0.5 * rock_density * speed * speed;
  EXPECT_GT(strain, 0.1 * energy) << "the block has been strained";
  return largest / energy;
}

// The square starts flush, so that the impact begins at the same phase of a step for every dt.
TEST(EnergyLedger, ClosesForADeformableBlockOnTheFloor) {
  for (const std::string elasticity : {"implicit", "explicit"}) {
    std::vector<double> residual;
    for (const double w : {0.05, 0.025, 0.0125}) {
      residual.push_back(bounce_residual(elasticity, w));
      expect_below(fmt::format("bounce, {} elasticity, W = {}: largest residual over E0", elasticity, w),
                   10.0 * w * w, residual.back());
    }
    expect_value("bounce, " + elasticity + " elasticity: residual of dt over that of dt/2", 4.0,
                 residual[0] / residual[1], 0.2);
    expect_value("bounce, " + elasticity + " elasticity: residual of dt/2 over that of dt/4", 4.0,
                 residual[1] / residual[2], 0.2);
  }
}

} // namespace
} // namespace gcpdda::testing::loads_test
