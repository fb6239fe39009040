// Factors of safety by strength reduction against limit equilibrium.

#include "problem.hpp"

#include "blockgen/region_cutter.hpp"
#include "driver/safety_factor.hpp"
#include "support/plane_failure.hpp"
#include "support/run_facts.hpp"
#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>

namespace gcpdda::testing::safety_factor_test {
namespace {

struct Found {
  int exit_code = 0;
  double holds = 0.0;
  double fails = 0.0;
  std::string text; ///< for people

  explicit Found(const std::string &toml) : Found(scene_of(toml)) {}
  explicit Found(const Scene &scene) {
    const TemporaryFolder folder;
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const std::filesystem::path result = folder.path() / "fos";
    exit_code = find_safety_factor(Communicator::self(), scene, {result, false});
    ::testing::internal::GetCapturedStderr();
    text = ::testing::internal::GetCapturedStdout();
    if (std::filesystem::exists(result / "fos.json")) {
      holds = std::atof(json_value(result / "fos.json", "holds").c_str());
      fails = std::atof(json_value(result / "fos.json", "fails").c_str());
    }
  }
  [[nodiscard]] double factor() const { return 0.5 * (holds + fails); }
};

// The bracket is 0.4 % wide; below 1e-3 of it a block slides so slowly that its limit could end first.
TEST(SafetyFactor, OfPlaneFailure) {
  for (const double from_cohesion : {0.0, 0.5}) {
    const Found found(plane_failure_toml(from_cohesion));
    const std::string problem =
        fmt::format("factor of safety, plane failure, {} of it by cohesion", from_cohesion);
    expect_value(problem, plane_failure_factor(from_cohesion), found.factor(), 0.004);
    EXPECT_EQ(found.exit_code, 0) << found.text;
    EXPECT_NE(found.text.find("1 of 1 blocks move"), std::string::npos) << found.text;
  }
}

// A slender block glued to its base at 25 degrees. Friction alone has no part in toppling, b/(h tan(th)) is
// geometry: what is divided here is the strength of the bond, which fails first where the joint opens,
//     sigma = 6 W sin(th) (h/2)/b^2 - W cos(th)/b.
// Truncation: the overlap's pressure is linear up to half its depth over the width, 3e-4.
TEST(SafetyFactor, OfAGluedBlockThatTopples) {
  const double slope = 25.0 * degree;
  const Vec2 size{1.0, 3.0};
  const double weight = rock_density * earth_gravity * size.x * size.y;
  const double pull =
      6.0 * weight * std::sin(slope) * 0.5 * size.y / (size.x * size.x) - weight * std::cos(slope) / size.x;
  const std::string toml = fmt::format(R"([run]
fidelity = "rigid"
gravity = [{:.17g}, {:.17g}]
gravity_ramp = 0.5
[material.rock]
density = {}
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 30.0
cohesion = 2e6
tension = {:.17g}
[[stage]]
kind = "settle"
limit = 10.0
[fos]
tolerance = 0.004
limit = 20.0
)",
                                       earth_gravity * std::sin(slope), -earth_gravity * std::cos(slope),
                                       rock_density, 2.2 * pull) +
                           block_toml("slope", rectangle({-2.0, -1.0}, {20.0, 0.0}), "fixed = true") +
                           block_toml("column", rectangle({0.0, 0.0}, size));
  const Found found(toml);
  expect_value("factor of safety, glued column that topples", 2.2, found.factor(), 0.006);
  EXPECT_EQ(found.exit_code, 0) << found.text;
}

// The mass slides on its bedding whatever its blocks are made of. The bracket is 0.01 wide.
TEST(SafetyFactor, OfASlopeOfBlocksThatDeform) {
  for (const char *modulus : {"2e9", "30e9"}) {
    Scene scene = shipped_scene("deformable_slope", {std::string("material.rock.youngs_modulus=") + modulus,
                                                     "fos.from=1.2", "fos.to=1.4"});
    scene.region_blocks = std::make_shared<RegionCutter>(scene);
    const Found found(scene);
    expect_value(std::string("factor of safety, deformable slope, E = ") + modulus + " Pa",
                 std::tan(42.0 * degree) / std::tan(35.0 * degree), found.factor(), 0.0075);
    EXPECT_EQ(found.exit_code, 0) << found.text;
  }
}

// One that stands whatever the friction, in the range asked for.
TEST(SafetyFactor, SaysWhereNothingFails) {
  std::string toml = plane_failure_toml(0.0);
  toml.replace(toml.find("tolerance"), 0, "from = 0.5\nto = 1.2\n");
  const Found found(toml);
  EXPECT_EQ(found.exit_code, 7);
  EXPECT_NE(found.text.find("still hold at 1.2"), std::string::npos) << found.text;
}

// One that slides with its own strength settles with more, and has a factor below 1; the bracket is 5 % wide.
TEST(SafetyFactor, OfASlopeThatDoesNotStand) {
  std::string toml = plane_failure_toml(0.0);
  toml.replace(toml.find("friction_angle_deg = 40.0"), 25, "friction_angle_deg = 25.0");
  toml.replace(toml.find("tolerance = 0.004"), 17, "tolerance = 0.05\nfrom = 0.6\nto = 1.0");
  const Found found(toml);
  EXPECT_EQ(found.exit_code, 0);
  expect_value("factor of safety, plane failure that does not stand",
               std::tan(25.0 * degree) / std::tan(30.0 * degree), found.factor(), 0.035);
  EXPECT_NE(found.text.find("settled state with strengths divided by 0.6"), std::string::npos) << found.text;
}

// A limit too short for a verdict near the factor, without patience: the bracket says so.
TEST(SafetyFactor, KeepsUndecidedTrialsInTheBracket) {
  std::string toml = plane_failure_toml(0.0);
  toml.replace(toml.find("limit = 30.0"), 12, "limit = 0.35\npatience = 0");
  toml.replace(toml.find("limit = 10.0"), 12, "limit = 10.0\nsolver = \"dynamic\"");
  toml.replace(toml.find("tolerance = 0.004"), 17, "tolerance = 0.05");
  const Found found(toml);
  EXPECT_EQ(found.exit_code, 7);
  EXPECT_NE(found.text.find("undecided in the limit"), std::string::npos) << found.text;
  EXPECT_LT(found.holds, plane_failure_factor(0.0));
  EXPECT_GT(found.fails, plane_failure_factor(0.0));
}

// The same limit with the patience of the default: trials without a verdict go on without local damping.
TEST(SafetyFactor, GoesOnWithUndecidedTrialsWithoutDrag) {
  std::string toml = plane_failure_toml(0.0);
  toml.replace(toml.find("limit = 30.0"), 12, "limit = 0.7");
  toml.replace(toml.find("limit = 10.0"), 12, "limit = 10.0\nsolver = \"dynamic\"");
  toml.replace(toml.find("tolerance = 0.004"), 17, "tolerance = 0.01");
  const Found found(toml);
  EXPECT_EQ(found.exit_code, 0);
  EXPECT_NE(found.text.find("dynamic step without damping"), std::string::npos) << found.text;
  expect_value("factor of safety, plane failure, limit of 0.7 s", plane_failure_factor(0.0), found.factor(),
               0.01);
}

} // namespace
} // namespace gcpdda::testing::safety_factor_test
