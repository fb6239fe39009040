// Pieces of the deformable block, one by one; how it moves is in verification/deformable_block_test.cpp.

#include "dynamics/deformable.hpp"

#include "dynamics/integrate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace gcpdda::deformable_test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr double modulus = 5e8;
constexpr double ratio = 0.3;
constexpr double density = 2500.0;

double next(std::mt19937 &engine) {
  return -1.0 + 2.0 * static_cast<double>(engine()) / 4294967296.0;
}

Mat2 turn_by(double angle) {
  const Rotation r = Rotation::of(angle);
  return {r.c, -r.s, r.s, r.c};
}

Mat2 random_gradient(std::mt19937 &engine, double strain) {
  const Mat2 stretch{1.0 + strain * next(engine), strain * next(engine), strain * next(engine),
                     1.0 + strain * next(engine)};
  return turn_by(pi * next(engine)) * stretch;
}

Scheme usual_scheme() {
  return make_scheme(SchemeKind::generalized_alpha, 0.8, ContactTime::leapfrog);
}

/// One lopsided block as row 0, at rest.
BlockSystem one_block(BlockKind kind = BlockKind::deformable, bool plane_strain = true) {
  BlockSystem system;
  SceneBlock block;
  block.vertices = {{0.0, 0.0}, {2.0, 0.3}, {1.7, 1.2}, {-0.2, 1.0}};
  append_block(system, BlockId{0}, block, {"rock", density, modulus, ratio}, kind, plane_strain);
  system.num_owned = 1;
  pose(system, 0, 1);
  return system;
}

void put(BlockSystem &system, const Mat2 &gradient) {
  Deformation &d = system.deformation[0];
  d.gradient = d.trial = gradient;
  pose(system, 0, 1);
}

TEST(Gradient, ComponentsComeBackAndDoTheSameWork) {
  std::mt19937 engine(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Mat2 g = random_gradient(engine, 0.5);
    const Mat2 h = random_gradient(engine, 0.5);
    EXPECT_LE(norm(motion_matrix(motion_dof(g)) - g), 4.0 * epsilon);
    EXPECT_LE(norm(force_matrix(force_dof(h)) - h), 4.0 * epsilon);
    const GradientDof f = force_dof(h);
    const GradientDof m = motion_dof(g);
    EXPECT_NEAR(f.r * m.r + f.ex * m.ex + f.ey * m.ey + f.gxy * m.gxy, contract(h, g), 16.0 * epsilon);
  }
}

TEST(Gradient, PolarDecomposition) {
  std::mt19937 engine(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Mat2 f = random_gradient(engine, 0.4);
    const Mat2 stretch = transposed(rotation_of(f)) * f;
    EXPECT_NEAR(stretch.xy, stretch.yx, 4.0 * epsilon);
    EXPECT_GT(stretch.xx, 0.0);
    EXPECT_LE(norm(rotation_of(f) - turn_by(angle_of(f))), 4.0 * epsilon);
    const double angle = pi * next(engine);
    EXPECT_NEAR(angle_between(f, turn_by(angle) * f), angle, 8.0 * epsilon);
  }
  EXPECT_EQ(angle_between(random_gradient(engine, 0.0), {}), 0.0) << "undefined, but a number";
}

// P is the slope of the energy in every direction, so it has no torque; both turn with the block.
TEST(ElasticForce, IsTheSlopeOfTheEnergyAndHasNoTorque) {
  std::mt19937 engine(3);
  for (const bool plane_strain : {false, true}) {
    const BlockSystem system = one_block(BlockKind::deformable, plane_strain);
    const Deformation &d = system.deformation[0];
    for (int trial = 0; trial < 50; ++trial) {
      const Mat2 f = random_gradient(engine, 0.2);
      const Mat2 force = elastic_force(d, f);
      const Mat2 along = random_gradient(engine, 0.5);
      constexpr double h = 1e-5; // truncation h^2, rounding epsilon/h
      const double slope = (strain_energy(d, f + h * along) - strain_energy(d, f - h * along)) / (2.0 * h);
      EXPECT_NEAR(slope, contract(force, along), 1e-8 * d.stiffness_direct);
      const Mat2 moment = force * transposed(f);
      EXPECT_NEAR(moment.xy, moment.yx, 8.0 * epsilon * norm(force));
      const Mat2 turn = turn_by(1.0);
      EXPECT_LE(norm(elastic_force(d, turn * f) - turn * force), 16.0 * epsilon * d.stiffness_direct);
    }
  }
}

