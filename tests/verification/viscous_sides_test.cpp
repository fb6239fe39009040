// Waves that leave and come in through viscous sides. Slabs 20 km wide and 1 m high, pressed together, carry
// compression waves up a column and, as it is much wider than the wave is long, shear waves: bending takes
// about (length/width)^2 of these. A narrow column of blocks between joints at 45 and 135 degrees carries
// compression waves between rollers; with k_t = k_n it does not push on these, which give way by their
// joints.

#include "problem.hpp"

#include "blockgen/region_cutter.hpp"
#include "simulation/energy_ledger.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace gcpdda::testing::viscous_sides_test {
namespace {

constexpr int num_slabs = 160;
constexpr double joint_stiffness = 1e9; ///< Pa/m
constexpr double pulse_length = 100.0;  ///< m
constexpr double pulse_speed = 1e-3;    ///< m/s

enum class Wave { compression, shear };

struct Column {
  std::string fidelity = "rigid";
  std::string sides = "\"bottom\"";
  Wave wave = Wave::compression;
  double youngs_modulus = 1e9; ///< where slabs deform; Pa, without Poisson's effect
  bool is_oblique = false;     ///< joints at 45 and 135 degrees that cross every metre

  [[nodiscard]] double width() const { return is_oblique ? 2.0 : 2e4; } ///< m

  /// Speed of long waves, m/s.
  [[nodiscard]] double speed() const {
    if (is_oblique) { // s (k_n + k_t)/2 with a spacing s of 1/sqrt(2) and k_t = k_n
      return std::sqrt(std::sqrt(0.5) * joint_stiffness / rock_density);
    }
    const double joint = (wave == Wave::shear ? 0.5 : 1.0) * joint_stiffness; // times a height of 1 m
    const double rock = wave == Wave::shear ? 0.5 * youngs_modulus : youngs_modulus;
    return std::sqrt((fidelity == "rigid" ? joint : 1.0 / (1.0 / joint + 1.0 / rock)) / rock_density);
  }

  [[nodiscard]] std::string toml(double duration) const {
    return head({.duration = duration,
                 .gravity = {},
                 .normal_stiffness = joint_stiffness,
                 .friction_deg = 60.0,
                 .damping = 0.0,
                 .run_keys = "initial_friction = \"zero\"\nsafety = 0.4\n",
                 .fidelity = fidelity,
                 .youngs_modulus = youngs_modulus}) +
           fmt::format(
               "[region]\nmaterial = \"rock\"\npolygon = [[0, 0], [{0}, 0], [{0}, {1}], [0, {1}]]\n"
               "stress = [\"bottom\", \"top\"]\n"
               "{3}\n"
               "[in_situ]\nvertical_stress = 1e5\nk0 = {4}\n"
               "[earthquake]\nviscous = [{2}]\n",
               width(), num_slabs, sides,
               is_oblique
                   ? fmt::format("roller = [\"left\", \"right\"]\n"
                                 "[[joint_set]]\ndip_deg = 45.0\nspacing = {0:.17g}\njoint = \"even\"\n"
                                 "[[joint_set]]\ndip_deg = 135.0\nspacing = {0:.17g}\njoint = \"even\"\n"
                                 "[joint.even]\ntangential_ratio = 1.0\n",
                                 std::sqrt(0.5))
                   : "[[joint_set]]\ndip_deg = 0.0\nspacing = 1.0\n",
               is_oblique ? 1.0 : 0.0);
  }
};

std::vector<RecordRow> pulse_record(Wave wave, double length) {
  std::vector<RecordRow> rows;
  constexpr int count = 400;
  for (int k = 0; k <= count; ++k) {
    const double v = 0.5 * pulse_speed * (1.0 - std::cos(2.0 * std::numbers::pi * k / count));
    rows.push_back({length * k / count, wave == Wave::shear ? Vec2{v, 0.0} : Vec2{0.0, v}});
  }
  return rows;
}

/// Row of the slab that holds a height.
std::size_t slab_at(const Simulation &simulation, double height) {
  const BlockSystem &blocks = simulation.blocks();
  std::size_t nearest = 0;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    const auto away = [&](std::size_t r) { return std::abs(blocks.properties[r].centroid.y - height); };
    nearest = away(row) < away(nearest) ? row : nearest;
  }
  return nearest;
}

/// What a slab goes through.
struct Passage {
  double first = 0.0;      ///< largest velocity up to the time that parts the two, m/s
  double afterwards = 0.0; ///< largest after it
  double residual = 0.0;   ///< of the energies, J/m
  double carried = 0.0;    ///< energy of the pulse, J/m
};

/// A pulse comes in at the bottom.
/// @param height, parted  of the slab that is looked at, m; the time, in times the pulse takes for the column
Passage pulse_through(const Column &column, double height, double parted, double lasts) {
  const double travel = num_slabs / column.speed();
  Scene scene = scene_of(column.toml(lasts * travel));
  scene.earthquake.file = "in memory";
  scene.earthquake.record = pulse_record(column.wave, pulse_length / column.speed());
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  Simulation simulation(Communicator::self(), std::move(scene));
  EnergyLedger energies(simulation.state());
  const std::size_t slab = slab_at(simulation, height);
  Passage passage;
  while (!simulation.finished()) {
    step(simulation);
    const Vec2 v = simulation.blocks().velocity[slab].u;
    double &largest = simulation.time() < parted * travel ? passage.first : passage.afterwards;
    largest = std::max(largest, std::abs(column.wave == Wave::shear ? v.x : v.y));
  }
  EXPECT_FALSE(simulation.fault().has_value());
  const EnergyRow row = energies.row(simulation.state());
  passage.residual = std::abs(row.residual);
  // rho c v^2 over the raised cosine: 3/8 of its peak's.
  passage.carried = 0.375 * rock_density * column.speed() * pulse_speed * pulse_speed * column.width() *
                    pulse_length / column.speed();
  return passage;
}

