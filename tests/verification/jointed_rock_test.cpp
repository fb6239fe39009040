// Jointed rock whose joints stick under load: a small motion about equilibrium does not grow. The eigenvalues
// of the tangent (support/base_state.hpp) and runs without damping say so.

#include "problem.hpp"

#include "blockgen/region_cutter.hpp"
#include "dynamics/deformable.hpp"
#include "support/base_state.hpp"
#include "support/contact_regions.hpp"
#include "support/eigenvalues.hpp"
#include "support/shapes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>

namespace gcpdda::testing::jointed_rock_test {
namespace {

constexpr double k_n = 1e10; ///< Pa/m
constexpr double size = 1.0; ///< of a block, m
constexpr double use = 0.95; ///< largest T/N over tan phi

/// Rock 3.5 m by 2.5 m in a fixed frame, cut at random, under in-situ stress.
struct Rock {
  std::string cuts;
  double min_width = 0.02;  ///< m; thinner pieces join a neighbour, which may make it re-entrant
  double softness = 1.0;    ///< k_n L/E
  double compression = 0.0; ///< larger principal stress, Pa
  double ratio = 0.0;       ///< smaller over larger one
  double angle = 0.0;       ///< of the larger one, degrees

  static Rock random(unsigned seed) {
    std::mt19937 engine(seed);
    const auto draw = [&](double low, double high) { return uniform(engine, low, high); };
    Rock rock;
    rock.softness = std::pow(10.0, draw(-3.0, 3.0));
    rock.compression = k_n * size * std::pow(10.0, draw(-6.0, -5.0));
    rock.ratio = draw(0.2, 0.5);
    rock.angle = draw(0.0, 180.0);
    if (seed % 2 == 0) {
      rock.min_width = seed % 4 == 0 ? 0.15 : rock.min_width;
      rock.cuts = fmt::format("[[voronoi]]\nsize = {}\nirregularity = 0.8\nseed = {}\n", size, seed);
      return rock;
    }
    const double dip = draw(-90.0, 90.0);
    for (const double own : {dip, dip + draw(50.0, 130.0)}) {
      rock.cuts +=
          fmt::format("[[joint_set]]\ndip_deg = {}\nspacing = {}\norigin = [{}, {}]\n",
                      own > 90.0 ? own - 180.0 : own, size * draw(0.8, 1.2), draw(0.0, 1.0), draw(0.0, 1.0));
    }
    return rock;
  }

  [[nodiscard]] Scene scene(double friction_deg) const {
    Scene scene = scene_of(
        head({.gravity = {},
              .normal_stiffness = k_n,
              .friction_deg = friction_deg,
              .damping = 0.0,
              .fidelity = "deformable",
              .youngs_modulus = k_n * size / softness,
              .poissons_ratio = 0.25}) +
        fmt::format("[region]\nmaterial = \"rock\"\npolygon = [[0, 0], [3.5, 0], [3.5, 2.5], [0, 2.5]]\n"
                    "fixed = [\"bottom\", \"left\", \"right\", \"top\"]\nmin_width = {}\n{}"
                    "[in_situ]\nprincipal_stresses = [{}, {}]\nprincipal_angle_deg = {}\n",
                    min_width, cuts, compression, ratio * compression, angle));
    scene.region_blocks = std::make_shared<RegionCutter>(scene, 1);
    return scene;
  }
  /// With which the most loaded joint has T/N = use tan phi.
  [[nodiscard]] double friction_deg() const {
    Simulation simulation(Communicator::self(), scene(89.0));
    double largest = 0.0;
    for (const RegionForce &region : regions_of(simulation)) {
      largest = std::max(largest, std::abs(region.shear) / region.normal_force);
    }
    return std::atan(largest / use) / degree;
  }
};

/// Overlap of the thinnest contact. Corners that just touch, by rounding, are none.
double thinnest(const std::vector<RegionForce> &regions) {
  double deepest = 0.0;
  for (const RegionForce &region : regions) {
    deepest = std::max(deepest, region.overlap);
  }
  double least = deepest;
  for (const RegionForce &region : regions) {
    least = region.overlap > 1e-3 * deepest ? std::min(least, region.overlap) : least;
  }
  return least;
}

double kinetic_energy_of(const BlockSystem &blocks) {
  double energy = 0.0;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const Deformation &d = blocks.deformation_of(row);
    energy += 0.5 * blocks.properties[row].mass * dot(blocks.velocity[row].u, blocks.velocity[row].u) +
              kinetic_energy(d, d.rate);
  }
  return energy;
}

/// Largest value in the last fifth of a series over that in the first fifth.
template <class Next> double growth_of(int count, Next &&next) {
  double first = 0.0;
  double last = 0.0;
  for (int i = 0; i < count; ++i) {
    const double value = next();
    first = i < count / 5 ? std::max(first, value) : first;
    last = i >= 4 * count / 5 ? std::max(last, value) : last;
  }
  return last / first;
}

// What sets blocks moving is the small part of the stress that the ends of joints do not bear
// (contact/in_situ.hpp). It spreads over the modes, which beat: that changes the largest kinetic energy of a
// fifth of the run by less than a factor of two. Flutter multiplied it by 5e7.
TEST(JointedRock, RestsWhateverItsStiffnessAndTheUseOfFriction) {
  double worst_growth = 0.0;
  std::ptrdiff_t num_re_entrant = 0;
  double worst_run = 0.0;
  const unsigned num_masses = full_size() ? 100 : 20;
  for (unsigned seed = 1; seed <= num_masses; ++seed) {
    const Rock rock = Rock::random(seed);
    Simulation simulation(Communicator::self(), rock.scene(rock.friction_deg()));
    EXPECT_GE(simulation.blocks().num_owned, 6U);
    num_re_entrant += std::ranges::count_if(simulation.blocks().properties,
                                            [](const BlockProperties &block) { return !block.is_convex; });
    BaseState state(simulation);
    const Eigen::MatrixXd contacts = state.contact_stiffness(3e-3 * thinnest(regions_of(simulation)));
    const double growth = growth_rate(contacts + state.elastic_stiffness());
    const double run = growth_of(4000, [&] {
      step(simulation);
      return kinetic_energy_of(simulation.blocks());
    });
    EXPECT_FALSE(simulation.fault().has_value());
    EXPECT_LE(run, 2.0) << "seed " << seed;
    worst_growth = std::max(worst_growth, growth / simulation.bound().omega_max);
    worst_run = std::max(worst_run, run);
  }
  EXPECT_GT(num_re_entrant, 0);
  const std::string masses = fmt::format("C12 {} jointed rock masses: ", num_masses);
  expect_below(masses + "largest growth rate of a mode over omega_max", 1e-7, worst_growth);
  expect_below(masses + "kinetic energy at the end of a run over that at its start", 2.0, worst_run);
}

/// A deformable block 2 m by 1 m on another one, which lies on a fixed floor: closed from its left end over
/// the share `closed` of its length, born so, and sheared by T.
struct GapingJoint {
  double youngs_modulus = 1e9;
  double closed = 0.5;
  double shear_ratio = 0.5; ///< T/N

