// Kinetic damping takes energy, shown for the linear model of a step (simulation/stages.cpp, book_stop).

#include "dynamics/scheme.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace gcpdda::testing::kinetic_stop_test {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Symmetric, with the given eigenvalues in random directions.
Matrix symmetric(std::mt19937 &random, const Vector &eigenvalues) {
  std::normal_distribution<double> normal;
  const Matrix any =
      Matrix::NullaryExpr(eigenvalues.size(), eigenvalues.size(), [&] { return normal(random); });
  const Matrix directions = Eigen::HouseholderQR<Matrix>(any).householderQ();
  return directions * eigenvalues.asDiagonal() * directions.transpose();
}

/// Unit masses and unit steps: contact springs k act at the trial configuration, elasticity K implicitly.
struct Springs {
  Matrix contact;
  Matrix elastic;
  [[nodiscard]] double energy_at_rest(const Vector &x) const { return 0.5 * x.dot((contact + elastic) * x); }
};

/// From rest at x in `steps` steps: the largest energy that a stop after one of them leaves.
double largest_energy_after_stop(const Scheme &s, const Springs &springs, Vector x, int steps) {
  Vector v = Vector::Zero(x.size());
  Vector a = v;
  const double share = 1.0 - s.alpha_f;
  const Matrix own =
      (1.0 - s.alpha_m) * Matrix::Identity(x.size(), x.size()) + share * s.beta * springs.elastic;
  const Eigen::LDLT<Matrix> solver(own);
  double largest = 0.0;
  for (int step = 0; step < steps; ++step) {
    const Vector trial = x + s.trial_velocity * v + s.trial_acceleration * a;
    const Vector coasting = x + v + (0.5 - s.beta) * a;
    const Vector a_new = solver.solve(-springs.contact * trial -
                                      springs.elastic * (share * coasting + s.alpha_f * x) - s.alpha_m * a);
    v += (1.0 - s.gamma) * a + s.gamma * a_new;
    x = coasting + s.beta * a_new;
    a = a_new;
    largest = std::max(largest, springs.energy_at_rest(x));
  }
  return largest;
}

// Rounding of some hundred operations, of springs up to 1e5 times as stiff as the masses.
constexpr double rounding = 1e-9;

TEST(KineticStop, FromRestNoStopRaisesTheEnergyOfSpringsAtRandom) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (const double radius : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const Scheme scheme = make_scheme(SchemeKind::generalized_alpha, radius, ContactTime::leapfrog);
    const double limit = stability_limit(scheme, 0.0);
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Index size = 1 + trial % 4;
      Vector contact = Vector::NullaryExpr(size, [&] { return share(random); });
      contact *= std::pow(0.9 * limit, 2) * share(random) / contact.maxCoeff();
      const Vector elastic = Vector::NullaryExpr(
          size, [&] { return share(random) < 0.3 ? 0.0 : std::pow(10.0, 9.0 * share(random) - 4.0); });
      const Springs springs{symmetric(random, contact), symmetric(random, elastic)};
      const Vector start = Vector::NullaryExpr(size, [&] { return share(random) - 0.5; });
      EXPECT_LE(largest_energy_after_stop(scheme, springs, start, 80),
                (1.0 + rounding) * springs.energy_at_rest(start))
          << "radius " << radius << ", trial " << trial;
    }
  }
}

// The stop is booked as -(v M v/2 + (7/72) dt^2 a M a): with the scheme's numbers, for any force M a.
TEST(KineticStop, BookedWorkIsNegativeWhateverTheForce) {
  const Scheme s = make_scheme(SchemeKind::generalized_alpha, 0.5, ContactTime::leapfrog);
  for (int i = 0; i < 64; ++i) {
    const double angle = 0.1 * i;
    const double v = std::cos(angle);
    const double a = std::sin(angle);
    const double a_before = 3.0 * std::cos(5.0 * angle);
    const double v_before = v - (1.0 - s.gamma) * a_before - s.gamma * a;
    const double x = v_before + (0.5 - s.beta) * a_before + s.beta * a; // from x = 0 before
    const double behind = x - s.trial_velocity * v_before - s.trial_acceleration * a_before;
    const double ahead = s.trial_velocity * v + s.trial_acceleration * a;
    const double booked = 0.5 * a * (ahead - behind) - 0.5 * (behind + ahead) * (behind + ahead);
    EXPECT_NEAR(booked, -(0.5 * v * v + 7.0 / 72.0 * a * a), 1e-14);
  }
}

} // namespace
} // namespace gcpdda::testing::kinetic_stop_test
