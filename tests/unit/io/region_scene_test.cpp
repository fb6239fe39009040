// [region] and what lies in it: what is read, and what is refused with which words.

#include "geometry/polygon.hpp"
#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace gcpdda::region_scene_test {
namespace {

using testing::good;
using testing::messages;

const std::string head = R"([run]
duration = 2
[material.rock]
density = 2600
[material.clay]
density = 2000
[joint.default]
normal_stiffness = 1e9
[joint.bedding]
friction_angle_deg = 20
)";

const std::string region = R"([region]
polygon = [[0, 0], [0, 10], [20, 10], [20, 0]]
material = "rock"
)";

std::vector<std::string> faults(const std::string &text, const testing::Sets &sets = {}) {
  std::vector<std::string> result = messages(read_scene(text, "s.toml", sets));
  for (std::string &fault : result) {
    const std::string place = "s.toml:";
    fault = fault.starts_with(place) ? fault.substr(place.size()) : fault;
  }
  return result;
}

using Strings = std::vector<std::string>;

TEST(RegionScene, ReadsAllThatLiesInARegion) {
  const Scene scene = good(head + R"([region]
polygon = [[0, 0], [0, 10], [20, 10], [20, 0]]
material = "clay"
min_width = 0.1
slivers = "refuse"
fixed = ["right", "bottom"]
max_blocks = 1000
[[joint_set]]
name = "beds"
joint = "bedding"
dip_deg = 30
dip_scatter = {kind = "fisher", concentration = 100}
spacing = 2
spacing_scatter = {kind = "lognormal", deviation = 0.5}
trace_length = 5
trace_scatter = {kind = "exponential"}
gap = 1
stagger = 0.25
origin = [1, 2]
seed = 9
within = [[0, 0], [10, 0], [10, 10]]
[[fault]]
points = [[0, 1], [5, 6], [7, 7]]
[[joint_map]]
file = "maps/m.csv"
joint = "bedding"
[[opening]]
name = "tunnel"
shape = "d"
centre = [10, 5]
width = 4
height = 5
[[layer]]
polygon = [[0, 0], [20, 0], [20, 2], [0, 2]]
material = "rock"
[[voronoi]]
size = 2.5
[[bricks]]
block_size = [4, 2]
joint = "default"
[[monitor]]
block = "b12"
)");
  const RockRegion &r = scene.region;
  EXPECT_EQ(r.outline, (std::vector<Vec2>{{0, 0}, {20, 0}, {20, 10}, {0, 10}}));
  EXPECT_EQ(r.material, 1);
  EXPECT_EQ(r.min_width, 0.1);
  EXPECT_EQ(r.min_area, 0.1 * 0.1);
  EXPECT_EQ(r.slivers, SliverRule::refuse);
  EXPECT_EQ(r.fixed, (std::array<bool, 4>{true, false, true, false}));
  EXPECT_EQ(r.max_blocks, 1000);
  ASSERT_EQ(r.joint_sets.size(), 1U);
  const JointSet &set = r.joint_sets[0];
  EXPECT_EQ(set.joint, 1);
  EXPECT_DOUBLE_EQ(set.dip.mean, std::numbers::pi / 6.0);
  EXPECT_EQ(set.dip.spread, Spread::fisher);
  EXPECT_EQ(set.dip.width, 100.0);
  EXPECT_EQ(set.spacing.spread, Spread::lognormal);
  EXPECT_EQ(set.spacing.width, 0.5);
  EXPECT_FALSE(set.through_going);
  EXPECT_EQ(set.trace.spread, Spread::exponential);
  EXPECT_EQ(set.gap.mean, 1.0);
  EXPECT_EQ(set.stagger, 0.25);
  EXPECT_EQ(set.origin, (Vec2{1, 2}));
  EXPECT_EQ(set.seed, 9);
  EXPECT_EQ(set.within.size(), 3U);
  EXPECT_EQ(r.faults.at(0).points.size(), 3U);
  EXPECT_EQ(r.faults.at(0).joint, -1);
  EXPECT_EQ(r.maps.at(0).path, "folder/maps/m.csv");
  EXPECT_EQ(r.openings.at(0).name, "tunnel");
  EXPECT_FALSE(r.openings.at(0).excavated);
  EXPECT_EQ(r.layers.at(0).material, 0);
  EXPECT_EQ(r.voronoi.at(0).size, 2.5);
  EXPECT_EQ(r.bricks.at(0).joint, 0);
  EXPECT_EQ(r.bricks.at(0).bond, 0.5);
  EXPECT_EQ(scene.monitors.at(0).block, 12);
  const Scene again = good(scene.resolved);
  EXPECT_TRUE(std::filesystem::path(again.region.maps.at(0).path).is_absolute());
  EXPECT_EQ(again.region.joint_sets.at(0).within, set.within);
  EXPECT_EQ(again.region.openings.at(0).outline, r.openings.at(0).outline);
}

