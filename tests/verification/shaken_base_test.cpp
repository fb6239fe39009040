// B7: a block 2 m wide and 0.5 m high, which hardly rocks, on a base that shakes with acceleration a0 sin(2
// pi f t) sticks, slips and slips back; the base driven by its table, or all that is held by a record. And
// Newmark's block on an inclined plane that shakes.

#include "problem.hpp"
#include "support/contact_regions.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace gcpdda::testing::shaken_base_test {
namespace {

constexpr double friction = 0.2;
constexpr double amplitude = 5.0;  ///< a0, m/s2
constexpr double frequency = 1.0;  ///< f, Hz
constexpr double duration = 0.72;  ///< s
constexpr double stiffness = 1e10; ///< Pa/m

/// Velocity of the base, linear between rows: of the sine that the acceleration is, the error is (2 pi f
/// h)^2/8 = 5e-8 for rows h apart.
std::vector<RecordRow> base_record() {
  const double omega = 2.0 * std::numbers::pi * frequency;
  std::vector<RecordRow> rows;
  constexpr int num_rows = 7200;
  for (int k = 0; k <= num_rows; ++k) {
    const double t = duration * k / num_rows;
    rows.push_back({t, {amplitude / omega * (1.0 - std::cos(omega * t)), 0.0}});
  }
  return rows;
}

std::string velocity_table() {
  std::string rows;
  for (const RecordRow &row : base_record()) {
    rows += fmt::format("[{:.17g}, {:.17g}, 0, 0], ", row.time, row.value.x);
  }
  return "velocity_table = [" + rows + "]";
}

enum class Drive { table, record };

struct Slip {
  double begin = 0.0;    ///< s
  double end = 0.0;      ///< where the base has caught up with the block, s
  double distance = 0.0; ///< then, m
  double back = 0.0;     ///< beginning of the slip the other way, s
};

Slip shaken(double time_step, Drive drive) {
  const double depth = 0.5 * rock_density * earth_gravity / stiffness;
  Scene scene = scene_of(head({.duration = duration,
                               .time_step = time_step,
                               .normal_stiffness = stiffness,
                               .friction_deg = std::atan(friction) / degree,
                               .damping = 0.3}) +
                         block_toml("base", rectangle({-5.0, -1.0}, {5.0, 0.0}),
                                    drive == Drive::table ? velocity_table() : "fixed = true") +
                         block_toml("block", rectangle({-1.0, -depth}, {1.0, 0.5 - depth})));
  if (drive == Drive::record) {
    scene.earthquake.file = "in memory";
    scene.earthquake.record = base_record();
  }
  Simulation simulation(Communicator::self(), std::move(scene));
  Slip slip;
  double speed_before = 0.0;
  while (!simulation.finished()) {
    step(simulation);
    const double gap = (displacement_of(simulation, 0) - displacement_of(simulation, 1)).u.x;
    const double speed = (velocity_of(simulation, 0) - velocity_of(simulation, 1)).u.x;
    const RegionForce joint = regions_of(simulation)[0];
    const bool slips = std::abs(joint.shear) >= joint.cap; // friction and its dashpot
    if (slip.begin == 0.0 && slips) {
      slip.begin = simulation.time();
    } else if (slip.end == 0.0 && slip.begin > 0.0 && simulation.time() > 0.5 && speed <= 0.0) {
      slip.end = simulation.time() - time_step * speed / (speed - speed_before);
      slip.distance = gap;
    } else if (slip.end > 0.0 && slip.back == 0.0 && slips && speed < -1e-3) {
      slip.back = simulation.time();
    }
    speed_before = speed;
  }
  EXPECT_FALSE(simulation.fault().has_value());
  return slip;
}

// The beginning is known to a step, 3e-4 of it. Until it slips back the stick spring swings from one cap to
// the other, 2 mu m g/k_t = 0.5 um at 6 m/s2: 0.4 ms.
TEST(ShakenBase, SlipsAndSlipsBack) {
  for (const Drive drive : {Drive::table, Drive::record}) {
    const Slip slip = shaken(2e-5, drive);
    const std::string name = drive == Drive::table ? "B7 shaken base" : "B7 shaken base by a record";
    expect_value(name + ": slip begins, s", 0.064177, slip.begin, 4e-4);
    expect_value(name + ": slip ends, s", 0.658273, slip.end, 1e-5);
    expect_value(name + ": relative displacement then, m", 0.244495, slip.distance, 5e-5);
    expect_below(name + ": time until it slips back, s", 1e-3, slip.back - slip.end);
    EXPECT_GT(slip.back, slip.end);
  }
}

/// A record like that of an earthquake: eleven sines of 0.5 to 5.5 Hz under a rise and a decay, m/s2, every
/// 0.01 s.
std::vector<RecordRow> quake_record(double length) {
  std::vector<RecordRow> rows;
  const int count = static_cast<int>(std::lround(length / 0.01));
  for (int k = 0; k <= count; ++k) {
    const double t = 0.01 * k;
    const double envelope = t * t * std::exp(-1.2 * t);
    Vec2 sum;
    for (int i = 1; i <= 11; ++i) {
      sum += {std::sin(std::numbers::pi * i * t + 1.7 * i * i),
              std::sin(std::numbers::pi * i * t + 2.9 * i * i)};
    }
    rows.push_back({t, 2.5 * envelope * Vec2{sum.x, 0.5 * sum.y}});
  }
  return rows;
}

/// Newmark's rigid-plastic block (doi:10.1680/geot.1965.15.2.139) on a plane that falls to the right by
/// `dip`: way down the plane, by steps of 1e-5 s.
double newmark_way(const std::vector<RecordRow> &record, double dip, double friction_of_plane) {
  constexpr double dt = 1e-5;
  const Vec2 down{std::cos(dip), -std::sin(dip)};
  const Vec2 out{std::sin(dip), std::cos(dip)};
  double way = 0.0;
  double speed = 0.0;
  for (std::size_t k = 0; k + 1 < record.size(); ++k) {
    const double length = record[k + 1].time - record[k].time;
    const int steps = static_cast<int>(std::lround(length / dt));
    for (int i = 0; i < steps; ++i) {
      const double share = (i + 0.5) / steps;
      const Vec2 ground = (1.0 - share) * record[k].value + share * record[k + 1].value;
      const Vec2 force = Vec2{0.0, -earth_gravity} - ground;
      const double drive = dot(force, down);
      const double drag = friction_of_plane * std::max(0.0, -dot(force, out));
      if (speed == 0.0 && std::abs(drive) <= drag) {
        continue;
      }
      const double sign = speed != 0.0 ? std::copysign(1.0, speed) : std::copysign(1.0, drive);
      const double next = speed + dt * (drive - sign * drag);
      const bool stops = speed != 0.0 && next * speed <= 0.0;
      way += dt * 0.5 * (speed + (stops ? 0.0 : next));
      speed = stops ? 0.0 : next;
    }
  }
  return way;
}

struct Slab {
  double width = 2.0;
  double height = 0.5;
  double damping = 0.3; ///< of contacts
};

/// Way of a slab down that plane.
double shaken_down(const std::vector<RecordRow> &record, double dip, double friction_deg, double k_n,
                   double time_step, const Slab &slab = {}) {
  const double depth = slab.height * rock_density * earth_gravity * std::cos(dip) / k_n;
  Scene scene = scene_of(
      head({.duration = record.back().time,
            .time_step = time_step,
            .normal_stiffness = k_n,
            .friction_deg = friction_deg,
            .damping = slab.damping}) +
      block_toml("base", placed(rectangle({-9.0, -1.0}, {9.0, 0.0}), -dip, {}), "fixed = true") +
      block_toml(
          "block",
          placed(rectangle({-0.5 * slab.width, -depth}, {0.5 * slab.width, slab.height - depth}), -dip, {})));
  scene.earthquake.file = "in memory";
  scene.earthquake.quantity = RecordQuantity::acceleration;
  scene.earthquake.record = record;
  Simulation simulation(Communicator::self(), std::move(scene));
  run(simulation);
  return dot(displacement_of(simulation, 1).u, Vec2{std::cos(dip), -std::sin(dip)});
}

// Some ten slips. At the beginning of each the block tilts before it slides, which is late by a time that
// falls with the root of the stiffness, as that of the block that starts flat on an incline does; elastic
// stick, mu m g cos(dip)/k_t = 2 um at k_n = 1e10, and the steps take less.
TEST(ShakenBase, NewmarkBlockSlidesDownAnInclinedPlane) {
  constexpr double dip = 20.0 * degree;
  const std::vector<RecordRow> record = quake_record(8.0);
  const double way = newmark_way(record, dip, std::tan(30.0 * degree));
  const std::string name = "Newmark block on a shaken incline, ";
  expect_value(name + "k_n = 1e10 Pa/m: permanent displacement, m", way,
               shaken_down(record, dip, 30.0, 1e10, 1e-4), 1.5e-3);
  expect_value(name + "k_n = 1e11 Pa/m: permanent displacement, m", way,
               shaken_down(record, dip, 30.0, 1e11, 3.2e-5), 5e-4);
}

// A run stage with a limit waits for the record, of which nothing moves for the first second.
TEST(ShakenBase, ARunToAVerdictWaitsForTheRecord) {
  constexpr double dip = 20.0 * degree;
  constexpr double k_n = 1e10;
  std::vector<RecordRow> record = quake_record(8.0);
  const double way = newmark_way(record, dip, std::tan(30.0 * degree));
  for (RecordRow &row : record) {
    row.time += 1.0;
  }
  record.insert(record.begin(), {0.0, {}});
  const double depth = Slab{}.height * rock_density * earth_gravity * std::cos(dip) / k_n;
  const Slab slab;
  Scene scene = scene_of(
      without_duration(
          head({.time_step = 1e-4, .normal_stiffness = k_n, .friction_deg = 30.0, .damping = slab.damping})) +
      block_toml("base", placed(rectangle({-9.0, -1.0}, {9.0, 0.0}), -dip, {}), "fixed = true") +
      block_toml(
          "block",
          placed(rectangle({-0.5 * slab.width, -depth}, {0.5 * slab.width, slab.height - depth}), -dip, {})) +
      "[[stage]]\nkind = \"run\"\nlimit = 20.0\n");
  scene.earthquake.file = "in memory";
  scene.earthquake.quantity = RecordQuantity::acceleration;
  scene.earthquake.record = record;
  Simulation simulation(Communicator::self(), std::move(scene));
  run_stages(simulation, step);
  EXPECT_EQ(simulation.stage().verdict, Verdict::settled);
  EXPECT_GE(simulation.time(), 9.0);
  EXPECT_NEAR(dot(displacement_of(simulation, 1).u, Vec2{std::cos(dip), -std::sin(dip)}), way, 1.5e-3 * way);
}

// It is so high that friction, by its lever h/2, takes the pressure off a part of the base: mu h/2 > w/6.
// Then its bouncing and its rocking feed on friction, and dashpots must take more than that.
TEST(ShakenBase, NewmarkSlabThatStandsOnAPartOfItsBase) {
  constexpr double dip = 30.0 * degree;
  const std::vector<RecordRow> record = quake_record(8.0);
  const double way = newmark_way(record, dip, std::tan(35.0 * degree));
  expect_value("Newmark slab on a part of its base, contact_damping 0.3: permanent displacement, m", way,
               shaken_down(record, dip, 35.0, 1e10, 1e-4, {5.0, 3.0, 0.3}), 1.5e-3);
}

} // namespace
} // namespace gcpdda::testing::shaken_base_test