  [[nodiscard]] BaseState state() const {
    constexpr double depth = 1e-5;
    const double tilt = depth / (2.0 * closed);
    BlockSystem system;
    Material rock;
    rock.density = rock_density;
    rock.youngs_modulus = youngs_modulus;
    rock.poissons_ratio = 0.2;
    const std::array<std::vector<Vec2>, 3> shapes{
        rectangle({-1.0, -1.0}, {1.0, 0.0}), placed(rectangle({0.0, 0.0}, {2.0, 1.0}), tilt, {-1.0, -depth}),
        rectangle({-2.0, -2.0}, {2.0, -1.0 + depth})};
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      SceneBlock block;
      block.vertices = shapes[k];
      block.fixed = k == 2;
      append_block(system, BlockId{static_cast<std::int64_t>(k)}, block, rock,
                   block.fixed ? BlockKind::fixed : BlockKind::deformable);
    }
    system.num_owned = 2;
    system.num_fixed = 1;
    pose(system, 0, system.num_rows());
    JointLaw law;
    law.normal_stiffness = k_n;
    law.tan_friction = 2.0;
    BaseState state(std::move(system), {{{law}, {0}, 1}, 0.0, PotentialKind::exact, 0.0}, PairPath::plain);
    double carried = 0.0;
    state.change_memory([&](const RegionForce &region, RegionState &memory) {
      carried = carried == 0.0 ? shear_ratio * region.normal_force : carried; // through both joints
      memory.shear = std::clamp(carried, -region.normal_force, region.normal_force);
    });
    return state;
  }
};

// A joint that is as long as it has ever been stands on an edge of the rules by which friction remembers: it
// has one tangent for longer and another one for shorter, and with the mean of both some of these states
// would grow by 126/s. Runs from many small disturbances decide; they last 0.7 to 1.7 s.
TEST(JointedRock, JointsBornGapingRestToo) {
  double worst = 0.0;
  std::mt19937 engine(1);
  for (const double youngs_modulus : {1e9, 5e9, 2e10}) {
    for (const double closed : {0.3, 0.5, 0.8}) {
      for (const double shear_ratio : {-1.0, -0.5, 0.5, 1.0}) {
        const GapingJoint joint{youngs_modulus, closed, shear_ratio};
        const Eigen::MatrixXd k = [&] {
          BaseState state = joint.state();
          return Eigen::MatrixXd(state.contact_stiffness(1e-8) + state.elastic_stiffness());
        }();
        const double time_step = 0.8 / std::sqrt(eigenvalues(k).cwiseAbs().maxCoeff());
        for (const double disturbance : {1e-8, 1e-7}) { // m, in the first step; the overlap is 1e-5 m
          BaseState state = joint.state();
          Eigen::VectorXd velocity(state.num_unknowns());
          for (Eigen::Index i = 0; i < velocity.size(); ++i) {
            velocity(i) =
                std::sqrt(2.0 * rock_density) * disturbance / time_step * uniform(engine, -0.5, 0.5);
          }
          Swing swing(state, time_step, velocity);
          const double run = growth_of(10000, [&] {
            swing.step();
            return swing.kinetic_energy();
          });
          worst = std::max(worst, run);
        }
      }
    }
  }
  expect_below("C12 72 disturbed joints that gape: kinetic energy at the end of a run over that at its start",
               2.0, worst);
}

} // namespace
} // namespace gcpdda::testing::jointed_rock_test
