// C8: strength of a sample with one inclined joint (Jaeger, 1960, Geological Magazine 97,
// doi:10.1017/S0016756800061100; Jaeger, Cook and Zimmerman, section 4).
//
// The joint dips at b against the plates, sigma1 acts along the sample, sigma3 on its sides. The joint bears
//     sigma_n = sigma3 + D cos^2 b,  tau = D sin b cos b,  D = sigma1 - sigma3
// and slips when tau = c + sigma_n tan(phi):
//     D = (2 c + 2 sigma3 tan(phi))/((1 - tan(phi) cot(b)) sin(2 b)) where b > phi, never where b <= phi.
// The sides bear dead loads in the middles of the faces, which is all that the six unknowns of a block know
// of a uniform stress. The lower plate is rough, the upper one goes down and is smooth, so that the upper
// block may slide. It starts with the overlaps of sigma3 all around.
//
// The joint must stick up to D and its slip hold D from there on. Truncation: overlaps and slip over the
// length of the joint, up to 4e-4 each at the largest stress, and what dashpots bear at the speed of the
// plate.

#include "problem.hpp"
#include "support/contact_regions.hpp"
#include "support/memories.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::jaeger_sample_test {
namespace {

constexpr double friction = 30.0 * degree;
constexpr double confinement = 1e4;     ///< sigma3, Pa
constexpr double joint_stiffness = 1e9; ///< k_n, Pa/m
constexpr double tangential_ratio = 0.5;
constexpr double margin = 0.5; ///< of rock beside the joint, m; the sample is 1 m wide
constexpr double damping = 0.3;

struct Sample {
  double angle = 0.0;          ///< b
  double cohesion = 0.0;       ///< Pa
  double youngs_modulus = 0.0; ///< 0: rigid blocks

  [[nodiscard]] double left() const { return margin; } ///< height at which the joint leaves
  [[nodiscard]] double right() const { return margin + std::tan(angle); }
  [[nodiscard]] double height() const { return right() + margin; }
  /// D at slip.
  [[nodiscard]] double strength() const {
    return 2.0 * (cohesion + confinement * std::tan(friction)) /
           ((1.0 - std::tan(friction) / std::tan(angle)) * std::sin(2.0 * angle));
  }
  /// Way of the upper plate for a unit of D.
  [[nodiscard]] double compliance() const {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return (2.0 + c * c * c + s * s * c / tangential_ratio) / joint_stiffness +
           (youngs_modulus > 0.0 ? height() / youngs_modulus : 0.0);
  }
  /// Slow against the vibrations of the sample on its compliance.
  [[nodiscard]] double duration() const { return 1000.0 * std::sqrt(rock_density * height() * compliance()); }

