// Values that no rock has: each key, each unit that is mistaken for the right one, and no alarm for sound
// scenes.

#include "simulation/plausibility.hpp"

#include "simulation/plausible_ranges.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace gcpdda::testing::plausible_values_test {
namespace {

/// All quantities, plausible.
const std::string sound = R"([run]
duration = 2.0
gravity = [0.0, -9.81]
rayleigh = { ratio = 0.02, frequency = 2.0 }
[material.rock]
density = 2600.0
youngs_modulus = 40e9
poissons_ratio = 0.25
[material.clay]
density = 1900.0
[joint.default]
normal_stiffness = 5e9
friction_angle_deg = 35.0
cohesion = 2e5
tension = 1e5
residual_friction_angle_deg = 30.0
residual_cohesion = 1e4
dilation_angle_deg = 0.4
dilation_limit = 0.01
[joint.rough]
materials = ["clay", "rock"]
law = "barton-bandis"
jrc = 8.0
jcs = 50e6
residual_friction_angle_deg = 28.0
[joint.soft]
materials = ["clay", "clay"]
allowed_overlap = 1e-3
[joint.mass]
rock_mass_modulus = 10e9
intact_modulus = 40e9
spacing = 1.0
[[block]]
name = "ram"
material = "clay"
vertices = [[100, 0], [101, 0], [101, 1], [100, 1]]
prescribed_velocity = [1.0, 0.0, 0.5]
[[wall]]
name = "east"
material = "rock"
origin = [200, 0]
rows = 2
columns = 2
block_size = [0.5, 0.25]
[[pyramid]]
name = "tomb"
material = "rock"
origin = [300, 0]
rows = 2
block_size = [0.5, 0.25]
[region]
material = "rock"
polygon = [[0, 0], [40, 0], [40, 30], [0, 30]]
fixed = ["bottom"]
[[joint_set]]
name = "bedding"
dip_deg = 10
spacing = 2.0
trace_length = 10.0
gap = 5.0
[[joint_set]]
name = "cross"
dip_deg = 100
p21 = 0.1
[[fault]]
name = "f1"
points = [[0, 2], [39, 20]]
[[opening]]
name = "tunnel"
shape = "circle"
centre = [20, 15]
width = 8.0
[[layer]]
material = "clay"
polygon = [[0, 0], [40, 0], [40, 3], [0, 3]]
[[voronoi]]
size = 1.0
[[bricks]]
block_size = [0.4, 0.2]
[water.sea]
phreatic = [[0, 5], [40, 6]]
density = 1025.0
[in_situ]
vertical_stress = 2.6e6
k0 = 0.7
level = 30.0
density = 2500.0
[earthquake]
viscous = ["left"]
p_wave_speed = 3000.0
s_wave_speed = 1700.0
[support.bolt]
kind = "grouted"
axial_stiffness = 5e7
axial_yield = 2.5e5
shear_stiffness = 2e7
shear_yield = 1e5
rupture_strain = 0.1
pretension = 1e5
active_length = 0.3
bond_strength = 3e5
spacing = 1.5
[support.cable]
kind = "anchored"
axial_rigidity = 1e8
[support.shell]
kind = "liner"
thickness = 0.1
youngs_modulus = 2e10
compressive_strength = 3e7
tensile_strength = 2e6
residual_tensile_strength = 1e6
shear_strength = 2e6
adhesion = 5e5
bond_width = 0.03
[support.plain]
kind = "liner"
thickness = 0.1
youngs_modulus = 2e10
tensile_strength = 2e6
[[bolt]]
name = "one"
support = "cable"
from = [20, 19]
to = [20, 25]
[output]
interval = 0.02
history_interval = 0.02
checkpoint_interval = 0.5
)";

std::vector<std::string> doubts_of(const Scene &scene) {
  std::vector<std::string> texts;
  for (const Diagnostic &doubt : implausible_values(scene)) {
    EXPECT_EQ(doubt.severity, Severity::warning);
    texts.push_back(to_string(doubt));
  }
  return texts;
}

TEST(PlausibleValues, OfASoundSceneGiveNoAlarm) {
  EXPECT_EQ(doubts_of(scene_of(sound)), std::vector<std::string>{});
}

struct Slip {
  std::string set;  ///< with the value in the wrong unit
  std::string what; ///< what the warning begins with, behind the place
  std::string hint; ///< what it ends with
};

