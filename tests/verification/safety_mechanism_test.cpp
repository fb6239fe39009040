// The factor of the first mechanism beside that of the first block: two blocks on two planes, whose limits
// are known.

#include "problem.hpp"
#include "safety_limits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace gcpdda::testing::safety_mechanism_test {
namespace {

constexpr double friction_deg = 40.0;
constexpr double steep_deg = 38.0; ///< of the plane of the small block, 1 m2
constexpr double flat_deg = 35.0;  ///< of that of the large block, 6 m2
const double factor_of_small = std::tan(friction_deg * degree) / std::tan(steep_deg * degree);
const double factor_of_large = std::tan(friction_deg * degree) / std::tan(flat_deg * degree);

/// A block of some width and a height of 1 m on a plane of its own, which falls to the right.
std::string block_on_plane(const std::string &name, Vec2 top, double dip_deg, double width) {
  const Rotation turn = Rotation::of(-dip_deg * degree);
  const auto at = [&](double x, double y) { return top + turn({x, y}); };
  return block_toml(name + "_plane", {at(-1.0, -1.0), at(30.0, -1.0), at(30.0, 0.0), at(-1.0, 0.0)},
                    "fixed = true") +
         block_toml(name, {at(0.0, 0.0), at(width, 0.0), at(width, 1.0), at(0.0, 1.0)});
}

SafetyReport search(const std::string &fos_keys, bool is_static) {
  const std::string toml = head({.friction_deg = friction_deg}) +
                           block_on_plane("small", {0.0, 0.0}, steep_deg, 1.0) +
                           block_on_plane("large", {60.0, 0.0}, flat_deg, 6.0);
  const Scene scene = scene_of(without_duration(toml) + "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n" +
                               (is_static ? "solver = \"static\"\n" : "solver = \"dynamic\"\n") +
                               "[fos]\nfrom = 1.0\nto = 1.5\n" + fos_keys);
  const SafetyOutcome outcome = search_quietly(scene);
  EXPECT_EQ(outcome.exit_code, exit_code::done) << outcome.message;
  return outcome.report;
}

template <class Bracket> double middle_of(const Bracket &bracket) {
  EXPECT_TRUE(bracket.holds && bracket.fails);
  return 0.5 * (bracket.holds.value_or(0.0) + bracket.fails.value_or(0.0));
}

// Brackets of 1 %; the two limits are 11 % apart.
TEST(SafetyMechanism, ASmallBlockDoesNotGovernTheFactor) {
  ASSERT_GT(factor_of_large, 1.1 * factor_of_small);
  for (const bool is_static : {false, true}) {
    const std::string solver = is_static ? "static" : "dynamic";
    const SafetyReport plain = search("", is_static);
    EXPECT_FALSE(plain.first_block);
    expect_value("factor of the first block, " + solver, factor_of_small, middle_of(plain), 0.01);

    const SafetyReport of_area = search("ignore_area = 2.0\n", is_static);
    expect_value("factor of the first mechanism above 2 m2, " + solver, factor_of_large, middle_of(of_area),
                 0.01);
    ASSERT_TRUE(of_area.first_block);
    expect_value("factor of the first block beside it, " + solver, factor_of_small,
                 middle_of(*of_area.first_block), 0.01);

    const SafetyReport in_region = search("region = [[50, -40], [90, -40], [90, 10], [50, 10]]\n", is_static);
    expect_value("factor of the watched region, " + solver, factor_of_large, middle_of(in_region), 0.01);
  }
}

// A bound without trials knows no mechanism, and says so.
TEST(SafetyMechanism, ABoundIsThatOfAnyBlock) {
  const std::string toml = head({.friction_deg = friction_deg}) +
                           block_on_plane("small", {0.0, 0.0}, steep_deg, 1.0) +
                           block_on_plane("large", {60.0, 0.0}, flat_deg, 6.0);
  const SafetyOutcome outcome =
      search_quietly(scene_of(without_duration(toml) +
                              "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n[fos]\nignore_area = 2.0\n"),
                     true);
  expect_value("bound of two blocks on two planes", factor_of_small, outcome.report.bound.value_or(0.0),
               3e-3);
  const std::string text = to_text(outcome.report);
  EXPECT_NE(text.find("the bound is that of any block"), std::string::npos) << text;
  EXPECT_EQ(text.find("none fails at any factor tried"), std::string::npos) << text;
}

// What is larger than the area to ignore governs as before.
TEST(SafetyMechanism, ALargerBlockDoes) {
  expect_value("factor of the first mechanism above 0.5 m2", factor_of_small,
               middle_of(search("ignore_area = 0.5\n", false)), 0.01);
}

} // namespace
} // namespace gcpdda::testing::safety_mechanism_test
