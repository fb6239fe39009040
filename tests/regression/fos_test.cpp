// gcpdda fos as a person calls it: what it writes, says and refuses.

#include "child_process.hpp"
#include "support/plane_failure.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <regex>

namespace gcpdda::fos_test {
namespace {

namespace fs = std::filesystem;
using testing::file_text;
using testing::json_value;
using testing::lines_of;
using testing::Outcome;
using testing::run_gcpdda;
using testing::WorkFolder;

/// The numbers of the first element of a picture that a pattern finds.
std::vector<double> numbers_of(const std::string &picture, const std::string &pattern) {
  std::smatch element;
  std::vector<double> numbers;
  if (std::regex_search(picture, element, std::regex(pattern))) {
    const std::string text = element[1];
    const std::regex number("-?[0-9.]+");
    for (std::sregex_iterator at(text.begin(), text.end(), number); at != std::sregex_iterator(); ++at) {
      numbers.push_back(std::stod(at->str()));
    }
  }
  return numbers;
}

// The slider is the second block. Its joint is its lower edge, and is drawn before the legend.
void expect_sliding_joint(const std::string &picture) {
  const std::vector<double> slider =
      numbers_of(picture, "<polygon[^>]*points=\"[^\"]*\"/>\n<polygon[^>]*points=\"([^\"]*)\"");
  const std::vector<double> joint = numbers_of(picture, "<path stroke=\"#7a0fa8\"[^>]*d=\"M([^\"]*)\"");
  ASSERT_EQ(slider.size(), 8U);
  ASSERT_EQ(joint.size(), 4U);
  const double lower = std::max(slider[1], slider[5]); // y goes down the page
  const auto [left, right] = std::minmax(slider[0], slider[4]);
  const auto [begin, end] = std::minmax(joint[0], joint[2]);
  EXPECT_NEAR(joint[1], lower, 1.0);
  EXPECT_NEAR(joint[3], lower, 1.0);
  EXPECT_NEAR(begin, left, 1.0);
  EXPECT_NEAR(end, right, 1.0);
}

TEST(Fos, WritesWhatItFinds) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::plane_failure_toml(0.0));
  const std::vector<std::string> call{"fos",  "plane.toml", "--tolerance", "0.3",
                                      "--to", "2.5",        "--from",      "0.8"};
  const Outcome outcome = run_gcpdda(2, call, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("factor of safety"), std::string::npos) << outcome.out;
  const fs::path results = folder / "results/plane_fos";
  EXPECT_EQ(file_text(results / "fos.txt"), outcome.out);
  const double holds = std::stod(json_value(results / "fos.json", "holds"));
  const double fails = std::stod(json_value(results / "fos.json", "fails"));
  EXPECT_LT(holds, testing::plane_failure_factor(0.0));
  EXPECT_GT(fails, testing::plane_failure_factor(0.0));
  EXPECT_LE(fails - holds, 0.3 * holds + 1e-12) << "round-off";
  const std::vector<std::string> trials = lines_of(file_text(results / "fos_trials.csv"));
  EXPECT_GE(trials.size(), 4U) << "a header, both ends and what lies between";
  EXPECT_EQ(json_value(results / "fos.json", "block"), "\"slider\"") << "the block that moves";
  expect_sliding_joint(file_text(results / "fos.svg"));
  EXPECT_TRUE(fs::exists(results / "settled/checkpoints"));
  EXPECT_TRUE(fs::exists(results / "trials/F1.3/frames/frame_000000.hdf"));