TEST(Energies, OfKnownStates) {
  BlockSystem system = one_block();
  Deformation &d = system.deformation[0];
  constexpr double spin = 3.0;
  const double turning = 0.5 * system.properties[0].inertia * spin * spin;
  EXPECT_NEAR(kinetic_energy(d, {0.0, -spin, spin, 0.0}), turning, 8.0 * epsilon * turning);
  constexpr double stretch = 1e-3;
  const double stored = 0.5 * d.stiffness_direct * stretch * stretch;
  EXPECT_NEAR(strain_energy(d, turn_by(0.7) * Mat2{1.0 + stretch, 0.0, 0.0, 1.0}), stored,
              1e3 * epsilon / stretch * stored);
  std::mt19937 engine(5);
  put(system, random_gradient(engine, 0.01));
  accelerate(system); // applies P*
  const double trial = strain_energy(d, d.trial);
  EXPECT_NEAR(applied_strain_energy(d), trial, 1e-11 * trial);
}

// A rotating and stretching motion F = R(w t)(I + t A).
TEST(Spin, OfAKnownMotion) {
  const Mat2 a{0.1, 0.05, 0.05, -0.2};
  constexpr double w = 2.0;
  const auto motion = [&](double t) { return turn_by(w * t) * (Mat2::identity() + t * a); };
  const double t = 0.4;
  constexpr double h = 1e-4;
  const Mat2 rate = (0.5 / h) * (motion(t + h) - motion(t - h));
  // Commuting symmetric factors add no spin of their own.
  EXPECT_NEAR(spin_of(motion(t), rate), w, 1e-7);
}

// M g = R^T (G - P): the same as F'' S = G - P, and P is kept for output.
TEST(Accelerate, DeformableRows) {
  std::mt19937 engine(4);
  BlockSystem system = one_block();
  put(system, random_gradient(engine, 0.01));
  Deformation &d = system.deformation[0];
  system.contact[0].force.u = {3e3, -1e3};
  d.contact.force = 1e4 * random_gradient(engine, 0.5);
  accelerate(system);
  EXPECT_EQ(d.internal, elastic_force(d, d.trial));
  EXPECT_LE(norm(d.acceleration * d.second_moment + d.internal - d.contact.force),
            32.0 * epsilon * norm(d.internal));
  EXPECT_NEAR(system.acceleration[0].u.x, 3e3 / system.properties[0].mass, 1e-15);
}

// Dead loads at rest: the first step from a consistent start finds the same acceleration again.
TEST(Accelerate, AgreesWithTheFirstStep) {
  for (const Elasticity elasticity : {Elasticity::implicit, Elasticity::explicit_}) {
    BlockSystem system = one_block();
    system.deformation[0].contact.force = {2e4, 5e3, -1e4, 3e3};
    accelerate(system);
    const Mat2 start = system.deformation[0].acceleration;
    constexpr double time_step = 1e-9; // so short that elasticity does not answer yet
    make_block_matrices(system, usual_scheme(), time_step, elasticity, 1e9);
    predict(system, usual_scheme(), time_step);
    ASSERT_FALSE(solve_and_update(system, {}, usual_scheme(), time_step, elasticity));
    EXPECT_LE(norm(system.deformation[0].acceleration - start), 1e-9 * norm(start));
  }
}

TEST(Predict, KeepsTheUnwrappedAngle) {
  BlockSystem system = one_block();
  Deformation &d = system.deformation[0];
  const double angle = 6.0 * pi + 3.1; // 0.04 rad short of where atan2 jumps
  put(system, turn_by(angle));
  system.displacement[0].r = angle;
  d.rate = 100.0 * (Mat2{0.0, -1.0, 1.0, 0.0} * d.gradient);
  constexpr double time_step = 1e-3;
  predict(system, usual_scheme(), time_step);
  // A chord along the tangent of the circle.
  const double turned = std::atan(100.0 * usual_scheme().trial_velocity * time_step);
  EXPECT_NEAR(system.trial[0].r, angle + turned, 32.0 * epsilon * angle);
  make_block_matrices(system, usual_scheme(), time_step, Elasticity::explicit_, 1e9);
  ASSERT_FALSE(solve_and_update(system, {}, usual_scheme(), time_step, Elasticity::explicit_));
  EXPECT_NEAR(system.displacement[0].r, angle + 0.1, 1e-3);
}

