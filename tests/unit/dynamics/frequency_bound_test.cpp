#include "dynamics/frequency_bound.hpp"

#include "dynamics/deformable.hpp"
#include "dynamics/integrate.hpp"
#include "support/blocks.hpp"
#include "support/eigenvalues.hpp"
#include "support/scenes.hpp"

#include <Eigen/Core>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gcpdda::frequency_bound_test {
namespace {

using namespace testing;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double normal_stiffness = 3e6;
constexpr double tangential_stiffness = 1e6;
constexpr double density = 2000.0;

Eigen::Vector3d mass_of(const BlockProperties &p) {
  return {p.mass, p.mass, p.inertia};
}

/// Row of T^T: generalised force of a unit traction along d at offset r from the centroid.
Eigen::Vector3d generalised(Vec2 r, Vec2 d) {
  return {d.x, d.y, cross(r, d)};
}

// Rotation: 4 edges with int s^2 ds = L^3/12 and arm L/2: K33 = (k_n/3 + k_t) L^3, M33 = m L^2/6.
// Translation: K11 = 2 L (k_n + k_t). Twice the larger of both ratios.
TEST(FrequencyBound, OfASquare) {
  for (const double length : {0.1, 1.0, 7.0}) {
    for (const double ratio : {0.0, 0.2, 0.5, 1.0}) {
      const BlockSystem system =
          system_of({rectangle({3.0, 4.0}, {3.0 + length, 4.0 + length})}, {}, density);
      const double k_t = ratio * normal_stiffness;
      const double mass = density * length * length;
      const double exact =
          2.0 * length / mass * std::max(2.0 * (normal_stiffness + k_t), 2.0 * normal_stiffness + 6.0 * k_t);
      // Vertices near 4 give a side of 0.1 to 40 epsilon.
      EXPECT_NEAR(contact_frequency_bound(system, 0, normal_stiffness, k_t), exact, 1e-13 * exact);
    }
  }
}

// K by a midpoint rule of 1000 points an edge (error 1e-6/12 of the quadratic part) and a general
// eigensolver.
TEST(FrequencyBound, AgreesWithAnIntegratedStiffness) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    const std::vector<Vec2> polygon = random_polygon(seed, 3 + static_cast<int>(seed % 7), 1.3, {-2.0, 5.0});
    const BlockSystem system = system_of({polygon}, {}, density);
    const Vec2 c = system.properties[0].centroid;
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    constexpr int points = 1000;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec2 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
      const double length = norm(edge);
      const Vec2 t = (1.0 / length) * edge;
      for (int i = 0; i < points; ++i) {
        const Vec2 r = polygon[k] + ((i + 0.5) / points) * edge - c;
        const Eigen::Vector3d b_n = generalised(r, {t.y, -t.x});
        const Eigen::Vector3d b_t = generalised(r, t);
        stiffness +=
            length / points *
            (normal_stiffness * b_n * b_n.transpose() + tangential_stiffness * b_t * b_t.transpose());
      }
    }
    const double exact = 2.0 * squared_frequencies(stiffness, mass_of(system.properties[0])).maxCoeff();
    EXPECT_NEAR(contact_frequency_bound(system, 0, normal_stiffness, tangential_stiffness), exact,
                1e-6 * exact);
  }
}

double bound_of(const BlockSystem &system, double k_t) {
  return std::max(contact_frequency_bound(system, 0, normal_stiffness, k_t),
                  contact_frequency_bound(system, 1, normal_stiffness, k_t));
}

double largest_frequency(const BlockSystem &system, const Matrix6 &stiffness) {
  Eigen::Matrix<double, 6, 1> mass;
  mass << mass_of(system.properties[0]), mass_of(system.properties[1]);
  const Matrix6 symmetric = 0.5 * (stiffness + stiffness.transpose());
  return squared_frequencies(symmetric, mass).maxCoeff();
}

