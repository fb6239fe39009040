// C10: a plane compression wave through one compliant joint, at right angles.
//
// The joint passes the stress on and opens by it over k (Schoenberg, 1980, doi:10.1121/1.384077). Between
// two halves of the impedance Z a wave of the frequency omega keeps, of its amplitude,
//     |T| = 1/sqrt(1 + (omega Z/2k)^2).
// A column of slabs with equal joints, one of which is softer, is such a bar: its modulus is
// 1/(1/E + 1/(k_n h)) and 1/k is what the soft joint has more than the others. A pulse holds all frequencies.
// Fourier sums over its passage through one slab before and one behind the joint give |T|.
//
// A chain differs from a bar by (q h)^2, q the wave number (h = 1 m below). Exactly, with F_n in the joints
// and the strain of slab n (F_n + F_n-1)/(2 E - m h omega^2/6), the openings of neighbouring joints give, g =
// h/(4 E - m h omega^2/3),
//     -m omega^2 [F_n/k_n + g (F_n-1 + 2 F_n + F_n+1) + (F_0/k at n = 0)] = F_n+1 - 2 F_n + F_n-1.
// F_n = exp(iqn) + (T - 1) exp(-iqn) before and T exp(iqn) behind the joint solve it with
//     m omega^2 (1/k_n + 4 g cos^2(q/2)) = 4 sin^2(q/2),
//     |T| = 1/sqrt(1 + (C/(2 A sin(q)))^2),  A = 1 + m omega^2 g,  C = m omega^2/k.
// Rigid slabs: g = 0, C/(2 A sin(q)) = (k_n/k) tan(q/2). What is left of the error is the time step,
// (omega dt)^2/12, and the ends of the pulse that the sums cut off: 2e-4. Against the bar it is
// tan(q/2)/sin(q/2) - 1 = (q h)^2/8 at most, which is the answer of many slabs per wave.

#include "problem.hpp"

#include "blockgen/region_cutter.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <utility>
#include <vector>

namespace gcpdda::testing::joint_transmission_test {
namespace {

constexpr int num_slabs = 160; // 1 m high
constexpr int soft_joint = 60; ///< its height, m
constexpr double before = 25.5;
constexpr double behind = 70.5;
constexpr double width = 10.0;         ///< m
constexpr double pulse_length = 24.0;  ///< m
constexpr double pulse_speed = 1e-4;   ///< m/s: a sixth of the stress at rest, which keeps joints closed
constexpr double last_passage = 185.0; ///< m at the speed of waves: nothing has come back from the ends yet

struct Bar {
  double joint_stiffness = 1e9; ///< of the other joints, Pa/m
  double youngs_modulus = 0.0;  ///< Pa, without Poisson's effect; 0: rigid slabs
  double softness = 1.0;        ///< modulus of the bar over k, m

  [[nodiscard]] double modulus() const {
    return 1.0 / (1.0 / joint_stiffness + (youngs_modulus > 0.0 ? 1.0 / youngs_modulus : 0.0));
  }
  [[nodiscard]] double speed() const { return std::sqrt(modulus() / rock_density); }
  [[nodiscard]] double compliance() const { return softness / modulus(); } ///< 1/k

  [[nodiscard]] std::string toml() const {
    std::string toml = head({.duration = last_passage / speed(),
                             .gravity = {},
                             .normal_stiffness = joint_stiffness,
                             .damping = 0.0,
                             .run_keys = "plane = \"stress\"\nsafety = 0.2\n",
                             .fidelity = youngs_modulus > 0.0 ? "deformable" : "rigid",
                             .youngs_modulus = youngs_modulus});
    toml +=
        fmt::format("[joint.soft]\nnormal_stiffness = {:.17g}\n[joint.tight]\nnormal_stiffness = {:.17g}\n",
                    1.0 / (1.0 / joint_stiffness + compliance()), joint_stiffness);
    toml += fmt::format("[region]\nmaterial = \"rock\"\npolygon = [[0, 0], [{0}, 0], [{0}, {1}], [0, {1}]]\n"
                        "stress = [\"bottom\", \"top\"]\n"
                        "[in_situ]\nvertical_stress = 1e3\nk0 = 0.0\n"
                        "[earthquake]\nviscous = [\"bottom\", \"top\"]\n",
                        width, num_slabs);
    for (int k = 1; k < num_slabs; ++k) {
      toml += fmt::format("[[fault]]\npoints = [[-1, {0}], [{1}, {0}]]\njoint = \"{2}\"\n", k, width + 1.0,
                          k == soft_joint ? "soft" : "tight");
    }
    return toml;
  }

