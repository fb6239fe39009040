// C7: a column cut by parallel joints in uniaxial compression.
//
// The joints dip at b, s apart along their normal. Under the stress sigma along the column a joint bears
// sigma cos^2 b across and sigma sin b cos b along itself. It closes by the first over k_n and slips by the
// second over k_s; along the column that is sigma (cos^3 b/k_n + sin^2 b cos b/k_s), once every s/cos b:
//     1/E_b = 1/E + cos^4 b/(k_n s) + sin^2 b cos^2 b/(k_s s)
// (classical: strains of rock and joints add; Goodman, Introduction to Rock Mechanics, 2nd edition, 1989).
// The joints shift the column sideways as well, hence one plate without friction. The stress is uniform and
// the blocks strain alike, so that rigid and deformable blocks, which have no bending, give this exactly.
//
// The column starts in equilibrium under an in-situ stress. The top plate then goes down at a steady speed,
// which adds as much, and every block starts with the velocity of the exact solution. E_b is the slope of the
// stress over the strain in the second half of the run: what is constant, such as the force of the dashpots,
// drops out.
//
// Truncation: closures over the length of a joint are 1e-6. Deformable blocks start without the strain rate
// of the exact solution and ring: a few 1e-4 are left. Without the stress at the start that would open steep
// joints, which then have lost their shear.

#include "problem.hpp"

#include "geometry/polygon.hpp"
#include "support/contact_regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::jointed_column_test {
namespace {

constexpr int num_joints = 5;
constexpr double width = 1.0;           ///< m
constexpr double spacing = 0.4;         ///< s, m
constexpr double joint_stiffness = 1e9; ///< k_n, Pa/m
constexpr double tangential_ratio = 0.4;
constexpr double largest_strain = 1e-6; ///< of rock or joints over their spacing
constexpr double damping = 0.3;         ///< takes the ringing

struct Column {
  double angle = 0.0;          ///< b
  double youngs_modulus = 0.0; ///< 0: rigid blocks

  [[nodiscard]] double pitch() const { return spacing / std::cos(angle); } ///< between joints along y
  /// Half of what a joint rises across the column.
  [[nodiscard]] double half_rise() const { return 0.5 * width * std::tan(angle); }
  [[nodiscard]] double end() const { return half_rise() + 0.5 * pitch(); } ///< of an end block, mid height
  [[nodiscard]] double height() const { return 2.0 * end() + (num_joints - 1) * pitch(); }
  [[nodiscard]] double rock_compliance() const { return youngs_modulus > 0.0 ? 1.0 / youngs_modulus : 0.0; }

  /// What a unit of stress moves the rock above a joint against that below.
  [[nodiscard]] Vec2 jump() const {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return (-c * c / joint_stiffness) * Vec2{-s, c} -
           (s * c / (tangential_ratio * joint_stiffness)) * Vec2{c, s};
  }
  [[nodiscard]] double compliance() const {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return rock_compliance() + std::pow(c, 4) / (joint_stiffness * spacing) +
           s * s * c * c / (tangential_ratio * joint_stiffness * spacing);
  }
  [[nodiscard]] double largest_stress() const {
    return largest_strain * (youngs_modulus > 0.0 ? std::min(youngs_modulus, joint_stiffness * spacing)
                                                  : joint_stiffness * spacing);
  }
  /// Sixteen times up and down the column at the speed of its waves.
  [[nodiscard]] double duration() const { return 32.0 * height() * std::sqrt(rock_density * compliance()); }

  /// Block k of num_joints + 1, from below.
  [[nodiscard]] std::vector<Vec2> outline(int k) const {
    const auto joint = [&](int j) { return end() + j * pitch(); };
    const bool is_first = k == 0;
    const bool is_last = k == num_joints;
    const double low = is_first ? 0.0 : joint(k - 1);
    const double high = is_last ? height() : joint(k);
    return {{0.0, is_first ? low : low - half_rise()},
            {width, is_first ? low : low + half_rise()},
            {width, is_last ? high : high + half_rise()},
            {0.0, is_last ? high : high - half_rise()}};
  }
  /// Displacement of its centroid by a unit of stress.
  [[nodiscard]] Vec2 moved(int k) const {
    const Vec2 centroid = polygon_moments(outline(k)).centroid;
    return static_cast<double>(k) * jump() +
           Vec2{poissons_ratio * rock_compliance() * (centroid.x - 0.5 * width),
                -1.0 / joint_stiffness - rock_compliance() * centroid.y};
  }
  static constexpr double poissons_ratio = 0.25;

