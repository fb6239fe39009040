// C1 and C5: does a block on a slope stay, slide, topple, or do both?

#include "problem.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gcpdda::testing::block_on_slope_test {
namespace {

/// A block 1 m high and tan(slenderness) m wide.
struct SlopeCase {
  double slope, slenderness, friction; ///< degrees
};

struct Motion {
  double slid = 0.0;   ///< of the toe along the slope, m
  double turned = 0.0; ///< towards the valley, rad
};

/// Motion until something is plain: the toe has slid 0.1 m, the block has turned by 0.02 rad, or 2.5 s have
/// passed. The slope is level and gravity tilted; x points downhill.
Motion released(const SlopeCase &c) {
  const Vec2 gravity{earth_gravity * std::sin(c.slope * degree), -earth_gravity * std::cos(c.slope * degree)};
  // Near the borders the resultant passes 1 cm from the toe, which must sink by far less: stiff joints. The
  // load is put on slowly, or the block rocks past the border at first.
  const double width = std::tan(c.slenderness * degree);
  Simulation simulation(Communicator::self(),
                        scene_of(head({.duration = 2.5,
                                       .gravity = gravity,
                                       .normal_stiffness = 1e11,
                                       .friction_deg = c.friction,
                                       .damping = 0.3,
                                       .run_keys = "gravity_ramp = 1.0"}) +
                                 block_toml("slope", rectangle({-5.0, -3.0}, {20.0, 0.0}), "fixed = true") +
                                 block_toml("block", rectangle({0.0, 0.0}, {width, 1.0}))));
  Motion motion;
  while (!simulation.finished() && motion.slid < 0.1 && motion.turned < 0.02) {
    step(simulation);
    const std::size_t row = row_of(simulation, 1);
    const Vec2 toe = current_vertices(simulation.blocks(), row)[1];
    motion = {toe.x - width, -displacement_of(simulation, 1).r};
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return motion;
}

// At least 1 degree off every border. With the toe as a hinge nothing slides: less than 1 % of the top's
// motion is the joint's own shear and the shift of the pressure under the edge.
std::string judged(const Motion &motion) {
  const bool turns = motion.turned > 0.005;
  const bool slides = motion.slid > (turns ? 0.02 * motion.turned : 1e-3);
  return turns ? (slides ? "both" : "topples") : (slides ? "slides" : "stays");
}

/// The chart: which of the four by limit equilibrium.
std::string region(const SlopeCase &c) {
  const double slope = c.slope * degree;
  const double slenderness = c.slenderness * degree;
  if (slope <= slenderness) {
    return c.friction >= c.slope ? "stays" : "slides";
  }
  const double lever = 0.75 * std::sin(slope - slenderness);
  const double limit = std::atan((std::sin(slope) - lever * std::cos(slenderness)) /
                                 (std::cos(slope) + lever * std::sin(slenderness))) /
                       degree;
  return c.friction >= limit ? "topples" : c.friction > c.slenderness ? "both" : "slides";
}

/// No border within `margin` degrees in any direction.
bool is_clear(const SlopeCase &c, double margin) {
  for (const double by : {-margin, margin}) {
    if (region({c.slope + by, c.slenderness, c.friction}) != region(c) ||
        region({c.slope, c.slenderness + by, c.friction}) != region(c) ||
        region({c.slope, c.slenderness, c.friction + by}) != region(c)) {
      return false;
    }
  }
  return true;
}

// A block that turns about its toe, with 4/3 m R^2, R half its diagonal, needs tan phi = [sin al - 3/4 sin(al
// - de) cos de]/[cos al + 3/4 sin(al - de) sin de] there; digits of it, al the slope and de the slenderness.
TEST(BlockOnSlope, LimitOfPureToppling) {
  struct Row {
    double slope, slenderness, limit;
  };
  for (const Row row : {Row{20, 10, 12.524},
                        {20, 15, 16.253},
                        {30, 20, 22.524},
                        {30, 11.30993, 16.144},
                        {40, 21.80141, 26.5}}) {
    EXPECT_EQ(region({row.slope, row.slenderness, row.limit + 6e-4}), "topples") << row.slope;
    EXPECT_EQ(region({row.slope, row.slenderness, row.limit - 6e-4}), "both") << row.slope;
  }
}

/// Points at about 1 degree from a border of every kind and far within; of the full chart a grid.
std::vector<SlopeCase> chart_points() {
  std::vector<SlopeCase> points{{9, 20, 11},        {20, 25, 35},        {29, 31, 31},   {20, 15, 13.9},
                                {30, 20, 18.9},     {30, 35, 28.9},      {30, 45, 10},   {20, 10, 14},
                                {20, 15, 17.5},     {30, 20, 24},        {30, 20, 45},   {30, 11.30993, 17.5},
                                {40, 21.80141, 28}, {20, 10, 11.3},      {30, 20, 21.3}, {30, 11.30993, 14},
                                {40, 21.80141, 24}, {40, 21.80141, 25.4}};
  if (full_size()) {
    for (double slope = 10.0; slope <= 40.0; slope += 10.0) {
      for (double slenderness = 3.5; slenderness <= 50.0; slenderness += 5.0) {
        for (double friction = 3.0; friction <= 58.0; friction += 5.0) {
          points.push_back({slope, slenderness, friction});
        }
      }
    }
  }
  return points;
}

TEST(BlockOnSlope, ChartOfSlidingAndToppling) {
  int wrong = 0;
  int runs = 0;
  for (const SlopeCase &c : chart_points()) {
    if (!is_clear(c, 1.0)) {
      continue;
    }
    const Motion motion = released(c);
    const std::string got = judged(motion);
    const std::string expected = region(c);
    if (got != expected) {
      fmt::print(
          "    C1 slope {:g}, slenderness {:g}, friction {:g}: expected {}, got {} (toe slid {:.2e} m, "
          "turned {:.2e} rad)\n",
          c.slope, c.slenderness, c.friction, expected, got, motion.slid, motion.turned);
    }
    wrong += got == expected ? 0 : 1;
    ++runs;
  }
  expect_below(fmt::format("C1 wrong verdicts of {} at 1 degree or more from a border", runs), 0.0, wrong);
}

// Safety against toppling is b/(h tan th). Near 1 the resultant passes the toe by less than the joint sinks:
// 3 % are 9 mm.
TEST(BlockOnSlope, SafetyAgainstToppling) {
  for (const double safety : {0.97, 1.03}) {
    const SlopeCase c{30.0, std::atan(safety * std::tan(30.0 * degree)) / degree, 60.0};
    const double turned = released(c).turned;
    const std::string problem = fmt::format("C5 block of safety {} against toppling: turned, rad", safety);
    if (safety < 1.0) {
      expect_above(problem, 0.02, turned);
    } else {
      expect_below(problem, 0.005, turned);
    }
  }
}

/// A plane failure by strength reduction: the block is so flat that its base stays closed over its length.
struct PlaneFailure {
  double slope, friction; ///< degrees
  double cohesion;        ///< Pa

  static constexpr double length = 4.0;
  static constexpr double height = 0.5;

  [[nodiscard]] double safety() const {
    return std::tan(friction * degree) / std::tan(slope * degree) +
           cohesion * length / (rock_density * length * height * earth_gravity * std::sin(slope * degree));
  }

  /// Speed when the load has been on for 2 s, and what it gained in the last of them.
  [[nodiscard]] std::pair<double, double> motion(double reduction) const {
    const Vec2 gravity{earth_gravity * std::sin(slope * degree), -earth_gravity * std::cos(slope * degree)};
    std::string toml = head({.duration = 3.0,
                             .gravity = gravity,
                             .friction_deg = std::atan(std::tan(friction * degree) / reduction) / degree,
                             .damping = 0.3,
                             .run_keys = "gravity_ramp = 1.0"});
    toml.insert(toml.find("friction_angle_deg"), fmt::format("cohesion = {:.17g}\n", cohesion / reduction));
    toml += block_toml("slope", rectangle({-5.0, -3.0}, {20.0, 0.0}), "fixed = true") +
            block_toml("block", rectangle({0.0, 0.0}, {length, height}));
    Simulation simulation(Communicator::self(), scene_of(toml));
    run_until(simulation, 2.0);
    const double before = velocity_of(simulation, 1).u.x;
    run(simulation);
    const double after = velocity_of(simulation, 1).u.x;
    return {after, after - before};
  }
};

// Safety against sliding is tan(phi)/tan(th) + c l/(W sin th). With the strength divided by 0.998 of it the
// block stands, by 1.002 it slides with the share of gravity that is missing. While the load comes on the
// block rocks, and slides a little whatever the margin; it then takes its time to stop.
TEST(BlockOnSlope, SafetyAgainstSlidingByStrengthReduction) {
  for (const PlaneFailure c : {PlaneFailure{35, 25, 5e3}, {20, 30, 0}, {50, 0, 1.5e4}}) {
    const double safety = c.safety();
    const std::string problem =
        fmt::format("C5 plane failure, th={} phi={} c={:g} Pa, safety {:.4f}, strength "
                    "divided by ",
                    c.slope, c.friction, c.cohesion, safety);
    expect_below(problem + "0.998 of it: speed, m/s", 1e-6, std::abs(c.motion(0.998 * safety).first));
    expect_value(problem + "1.002 of it: acceleration, m/s2",
                 earth_gravity * std::sin(c.slope * degree) * (1.0 - 1.0 / 1.002),
                 c.motion(1.002 * safety).second, 5e-4);
  }
}

} // namespace
} // namespace gcpdda::testing::block_on_slope_test