// Every row of the table is here, most with each of its units.
const std::vector<Slip> slips{
    {"run.gravity=[0,-9810]", "run.gravity is 9810 m/s2", "if it is in mm/s2, write 9.81"},
    {"run.gravity=[0,-0.00981]", "run.gravity is 0.00981 m/s2", "if it is in km/s2, write 9.81"},
    {"run.rayleigh.ratio=2", "run.rayleigh.ratio is 2", "if it is in per cent, write 0.02"},
    {"material.rock.density=27", "material.rock.density is 27 kg/m3", "if it is in kN/m3, write 2752"},
    {"material.rock.density=2.7", "material.rock.density is 2.7 kg/m3", "if it is in t/m3, write 2700"},
    {"material.rock.density=26500", "material.rock.density is 26500 kg/m3", "if it is in N/m3, write 2701"},
    {"material.rock.density=2.7e6", "material.rock.density is 2.7e+06 kg/m3", "if it is in g/m3, write 2700"},
    {"material.rock.youngs_modulus=25", "material.rock.youngs_modulus is 25 Pa",
     "if it is in GPa, write 2.5e+10; if it is in MPa, write 2.5e+07"},
    {"material.rock.youngs_modulus=210000", "material.rock.youngs_modulus is 210000 Pa",
     "if it is in MPa, write 2.1e+11"},
    {"joint.default.normal_stiffness=1e3", "joint.default.normal_stiffness is 1000 Pa/m",
     "if it is in MPa/m, write 1e+09; if it is in GPa/m, write 1e+12"},
    {"joint.default.normal_stiffness=20", "joint.default.normal_stiffness is 20 Pa/m",
     "if it is in GPa/m, write 2e+10; if it is in MPa/m, write 2e+07"},
    {"joint.soft.allowed_overlap=0.1", "joint.soft.allowed_overlap is 0.1",
     "if it is in per cent, write 0.001"},
    {"joint_set.cross.p21=0.001", "joint_set.cross.p21 is 0.001 m/m2", ""},
    {"joint.mass.rock_mass_modulus=10", "joint.mass.rock_mass_modulus is 10 Pa",
     "if it is in GPa, write 1e+10; if it is in MPa, write 1e+07"},
    {"joint.mass.intact_modulus=4e12", "joint.mass.intact_modulus is 4e+12 Pa", ""},
    {"joint.mass.spacing=800", "joint.mass.spacing is 800 m",
     "if it is in mm, write 0.8; if it is in cm, write 8"},
    {"joint.default.tangential_ratio=500", "joint.default.tangential_ratio is 500",
     "check its unit; gcpdda reference --values has the range and its source"},
    {"joint.default.residual_friction_angle_deg=0.5",
     "joint.default.residual_friction_angle_deg is 0.5 degrees",
     "if it is in radians, write 28.65; if it is the coefficient, write 26.6"},
    {"joint.rough.residual_friction_angle_deg=0.5", "joint.rough.residual_friction_angle_deg is 0.5 degrees",
     "if it is in radians, write 28.65; if it is the coefficient, write 26.6"},
    {"joint.default.dilation_angle_deg=0.1", "joint.default.dilation_angle_deg is 0.1 degrees",
     "if it is in radians, write 5.73"},
    {"joint.default.dilation_limit=10", "joint.default.dilation_limit is 10 m",
     "if it is in mm, write 0.01; if it is in cm, write 0.1"},
    {"joint.default.residual_cohesion=100", "joint.default.residual_cohesion is 100 Pa",
     "if it is in kPa, write 1e+05; if it is in MPa, write 1e+08"},
    {"joint.default.tension=0.3", "joint.default.tension is 0.3 Pa", "if it is in MPa, write 3e+05"},
    {"joint.rough.jrc=30", "joint.rough.jrc is 30",
     "check its unit; gcpdda reference --values has the range and its source"},
    {"joint.rough.jcs=50", "joint.rough.jcs is 50 Pa", "if it is in MPa, write 5e+07"},
    {"joint.rough.jcs=50e3", "joint.rough.jcs is 50000 Pa", "if it is in kPa, write 5e+07"},
    {"block.ram.prescribed_velocity=[2000,0,0]", "block.ram: velocity is 2000 m/s",
     "if it is in mm/s, write 2; if it is in cm/s, write 20"},
    {"block.ram.prescribed_velocity=[0,0,-360]", "block.ram: spin is -360 rad/s",
     "if it is in degrees/s, write 6.283"},
    {"wall.east.block_size=[400,200]", "wall.east.block_size is 400 m",
     "if it is in mm, write 0.4; if it is in cm, write 4"},
    {"pyramid.tomb.block_size=[400,300]", "pyramid.tomb.block_size is 400 m (and 1 more like it)",
     "if it is in mm, write 0.4; if it is in cm, write 4"},
    {"joint_set.bedding.spacing=2000", "joint_set.bedding.spacing is 2000 m",
     "if it is in mm, write 2; if it is in cm, write 20"},
    {"joint_set.bedding.trace_length=10000", "joint_set.bedding.trace_length is 10000 m",
     "if it is in mm, write 10; if it is in cm, write 100"},
    {"joint_set.bedding.gap=8000", "joint_set.bedding.gap is 8000 m",
     "if it is in mm, write 8; if it is in cm, write 80"},
    {"opening.tunnel.width=8000", "opening.tunnel: width is 8000 m",
     "if it is in mm, write 8; if it is in cm, write 80"},
    {"voronoi=[{size=500}]", "voronoi.size is 500 m", "if it is in mm, write 0.5; if it is in cm, write 5"},
    {"bricks=[{block_size=[400,100]}]", "bricks.block_size is 400 m",
     "if it is in mm, write 0.4; if it is in cm, write 4"},
    {"water.sea.density=9.81", "water.sea.density is 9.81 kg/m3", "if it is in kN/m3, write 1000"},
    {"water.sea.density=1.025", "water.sea.density is 1.025 kg/m3", "if it is in t/m3, write 1025"},
    {"in_situ.vertical_stress=2.6", "in_situ.vertical_stress is 2.6 Pa", "if it is in MPa, write 2.6e+06"},
    {"in_situ.vertical_stress=2600", "in_situ.vertical_stress is 2600 Pa", "if it is in kPa, write 2.6e+06"},
    {"in_situ.k0=70", "in_situ.k0 is 70", "if it is in per cent, write 0.7"},
    {"in_situ.density=25", "in_situ.density is 25 kg/m3", "if it is in kN/m3, write 2548"},
    {"earthquake.p_wave_speed=3", "earthquake.p_wave_speed is 3 m/s", "if it is in km/s, write 3000"},
    {"earthquake.s_wave_speed=1.7", "earthquake.s_wave_speed is 1.7 m/s", "if it is in km/s, write 1700"},
    {"support.bolt.axial_stiffness=5e4", "support.bolt.axial_stiffness is 50000 N/m",
     "if it is in kN/m, write 5e+07; if it is in MN/m, write 5e+10"},
    {"support.cable.axial_rigidity=1e5", "support.cable.axial_rigidity is 100000 N",
     "if it is in kN, write 1e+08; if it is in MN, write 1e+11"},
    {"support.bolt.shear_stiffness=20", "support.bolt.shear_stiffness is 20 N/m",
     "if it is in MN/m, write 2e+07; if it is in kN/m, write 2e+04"},
    {"support.bolt.shear_yield=100", "support.bolt.shear_yield is 100 N",
     "if it is in kN, write 1e+05; if it is in MN, write 1e+08"},
    {"support.bolt.rupture_strain=0.9", "support.bolt.rupture_strain is 0.9",
     "if it is in per cent, write 0.009"},
    {"support.bolt.pretension=100", "support.bolt.pretension is 100 N",
     "if it is in kN, write 1e+05; if it is in MN, write 1e+08"},
    {"support.bolt.active_length=300", "support.bolt.active_length is 300 m",
     "if it is in mm, write 0.3; if it is in cm, write 3"},
    {"support.bolt.bond_strength=300", "support.bolt.bond_strength is 300 N/m",
     "if it is in kN/m, write 3e+05"},
    {"support.bolt.spacing=1500", "support.bolt.spacing is 1500 m",
     "if it is in mm, write 1.5; if it is in cm, write 15"},
    {"support.shell.thickness=100", "support.shell.thickness is 100 m",
     "if it is in mm, write 0.1; if it is in cm, write 1"},
    {"support.shell.youngs_modulus=20", "support.shell.youngs_modulus is 20 Pa",
     "if it is in GPa, write 2e+10"},
    {"support.shell.compressive_strength=30", "support.shell.compressive_strength is 30 Pa",
     "if it is in MPa, write 3e+07"},
    {"support.plain.tensile_strength=2000", "support.plain.tensile_strength is 2000 Pa",
     "if it is in kPa, write 2e+06"},
    {"support.shell.residual_tensile_strength=1000", "support.shell.residual_tensile_strength is 1000 Pa",
     "if it is in kPa, write 1e+06"},
    {"support.shell.shear_strength=2", "support.shell.shear_strength is 2 Pa",
     "if it is in MPa, write 2e+06"},
    {"support.shell.adhesion=0.5", "support.shell.adhesion is 0.5 Pa", "if it is in MPa, write 5e+05"},
    {"support.shell.bond_width=30", "support.shell.bond_width is 30 m",
     "if it is in mm, write 0.03; if it is in cm, write 0.3"},
    {"bolt.one.to=[20,6019]", "bolt.one: length is 6000 m",
     "if it is in mm, write 6; if it is in cm, write 60"},
    {"output.interval=4", "output.interval is 4 s, and the run takes 2 s", "use at most 2"},
    {"output.history_interval=4", "output.history_interval is 4 s, and the run takes 2 s", "use at most 2"},
    {"output.checkpoint_interval=4", "output.checkpoint_interval is 4 s, and the run takes 2 s",
     "use at most 2"},
    {"fault.f1.points=[[2000,2000],[39000,20000]]", "fault.f1 lies from [2000, 2000] to [39000, 20000]",
     "check its coordinates and their unit, m"},
};