  /// |T| of the chain and of the bar.
  [[nodiscard]] double of_chain(double omega) const {
    const double inertia = rock_density * omega * omega; // m omega^2
    const double g = youngs_modulus > 0.0 ? 0.25 / (youngs_modulus - inertia / 12.0) : 0.0;
    // 4 sin^2(q/2) (1 + m omega^2 g) = m omega^2 (1/k_n + 4 g)
    const double half_sine =
        std::sqrt(0.25 * inertia * (1.0 / joint_stiffness + 4.0 * g) / (1.0 + inertia * g));
    const double sine = 2.0 * half_sine * std::sqrt(1.0 - half_sine * half_sine);
    return 1.0 / std::hypot(1.0, inertia * compliance() / (2.0 * (1.0 + inertia * g) * sine));
  }
  [[nodiscard]] double of_bar(double omega) const {
    return 1.0 / std::hypot(1.0, 0.5 * omega * rock_density * speed() * compliance());
  }
};

std::vector<RecordRow> pulse(double length) {
  std::vector<RecordRow> rows;
  constexpr int count = 400;
  for (int k = 0; k <= count; ++k) {
    rows.push_back({length * k / count,
                    {0.0, 0.5 * pulse_speed * (1.0 - std::cos(2.0 * std::numbers::pi * k / count))}});
  }
  return rows;
}

std::size_t slab_at(const Simulation &simulation, double height) {
  const BlockSystem &blocks = simulation.blocks();
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    if (std::abs(blocks.properties[row].centroid.y - height) < 0.25) {
      return row;
    }
  }
  throw std::runtime_error("no slab there");
}

/// |T| measured at the frequencies.
std::vector<double> transmitted(const Bar &bar, const std::vector<double> &frequencies) {
  Scene scene = scene_of(bar.toml());
  scene.earthquake.file = "in memory";
  scene.earthquake.record = pulse(pulse_length / bar.speed());
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  Simulation simulation(Communicator::self(), std::move(scene));
  const std::size_t rows[2] = {slab_at(simulation, before), slab_at(simulation, behind)};
  // The echo, which short waves run ahead of, passes the first slab after that.
  const double passed = (soft_joint + 10.0) / bar.speed();
  std::vector<std::complex<double>> came(frequencies.size());
  std::vector<std::complex<double>> went(frequencies.size());
  while (!simulation.finished()) {
    step(simulation);
    for (std::size_t k = 0; k < frequencies.size(); ++k) {
      const std::complex<double> wave = std::polar(1.0, frequencies[k] * simulation.time());
      if (simulation.time() < passed) {
        came[k] += wave * simulation.blocks().velocity[rows[0]].u.y;
      }
      went[k] += wave * simulation.blocks().velocity[rows[1]].u.y;
    }
  }
  EXPECT_FALSE(simulation.fault().has_value());
  std::vector<double> result;
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    result.push_back(std::abs(went[k]) / std::abs(came[k]));
  }
  return result;
}

TEST(JointTransmission, OfAPlaneWaveByFrequency) {
  double worst = 0.0;
  for (const Bar &kind : {Bar{1e9, 0.0}, Bar{1e9, 1e9}, Bar{1e10, 1e9}}) {
    for (const double softness : {1.0, 5.0, 17.0}) {
      Bar bar = kind;
      bar.softness = softness;
      const std::vector<double> numbers{0.1, 0.2, 0.3}; // omega h/c
      std::vector<double> frequencies;
      for (const double number : numbers) {
        frequencies.push_back(number * bar.speed());
      }
      const std::vector<double> got = transmitted(bar, frequencies);
      for (std::size_t k = 0; k < got.size(); ++k) {
        const std::string name =
            fmt::format("C10 wave through a joint, omega Z/k = {:.1f}, {}: |T|", numbers[k] * softness,
                        bar.youngs_modulus > 0.0 ? fmt::format("deformable, k_n h/E = {}",
                                                               bar.joint_stiffness / bar.youngs_modulus)
                                                 : "rigid");
        worst = std::max(worst, std::abs(got[k] / bar.of_chain(frequencies[k]) - 1.0));
        expect_value(name, bar.of_bar(frequencies[k]), got[k], numbers[k] * numbers[k] / 8.0);
      }
    }
  }
  expect_below("C10 waves through a joint: largest error against the chain of slabs", 2e-4, worst);
}

} // namespace
} // namespace gcpdda::testing::joint_transmission_test
