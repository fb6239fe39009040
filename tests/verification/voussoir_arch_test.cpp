// C11: collapse of a semicircular arch of n voussoirs by limit analysis (Heyman, 1966,
// doi:10.1016/0020-7683(66)90018-7): no tension, no crushing, no sliding.
//
// With the force (F_x, F_y) and moment M that the ground gives the first joint, equilibrium of the voussoirs
// up to joint k gives its force, F_k = F_0 + sum of weights, and moment M_k about its middle, both linear in
// the three unknowns. The arch stands if some choice of them keeps the thrust inside all joints, |M_k| <= N_k
// t/2. The largest horizontal load, lambda times the weight, follows from a linear programme with lambda as
// fourth unknown: at the best of the corners of what is allowed, four of the 2 (n + 1) conditions are
// equalities, the four hinges of the mechanism. All choices of four are tried. Gravity tilted by atan(lambda)
// is that load. The least thickness under the weight alone, about 0.107 of the mean radius for many voussoirs
// (Milankovitch, 1907), is that at which the largest N t/2 - |M| that all joints can have, as fourth unknown,
// is zero: five hinges.
//
// Joints that give way: one turned by psi and closed over the depth a bears N = k_n psi a^2/2 at a/3 from its
// edge, so hinges lie inside by sqrt(2 N/(k_n psi))/3, while the arch changes its shape by psi. Both take
// from what the arch bears; the sum is least at psi of the order (N/(k_n t))^(1/3), and it is of that order,
// too. Hence an arch below the limit by 8 (N/(k_n t))^(1/3), N half the weight, must come to rest, measured:
// by 5 to 8 times; one 2 % beyond the limit must fall whatever its joints.

#include "problem.hpp"
#include "semicircular_arch.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gcpdda::testing::voussoir_arch_test {
namespace {

constexpr double radius = SemicircularArch::radius;
constexpr double ramp = 0.5;     ///< s
constexpr double at_rest = 1e-5; ///< m/s; what falls has 0.1 m/s soon

using Arch = SemicircularArch;

/// Largest of four unknowns' last one under conditions row.x + constant >= 0, by trying all corners.
double largest_last(const Eigen::MatrixXd &rows, const Eigen::VectorXd &constants) {
  const Eigen::Index n = rows.rows();
  const double slack = 1e-9 * rows.cwiseAbs().maxCoeff();
  double best = -1e300;
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = a + 1; b < n; ++b) {
      for (Eigen::Index c = b + 1; c < n; ++c) {
        for (Eigen::Index d = c + 1; d < n; ++d) {
          Eigen::Matrix4d corner;
          corner << rows.row(a), rows.row(b), rows.row(c), rows.row(d);
          const Eigen::Vector4d right{-constants(a), -constants(b), -constants(c), -constants(d)};
          const Eigen::FullPivLU<Eigen::Matrix4d> solver(corner);
          if (!solver.isInvertible()) {
            continue;
          }
          const Eigen::Vector4d x = solver.solve(right);
          if (x(3) > best && (rows * x + constants).minCoeff() >= -slack) {
            best = x(3);
          }
        }
      }
    }
  }
  return best;
}

enum class Last { horizontal_load, slack };

/// Limit analysis with forces over the weight of the arch.
/// @return lambda, or the largest common N t/2 - |M| of the joints
double limit_of(const Arch &arch, Last last) {
  double total = 0.0;
  for (int k = 0; k < arch.num_voussoirs; ++k) {
    total += polygon_moments(arch.voussoir(k)).area;
  }
  const int joints = arch.num_voussoirs + 1;
  Eigen::MatrixXd rows(2 * joints, 4); // F_0, M_0 and the last one
  Eigen::VectorXd constants(2 * joints);
  double weight = 0.0; // of the voussoirs before the joint
  Vec2 first{};        // and its first moments
  for (int k = 0; k < joints; ++k) {
    const Vec2 middle = arch.joint(k, radius);
    const Vec2 arm = arch.joint(0, radius) - middle;
    const Vec2 forward = perp(arch.joint(k, 1.0));
    const Vec2 about = first - weight * middle;
    Eigen::RowVector4d normal{forward.x, forward.y, 0.0, 0.0};
    Eigen::RowVector4d moment{-arm.y, arm.x, 1.0, 0.0}; // arm x F_0 + M_0
    if (last == Last::horizontal_load) {
      normal(3) = weight * forward.x;
      moment(3) = -about.y;
    }
    const double normal_of_weight = -weight * forward.y;
    const double moment_of_weight = -about.x;
    for (const int side : {0, 1}) {
      const double sign = side == 0 ? 1.0 : -1.0;
      rows.row(2 * k + side) = 0.5 * arch.thickness * normal + sign * moment;
      constants(2 * k + side) = 0.5 * arch.thickness * normal_of_weight + sign * moment_of_weight;
      if (last == Last::slack) {
        rows(2 * k + side, 3) = -1.0;
      }
    }
    if (k < arch.num_voussoirs) {
      const Moments moments = polygon_moments(arch.voussoir(k));
      weight += moments.area / total;
      first += (moments.area / total) * moments.centroid;
    }
  }
  return largest_last(rows, constants);
}