TEST(RegionScene, SlopesRiseBenchByBench) {
  const Scene scene = good(head + R"([region]
material = "rock"
[region.slope]
toe = [5, 1]
toe_length = 10
crest_length = 7
depth = 4
[[region.slope.bench]]
height = 6
face_angle_deg = 90
width = 3
[[region.slope.bench]]
height = 5
face_angle_deg = 45
)");
  const std::vector<Vec2> expected{{-5, -3}, {20, -3}, {20, 12}, {13, 12}, {8, 7}, {5, 7}, {5, 1}, {-5, 1}};
  ASSERT_EQ(scene.region.outline.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(norm(scene.region.outline[k] - expected[k]), 0.0, 1e-14);
  }
}

TEST(RegionScene, StagesExcavateOpeningsByName) {
  const std::string openings =
      "[[opening]]\nname = \"tunnel\"\nshape = \"circle\"\ncentre = [10, 5]\nwidth = 4\n"
      "[[opening]]\nname = \"shaft\"\nshape = \"circle\"\ncentre = [3, 5]\nwidth = 2\n";
  const auto stage = [](const std::string &names) {
    return "[[stage]]\nkind = \"run\"\nduration = 1.0\n[[stage]]\nkind = \"excavate\"\nopenings = " + names +
           "\n[[stage]]\nkind = \"run\"\nduration = 1.0\n";
  };
  const std::string without_duration =
      head.substr(0, head.find("duration")) + head.substr(head.find("[material"));
  const Scene scene = good(without_duration + region + openings + stage("[\"shaft\"]"));
  EXPECT_EQ(scene.stages.at(1).excavated.openings, std::vector<std::size_t>{1});
  const auto said = messages(read_scene(without_duration + region + openings + "excavated = true\n" +
                                            stage("[\"shaft\", \"tunel\"]"),
                                        "s.toml", {}));
  ASSERT_EQ(said.size(), 2U) << ::testing::PrintToString(said);
  EXPECT_NE(said[0].find("opening 'shaft' has no blocks"), std::string::npos) << said[0];
  EXPECT_NE(said[1].find("no opening is named 'tunel', did you mean 'tunnel'?"), std::string::npos)
      << said[1];
}

// Areas of the shapes in closed form, approached from inside by n chords as 1 - (2 pi/n)^2/6.
TEST(RegionScene, OpeningsHaveTheirShapes) {
  const auto area = [](const std::string &shape) {
    return signed_area(
        good(head + region + "[[opening]]\ncentre = [10, 5]\nwidth = 6\nchords = 1000\n" + shape)
            .region.openings.at(0)
            .outline);
  };
  constexpr double pi = std::numbers::pi;
  EXPECT_NEAR(area("shape = \"circle\""), 9.0 * pi, 9.0 * pi * 1e-5);
  EXPECT_NEAR(area("shape = \"d\"\nheight = 7"), 4.5 * pi + 6.0 * 4.0, 1e-3);
  // Below the spring line, walls of radius 6 about its ends: 2 (int_0^3 sqrt(36 - y^2) dy - 9).
  const double walls = 2.0 * (0.5 * (3.0 * std::sqrt(27.0) + 36.0 * std::asin(0.5)) - 9.0);
  EXPECT_NEAR(area("shape = \"horseshoe\""), 4.5 * pi + walls, 1e-3);
}

TEST(RegionScene, SetReachesJointSetsByName) {
  const std::string text = head + region + "[[joint_set]]\nname = \"beds\"\ndip_deg = 10\nspacing = 3\n";
  EXPECT_EQ(good(text, {"joint_set.beds.spacing=2"}).region.joint_sets.at(0).spacing.mean, 2.0);
}

