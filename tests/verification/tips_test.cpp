// B8: collisions that other contact laws cannot decide: vertex on vertex, needle tips, edges in one line.

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::tips_test {
namespace {

/// A needle of unit length with a tip of `angle` degrees at the origin, pointing to -x.
std::vector<Vec2> needle(double angle) {
  const double half = std::tan(0.5 * angle * degree);
  return {{0.0, 0.0}, {1.0, -half}, {1.0, half}};
}

std::vector<Vec2> mirrored(const std::vector<Vec2> &points) {
  std::vector<Vec2> out;
  for (const Vec2 p : points) {
    out.insert(out.begin(), {-p.x, p.y});
  }
  return out;
}

struct Outcome {
  bool finite = true;
  double momentum = 0.0;    ///< change of linear momentum over sum of m |v|
  double jump = 0.0;        ///< largest change of force in one step over the largest force
  double max_force = 0.0;   ///< N/m
  double energy = 0.0;      ///< final kinetic energy over the initial one
  double max_overlap = 0.0; ///< m
};

double kinetic(const Simulation &simulation) {
  double sum = 0.0;
  for (std::size_t row = 0; row < simulation.blocks().num_owned; ++row) {
    const BlockProperties &p = simulation.blocks().properties[row];
    const RigidDof &v = simulation.blocks().velocity[row];
    sum += 0.5 * (p.mass * dot(v.u, v.u) + p.inertia * v.r * v.r);
  }
  return sum;
}

Outcome collide(const std::string &toml) {
  Simulation simulation(Communicator::self(), scene_of(toml));
  const BlockSystem &blocks = simulation.blocks();
  const auto momentum = [&] {
    Vec2 sum;
    for (std::size_t row = 0; row < blocks.num_owned; ++row) {
      sum += blocks.properties[row].mass * blocks.velocity[row].u;
    }
    return sum;
  };
  double scale = 0.0;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    scale += blocks.properties[row].mass * norm(blocks.velocity[row].u);
  }
  const Vec2 before = momentum();
  const double energy = kinetic(simulation);
  Outcome out;
  Vec2 last;
  double jump = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    const Vec2 force = simulation.blocks().contact[0].force.u;
    jump = std::max(jump, norm(force - last));
    last = force;
    out.max_force = std::max(out.max_force, norm(force));
    out.momentum = std::max(out.momentum, norm(momentum() - before) / scale);
    out.finite =
        out.finite && std::isfinite(force.x) && std::isfinite(force.y) && std::isfinite(momentum().x);
  }
  EXPECT_FALSE(simulation.fault().has_value());
  out.jump = jump / out.max_force;
  out.energy = kinetic(simulation) / energy;
  out.max_overlap = simulation.counters().max_overlap;
  return out;
}

/// Two copies of a shape, tips `gap` apart, fly at each other at 0.1 m/s each. Needles that meet head on and
/// keep their line part after 0.21 s.
Outcome tip_to_tip(const std::vector<Vec2> &shape, double offset, double tilt, double friction) {
  constexpr double gap = 0.001;
  return collide(
      head({.duration = 0.25, .time_step = 2e-6, .gravity = {}, .friction_deg = friction, .damping = 0.0}) +
      block_toml("right", placed(shape, tilt, {0.5 * gap, offset}), "velocity = [-0.1, 0.0, 0.0]") +
      block_toml("left", placed(mirrored(shape), 0.0, {-0.5 * gap, 0.0}), "velocity = [0.1, 0.0, 0.0]"));
}

// The force starts from zero and follows the overlap: at this dt the largest change in a step is a small
// share of the peak. Momentum: round-off. Energy: kept without friction, never gained with it.
void check(const std::string &problem, const Outcome &out, double friction) {
  EXPECT_TRUE(out.finite) << problem;
  EXPECT_GT(out.max_force, 0.0) << problem;
  expect_below(problem + ": change of linear momentum", 1e-13, out.momentum);
  expect_below(problem + ": largest jump of force in a step over its peak", 0.05, out.jump);
  if (friction > 0.0) {
    expect_below(problem + ": kinetic energy after over before", 1.0 + 1e-4, out.energy);
  } else {
    expect_value(problem + ": kinetic energy after over before", 1.0, out.energy, 1e-4);
  }
}

