// Bolts on many ranks: the same bytes as on one, through migration, refresh, stages and a restart.

#include "base/text.hpp"
#include "driver/restart.hpp"
#include "gcpdda/driver/run.hpp"
#include "io/checkpoint/checkpoint_reader.hpp"
#include "io/results/run_comparison.hpp"
#include "shared_folder.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <sstream>

namespace gcpdda::bolts_test {
namespace {

namespace fs = std::filesystem;
using testing::summary_number;

/// A thrown wall of rigid and deformable bricks that tears at grouted bolts through its courses and cables
/// right across it; half of them are put in, and one cable taken out, on the way. Steel yields and breaks.
std::string bolted_wall_toml() {
  std::string toml = testing::mixed_wall_toml(24, 14, 0.02);
  toml.erase(toml.find("duration"), std::string("duration = 0.02\n").size());
  toml += "[support.bolt]\nkind = \"grouted\"\naxial_stiffness = 4e8\naxial_yield = 3e5\nshear_stiffness = "
          "1e8\nshear_yield = 1e5\nactive_length = 0.2\nrupture_strain = 0.01\npretension = 5e4\n"
          "bond_strength = 4e5\nspacing = 2.0\n"
          "[support.cable]\nkind = \"anchored\"\naxial_rigidity = 2e8\naxial_yield = 4e5\npretension = 2e5\n";
  for (int k = 0; k < 12; ++k) {
    toml += fmt::format("[[bolt]]\nname = \"bolt{0}\"\nsupport = \"bolt\"\nfrom = [{1}, 23.6]\nto = [{2}, "
                        "0.4]\nactive = {3}\n",
                        k, 1.3 + 2 * k, 1.9 + 2 * k, k % 2 == 0);
  }
  for (int k = 0; k < 5; ++k) {
    toml += fmt::format(
        "[[bolt]]\nname = \"cable{0}\"\nsupport = \"cable\"\nfrom = [0.4, {1}]\nto = [26.2, {2}]\n", k,
        1.3 + 4 * k, 2.1 + 3.9 * k);
  }
  toml += "[[stage]]\nkind = \"run\"\nduration = 0.01\n"
          "[[stage]]\nkind = \"run\"\nduration = 0.01\nset = { \"bolt.cable2.active\" = false";
  for (int k = 1; k < 12; k += 2) {
    toml += fmt::format(", \"bolt.bolt{}.active\" = true", k);
  }
  return toml + " }\n";
}

/// A wall of rigid and deformable bricks that settles with bars through its courses and slack cables along
/// them, and again when a brick is taken out and the wall gets heavier. The bars yield.
std::string settling_bolted_wall_toml() {
  std::string toml = "[run]\n[material.rock]\ndensity = 2600.0\nyoungs_modulus = 2e9\n"
                     "poissons_ratio = 0.25\n[joint.default]\nnormal_stiffness = 5e8\n"
                     "friction_angle_deg = 45.0\n[output]\ninterval = 0.02\n"
                     "[support.bar]\nkind = \"grouted\"\naxial_stiffness = 4e7\naxial_yield = 5e3\n"
                     "shear_stiffness = 1e7\nshear_yield = 2e3\nactive_length = 0.2\n"
                     "[support.cable]\nkind = \"anchored\"\naxial_rigidity = 2e8\n";
  const int columns = 32;
  const int rows = 30;
  toml +=
      testing::block_toml("floor", testing::rectangle({-2.0, -1.0}, {columns + 3.0, 0.0}), "fixed = true");
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 low{column + 0.3 * (row % 2), 0.5 * row};
      toml += testing::block_toml(
          fmt::format("b{}_{}", row, column), testing::rectangle(low, low + Vec2{1.0, 0.5}),
          fmt::format("fidelity = \"{}\"", (row + column) % 2 == 0 ? "deformable" : "rigid"));
    }
  }
  for (int k = 0; k < 10; ++k) {
    toml += fmt::format("[[bolt]]\nname = \"bar{}\"\nsupport = \"bar\"\nfrom = [{}, 14.8]\nto = [{}, 0.2]\n",
                        k, 1.3 + 3 * k, 2.6 + 3 * k);
  }
  for (int k = 0; k < 4; ++k) {
    toml += fmt::format(
        "[[bolt]]\nname = \"cable{0}\"\nsupport = \"cable\"\nfrom = [0.7, {1}]\nto = [31.7, {1}]\n", k,
        2.25 + 3 * k);
  }
  const std::string settle = "kind = \"settle\"\nlimit = 30.0\n";
  return toml + "[[stage]]\nname = \"weight\"\n" + settle +
         "[[stage]]\nkind = \"excavate\"\nblocks = [\"b5_10\"]\n"
         "[[stage]]\nname = \"heavier\"\n" +
         settle + "set = { \"material.rock.density\" = 3000.0 }\n";
}

