// Upper bounds of the factor of safety of blocks that hang on bonds, each beside the factor that a search
// finds and the known one.

#include "safety_limits.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gcpdda::testing::safety_bond_bound_test {
namespace {

/// A block of 1 m x 1 m below a roof, whose top side has vertices at `ends` (from right to left).
struct HangingBlock {
  std::string name;
  std::vector<double> ends; ///< of the edges of the top side, m
  std::string joints;       ///< of these edges
  std::string roof_joint;
  double tension; ///< of the bond, in weights of the block per metre
  double factor;

  [[nodiscard]] Scene scene() const {
    std::vector<Vec2> outline{{0.0, -1.0}, {1.0, -1.0}};
    for (const double x : ends) {
      outline.push_back({x, 0.0});
    }
    return scene_of(
        without_duration(
            head({.friction_deg = 35.0}) +
            fmt::format("[joint.bond]\ncohesion = 1e6\ntension = {:.17g}\n",
                        tension * rock_density * earth_gravity) +
            block_toml("roof", rectangle({-5.0, 0.0}, {5.0, 1.0}),
                       fmt::format("fixed = true\nedge_joints = [\"{}\", \"\", \"\", \"\"]", roof_joint)) +
            block_toml("block", outline, fmt::format("edge_joints = [\"\", \"\", {}, \"\"]", joints))) +
        "[fos]\nto = 8.0\n[[stage]]\nkind = \"settle\"\nlimit = 10.0\n");
  }
};

// The tension of a bond acts on the length of that bond, wherever corners stand before the rest of the side.
TEST(SafetyBondBound, ABlockThatHangsOnSeveralBondsHasTheBoundOfAll) {
  const std::string two = R"("bond", "bond")";
  for (const HangingBlock &block :
       {HangingBlock{"one bond", {1.0, 0.0}, R"("bond")", "", 2.0, 2.0},
        HangingBlock{"a vertex in the middle", {1.0, 0.5, 0.0}, two, "", 2.0, 2.0},
        HangingBlock{"a vertex at 0.4 m", {1.0, 0.4, 0.0}, two, "", 2.0, 2.0},
        HangingBlock{"a vertex at 0.1 m", {1.0, 0.1, 0.0}, two, "", 2.0, 2.0},
        HangingBlock{"bonds at the ends", {1.0, 0.75, 0.25, 0.0}, R"("bond", "", "bond")", "", 4.0, 2.0},
        HangingBlock{"a bond in the middle", {1.0, 0.75, 0.25, 0.0}, R"("", "bond", "")", "", 4.0, 2.0},
        HangingBlock{"three bonds", {1.0, 0.75, 0.25, 0.0}, R"("", "bond", "")", "bond", 4.0, 4.0}}) {
    const Scene scene = block.scene();
    const SafetyReport found = search_quietly(scene).report;
    const double bound = search_quietly(scene, true).report.bound.value_or(0.0);
    EXPECT_GE(bound, found.holds.value_or(0.0)) << block.name;
    EXPECT_NEAR(found.holds.value_or(0.0), block.factor, 0.01 * block.factor) << block.name;
    EXPECT_NEAR(bound, block.factor, 3e-3 * block.factor) << block.name;
  }
}

} // namespace
} // namespace gcpdda::testing::safety_bond_bound_test