  [[nodiscard]] std::string toml() const {
    Setting setting{.duration = duration(),
                    .gravity = {},
                    .normal_stiffness = joint_stiffness,
                    .friction_deg = 80.0,
                    .damping = damping,
                    .run_keys = "plane = \"stress\"\n",
                    .fidelity = youngs_modulus > 0.0 ? "deformable" : "rigid",
                    .youngs_modulus = youngs_modulus,
                    .poissons_ratio = poissons_ratio};
    std::string toml = head(setting);
    toml.insert(toml.find("friction_angle_deg"), fmt::format("tangential_ratio = {}\n", tangential_ratio));
    toml += fmt::format("[material.plate]\ndensity = {}\n[joint.smooth]\nmaterials = [\"rock\", \"plate\"]\n"
                        "friction_angle_deg = 0.0\n",
                        rock_density);
    toml += fmt::format("[in_situ]\nvertical_stress = {:.17g}\nk0 = 0.0\n", largest_stress());
    const double rate = largest_stress() / duration(); // Pa/s
    for (int k = 0; k <= num_joints; ++k) {
      const Vec2 v = rate * moved(k);
      toml += block_toml(fmt::format("block{}", k), outline(k),
                         fmt::format("velocity = [{:.17g}, {:.17g}, 0.0]", v.x, v.y));
    }
    toml += block_toml("bottom", rectangle({-2.0, -1.0}, {2.0 + width, 0.0}), "fixed = true");
    const double down = num_joints * jump().y - 2.0 / joint_stiffness - rock_compliance() * height();
    std::string plate = block_toml(
        "top", rectangle({-2.0, height()}, {2.0 + width, height() + 1.0}),
        fmt::format("fidelity = \"rigid\"\nprescribed_velocity = [0.0, {:.17g}, 0.0]", rate * down));
    return toml + plate.replace(plate.find("\"rock\""), 6, "\"plate\"");
  }
};

/// Stress at the top and strain between the second block and the last but one.
struct State {
  double stress = 0.0;
  double strain = 0.0;
};

State state_of(Simulation &simulation, const Column &column) {
  State state;
  const std::size_t top = row_of(simulation, num_joints + 2);
  for (const RegionForce &force : regions_of(simulation)) {
    const CandidatePair &pair = simulation.candidates().pairs[force.pair];
    if (pair.lower.value == top || pair.higher.value == top) {
      state.stress += std::abs(force.force.y) / width;
    }
  }
  state.strain = (displacement_of(simulation, 1).u.y - displacement_of(simulation, num_joints - 1).u.y) /
                 ((num_joints - 2) * column.pitch());
  return state;
}

double measured_modulus(const Column &column) {
  Simulation simulation(Communicator::self(), scene_of(column.toml()));
  run_until(simulation, 0.5 * column.duration());
  const State half = state_of(simulation, column);
  run(simulation);
  const State full = state_of(simulation, column);
  return (full.stress - half.stress) / (full.strain - half.strain);
}

TEST(JointedColumn, CompressesByBlocksAndInclinedJoints) {
  for (const double degrees : {0.0, 30.0, 45.0, 60.0, 75.0}) {
    for (const double ratio : {0.0, 0.2, 1.0, 5.0}) { // k_n s/E; 0: rigid
      const Column column{degrees * degree, ratio > 0.0 ? joint_stiffness * spacing / ratio : 0.0};
      expect_value(fmt::format("C7 jointed column, joints at {} degrees, {}: modulus, Pa", degrees,
                               ratio > 0.0 ? fmt::format("deformable, k_n s/E = {}", ratio) : "rigid"),
                   1.0 / column.compliance(), measured_modulus(column), ratio > 0.0 ? 5e-4 : 5e-5);
    }
  }
}

} // namespace
} // namespace gcpdda::testing::jointed_column_test