TEST(SolveAndUpdate, KeepsABrokenDeformableBlock) {
  const double bad = std::numeric_limits<double>::quiet_NaN();
  for (const auto &[force, on_gradient] :
       {std::pair(bad, Mat2{}), std::pair(0.0, Mat2{0.0, bad, 0.0, 0.0}),
        std::pair(0.0, Mat2{-1e13, 0.0, 0.0, 0.0})}) { // the last one turns it inside out
    BlockSystem system = one_block();
    system.contact[0].force.u.x = force;
    system.deformation[0].contact.force = on_gradient;
    make_block_matrices(system, usual_scheme(), 1e-3, Elasticity::implicit, 1e9);
    predict(system, usual_scheme(), 1e-3);
    EXPECT_EQ(solve_and_update(system, {}, usual_scheme(), 1e-3, Elasticity::implicit),
              std::optional<std::size_t>(0));
    EXPECT_EQ(system.deformation[0].gradient, Mat2::identity());
    EXPECT_EQ(system.velocity[0], RigidDof{});
  }
}

// No vertex leaves the bounds, whatever F does.
TEST(MotionBound, HoldsForADeformableBlock) {
  std::mt19937 engine(6);
  for (int trial = 0; trial < 50; ++trial) {
    BlockSystem system = one_block();
    Deformation &d = system.deformation[0];
    put(system, random_gradient(engine, 0.05));
    d.rate = 20.0 * random_gradient(engine, 1.0);
    d.acceleration = 300.0 * random_gradient(engine, 1.0);
    system.velocity[0].u = {next(engine), next(engine)};
    d.refreshed = d.gradient;
    constexpr double time_step = 1e-3;
    make_block_matrices(system, usual_scheme(), time_step, Elasticity::implicit, 1e9);
    const std::vector<Vec2> before = current_vertices(system, 0);
    const double bound = motion_bound(system, 0, time_step);
    predict(system, usual_scheme(), time_step);
    for (std::size_t k = 0; k < before.size(); ++k) {
      EXPECT_LE(norm(system.vertex[k] - before[k]), bound);
    }
    ASSERT_FALSE(solve_and_update(system, {}, usual_scheme(), time_step, Elasticity::implicit));
    const std::vector<Vec2> after = current_vertices(system, 0);
    double farthest = 0.0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      farthest = std::max(farthest, norm(after[k] - before[k]));
    }
    EXPECT_LE(farthest, moved_since_refresh(system, 0));
    EXPECT_GT(farthest, 0.2 * moved_since_refresh(system, 0)); // not a bound that never bites
  }
}

// A dead load G on a block at rest, [std]: plane stress eps = (sx - nu sy)/E; plane strain with E/(1 - nu^2)
// and nu/(1 - nu) in their places. Local damping brings it there.
TEST(StaticStretch, IsHookes) {
  for (const bool plane_strain : {false, true}) {
    for (const Elasticity elasticity : {Elasticity::implicit, Elasticity::explicit_}) {
      BlockSystem system = one_block(BlockKind::deformable, plane_strain);
      const double area = system.properties[0].area;
      constexpr double sx = 2e5;
      constexpr double sy = -5e4;
      constexpr double sxy = 1e5;
      constexpr double time_step = 1e-4;
      make_block_matrices(system, usual_scheme(), time_step, elasticity, 1e9);
      for (int k = 0; k < 100000; ++k) {
        predict(system, usual_scheme(), time_step);
        system.contact[0] = {};
        system.deformation[0].contact = {area * Mat2{sx, sxy, sxy, sy}, {}, {}};
        ASSERT_FALSE(solve_and_update(system, {.local_damping = 0.5}, usual_scheme(), time_step, elasticity));
      }
      const double e = plane_strain ? modulus / (1.0 - ratio * ratio) : modulus;
      const double nu = plane_strain ? ratio / (1.0 - ratio) : ratio;
      const double shear = sxy * (1.0 + ratio) / modulus; // half of gamma
      const Mat2 expected{1.0 + (sx - nu * sy) / e, shear, shear, 1.0 + (sy - nu * sx) / e};
      // Turning, at which dead tractions swing the block to and fro with some 10 rad/s, settles last.
      EXPECT_LE(norm(system.deformation[0].gradient - expected), 1e-11);
      // Mean Cauchy stress is P F^T/(area det F).
      const std::array<double, 3> stress = mean_cauchy_stress(system.deformation[0], area);
      const Mat2 cauchy = (1.0 / determinant(expected)) * (Mat2{sx, sxy, sxy, sy} * transposed(expected));
      EXPECT_NEAR(stress[0], cauchy.xx, 1e-8 * sx);
      EXPECT_NEAR(stress[1], cauchy.yy, 1e-8 * sx);
      EXPECT_NEAR(stress[2], 0.5 * (cauchy.xy + cauchy.yx), 1e-8 * sx);
    }
  }
}

