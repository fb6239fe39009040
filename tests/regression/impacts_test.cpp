// What a run says of impacts whose energy the time step changes.

#include "child_process.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <regex>

namespace gcpdda::impacts_test {
namespace {

using testing::block_toml;
using testing::count_of;
using testing::file_text;
using testing::lines_of;
using testing::Outcome;
using testing::rectangle;
using testing::run_gcpdda;
using testing::WorkFolder;

struct Told {
  double begin = 0.0;
  double end = 0.0;
  double gained = 0.0; ///< J/m, negative where lost
  double percent = 0.0;
  double energy = 0.0;
  std::string key; ///< of the hint, "run.safety" or "run.time_step"
  std::string value;
};

std::optional<Told> told_by(const Outcome &outcome) {
  static const std::regex pattern(
      "warning: impacts between t = (\\S+) and (\\S+) s (gained|lost) (\\S+) J/m, "
      "(\\S+) % of their energy of (\\S+) J/m, by the time step alone, .*, use "
      "(\\S+) = (\\S+) or less");
  std::smatch found;
  if (!std::regex_search(outcome.err, found, pattern)) {
    EXPECT_EQ(count_of(outcome.err, "by the time step alone"), 0) << outcome.err;
    return std::nullopt;
  }
  EXPECT_EQ(count_of(outcome.err, "by the time step alone"), 1) << "it is told once: " << outcome.err;
  const double sign = found[3] == "gained" ? 1.0 : -1.0;
  return Told{std::stod(found[1]),
              std::stod(found[2]),
              sign * std::stod(found[4]),
              std::stod(found[5]),
              std::stod(found[6]),
              found[7],
              found[8]};
}

constexpr double density = 2500.0;
constexpr double stiffness = 1e9;

/// A square that flies flush onto a floor and back, without gravity, friction and damping.
std::string square_on_floor(double speed, const std::string &extra = "") {
  return fmt::format("[run]\nduration = 0.4\ngravity = [0, 0]\nfidelity = \"rigid\"\ncontact_damping = 0\n{}"
                     "[material.rock]\ndensity = {}\n[joint.default]\nnormal_stiffness = {}\n"
                     "friction_angle_deg = 0\n[output]\ninterval = 0.02\n",
                     extra, density, stiffness) +
         block_toml("floor", rectangle({-5.0, -1.0}, {5.0, 0.0}), "fixed = true") +
         block_toml("square", rectangle({0.0, 0.1}, {1.0, 1.1}),
                    fmt::format("velocity = [0, -{}, 0]", speed));
}

double kinetic_at_end(const WorkFolder &folder) {
  const std::string row = lines_of(file_text(folder / "out/history/energy.csv")).back();
  return std::stod(row.substr(row.find(',') + 1));
}

// The energy that the impact has changed is that of the flight before and after it. It is told if and only if
// it is more than 1 %, gains as well as losses; which speed gives which is chance.
TEST(Impacts, AreToldWithWhatTheyGained) {
  const WorkFolder folder;
  int silent = 0;
  int gains = 0;
  int losses = 0;
  for (const double speed : {1.0, 1.01, 1.03, 1.05}) {
    folder.write("scene.toml", square_on_floor(speed));
    const Outcome outcome = run_gcpdda(0, {"run", "scene.toml", "--out", "out", "--overwrite"}, folder);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const double before = 0.5 * density * speed * speed;
    const double gained = kinetic_at_end(folder) - before;
    const auto told = told_by(outcome);
    ASSERT_EQ(told.has_value(), std::abs(gained) > 0.01 * before) << gained / before << outcome.err;
    if (!told) {
      ++silent;
      continue;
    }
    (gained > 0.0 ? gains : losses) += 1;
    EXPECT_NEAR(told->gained, gained, 5e-3 * std::abs(gained)) << "three digits";
    // m (v + v')^2/8, with v' the speed after it, for m v^2/2; two digits.
    EXPECT_NEAR(told->percent, 100.0 * std::abs(gained) / before, 0.1 * told->percent);
    EXPECT_LE(told->begin, 0.1 / speed) << "the gap of 0.1 m is crossed then";
    EXPECT_GT(told->end, 0.1 / speed);
    // Its step keeps the impact: no more than half of 1 % by chance, 1 % in any case.
    const Outcome better = run_gcpdda(
        0, {"run", "scene.toml", "--out", "out", "--overwrite", "--set", told->key + "=" + told->value},
        folder);
    EXPECT_EQ(told->key, "run.safety");
    EXPECT_FALSE(told_by(better)) << better.err;
    EXPECT_LT(std::abs(kinetic_at_end(folder) - before), 0.01 * before);
  }
  EXPECT_EQ(silent, 1);
  EXPECT_GE(gains, 1);
  EXPECT_GE(losses, 1);
}

// The same words on any ranks; a step given in seconds, here that of safety 0.55, gets its hint in seconds.
TEST(Impacts, AreToldAlikeOnAnyRanksAndForAGivenStep) {
  const WorkFolder folder;
  folder.write("scene.toml", square_on_floor(1.03) + block_toml("far", rectangle({-4.0, 0.0}, {-3.0, 1.0}),
                                                                "velocity = [0, 1, 0]"));
  std::vector<std::string> words;
  for (const int ranks : {0, 2, 3}) {
    const Outcome outcome = run_gcpdda(ranks, {"run", "scene.toml", "--out", "out", "--overwrite"}, folder);
    const std::size_t begin = outcome.err.find("warning: impacts");
    ASSERT_NE(begin, std::string::npos) << outcome.err;
    words.push_back(outcome.err.substr(begin, outcome.err.find('\n', begin) - begin));
    EXPECT_EQ(words.back(), words.front());
  }
  folder.write("scene.toml", square_on_floor(1.03, fmt::format("time_step = {}\n", 0.02 / 23.0)));
  const auto told = told_by(run_gcpdda(0, {"run", "scene.toml", "--out", "out", "--overwrite"}, folder));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->key, "run.time_step");
  EXPECT_LT(std::stod(told->value), 0.02 / 23.0);
}

/// A thin bar that tips over and strikes a floor, with the usual contact damping.
std::string falling_bar() {
  constexpr double friction_angle = 71.56505117707799;
  return fmt::format("[run]\nduration = 2.0\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n"
                     "[joint.default]\nnormal_stiffness = 1e10\nfriction_angle_deg = {}\n[output]\n"
                     "interval = 0.05\nhistory_interval = 0.005\n",
                     friction_angle) +
         block_toml("floor", rectangle({-50.0, -1.0}, {50.0, 0.0}), "fixed = true") +
         block_toml("bar",
                    {{0.0, 0.05},
                     {0.08660254037844387, 0.0},
                     {2.0866025403784443, 3.4641016151377544},
                     {2.0, 3.514101615137754}},
                    "velocity = [5, 0, 0]");
}

// Contact damping takes energy, and the step takes its share too: damped impacts are told as well.
TEST(Impacts, AreToldOfADampedFallAndTheHintMendsIt) {
  const WorkFolder folder;
  folder.write("bar.toml", falling_bar());
  const auto told = told_by(run_gcpdda(0, {"run", "bar.toml", "--out", "out"}, folder));
  ASSERT_TRUE(told);
  EXPECT_EQ(told->key, "run.safety");
  EXPECT_FALSE(told_by(run_gcpdda(
      0, {"run", "bar.toml", "--out", "out", "--overwrite", "--set", "run.safety=" + told->value}, folder)));
}

// Joints that close under sudden weight and swing, friction that slides: nothing parts, nothing is told.
TEST(Impacts, AreNotToldWhereThereAreNone) {
  const WorkFolder folder;
  for (const char *angle : {"0.0", "30.0"}) {
    folder.write("scene.toml",
                 "[run]\nduration = 0.5\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2500\n"
                 "[joint.default]\nnormal_stiffness = 1e8\nfriction_angle_deg = " +
                     std::string(angle) + "\n[output]\ninterval = 0.02\n" +
                     block_toml("floor", rectangle({-9.0, -1.0}, {9.0, 0.0}), "fixed = true") +
                     block_toml("lower", rectangle({0.0, 0.0}, {2.0, 1.0}), "velocity = [1, 0, 0]") +
                     block_toml("upper", rectangle({0.5, 1.0}, {1.5, 2.0}), "velocity = [1, 0, 0]"));
    const Outcome outcome = run_gcpdda(0, {"run", "scene.toml", "--out", "out", "--overwrite"}, folder);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_FALSE(told_by(outcome));
  }
}

// A deformable bar hangs by a fixed point and swings: the error of its energy is that of its own vibrations.
TEST(Impacts, AreNotToldOfABlockThatTouchesNothing) {
  const WorkFolder folder;
  const std::string bar =
      "[run]\nduration = 1.0\nfidelity = \"deformable\"\n[material.rock]\ndensity = 2500\n"
      "youngs_modulus = 1e9\npoissons_ratio = 0.2\n[joint.default]\nnormal_stiffness = 1e9\n"
      "friction_angle_deg = 30\n" +
      block_toml("bar", rectangle({-0.05, -1.0}, {0.05, 0.0}), "fixed_points = [[0, 0]]");
  for (const char *time_step : {"\"auto\"", "0.01"}) {
    folder.write("bar.toml", bar);
    const Outcome outcome = run_gcpdda(0,
                                       {"run", "bar.toml", "--out", "out", "--overwrite", "--set",
                                        fmt::format("run.time_step={}", time_step)},
                                       folder);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "impacts"), 0) << outcome.err;
  }
}