  [[nodiscard]] std::string toml(double largest_stress) const {
    std::string toml = head({.duration = duration(),
                             .gravity = {},
                             .normal_stiffness = joint_stiffness,
                             .friction_deg = friction / degree,
                             .damping = damping,
                             .run_keys = "plane = \"stress\"\n",
                             .fidelity = youngs_modulus > 0.0 ? "deformable" : "rigid",
                             .youngs_modulus = youngs_modulus,
                             .poissons_ratio = 0.25});
    toml.insert(toml.find("friction_angle_deg"),
                fmt::format("tangential_ratio = {}\ncohesion = {}\n", tangential_ratio, cohesion));
    toml += fmt::format("[material.plate]\ndensity = {}\n[joint.smooth]\nmaterials = [\"rock\", \"plate\"]\n"
                        "friction_angle_deg = 0.0\ncohesion = 0.0\n",
                        rock_density);
    const auto side = [](double x, double low, double high, Vec2 moved) {
      return fmt::format("[[block.load]]\npoint = [{:.17g}, {:.17g}]\nforce = [{:.17g}, 0.0]\n", x + moved.x,
                         0.5 * (low + high) + moved.y, (x > 0.5 ? -1.0 : 1.0) * confinement * (high - low));
    };
    const double overlap = confinement / joint_stiffness;
    const Vec2 lower{0.0, -overlap};
    const Vec2 upper = lower + overlap * Vec2{std::sin(angle), -std::cos(angle)};
    toml += block_toml("lower", placed({{0.0, 0.0}, {1.0, 0.0}, {1.0, right()}, {0.0, left()}}, 0.0, lower),
                       side(0.0, 0.0, left(), lower) + side(1.0, 0.0, right(), lower));
    toml += block_toml("upper",
                       placed({{0.0, left()}, {1.0, right()}, {1.0, height()}, {0.0, height()}}, 0.0, upper),
                       side(0.0, left(), height(), upper) + side(1.0, right(), height(), upper));
    toml += block_toml("bottom", rectangle({-2.0, -1.0}, {3.0, 0.0}), "fixed = true");
    const double top = height() + upper.y - overlap;
    const double begins = 0.1 * duration();
    std::string plate = block_toml(
        "top", rectangle({-2.0, top}, {3.0, top + 1.0}),
        fmt::format(
            "fidelity = \"rigid\"\nvelocity_table = [[0, 0, 0, 0], [{:.17g}, 0, 0, 0], [{:.17g}, 0, {:.17g}, "
            "0]]",
            begins, 1.1 * begins, -largest_stress * compliance() / (duration() - 1.05 * begins)));
    return toml + plate.replace(plate.find("\"rock\""), 6, "\"plate\"");
  }
};

/// What springs bear: D at the upper plate, and the slip of the joint.
struct State {
  double deviator = 0.0;
  double slip = 0.0;
};

State state_of(Simulation &simulation) {
  State state;
  const std::size_t upper = row_of(simulation, 1);
  const auto is = [&](const CandidatePair &pair, int block) {
    const std::size_t row = row_of(simulation, block);
    return std::minmax(pair.lower.value, pair.higher.value) ==
           std::minmax(static_cast<std::uint32_t>(upper), static_cast<std::uint32_t>(row));
  };
  for (const RegionForce &force : regions_of(simulation)) {
    const CandidatePair &pair = simulation.candidates().pairs[force.pair];
    if (is(pair, 3)) {
      state.deviator += force.normal_force - confinement;
    } else if (is(pair, 0)) {
      for (const RegionMemory &memory : simulation.history().of_pair(force.pair)) {
        state.slip += memory.slip;
      }
    }
  }
  return state;
}

/// D when the joint begins to slip and when it has slipped.
struct Course {
  double first = 0.0;
  double last = 0.0;
  double slip = 0.0;
};

Course pressed(const Sample &sample, double largest_stress) {
  Simulation simulation(Communicator::self(), scene_of(sample.toml(largest_stress)));
  run_until(simulation, 0.1 * sample.duration());
  const double before = state_of(simulation).slip;
  Course course;
  while (!simulation.finished()) {
    step(simulation);
    const State state = state_of(simulation);
    course.first = state.slip > before && course.first == 0.0 ? state.deviator : course.first;
    course.last = state.deviator;
    course.slip = state.slip - before;
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return course;
}

std::string name_of(const Sample &sample) {
  return fmt::format(
      "C8 sample with a joint at {:.0f} degrees, c = {:g} Pa, {}", sample.angle / degree, sample.cohesion,
      sample.youngs_modulus > 0.0 ? fmt::format("E = {:g} Pa", sample.youngs_modulus) : "rigid");
}

TEST(JaegerSample, SlipsAtTheStrengthOfItsJoint) {
  double worst = 0.0;
  for (const double youngs_modulus : {0.0, 1e9, 1e10}) {
    for (const double cohesion : {0.0, 2e4}) {
      for (const double degrees : {40.0, 50.0, 60.0, 75.0}) {
        const Sample sample{degrees * degree, cohesion, youngs_modulus};
        const Course course = pressed(sample, 1.5 * sample.strength());
        expect_value(name_of(sample) + ": stress at which it begins to slip, Pa", sample.strength(),
                     course.first, 5e-4);
        worst = std::max(worst, std::abs(course.last / sample.strength() - 1.0));
      }
    }
  }
  expect_below("C8 samples with a joint: largest error of the stress that slip holds", 5e-4, worst);
}

TEST(JaegerSample, NeverSlipsOnAJointFlatterThanFriction) {
  for (const double youngs_modulus : {0.0, 1e9, 1e10}) {
    const Sample sample{29.0 * degree, 0.0, youngs_modulus};
    const Course course = pressed(sample, 50.0 * confinement);
    expect_above(name_of(sample) + ": stress it bears over the confinement", 49.0, course.last / confinement);
    expect_below(name_of(sample) + ": slip, m", 0.0, course.slip);
  }
}

} // namespace
} // namespace gcpdda::testing::jaeger_sample_test
