// Warnings about bolts that hold nothing because an end lies on an edge, which is in no block.

#include "simulation/simulation.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

namespace gcpdda::testing::bolt_notes_test {
namespace {

/// What is said of a bolt between two blocks of 1 m with 0.5 m of air between them.
std::string said_of_bolt(double from, double to) {
  const Simulation simulation(
      Communicator::self(),
      scene_of(
          "[run]\nduration = 0.1\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2000\n[joint.default]\n"
          "normal_stiffness = 1e7\nfriction_angle_deg = 30\n" +
          block_toml("left", rectangle({0.0, 0.0}, {1.0, 1.0}), "fixed = true") +
          block_toml("right", rectangle({1.5, 0.0}, {2.5, 1.0})) +
          fmt::format("[support.steel]\nkind = \"anchored\"\naxial_stiffness = 1e7\n"
                      "[[bolt]]\nsupport = \"steel\"\nfrom = [{}, 0.5]\nto = [{}, 0.5]\n",
                      from, to)));
  std::string said;
  for (const Diagnostic &note : simulation.notes()) {
    const std::string text = to_string(note);
    said +=
        text.find("bolt 'bolt0'") == std::string::npos ? "" : text.substr(text.find("bolt 'bolt0'")) + "\n";
  }
  return said;
}

TEST(BoltNotes, SayWhichEndLiesInNoBlockAndHowToMoveIt) {
  EXPECT_EQ(said_of_bolt(1.0, 1.5),
            "bolt 'bolt0' lies outside the blocks, it holds nothing, move 'from' and 'to' "
            "into blocks; an end on an edge lies in none\n");
  EXPECT_EQ(said_of_bolt(0.5, 1.5),
            "bolt 'bolt0' crosses no joint, and its tip lies in no block, it acts only "
            "between two blocks, and an end on an edge lies in none, move 'to' into a "
            "block\n");
  EXPECT_EQ(said_of_bolt(1.0, 2.0),
            "bolt 'bolt0' crosses no joint, and its head lies in no block, it acts only "
            "between two blocks, and an end on an edge lies in none, move 'from' into a "
            "block\n");
  EXPECT_EQ(said_of_bolt(0.2, 0.8), "bolt 'bolt0' crosses no joint, it acts only between two blocks, make it "
                                    "longer, or leave it out\n");
  EXPECT_EQ(said_of_bolt(0.5, 2.0), "");
}

} // namespace
} // namespace gcpdda::testing::bolt_notes_test