TEST(Tips, SquaresMeetVertexOnVertex) {
  const std::vector<Vec2> square{{0.0, 0.0}, {0.5, -0.5}, {1.0, 0.0}, {0.5, 0.5}};
  for (const double friction : {0.0, 30.0}) {
    for (const double offset : {0.0, 1e-9, 1e-4}) {
      check(fmt::format("B8 squares vertex on vertex, {} m off, friction {}", offset, friction),
            tip_to_tip(square, offset, 0.0, friction), friction);
    }
  }
}

TEST(Tips, NeedlesOfFiveDegrees) {
  for (const double friction : {0.0, 30.0}) {
    for (const double offset : {0.0, 1e-9, 1e-5}) {
      check(fmt::format("B8 needle tips, {} m off, friction {}", offset, friction),
            tip_to_tip(needle(5.0), offset, 0.0, friction), friction);
    }
    check(fmt::format("B8 needle tips, tilted 10 degrees, friction {}", friction),
          tip_to_tip(needle(5.0), 0.0, 10.0 * degree, friction), friction);
  }
}

// A right-angled tip flies into the bottom of a notch of 100 degrees.
TEST(Tips, VertexMeetsReentrantCorner) {
  const std::vector<Vec2> square{{0.0, 0.0}, {0.5, -0.5}, {1.0, 0.0}, {0.5, 0.5}};
  const double lip = 0.8 * std::tan(50.0 * degree);
  const std::vector<Vec2> notched{{-1.5, -lip}, {0.8, -lip}, {0.0, 0.0}, {0.8, lip}, {-1.5, lip}};
  for (const double friction : {0.0, 30.0}) {
    for (const double offset : {0.0, 1e-9, 1e-4}) {
      check(fmt::format("B8 vertex into a re-entrant corner, {} m off, friction {}", offset, friction),
            collide(head({.duration = 0.2,
                          .time_step = 2e-6,
                          .gravity = {},
                          .friction_deg = friction,
                          .damping = 0.0}) +
                    block_toml("tip", placed(square, 0.0, {0.001, offset}), "velocity = [-0.1, 0.0, 0.0]") +
                    block_toml("notch", notched, "velocity = [0.1, 0.0, 0.0]")),
            friction);
    }
  }
}

// Faces in one line and a corner on a corner: two squares laid on each other with their sides flush, and one
// landing on the joint of two.
TEST(Tips, EdgesInOneLine) {
  const std::string start = head({.duration = 0.5, .time_step = 5e-5, .friction_deg = 30.0});
  const std::string floor = block_toml("floor", rectangle({-3.0, -2.0}, {3.0, 0.0}), "fixed = true");
  for (const double shift : {0.0, 0.5, 1.0}) {
    Simulation simulation(Communicator::self(),
                          scene_of(start + floor + block_toml("left", rectangle({-1.0, 0.0}, {0.0, 1.0})) +
                                   block_toml("right", rectangle({0.0, 0.0}, {1.0, 1.0})) +
                                   block_toml("top", rectangle({shift - 1.0, 1.0}, {shift, 2.0}))));
    run(simulation);
    double largest = 0.0;
    for (const RigidDof &d : simulation.blocks().displacement) {
      EXPECT_TRUE(std::isfinite(d.u.x) && std::isfinite(d.u.y) && std::isfinite(d.r));
      largest = std::max({largest, norm(d.u), std::abs(d.r)});
    }
    // Twice the closure of the joints below: 5.1e-5 m and 2.6e-5 m.
    expect_below(fmt::format("B8 three squares flush, the upper one shifted by {}: motion, m", shift), 2e-4,
                 largest);
  }
}

} // namespace
} // namespace gcpdda::testing::tips_test