/// Sum of a column of history/bolts.csv over the rows of its last time.
double last_sum(const fs::path &run, std::size_t column) {
  const std::vector<std::string> lines = testing::lines_of(testing::file_text(run / "history/bolts.csv"));
  const std::string time = lines.back().substr(0, lines.back().find(','));
  double sum = 0.0;
  for (const std::string &line : lines) {
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t k = 0; k <= column; ++k) {
      std::getline(cells, cell, ',');
    }
    sum += line.starts_with(time + ",") ? std::stod(cell) : 0.0;
  }
  return sum;
}

/// The table of summary.json against the rows of history/bolts.csv: largest forces are those of the last row
/// of a bolt and no less than what any row has, and times at which bolts were put in are those of the rows,
/// up to the row before the first of each.
void expect_loads_of_history(const fs::path &run) {
  std::map<std::string, std::array<double, 2>> largest;
  double last = 0.0;
  std::string last_names;
  for (const std::string &line : testing::lines_of(testing::file_text(run / "history/bolts.csv"))) {
    const CsvRow<15> row(line);
    if (row.fields[0] == "time[s]") {
      continue;
    }
    const auto number = [&](std::size_t k) { return std::stod(std::string(row.fields[k])); };
    auto &[axial, shear] = largest[std::string(row.fields[1])];
    EXPECT_GE(number(13), std::max(axial, number(6)));
    EXPECT_GE(number(14), std::max(shear, number(7)));
    axial = number(13);
    shear = number(14);
    const double time = number(0);
    last_names = time > last ? "" : last_names;
    last_names += "," + std::string(row.fields[1]) + ",";
    last = time;
  }
  std::string table = testing::summary_text(run, "bolts");
  EXPECT_EQ(testing::count_of(table, "\"name\""), std::ssize(largest));
  EXPECT_EQ(largest.size(), 17U);
  for (const auto &[name, forces] : largest) {
    const std::size_t begin = table.find("{\"name\": \"" + name + "\"");
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string entry = table.substr(begin, table.find('}', begin) - begin);
    const auto holds = [&](const std::string &member) { return entry.find(member) != std::string::npos; };
    EXPECT_TRUE(holds(fmt::format("\"largest_axial\": {}, \"largest_shear\": {},", forces[0], forces[1])))
        << entry;
    const bool comes_later = name.starts_with("bolt") && std::stoi(name.substr(4)) % 2 == 1;
    EXPECT_TRUE(holds(comes_later ? "\"installed\": 0.01," : "\"installed\": 0,")) << entry;
    const bool in_place = last_names.find("," + name + ",") != std::string::npos;
    EXPECT_TRUE(holds(in_place ? "\"in_place\": true" : "\"in_place\": false")) << entry;
    EXPECT_EQ(in_place, name != "cable2");
  }
}

TEST(Bolts, AreTheSameOnAnyNumberOfRanksAndThroughARestart) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const Scene scene = testing::scene_of(bolted_wall_toml(), {"output.interval=0.01"});
  const fs::path together = folder.path("together");
  const fs::path alone = folder.path("alone");
  const fs::path resumed = folder.path("resumed");
  EXPECT_EQ(run_scene(world, scene, {together, false}), 0);
  world.barrier();
  if (world.is_root()) { // back to the end of the first stage
    fs::copy(together, resumed, fs::copy_options::recursive);
    const std::vector<fs::path> checkpoints = checkpoint_files(resumed);
    EXPECT_EQ(checkpoints.size(), 2U);
    fs::remove(checkpoints.back());
  }
  world.barrier();
  EXPECT_EQ(restart_scene(world, scene, scene, resumed), 0);
  world.barrier();
  if (world.is_root()) {
    EXPECT_EQ(run_scene(Communicator::self(), scene, {alone, false}), 0);
    for (const fs::path &run : {together, resumed}) {
      for (const std::string &difference : compare_runs(run, alone)) {
        ADD_FAILURE() << run.filename() << ": " << difference;
      }
    }
    EXPECT_EQ(testing::summary_text(together, "energy"), testing::summary_text(alone, "energy"));
    for (const fs::path &run : {together, resumed}) {
      EXPECT_EQ(testing::summary_text(run, "bolts"), testing::summary_text(alone, "bolts"));
      EXPECT_TRUE(fs::exists(run / "frames/bolts_000002.hdf"));
    }
    expect_loads_of_history(alone);
    EXPECT_EQ(summary_number(resumed, "restarted_at"), 0.01);
    constexpr std::size_t joints = 10;
    EXPECT_GE(last_sum(alone, joints), 100);
    EXPECT_GE(last_sum(alone, joints + 1), 20) << "yielded";
    EXPECT_GE(last_sum(alone, joints + 2), 5) << "broken";
    EXPECT_GE(summary_number(together, "refreshes"), 1);
    if (world.size() > 1) {
      EXPECT_GE(summary_number(together, "migrations"), 1);
      EXPECT_GE(summary_number(together, "cross_rank_contacts"), 50);
    }
  }
  world.barrier();
}

