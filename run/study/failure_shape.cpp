// Slender blocks, needles, coincident and collinear edges.

#include "failure_search.hpp"

#include "support/setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace gcpdda::study {

namespace {

using testing::advance;
using testing::block_toml;
using testing::displacement_of;
using testing::earth_gravity;
using testing::head;
using testing::placed;
using testing::rectangle;
using testing::rock_density;
using testing::velocity_of;

/// A block of width and height on the ground: stands straight, at the depth of the closed form?
Outcome rest_of(double width, double height, double k) {
  const std::string toml =
      head({.duration = 6.0, .normal_stiffness = k, .friction_deg = 30.0, .run_keys = "gravity_ramp = 1.0"}) +
      ground() + block_toml("b", rectangle({0.0, 0.0}, {width, height}), "velocity = [0.0, 0.0, 1e-6]");
  const double critical = 6.0 * rock_density * earth_gravity * height * height / (width * width);
  return try_scene(toml, [&](Simulation &simulation) {
    advance(simulation, 1.0);
    double turn = 0.0;
    double speed = 0.0;
    while (!simulation.finished()) {
      simulation.step();
      turn = std::max(turn, std::abs(displacement_of(simulation, 1).r));
      speed = norm(velocity_of(simulation, 1).u);
    }
    const double pressure = rock_density * earth_gravity * height / k;
    const double depth = width * (1.0 - std::sqrt(1.0 - 2.0 * pressure / width));
    const double error = std::abs(-displacement_of(simulation, 1).u.y / depth - 1.0);
    const std::string text =
        fmt::format("depth off by {:.1e}, largest turn {:.1e}, speed {:.1e} m/s", error, turn, speed);
    if (turn > 1e-4 && k < critical) {
      return Outcome{Ending::physical,
                     fmt::format("falls over, {}: the joint turns more easily than the weight does", text)};
    }
    return judged(error < 0.01 && turn < 1e-4, text);
  });
}

void slender_blocks(const Options &options, Boundaries &boundaries) {
  const Search range = search(options, 1.0, 100.0, 5, 6);
  boundaries.add(
      "column that lies", "length over width", "1", range,
      find_boundary(range,
                    [](double s) { return rest_of(1.0, 1.0 / s, stiffness(1.0 / s, 1.0 / std::sqrt(s))); }),
      "1 m long, k_n of the rule with L = sqrt(area)");
  boundaries.add(
      "column that stands, L = sqrt(area)", "height over width", "1", range,
      find_boundary(range,
                    [](double s) { return rest_of(1.0 / s, 1.0, stiffness(1.0, 1.0 / std::sqrt(s))); }),
      fmt::format("1 m high, disturbed; statically unstable from (1/(6 e))^(2/3) = {:.1f} on",
                  std::pow(1e3 / 6.0, 2.0 / 3.0)));
  boundaries.add(
      "column that stands, L = width", "height over width", "1", range,
      find_boundary(range, [](double s) { return rest_of(1.0 / s, 1.0, stiffness(1.0, 1.0 / s)); }),
      fmt::format("1 m high, disturbed; statically unstable from 1/(6 e) = {:.0f} on", 1e3 / 6.0));
}

void thin_plates(const Options &options, Boundaries &boundaries) {
  constexpr int num_plates = 10;
  const auto trial = [](double slenderness) {
    const double thick = 1.0 / slenderness;
    const double k = stiffness(num_plates * thick, std::sqrt(thick));
    std::string toml = head({.duration = 1.5,
                             .normal_stiffness = k,
                             .friction_deg = 30.0,
                             .run_keys = "gravity_ramp = 1.0"}) +
                       ground();
    for (int b = 0; b < num_plates; ++b) {
      toml += block_toml(fmt::format("b{}", b), rectangle({0.0, b * thick}, {1.0, (b + 1) * thick}));
    }
    return try_scene(toml, [&](Simulation &simulation) {
      advance(simulation, 1.5);
      double error = 0.0;
      for (int b = 1; b <= num_plates; ++b) {
        const double closed =
            (b == 1 ? 0.0 : displacement_of(simulation, b - 1).u.y) - displacement_of(simulation, b).u.y;
        const double share = b == 1 ? 0.5 : 1.0;
        const double carried = k * closed * (1.0 - share * closed);
        const double weight = rock_density * earth_gravity * thick * (num_plates + 1 - b);
        error = std::max(error, std::abs(carried / weight - 1.0));
      }
      return judged(error < 0.02,
                    fmt::format("joint forces off by {:.1e}, largest overlap {:.2e} of a thickness", error,
                                simulation.counters().max_overlap / thick));
    });
  };
  const Search range = search(options, 1.0, 1e5, 6, 6);
  boundaries.add("stack of ten plates", "length over thickness", "1", range, find_boundary(range, trial),
                 "1 m long, k_n of the rule with L = sqrt(area), gravity ramp 1 s");
}

/// A needle 1 m long, its tip 1 mm above the ground, tilted; without gravity, damping and friction.
Outcome bounce(double tip_deg, double speed, double tilt_deg) {
  const double half = std::tan(0.5 * tip_deg * testing::degree);
  const std::vector<Vec2> needle{{0.0, 0.0}, {half, 1.0}, {-half, 1.0}};
  const std::string toml =
      head(
          {.duration = 1.0 / speed, .gravity = {}, .normal_stiffness = stiffness(1.0, 1.0), .damping = 0.0}) +
      ground() +
      block_toml("needle", placed(needle, tilt_deg * testing::degree, {0.0, 1e-3}),
                 fmt::format("velocity = [0.0, {:.17g}, 0.0]", -speed));
  return try_scene(toml, [&](Simulation &simulation) {
    const double inertia = simulation.blocks().properties[0].inertia / simulation.blocks().properties[0].mass;
    double tip = 0.0;
    while (!simulation.finished() && (tip == 0.0 || !simulation.history().empty())) {
      simulation.step();
      for (const Vec2 v : TrialOutline(simulation.blocks(), 0).vertex) {
        tip = std::min(tip, v.y);
      }
    }
    const RigidDof v = velocity_of(simulation, 1);
    const double energy = (dot(v.u, v.u) + inertia * v.r * v.r) / (speed * speed);
    const bool is_out = simulation.history().empty();
    return judged(is_out && tip < 0.0 && std::abs(energy - 1.0) < 0.02,
                  fmt::format("{}, deepest tip {:.2e} m, E/E0 - 1 = {:.1e}, normal undefined {} times",
                              is_out ? "comes back" : "still in contact", -tip, energy - 1.0,
                              simulation.counters().normals_undefined));
  });
}

void needles(const Options &options, Boundaries &boundaries) {
  const std::string held = fmt::format("needle 1 m long, k_n = {:.4g} Pa/m, no damping", stiffness(1.0, 1.0));
  const Search angles = search(options, 60.0, 2.0, 8, 5);
  for (const double tilt : {0.0, 10.0}) {
    boundaries.add(fmt::format("needle into a face at 0.01 m/s, tilted by {:g} deg", tilt), "tip angle",
                   "deg", angles, find_boundary(angles, [&](double tip) { return bounce(tip, 0.01, tilt); }),
                   held);
  }
  for (const double tip : {2.0, 10.0, 20.0}) {
    const Search speeds = search(options, 1e-3, 10.0, 9, 6);
    const double half = 0.5 * tip * testing::degree;
    // Half the narrowest width; where the normals nearly cancel an overlap counts twice.
    const double allowed = (std::sin(half) < 0.1 ? 0.5 : 1.0) * std::tan(half);
    const double limit = std::sqrt(stiffness(1.0, 1.0) * allowed * allowed * allowed * std::tan(half) *
                                   (1.0 + std::sin(half)) / (3.0 * rock_density * std::tan(half)));
    boundaries.add(
        fmt::format("needle of {:g} deg into a face", tip), "speed", "m/s", speeds,
        find_boundary(speeds, [&](double speed) { return bounce(tip, speed, 0.0); }),
        fmt::format("{}; energy says {:.3g} m/s{}", held, limit,
                    std::sin(half) < 0.1 ? ", at half the allowed depth: the normals nearly cancel" : ""));
  }
}

/// A rectangle whose faces have `extra` further vertices each, in equal distances but for the last digits.
std::vector<Vec2> with_collinear(const std::vector<Vec2> &corners, int extra) {
  std::vector<Vec2> all;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i];
    const Vec2 b = corners[(i + 1) % corners.size()];
    for (int k = 0; k <= extra; ++k) {
      all.push_back(a + (static_cast<double>(k) / (extra + 1)) * (b - a));
    }
  }
  return all;
}