/// A block in the middle of a motion: all that a step reads is random.
BlockSystem stirred_block(std::mt19937 &engine, const Scheme &scheme, double time_step,
                          Elasticity elasticity) {
  BlockSystem system = one_block();
  make_block_matrices(system, scheme, time_step, elasticity, 1e9);
  put(system, Mat2::identity() + 0.01 * random_gradient(engine, 1.0));
  Deformation &d = system.deformation[0];
  d.rate = random_gradient(engine, 1.0);
  d.acceleration = (0.1 / time_step) * random_gradient(engine, 1.0);
  system.velocity[0].u = {next(engine), next(engine)};
  predict(system, scheme, time_step);
  const double force = system.properties[0].mass / time_step;
  system.contact[0] = {{{force * next(engine), force * next(engine)}, 0.0}, {}, {}};
  d.contact = {force * random_gradient(engine, 1.0), {}, {}};
  return system;
}

// Friction on every component of the motion of x*, whatever the stiffness: what is taken does no work that is
// positive, it is what an outer force like it would have done, and no component of the mean motion is turned.
TEST(LocalDamping, OfADeformableBlockIsFriction) {
  std::mt19937 engine(8);
  constexpr double time_step = 1e-3;
  for (const double r : {0.0, 0.5, 0.8}) {
    const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, r, ContactTime::leapfrog);
    for (const Elasticity elasticity : {Elasticity::implicit, Elasticity::explicit_}) {
      for (int trial = 0; trial < 50; ++trial) {
        const BlockSystem start = stirred_block(engine, scheme, time_step, elasticity);
        BlockSystem damped = start;
        ASSERT_FALSE(solve_and_update(damped, {.local_damping = 0.8}, scheme, time_step, elasticity));
        const Vec2 d = damped.contact[0].damping.u;
        const Mat2 on_gradient = damped.deformation[0].contact.damping;
        EXPECT_EQ(damped.contact[0].force.u, start.contact[0].force.u + d);

        BlockSystem pushed = start;
        pushed.contact[0].force.u += d;
        pushed.deformation[0].contact.force += on_gradient;
        ASSERT_FALSE(solve_and_update(pushed, {}, scheme, time_step, elasticity));
        // The torque of K e is balanced before damping: of second order in the strain that passes.
        const double size = norm(pushed.acceleration[0].u) + norm(pushed.deformation[0].acceleration);
        EXPECT_LE(norm(damped.acceleration[0].u - pushed.acceleration[0].u), 1e-12 * size);
        EXPECT_LE(norm(damped.deformation[0].acceleration - pushed.deformation[0].acceleration), 0.05 * size);

        const RigidDof before = damped.motion[0].increment();
        const Mat2 stretched = damped.gradient_increment(0);
        predict(damped, scheme, time_step);
        const Vec2 way = before.u + damped.motion[0].increment().u;
        const Mat2 way_of_gradient = stretched + damped.gradient_increment(0);
        const double on_centroid = dot(d, way);
        const double turning = contract(on_gradient, way_of_gradient);
        const double rounding = 1e-13 * (norm(d) * norm(way) + norm(on_gradient) * norm(way_of_gradient));
        EXPECT_LE(on_centroid, rounding);
        EXPECT_LE(turning, rounding);
        EXPECT_LT(on_centroid + turning, 0.0);
        EXPECT_NEAR(damped.ledger[0].damping, 0.5 * (dot(d, before.u) + contract(on_gradient, stretched)),
                    rounding);
      }
    }
  }
}