// Bolts and a liner around an opening join blocks on which nothing acts: what moves is round-off.
TEST(Impacts, AreNotToldOfRoundOff) {
  const WorkFolder folder;
  folder.write("still.toml", R"([run]
duration = 0.001
gravity = [0, 0]
fidelity = "rigid"
[material.rock]
density = 2000.0
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 30
[region]
material = "rock"
polygon = [[-20, -20], [20, -20], [20, 20], [-20, 20]]
fixed = ["bottom"]
min_width = 0
slivers = "keep"
[[opening]]
name = "d"
shape = "d"
centre = [0, 0]
width = 6
height = 6
excavated = true
[support.b]
kind = "grouted"
axial_stiffness = 1e7
active_length = 0.5
[support.l]
kind = "liner"
thickness = 0.1
youngs_modulus = 1e10
[[joint_set]]
dip_deg = 35
spacing = 0.7
[[joint_set]]
dip_deg = 125
spacing = 0.7
[[bolt_pattern]]
name = "p"
support = "b"
opening = "d"
length = 3
from_angle_deg = -90
to_angle_deg = 270
spacing = 1.5
[[liner]]
name = "l"
support = "l"
opening = "d"
from_angle_deg = -90
to_angle_deg = 270
)");
  const Outcome outcome = run_gcpdda(0, {"run", "still.toml", "--out", "out"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "by the time step alone"), 0) << outcome.err;
}

