// Water: buoyancy, the period of a raft, and Hoek and Bray's slide with a water-filled tension crack.

#include "geometry/polygon.hpp"
#include "problem.hpp"
#include "safety_limits.hpp"
#include "simulation/results.hpp"
#include "support/contact_regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gcpdda::testing::water_test {
namespace {

constexpr double water_density = 1000.0;
constexpr double unit_weight = water_density * earth_gravity;

std::string water_toml(const std::vector<Vec2> &line, const std::string &more = "") {
  std::string points;
  for (const Vec2 x : line) {
    points += fmt::format("{}[{:.17g}, {:.17g}]", points.empty() ? "" : ", ", x.x, x.y);
  }
  return fmt::format("[water.table]\nphreatic = [{}]\n{}", points, more);
}

std::string of_density(std::string toml, double density) {
  const std::size_t at = toml.find("density = ") + 10;
  return toml.replace(at, toml.find('\n', at) - at, fmt::format("{:.1f}", density));
}

// A square on a permeable floor weighs what it weighs in water.
TEST(Water, SubmergedSquareHasItsBuoyancy) {
  for (const bool is_wet : {false, true}) {
    const std::string toml = head({.duration = 3.0, .run_keys = "local_damping = 0.8\n"}) +
                             water_toml({{-9.0, 7.0}, {9.0, 7.0}}, is_wet ? "" : "active = false\n") +
                             block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
                             block_toml("square", rectangle({-0.5, 0.0}, {0.5, 1.0}));
    Simulation simulation(Communicator::self(), scene_of(toml));
    run(simulation);
    ASSERT_EQ(regions_of(simulation).size(), 1U);
    const double weight = (rock_density - (is_wet ? water_density : 0.0)) * earth_gravity;
    // Local damping leaves the last digits of the motion.
    expect_value(fmt::format("water: {} square on a floor, force of the joint, N/m", is_wet ? "wet" : "dry"),
                 weight, regions_of(simulation)[0].normal_force, 1e-6);
  }
}

// Hung by the middle of its top in water, and touching nothing: the water presses on it as at its centre, and
// its weight in water hangs half its height above the centre. Both kinds of blocks have this mean stress.
TEST(Water, HungSquareHasTheStressOfWaterAndOfWhatHoldsIt) {
  constexpr double top = 7.0;
  constexpr double centre = 2.5;
  for (const std::string fidelity : {"rigid", "deformable"}) {
    const std::string toml = head({.duration = 2.0,
                                   .run_keys = "local_damping = 0.8\n",
                                   .fidelity = fidelity,
                                   .youngs_modulus = 1e10,
                                   .poissons_ratio = 0.25}) +
                             water_toml({{-9.0, top}, {9.0, top}}) +
                             block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
                             block_toml("square", rectangle({-0.5, centre - 0.5}, {0.5, centre + 0.5}),
                                        "fixed_points = [[0.0, 3.0]]");
    Simulation simulation(Communicator::self(), scene_of(toml));
    run(simulation);
    const SimulationFrame frame(simulation);
    std::vector<FrameRow> rows;
    std::vector<Vec2> vertices;
    frame.append(0, 2, rows, vertices);
    ASSERT_EQ(rows.size(), 2U);
    const double pressure = unit_weight * (top - centre);
    const double hanging = 0.5 * (rock_density - water_density) * earth_gravity;
    // Rock that deforms strains by the pressure over its modulus, 4e-6, and so do area and depth.
    expect_value("water: hung square, horizontal stress, " + fidelity, -pressure, rows[1].stress[0], 1e-5);
    expect_value("water: hung square, vertical stress, " + fidelity, hanging - pressure, rows[1].stress[1],
                 1e-5);
  }
}

// As heavy as water it hovers, pressed together by the pressure at its centre: plane strain,
// e = -p (1 + nu)(1 - 2 nu)/E. The pressure grows with depth: of that a constant strain knows nothing.
TEST(Water, HoveringSquareIsPressedTogether) {
  const double youngs_modulus = 1e8;
  const double poissons_ratio = 0.25;
  const std::string toml = of_density(head({.duration = 2.0,
                                            .run_keys = "local_damping = 0.8\n",
                                            .fidelity = "deformable",
                                            .youngs_modulus = youngs_modulus,
                                            .poissons_ratio = poissons_ratio}),
                                      water_density) +
                           water_toml({{-9.0, 7.0}, {9.0, 7.0}}) +
                           block_toml("floor", rectangle({-3.0, -1.0}, {3.0, 0.0}), "fixed = true") +
                           block_toml("square", rectangle({-0.5, 1.0}, {0.5, 2.0}));
  Simulation simulation(Communicator::self(), scene_of(toml));
  run(simulation);
  const double pressure = unit_weight * 5.5;
  const double strain = -pressure * (1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio) / youngs_modulus;
  const Mat2 gradient = simulation.blocks().deformation_of(row_of(simulation, 1)).gradient;
  // The square of the strain.
  expect_value("water: hovering square, horizontal strain", strain, gradient.xx - 1.0, 1e-3);
  expect_value("water: hovering square, vertical strain", strain, gradient.yy - 1.0, 1e-3);
}

// A raft of half the density of water, b by h, draught d: metacentric height b^2/(12 d) - (h - d)/2; the
// model moves no water.
TEST(Water, RaftRollsWithItsMetacentricHeight) {
  const double breadth = 3.0;
  const double draught = 0.5;
  const double heel = 0.01;
  std::vector<Vec2> outline = rectangle({-0.5 * breadth, -0.5}, {0.5 * breadth, 0.5});
  for (Vec2 &x : outline) {
    x = Rotation::of(heel)(x);
  }
  const std::string toml = of_density(head({.duration = 1.2}), 0.5 * water_density) +
                           water_toml({{-9.0, 0.0}, {9.0, 0.0}}) + block_toml("raft", outline) +
                           block_toml("bottom", rectangle({-3.0, -9.0}, {3.0, -8.0}), "fixed = true");
  Simulation simulation(Communicator::self(), scene_of(toml));
  const double height = breadth * breadth / (12.0 * draught) - 0.5 * (1.0 - draught);
  const double omega = std::sqrt(earth_gravity * height * 12.0 / (breadth * breadth + 1.0));
  double before = 0.0;
  double half_period = 0.0;
  while (!simulation.finished() && half_period == 0.0) {
    step(simulation);
    const double spin = velocity_of(simulation, 0).r;
    if (before < 0.0 && spin >= 0.0) {
      half_period = simulation.time() - simulation.plan().time_step * spin / (spin - before);
    }
    before = spin;
  }
  // Heel squared; heave couples with it to the same order.
  expect_value("water: raft, half a period of its roll, s", std::numbers::pi / omega, half_period, 1e-3);
  expect_below("water: raft, largest overshoot of the heel", 1e-3 * heel,
               std::abs(displacement_of(simulation, 0).r + 2.0 * heel));
}

/// A slide of height 16 m on a plane of 30 degrees below a tension crack 20 m behind the toe
/// [doi:10.1201/9781482267099, plane failure].
struct Slide {
  double level; ///< of the water in the crack above its end, m