double least_thickness(int num_voussoirs) {
  double low = 0.02 * radius;
  double high = 0.3 * radius;
  while (high - low > 1e-4 * radius) {
    const double middle = 0.5 * (low + high);
    (limit_of({num_voussoirs, middle}, Last::slack) < 0.0 ? low : high) = middle;
  }
  return high;
}

struct Rock {
  double normal_stiffness = 1e11; ///< Pa/m
  double youngs_modulus = 0.0;    ///< 0: rigid
};

struct Rest {
  bool stands = false;
  double moved = 0.0; ///< largest displacement over the thickness, looked at up to 0.1
};

/// Gravity rises slowly, tilted by atan(lambda), until the arch has come to rest or falls.
Rest loaded(const Arch &arch, double lambda, const Rock &rock) {
  const double share = 1.0 / std::hypot(1.0, lambda);
  std::string toml = head({.duration = 6.0,
                           .gravity = {lambda * share * earth_gravity, -share * earth_gravity},
                           .normal_stiffness = rock.normal_stiffness,
                           .friction_deg = 70.0,
                           .run_keys = "local_damping = 0.8\ngravity_ramp = " + std::to_string(ramp) + "\n",
                           .fidelity = rock.youngs_modulus > 0.0 ? "deformable" : "rigid",
                           .youngs_modulus = rock.youngs_modulus,
                           .poissons_ratio = 0.2});
  toml += block_toml("ground", rectangle({-2.0 * radius, -2.0}, {2.0 * radius, 0.0}), "fixed = true");
  for (int k = 0; k < arch.num_voussoirs; ++k) {
    toml += block_toml(fmt::format("voussoir{}", k), arch.voussoir(k));
  }
  Simulation simulation(Communicator::self(), scene_of(toml));
  Rest rest;
  while (!simulation.finished() && !rest.stands && rest.moved < 0.1) {
    run_until(simulation, simulation.time() + 0.02);
    double fastest = 0.0;
    for (int k = 1; k <= arch.num_voussoirs; ++k) {
      rest.moved = std::max(rest.moved, norm(displacement_of(simulation, k).u) / arch.thickness);
      fastest = std::max(fastest, norm(velocity_of(simulation, k).u));
    }
    rest.stands = simulation.time() > ramp && fastest < at_rest;
  }
  return rest;
}

/// Stands with a little less than the limit and falls with a little more.
void expect_limit(const std::string &name, const Rest &within, const Rest &beyond) {
  EXPECT_TRUE(within.stands) << name;
  expect_below(name + " within the limit: displacement over the thickness", 0.01, within.moved);
  EXPECT_FALSE(beyond.stands) << name;
  expect_above(name + " beyond the limit: displacement over the thickness", 0.1, beyond.moved);
}

/// Share of the limit that joints take, see above; N over t is that of the middle line.
double margin(const Rock &rock) {
  return 8.0 *
         std::cbrt(0.5 * std::numbers::pi * radius * rock_density * earth_gravity / rock.normal_stiffness);
}

std::string name_of(int num_voussoirs, const Rock &rock) {
  return fmt::format("C11 arch of {} voussoirs, k_n = {:g} Pa/m, {}", num_voussoirs, rock.normal_stiffness,
                     rock.youngs_modulus > 0.0 ? fmt::format("deformable, E = {:g} Pa", rock.youngs_modulus)
                                               : "rigid");
}

constexpr Rock stiff{1e12};
constexpr Rock usual{1e11};
constexpr Rock deformable{1e11, 3e10};

TEST(VoussoirArch, StandsUnderItsWeightFromTheLeastThicknessOn) {
  // Few voussoirs have no joint just where a thin arch would open.
  EXPECT_NEAR(least_thickness(15) / radius, 0.1075, 0.002);
  for (const int num_voussoirs : {9, 12}) {
    const std::vector<Rock> rocks =
        num_voussoirs == 9 ? std::vector{usual, stiff, deformable} : std::vector{usual};
    const double least = least_thickness(num_voussoirs);
    for (const Rock &rock : rocks) {
      expect_limit(name_of(num_voussoirs, rock) + fmt::format(", thickness {:.3f} R +{:.1f}/-2 %,",
                                                              least / radius, 100.0 * margin(rock)),
                   loaded({num_voussoirs, (1.0 + margin(rock)) * least}, 0.0, rock),
                   loaded({num_voussoirs, 0.98 * least}, 0.0, rock));
    }
  }
}

TEST(VoussoirArch, BearsTheHorizontalLoadOfItsMechanism) {
  for (const int num_voussoirs : {9, 12}) {
    const std::vector<Rock> rocks =
        num_voussoirs == 9 ? std::vector{usual, stiff, deformable} : std::vector{usual};
    const double thickness = 0.2 * radius;
    const double limit = limit_of({num_voussoirs, thickness}, Last::horizontal_load);
    for (const Rock &rock : rocks) {
      expect_limit(name_of(num_voussoirs, rock) +
                       fmt::format(", horizontal load {:.3f} of the weight -{:.1f}/+2 %,", limit,
                                   100.0 * margin(rock)),
                   loaded({num_voussoirs, thickness}, (1.0 - margin(rock)) * limit, rock),
                   loaded({num_voussoirs, thickness}, 1.02 * limit, rock));
    }
  }
}

} // namespace
} // namespace gcpdda::testing::voussoir_arch_test
