// `gcpdda report` finds Python and its package, and says what is missing where it does not.

#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

namespace gcpdda::report_command_test {
namespace {

using testing::count_of;
using testing::file_text;
using testing::gcpdda_words;
using testing::Outcome;
using testing::run_gcpdda;
using testing::run_program;
using testing::summary_text;
using testing::WorkFolder;

/// Plain start (0) or under mpirun with that many ranks.
class ReportCommand : public ::testing::TestWithParam<int> {
protected:
  void run() {
    folder_.write("scene.toml", testing::small_scene());
    ASSERT_EQ(run_gcpdda(0, {"run", "scene.toml", "--out", "kept"}, folder_).exit_code, 0);
  }

  WorkFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Regression, ReportCommand, ::testing::Values(0, 3), [](const auto &ranks) {
  return ranks.param == 0 ? std::string("plain") : "ranks" + std::to_string(ranks.param);
});

TEST_P(ReportCommand, WritesThePage) {
  run();
  const Outcome outcome = run_gcpdda(
      GetParam(), {"report", "kept", "--title", "My wall", "--frames", "0", "--out", "page.html"}, folder_);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(count_of(outcome.out, "page.html, "), 1) << outcome.out;
  const std::string page = file_text(folder_ / "page.html");
  EXPECT_EQ(count_of(page, "<title>My wall</title>"), 1);
  const std::string version = summary_text(folder_ / "kept", "version");
  EXPECT_GE(count_of(page, version.substr(1, version.size() - 2)), 1) << version;
}

TEST_P(ReportCommand, OfAFolderWithoutResultsIsFour) {
  const Outcome outcome = run_gcpdda(GetParam(), {"report", "nowhere"}, folder_);
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "gcpdda report: error: "), 1) << outcome.err;
  EXPECT_EQ(run_gcpdda(GetParam(), {"report"}, folder_).exit_code, 2);
  EXPECT_EQ(run_gcpdda(GetParam(), {"report", "nowhere", "--frames", "many"}, folder_).exit_code, 2);
}

TEST_P(ReportCommand, WithoutALibraryIsFour) {
  folder_.write("h5py.py", "raise ImportError('it is broken')\n"); // comes before that of any Python
  const Outcome outcome = run_program(gcpdda_words(GetParam(), {"report", "nowhere"}), folder_.path(),
                                      {"PYTHONPATH=" + folder_.path().string()});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "with h5py, matplotlib, numpy and pandas"), 1) << outcome.err;
  EXPECT_EQ(count_of(outcome.err, "Traceback"), 0) << outcome.err;
}

} // namespace
} // namespace gcpdda::report_command_test
