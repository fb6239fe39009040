// Warnings of water tables that act on nothing, or twice.

#include "simulation/simulation.hpp"

#include "support/scenes.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gcpdda::testing::water_doubts_test {
namespace {

std::vector<std::string> warnings_of(const std::string &toml) {
  std::vector<std::string> texts;
  const Simulation simulation(Communicator::world(), scene_of(toml));
  for (const Diagnostic &note : simulation.notes()) {
    if (note.severity == Severity::warning) {
      texts.push_back(to_string(note));
    }
  }
  return texts;
}

void expect_one(const std::vector<std::string> &texts, const std::string &expected) {
  ASSERT_EQ(texts.size(), 1U) << expected << "\n" << fmt::format("{}", fmt::join(texts, "\n"));
  EXPECT_NE(texts[0].find(expected), std::string::npos) << texts[0];
}

/// A slab on a floor, under a joint between their materials.
std::string slab(const std::string &water, const std::string &stages = "") {
  return "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600\n[material.clay]\ndensity = 2000\n"
         "[joint.default]\nnormal_stiffness = 5e9\nfriction_angle_deg = 40\n"
         "[joint.pair]\nmaterials = [\"rock\", \"clay\"]\nfriction_angle_deg = 30\n" +
         water +
         "[[block]]\nname = \"floor\"\nmaterial = \"clay\"\nfixed = true\n"
         "vertices = [[-60, -5], [60, -5], [60, 0], [-60, 0]]\n"
         "[[block]]\nname = \"slab\"\nmaterial = \"rock\"\n"
         "vertices = [[0, 0], [10, 0], [10, 2], [0, 2]]\n"
         "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 20\n" +
         stages;
}

std::string table(const std::string &name, double level, const std::string &more = "") {
  return fmt::format("[water.{}]\nphreatic = [[-50, {}], [50, {}]]\n{}", name, level, level, more);
}

TEST(WaterDoubts, NoneForTablesThatWetSomething) {
  EXPECT_EQ(warnings_of(slab(table("w", 3.0))), std::vector<std::string>{});
  EXPECT_EQ(warnings_of(slab(table("w", 3.0, "joints = [\"pair\"]\n"))), std::vector<std::string>{});
  EXPECT_EQ(warnings_of(slab(table("low", -1.0, "active = false\n"))), std::vector<std::string>{});
}

TEST(WaterDoubts, TableWhoseLawsNoJointHas) {
  expect_one(
      warnings_of(slab(table("w", 3.0, "joints = [\"default\"]\n"))),
      "test.toml:15:10: warning: [water.w] wets no edge of a block that can move, no contact at the start "
      "and no edge without one has its law 'default', list laws of joints between blocks, or leave out "
      "'joints' to wet all edges");
}

TEST(WaterDoubts, TableThatLiesTooLow) {
  expect_one(
      warnings_of(slab(table("w", -1.0))),
      "test.toml:14:12: warning: [water.w] wets no edge of a block that can move, all edges that it may "
      "wet lie above its phreatic line, and it acts on nothing, raise 'phreatic', or leave the table out");
  const std::string rises = "[[stage]]\nname = \"wet\"\nkind = \"settle\"\nlimit = 20\n"
                            "set = { \"water.w.phreatic\" = [[-50, 1], [50, 1]] }\n";
  EXPECT_EQ(warnings_of(slab(table("w", -1.0), rises)), std::vector<std::string>{});
}

TEST(WaterDoubts, TwoTablesThatAddUp) {
  expect_one(
      warnings_of(slab(table("v", 3.0) + table("w", 3.0, "joints = [\"pair\"]\n"))),
      "[water.v] and [water.w] are both active at the start and act on the same edge of block 'slab', "
      "their pressures add up there, set water.v.active = false where water.w is active, or let them wet "
      "different 'joints'");
  const auto raise = [](const std::string &set) {
    return "[[stage]]\nname = \"wet\"\nkind = \"settle\"\nlimit = 20\nset = { \"water.w.active\" = true" +
           set + " }\n";
  };
  const std::string tables = table("v", 1.0) + table("w", 3.0, "active = false\n");
  expect_one(warnings_of(slab(tables, raise(""))), "both active in stage 'wet' and act on the same edge");
  EXPECT_EQ(warnings_of(slab(tables, raise(", \"water.v.active\" = false"))), std::vector<std::string>{});
}

/// A layer of ore on a floor of rock, with a law between them. Both are fixed, and the last stage sets the
/// layer free.
/// @param gap    m, between the two as they are drawn
/// @param wedge  also there is a block that can move from the start, away from them
std::string held_layer(double gap, bool wedge) {
  return "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600\n[material.ore]\ndensity = 3000\n"
         "[joint.default]\nnormal_stiffness = 5e9\nfriction_angle_deg = 40\n"
         "[joint.seam]\nmaterials = [\"rock\", \"ore\"]\nfriction_angle_deg = 30\n" +
         table("w", 9.0, "joints = [\"seam\"]\n") +
         fmt::format("[[block]]\nname = \"b\"\nmaterial = \"ore\"\nfixed = true\n"
                     "vertices = [[0, {0}], [3.47, {0}], [3.47, 5.41], [0, 5.41]]\n",
                     1.16 + gap) +
         "[[block]]\nname = \"a\"\nmaterial = \"rock\"\nfixed = true\n"
         "vertices = [[0, -0.86], [3.47, -0.86], [3.47, 1.16], [0, 1.16]]\n" +
         (wedge ? "[[block]]\nname = \"c\"\nmaterial = \"rock\"\n"
                  "vertices = [[9, 0], [11, 0], [11, 2], [9, 2]]\n"
                : "") +
         "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 20\n"
         "[[stage]]\nname = \"free\"\nkind = \"settle\"\nlimit = 20\n"
         "set = { \"block.b.fixed\" = false }\n";
}

// Faces that are drawn on each other are a joint, also where a rounding or a thousandth parts them.
TEST(WaterDoubts, JointsOfBlocksThatAStageSetsFreeAreWet) {
  for (const bool wedge : {false, true}) {
    for (const double gap : {0.0, 1e-15, 2e-3}) {
      const Simulation simulation(Communicator::self(), scene_of(held_layer(gap, wedge)));
      for (const Diagnostic &note : simulation.notes()) {
        EXPECT_EQ(note.what.find("wets no edge"), std::string::npos) << gap << ": " << to_string(note);
      }
      for (const int block : {0, 1}) {
        const auto wet = simulation.blocks().water_stretches(row_of(simulation, block));
        ASSERT_EQ(wet.size(), 1U) << "block " << block << ", gap " << gap;
        EXPECT_NEAR(wet[0].end - wet[0].begin, 1.0, 1e-12);
      }
    }
  }
}

// Ranks hold other rows in another order: the first block by id is named whoever holds it.
TEST(WaterDoubts, TheFirstBlockIsNamedWhereSeveralAreWetTwice) {
  const std::string free_floor = "[[stage]]\nname = \"free\"\nkind = \"settle\"\nlimit = 20\n"
                                 "set = { \"block.floor.fixed\" = false }\n";
  expect_one(warnings_of(slab(table("v", 3.0) + table("w", 3.0, "joints = [\"pair\"]\n"), free_floor)),
             "act on the same edge of block 'floor'");
}

} // namespace
} // namespace gcpdda::testing::water_doubts_test