// tan(60) cos(60) = tan(40.893395), and the part of the pole in the section is sqrt(3/16 + 1/4) = 0.661438.
TEST(RegionScene, SetsInSpaceBecomeTheirTraces) {
  const std::string text = head + region + "azimuth = 90\n[[joint_set]]\nname = \"beds\"\ndip = 60\n" +
                           "dip_direction = 150\nfisher_k = 300\n";
  const JointSet set = good(text + "spacing = 2\nspacing_scatter = {kind = \"normal\", deviation = 0.5}\n")
                           .region.joint_sets.at(0);
  constexpr double share = 0.66143782776614764;
  EXPECT_NEAR(set.dip.mean, -40.893394649 * std::numbers::pi / 180.0, 1e-10);
  EXPECT_NEAR(set.spacing.mean, 2.0 / share, 1e-13);
  EXPECT_NEAR(set.spacing.width, 0.5 / share, 1e-13);
  ASSERT_TRUE(set.plane);
  EXPECT_EQ(set.plane->fisher, 300.0);
  EXPECT_NEAR(set.plane->spacing, 2.0, 1e-14);
  EXPECT_TRUE(set.is_turned());
  // Its intensity is that of the section.
  const JointSet dense = good(text + "p21 = 0.5\n").region.joint_sets.at(0);
  EXPECT_NEAR(dense.spacing.mean, 2.0, 1e-14);
  EXPECT_NEAR(dense.plane->spacing, 2.0 * share, 1e-13);
}

TEST(RegionScene, IntensityGivesTheSpacingWithPersistence) {
  const std::string text = head + region + "[[joint_set]]\ndip_deg = 10\np21 = 0.5\n";
  EXPECT_EQ(good(text).region.joint_sets.at(0).spacing.mean, 2.0);
  EXPECT_EQ(good(text + "trace_length = 6\ngap = 2\n").region.joint_sets.at(0).spacing.mean, 1.5);
  // From 1 to 4 m with the exponent 2: mean ln(4)/(1 - 1/4).
  const JointSet set =
      good(text + "trace_scatter = {kind = \"power-law\", exponent = 2, min = 1, max = 4}\ngap = 2\n")
          .region.joint_sets.at(0);
  EXPECT_EQ(set.trace.spread, Spread::power_law);
  EXPECT_NEAR(set.trace.mean, std::log(4.0) / 0.75, 1e-14);
  EXPECT_NEAR(set.spacing.mean, set.trace.mean / (set.trace.mean + 2.0) / 0.5, 1e-14);
}

TEST(RegionScene, FaultsOfDirectionsAndIntensitiesAreNamed) {
  EXPECT_EQ(
      faults(head + region + "[[joint_set]]\nspacing = 1\n[[joint_set]]\ndip_deg = 10\n"),
      (Strings{"14:1: error: joint_set 'joint_set0' gives neither dip_deg nor dip and dip_direction, the "
               "joints need a direction, for example dip_deg = -35.0",
               "16:1: error: joint_set 'joint_set1' gives neither spacing nor p21, exactly one of them "
               "says how many joints there are, for example spacing = 2.0"}));
  EXPECT_EQ(
      faults(head + region + "[[joint_set]]\ndip_deg = 10\ndip = 20\nfisher_k = 9\nspacing = 1\np21 = 1\n"),
      (Strings{
          "14:1: error: 'dip_direction' in joint_set 'joint_set0' is missing, a plane in space has dip and "
          "dip_direction, for example dip_direction = 120.0, or dip_deg alone for the angle in the section",
          "14:1: error: 'azimuth' in [region] is missing for joint_set 'joint_set0', the trace of a plane "
          "depends on the direction of the x axis, for example azimuth = 90.0 for a section from west to "
          "east",
          "16:7: error: joint_set 'joint_set0' gives both dip_deg and dip or dip_direction, the angle in the "
          "section follows from dip, dip_direction and region.azimuth, leave dip_deg out, or the other two",
          "19:7: error: joint_set 'joint_set0' gives both spacing and p21, exactly one of them says how many "
          "joints there are, leave one of them out"}));
  EXPECT_EQ(
      faults(head + region + "azimuth = 90\n[[joint_set]]\ndip = 90\ndip_direction = 0\nspacing = 1\n"),
      (Strings{"17:17: error: joint_set 'joint_set0' is parallel to the section, planes that dip by 90 "
               "degrees towards 0 meet a section towards 90 nowhere, or at less than 1 degree, leave the "
               "set out, or choose another azimuth"}));
  EXPECT_EQ(
      faults(head + region +
             "azimuth = 90\n[[joint_set]]\ndip = 9\ndip_direction = 0\nspacing = 1\ndip_scatter = {kind = "
             "\"fisher\", concentration = 9}\n[[joint_set]]\ndip_deg = 0\nfisher_k = 9\nspacing = 1\n"),
      (Strings{
          "19:15: error: 'dip_scatter' in joint_set 'joint_set0' has no meaning with dip and dip_direction, "
          "planes in space scatter in all directions, give fisher_k instead, for example fisher_k = 200",
          "22:12: error: 'fisher_k' in joint_set 'joint_set1' has no meaning, it scatters planes in space, "
          "which dip and dip_direction give, give these, or dip_scatter = {kind = \"fisher\", "
          "concentration = 200}"}));
  EXPECT_EQ(
      faults(head + region +
             "[[joint_set]]\ndip_deg = 10\nspacing = 1\ngap = 1\ntrace_length = 3\ntrace_scatter = {kind = "
             "\"power-law\", exponent = 2, min = 4, max = 4}\n"),
      (Strings{
          "18:16: error: 'trace_length' in joint_set 'joint_set0' has no meaning with a power law, the mean "
          "follows from its exponent, min and max, leave it out",
          "19:67: error: 'max' in trace_scatter of joint_set 'joint_set0' is not above min, lengths lie "
          "between min and max, exchange them"}));
}