  const Outcome again = run_gcpdda(0, call, folder);
  EXPECT_EQ(again.exit_code, 4);
  EXPECT_NE(again.err.find("--overwrite"), std::string::npos) << again.err;
  const Outcome inside = run_gcpdda(0, {"fos", "plane.toml", "--out", "results/plane_fos/settled"}, folder);
  EXPECT_EQ(inside.exit_code, 4) << "the folder of a run";
  const Outcome restart = run_gcpdda(2, {"restart", "results/plane_fos"}, folder);
  EXPECT_EQ(restart.exit_code, 4);
  EXPECT_NE(restart.err.find("--settled results/plane_fos/settled\n"), std::string::npos) << restart.err;
  std::vector<std::string> replace = call;
  replace.back() = "1.1"; // the trial at 1, where nothing changes, needs no time
  replace.insert(replace.end(), {"--overwrite", "--set", "fos.limit=0.01", "--set", "fos.patience=0"});
  EXPECT_EQ(run_gcpdda(0, replace, folder).exit_code, 7) << "too short for any verdict";
  EXPECT_FALSE(fs::exists(results / "trials/F1.3")) << "of the search before";
  EXPECT_EQ(json_value(results / "fos.json", "holds"), "null");
}

// Just below its limit the toe of this slope slides by a tenth of a block and comes to rest. A change of the
// density by its last bits changes on which windows of its motion it does.
TEST(Fos, VerdictNearTheLimitHangsOnNoLastBit) {
  const WorkFolder folder;
  folder.write("wet.toml", testing::shipped_toml("wet_slope"));
  for (int k = 2; k < 6; ++k) {
    const std::string density = fmt::format("material.rock.density={}", 2600.0 * (1.0 + 1e-11 * k));
    const std::string out = fmt::format("density{}", k);
    run_gcpdda(0,
               {"fos", "wet.toml", "--from", "1.265", "--to", "1.266", "--tolerance", "0.05", "--set",
                density, "--out", out},
               folder);
    const std::vector<std::string> trials = lines_of(file_text(folder / out / "fos_trials.csv"));
    ASSERT_EQ(trials.size(), 3U);
    EXPECT_NE(trials[1].find(",settled,"), std::string::npos) << trials[1];
  }
}

/// The slope of run/guide/walk_1_your_slope.md.
std::string wet_slope_of_95_blocks() {
  return testing::walked_slope_toml() + "[fos]\nfamilies = [\"bedding\"]\nfrom = 1.0\nto = 1.6\n";
}

// Two regions slip, are driven back and slip again to the same side: with the small share of their tangential
// stiffness that slipping regions have in K, the static solver swung between them for 1,500 evaluations and
// left the trial to damped motion.
TEST(Fos, StaticSolverGoesOnWhereATrialSwings) {
  const WorkFolder folder;
  folder.write("slope.toml", wet_slope_of_95_blocks());
  run_gcpdda(0, {"fos", "slope.toml", "--from", "1.24", "--to", "1.241", "--tolerance", "0.05"}, folder);
  const std::vector<std::string> trials = lines_of(file_text(folder / "results/slope_fos/fos_trials.csv"));
  ASSERT_EQ(trials.size(), 2U) << "the lower factor fails";
  EXPECT_NE(trials[1].find(",failed,"), std::string::npos) << trials[1];
  EXPECT_NE(trials[1].find(",static solver"), std::string::npos) << trials[1];
}

// Three blocks at the foot slide out over the corner of the block below them. It has the cross joint at its
// back, which is not weakened: a contact that kept the law with which it was born there held them at 1.27, or
// not, as the way there had it.
TEST(Fos, FactorDoesNotHangOnTheWayToIt) {
  const WorkFolder folder;
  folder.write("slope.toml", wet_slope_of_95_blocks());
  const std::vector<std::vector<std::string>> ways{{"stage.weight.increments=50"},
                                                   {"stage.weight.increments=800"},
                                                   {"stage.weight.solver=dynamic"},
                                                   {"run.fidelity=deformable",
                                                    "material.granite.youngs_modulus=40e9",
                                                    "material.granite.poissons_ratio=0.25"}};
  // Limit equilibrium of the three on their plane: W = 18.255 m2 2650 kg/m3 g, and by the phreatic line
  // U = 21.3 kN/m on their base and V = 3.5 kN/m at their back, which stands at 78.2 + 31.1 degrees to it:
  // F = tan(38) (W cos(31.11) - U + V cos(109.3))/(W sin(31.11) + V sin(109.3)).
  const double limit = 1.207;
  const fs::path report = folder / "results/slope_fos/fos.json";
  std::string holds;
  for (const std::vector<std::string> &way : ways) {
    std::vector<std::string> call{"fos", "slope.toml", "--overwrite"};
    for (const std::string &key : way) {
      call.insert(call.end(), {"--set", key});
    }
    EXPECT_EQ(run_gcpdda(0, call, folder).exit_code, 0) << way.front();
    holds = holds.empty() ? json_value(report, "holds") : holds;
    EXPECT_EQ(json_value(report, "holds"), holds) << way.front();
    const double found =
        0.5 * (std::stod(json_value(report, "holds")) + std::stod(json_value(report, "fails")));
    EXPECT_NEAR(found, limit, 0.01 * limit) << way.front() << ": the bracket is as wide";
  }
}

