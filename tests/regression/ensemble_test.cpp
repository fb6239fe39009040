// gcpdda ensemble as a person calls it: what it writes, says and refuses, and how it is gone on with.

#include "child_process.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fmt/format.h>
#include <numbers>

namespace gcpdda::ensemble_test {
namespace {

namespace fs = std::filesystem;
using testing::count_of;
using testing::file_text;
using testing::json_value;
using testing::lines_of;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

TEST(Ensemble, WritesWhatItFinds) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::shipped_toml("plane_failure"));
  const Outcome outcome = run_gcpdda(2, {"ensemble", "plane.toml", "--count", "5"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const fs::path results = folder / "results/plane_ensemble";
  EXPECT_EQ(file_text(results / "ensemble.txt"), outcome.out);
  EXPECT_NE(outcome.out.find("probability of failure"), std::string::npos) << outcome.out;
  EXPECT_EQ(count_of(outcome.err, "member "), 5) << outcome.err;
  const std::vector<std::string> rows = lines_of(file_text(results / "ensemble_members.csv"));
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0], "member,outcome,holds,fails,steps,cpu[s],joint.default.friction_angle_deg,"
                     "joint.default.cohesion,message");
  EXPECT_EQ(json_value(results / "ensemble.json", "done"), "5");
  EXPECT_FALSE(json_value(results / "ensemble.json", "version").empty());
  EXPECT_TRUE(
      json_value(results / "ensemble.json", "command").ends_with("gcpdda ensemble plane.toml --count 5\""))
      << json_value(results / "ensemble.json", "command");
  EXPECT_FALSE(fs::exists(results / "ensemble.svg")) << "verdicts have no histogram";

  const Outcome kept = run_gcpdda(
      0, {"ensemble", "plane.toml", "--count", "2", "--set", "ensemble.keep=true", "--out", "kept"}, folder);
  EXPECT_EQ(kept.exit_code, 0) << kept.err;
  const std::string kept_row = lines_of(file_text(folder / "kept/ensemble_members.csv"))[1];
  EXPECT_EQ(kept_row.substr(0, kept_row.find('.')), rows[1].substr(0, rows[1].find('.')))
      << "the outcome after as many steps as without its files";

  const Outcome again = run_gcpdda(0, {"ensemble", "plane.toml", "--count", "5"}, folder);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, outcome.out) << "nothing was missing";
  const Outcome other =
      run_gcpdda(0, {"ensemble", "plane.toml", "--count", "5", "--set", "ensemble.seed=2"}, folder);
  EXPECT_EQ(other.exit_code, 4);
  EXPECT_NE(other.err.find("another scene"), std::string::npos) << other.err;
  const Outcome replaced = run_gcpdda(0,
                                      {"ensemble", "plane.toml", "--count", "1", "--set", "ensemble.seed=2",
                                       "--set", "ensemble.keep=true", "--overwrite"},
                                      folder);
  EXPECT_EQ(replaced.exit_code, 0) << replaced.err;
  EXPECT_EQ(lines_of(file_text(results / "ensemble_members.csv")).size(), 2U);
  EXPECT_TRUE(fs::exists(results / "members/member_000000/summary.json"));
}

TEST(Ensemble, StopsAtTheSignalAndGoesOn) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::shipped_toml("plane_failure"));
  const fs::path results = folder / "results/plane_ensemble";
  testing::Process process(testing::gcpdda_words(2, {"ensemble", "plane.toml", "--count", "5000"}),
                           folder.path());
  process.wait_until([&] { return fs::exists(results / "members/member_000003.csv"); });
  kill(process.id(), SIGUSR1);
  const Outcome stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 6) << stopped.err;
  EXPECT_NE(stopped.err.find("the same call goes on"), std::string::npos) << stopped.err;
  const auto done = lines_of(file_text(results / "ensemble_members.csv")).size() - 1;
  EXPECT_GE(done, 2U) << "what the rank of member 3 has done";
  EXPECT_LT(done, 5000U);
  const std::string row = lines_of(file_text(results / "ensemble_members.csv"))[1];
  const Outcome on = run_gcpdda(0, {"ensemble", "plane.toml", "--count", std::to_string(done + 1)}, folder);
  EXPECT_EQ(on.exit_code, 0) << on.err;
  EXPECT_EQ(count_of(on.err, "there already"), 1) << on.err;
  EXPECT_EQ(lines_of(file_text(results / "ensemble_members.csv"))[1], row)
      << "not run again: the same CPU time";
}