/// Where three squares get to in 0.2 s under gravity ramped up in 0.1 s, on a plane falling by `slope`, with
/// `shift` of each against the one below.
std::vector<RigidDof> settled(int extra, double slope, double shift) {
  std::string toml =
      head({.duration = 0.2,
            .time_step = 1e-3,
            .normal_stiffness = stiffness(3.0, 1.0),
            .friction_deg = 30.0,
            .run_keys = "gravity_ramp = 0.1"}) +
      block_toml("ground", placed(rectangle({-3.0, -2.0}, {4.0, 0.0}), -slope, {}), "fixed = true");
  for (int b = 0; b < 3; ++b) {
    const std::vector<Vec2> square = rectangle({b * shift, 1.0 * b}, {b * shift + 1.0, b + 1.0});
    toml += block_toml(fmt::format("b{}", b), with_collinear(placed(square, -slope, {}), extra));
  }
  std::vector<RigidDof> places;
  const Outcome outcome = try_scene(toml, [&](Simulation &simulation) {
    advance(simulation, 0.2);
    for (int b = 1; b <= 3; ++b) {
      places.push_back(displacement_of(simulation, b));
    }
    return Outcome{};
  });
  if (outcome.ending != Ending::fine) {
    throw std::runtime_error(outcome.text);
  }
  return places;
}