TEST(RegionScene, KindsOfScatterOfAnglesAreThoseThatAreRead) {
  const auto with = [](const std::string &scatter) {
    return head + region + "[[joint_set]]\ndip_deg = 10\nspacing = 1\ndip_scatter = {" + scatter + "}\n";
  };
  const auto spread = [&](const std::string &scatter) {
    return good(with(scatter)).region.joint_sets.at(0).dip.spread;
  };
  EXPECT_EQ(spread("kind = \"none\""), Spread::none);
  EXPECT_EQ(spread("kind = \"normal\", deviation_deg = 5"), Spread::normal);
  EXPECT_EQ(spread("kind = \"fisher\", concentration = 200"), Spread::fisher);
  const std::vector<std::pair<std::string, std::string>> others{
      {"lognormal", "did you mean 'normal'?"},
      {"exponential", "for example kind = \"normal\""},
      {"power-law", "for example kind = \"normal\""}};
  for (const auto &[kind, hint] : others) {
    EXPECT_EQ(faults(with("kind = \"" + kind + "\"")),
              (Strings{"17:23: error: 'kind' in dip_scatter of joint_set 'joint_set0' is '" + kind +
                       "', it must be one of none normal fisher, " + hint}));
  }
}

// A wrong coordinate makes a wide box of a small region.
TEST(RegionScene, SizeIsJudgedByExtentAndSpacing) {
  const std::string needle = "[region]\nmaterial = \"rock\"\npolygon = [[0, 0], [1, 0], [1e6, 1e6]]\n";
  EXPECT_EQ(
      faults(head + needle + "max_blocks = 3000\n[[joint_set]]\ndip_deg = 135\nspacing = 2.0\n"),
      (Strings{"11:1: error: the region would be cut into about 7.07e+05 blocks, max_blocks is 3000, use "
               "larger spacings, or raise max_blocks"}));
  EXPECT_EQ(
      faults(head + needle + "[[voronoi]]\nsize = 10\n"),
      (Strings{"11:1: error: the Voronoi pattern would have about 1e+10 cells, a set has at most 1e+08 in "
               "the bounding box of the region, use a larger size, or look for a vertex with a wrong "
               "coordinate"}));
  EXPECT_EQ(
      faults(head + needle + "[[joint_set]]\ndip_deg = 135\nspacing = 1\ntrace_length = 1\ngap = 1\n"),
      (Strings{"11:1: error: joint_set 'joint_set0' would have about 1e+12 joints, a set has at most 1e+08 "
               "in the bounding box of the region, use a larger spacing or longer traces, or look for a "
               "vertex with a wrong coordinate"}));
}