// Level ground moves away under the slider by more than any friction of the members takes along: all fail. At
// rest, without the earthquake, all hold.
TEST(Ensemble, MembersAreShaken) {
  const WorkFolder folder;
  folder.write("push.csv", "0.0, -30.0\n1.0, -30.0\n");
  const std::string record = "[earthquake]\nrecord = \"push.csv\"\nquantity = \"acceleration\"\n";
  folder.write("plane.toml", testing::shipped_toml("plane_failure") + record +
                                 "stage = \"shaking\"\n[[stage]]\nname = \"shaking\"\nkind = "
                                 "\"run\"\nlimit = 1.0\n");
  const Outcome shaken =
      run_gcpdda(0, {"ensemble", "plane.toml", "--count", "3", "--set", "run.gravity=[0,-9.81]"}, folder);
  EXPECT_EQ(shaken.exit_code, 0) << shaken.err;
  EXPECT_NE(shaken.out.find("3 of 3 members fail"), std::string::npos) << shaken.out;

  std::string toml = testing::shipped_toml("plane_failure") + record;
  toml.erase(toml.find("[[stage]]"), toml.find("[fos]") - toml.find("[[stage]]"));
  toml.insert(toml.find("[run]\n") + 6, "duration = 1.0\n");
  folder.write("unstaged.toml", toml);
  const Outcome unstaged = run_gcpdda(0, {"ensemble", "unstaged.toml"}, folder);
  EXPECT_EQ(unstaged.exit_code, 3);
  EXPECT_NE(unstaged.err.find("no stage says when its blocks stand"), std::string::npos) << unstaged.err;
}

// A slab on a plane of 10 degrees under two pulses that any friction of the members gives way to: each slides
// some way and rests, and the limit is for the user to set.
TEST(Ensemble, PermanentDisplacementsAreTold) {
  const WorkFolder folder;
  std::string record;
  for (int k = 0; k <= 200; ++k) {
    record += fmt::format("{:.3f}, {}\n", 0.005 * k, 6.0 * std::sin(4.0 * std::numbers::pi * 0.005 * k));
  }
  folder.write("push.csv", record);
  constexpr double dip = 10.0 * std::numbers::pi / 180.0;
  folder.write(
      "slab.toml",
      "[run]\nfidelity = \"rigid\"\n[material.rock]\ndensity = 2600\n[joint.default]\n"
      "normal_stiffness = 1e9\nfriction_angle_deg = 25\n" +
          testing::block_toml("plane", testing::placed(testing::rectangle({-20, -2}, {20, 0}), dip, {}),
                              "fixed = true") +
          testing::block_toml("slab", testing::placed(testing::rectangle({-1, 0}, {1, 1}), dip, {})) +
          "[earthquake]\nrecord = \"push.csv\"\nquantity = \"acceleration\"\nstage = \"shaking\"\n"
          "[[stage]]\nname = \"weight\"\nkind = \"settle\"\nlimit = 5\n"
          "[[stage]]\nname = \"shaking\"\nkind = \"run\"\nlimit = 9\n"
          "[ensemble]\ncount = 5\nmeasure = \"verdict\"\n[[ensemble.vary]]\n"
          "key = \"joint.default.friction_angle_deg\"\ndistribution = \"uniform\"\nmin = 18.0\nmax = 30.0\n");
  const Outcome free =
      run_gcpdda(2, {"ensemble", "slab.toml", "--out", "free", "--set", "ensemble.keep=true"}, folder);
  ASSERT_EQ(free.exit_code, 0) << free.err;
  EXPECT_NE(free.out.find("members hold wherever they have come to rest"), std::string::npos) << free.out;
  EXPECT_EQ(json_value(folder / "free/ensemble.json", "fails"), "0");
  EXPECT_TRUE(fs::exists(folder / "free/ensemble.svg"));
  const std::vector<std::string> rows = lines_of(file_text(folder / "free/ensemble_members.csv"));
  EXPECT_EQ(rows[0], "member,outcome,holds,fails,steps,cpu[s],joint.default.friction_angle_deg,"
                     "permanent_displacement[m],message");
  std::vector<double> displacements;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    displacements.push_back(
        std::stod(rows[k].substr(0, rows[k].rfind(',')).substr(rows[k].rfind(',', rows[k].size() - 2) + 1)));
    const fs::path summary = folder / fmt::format("free/members/member_{:06}/summary.json", k - 1);
    EXPECT_EQ(displacements.back(), std::stod(json_value(summary, "permanent_displacement")));
    EXPECT_GT(displacements.back(), 0.01) << "no friction of theirs resists 6 m/s2";
  }
  ASSERT_EQ(displacements.size(), 5U);
  std::sort(displacements.begin(), displacements.end());
  EXPECT_NEAR(std::stod(json_value(folder / "free/ensemble.json", "median")), displacements[2], 1e-12);

  const double limit = 0.5 * (displacements[2] + displacements[3]);
  const Outcome limited = run_gcpdda(0,
                                     {"ensemble", "slab.toml", "--out", "limited", "--set",
                                      fmt::format("ensemble.largest_displacement={}", limit)},
                                     folder);
  EXPECT_EQ(limited.exit_code, 0) << limited.err;
  EXPECT_NE(limited.out.find("2 of 5 members fail"), std::string::npos) << limited.out;
  EXPECT_NE(limited.out.find("2 members at rest farther than"), std::string::npos) << limited.out;
}

