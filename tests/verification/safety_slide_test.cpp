// Blocks that slide to where they hold have not failed, unless fos.largest_motion says so.

#include "problem.hpp"
#include "safety_limits.hpp"

#include "driver/safety_search.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace gcpdda::testing::safety_slide_test {
namespace {

double middle_of(const SafetyReport &report) {
  EXPECT_TRUE(report.holds && report.fails);
  return 0.5 * (report.holds.value_or(0.0) + report.fails.value_or(0.0));
}

// A dam of 10 x 10 m on level rock, the water 8 m high behind it. The phreatic line falls to the ground
// within the dam: a triangle of pressure on its back and one under it. The dam is held by friction and
// cohesion of its base.
constexpr double side = 10.0;
constexpr double water_height = 8.0;
constexpr double friction_deg = 25.0;
constexpr double cohesion = 5e4;

std::string dam(const std::string &fidelity, const std::string &solver, const std::string &fos_keys) {
  return fmt::format(R"(
[run]
fidelity = "{}"
[material.rock]
density = 2400.0
youngs_modulus = 25e9
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 5e9
friction_angle_deg = {}
cohesion = {}
[water.lake]
phreatic = [[-50, {}], [0, {}], [{}, 0], [50, 0]]
active = false
[[block]]
material = "rock"
fixed = true
vertices = [[-30, -5], [50, -5], [50, 0], [-30, 0]]
[[block]]
name = "dam"
material = "rock"
vertices = [[0, 0], [{}, 0], [{}, {}], [0, {}]]
[[stage]]
name = "weight"
kind = "settle"
limit = 20.0
[[stage]]
name = "filling"
kind = "settle"
limit = 20.0
solver = "{}"
set = {{ "water.lake.active" = true }}
[fos]
{}
)",
                     fidelity, friction_deg, cohesion, water_height, water_height, side, side, side, side,
                     side, solver, fos_keys);
}

double factor_of_dam() {
  constexpr double g = 9.81;
  constexpr double water = 1000.0 * g;
  const double push = 0.5 * water * water_height * water_height;
  const double uplift = 0.5 * water * water_height * side;
  const double weight = 2400.0 * g * side * side;
  return (cohesion * side + (weight - uplift) * std::tan(friction_deg * degree)) / push;
}

// By a thousandth of its size the dam slides 0.3 % beyond its limit. Brackets of 1 %.
TEST(SafetySlides, ADamThatSlidesToWhereItHoldsFailsWhereItBeginsTo) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    for (const std::string solver : {"static", "dynamic"}) {
      const SafetyOutcome found =
          search_quietly(scene_of(dam(fidelity, solver, "to = 6.0\nlargest_motion = 0.001\n")));
      EXPECT_EQ(found.exit_code, exit_code::done) << found.message;
      expect_value(fmt::format("sliding of a gravity dam, {}, {} solver", fidelity, solver), factor_of_dam(),
                   middle_of(found.report), 0.01);
    }
  }
}

// Nor does the key matter: a dam that slides keeps the water that pressed it where it stood.
TEST(SafetySlides, ADamKeepsItsWater) {
  for (const std::string fidelity : {"rigid", "deformable"}) {
    for (const std::string solver : {"static", "dynamic"}) {
      const SafetyOutcome found = search_quietly(scene_of(dam(fidelity, solver, "to = 6.0\n")));
      EXPECT_NEAR(middle_of(found.report), factor_of_dam(), 0.01 * factor_of_dam()) << fidelity << solver;
    }
  }
}

