// Folders of searches and ensembles: one gcpdda at a time works in one, and a killed one leaves no lock.

#include "child_process.hpp"
#include "support/plane_failure.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <csignal>

namespace gcpdda::folder_in_use_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::gcpdda_words;
using testing::Outcome;
using testing::Process;
using testing::run_gcpdda;
using testing::WorkFolder;

void expect_in_use(const std::vector<std::string> &call, const WorkFolder &folder) {
  const Outcome refused = run_gcpdda(0, call, folder);
  EXPECT_EQ(refused.exit_code, 4) << refused.err;
  EXPECT_EQ(count_of(refused.err, "is in use: another gcpdda runs in it"), 1) << refused.err;
}

TEST(FolderInUse, OfAnEnsembleIsLeftToIt) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::shipped_toml("plane_failure"));
  Process first(gcpdda_words(0, {"ensemble", "plane.toml", "--count", "1000000", "--out", "o"}),
                folder.path());
  first.wait_until([&] { return fs::exists(folder / "o/members/member_000001.csv"); });
  expect_in_use({"ensemble", "plane.toml", "--count", "2", "--out", "o"}, folder);
  expect_in_use({"ensemble", "plane.toml", "--count", "2", "--out", "o", "--overwrite", "--set",
                 "material.rock.density=2500"},
                folder);
  EXPECT_TRUE(fs::exists(folder / "o/members/member_000001.csv"));
  kill(first.id(), SIGKILL);
  first.wait();
  const Outcome next = run_gcpdda(0, {"ensemble", "plane.toml", "--count", "2", "--out", "o"}, folder);
  EXPECT_EQ(next.exit_code, 0) << next.err;
  EXPECT_EQ(count_of(next.err, "2 of 2 members are there already"), 1) << next.err;
}

// The second trial gains speed so slowly that it takes a long time.
TEST(FolderInUse, OfASearchIsLeftToIt) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::plane_failure_toml(0.0));
  const std::string more = fmt::format("{:.7g}", 1.00001 * testing::plane_failure_factor(0.0));
  Process first(gcpdda_words(0, {"fos", "plane.toml", "--out", "o", "--from", "1.2", "--to", more, "--set",
                                 "fos.failure_motion=1e6", "--set", "fos.limit=1e4"}),
                folder.path());
  const fs::path trial = folder / ("o/trials/F" + more);
  first.wait_until([&] { return fs::exists(trial / "history/energy.csv"); });
  const std::vector<std::string> other{"fos",   "plane.toml",  "--out",      "o",           "--from",
                                       "0.8",   "--to",        "2.5",        "--tolerance", "0.3",
                                       "--set", "fos.limit=5", "--overwrite"};
  expect_in_use(other, folder);
  EXPECT_TRUE(fs::exists(trial / "history/energy.csv"));
  kill(first.id(), SIGKILL);
  first.wait();
  const Outcome next = run_gcpdda(0, other, folder);
  EXPECT_EQ(next.exit_code, 0) << next.err;
  EXPECT_FALSE(fs::exists(trial));
}

} // namespace
} // namespace gcpdda::folder_in_use_test