// With a tenth of the friction that limit equilibrium asks for, members fail whatever is measured: also where
// they do not come to rest with the largest strength that is tried (fos.from).
TEST(Ensemble, MembersThatNoSearchCanSettleFail) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::shipped_toml("plane_failure"));
  for (const std::string measure : {"verdict", "factor"}) {
    const Outcome weak =
        run_gcpdda(0,
                   {"ensemble", "plane.toml", "--count", "3", "--out", measure, "--set",
                    "ensemble.measure=" + measure, "--set",
                    "ensemble.vary=[{key = \"joint.default.friction_angle_deg\", distribution = \"uniform\", "
                    "min = 2.0, max = 3.0}]",
                    "--set", "joint.default.cohesion=0"},
                   folder);
    EXPECT_EQ(weak.exit_code, 0) << weak.err;
    EXPECT_NE(weak.out.find("3 of 3 members fail"), std::string::npos) << weak.out;
  }
}

// The plane ends at a wall: weak members slide there, and hold.
TEST(Ensemble, TellsOfMembersThatHoldAfterASlide) {
  const WorkFolder folder;
  folder.write(
      "push.toml",
      "[run]\nfidelity = \"rigid\"\ngravity = [3.0, -10.0]\n[material.rock]\ndensity = 2600.0\n"
      "[joint.default]\nnormal_stiffness = 1e9\nfriction_angle_deg = 30\n" +
          testing::block_toml("floor", testing::rectangle({-10.0, -1.0}, {20.0, 0.0}), "fixed = true") +
          testing::block_toml("stop", testing::rectangle({1.2, 0.1}, {2.0, 1.0}), "fixed = true") +
          testing::block_toml("block", testing::rectangle({0.0, 0.0}, {1.0, 1.0})) +
          "[[stage]]\nname = \"push\"\nkind = \"settle\"\nlimit = 20.0\n[ensemble]\ncount = 4\n"
          "measure = \"verdict\"\n[[ensemble.vary]]\nkey = \"joint.default.friction_angle_deg\"\n"
          "distribution = \"uniform\"\nmin = 2.0\nmax = 10.0\n");
  const Outcome weak = run_gcpdda(2, {"ensemble", "push.toml"}, folder);
  EXPECT_EQ(weak.exit_code, 0) << weak.err;
  EXPECT_NE(weak.out.find("warning: 4 members held only after blocks slid"), std::string::npos) << weak.out;
  EXPECT_EQ(json_value(folder / "results/push_ensemble/ensemble.json", "holds_after_slide"), "4");
  EXPECT_EQ(count_of(file_text(folder / "results/push_ensemble/ensemble_members.csv"),
                     "block 'block' slid in stage 'push' before rest"),
            4);
  const Outcome strong = run_gcpdda(
      0,
      {"ensemble", "push.toml", "--out", "strong", "--set",
       "ensemble.vary=[{key = \"joint.default.friction_angle_deg\", distribution = \"uniform\", min = 30.0, "
       "max = 40.0}]"},
      folder);
  EXPECT_EQ(strong.out.find("slid"), std::string::npos) << strong.out;
}

TEST(Ensemble, RefusesWhatItCannotRun) {
  const WorkFolder folder;
  folder.write("bench.toml", testing::shipped_toml("toppling"));
  const Outcome none = run_gcpdda(0, {"ensemble", "bench.toml"}, folder);
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_NE(none.err.find("bench.toml: error: the scene has no ensemble"), std::string::npos) << none.err;
  folder.write("plane.toml", testing::shipped_toml("plane_failure"));
  const Outcome count = run_gcpdda(0, {"ensemble", "plane.toml", "--count", "0"}, folder);
  EXPECT_EQ(count.exit_code, 3);
  EXPECT_FALSE(fs::exists(folder / "results"));
  const Outcome varied =
      run_gcpdda(0, {"ensemble", "plane.toml", "--set", "joint.default.cohesion=5000"}, folder);
  EXPECT_EQ(varied.exit_code, 3);
  EXPECT_EQ(count_of(varied.err,
                     "--set joint.default.cohesion=5000: error: 'joint.default.cohesion' varies in "
                     "the ensemble, each member draws a value of its own"),
            1)
      << varied.err;
  EXPECT_FALSE(fs::exists(folder / "results"));
  const Outcome unsettled = run_gcpdda(0,
                                       {"ensemble", "plane.toml", "--set", "ensemble.measure=factor", "--set",
                                        "stage=[{kind=\"run\",duration=1}]"},
                                       folder);
  EXPECT_EQ(unsettled.exit_code, 3);
  EXPECT_NE(unsettled.err.find("none of kind settle"), std::string::npos) << unsettled.err;
}

} // namespace
} // namespace gcpdda::ensemble_test