TEST(Fos, BeginsWithTheStateOfAnEarlierSearch) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::plane_failure_toml(0.0));
  const std::vector<std::string> call{"fos",  "plane.toml", "--tolerance", "0.3",
                                      "--to", "2.5",        "--from",      "0.8"};
  const auto with = [&](const std::vector<std::string> &more) {
    std::vector<std::string> longer = call;
    longer.insert(longer.end(), more.begin(), more.end());
    return longer;
  };
  ASSERT_EQ(run_gcpdda(0, call, folder).exit_code, 0);
  const std::string state = "results/plane_fos/settled";
  const Outcome again = run_gcpdda(2, with({"--settled", state, "--out", "again"}), folder);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_FALSE(fs::exists(folder / "again/settled"));
  EXPECT_NE(json_value(folder / "again/fos.json", "settled").find(state), std::string::npos)
      << "where a report finds it";
  for (const char *key : {"holds", "fails", "moving"}) {
    EXPECT_EQ(json_value(folder / "again/fos.json", key),
              json_value(folder / "results/plane_fos/fos.json", key))
        << key;
  }
  EXPECT_EQ(run_gcpdda(0, with({"--settled", state, "--overwrite"}), folder).exit_code, 0)
      << "in the folder of the earlier search, which keeps its state";

  const Outcome other = run_gcpdda(
      0, with({"--settled", state, "--out", "other", "--set", "joint.default.friction_angle_deg=44"}),
      folder);
  EXPECT_EQ(other.exit_code, 4);
  EXPECT_NE(other.err.find("settled with another scene"), std::string::npos) << other.err;
  EXPECT_NE(other.err.find("'friction_angle_deg = 44'"), std::string::npos) << other.err;
  EXPECT_FALSE(fs::exists(folder / "other"));
  const Outcome nothing = run_gcpdda(0, with({"--settled", "results", "--out", "other"}), folder);
  EXPECT_EQ(nothing.exit_code, 4);
  EXPECT_FALSE(fs::exists(folder / "other"));
  fs::remove_all(folder / state / "checkpoints");
  const Outcome stateless = run_gcpdda(2, with({"--settled", state, "--out", "other"}), folder);
  EXPECT_EQ(stateless.exit_code, 4);
  EXPECT_FALSE(fs::exists(folder / "other"));
}

/// Two blocks on a slope of 30 degrees, which slide on joints of 35 and of 45 degrees.
constexpr const char *two_sliders = R"([run]
fidelity = "rigid"
gravity = [4.905, -8.495709]
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 2e8
friction_angle_deg = 45.0
[joint.weak]
friction_angle_deg = 35
[output]
interval = 0.1
[[block]]
name = "slope"
material = "rock"
fixed = true
vertices = [[-2, -1], [60, -1], [60, 0], [-2, 0]]
[[block]]
name = "small"
material = "rock"
vertices = [[0, 0], [1, 0], [1, 0.5], [0, 0.5]]
edge_joints = ["weak", "", "", ""]
[[block]]
name = "big"
material = "rock"
vertices = [[20, 0], [24, 0], [24, 2], [20, 2]]
[[stage]]
name = "weight"
kind = "settle"
limit = 10.0
[fos]
limit = 0.05
patience = 0
)";