// Two random blocks glued along the whole of an edge each shares: springs k_n and k_t on that edge.
TEST(FrequencyBound, BoundsAPairWithAFlushJoint) {
  double sharpest = 0.0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::vector<Vec2> a = random_polygon(seed, 3 + static_cast<int>(seed % 5), 1.0, {});
    std::vector<Vec2> b = random_polygon(seed + 1000, 3 + static_cast<int>(seed % 4), 0.2 + 0.01 * seed, {});
    // Place b so that the middle of its first edge meets the middle of a's first edge, face on face.
    const Vec2 edge_a = a[1] - a[0];
    const Vec2 edge_b = b[1] - b[0];
    const double turn = std::atan2(-edge_a.y, -edge_a.x) - std::atan2(edge_b.y, edge_b.x);
    const Vec2 middle = 0.5 * (a[0] + a[1]);
    b = placed(b, turn, middle - Rotation::of(turn)(0.5 * (b[0] + b[1])));
    const BlockSystem system = system_of({a, b}, {}, density);
    const double length = std::min(norm(edge_a), norm(edge_b));
    const Vec2 t = (1.0 / norm(edge_a)) * edge_a;
    Matrix6 stiffness = Matrix6::Zero();
    for (const double gauss : {-1.0, 1.0}) { // two points integrate a quadratic exactly
      const Vec2 x = middle + (gauss * length / std::sqrt(12.0)) * t;
      for (const bool normal : {true, false}) {
        Eigen::Matrix<double, 6, 1> row;
        const Vec2 d = normal ? perp(t) : t;
        row << generalised(x - system.properties[0].centroid, d),
            -generalised(x - system.properties[1].centroid, d);
        stiffness +=
            0.5 * length * (normal ? normal_stiffness : tangential_stiffness) * row * row.transpose();
      }
    }
    const double share = largest_frequency(system, stiffness) / bound_of(system, tangential_stiffness);
    EXPECT_LE(share, 1.0) << seed;
    sharpest = std::max(sharpest, share);
  }
  EXPECT_GT(sharpest, 0.2) << "a bound that is far from sharp costs steps";
}

// The stiffness that the contact itself has, overlap and all: slopes of the product's forces.
TEST(FrequencyBound, BoundsTheContactsOwnStiffness) {
  std::mt19937 engine(41);
  double sharpest = 0.0;
  int touching = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const auto seed = static_cast<unsigned>(engine());
    ContactBench bench(system_of({random_polygon(seed, 3 + static_cast<int>(seed % 6), 1.0, {}),
                                  random_polygon(seed + 1, 3 + static_cast<int>(seed % 5), 1.0,
                                                 {uniform(engine, 1.3, 1.9), uniform(engine, -0.2, 0.2)})},
                                 {}, density),
                       one_law(normal_stiffness));
    if (!bench.evaluate().touching) {
      continue;
    }
    ++touching;
    Matrix6 stiffness;
    constexpr double h = 1e-6; // slopes to about 1e-9 of k_n
    const auto forces = [&] {
      bench.evaluate();
      Eigen::Matrix<double, 6, 1> f;
      for (std::size_t row = 0; row < 2; ++row) {
        const RigidDof sum = bench.regions.sum_contacts(bench.candidates, row).force;
        f.segment<3>(static_cast<Eigen::Index>(3 * row)) << sum.u.x, sum.u.y, sum.r;
      }
      return f;
    };
    for (Eigen::Index k = 0; k < 6; ++k) {
      RigidDof &dof = bench.system.trial[static_cast<std::size_t>(k / 3)];
      double &value = k % 3 == 0 ? dof.u.x : k % 3 == 1 ? dof.u.y : dof.r;
      value = h;
      const auto plus = forces();
      value = -h;
      stiffness.col(k) = -(plus - forces()) / (2.0 * h);
      value = 0.0;
    }
    const double share = largest_frequency(bench.system, stiffness) / bound_of(bench.system, 0.0);
    EXPECT_LE(share, 1.0) << trial;
    sharpest = std::max(sharpest, share);
  }
  EXPECT_GT(touching, 100);
  RecordProperty("largest_share_of_bound", std::to_string(sharpest));
}

/// A unit square in its own row of a system.
BlockSystem unit_square(BlockKind kind, double modulus, bool driven = false) {
  SceneBlock block;
  block.vertices = rectangle({0.0, 0.0}, {1.0, 1.0});
  block.driven = driven;
  BlockSystem system;
  append_block(system, BlockId{0}, block, {"rock", density, modulus, 0.0}, kind);
  system.num_owned = 1;
  pose(system, 0, 1);
  return system;
}

