// Warnings about bolts that hold nothing because an end lies on an edge, which is in no block.

#include "simulation/simulation.hpp"
#include "support/scenes.hpp"
#include "support/setting.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

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

/// Three layers, of which the upper one can move, under a cap.
std::string layers_toml(const std::string &support) {
  std::string toml = "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2000\n[joint.default]\n"
                     "normal_stiffness = 1e8\nfriction_angle_deg = 30\n[support.steel]\n" +
                     support;
  for (int k = 0; k < 3; ++k) {
    toml += block_toml(fmt::format("b{}", k), rectangle({0.0, 1.0 * k}, {4.0, 1.0 + k}),
                       k < 2 ? "fixed = true" : "");
  }
  toml += block_toml("cap", rectangle({0.0, 3.0}, {4.0, 3.5}));
  return toml;
}

/// What is said of two bolts through three blocks above each other, of which a stage excavates one.
std::string said_of_cut(const std::string &support, const std::string &excavated,
                        const std::string &stage = "") {
  std::string toml = layers_toml(support);
  for (const double x : {1.0, 3.0}) {
    toml += fmt::format("[[bolt]]\nname = \"at{0}\"\nsupport = \"steel\"\nfrom = [{0}, 0.5]\n"
                        "to = [{0}, 2.5]\n",
                        x);
  }
  toml += "[[stage]]\nkind = \"run\"\nduration = 0.01\n" + stage +
          fmt::format("[[stage]]\nname = \"cut\"\nkind = \"excavate\"\nblocks = [\"{}\"]\n", excavated);
  Simulation simulation(Communicator::self(), scene_of(toml));
  const std::size_t at_start = simulation.notes().size();
  run_stages(simulation);
  EXPECT_TRUE(at_start == simulation.notes().size() || !stage.empty()) << "said twice";
  std::string said;
  for (const Diagnostic &note : simulation.notes()) {
    said += note.what.starts_with("bolt") ? note.what + "\n" : "";
  }
  return said;
}

TEST(BoltNotes, SayWhichBoltsAnExcavationCuts) {
  const std::string cable = "kind = \"anchored\"\naxial_stiffness = 1e7\n";
  const std::string bar = "kind = \"grouted\"\naxial_stiffness = 1e7\nactive_length = 0.2\nplate = true\n"
                          "bond_strength = 1e5\n";
  EXPECT_EQ(said_of_cut(cable, "b0"), "bolt 'at1' and 1 more are taken away by stage 'cut'\n");
  EXPECT_EQ(said_of_cut(cable, "b1"),
            "bolt 'at1' and 1 more cross rock between head and anchor that stage 'cut' excavates\n");
  EXPECT_EQ(said_of_cut(cable, "b1", "[[stage]]\nkind = \"change\"\nset = { \"bolt.at3.active\" = false }\n"),
            "bolt 'at1' crosses rock between head and anchor that stage 'cut' excavates\n");
  EXPECT_EQ(said_of_cut(bar, "b0"), "bolt 'at1' and 1 more lose their face plates in stage 'cut'\n");
  EXPECT_EQ(said_of_cut(bar, "b1"), "bolt 'at1' and 1 more are taken away by stage 'cut'\n");
  EXPECT_EQ(said_of_cut(bar, "b2"), "");
  EXPECT_EQ(said_of_cut(cable, "cap"), "");
}

/// What is said before the first step of a bolt through three layers, the lowest of which holds its head.
/// @param more    keys of the bolt
/// @param stages  after one of 0.01 s
std::vector<std::string> said_at_start(const std::string &support, const std::string &more,
                                       const std::string &stages) {
  std::string toml = layers_toml(support);
  toml += "[[bolt]]\nname = \"rod\"\nsupport = \"steel\"\nfrom = [1, 0.5]\nto = [1, 2.5]\n" + more +
          "[[stage]]\nkind = \"run\"\nduration = 0.01\n" + stages;
  Simulation simulation(Communicator::self(), scene_of(toml));
  std::vector<std::string> at_start;
  for (const Diagnostic &note : simulation.notes()) {
    at_start.push_back(note.what);
  }
  run_stages(simulation);
  std::vector<std::string> cuts;
  for (const Diagnostic &note : simulation.notes()) {
    if (note.what.starts_with("bolt 'rod'") && note.what.find("stage") != std::string::npos) {
      EXPECT_NE(std::find(at_start.begin(), at_start.end(), note.what), at_start.end())
          << "only the run says: " << note.what;
      cuts.push_back(note.what);
    }
  }
  return cuts;
}

std::string dig(const std::string &name, const std::string &block) {
  return fmt::format("[[stage]]\nname = \"{}\"\nkind = \"excavate\"\nblocks = [\"{}\"]\n", name, block);
}

// A bolt that a stage puts in is cut as one that is in place from the start, and a stage that takes the last
// joint of a bar takes the bar away.
TEST(BoltNotes, FollowBoltsThroughTheStages) {
  using Said = std::vector<std::string>;
  const std::string cable = "kind = \"anchored\"\naxial_stiffness = 1e7\n";
  const std::string bar = "kind = \"grouted\"\naxial_stiffness = 1e7\nactive_length = 0.2\n";
  const std::string waits = "active = false\n";
  const auto set = [](const char *active) {
    return fmt::format("[[stage]]\nkind = \"change\"\nset = {{ \"bolt.rod.active\" = {} }}\n", active);
  };
  EXPECT_EQ(said_at_start(cable, waits, set("true") + dig("cut", "b2")),
            Said{"bolt 'rod' is taken away by stage 'cut'"});
  EXPECT_EQ(said_at_start(cable, waits, set("true") + dig("cut", "b1")),
            Said{"bolt 'rod' crosses rock between head and anchor that stage 'cut' excavates"});
  EXPECT_EQ(said_at_start(cable, waits, dig("cut", "b2")), Said{}) << "it is not there";
  EXPECT_EQ(said_at_start(cable, "", set("false") + dig("cut", "b2")), Said{}) << "it is there no longer";
  EXPECT_EQ(said_at_start(bar, "", dig("first", "b0") + dig("second", "b2")),
            Said{"bolt 'rod' is taken away by stage 'second'"});
  // The rock at its head has gone when it is put in: it holds b1 to b2.
  EXPECT_EQ(said_at_start(cable, waits, dig("first", "b0") + set("true") + dig("second", "b1")),
            Said{"bolt 'rod' is taken away by stage 'second'"});
}

} // namespace
} // namespace gcpdda::testing::bolt_notes_test