// The value written in the wrong unit is told once, with the place and with the right one.
TEST(PlausibleValues, AreToldWithWhatWasMeant) {
  for (const Slip &slip : slips) {
    const std::vector<std::string> texts = doubts_of(scene_of(sound, {slip.set}));
    int told = 0;
    for (const std::string &text : texts) {
      told += text.find("warning: " + slip.what) != std::string::npos && text.ends_with(slip.hint) ? 1 : 0;
    }
    EXPECT_EQ(told, 1) << slip.set << ": " << fmt::format("{}", fmt::join(texts, "\n"));
  }
}

// Each of these needs another scene than the rest.
TEST(PlausibleValues, OfKeysThatExcludeOthers) {
  const auto one = [](const std::string &text, const std::string &what) {
    const std::vector<std::string> texts = doubts_of(scene_of(text));
    ASSERT_EQ(texts.size(), 1U) << what;
    EXPECT_NE(texts[0].find("warning: " + what), std::string::npos) << texts[0];
  };
  const std::string blocks = "[[block]]\nname = \"a\"\nmaterial = \"rock\"\nvertices = [[0,0],[1,0],[1,1]]\n";
  const std::string head = "[run]\nduration = 1\n[material.rock]\ndensity = 2600\n";
  one("[run]\nduration = 1\ncontact_damping = 5\n[material.rock]\ndensity = "
      "2600\n[joint.default]\nnormal_stiffness = "
      "1e9\n" +
          blocks,
      "run.contact_damping is 5");
  one(head + "[joint.default]\nnormal_stiffness = 1e9\ncohesion = 100\n" + blocks,
      "joint.default.cohesion is 100 Pa");
  one(head + "[joint.default]\nnormal_stiffness = 1e9\nfriction_angle_deg = 0.61\n" + blocks,
      "joint.default.friction_angle_deg is 0.61 degrees");
  one(head +
          "[support.s]\nkind = \"anchored\"\naxial_stiffness = 5e7\naxial_yield = 250\n[joint.default]\n"
          "normal_stiffness = 1e9\n" +
          blocks,
      "support.s.axial_yield is 250 N");
  one("[run]\nduration = 1\ngravity = [0, 9.81]\n[material.rock]\ndensity = 2600\n[joint.default]\n"
      "normal_stiffness = 1e9\n" +
          blocks,
      "run.gravity is [0, 9.81]: it points upwards, y is up, if the rock is to fall, write [0, -9.81]");
  one(head + "[joint.default]\nnormal_stiffness = 1e9\n[region]\nmaterial = \"rock\"\n"
             "polygon = [[0,0],[40000,0],[40000,30000],[0,30000]]\n",
      "region: the root of its area is 34641 m, the root of the area of a sample or a mountain side is 0.02 "
      "to 10000 m, if "
      "it is in mm, write 34.64");
  one(head + "[in_situ]\nprincipal_stresses = [4, 2]\n[joint.default]\nnormal_stiffness = 1e9\n" + blocks,
      "in_situ.principal_stresses is 4 Pa");
}