/// Bolts whose largest tension so far exceeds that of every row.
int loaded_between_rows(const fs::path &run) {
  std::map<std::string, std::array<double, 2>> largest;
  for (const std::string &line : testing::lines_of(testing::file_text(run / "history/bolts.csv"))) {
    const CsvRow<15> row(line);
    if (row.fields[0] != "time[s]") {
      auto &[of_rows, so_far] = largest[std::string(row.fields[1])];
      of_rows = std::max(of_rows, std::stod(std::string(row.fields[6])));
      so_far = std::stod(std::string(row.fields[13]));
    }
  }
  return static_cast<int>(std::count_if(largest.begin(), largest.end(),
                                        [](const auto &bolt) { return bolt.second[1] > bolt.second[0]; }));
}

// A checkpoint between two rows has what links have borne since the first of them; elastic ones, which swing.
TEST(Bolts, KeepTheirLargestForcesThroughARestartBetweenTwoRows) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const Scene scene = testing::scene_of(
      bolted_wall_toml(),
      {"output.interval=0.01", "output.history_interval=0.01", "output.checkpoint_interval=0.008",
       "support.bolt.axial_yield=1e12", "support.bolt.shear_yield=1e12", "support.bolt.bond_strength=1e12",
       "support.bolt.rupture_strain=1.0", "support.cable.axial_yield=1e12"});
  const fs::path whole = folder.path("whole");
  const fs::path resumed = folder.path("resumed");
  EXPECT_EQ(run_scene(world, scene, {whole, false}), 0);
  world.barrier();
  if (world.is_root()) {
    fs::copy(whole, resumed, fs::copy_options::recursive);
    fs::remove(checkpoint_files(resumed).back());
  }
  world.barrier();
  EXPECT_EQ(restart_scene(world, scene, scene, resumed), 0);
  world.barrier();
  if (world.is_root()) {
    EXPECT_GT(summary_number(resumed, "restarted_at"), 0.011);
    EXPECT_LT(summary_number(resumed, "restarted_at"), 0.0195);
    EXPECT_GE(loaded_between_rows(whole), 3);
    EXPECT_EQ(testing::summary_text(resumed, "bolts"), testing::summary_text(whole, "bolts"));
    for (const std::string &difference : compare_runs(resumed, whole)) {
      ADD_FAILURE() << difference;
    }
  }
  world.barrier();
}

TEST(Bolts, AreTheSameInStaticStages) {
  const Communicator world = Communicator::world();
  const testing::SharedFolder folder(world);
  const testing::CapturedLog log;
  const Scene scene = testing::scene_of(settling_bolted_wall_toml());
  const fs::path together = folder.path("together");
  const fs::path alone = folder.path("alone");
  EXPECT_EQ(run_scene(world, scene, {together, false}), 0);
  world.barrier();
  if (world.is_root()) {
    EXPECT_EQ(run_scene(Communicator::self(), scene, {alone, false}), 0);
    for (const std::string &difference : compare_runs(together, alone)) {
      ADD_FAILURE() << difference;
    }
    EXPECT_EQ(testing::summary_text(together, "energy"), testing::summary_text(alone, "energy"));
    EXPECT_EQ(testing::file_text(alone / "run.log").find("goes on with solver"), std::string::npos);
    constexpr std::size_t joints = 10;
    EXPECT_GE(last_sum(alone, joints), 100);
    EXPECT_GE(last_sum(alone, joints + 1), 20) << "yielded";
    if (world.size() > 1) {
      EXPECT_GE(summary_number(together, "cross_rank_contacts"), 50);
    }
  }
  world.barrier();
}

} // namespace
} // namespace gcpdda::bolts_test