// The static solver comes to its verdicts in any limit, the dynamic step does not. By limit equilibrium the
// smaller block fails at tan(35)/tan(30) = 1.213.
TEST(Fos, EndsWhereNoVerdictIsConfirmed) {
  const WorkFolder folder;
  folder.write("sliders.toml", two_sliders);
  const Outcome alone = run_gcpdda(0, {"fos", "sliders.toml", "--out", "alone"}, folder);
  EXPECT_EQ(alone.exit_code, 7) << alone.err;
  EXPECT_NE(alone.out.find("by the static solver alone the blocks hold at 1.2064 and fail at no factor"),
            std::string::npos)
      << alone.out;
  EXPECT_NE(alone.out.find("3 confirmations by the dynamic step are undecided in fos.limit = 0.05 s"),
            std::string::npos)
      << alone.out;
  EXPECT_NE(alone.out.find("such as fos.limit = 0.5, or fos.patience = 8"), std::string::npos) << alone.out;
  const fs::path report = folder / "alone/fos.json";
  EXPECT_EQ(json_value(report, "holds"), "null");
  EXPECT_EQ(json_value(report, "found"), "0");
  EXPECT_EQ(std::stod(json_value(report, "static_holds")), 1.2064);
  EXPECT_EQ(json_value(report, "static_fails"), "null");
  EXPECT_LT(lines_of(file_text(folder / "alone/fos_trials.csv")).size(), 25U);

  const Outcome together = run_gcpdda(2, {"fos", "sliders.toml", "--out", "together"}, folder);
  EXPECT_EQ(together.exit_code, 7) << together.err;
  EXPECT_EQ(lines_of(together.out).front(), lines_of(alone.out).front());
  const Outcome longer =
      run_gcpdda(0, {"fos", "sliders.toml", "--set", "fos.limit=0.5", "--set", "fos.patience=8"}, folder);
  EXPECT_EQ(longer.exit_code, 0) << longer.out << "the remedy that the text names";
}

// On one rank, one trial after the other; the second gains speed so slowly that it takes a long time.
TEST(Fos, TellsWhatItKnowsWhereTheSignalStopsIt) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::plane_failure_toml(0.0));
  const fs::path results = folder / "results/plane_fos";
  const std::string more = fmt::format("{:.7g}", 1.00001 * testing::plane_failure_factor(0.0));
  testing::Process process(
      testing::gcpdda_words(0, {"fos", "plane.toml", "--from", "1.2", "--to", more, "--set",
                                "fos.failure_motion=1e6", "--set", "fos.limit=1e4"}),
      folder.path());
  const fs::path trial = results / ("trials/F" + more);
  const fs::path started = trial / "history/energy.csv";
  process.wait_until([&] { return fs::exists(started); });
  kill(process.id(), SIGUSR1);
  const Outcome stopped = process.wait();
  EXPECT_EQ(stopped.exit_code, 6) << stopped.err;
  EXPECT_NE(stopped.err.find("stopped by a signal in trial 2"), std::string::npos) << stopped.err;
  EXPECT_NE(stopped.out.find("the blocks still hold at 1.2"), std::string::npos) << stopped.out;
  EXPECT_EQ(stopped.out.find("undecided in the limit"), std::string::npos) << stopped.out;
  EXPECT_EQ(stopped.err.find("gcpdda restart"), std::string::npos) << "a trial is not gone on with";
  EXPECT_EQ(file_text(results / "fos.txt"), stopped.out);
  EXPECT_EQ(std::stod(json_value(results / "fos.json", "holds")), 1.2);
  EXPECT_EQ(lines_of(file_text(results / "fos_trials.csv")).size(), 3U);
  EXPECT_TRUE(fs::exists(trial / "frames/frame_000000.hdf")) << "as it was stopped";
  EXPECT_FALSE(fs::exists(trial / "checkpoints"));
}