// A row without a test of its own would be found here.
TEST(PlausibleValues, OfEveryRowAreTried) {
  const std::set<std::string> elsewhere{"earthquake.record.acceleration",
                                        "earthquake.record.velocity",
                                        "run.contact_damping",
                                        "joint.*.cohesion",
                                        "joint.*.friction_angle_deg",
                                        "support.*.axial_yield",
                                        "block.*.size",
                                        "region.size"};
  for (const PlausibleRange &row : plausible_ranges()) {
    EXPECT_LT(row.low, row.high) << row.key;
    EXPECT_TRUE(row.typical >= row.low && row.typical <= row.high) << row.key;
    EXPECT_FALSE(row.source.empty()) << row.key;
    for (const UnitSlip &slip : row.slips) {
      EXPECT_GT(slip.factor, 0.0) << row.key;
    }
    const std::string key(row.key);
    const std::string last = key.substr(key.rfind('.') + 1);
    const bool tried = std::any_of(slips.begin(), slips.end(), [&](const Slip &slip) {
      return slip.set.find(key.substr(0, key.find('.'))) == 0 &&
             (slip.what.find(last) != std::string::npos || last == "size" || last == "stress" ||
              last == "length");
    });
    EXPECT_TRUE(tried || elsewhere.contains(key)) << row.key;
  }
}