std::string name_of(const Column &column) {
  return fmt::format("{} wave, {} {}", column.wave == Wave::shear ? "shear" : "compression", column.fidelity,
                     column.is_oblique ? "blocks between oblique joints" : "slabs");
}

const std::vector<Column> &columns() {
  static const std::vector<Column> all{{.wave = Wave::compression},
                                       {.wave = Wave::shear},
                                       {.fidelity = "deformable", .wave = Wave::compression},
                                       {.fidelity = "deformable", .wave = Wave::shear}};
  return all;
}

// What comes in at the bottom passes the middle as it is and leaves through the top. A chain that ends in its
// last block's middle reflects h/(4 c) dv/dt of a pulse: pi h/(4 l) = 0.8 % of one of l = 100 h, and
// dispersion, (pi h/l)^2/6 = 2e-4, leaves ripples. The energy that came in has left.
TEST(ViscousSides, WaveLeavesWithoutReflection) {
  for (Column column : columns()) {
    column.sides = "\"bottom\", \"top\"";
    const Passage passage = pulse_through(column, 0.5 * num_slabs, 1.2, 2.2);
    expect_value(name_of(column) + ": velocity in the middle, m/s", pulse_speed, passage.first, 1e-3);
    expect_below(name_of(column) + ": reflected by a viscous side over what came", 0.01,
                 passage.afterwards / pulse_speed);
    expect_below(name_of(column) + ": energy error over what the wave carries", 1e-5,
                 passage.residual / passage.carried);
  }
}

// So it is of joints that cross the wave obliquely, from the impedance of their rock as a whole.
TEST(ViscousSides, WavePassesObliqueJoints) {
  const Column column{.sides = "\"bottom\", \"top\"", .is_oblique = true};
  const Passage passage = pulse_through(column, 0.5 * num_slabs, 1.2, 2.2);
  expect_value(name_of(column) + ": velocity in the middle, m/s", pulse_speed, passage.first, 1e-3);
  expect_below(name_of(column) + ": reflected by a viscous side over what came", 0.01,
               passage.afterwards / pulse_speed);
}

// The free surface doubles it; then it leaves through the bottom, by which it came.
TEST(ViscousSides, FreeSurfaceDoublesTheWave) {
  for (const Column &column : columns()) {
    const Passage passage = pulse_through(column, num_slabs - 0.5, 1.7, 3.7);
    expect_value(name_of(column) + ": velocity of the free surface, m/s", 2.0 * pulse_speed, passage.first,
                 1e-3);
    expect_below(name_of(column) + ": what comes back to the surface over what came", 0.01,
                 passage.afterwards / (2.0 * pulse_speed));
  }
}

// A column at rest on a fixed bottom between rollers stays at rest when all three become viscous: what held
// it stays as constant forces.
TEST(ViscousSides, TakeOverWhatHeldTheSides) {
  std::string toml = head({.normal_stiffness = joint_stiffness, .friction_deg = 30.0});
  toml = without_duration(toml) + R"([region]
material = "rock"
polygon = [[0, 0], [6, 0], [6, 8], [0, 8]]
fixed = ["bottom"]
roller = ["left", "right"]
[[joint_set]]
dip_deg = 0.0
spacing = 1.0
[[joint_set]]
dip_deg = 90.0
spacing = 1.5
[[stage]]
kind = "settle"
limit = 20.0
tolerance = 1e-9
[[stage]]
name = "quiet"
kind = "run"
duration = 1.0
[earthquake]
viscous = ["bottom", "left", "right"]
stage = "quiet"
)";
  Scene scene = scene_of(toml);
  scene.region_blocks = std::make_shared<RegionCutter>(scene);
  Simulation simulation(Communicator::self(), std::move(scene));
  run_stages(simulation, step);
  ASSERT_EQ(simulation.stage_results().size(), 2U);
  EXPECT_EQ(simulation.stage_results()[0].verdict, Verdict::settled);
  for (const Diagnostic &note : simulation.notes()) {
    EXPECT_EQ(note.what.find("goes on with solver"), std::string::npos)
        << "the static solver serves what comes before: " << note.why;
  }
  EXPECT_EQ(simulation.blocks().num_fixed, 0U);
  double fastest = 0.0;
  for (std::size_t row = 0; row < simulation.blocks().num_owned; ++row) {
    fastest = std::max(fastest, norm(simulation.blocks().velocity[row].u));
  }
  // Free fall would be 9.81 m/s; what was out of balance by 1e-9 of the weight at rest is that share of it.
  expect_below("viscous sides: speed 1 s after they have taken over, m/s", 1e-7, fastest);
}

} // namespace
} // namespace gcpdda::testing::viscous_sides_test
