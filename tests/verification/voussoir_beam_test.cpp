// C9: a beam of two halves that joints without tension hold between fixed abutments.
//
// Each half (length l = L/2, height h, weight W, stiffness E without Poisson's effect) is pressed against the
// abutment at the bottom and against the other half at the top, by the thrust H; friction carries W at the
// abutment, by symmetry nothing at midspan. Faces turn by psi, the axis by th = psi + g, g = W/(h E) the mean
// shear strain, and the axis shortens by e = H/(E h). A joint closed over the depth a from its edge, turned
// by psi at the abutment and 2 psi at midspan, bears the triangle H = k_n psi a^2/2 = k_n psi b^2 at a third
// of its depth; b = a/sqrt(2). The corners at the bottom of the abutment and the top of midspan bite in by
// psi a and psi b; their distance along the beam says
//     psi (a + b) = h psi + c - l e - l th^2/2,  e = k_n psi a^2/(2 E h)
// with c, the overlap of the two joints of a half at the start,
// and the moment of a half about its thrust at the abutment
//     H (h - l th - (a + b)/3) = W (l/2 + h psi/2).
// To first order and without c the depths do not depend on the load: k_n l a^2/(2 E h) + (1 + 1/sqrt(2)) a =
// h. Rigid halves: a = 0.586 h, b = 0.414 h, H = 3 W l/(4 h). Terms in th are those of snap-through. (The
// voussoir beam of Evans, 1941, Trans. Inst. Min. Metall. 50, whose depths are guessed, with joints that make
// them computable.)
//
// Truncation: corners bite in at the angle psi, so pressures and depths are off by that share.

#include "problem.hpp"
#include "support/contact_regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::voussoir_beam_test {
namespace {

constexpr double half_length = 3.0;                                            ///< l, m
constexpr double height = 1.0;                                                 ///< h, m
constexpr double weight = rock_density * earth_gravity * half_length * height; ///< W, N/m

struct Answer {
  double rotation = 0.0;   ///< psi
  double deflection = 0.0; ///< of midspan, l th, m
  double thrust = 0.0;     ///< H, N/m
  double abutment = 0.0;   ///< a, m
  double midspan = 0.0;    ///< b, m
};

struct Beam {
  double normal_stiffness = 1e9; ///< Pa/m
  double softness = 0.0;         ///< k_n L/E; 0: rigid halves

  [[nodiscard]] double youngs_modulus() const {
    return softness > 0.0 ? 2.0 * half_length * normal_stiffness / softness : 0.0;
  }

  /// c: with it friction holds the halves before they have turned, m.
  [[nodiscard]] double closure() const { return 0.02 * weight / (normal_stiffness * height); }

  /// Of faces turned by psi, all but the moment, which is left over.
  [[nodiscard]] Answer of_rotation(double psi) const {
    Answer answer{.rotation = psi};
    const double shear = softness > 0.0 ? weight / (height * youngs_modulus()) : 0.0;
    const double slope = psi + shear;
    const double quadratic = softness / (4.0 * height);
    const double linear = 1.0 + 1.0 / std::sqrt(2.0);
    const double constant = height + (closure() - 0.5 * half_length * slope * slope) / psi;
    answer.abutment = 2.0 * constant / (linear + std::sqrt(linear * linear + 4.0 * quadratic * constant));
    answer.midspan = answer.abutment / std::sqrt(2.0);
    answer.thrust = 0.5 * normal_stiffness * psi * answer.abutment * answer.abutment;
    answer.deflection = half_length * slope;
    return answer;
  }
  [[nodiscard]] Answer answer() const {
    const auto excess = [&](double psi) {
      const Answer a = of_rotation(psi);
      return a.thrust * (height - a.deflection - (a.abutment + a.midspan) / 3.0) -
             0.5 * weight * (half_length + height * psi);
    };
    // From the rotation without its own effects on, before the beam snaps through.
    double low = 0.5 * weight * half_length / (normal_stiffness * height * height * height);
    double high = low;
    while (excess(high) < 0.0) {
      high *= 1.02;
      EXPECT_LT(high, 0.2) << "it snaps through";
    }
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (excess(middle) < 0.0 ? low : high) = middle;
    }
    return of_rotation(high);
  }