  static constexpr double dip = 30.0 * degree;
  static constexpr double behind = 20.0;
  double crack_end = behind * std::tan(dip);
  double plane = behind / std::cos(dip); ///< length, m
  std::vector<Vec2> outline{{0.0, 0.0}, {behind, crack_end}, {behind, 16.0}, {4.0, 16.0}};
  double uplift = 0.5 * unit_weight * level * plane;
  double thrust = 0.5 * unit_weight * level * level;
  double weight = rock_density * earth_gravity * signed_area(outline);

  [[nodiscard]] double normal() const { return weight * std::cos(dip) - uplift - thrust * std::sin(dip); }
  [[nodiscard]] double driving() const { return weight * std::sin(dip) + thrust * std::cos(dip); }

  [[nodiscard]] std::string toml(double tan_friction, double duration, const std::string &run_keys) const {
    return head({.duration = duration,
                 .friction_deg = std::atan(tan_friction) / degree,
                 .run_keys = run_keys}) +
           water_toml({{0.0, 0.0}, {behind, crack_end + level}}) +
           block_toml("base",
                      {{-10.0, -20.0}, {behind, -20.0}, {behind, crack_end}, {-10.0, -10.0 * std::tan(dip)}},
                      "fixed = true") +
           block_toml("slide", outline);
  }
};

TEST(Water, SlideWithATensionCrackCarriesEffectiveForces) {
  const Slide slide{.level = 3.0};
  Simulation simulation(Communicator::self(), scene_of(slide.toml(1.0, 4.0, "local_damping = 0.8\n")));
  run(simulation);
  ASSERT_EQ(regions_of(simulation).size(), 1U);
  const RegionForce joint = regions_of(simulation)[0];
  // The slide sinks by 2e-4 m, and its water is deeper by as much.
  expect_value("water: plane failure with tension crack, effective normal force, N/m", slide.normal(),
               joint.normal_force, 2e-4);
  expect_value("water: plane failure with tension crack, shear force, N/m", slide.driving(),
               norm(joint.shear_force), 2e-4);
}

// It stands with 1 % more friction than limit equilibrium asks for and slides with 1 % less, wet and dry.
TEST(Water, SlideWithATensionCrackFailsAtItsFactorOfSafety) {
  for (const double level : {0.0, 3.0}) {
    const Slide slide{.level = level};
    const double limit = slide.driving() / slide.normal();
    for (const double factor : {0.99, 1.01}) {
      Simulation simulation(Communicator::self(),
                            scene_of(slide.toml(factor * limit, 4.0, "gravity_ramp = 1.0\n")));
      run(simulation);
      const double moved = norm(displacement_of(simulation, 1).u);
      const std::string what =
          fmt::format("water: plane failure, crack filled to {} m, {} of the friction it needs: motion, m",
                      level, factor);
      if (factor < 1.0) { // 0.01 S/m over 3 s is 0.2 m
        expect_above(what, 0.1, moved);
      } else {
        expect_below(what, 0.01, moved);
      }
    }
  }
}

// A stage fills the crack of a slide that stands without water.
TEST(Water, StageThatFillsTheCrackMakesTheSlideFail) {
  const Slide dry{.level = 0.0};
  const Slide full{.level = 3.0};
  const double between = 0.5 * (dry.driving() / dry.normal() + full.driving() / full.normal());
  std::string toml = without_duration(full.toml(between, 1.0, "gravity_ramp = 1.0\n"));
  toml.insert(toml.find("phreatic"), "active = false\n");
  toml += R"([[stage]]
kind = "settle"
limit = 20.0
[[stage]]
kind = "run"
limit = 20.0
set = { "water.table.active" = true }
)";
  Simulation simulation(Communicator::self(), scene_of(toml));
  run_stages(simulation, step);
  ASSERT_EQ(simulation.stage_results().size(), 2U);
  EXPECT_EQ(simulation.stage_results()[0].verdict, Verdict::settled);
  EXPECT_EQ(simulation.stage_results()[1].verdict, Verdict::failed);
}