TEST(Fos, SaysThatItLeavesTheEarthquakeOut) {
  const WorkFolder folder;
  folder.write("push.csv", "0.0, -30.0\n1.0, -30.0\n");
  folder.write("plane.toml", testing::plane_failure_toml(0.0) +
                                 "[earthquake]\nrecord = \"push.csv\"\nquantity = \"acceleration\"\n");
  const Outcome found = run_gcpdda(0, {"fos", "plane.toml", "--tolerance", "0.3"}, folder);
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_NE(found.out.find("the earthquake of the scene is left out"), std::string::npos) << found.out;
}

TEST(Fos, NamesStagesThatItLeavesOut) {
  const WorkFolder folder;
  std::string toml = testing::plane_failure_toml(0.0);
  toml.erase(toml.find("[ensemble]"));
  folder.write("plane.toml", toml + "[[stage]]\nkind = \"settle\"\nlimit = 10.0\n"
                                    "[[stage]]\nname = \"weaker\"\nkind = \"run\"\nlimit = 1.0\n"
                                    "set = { \"joint.default.friction_angle_deg\" = 1.0 }\n"
                                    "[[stage]]\nname = \"later\"\nkind = \"run\"\nduration = 1.0\n");
  const Outcome found = run_gcpdda(0, {"fos", "plane.toml", "--tolerance", "0.3"}, folder);
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_NE(found.out.find("stage 'weaker' is left out with what it changes"), std::string::npos)
      << found.out;
  EXPECT_EQ(found.out.find("stage 'later'"), std::string::npos) << "it changes nothing";
}

TEST(Fos, SaysWhyATrialCannotRun) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::plane_failure_toml(0.0));
  const Outcome outcome = run_gcpdda(0, {"fos", "plane.toml", "--set", "fos.limit=1e6"}, folder);
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.err.find("cannot run: plane.toml:"), std::string::npos) << outcome.err;
}

TEST(Fos, RefusesWhatItCannotSearch) {
  const WorkFolder folder;
  folder.write("plane.toml", testing::plane_failure_toml(0.0));
  const Outcome family = run_gcpdda(0, {"fos", "plane.toml", "--families", "defalt,default"}, folder);
  EXPECT_EQ(family.exit_code, 3);
  EXPECT_NE(family.err.find("did you mean 'default'?"), std::string::npos) << family.err;
  const Outcome in_front =
      run_gcpdda(0, {"fos", "--families", "defalt", "plane.toml", "--tolerance", "0.1"}, folder);
  EXPECT_EQ(in_front.exit_code, 3) << "the option takes one value: " << in_front.err;
  EXPECT_NE(in_front.err.find("did you mean 'default'?"), std::string::npos) << in_front.err;
  const Outcome word = run_gcpdda(0, {"fos", "plane.toml", "--tolerance", "little"}, folder);
  EXPECT_EQ(word.exit_code, 3);
  EXPECT_NE(word.err.find("'tolerance' in [fos]"), std::string::npos) << word.err;
  const Outcome unsettled = run_gcpdda(
      0, {"fos", "plane.toml", "--from", "0.7", "--set", "joint.default.friction_angle_deg=20"}, folder);
  EXPECT_EQ(unsettled.exit_code, 7);
  EXPECT_NE(unsettled.err.find("do not settle, not even with the largest strength"), std::string::npos)
      << unsettled.err;
  const Outcome undecided = run_gcpdda(
      0, {"fos", "plane.toml", "--out", "short", "--set", "stage=[{kind=\"settle\",limit=1e-3}]"}, folder);
  EXPECT_EQ(undecided.exit_code, 7);
  EXPECT_NE(undecided.err.find("do not settle, not even with the largest strength"), std::string::npos)
      << undecided.err;
  EXPECT_FALSE(fs::exists(folder / "short/fos.json"));
}

