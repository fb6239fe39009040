// gcpdda inspect and gcpdda reference as users start them.

#include "child_process.hpp"
#include "sample_scenes.hpp"
#include "support/run_facts.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <regex>

namespace gcpdda::inspect_test {
namespace {

namespace fs = std::filesystem;
using testing::block_toml;
using testing::count_of;
using testing::file_text;
using testing::lines_of;
using testing::listing;
using testing::Outcome;
using testing::rectangle;
using testing::run_gcpdda;
using testing::WorkFolder;

constexpr double density = 2600.0;
constexpr double gravity = 9.81;
constexpr double youngs_modulus = 5e9;
constexpr double sliver_width = 0.002;
constexpr double needle_height = 0.174977327; // 2 m tan 5 degrees
constexpr double depth = 0.001;               ///< of the needle in the floor

/// A floor and five mobile blocks: two squares, a needle of 5 degrees sunk into the floor, a sliver, an L.
/// Mobile extent along gravity from -0.001 to 2 m; sorted by sqrt(area) the L's neighbours are the squares.
std::string odd_scene() {
  return fmt::format("[run]\nduration = 1.0\naccepted_error = 0.019\n[material.rock]\ndensity = {}\n"
                     "youngs_modulus = {}\npoissons_ratio = 0.25\n[joint.default]\nallowed_overlap = 1e-3\n"
                     "friction_angle_deg = 30\n[output]\ninterval = 0.1\n",
                     density, youngs_modulus) +
         block_toml("floor", rectangle({-9.0, -2.0}, {9.0, 0.0}), "fixed = true") +
         block_toml("unit", rectangle({0.0, 0.0}, {1.0, 1.0})) +
         block_toml("large", rectangle({1.5, 0.0}, {3.5, 2.0})) +
         block_toml("needle", {{4.0, -depth}, {6.0, -depth}, {6.0, needle_height - depth}}) +
         block_toml("sliver", rectangle({-5.0, 0.0}, {-5.0 + sliver_width, 1.0}), "fidelity = \"rigid\"") +
         block_toml("ell", {{-3.0, 0.0}, {-1.0, 0.0}, {-1.0, 1.0}, {-2.0, 1.0}, {-2.0, 2.0}, {-3.0, 2.0}});
}

/// k_n = rho g h/(e L), L the median of sqrt(area): sliver, needle, unit, ell, large.
constexpr double expected_stiffness = density * gravity * (2.0 + depth) / (1e-3 * 1.0);

/// Share of the compliance that a rigid block of this area leaves out.
double share(double area) {
  const double joint = expected_stiffness * std::sqrt(area);
  return joint / (youngs_modulus + joint);
}

/// sqrt of 2 lambda_max(M^-1 K) of a rigid rectangle whose whole boundary is in contact; K is diagonal [std].
double rectangle_frequency(double width, double height) {
  const double k_n = expected_stiffness;
  const double k_t = 0.5 * k_n;
  const double mass = density * width * height;
  const double inertia = mass * (width * width + height * height) / 12.0;
  const double turning =
      k_n * (std::pow(width, 3) + std::pow(height, 3)) / 6.0 + k_t * 0.5 * width * height * (width + height);
  return std::sqrt(2.0 * std::max({2.0 * (k_n * height + k_t * width) / mass,
                                   2.0 * (k_n * width + k_t * height) / mass, turning / inertia}));
}

/// What matches the first group; fails the test where nothing does.
std::string match(const std::string &text, const std::string &pattern) {
  std::smatch found;
  if (!std::regex_search(text, found, std::regex(pattern))) {
    ADD_FAILURE() << "nothing matches " << pattern << " in\n" << text;
    return "0";
  }
  return found[1];
}

double number(const std::string &text, const std::string &pattern) {
  return std::stod(match(text, pattern));
}

/// Numbers are told with three to six digits.
constexpr double six_digits = 5e-6;
constexpr double three_digits = 5e-3;

class Inspect : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<WorkFolder>();
    folder_->write("odd.toml", odd_scene());
    outcome_ = run_gcpdda(0, {"inspect", "odd.toml", "--ranks", "4"}, *folder_);
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override { ASSERT_EQ(outcome_.exit_code, 0) << outcome_.err; }

