// Which values of two scenes differ: whatever their numbers look like, by names and by the positions of
// stages.

#include "io/scene/scene_changes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gcpdda::scene_changes_test {
namespace {

std::vector<std::string> changes(const std::string &before, const std::string &after) {
  std::vector<std::string> texts;
  for (const SceneChange &change : changes_between(before, after)) {
    texts.push_back(fmt::format("{}: {} to {}", change.path, change.before, change.after));
  }
  return texts;
}

using Texts = std::vector<std::string>;

TEST(SceneChanges, AreNoneBetweenEqualValues) {
  EXPECT_EQ(changes("[run]\nsafety = 0.55\nduration = 2\n", "[run]\nduration = 2.0\n"), Texts{});
  EXPECT_EQ(changes("[joint.default]\nnormal_stiffness = 1e9\n",
                    "[joint.default]\nnormal_stiffness = 1000000000\n"),
            Texts{});
  EXPECT_EQ(changes("", ""), Texts{});
}

TEST(SceneChanges, HaveThePathOfSetAndBothValues) {
  EXPECT_EQ(changes("[joint.a]\ncohesion = 2e9\n", "[joint.a]\ncohesion = 0.1\n"),
            Texts{"joint.a.cohesion: 2e+09 to 0.1"});
  EXPECT_EQ(changes("[run]\n", "[run]\npotential = \"linear\"\n[run.rayleigh]\nratio = 0.1\n"),
            (Texts{"run.potential: its default \"exact\" to \"linear\"", "run.rayleigh.ratio: none to 0.1"}));
  EXPECT_EQ(changes("[output]\ninterval = 0.1\n", "[output]\n"),
            Texts{"output.interval: 0.1 to its default"});
  EXPECT_EQ(
      changes("[[block]]\nname = \"a\"\n[[block]]\nname = \"c.d\"\n",
              "[[block]]\nname = \"c.d\"\n[[block.load]]\nforce = [0, -1.0]\n[[block]]\nname = \"a\"\n"),
      Texts{"block.c.d.load: none to [{force = [0, -1]}]"});
}

TEST(SceneChanges, OfStagesAreByTheirPositions) {
  const std::string first = "[[stage]]\nname = \"a\"\nkind = \"settle\"\nlimit = 1\n";
  const std::string second = "[[stage]]\nname = \"b\"\nkind = \"run\"\nduration = 1\n"
                             "set = { \"joint.default.cohesion\" = 1.0 }\n";
  EXPECT_EQ(changes(first, first + second), Texts{"stage.b: none to a stage"});
  EXPECT_EQ(changes(first + second, first), Texts{"stage.b: a stage to none"});
  std::string other = second;
  other.replace(other.find("= 1.0"), 5, "= 2.0");
  const std::vector<SceneChange> found = changes_between(first + second, first + other);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, "stage.b.set.joint.default.cohesion");
  EXPECT_EQ(found[0].stage, 1);
  const std::vector<SceneChange> set =
      changes_between(first + second, "[joint.default]\ncohesion = 3.0\n" + first + second);
  ASSERT_EQ(set.size(), 1U);
  EXPECT_EQ(set[0].stage, -1);
  EXPECT_EQ(set[0].set_in, (std::vector<std::int64_t>{1}));
}

} // namespace
} // namespace gcpdda::scene_changes_test