/// A slab 1 m wide and 3 m high under so much horizontal force at its top, and under its weight of 78 kN.
std::string pushed_slab_toml(double force) {
  return "[run]\nfidelity = \"rigid\"\ngravity = [0, -10]\n[material.rock]\ndensity = "
         "2600.0\n[joint.default]\n"
         "normal_stiffness = 1e9\nfriction_angle_deg = 45\n" +
         testing::block_toml("floor", testing::rectangle({-10.0, -1.0}, {20.0, 0.0}), "fixed = true") +
         testing::block_toml("slab", testing::rectangle({0.0, 0.0}, {1.0, 3.0})) +
         fmt::format("[[block.load]]\npoint = [0.0, 3.0]\nforce = [{}, 0.0]\n", force) +
         "[[stage]]\nname = \"push\"\nkind = \"settle\"\nlimit = 20.0\n";
}

// It topples from a sixth of its weight on, however strong its joint is.
TEST(Fos, SaysThatStrengthHasNoPartInAFailure) {
  const WorkFolder folder;
  folder.write("slab.toml", pushed_slab_toml(0.51 * 78e3));
  const Outcome outcome = run_gcpdda(0, {"fos", "slab.toml"}, folder);
  EXPECT_EQ(outcome.exit_code, 7);
  EXPECT_NE(
      outcome.err.find("they fail even with strengths multiplied by 2: either the factor of safety is below "
                       "0.5, or friction has no part in it"),
      std::string::npos)
      << outcome.err;
  const fs::path results = folder / "results/slab_fos";
  EXPECT_EQ(file_text(results / "fos.txt"), outcome.out);
  EXPECT_NE(outcome.out.find("the blocks fail already at 0.5, the smallest factor tried"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("friction has no part in it"), std::string::npos) << outcome.out;
  EXPECT_EQ(json_value(results / "fos.json", "holds"), "null");
  EXPECT_EQ(json_value(results / "fos.json", "fails"), "0.5");
}

// Said by the run that settles and by the report, each once.
TEST(Fos, WarnsOfSlidesBeforeTheSearch) {
  const WorkFolder folder;
  std::string toml = pushed_slab_toml(10e3);
  toml.replace(toml.find("friction_angle_deg = 45"), 23, "friction_angle_deg = 5");
  folder.write("slab.toml", toml +
                                "[[block]]\nname = \"stop\"\nmaterial = \"rock\"\nfixed = true\nvertices = "
                                "[[1.2, 0.1], [2, 0.1], [2, 1], [1.2, 1]]\n");
  const Outcome outcome = run_gcpdda(0, {"fos", "slab.toml", "--bound", "--out", "bound"}, folder);
  const std::string said = "block 'slab' slid in stage 'push' before rest, the farthest by 0.2";
  EXPECT_EQ(testing::count_of(outcome.out, said), 1) << outcome.out;
  EXPECT_EQ(testing::count_of(file_text(folder / "bound/settled/run.log"), said), 1);
  EXPECT_EQ(json_value(folder / "bound/fos.json", "slides_from"), "1");
  EXPECT_NE(file_text(folder / "bound/fos.json").find("\"stage\": \"push\""), std::string::npos);
  const Outcome again =
      run_gcpdda(0, {"fos", "slab.toml", "--bound", "--settled", "bound/settled", "--out", "again"}, folder);
  EXPECT_EQ(testing::count_of(again.out, said), 1) << again.out << again.err;
  const Outcome limited = run_gcpdda(0,
                                     {"fos", "slab.toml", "--bound", "--settled", "bound/settled", "--out",
                                      "limited", "--set", "fos.largest_motion=0.02"},
                                     folder);
  EXPECT_EQ(limited.exit_code, 7);
  EXPECT_NE(limited.err.find("more than fos.largest_motion = 0.02"), std::string::npos) << limited.err;
  const Outcome together = run_gcpdda(2, {"run", "slab.toml", "--out", "run"}, folder);
  EXPECT_EQ(testing::count_of(together.err, said), 1) << together.err;
}

} // namespace
} // namespace gcpdda::fos_test
