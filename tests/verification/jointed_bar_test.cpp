// A bar of unit squares with joints: 1/E_eff = 1/E + 1/(k_n L). Strains stay near 1e-6, so that what the
// formulas leave out (joint closure relative to the block, finite strain) is of that size.

#include "problem.hpp"
#include "support/jointed_bar.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gcpdda::testing::jointed_bar_test {
namespace {

constexpr int num_blocks = 16;
constexpr double joint_stiffness = 1e9; // k_n, Pa/m

Setting bar_setting(const std::string &fidelity, double youngs_modulus, double duration, double damping,
                    const std::string &run_keys) {
  Setting setting;
  setting.duration = duration;
  setting.gravity = {};
  setting.normal_stiffness = joint_stiffness;
  setting.damping = damping;
  setting.fidelity = fidelity;
  setting.youngs_modulus = youngs_modulus;
  setting.run_keys = "plane = \"stress\"\n" + run_keys;
  return setting;
}

std::string abutment(double left, double right) {
  return block_toml(fmt::format("abutment{:.0f}", left), rectangle({left, -1.0}, {right, 2.0}),
                    "fixed = true");
}

/// Shortening of the bar under a dead load at its free end, settled by local damping.
double shortening(const std::string &fidelity, double youngs_modulus, double load) {
  std::string toml = head(bar_setting(fidelity, youngs_modulus, 6.0, 0.1, "local_damping = 0.4"));
  toml += abutment(-2.0, 0.0);
  for (int i = 0; i < num_blocks; ++i) {
    std::string extra;
    for (const double y : {0.25, 0.75}) {
      extra += i + 1 < num_blocks ? ""
                                  : fmt::format("[[block.load]]\npoint = [{}, {}]\nforce = [{:.17g}, 0.0]\n",
                                                num_blocks, y, -0.5 * load);
    }
    toml += block_toml(fmt::format("bar{}", i), rectangle({1.0 * i, 0.0}, {i + 1.0, 1.0}), extra);
  }
  toml += fmt::format("[[monitor]]\nname = \"end\"\npoint = [{}, 0.5]\n", num_blocks);
  Simulation simulation(Communicator::self(), scene_of(toml));
  run(simulation);
  const BlockSystem &blocks = simulation.blocks();
  const std::size_t last = row_of(simulation, num_blocks);
  double end = displacement_of(simulation, num_blocks).u.x;
  if (blocks.is_deformable(last)) {
    end += 0.5 * (blocks.deformation_of(last).gradient.xx - 1.0);
  }
  return -end;
}

// Without Poisson's effect blocks and joints are springs in a row: P n (1/E + 1/(k_n L)).
TEST(JointedBar, ShortensByBlocksAndJoints) {
  for (const double ratio : {0.1, 1.0, 10.0}) { // k_n L/E
    const double youngs_modulus = joint_stiffness / ratio;
    const double load = 1e-6 * std::min(youngs_modulus, joint_stiffness);
    const double joints = load * num_blocks / joint_stiffness;
    const double hooke = load * num_blocks / youngs_modulus;
    expect_value(fmt::format("C3 jointed bar, deformable, k_n L/E = {}: shortening, m", ratio),
                 joints + hooke, shortening("deformable", youngs_modulus, load), 2e-5);
    expect_value(fmt::format("C3 jointed bar, rigid, k_n L/E = {}: shortening, m", ratio), joints,
                 shortening("rigid", youngs_modulus, load), 2e-5);
  }
}

/// Frequency of the half wave that runs to and fro between two abutments in a bar under compression. The
/// blocks start unstrained; dashpots take what breathing that makes, and hardly anything of the slow wave.
/// They act at t_n, the springs (1 - af) dt later, which shifts the frequency: hence the spectral radius.
double measured_frequency(const std::string &fidelity, double youngs_modulus) {
  constexpr double squeeze = 1e-5; // keeps every joint closed
  constexpr double speed = 1e-4;   // m/s: motion of 1e-6 m
  constexpr double settled = 0.2;  // s
  const double shape = std::numbers::pi / (num_blocks + 1);
  std::string toml =
      head(bar_setting(fidelity, youngs_modulus, 0.8, 0.1, "safety = 0.25\nspectral_radius = 0.8\n"));
  for (int i = 0; i < num_blocks; ++i) {
    toml += block_toml(fmt::format("bar{}", i),
                       rectangle({i * (1.0 - squeeze), 0.0}, {i * (1.0 - squeeze) + 1.0, 1.0}),
                       fmt::format("velocity = [{:.17g}, 0.0, 0.0]", speed * std::sin(shape * (i + 1))));
  }
  const double right = num_blocks * (1.0 - squeeze);
  toml += abutment(-2.0, squeeze) + abutment(right, right + 2.0);
  Simulation simulation(Communicator::self(), scene_of(toml));
  const auto amplitude = [&] {
    double sum = 0.0;
    for (int i = 0; i < num_blocks; ++i) {
      sum += velocity_of(simulation, i).u.x * std::sin(shape * (i + 1));
    }
    return sum;
  };
  double before = amplitude();
  double first = 0.0;
  double last = 0.0;
  int crossings = 0;
  while (!simulation.finished()) {
    step(simulation);
    const double now = amplitude();
    if (simulation.time() > settled && (before > 0.0) != (now > 0.0)) {
      last = simulation.time() - simulation.plan().time_step * now / (now - before);
      first = crossings == 0 ? last : first;
      ++crossings;
    }
    before = now;
  }
  EXPECT_GE(crossings, 5);
  return std::numbers::pi * (crossings - 1) / (last - first);
}

// Against the eigenvalue of the discrete bar: the dashpots' share of the slow wave, about 1e-2 of critical,
// shifts it by the square of that, the time step by (omega dt)^2/24 = 3e-5, what breathing is left and the
// closure relative to the block by 1e-5 each: 3e-4 in all. Against the continuous bar, omega = pi c / length
// with c = sqrt(E_eff/rho): dispersion, (pi/n)^2/24 = 1.6e-3 at most, and one joint more than blocks, up to
// 1/(2n).
TEST(JointedBar, CarriesWavesAtTheSpeedOfTheEffectiveModulus) {
  for (const double ratio : {0.1, 1.0, 10.0}) {
    const double youngs_modulus = joint_stiffness / ratio;
    const double got = measured_frequency("deformable", youngs_modulus);
    expect_value(
        fmt::format("C3 wave in a jointed bar, k_n L/E = {}: frequency of the discrete bar, rad/s", ratio),
        jointed_bar_frequency(num_blocks, youngs_modulus, joint_stiffness), got, 3e-4);
    const double effective = 1.0 / (1.0 / youngs_modulus + 1.0 / joint_stiffness);
    // Half a block's worth of joint more at each end than a bar of n blocks with their joints.
    const double length = num_blocks + 1.0 / (1.0 + ratio);
    expect_value(fmt::format("C3 wave in a jointed bar, k_n L/E = {}: wave speed, m/s", ratio),
                 std::sqrt(effective / rock_density), got * length / std::numbers::pi, 5e-3);
  }
  const double rigid_got = measured_frequency("rigid", 0.0);
  const double rigid =
      2.0 * std::sqrt(joint_stiffness / rock_density) * std::sin(0.5 * std::numbers::pi / (num_blocks + 1));
  expect_value("C3 wave in a chain of rigid blocks: frequency, rad/s", rigid, rigid_got, 3e-4);
}

} // namespace
} // namespace gcpdda::testing::jointed_bar_test