// The linear potential halves the force on a flush face; a block at rest swings to twice the overlap. No
// energy belongs to its forces, and the residual of the ledger holds what they work.
TEST(Impacts, AreNotToldOfTheLinearPotential) {
  const WorkFolder folder;
  folder.write("cube.toml",
               "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600\n[joint.default]\n"
               "normal_stiffness = 1e9\nfriction_angle_deg = 30\n[output]\ninterval = 0.1\n" +
                   block_toml("floor", rectangle({-2.0, -1.0}, {5.0, 0.0}), "fixed = true") +
                   block_toml("cube", rectangle({0.0, 0.0}, {2.0, 2.0})) +
                   "[[stage]]\nkind = \"settle\"\nlimit = 5\n[[stage]]\nkind = \"run\"\nduration = 0.5\n"
                   "set = { \"run.potential\" = \"linear\" }\n");
  const Outcome outcome = run_gcpdda(0, {"run", "cube.toml", "--out", "out"}, folder);
  EXPECT_EQ(count_of(outcome.err, "by the time step alone"), 0) << outcome.err;
}

// A slope that has settled and goes on without damping: its contacts tremble by a thousandth of what they
// have closed by.
TEST(Impacts, AreNotToldOfRockAtRest) {
  const WorkFolder folder;
  std::string slope = testing::shipped_toml("deformable_slope");
  slope.resize(slope.find("[fos]"));
  folder.write("slope.toml", slope + "[[stage]]\nkind = \"run\"\nduration = 2.0\n"
                                     "set = { \"run.contact_damping\" = 0.0 }\n");
  const Outcome outcome = run_gcpdda(0, {"run", "slope.toml", "--out", "out"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_FALSE(told_by(outcome));
}

/// A bonded column of ten deformable slabs without gravity, through which a pulse of 1 ms runs upwards.
std::string column_of_slabs() {
  std::string scene = R"([run]
gravity = [0, 0]
fidelity = "deformable"
[material.rock]
density = 2600
youngs_modulus = 5e10
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 2e12
tangential_ratio = 0.5
friction_angle_deg = 60
cohesion = 1e9
tension = 1e6
[region]
material = "rock"
polygon = [[0, 0], [2, 0], [2, 5], [0, 5]]
[earthquake]
record = "pulse.csv"
viscous = ["bottom", "top"]
[output]
interval = 0.0015
history_interval = 3e-6
[[stage]]
kind = "run"
duration = 0.0015
)";
  for (int k = 1; k < 10; ++k) {
    scene += fmt::format("[[fault]]\npoints = [[-1, {0}], [3, {0}]]\n", 0.5 * k);
  }
  return scene;
}

// The first rows of a record move blocks by next to nothing: what a stage moves in all is known at its end.
TEST(Impacts, AreNotToldOfTheBeginningOfARecord) {
  const WorkFolder folder;
  folder.write("column.toml", column_of_slabs());
  std::string pulse;
  for (int k = 0; k <= 500; ++k) {
    const double t = 3e-6 * k;
    pulse += fmt::format("{:.6f}, 0, {}\n", t,
                         k <= 333 ? 0.005 * (1.0 - std::cos(2e3 * std::numbers::pi * t)) : 0.0);
  }
  folder.write("pulse.csv", pulse);
  const Outcome outcome = run_gcpdda(0, {"run", "column.toml", "--out", "out"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "by the time step alone"), 0) << outcome.err;
}

} // namespace
} // namespace gcpdda::impacts_test