TEST(RegionScene, DeformsOnlyWithAnElasticMaterial) {
  const std::string layer = "[[layer]]\nmaterial = \"clay\"\npolygon = [[0, 0], [0, 1], [20, 1], [20, 0]]\n";
  EXPECT_EQ(
      faults(head + region + layer, {"run.fidelity=deformable"}),
      (Strings{
          "13:12: error: [region] is deformable but its material 'rock' has neither youngs_modulus "
          "nor poissons_ratio, a deformable block has its stiffness from both, for example "
          "youngs_modulus = 40e9 and poissons_ratio = 0.25 in [material.rock]",
          "15:12: error: layer 'layer0' is deformable but its material 'clay' has neither youngs_modulus "
          "nor poissons_ratio, a deformable block has its stiffness from both, for example "
          "youngs_modulus = 40e9 and poissons_ratio = 0.25 in [material.clay]"}));
  EXPECT_EQ(faults(head + region + layer, {"run.fidelity=rigid"}), Strings{});
}

TEST(RegionScene, FaultsAreNamedWithTheirPlaces) {
  EXPECT_EQ(
      faults(head + "[region]\npolygon = [[0, 0], [1, 1], [1, 0], [0, 1]]\nmaterial = \"rock\"\n"),
      (Strings{"12:11: error: 'polygon' in [region] crosses itself, two of its edges meet away from a common "
               "vertex, list the vertices in order around the polygon"}));
  EXPECT_EQ(
      faults(head + region +
             "[[joint_set]]\nname = \"beds\"\njoint = \"beding\"\ndip_deg = 10\nspacing = 0\n"),
      (Strings{"16:9: error: no joint is named 'beding', did you mean 'bedding'?",
               "18:11: error: 'spacing' in joint_set 'beds' is 0, it must be above 0 and at most 1e+09, for "
               "example spacing = 2.0"}));
  EXPECT_EQ(
      faults(
          head + region +
          "[[joint_set]]\ndip_deg = 10\nspacing = 0.0001\n[[joint_set]]\ndip_deg = 90\nspacing = 0.0001\n"),
      (Strings{"11:1: error: the region would be cut into about 1.97e+10 blocks, max_blocks is 2000000, use "
               "larger spacings, or raise max_blocks"}));
  EXPECT_EQ(
      faults(head + region +
             "[[joint_set]]\ndip_deg = 10\nspacing = 1\ntrace_length = 5\nspacing_scatter = {kind = "
             "\"normal\"}\n"),
      (Strings{
          "14:1: error: 'gap' in joint_set 'joint_set0' is missing, joints that end have a length and gaps "
          "between them, for example gap = 5.0, or leave both out",
          "18:19: error: 'deviation' in spacing_scatter of joint_set 'joint_set0' is missing, this kind of "
          "scatter needs it, for example deviation = 0.5"}));
  EXPECT_EQ(
      faults(head + "[[block]]\nmaterial = \"rock\"\nvertices = [[0, 0], [1, 0], [0, 1]]\n[[fault]]\npoints "
                    "= [[0, 0], [1, 1]]\njoint = \"bedding\"\n"),
      (Strings{
          "9:1: error: 'materials' in [joint.bedding] is missing, a law other than default is for one pair "
          "of "
          "materials, or for edges that name it, for example materials = [\"granite\", \"clay\"]",
          "14:1: error: fault 'fault0' has nothing to lie in, the scene has no region, write [region]"}));
  EXPECT_EQ(
      faults(head + region +
             "[[opening]]\nshape = \"horseshoe\"\ncentre = [10, 5]\nwidth = 4\nheight = 6\n[[fault]]\njoint "
             "= \"bedding\"\npoints = [[1, 1]]\n"),
      (Strings{
          "18:10: error: opening 'opening0' is 6 m high and 4 m wide, its walls do not meet roof and floor, "
          "use a height between 2 and 5.4641 m",
          "21:10: error: 'points' in fault 'fault0' has one point, a line has at least two, add its other "
          "end"}));
  EXPECT_EQ(
      faults(head + "[region]\nmaterial = \"rock\"\nfixed = [\"botom\"]\n"),
      (Strings{
          "11:1: error: [region] gives neither polygon nor slope, its outline is one of them, for example "
          "polygon = [[0, 0], [20, 0], [20, 10], [0, 10]]",
          "13:10: error: entry 0 of 'fixed' in [region] is 'botom', it must be one of bottom left right "
          "top, did you mean 'bottom'?"}));
}

} // namespace
} // namespace gcpdda::region_scene_test
