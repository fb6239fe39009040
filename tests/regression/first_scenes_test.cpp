// The scenes that `gcpdda new` writes run as they are, and are never written over a file of the user's.

#include "child_process.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>

namespace gcpdda::first_scenes_test {
namespace {

using testing::count_of;
using testing::file_text;
using testing::listing;
using testing::Outcome;
using testing::run_gcpdda;
using testing::summary_text;
using testing::WorkFolder;

struct Kind {
  const char *name;
  const char *verdict; ///< that its comment promises
};

[[maybe_unused]] void PrintTo(const Kind &kind, std::ostream *out) {
  *out << kind.name;
}

class FirstScene : public ::testing::TestWithParam<Kind> {
protected:
  WorkFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Regression, FirstScene,
                         ::testing::Values(Kind{"slope", "\"failed\""}, Kind{"tunnel", "\"settled\""},
                                           Kind{"wall", "\"failed\""}),
                         [](const auto &kind) { return std::string(kind.param.name); });

TEST_P(FirstScene, RunsWithoutAWarningToThePromisedVerdict) {
  const std::string name = GetParam().name;
  const Outcome written = run_gcpdda(0, {"new", name}, folder_);
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_EQ(count_of(written.out, "gcpdda run " + name + ".toml"), 1) << written.out;
  const Outcome outcome = run_gcpdda(0, {"run", name + ".toml"}, folder_);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "warning"), 0) << outcome.err;
  EXPECT_EQ(summary_text(folder_ / ("results/" + name), "verdict"), GetParam().verdict);
}

// With both kinds of blocks the first stage settles, and in the tunnel the last one.
TEST_P(FirstScene, RunsWithRigidAndDeformableBlocks) {
  const std::string name = GetParam().name;
  ASSERT_EQ(run_gcpdda(0, {"new", name, "mine.toml"}, folder_).exit_code, 0);
  for (const std::string &fidelity : {std::string("rigid"), std::string("deformable")}) {
    const Outcome outcome =
        run_gcpdda(0, {"run", "mine.toml", "--out", fidelity, "--set", "run.fidelity=" + fidelity}, folder_);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string text = file_text(folder_ / fidelity / "run.log");
    EXPECT_EQ(count_of(text, "' settled at t = "), GetParam().verdict == std::string("\"settled\"") ? 2 : 1)
        << text;
    EXPECT_EQ(count_of(text, fidelity == "rigid" ? " rigid and 0 deformable" : "fidelity: 0 rigid and "), 1)
        << text;
  }
}

/// Plain start (0) or under mpirun with that many ranks.
class NewScene : public ::testing::TestWithParam<int> {
protected:
  WorkFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Regression, NewScene, ::testing::Values(0, 3), [](const auto &ranks) {
  return ranks.param == 0 ? std::string("plain") : "ranks" + std::to_string(ranks.param);
});

TEST_P(NewScene, IsNeverWrittenOverAFile) {
  folder_.write("slope.toml", "mine");
  const Outcome outcome = run_gcpdda(GetParam(), {"new", "slope"}, folder_);
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "slope.toml: error: "), 1) << outcome.err;
  EXPECT_EQ(file_text(folder_ / "slope.toml"), "mine");
  EXPECT_EQ(run_gcpdda(GetParam(), {"new", "slope", "missing/slope.toml"}, folder_).exit_code, 4);
  EXPECT_EQ(listing(folder_.path()).size(), 1U);
}

TEST_P(NewScene, OfAnUnknownKindIsTwo) {
  const Outcome outcome = run_gcpdda(GetParam(), {"new", "bridge"}, folder_);
  EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "slope,tunnel,wall"), 1) << outcome.err;
  EXPECT_TRUE(listing(folder_.path()).empty());
}

} // namespace
} // namespace gcpdda::first_scenes_test