/// The swing of a block on a spring, W = omega dt.
struct Swing {
  double last = 0.0; ///< size at the end over that at the start
  double rise = 0.0; ///< largest of w^2 + W^2 x (x + w) in a step over its value, w the way to the next x*
};
Swing swing_of(double w, double share, double phase) {
  constexpr double time_step = 1e-3;
  BlockSystem system = one_block();
  const double spring = w * w * system.properties[0].mass / (time_step * time_step);
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.5, ContactTime::leapfrog);
  system.displacement[0].u.x = std::cos(phase);
  system.velocity[0].u.x = w / time_step * std::sin(phase);
  system.trial[0].u.x = next_trial(system, scheme, -time_step, 0).motion.u.x;
  Swing swing;
  double before = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double x = system.trial[0].u.x;
    predict(system, scheme, time_step);
    const double way = system.trial[0].u.x - x;
    const double kept = way * way + w * w * x * (x + way);
    if (k > 1) { // a_0 = 0 does not belong to the spring
      swing.rise = std::max(swing.rise, kept / before - 1.0);
    }
    before = kept;
    if (kept < 1e-200) {
      break;
    }
    swing.last = std::hypot(x, way / w);
    system.contact[0] = {{{-spring * system.trial[0].u.x, 0.0}, 0.0}, {}, {}};
    system.deformation[0].contact = {};
    EXPECT_FALSE(solve_and_update(system, {.local_damping = share}, scheme, time_step, Elasticity::implicit));
  }
  return swing;
}

// What the leapfrog keeps never rises, up to the limit of the scheme: to the rounding of its terms, which
// near W = 2 cancel to 1 - W^2/4. At 0.9 of the limit of damped scenes all comes to rest; above that limit
// what alternates with the step goes on.
TEST(LocalDamping, DeformableBlocksComeToRestBelowItsLimitAndNeverGrow) {
  const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, 0.5, ContactTime::leapfrog);
  for (const double share : {0.3, 0.8, 0.9}) {
    const double limit = stability_limit(scheme, 0.0, share);
    double goes_on = 0.0;
    for (int k = 0; k < 12; ++k) {
      for (const double w : {0.1, 0.5 * limit, 0.9 * limit, 1.05 * limit, 1.95}) {
        const Swing swing = swing_of(w, share, 0.5 * k);
        EXPECT_LT(swing.rise, 1e-12) << share << ' ' << w << ' ' << k;
        if (w < limit) {
          EXPECT_LT(swing.last, 1e-3) << share << ' ' << w << ' ' << k;
        } else {
          goes_on = std::max(goes_on, swing.last);
        }
      }
    }
    EXPECT_GT(goes_on, 0.1) << share;
  }
}

// A block that is let go falls with what its damping leaves of its weight.
TEST(LocalDamping, ADeformableBlockFallsWithTheRest) {
  constexpr double time_step = 1e-3;
  constexpr double share = 0.7;
  BlockSystem system = one_block();
  const double weight = 9.81 * system.properties[0].mass;
  double halfway = 0.0; // a_0 = 0 does not belong to the weight, and what comes of it dies out
  for (int k = 0; k < 200; ++k) {
    halfway = k == 100 ? system.velocity[0].u.y : halfway;
    predict(system, usual_scheme(), time_step);
    system.contact[0] = {{{0.0, -weight}, 0.0}, {}, {}};
    system.deformation[0].contact = {};
    ASSERT_FALSE(
        solve_and_update(system, {.local_damping = share}, usual_scheme(), time_step, Elasticity::implicit));
  }
  EXPECT_NEAR(system.velocity[0].u.y - halfway, -(1.0 - share) * 9.81 * 100 * time_step, 1e-12);
  EXPECT_EQ(system.velocity[0].u.x, 0.0);
}

} // namespace
// By a series where it is small, to the rounding of the products it comes from.
TEST(Deformable, AngleBetweenTurnsIsTheirs) {
  const auto turned = [](double angle) {
    const Rotation r = Rotation::of(angle);
    return Mat2{r.c, -r.s, r.s, r.c} * Mat2{1.1, 0.02, 0.02, 0.9};
  };
  for (const double angle : {0.0, 1e-12, -3e-7, 1e-3, 0.0156, -0.0157, 0.3, -2.0, 3.0}) {
    EXPECT_NEAR(angle_between(turned(0.7), turned(0.7 + angle)), angle, 8.0 * epsilon) << angle;
  }
}

} // namespace gcpdda::deformable_test