TEST(PlausibleValues, HaveTheirPlaceInTheFile) {
  const std::string wrong =
      "[run]\nduration = 1\n[material.rock]\ndensity = 27\n[joint.default]\nnormal_stiffness = 1e9\n"
      "[[block]]\nmaterial = \"rock\"\nvertices = [[0,0],[1,0],[1,1]]\n";
  const std::vector<std::string> texts = doubts_of(scene_of(wrong));
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_EQ(texts[0], "test.toml:4:11: warning: material.rock.density is 27 kg/m3, timber, soil, masonry, "
                      "concrete, rock, ore, "
                      "steel and lead have 300 to 12000 kg/m3, if it is in kN/m3, write 2752");
}

// Where a stage sets it, and once though the later stages have it too.
TEST(PlausibleValues, OfStagesAreTold) {
  const std::string staged =
      "[run]\n[material.rock]\ndensity = 2700\n[joint.default]\nnormal_stiffness = 1e9\nfriction_angle_deg = "
      "30\n"
      "[[block]]\nmaterial = \"rock\"\nvertices = [[0,0],[1,0],[1,1]]\n"
      "[[stage]]\nkind = \"run\"\nduration = 1\n"
      "[[stage]]\nkind = \"run\"\nduration = 1\nset = {\"joint.default.friction_angle_deg\" = 0.4}\n"
      "[[stage]]\nkind = \"run\"\nduration = 1\nset = {\"run.gravity\" = [0, -9]}\n[output]\ninterval = "
      "0.1\n";
  const std::vector<std::string> texts = doubts_of(scene_of(staged));
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_TRUE(texts[0].starts_with("test.toml:16:")) << texts[0];
}

TEST(PlausibleValues, OfNormalisedUnitsAreNotJudged) {
  const std::string unit = R"([run]
duration = 1
gravity = [0, -1]
[material.m]
density = 1
youngs_modulus = 100
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 100
cohesion = 0.5
friction_angle_deg = 30
[[block]]
material = "m"
vertices = [[0,0],[1,0],[1,1]]
)";
  EXPECT_EQ(doubts_of(scene_of(unit)), std::vector<std::string>{});
  EXPECT_EQ(doubts_of(scene_of(unit, {"run.gravity=[0,0]"})), std::vector<std::string>{});
  EXPECT_EQ(doubts_of(scene_of(unit, {"joint.default.friction_angle_deg=0.5"})).size(), 1U);
}

