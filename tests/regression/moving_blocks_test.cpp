// Blocks that are under way when a stage begins, and blocks that go too fast for the step.

#include "child_process.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace gcpdda::moving_blocks_test {
namespace {

using testing::block_toml;
using testing::count_of;
using testing::file_text;
using testing::json_value;
using testing::lines_of;
using testing::Outcome;
using testing::rectangle;
using testing::run_gcpdda;
using testing::summary_number;
using testing::WorkFolder;

const std::string rock = "[material.rock]\ndensity = 2600\nyoungs_modulus = 20e9\npoissons_ratio = 0.25\n"
                         "[joint.default]\nnormal_stiffness = 1e9\nfriction_angle_deg = 30\n";

/// The last number of a column of history/NAME.csv.
double last_of(const std::filesystem::path &folder, const std::string &name, const std::string &column) {
  const std::vector<std::string> rows = lines_of(file_text(folder / ("history/" + name + ".csv")));
  const auto cell = [](const std::string &row, std::size_t number) {
    std::size_t at = 0;
    for (std::size_t k = 0; k < number; ++k) {
      at = row.find(',', at) + 1;
    }
    return row.substr(at, row.find(',', at) - at);
  };
  std::size_t number = 0;
  while (cell(rows.front(), number) != column) {
    ++number;
  }
  return std::stod(cell(rows.back(), number));
}

std::string slider(const std::string &fidelity, double speed) {
  return "[run]\nfidelity = \"" + fidelity + "\"\n" + rock +
         block_toml("floor", rectangle({-10.0, -1.0}, {20.0, 0.0}), "fixed = true") +
         block_toml("slider", rectangle({0.0, 0.0}, {1.0, 1.0}),
                    "velocity = [" + std::to_string(speed) + ", 0.0, 0.0]") +
         "[[monitor]]\nblock = \"slider\"\n[[stage]]\nname = \"rest\"\nkind = \"settle\"\nlimit = 5\n";
}

// Damped motion takes more than the friction that would stop it after v^2/(2 mu g), and does not take it to
// where it began.
TEST(MovingBlocks, RestWhereTheirMotionEnds) {
  for (const std::string fidelity : {"rigid", "auto"}) {
    const WorkFolder folder;
    folder.write("slider.toml", slider(fidelity, 3.0));
    const Outcome outcome = run_gcpdda(0, {"run", "slider.toml", "--out", "out"}, folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "stage 'rest' goes on with solver = \"dynamic\", blocks are under way"),
              1)
        << outcome.err;
    const double moved = last_of(folder / "out", "slider", "ux[m]");
    const double whole = 9.0 / (2.0 * 9.81 * std::tan(std::numbers::pi / 6.0));
    EXPECT_GT(moved, 0.2 * whole);
    EXPECT_LT(moved, whole);
  }
}

// Motion that could lift a block by a hundred-thousandth of its size is for the static solver, and what it
// takes stands in the ledger.
TEST(MovingBlocks, LittleMotionIsTakenAndBooked) {
  for (const std::string fidelity : {"rigid", "auto"}) {
    const WorkFolder folder;
    folder.write("slider.toml", slider(fidelity, 0.014));
    const Outcome outcome = run_gcpdda(0, {"run", "slider.toml", "--out", "out"}, folder);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(count_of(outcome.err, "goes on with"), 0) << outcome.err;
    const double kinetic = 0.5 * 2600.0 * 0.014 * 0.014;
    EXPECT_LT(std::abs(std::stod(json_value(folder / "out/summary.json", "residual"))), 0.1 * kinetic);
  }
}

// Without gravity a square that trembles is for the static solver, and one that would go by its size within
// the limit is not.
TEST(MovingBlocks, WithoutGravityTheLimitSaysWhatIsFast) {
  const WorkFolder folder;
  const auto is_under_way = [&](const std::string &fidelity, double speed, const std::string &limit) {
    folder.write("slider.toml", slider(fidelity, speed));
    const Outcome outcome = run_gcpdda(0,
                                       {"run", "slider.toml", "--out", "out", "--overwrite", "--set",
                                        "run.gravity=[0, 0]", "--set", "stage.rest.limit=" + limit},
                                       folder);
    return count_of(outcome.err, "blocks are under way") == 1;
  };
  for (const std::string fidelity : {"rigid", "auto"}) {
    EXPECT_FALSE(is_under_way(fidelity, 1e-6, "2.0"));
    EXPECT_FALSE(is_under_way(fidelity, 1.0, "0.5"));
    EXPECT_TRUE(is_under_way(fidelity, 1.0, "2.0"));
  }
}

// A plate of 0.02 m lets no block move by more than 5 mm in a step; once it is excavated it has no say.
TEST(MovingBlocks, ExcavatedBlocksBoundNoMotion) {
  const WorkFolder folder;
  folder.write("fall.toml", "[run]\nfidelity = \"rigid\"\ntime_step = 5e-4\n[output]\ninterval = 0.1\n" +
                                rock +
                                block_toml("floor", rectangle({-10.0, -1.0}, {40.0, 0.0}), "fixed = true") +
                                block_toml("plate", rectangle({20.0, 0.5}, {25.0, 0.52}), "fixed = true") +
                                block_toml("other", rectangle({30.0, 0.5}, {32.0, 2.5}), "fixed = true") +
                                block_toml("stone", rectangle({0.0, 20.0}, {1.0, 21.0})) +
                                "[[stage]]\nname = \"first\"\nkind = \"run\"\nduration = 0.1\n"
                                "[[stage]]\nname = \"out\"\nkind = \"excavate\"\nblocks = [\"plate\"]\n"
                                "[[stage]]\nname = \"fall\"\nkind = \"run\"\nduration = 1.8\n");
  const Outcome fall = run_gcpdda(0, {"run", "fall.toml", "--out", "fall"}, folder);
  EXPECT_EQ(fall.exit_code, 0) << fall.err; // at 17.7 m/s it moves by 8.8 mm in a step
  const Outcome kept =
      run_gcpdda(0, {"run", "fall.toml", "--out", "kept", "--set", "stage.out.blocks=[\"other\"]"}, folder);
  EXPECT_EQ(kept.exit_code, 5) << kept.err;
  EXPECT_EQ(count_of(kept.err, "though none is near it now"), 1) << kept.err;
}

TEST(MovingBlocks, MassDampingIsTold) {
  const WorkFolder folder;
  folder.write("slider.toml", slider("rigid", 0.0));
  const Outcome outcome = run_gcpdda(
      0, {"run", "slider.toml", "--out", "out", "--set", "run.rayleigh={ratio=0.05, frequency=2.0}"}, folder);
  EXPECT_EQ(count_of(outcome.err, "rayleigh damping takes 0.63 of its speed a second"), 1) << outcome.err;
}

TEST(MovingBlocks, StrongDashpotsAreTold) {
  const WorkFolder folder;
  folder.write("slider.toml", slider("rigid", 0.0));
  for (const std::string damping : {"0.3", "1.0"}) {
    const Outcome outcome = run_gcpdda(0,
                                       {"run", "slider.toml", "--out", "out", "--overwrite", "--set",
                                        "stage.rest.kind=run", "--set", "run.contact_damping=" + damping},
                                       folder);
    EXPECT_EQ(count_of(outcome.err, "a part of impacts has no friction"), damping == "1.0" ? 1 : 0)
        << outcome.err;
  }
}

} // namespace
} // namespace gcpdda::moving_blocks_test