void collinear_vertices(const Options &options, Boundaries &boundaries) {
  struct Case {
    const char *name;
    double slope_deg;
    double shift;
  };
  for (const Case &c :
       {Case{"coincident edges", 0.0, 0.0}, Case{"T-junctions", 0.0, -0.25},
        Case{"coincident edges, 17 deg", 17.0, 0.0}, Case{"T-junctions, 17 deg", 17.0, -0.25}}) {
    const double slope = c.slope_deg * testing::degree;
    const std::vector<RigidDof> plain = settled(0, slope, c.shift);
    const bool is_plain = c.slope_deg == 0.0 && c.shift == 0.0;
    Search range = search(options, 1.0, options.quick ? 30.0 : is_plain ? 1000.0 : 300.0, 4, 4);
    range.whole = true;
    const auto trial = [&](double extra) {
      const std::vector<RigidDof> places = settled(static_cast<int>(extra), slope, c.shift);
      double difference = 0.0;
      for (std::size_t b = 0; b < places.size(); ++b) {
        const RigidDof d = places[b] - plain[b];
        difference = std::max({difference, norm(d.u), std::abs(d.r)});
      }
      return judged(difference < 1e-9, fmt::format("moves by {:.1e} m else than without", difference));
    };
    boundaries.add(fmt::format("collinear vertices, {}", c.name), "further vertices per face", "1", range,
                   find_boundary(range, trial),
                   "three unit squares, friction 30 deg, 200 steps under rising gravity; the cost grows with "
                   "the square of the vertices");
  }
}

} // namespace

void failures_of_shape(const Options &options, Boundaries &boundaries) {
  slender_blocks(options, boundaries);
  thin_plates(options, boundaries);
  needles(options, boundaries);
  collinear_vertices(options, boundaries);
}

} // namespace gcpdda::study