// The same fault of many blocks is one line.
// A law takes what it does not give from the default one.
TEST(PlausibleValues, OfRollersThatAreRough) {
  const auto told = [](const std::string &roller) {
    return doubts_of(scene_of(
        "[run]\nduration = 1.0\n[material.rock]\ndensity = 2600\n[joint.default]\n"
        "normal_stiffness = 1e9\nfriction_angle_deg = 40\n" +
        roller +
        "[region]\nmaterial = \"rock\"\npolygon = [[0, 0], [9, 0], [9, 9], [0, 9]]\nroller = [\"left\"]\n"));
  };
  const std::vector<std::string> rough = told("[joint.roller]\nnormal_stiffness = 5e9\n");
  ASSERT_EQ(rough.size(), 1U);
  EXPECT_NE(rough[0].find("takes a friction angle of 40 degrees and a cohesion of 0 Pa"), std::string::npos);
  EXPECT_EQ(told(""), std::vector<std::string>{});
  EXPECT_EQ(told("[joint.roller]\nnormal_stiffness = 5e9\nfriction_angle_deg = 5\n"),
            std::vector<std::string>{});
}

TEST(PlausibleValues, OfManyBlocksAreOneLine) {
  std::string scene =
      "[run]\nduration = 1\n[material.rock]\ndensity = 2700\n[joint.default]\nnormal_stiffness = 1e9\n";
  for (int k = 0; k < 100; ++k) {
    scene += block_toml(fmt::format("b.{}", k), rectangle({2.0 * k, 0.0}, {2.0 * k + 1.0, 1.0}),
                        "velocity = [5000.0, 0, 0]");
  }
  const std::vector<std::string> texts = doubts_of(scene_of(scene));
  ASSERT_EQ(texts.size(), 1U);
  EXPECT_NE(texts[0].find("block.b.0: velocity is 5000 m/s (and 99 more like it)"), std::string::npos)
      << texts[0];
}

// A program that fills a Scene gives all its values.
TEST(PlausibleValues, OfASceneMadeInCode) {
  Scene scene;
  scene.run.duration = 1.0;
  scene.output.interval = 10.0;
  scene.materials = {{"rock", 27.0, 25.0, 0.2}};
  scene.joints.laws.resize(1);
  scene.joints.laws[0].name = "default";
  scene.joints.laws[0].normal_stiffness = 1e9;
  scene.joints.laws[0].tan_friction = std::tan(0.01);
  const std::vector<std::string> texts = doubts_of(scene);
  ASSERT_EQ(texts.size(), 4U) << fmt::format("{}", fmt::join(texts, "\n"));
  for (const char *what : {"joint.default.friction_angle_deg is", "material.rock.density is 27 kg/m3",
                           "material.rock.youngs_modulus is 25 Pa", "output.interval is 10 s"}) {
    EXPECT_EQ(std::count_if(
                  texts.begin(), texts.end(),
                  [&](const std::string &text) { return text.starts_with(std::string("warning: ") + what); }),
              1)
        << what;
  }
}

TEST(PlausibleValues, OfRecords) {
  Scene scene;
  scene.run.duration = 10.0;
  Earthquake &earthquake = scene.earthquake;
  earthquake.file = "record.csv";
  earthquake.quantity = RecordQuantity::acceleration;
  const auto hint_of_peak = [&](double peak) {
    earthquake.record = {{0.0, {}}, {1.0, {peak, 0.0}}};
    const Diagnostics doubts = implausible_values(scene);
    return doubts.empty() ? std::string() : doubts[0].hint;
  };
  EXPECT_EQ(hint_of_peak(0.35),
            "if the record is in g, set earthquake.scale = 9.81; if it is in m/s2, write scale = 1.0");
  EXPECT_EQ(hint_of_peak(350.0), "if the record is in cm, set earthquake.scale = 0.01; in mm, 0.001");
  EXPECT_EQ(hint_of_peak(3.5), "");
  scene.places["earthquake.scale"] = {"s.toml", 1, 1}; // it says that m/s2 are meant
  EXPECT_EQ(hint_of_peak(0.35), "");
  earthquake.quantity = RecordQuantity::velocity;
  EXPECT_EQ(hint_of_peak(35.0), "if the record is in cm, set earthquake.scale = 0.01; in mm, 0.001");
  EXPECT_EQ(hint_of_peak(0.35), "");
}

} // namespace
} // namespace gcpdda::testing::plausible_values_test
