// Water in joints presses on both of their faces, whichever block names the law of the joint.

#include "geometry/polygon.hpp"
#include "problem.hpp"
#include "support/contact_regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace gcpdda::testing::water_joints_test {
namespace {

constexpr double unit_weight = 1000.0 * earth_gravity;
constexpr double rock_weight = rock_density * earth_gravity;

enum class Named { upper, lower, both, by_materials, by_default };
constexpr std::array all_names{Named::upper, Named::lower, Named::both, Named::by_materials,
                               Named::by_default};
constexpr std::array both_fidelities{"rigid", "deformable"};

std::string settle(const std::string &more = "") {
  return "[[stage]]\nkind = \"settle\"\nlimit = 20.0\n" + more;
}

/// Floor, lower and upper block, with their names, as blocks 0, 1 and 2.
struct Stack {
  Named named = Named::both;
  std::string fidelity = "rigid";
  double sign = 1.0;             ///< -1: mirrored in x = 0
  bool upper_is_half = false;    ///< a further block, 3, stands on the other half of the lower one
  std::string of_lower{};        ///< more keys of the lower block
  std::string stages = settle(); ///< after which the forces are asked

  /// A rectangle, whose mirror image keeps its edges in their order: bottom, right, top, left.
  [[nodiscard]] std::vector<Vec2> box(Vec2 low, Vec2 high) const {
    return sign > 0.0 ? rectangle(low, high) : rectangle({-high.x, low.y}, {-low.x, high.y});
  }
  [[nodiscard]] std::string block(const std::string &name, const std::vector<Vec2> &vertices,
                                  const std::string &edge, const std::string &more) const {
    const std::string names = edge == "top"      ? "edge_joints = [\"\", \"\", \"seam\", \"\"]\n"
                              : edge == "bottom" ? "edge_joints = [\"seam\", \"\", \"\", \"\"]\n"
                                                 : "";
    return block_toml(name, vertices, names + more);
  }
  [[nodiscard]] std::string toml() const {
    const bool by_edges = named == Named::upper || named == Named::lower || named == Named::both;
    std::string text = without_duration(head({.normal_stiffness = 5e9,
                                              .friction_deg = 40.0,
                                              .fidelity = fidelity,
                                              .youngs_modulus = 5e10,
                                              .poissons_ratio = 0.25}));
    text += fmt::format("[material.ore]\ndensity = {:.17g}\nyoungs_modulus = 5e10\npoissons_ratio = 0.25\n",
                        rock_density);
    text += "[joint.floor]\nmaterials = [\"ore\", \"clay\"]\n[material.clay]\ndensity = 2000.0\n";
    if (by_edges) {
      text += "[joint.seam]\nfriction_angle_deg = 30.0\n";
    } else if (named == Named::by_materials) {
      text += "[joint.seam]\nfriction_angle_deg = 30.0\nmaterials = [\"rock\", \"ore\"]\n";
    }
    text += fmt::format("[water.seam]\njoints = [\"{}\"]\nphreatic = [[{}, {}], [{}, {}]]\n",
                        named == Named::by_default ? "default" : "seam", -10.0, sign > 0.0 ? 7.0 : 9.0, 10.0,
                        sign > 0.0 ? 9.0 : 7.0);
    text += block_toml("floor", rectangle({-60.0, -5.0}, {60.0, 0.0}), "fixed = true\n");
    text.replace(text.rfind("\"rock\""), 6, "\"clay\"");
    text += block("lower", box({-5.0, 0.0}, {5.0, 3.0}),
                  named == Named::lower || named == Named::both ? "top" : "", of_lower);
    text.replace(text.rfind("\"rock\""), 6, "\"ore\"");
    const double end = upper_is_half ? 0.0 : 5.0;
    text += block("upper", box({-5.0, 3.0}, {end, 6.0}),
                  named == Named::upper || named == Named::both ? "bottom" : "", "");
    if (upper_is_half) {
      text += block("beside", box({0.0, 3.0}, {5.0, 6.0}), "", "");
    }
    return text + stages;
  }
};

/// Sum of the normal forces between two blocks, N/m.
double normal_between(Simulation &simulation, std::int64_t lower, std::int64_t higher) {
  const Regions regions(simulation);
  double sum = 0.0;
  for (std::size_t k = 0; k < simulation.candidates().pairs.size(); ++k) {
    const CandidatePair &pair = simulation.candidates().pairs[k];
    if (simulation.blocks().properties[pair.lower.value].id.value == lower &&
        simulation.blocks().properties[pair.higher.value].id.value == higher) {
      for (const RegionForce &force : regions.of_pair(k)) {
        sum += force.normal_force;
      }
    }
  }
  return sum;
}

std::unique_ptr<Simulation> settled(const std::string &toml) {
  auto simulation = std::make_unique<Simulation>(Communicator::self(), scene_of(toml));
  run_stages(*simulation, step);
  return simulation;
}

// The floor carries the whole weight, since the water in the joint is held by both blocks; the joint carries
// the weight of the upper block less the uplift.
TEST(WaterJoints, FloorCarriesTheWholeWeightWhicheverBlockNamesTheJoint) {
  const double weight = 30.0 * rock_weight;
  const double uplift = 10.0 * 5.0 * unit_weight; // of a line that is 8 m high in the middle
  for (const Named named : all_names) {
    for (const std::string fidelity : both_fidelities) {
      for (const double sign : {1.0, -1.0}) {
        SCOPED_TRACE(fmt::format("named {}, {}, {}", static_cast<int>(named), fidelity, sign));
        const auto simulation = settled(Stack{.named = named, .fidelity = fidelity, .sign = sign}.toml());
        EXPECT_NEAR(normal_between(*simulation, 0, 1) / (2.0 * weight), 1.0, 1e-4);
        // Blocks that deform sink by 1e-4 m, and rock that tilts under a slanted line has another depth.
        EXPECT_NEAR(normal_between(*simulation, 1, 2) / (weight - uplift), 1.0, 1e-3);
      }
    }
  }
}

// Two blocks on a long one, of which one names the joint: the water presses on its half.
TEST(WaterJoints, OnlyTheStretchThatFacesTheJointIsWet) {
  const double weight = 30.0 * rock_weight;
  for (const std::string fidelity : both_fidelities) {
    for (const double sign : {1.0, -1.0}) {
      SCOPED_TRACE(fmt::format("{}, {}", fidelity, sign));
      const auto simulation = settled(
          Stack{.named = Named::upper, .fidelity = fidelity, .sign = sign, .upper_is_half = true}.toml());
      const double head = 4.75; // below the middle of the half, where the line is 7.75 m high
      EXPECT_NEAR(normal_between(*simulation, 0, 1) / (2.0 * weight), 1.0, 1e-4);
      const double on_upper = 0.5 * weight - 5.0 * head * unit_weight;
      EXPECT_NEAR(normal_between(*simulation, 1, 2) / on_upper, 1.0, 2e-3);
      EXPECT_NEAR(normal_between(*simulation, 1, 3) / (0.5 * weight), 1.0, 1e-3);
    }
  }
}

// A block that is fixed at the start knows its joints when a stage sets it free.
TEST(WaterJoints, BlockThatIsSetFreeHasWaterInItsJoints) {
  for (const Named named : {Named::upper, Named::lower}) {
    const std::string free_it = settle("set = { \"block.lower.fixed\" = false }\n");
    const auto simulation =
        settled(Stack{.named = named, .of_lower = "fixed = true\n", .stages = settle() + free_it}.toml());
    EXPECT_NEAR(normal_between(*simulation, 0, 1) / (60.0 * rock_weight), 1.0, 1e-4);
  }
}

// A slide on a plane of 35 degrees: F = (W cos - U) tan(45)/(W sin) of the settled forces.
TEST(WaterJoints, FactorOfASlideDoesNotHangOnTheBlockThatNamesThePlane) {
  const double dip = 35.0 * degree;
  const Vec2 crest{16.5470054, 16.5470054 * std::tan(dip)};
  const Vec2 end = 1.1 * crest; // of the plane, behind the slide
  const double top = 20.0;
  const std::vector<Vec2> slide{{0.0, 0.0}, crest, {crest.x, top}, {11.5470054, top}};
  const double weight = rock_weight * signed_area(slide);
  const double half_full = 0.5 * (top - crest.y);
  const double uplift = 0.5 * unit_weight * half_full * norm(crest);
  const double expected = (weight * std::cos(dip) - uplift) / (weight * std::sin(dip));
  for (const bool base_names_it : {false, true}) {
    const std::string text =
        without_duration(head({.normal_stiffness = 1e9, .friction_deg = 45.0})) +
        "[joint.seam]\nfriction_angle_deg = 45.0\n" +
        fmt::format("[water.w]\njoints = [\"seam\"]\nphreatic = [[0, 0], [{:.17g}, {:.17g}]]\n", crest.x,
                    crest.y + half_full) +
        block_toml("base",
                   {{-40.0, -40.0 * std::tan(dip)}, {-40.0, -48.0}, {36.0, -48.0}, {36.0, end.y}, end},
                   std::string("fixed = true\n") +
                       (base_names_it ? "edge_joints = [\"\", \"\", \"\", \"\", \"seam\"]\n" : "")) +
        block_toml("slide", slide, base_names_it ? "" : "edge_joints = [\"seam\", \"\", \"\", \"\"]\n") +
        settle();
    const auto simulation = settled(text);
    const std::vector<RegionForce> regions = regions_of(*simulation);
    ASSERT_EQ(regions.size(), 1U);
    const double factor = regions[0].normal_force / norm(regions[0].shear_force);
    EXPECT_NEAR(factor, expected, 1e-3 * expected) << base_names_it;
    EXPECT_NEAR(expected, 1.1899, 1e-3);
  }
}

} // namespace
} // namespace gcpdda::testing::water_joints_test