// A stage that confirms a trial has the water of the trial: the dam has slid to a stop in it, with the whole
// lake behind it.
TEST(SafetySlides, AConfirmationHasTheWaterOfItsTrial) {
  std::string toml = dam("rigid", "static", "");
  const std::string filled = "\"water.lake.active\" = true";
  toml.replace(toml.find(filled), filled.size(),
               filled + ", \"joint.default.friction_angle_deg\" = 5.0, \"joint.default.cohesion\" = 0.0");
  toml.insert(toml.find("[[stage]]"),
              block_toml("stop", rectangle({side + 0.5, 0.1}, {side + 2.0, 4.0}), "fixed = true"));
  Simulation simulation(Communicator::self(), with_confirming_stage(scene_of(toml), Verdict::settled));
  run_stages(simulation, step);
  ASSERT_EQ(simulation.stage_results().size(), 3U);
  EXPECT_GT(simulation.stage_results()[1].slide_distance, 0.49);
  EXPECT_EQ(simulation.stage_results()[2].verdict, Verdict::settled);
  const double push = 0.5 * 1000.0 * 9.81 * water_height * water_height;
  const AppliedForces *on_dam = simulation.blocks().applied_to(0);
  ASSERT_NE(on_dam, nullptr);
  EXPECT_NEAR(on_dam->load.u.x, push, 1e-4 * push) << "it has settled by 5e-5 m";
}

constexpr double joint_friction_deg = 40.0;
constexpr double steep_deg = 38.0; ///< of the plane of the small block, 1 m2
constexpr double flat_deg = 35.0;  ///< of that of the large block, 6 m2
constexpr double way = 0.08;       ///< m that each slides until a stop holds it

std::string block_before_a_stop(const std::string &name, Vec2 top, double dip_deg, double width) {
  const Rotation turn = Rotation::of(-dip_deg * degree);
  const auto at = [&](double x, double y) { return top + turn({x, y}); };
  return block_toml(name + "_plane", {at(-1.0, -1.0), at(30.0, -1.0), at(30.0, 0.0), at(-1.0, 0.0)},
                    "fixed = true") +
         block_toml(name + "_stop",
                    {at(width + way, 0.05), at(width + way + 1.0, 0.05), at(width + way + 1.0, 1.0),
                     at(width + way, 1.0)},
                    "fixed = true") +
         block_toml(name, {at(0.0, 0.0), at(width, 0.0), at(width, 1.0), at(0.0, 1.0)});
}

SafetyReport search_before_stops(const std::string &fos_keys) {
  const std::string toml = head({.friction_deg = joint_friction_deg}) +
                           block_before_a_stop("small", {0.0, 0.0}, steep_deg, 1.0) +
                           block_before_a_stop("large", {60.0, 0.0}, flat_deg, 6.0);
  const SafetyOutcome outcome =
      search_quietly(scene_of(without_duration(toml) + "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n[fos]\n" +
                              "from = 1.0\nto = 1.5\n" + fos_keys));
  EXPECT_TRUE(outcome.report.undecided.empty()) << outcome.message;
  return outcome.report;
}

// Without a limit they have not failed: the report says from where on they slide by what counts for failure.
TEST(SafetySlides, WithoutALimitTheReportSaysWhereBlocksSlide) {
  const SafetyReport report = search_before_stops("failure_motion = 0.07\n");
  EXPECT_EQ(report.holds, 1.5);
  EXPECT_FALSE(report.fails);
  ASSERT_TRUE(report.first_slide);
  EXPECT_GT(report.first_slide->factor, std::tan(joint_friction_deg * degree) / std::tan(steep_deg * degree));
  EXPECT_GE(report.first_slide->moved, 0.07);
  EXPECT_NE(to_text(report).find("blocks slide to where they hold"), std::string::npos);
}

// The slide of the small block is 0.08 of its size, that of the large one 0.03: both are told of, with less
// than failure_motion.
TEST(SafetySlides, TheReportWarnsOfSlidesFarBelowFailures) {
  const SafetyReport report = search_before_stops("");
  ASSERT_TRUE(report.first_slide);
  const double limit = std::tan(joint_friction_deg * degree) / std::tan(steep_deg * degree);
  EXPECT_GT(report.first_slide->factor, limit);
  EXPECT_LT(report.first_slide->moved, 0.09);
  EXPECT_NE(to_text(report).find("warning: at "), std::string::npos);
}