// A settle stage asks whether the slide rests where it is: it does not by sliding out of its pressure.
TEST(Water, ASlideFindsNoHoldByLeavingItsWater) {
  for (const std::string solver : {"static", "dynamic"}) {
    for (const double level : {3.0, 4.4}) { // m, of 4.45
      const Slide slide{.level = level};
      const double limit = slide.driving() / slide.normal();
      for (const double factor : {0.98, 1.01}) {
        const std::string toml =
            without_duration(slide.toml(factor * limit, 1.0, "")) +
            fmt::format("[[stage]]\nkind = \"settle\"\nlimit = 20.0\nsolver = \"{}\"\n", solver);
        Simulation simulation(Communicator::self(), scene_of(toml));
        run_stages(simulation, step);
        // Below the limit it creeps under local damping until it fails or the time is over.
        EXPECT_EQ(simulation.stage_results()[0].verdict == Verdict::settled, factor > 1.0)
            << solver << ", crack filled to " << level << " m, factor " << factor;
      }
    }
  }
}

// The head falls along the plane, so that a slide which went on would find less pressure where it goes.
TEST(Water, SearchesKeepThePressureOfAFilledCrack) {
  for (const double level : {1.5, 4.0}) {
    const Slide slide{.level = level};
    const double friction = 1.2 * slide.driving() / slide.normal();
    for (const std::string solver : {"static", "dynamic"}) {
      const SafetyOutcome found = search_quietly(
          scene_of(without_duration(slide.toml(friction, 1.0, "")) +
                   fmt::format("[[stage]]\nkind = \"settle\"\nlimit = 20.0\nsolver = \"{}\"\n", solver)));
      ASSERT_TRUE(found.report.holds && found.report.fails) << solver << level;
      EXPECT_NEAR(0.5 * (*found.report.holds + *found.report.fails), 1.2, 0.01 * 1.2) << solver << level;
    }
  }
}

} // namespace
} // namespace gcpdda::testing::water_test
