#include "friction_variants.hpp"

#include "one_block.hpp"
#include "support/incline.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>

namespace gcpdda::study {

namespace {

using namespace testing;

constexpr double k_n = 1e9;
const double depth = 1.0 - std::sqrt(1.0 - 2.0 * rock_density * earth_gravity / k_n);

struct Named {
  std::string name;
  Variant variant;
};

/// A square at its depth on a plane, moving.
struct Moving {
  std::string name;
  RigidDof velocity;
  double friction_deg = 0.0;
  double damping_ratio = 0.0;
  double time_step = 0.0;
  int num_steps = 0;

  [[nodiscard]] OneBlockProblem problem() const {
    return {.block = rectangle({0.0, -depth}, {1.0, 1.0 - depth}),
            .support = rectangle({-3.0, -2.0}, {4.0, 0.0}),
            .velocity = velocity,
            .normal_stiffness = k_n,
            .tan_friction = std::tan(friction_deg * degree),
            .damping_ratio = damping_ratio,
            .time_step = time_step};
  }
};

/// Largest difference of the block's path from that of the program, over the largest motion.
double difference_from_program(const Moving &moving) {
  constexpr int num_steps = 2000;
  OneBlock block(moving.problem(), {});
  Simulation simulation(
      Communicator::self(),
      scene_of(head({.duration = num_steps * moving.time_step,
                     .time_step = moving.time_step,
                     .normal_stiffness = k_n,
                     .friction_deg = moving.friction_deg,
                     .damping = moving.damping_ratio,
                     .run_keys = "initial_friction = \"zero\""}) +
               block_toml("plane", moving.problem().support, "fixed = true") +
               block_toml("square", moving.problem().block,
                          fmt::format("velocity = [{:.17g}, {:.17g}, {:.17g}]", moving.velocity.u.x,
                                      moving.velocity.u.y, moving.velocity.r))));
  double motion = 0.0;
  double difference = 0.0;
  while (!simulation.finished()) {
    simulation.step();
    block.step();
    const RigidDof d = displacement_of(simulation, 1);
    const RigidDof off = block.displacement() - d;
    motion = std::max({motion, norm(d.u), std::abs(d.r)});
    difference = std::max({difference, norm(off.u), std::abs(off.r)});
  }
  return difference / motion;
}

/// Energy over that supplied by the velocity, step by step.
void energies(Table &table, const Moving &moving, const std::vector<Named> &variants) {
  std::cout << fmt::format("{}: the one-block code differs from the program by {:.1e} of the motion\n",
                           moving.name, difference_from_program(moving));
  for (const Named &named : variants) {
    OneBlock block(moving.problem(), named.variant);
    block.step();
    block.step(); // x_0 is not a trial configuration: the first pair is that of x*_1 and x*_2
    const RigidDof &v = moving.velocity;
    const double supplied = 0.5 * block.mass() * (dot(v.u, v.u) + v.r * v.r / 6.0);
    const double start = block.energy();
    constexpr int num_rows = 200;
    const int stride = std::max(1, moving.num_steps / 20000); // of looks at the energy
    double ratio = 1.0;
    double largest = 0.0;
    for (int row = 1; row <= num_rows; ++row) {
      double largest_of_row = 0.0;
      for (int i = 0; i < moving.num_steps / num_rows; ++i) {
        block.step();
        if (i % stride == 0) {
          ratio = 1.0 + (block.energy() - start) / supplied;
          largest_of_row = std::max(largest_of_row, ratio);
        }
      }
      table.add(
          {moving.name, named.name, std::int64_t{1} * row * (moving.num_steps / num_rows), largest_of_row});
      largest = std::max(largest, largest_of_row);
    }
    std::cout << fmt::format("{}, {}: energy after {} steps {:.4g} of that supplied, at most {:.4g}\n",
                             moving.name, named.name, moving.num_steps, ratio, largest);
  }
}

/// A square in the depth and tilt of steady sliding: error of its path.
void sliding(Table &table, const std::vector<Named> &variants) {
  const Incline incline;
  constexpr double dt = 2e-4;
  constexpr int num_steps = 5000;
  for (const Named &named : variants) {
    OneBlock block({.block = incline.sliding_square(),
                    .support = incline.plane(),
                    .normal_stiffness = incline.normal_stiffness,
                    .tan_friction = std::tan(incline.friction_deg * degree),
                    .damping_ratio = 0.05,
                    .time_step = dt,
                    .shear_at_start = -1e30},
                   named.variant);
    double error = 0.0;
    for (int i = 1; i <= num_steps; ++i) {
      block.step();
      const double exact = 0.5 * incline.acceleration() * (i * dt) * (i * dt);
      error = std::abs(dot(block.displacement().u, incline.downhill()) / exact - 1.0);
      if (i % 50 == 0) {
        table.add({"sliding", named.name, std::int64_t{i}, error});
      }
    }
    std::cout << fmt::format("sliding, {}: error of the path after 1 s {:.1e}\n", named.name, error);
  }
}

} // namespace

void friction_variants(const Options &options) {
  Table table(options.folder / "friction_variants.csv", {"problem", "variant", "step", "value"});
  energies(table,
           {.name = "sticking",
            .velocity = {{1e-3, 0.0}, 0.0},
            .friction_deg = 35.0,
            .time_step = 2e-4,
            .num_steps = options.quick ? 20000 : 100000},
           {{"trial configurations", {}}, {"velocities", {.slide = Slide::velocities}}});
  energies(table,
           {.name = "sheared and rocking",
            .velocity = {{0.02, 0.0}, 0.05},
            .friction_deg = 85.0,
            .time_step = 4e-5,
            .num_steps = options.quick ? 20000 : 100000},
           {{"longest", {}},
            {"current", {.length = SpringLength::current}},
            {"scaled", {.length = SpringLength::scaled}}});
  const std::vector<Named> dashpots{{"distributed", {}},
                                    {"piece normals", {.dashpot = Dashpot::piece_normals}},
                                    {"resultant", {.dashpot = Dashpot::resultant}}};
  energies(table,
           {.name = "rocking",
            .velocity = {{0.0, 0.0}, 1e-3},
            .damping_ratio = 0.05,
            .time_step = 1e-4,
            .num_steps = 4000},
           dashpots);
  sliding(table, dashpots);
}

} // namespace gcpdda::study