// Nothing fails while blocks find hold; the small block governs where each block counts, the large one where
// areas or places are asked for.
TEST(SafetySlides, AreasAndRegionsCountAsInFailures) {
  const double factor_of_small = std::tan(joint_friction_deg * degree) / std::tan(steep_deg * degree);
  const double factor_of_large = std::tan(joint_friction_deg * degree) / std::tan(flat_deg * degree);
  EXPECT_FALSE(search_before_stops("").fails);
  const std::string largest = "largest_motion = 0.02\n"; // 0.02 m and 0.05 m
  expect_value("factor of a block that slides to a stop", factor_of_small,
               middle_of(search_before_stops(largest)), 0.01);
  for (const std::string watched :
       {"ignore_area = 2.0\n", "region = [[50, -40], [90, -40], [90, 10], [50, 10]]\n"}) {
    const SafetyReport report = search_before_stops(largest + watched);
    const std::string by = watched.substr(0, watched.find(' '));
    expect_value("factor of the first mechanism that slides to a stop, " + by, factor_of_large,
                 middle_of(report), 0.01);
    ASSERT_TRUE(report.first_block && report.first_block->holds && report.first_block->fails);
    expect_value("factor of the first block beside it that does, " + by, factor_of_small,
                 0.5 * (*report.first_block->holds + *report.first_block->fails), 0.01);
  }
}

/// A block on a plane of 45 degrees with a friction angle of 20, so far above a wall.
std::string block_above_wall(double gap, const std::string &fos_keys) {
  const Rotation turn = Rotation::of(-45.0 * degree);
  const auto at = [&](double x, double y) { return turn(Vec2{x, y}); };
  return without_duration(head({.friction_deg = 20.0})) +
         block_toml("plane", {at(-5.0, -1.0), at(20.0, -1.0), at(20.0, 0.0), at(-5.0, 0.0)}, "fixed = true") +
         block_toml("wall", {at(4.0 + gap, 0.1), at(6.0 + gap, 0.1), at(6.0 + gap, 2.0), at(4.0 + gap, 2.0)},
                    "fixed = true") +
         block_toml("block", {at(0.0, 0.0), at(4.0, 0.0), at(4.0, 2.0), at(0.0, 2.0)}) +
         "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 20.0\n[fos]\n" + fos_keys;
}

// The block slides to the wall before the search begins, and holds there with any strength.
TEST(SafetySlides, TheReportTellsOfSlidesBeforeTheSearch) {
  const Scene scene = scene_of(block_above_wall(0.5, ""));
  for (const bool only_bound : {false, true}) {
    const SafetyReport report = search_quietly(scene, only_bound).report;
    ASSERT_EQ(report.earlier_slides.size(), 1U);
    const EarlierSlide &slide = report.earlier_slides[0];
    EXPECT_EQ(slide.stage, "weight");
    EXPECT_EQ(slide.block, "block");
    EXPECT_EQ(slide.blocks, 1);
    EXPECT_NEAR(slide.distance, 0.5, 0.01 * 0.5);
    ASSERT_TRUE(report.first_slide);
    EXPECT_EQ(report.first_slide->factor, 1.0);
    EXPECT_EQ(report.first_slide->moved, slide.share);
    const std::string text = to_text(report);
    EXPECT_NE(text.find("warning: block 'block' slid in stage 'weight' before rest"), std::string::npos)
        << text;
    EXPECT_NE(text.find("(a factor below 1)"), std::string::npos) << text;
  }
  const SafetyReport held = search_quietly(scene_of(block_above_wall(0.0, ""))).report;
  EXPECT_TRUE(held.earlier_slides.empty());
  EXPECT_FALSE(held.first_slide);
}

TEST(SafetySlides, TheLargestMotionCountsSlidesBeforeTheSearch) {
  const std::string largest = "largest_motion = 0.02\n";
  const SafetyReport found = search_quietly(scene_of(block_above_wall(0.5, largest + "from = 0.2\n"))).report;
  const double exact = std::tan(20.0 * degree); // at 45 degrees
  EXPECT_NEAR(middle_of(found), exact, 0.01 * exact);
  EXPECT_TRUE(found.earlier_slides.empty()) << "it has not slid with the strength with which it settles";

  const SafetyOutcome none = search_quietly(scene_of(block_above_wall(0.5, largest + "from = 0.5\n")));
  EXPECT_EQ(none.exit_code, exit_code::undecided);
  EXPECT_EQ(none.report.fails, 0.5);
  EXPECT_NE(none.message.find("slide by more than fos.largest_motion even with strengths multiplied by 2"),
            std::string::npos)
      << none.message;
}

} // namespace
} // namespace gcpdda::testing::safety_slide_test