  [[nodiscard]] std::string toml() const {
    const double deflection = answer().deflection;
    const double bite = 0.5 * closure();
    const double slow = std::sqrt(deflection / earth_gravity); // 1/frequency of the beam
    return head({.duration = 300.0 * slow,
                 .normal_stiffness = normal_stiffness,
                 .friction_deg = 50.0,
                 .run_keys = fmt::format("plane = \"stress\"\nlocal_damping = 0.8\ngravity_ramp = {:.17g}\n",
                                         100.0 * slow),
                 .fidelity = softness > 0.0 ? "deformable" : "rigid",
                 .youngs_modulus = youngs_modulus()}) +
           block_toml("left", rectangle({-half_length - bite, 0.0}, {bite, height})) +
           block_toml("right", rectangle({-bite, 0.0}, {half_length + bite, height})) +
           block_toml("left_abutment", rectangle({-half_length - 2.0, -1.0}, {-half_length, 2.0}),
                      "fixed = true") +
           block_toml("right_abutment", rectangle({half_length, -1.0}, {half_length + 2.0, 2.0}),
                      "fixed = true");
  }
};

Answer measured(const Beam &beam) {
  Simulation simulation(Communicator::self(), scene_of(beam.toml()));
  run(simulation);
  const BlockSystem &blocks = simulation.blocks();
  const std::size_t left = row_of(simulation, 0);
  const std::size_t right = row_of(simulation, 1);
  Answer answer;
  if (blocks.is_deformable(left)) {
    const Mat2 &gradient = blocks.deformation_of(left).gradient;
    answer.rotation = gradient.xy;
    answer.deflection = -half_length * gradient.yx;
  } else {
    answer.rotation = -blocks.displacement[left].r;
    answer.deflection = half_length * std::sin(answer.rotation);
  }
  for (const RegionForce &force : regions_of(simulation)) {
    const CandidatePair &pair = simulation.candidates().pairs[force.pair];
    const bool of_left = pair.lower.value == left || pair.higher.value == left;
    const bool of_right = pair.lower.value == right || pair.higher.value == right;
    const double depth = force.extent_end - force.extent_begin;
    if (of_left && of_right) {
      answer.midspan = depth;
    } else if (of_left) {
      answer.abutment = depth;
      answer.thrust = force.normal_force;
    }
  }
  double fastest = 0.0;
  for (const std::size_t row : {left, right}) {
    fastest = std::max(fastest, norm(blocks.velocity[row].u));
  }
  EXPECT_LE(fastest, 1e-9) << "m/s: it is at rest";
  return answer;
}

TEST(VoussoirBeam, BearsAsTheBeamWithoutTension) {
  for (const double normal_stiffness : {1e8, 1e9, 1e10}) {
    for (const double softness : {0.0, 1.0, 10.0}) {
      const Beam beam{normal_stiffness, softness};
      const Answer expected = beam.answer();
      const Answer got = measured(beam);
      const double tolerance = 2.0 * expected.rotation;
      const std::string name =
          fmt::format("C9 beam of two halves, k_n = {:g} Pa/m, {}: ", normal_stiffness,
                      softness > 0.0 ? fmt::format("deformable, k_n L/E = {}", softness) : "rigid");
      expect_value(name + "thrust, N/m", expected.thrust, got.thrust, tolerance);
      expect_value(name + "deflection of midspan, m", expected.deflection, got.deflection, tolerance);
      expect_value(name + "closed depth at the abutment, m", expected.abutment, got.abutment, tolerance);
      expect_value(name + "closed depth at midspan, m", expected.midspan, got.midspan, tolerance);
    }
  }
}

} // namespace
} // namespace gcpdda::testing::voussoir_beam_test
