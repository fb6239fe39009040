// Damping of deformable blocks takes energy in every step, whatever their stiffness, and brings them to rest.

#include "problem.hpp"

#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace gcpdda::testing::local_damping_test {
namespace {

constexpr double normal_stiffness = 1e9;

/// Rows of 3, 2 and 1 squares, each lying across two of the row below, that gravity acts on at once. Without
/// friction a row would part for good, so then it is a column.
std::string pile_toml(double youngs_modulus, double friction_deg, const std::string &run_keys,
                      const std::string &stage) {
  std::string toml = fmt::format(
      "[run]\ncontact_damping = 0.0\nfidelity = \"deformable\"\n{}\n[material.rock]\ndensity = 2600.0\n"
      "youngs_modulus = {}\npoissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = {}\n"
      "friction_angle_deg = {}\n[output]\ninterval = 1.0\n[[stage]]\nkind = \"settle\"\nlimit = 20.0\n{}\n",
      run_keys, youngs_modulus, normal_stiffness, friction_deg, stage);
  toml += block_toml("floor", rectangle({-1.0, -1.0}, {4.0, 0.0}), "fixed = true");
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < (friction_deg > 0.0 ? 3 - row : 1); ++k) {
      const double x = friction_deg > 0.0 ? k + 0.5 * row : 0.0;
      toml += block_toml(fmt::format("b{}_{}", row, k), rectangle({x, 1.0 * row}, {x + 1.0, row + 1.0}));
    }
  }
  return toml;
}

/// Force of local damping on a block and the way its trial configuration came.
struct Taken {
  Vec2 force;
  Mat2 on_gradient;
  Vec2 way;
  Mat2 stretched;
};
std::vector<Taken> taken_in_step(const BlockSystem &blocks) {
  std::vector<Taken> taken;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    taken.push_back({blocks.contact[row].damping.u, blocks.deformation_of(row).contact.damping,
                     blocks.motion[row].step, blocks.gradient_increment(row)});
  }
  return taken;
}

struct Works {
  double largest = -std::numeric_limits<double>::infinity(); ///< of a block in a step, over its round-off
  double sum = 0.0;                                          ///< J/m
  double time = 0.0;
};

/// Steps a scene to its verdict; nothing but local damping stands in the damping forces.
Works settle(Simulation &simulation) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  Works works;
  std::vector<Taken> before;
  while (!simulation.finished()) {
    step(simulation);
    if (simulation.fault()) {
      break;
    }
    const std::vector<Taken> now = taken_in_step(simulation.blocks());
    for (std::size_t row = 0; row < before.size(); ++row) {
      const Taken &d = before[row];
      const double work = 0.5 * (dot(d.force, d.way + now[row].way) +
                                 contract(d.on_gradient, d.stretched + now[row].stretched));
      // Ways are differences of u and of F, of size 1.
      const double rounding =
          8.0 * epsilon *
          (norm(d.force) * norm(simulation.blocks().displacement[row].u) + 2.0 * norm(d.on_gradient));
      works.largest = std::max(works.largest, work / (rounding + 1e-300));
      works.sum += work;
    }
    before = now;
  }
  works.time = simulation.time();
  return works;
}

TEST(LocalDamping, OfDeformableBlocksTakesEnergyInEveryStep) {
  for (const char *elasticity : {"implicit", "explicit"}) {
    for (const double youngs_modulus : {1e9, 1e10, 1e11, 1e12}) {
      for (const double share : {0.3, 0.6, 0.9}) {
        const double friction_deg = share == 0.6 ? 0.0 : 35.0;
        Simulation simulation(
            Communicator::self(),
            scene_of(pile_toml(youngs_modulus, friction_deg, fmt::format("elasticity = \"{}\"", elasticity),
                               fmt::format("local_damping = {}", share))));
        const Works works = settle(simulation);
        const std::string problem = fmt::format("pile, {} elasticity, E = {:g} Pa, damping {}, friction {}",
                                                elasticity, youngs_modulus, share, friction_deg);
        EXPECT_FALSE(simulation.fault()) << problem;
        EXPECT_EQ(simulation.stage().verdict, Verdict::settled) << problem;
        expect_below(problem + ": largest work of a step over round-off", 1.0, works.largest);
        EXPECT_LT(works.sum, 0.0) << problem;
      }
    }
  }
}

double damping_work(const BlockSystem &blocks) {
  double sum = 0.0;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    sum += blocks.ledger[row].damping;
  }
  return sum;
}

// Every stop takes energy; nothing else stands in the work of damping.
TEST(KineticDamping, OfDeformableBlocksTakesEnergyAtEveryStop) {
  for (const char *elasticity : {"implicit", "explicit"}) {
    for (const double youngs_modulus : {1e9, 1e10, 1e11, 1e12}) {
      for (const double friction_deg : {0.0, 35.0}) {
        Simulation simulation(
            Communicator::self(),
            scene_of(pile_toml(youngs_modulus, friction_deg, fmt::format("elasticity = \"{}\"", elasticity),
                               "kinetic_damping = true")));
        const std::string problem =
            fmt::format("pile, {} elasticity, E = {:g} Pa, kinetic damping, friction {}", elasticity,
                        youngs_modulus, friction_deg);
        double before = 0.0;
        double largest = -std::numeric_limits<double>::infinity();
        int stops = 0;
        while (!simulation.finished() && !simulation.fault()) {
          step(simulation);
          const double work = damping_work(simulation.blocks());
          if (work != before) {
            largest = std::max(largest, work - before);
            ++stops;
          }
          before = work;
        }
        EXPECT_FALSE(simulation.fault()) << problem;
        EXPECT_EQ(simulation.stage().verdict, Verdict::settled) << problem;
        EXPECT_GT(stops, 3) << problem;
        expect_below(problem + ": largest work of a stop, J/m", 0.0, largest);
      }
    }
  }
}

} // namespace
} // namespace gcpdda::testing::local_damping_test