// Without shear springs the fastest mode of a square stretches it against both neighbours: 2 k/2 over m/12.
TEST(FrequencyBound, OfADeformableSquare) {
  constexpr double modulus = 1e7;
  const BlockSystem system = unit_square(BlockKind::deformable, modulus);
  const double exact = 12.0 * normal_stiffness / density;
  EXPECT_NEAR(contact_frequency_bound(system, 0, normal_stiffness, 0.0), exact, 1e-13 * exact);
  const double elastic = 12.0 * modulus / density;
  EXPECT_NEAR(contact_frequency_bound(system, 0, normal_stiffness, 0.0, Elasticity::explicit_),
              exact + elastic, 1e-13 * (exact + elastic));
  EXPECT_EQ(contact_frequency_bound(unit_square(BlockKind::rigid, modulus, true), 0, 1.0, 1.0), 0.0);
}

/// Largest omega^2 of a row of unit squares with flush joints, normal springs only, free ends; unknowns (u,
/// eps_x), which the other four do not see.
double largest_of_chain(int num_blocks, bool deformable) {
  const int n = 2 * num_blocks;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd mass(n);
  for (int i = 0; i < num_blocks; ++i) {
    mass[2 * i] = density;
    mass[2 * i + 1] = deformable ? density / 12.0 : 1e12 * density;
    if (i > 0) {
      Eigen::VectorXd gap = Eigen::VectorXd::Zero(n);
      gap.segment<4>(2 * i - 2) << -1.0, -0.5, 1.0, -0.5;
      stiffness += normal_stiffness * gap * gap.transpose();
    }
  }
  return squared_frequencies(stiffness, mass).maxCoeff();
}

// 4 k/m and 12 k/m are what long chains reach, as cos^2(pi/2N) does 1: the bound of deformable blocks is
// sharp.
TEST(FrequencyBound, OfChainsIsReached) {
  const double unit = normal_stiffness / density;
  EXPECT_NEAR(largest_of_chain(50, false), 4.0 * unit, 0.004 * unit);
  EXPECT_LT(largest_of_chain(50, false), 4.0 * unit);
  EXPECT_NEAR(largest_of_chain(50, true), 12.0 * unit, 0.012 * unit);
  const double bound =
      contact_frequency_bound(unit_square(BlockKind::deformable, 1.0), 0, normal_stiffness, 0.0);
  EXPECT_LE(largest_of_chain(50, true), bound);
}

/// Largest stretch in 2000 steps of a square between two mirrored neighbours that stretch alike: each face
/// meets the spring 2 k of half a joint.
double largest_stretch(double share_of_limit, double modulus, Elasticity elasticity) {
  BlockSystem system = unit_square(BlockKind::deformable, modulus);
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
  const double omega = std::sqrt(contact_frequency_bound(system, 0, normal_stiffness, 0.0, elasticity));
  const double time_step = share_of_limit * stability_limit(scheme, 0.0) / omega;
  make_block_matrices(system, scheme, time_step, elasticity, normal_stiffness);
  Deformation &d = system.deformation[0];
  constexpr double start = 1e-8;
  d.gradient.xx = d.trial.xx = 1.0 + start;
  double largest = 0.0;
  for (int k = 0; k < 2000; ++k) {
    predict(system, scheme, time_step);
    d.contact.force.xx = -normal_stiffness * (d.trial.xx - 1.0);
    if (solve_and_update(system, {}, scheme, time_step, elasticity)) {
      return std::numeric_limits<double>::infinity();
    }
    largest = std::max(largest, std::abs(d.gradient.xx - 1.0) / start);
  }
  return largest;
}

TEST(FrequencyBound, IsTheLimitOfTheStep) {
  for (const double modulus : {1e-3 * normal_stiffness, normal_stiffness, 10.0 * normal_stiffness}) {
    EXPECT_LT(largest_stretch(0.98, modulus, Elasticity::explicit_), 20.0) << modulus;
    EXPECT_GT(largest_stretch(1.02, modulus, Elasticity::explicit_), 1e6) << modulus;
    EXPECT_LT(largest_stretch(0.98, modulus, Elasticity::implicit), 20.0) << modulus;
  }
  EXPECT_GT(largest_stretch(1.02, 1e-3 * normal_stiffness, Elasticity::implicit), 1e6);
}

} // namespace
} // namespace gcpdda::frequency_bound_test