  static std::unique_ptr<WorkFolder> folder_;
  static Outcome outcome_;
};

std::unique_ptr<WorkFolder> Inspect::folder_;
Outcome Inspect::outcome_;

TEST_F(Inspect, WritesNothingButTheReport) {
  EXPECT_EQ(listing(folder_->path()), std::vector<std::string>{"odd.toml"});
  EXPECT_EQ(outcome_.err, "");
  EXPECT_EQ(count_of(outcome_.out, "scene 'odd'\n"), 1) << outcome_.out;
}

TEST_F(Inspect, CountsTheBlocks) {
  // Four rectangles with the floor, a triangle and an L of six.
  EXPECT_EQ(count_of(outcome_.out, "5 mobile, 1 fixed, 25 vertices, 1 with re-entrant vertices\n"), 1)
      << outcome_.out;
}

// At accepted_error = 0.019: unit 0.0101 and needle 0.0042 rigid, ell 0.0173 too, large 0.0200 just above.
TEST_F(Inspect, TellsKindsAndWhy) {
  ASSERT_LT(share(3.0), 0.019);
  ASSERT_GT(share(4.0), 0.019);
  EXPECT_EQ(count_of(outcome_.out, "4 rigid, 1 deformable; accepted error 0.019;"), 1) << outcome_.out;
  EXPECT_NEAR(number(outcome_.out, "of the rigid blocks is (\\S+) at most"), share(3.0),
              three_digits * share(3.0));
  EXPECT_NEAR(number(outcome_.out, "of the deformable ones (\\S+) at most"), share(4.0),
              three_digits * share(4.0));
}

TEST_F(Inspect, TellsTheStiffnessOfAnAllowedOverlap) {
  EXPECT_NEAR(number(outcome_.out, "'default': k_n (\\S+) Pa/m \\(from allowed_overlap = 0.001\\)"),
              expected_stiffness, six_digits * expected_stiffness);
  EXPECT_EQ(count_of(outcome_.out, "k_t/k_n 0.5, friction angle 30 deg, cohesion 0 Pa"), 1) << outcome_.out;
}

TEST_F(Inspect, TellsTheStepOfAFastBlock) {
  folder_->write("fast.toml", odd_scene() + block_toml("fast", rectangle({0.0, 5.0}, {1.0, 6.0}),
                                                       "velocity = [90, 0, 0]"));
  const Outcome outcome = run_gcpdda(0, {"inspect", "fast.toml"}, *folder_);
  fs::remove(folder_->path() / "fast.toml");
  EXPECT_EQ(match(outcome.out, "set by block '(\\w+)'"), "fast");
  const double bound = 0.9 * 0.25 * sliver_width / 90.0;
  EXPECT_NEAR(number(outcome.out, "at most (\\S+) s, set by"), bound, six_digits * bound);
  EXPECT_LE(number(outcome.out, "step +(\\S+) s \\(automatic\\)"), bound);
}

TEST_F(Inspect, TellsTheStepAndWhoLimitsIt) {
  EXPECT_EQ(match(outcome_.out, "set by block '(\\w+)'"), "sliver");
  const double omega = number(outcome_.out, "omega_max (\\S+) rad/s");
  const double expected = rectangle_frequency(sliver_width, 1.0);
  EXPECT_NEAR(omega, expected, six_digits * expected);
  // The limit itself, 2 without damping and less with, is told with four digits.
  const double limit = number(outcome_.out, "limit (\\S+) /");
  EXPECT_GT(limit, 1.5);
  EXPECT_LT(limit, 2.0);
  const double bound = number(outcome_.out, "at most (\\S+) s = safety 0.55 x");
  EXPECT_NEAR(bound, 0.55 * limit / expected, 5e-4 * bound);
  const double step = number(outcome_.out, "step +(\\S+) s \\(automatic\\)");
  EXPECT_LE(step, bound * (1.0 + six_digits));
  const double steps = number(outcome_.out, "\\(automatic\\), (\\d+) steps of 1 s in all");
  EXPECT_NEAR(step * steps, 1.0, six_digits);
  EXPECT_EQ(std::fmod(steps, 10.0), 0.0) << "outputs every 0.1 s fall on whole steps";
}

TEST_F(Inspect, TellsAGivenStep) {
  const Outcome given = run_gcpdda(0, {"inspect", "odd.toml", "--set", "run.time_step=1e-6"}, *folder_);
  EXPECT_EQ(count_of(given.out, "1e-06 s (as given), 1000000 steps of 1 s in all"), 1) << given.out;
}

// A settle stage of the static solver ends after some hundred evaluations, whatever its limit is.
TEST(InspectPlan, TellsNoStepsOfAStageOfTheStaticSolver) {
  const WorkFolder folder;
  std::string toml = odd_scene();
  toml.erase(toml.find("duration = 1.0\n"), 15);
  const auto told = [&](const std::string &solver) {
    folder.write("plan.toml",
                 toml + "[[stage]]\nkind = \"settle\"\nlimit = 1e4\nsolver = \"" + solver + "\"\n");
    return run_gcpdda(0, {"inspect", "plan.toml"}, folder).out;
  };
  const std::string of_motion = told("dynamic");
  EXPECT_TRUE(
      std::regex_search(of_motion, std::regex("run time +about \\S+ (s|min|h) of stepping on 1 rank")))
      << of_motion;
  const std::string of_statics = told("static");
  EXPECT_TRUE(std::regex_search(of_statics,
                                std::regex("step .*, for motion that takes over from the static solver\n")))
      << of_statics;
  EXPECT_TRUE(std::regex_search(
      of_statics, std::regex("run time +about \\S+ (s|min) for a hundred evaluations of the static solver")))
      << of_statics;
  EXPECT_EQ(of_statics.find("of stepping"), std::string::npos) << of_statics;
}

TEST(InspectPlan, TellsStagesWaterAndBolts) {
  const WorkFolder folder;
  std::string toml = odd_scene();
  toml.erase(toml.find("duration = 1.0\n"), 15);
  folder.write("plan.toml", toml + R"([water.table]
phreatic = [[-9, -1], [9, 0.5]]
[support.cable]
kind = "anchored"
axial_stiffness = 1e7
[[bolt]]
name = "b"
support = "cable"
from = [0.5, 0.5]
to = [0.5, -1.5]
[[stage]]
name = "weight"
kind = "settle"
limit = 2.0
[[stage]]
name = "gap"
kind = "excavate"
blocks = ["large"]
relax = 0.5
)");
  const Outcome outcome = run_gcpdda(0, {"inspect", "plan.toml"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char *line : {"stage       'weight': settle, until unbalanced forces are 1e-05, 2 s at most\n",
                           "stage       'gap': excavate, forces fall to zero in 0.5 s\n",
                           "water       'table': level between -1 and 0.5 m, in all joints\n",
                           "bolts       1, 0 of them put in by a stage; 1 links across joints now\n"}) {
    EXPECT_EQ(count_of(outcome.out, line), 1) << line << outcome.out;
  }
}

// What it says of a stage's own damping is what it says where the damping is that of the run.
TEST(InspectPlan, TellsWhatTheDampingOfAStageCosts) {
  const WorkFolder folder;
  std::string toml = odd_scene();
  toml.erase(toml.find("duration = 1.0\n"), 15);
  folder.write("plan.toml",
               toml + "[[stage]]\nkind = \"run\"\nduration = 1.0\n[[stage]]\nname = \"shaking\"\nkind "
                      "= \"run\"\nduration = 1.0\nset = { \"run.rayleigh\" = { ratio = 0.05, "
                      "frequency = 5.0 } }\n[[stage]]\nkind = \"run\"\nduration = 1.0\n");
  const std::string by_stage = run_gcpdda(0, {"inspect", "plan.toml"}, folder).out;
  const std::string by_run =
      run_gcpdda(0, {"inspect", "plan.toml", "--set", "run.rayleigh={ratio=0.05,frequency=5.0}"}, folder).out;
  const auto word_after = [](const std::string &text, const std::string &before) {
    const std::size_t begin = text.find(before) + before.size();
    return text.substr(begin, text.find(' ', begin) - begin);
  };
  EXPECT_EQ(count_of(by_stage, "Rayleigh"), 1) << by_stage;
  const std::string stage = "'shaking': run, 1 s, Rayleigh damping with ratio ";
  EXPECT_EQ(count_of(by_stage, stage), 1) << by_stage;
  EXPECT_EQ(word_after(by_stage, stage), word_after(by_run, "beta 0.001592 s; ratio ")) << by_run;
  const std::string line = by_run.substr(by_run.find("without it the step would be at most "));
  EXPECT_EQ(word_after(by_stage, "without it the step would be "), word_after(line, " s, ")) << line;
}

// A square balanced on its corner and one flush on its face, which take up their weight as gravity rises and
// are damped: each ends as deep as inspect says. The weight lets them swing by a few (T/ramp)^2 = (0.03/1)^2
// of the depth, and the flush joint closes by d/(2 l) = 1e-5 more than its linear law.
TEST(InspectPlan, LeavesOutTheWeightOfADrivenBlock) {
  const WorkFolder folder;
  const std::string scene = "[run]\nduration = 1.0\n[material.rock]\ndensity = 2600.0\n[joint.default]\n"
                            "normal_stiffness = 1e9\n" +
                            block_toml("floor", rectangle({-9.0, -2.0}, {9.0, 0.0}), "fixed = true") +
                            block_toml("loose", rectangle({-3.0, 0.0}, {-2.0, 1.0}));
  folder.write("driven.toml", scene + block_toml("ram", rectangle({2.0, 0.5}, {6.0, 3.5}),
                                                 "prescribed_velocity = [-0.1, 0.0, 0.0]"));
  const auto outcome = run_gcpdda(0, {"inspect", "driven.toml"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const double weight = 2600.0 * gravity;
  EXPECT_NEAR(number(outcome.out, "under (\\S+) N/m, the weight of block 'loose'"), weight,
              three_digits * weight);
  EXPECT_NEAR(number(outcome.out, "under all mobile blocks, (\\S+) N/m"), weight, three_digits * weight);
}

TEST(InspectPlan, TellsHowDeepACornerSinks) {
  const WorkFolder folder;
  const double half = std::sqrt(0.5);
  folder.write(
      "corner.toml",
      "[run]\nduration = 2.0\ngravity_ramp = 1.0\nfidelity = \"rigid\"\ncontact_damping = "
      "0.3\n[material.rock]\ndensity = 2600.0\n[joint.default]\nnormal_stiffness = 1e9\n"
      "friction_angle_deg = 30\n[output]\ninterval = 0.1\n" +
          block_toml("floor", rectangle({-9.0, -2.0}, {9.0, 0.0}), "fixed = true") +
          block_toml("flush", rectangle({-3.0, 0.0}, {-2.0, 1.0})) +
          block_toml("corner", {{2.0, 0.0}, {2.0 + half, half}, {2.0, 2.0 * half}, {2.0 - half, half}}) +
          "[[monitor]]\nblock = \"flush\"\n[[monitor]]\nblock = \"corner\"\n");
  const std::string told = run_gcpdda(0, {"inspect", "corner.toml"}, folder).out;
  ASSERT_EQ(run_gcpdda(0, {"run", "corner.toml", "--out", "out"}, folder).exit_code, 0);
  const auto sunk = [&](const std::string &block) {
    const auto height = [](const std::string &row) {
      const std::size_t second = row.find(',', row.find(',') + 1) + 1;
      return std::stod(row.substr(second));
    };
    const std::vector<std::string> rows = lines_of(file_text(folder / ("out/history/" + block + ".csv")));
    return height(rows.at(1)) - height(rows.back());
  };
  const double weight = 2600.0 * gravity;
  EXPECT_NEAR(number(told, "under (\\S+) N/m, the weight of block '(?:flush|corner)'"), weight,
              three_digits * weight)
      << told;
  EXPECT_NEAR(number(told, "closes by (\\S+) m"), weight / 1e9, three_digits * weight / 1e9);
  EXPECT_NEAR(number(told, "closes by (\\S+) m"), sunk("flush"), three_digits * sunk("flush"));
  const double corner = number(told, "right-angled corner sinks by (\\S+) m");
  EXPECT_NEAR(corner, sunk("corner"), three_digits * corner);
  EXPECT_GT(corner, 100.0 * sunk("flush"));
  // Both blocks on one corner: the square root of twice the load.
  EXPECT_NEAR(number(told, "N/m, a corner by (\\S+) m"), std::sqrt(2.0) * corner,
              2.0 * three_digits * corner);
}

TEST_F(Inspect, TellsSubdomainsAndCosts) {
  EXPECT_TRUE(std::regex_search(outcome_.out, std::regex("subdomains +4 by [^:]+: [01] to [2-5] blocks each, "
                                                         "imbalance of the work [0-9.]+\n")))
      << outcome_.out;
  EXPECT_TRUE(std::regex_search(outcome_.out, std::regex("memory +[0-9.]+ [kMG]B of state")));
  EXPECT_TRUE(
      std::regex_search(outcome_.out, std::regex("run time +about [0-9.e+-]+ (s|min|h) of stepping")));
  // Ten intervals and t = 0; two digits of a frame's size in kB.
  const double frame = number(outcome_.out, "output +11 frames of about (\\S+) kB");
  EXPECT_NEAR(number(outcome_.out, ", (\\S+) kB in all"), 11.0 * frame, 6.0);
}

TEST_F(Inspect, TellsOddities) {
  EXPECT_EQ(count_of(outcome_.out, "1 blocks with a needle below 10 degrees; the sharpest corner has 5 "
                                   "degrees, block 'needle'"),
            1)
      << outcome_.out;
  // width/sqrt(area) of a rectangle of height 1 is sqrt(width).
  const double narrowest =
      number(outcome_.out, "1 blocks narrower than 0.05 of sqrt\\(area\\); the narrowest "
                           "has (\\S+), block 'sliver'");
  EXPECT_NEAR(narrowest, std::sqrt(sliver_width), three_digits * narrowest);
  EXPECT_EQ(
      count_of(outcome_.out, "the deepest initial overlap is 0.001 m between blocks 'floor' and 'needle'"), 1)
      << outcome_.out;
}

// All that does not depend on the machine or the number of processes.
TEST_F(Inspect, SaysTheSameOnAnyRanks) {
  const auto lasting = [](const std::string &text) {
    std::vector<std::string> lines = lines_of(text);
    std::erase_if(lines, [](const std::string &line) {
      return line.starts_with("memory") || line.starts_with("run time");
    });
    return lines;
  };
  const Outcome three = run_gcpdda(3, {"inspect", "odd.toml", "--ranks", "4"}, *folder_);
  ASSERT_EQ(three.exit_code, 0) << three.err;
  EXPECT_GT(lasting(three.out).size(), 8U);
  EXPECT_EQ(lasting(three.out), lasting(outcome_.out));
  EXPECT_NE(three.out.find("of stepping on 3 ranks"), std::string::npos);
  // Without --ranks as many subdomains as processes.
  const Outcome plain = run_gcpdda(3, {"inspect", "odd.toml"}, *folder_);
  EXPECT_TRUE(std::regex_search(plain.out, std::regex("subdomains +3 by "))) << plain.out;
}

/// Elements of a text in which every tag is closed in order; throws no exception but fails the test.
int count_elements(const std::string &xml) {
  const std::regex tag("<(/?)([A-Za-z]+)((?:\\s+[A-Za-z-]+=\"[^\"<>&]*\")*)\\s*(/?)>");
  std::vector<std::string> open;
  int elements = 0;
  std::size_t covered = 0;
  for (std::sregex_iterator at(xml.begin(), xml.end(), tag); at != std::sregex_iterator(); ++at) {
    const std::smatch &m = *at;
    const std::string between = xml.substr(covered, static_cast<std::size_t>(m.position()) - covered);
    EXPECT_EQ(between.find_first_of("<>&"), std::string::npos) << between;
    covered = static_cast<std::size_t>(m.position() + m.length());
    if (m[1].length() > 0) {
      EXPECT_FALSE(open.empty() || open.back() != m[2].str()) << "closed out of order: " << m.str();
      open.pop_back();
    } else {
      ++elements;
      if (m[4].length() == 0) {
        open.push_back(m[2]);
      }
    }
  }
  EXPECT_TRUE(open.empty()) << open.back() << " is never closed";
  EXPECT_EQ(xml.substr(covered), "\n");
  return elements;
}

TEST(InspectPicture, HasOnePolygonABlock) {
  for (const int ranks : {0, 3}) {
    const WorkFolder folder;
    folder.write("odd.toml", odd_scene());
    const Outcome outcome =
        run_gcpdda(ranks, {"inspect", "odd.toml", "--ranks", "4", "--svg", "odd.svg"}, folder);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(listing(folder.path()), (std::vector<std::string>{"odd.svg", "odd.toml"}));
    const std::string svg = file_text(folder / "odd.svg");
    EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    EXPECT_GT(count_elements(svg), 1 + 1 + 6 + 1) << "svg, background, blocks, legend, and axes";
    std::vector<std::ptrdiff_t> corners;
    const std::regex polygon("<polygon [^>]*points=\"([^\"]*)\"");
    for (std::sregex_iterator at(svg.begin(), svg.end(), polygon); at != std::sregex_iterator(); ++at) {
      const std::string points = (*at)[1];
      corners.push_back(std::count(points.begin(), points.end(), ','));
    }
    std::sort(corners.begin(), corners.end());
    EXPECT_EQ(corners, (std::vector<std::ptrdiff_t>{3, 4, 4, 4, 4, 6}));
    EXPECT_EQ(count_of(svg, "#9a9a9a"), 1) << "the floor is grey";
    EXPECT_NE(svg.find("6 blocks, 4 subdomains, 18 m x 4 m"), std::string::npos);
  }
}

/// Exit code, what is said once, and no file touched.
void expect_refusal(int ranks, const std::vector<std::string> &arguments, int exit_code,
                    const std::vector<std::string> &said, const WorkFolder &folder) {
  const std::vector<std::string> before = listing(folder.path());
  const Outcome outcome = run_gcpdda(ranks, arguments, folder);
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  for (const std::string &text : said) {
    EXPECT_EQ(count_of(outcome.err, text), 1) << "expected once: " << text << "\nin: " << outcome.err;
  }
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(listing(folder.path()), before);
}

WorkFolder &with_bad_scenes(WorkFolder &folder) {
  folder.write("odd.toml", odd_scene());
  folder.write("misspelt.toml",
               odd_scene() + "[[block]]\nname = \"no\"\nmaterial = \"slate\"\nvertises = 1\n");
  folder.write("deep.toml", odd_scene() + block_toml("deep", rectangle({0.0, 0.75}, {1.0, 1.75})));
  folder.write("nowhere.toml", odd_scene() + "[[monitor]]\nname = \"sky\"\npoint = [0.0, 50.0]\n");
  return folder;
}

TEST(InspectRefuses, WhatItCannotDo) {
  WorkFolder folder;
  with_bad_scenes(folder);
  expect_refusal(0, {"inspect", "misspelt.toml", "--svg", "p.svg"}, 3, {"'slate'", "'vertises'"}, folder);
  expect_refusal(0, {"inspect", "nowhere.toml"}, 3, {"no block holds the point (0, 50)"}, folder);
  expect_refusal(0, {"inspect", "odd.toml", "--ranks", "0"}, 2, {"--ranks"}, folder);
  expect_refusal(0, {"inspect", "odd.toml", "--ranks", "many"}, 2, {"--ranks"}, folder);
  expect_refusal(0, {"inspect"}, 2, {"SCENE is required"}, folder);
  expect_refusal(0, {"inspect", "lost.toml"}, 4, {"lost.toml"}, folder);
}

TEST(InspectRefuses, InOneVoice) {
  WorkFolder folder;
  with_bad_scenes(folder);
  expect_refusal(3, {"inspect", "deep.toml", "--svg", "p.svg"}, 3,
                 {"blocks 'unit' and 'deep' overlap by 0.25 m"}, folder);
  expect_refusal(3, {"inspect", "odd.toml", "--ranks", "0"}, 2, {"--ranks"}, folder);
  expect_refusal(3, {"inspect", "odd.toml", "--svg", "no/such/folder.svg"}, 4, {"no/such/folder.svg"},
                 folder);
}

// The keys of the contract, each with the table it stands in.
TEST(Reference, HasEveryKeyAndIsThePageThatShips) {
  const WorkFolder folder;
  const Outcome outcome = run_gcpdda(0, {"reference"}, folder);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_TRUE(listing(folder.path()).empty());
  const auto section = [&](const std::string &title) {
    const std::size_t begin = outcome.out.find("## " + title + "\n");
    EXPECT_NE(begin, std::string::npos) << title;
    return begin == std::string::npos
               ? ""
               : outcome.out.substr(begin, outcome.out.find("\n## ", begin + 1) - begin);
  };
  const std::vector<std::pair<std::string, std::vector<std::string>>> contract{
      {"[run]",
       {"duration", "gravity", "gravity_ramp", "time_step", "safety", "scheme", "spectral_radius",
        "contact_time", "potential", "fidelity", "accepted_error", "initial_friction", "contact_damping",
        "local_damping", "rayleigh", "elasticity", "plane"}},
      {"[run.rayleigh]", {"ratio", "frequency"}},
      {"[material.NAME]", {"density", "youngs_modulus", "poissons_ratio"}},
      {"[joint.NAME]",
       {"materials", "normal_stiffness", "allowed_overlap", "rock_mass_modulus", "intact_modulus", "spacing",
        "tangential_ratio", "friction_angle_deg", "cohesion", "tension", "residual_friction_angle_deg",
        "residual_cohesion", "dilation_angle_deg", "dilation_limit", "law", "jrc", "jcs"}},
      {"[[block]]",
       {"name", "material", "vertices", "edge_joints", "velocity", "fixed", "fidelity", "fixed_points",
        "prescribed_velocity", "velocity_table", "load"}},
      {"[[block.load]]", {"point", "force", "ramp", "table"}},
      {"[[wall]]", {"name", "material", "origin", "rows", "columns", "block_size", "bond", "gap"}},
      {"[[pyramid]]", {"name", "material", "origin", "rows", "block_size", "gap"}},
      {"[blocks]", {"file"}},
      {"[output]", {"interval", "history_interval", "checkpoint_interval", "contacts"}},
      {"[fos]",
       {"families", "from", "to", "tolerance", "limit", "patience", "failure_motion", "largest_motion",
        "local_damping", "ignore_area", "region"}},
      {"[[monitor]]", {"block", "name", "point", "along", "points"}}};
  for (const auto &[title, keys] : contract) {
    const std::string text = section(title);
    for (const std::string &key : keys) {
      EXPECT_EQ(count_of(text, "\n| `" + key + "` |"), 1) << title << " " << key;
    }
    EXPECT_EQ(count_of(text, "\n| `"), static_cast<int>(keys.size())) << "a key that no test knows: " << text;
  }
  EXPECT_EQ(outcome.out, file_text(fs::path(GCPDDA_SOURCE_DIR) / "run/scene_keys.md"))
      << "run 'gcpdda reference > run/scene_keys.md'";
}

} // namespace
} // namespace gcpdda::inspect_test
