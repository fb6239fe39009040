#include "gcpdda/io/scene_reader.hpp"
#include "io/scene/scene_keys.hpp"
#include "io/scene/scene_reference.hpp"
#include "unit/scene_texts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gcpdda::scene_reader_test {
namespace {

using namespace gcpdda::testing;

TEST(SceneReader, ReadsRunAndOutput) {
  const Scene scene = good(full_scene);
  EXPECT_EQ(scene.stem, "small.scene");
  EXPECT_EQ(scene.run.duration, 2.0);
  EXPECT_EQ(scene.run.gravity, (Vec2{1.0, -9.5}));
  EXPECT_EQ(scene.run.gravity_ramp, 0.5);
  EXPECT_EQ(scene.run.time_step, 1e-4);
  EXPECT_EQ(scene.run.safety, 0.2);
  EXPECT_EQ(scene.run.scheme, SchemeKind::explicit_generalized_alpha);
  EXPECT_EQ(scene.run.spectral_radius, 0.5);
  EXPECT_EQ(scene.run.potential, PotentialKind::linear);
  EXPECT_EQ(scene.run.fidelity, Fidelity::rigid);
  EXPECT_EQ(scene.run.accepted_error, 0.02);
  EXPECT_EQ(scene.run.initial_friction, InitialFriction::zero);
  EXPECT_EQ(scene.run.contact_damping, 0.1);
  EXPECT_EQ(scene.run.local_damping, 0.7);
  EXPECT_EQ(scene.run.elasticity, Elasticity::explicit_);
  EXPECT_FALSE(scene.run.plane_strain);
  EXPECT_EQ(scene.output.interval, 0.02);
  EXPECT_EQ(scene.output.history_interval, 0.001);
  EXPECT_EQ(scene.output.checkpoint_interval, 0.5);
  EXPECT_FALSE(scene.output.contacts);
}

TEST(SceneReader, KeepsMaterialsInFileOrderAndFillsTheJointTable) {
  const Scene scene = good(full_scene);
  ASSERT_EQ(scene.materials.size(), 2U);
  EXPECT_EQ(scene.materials[0].name, "granite");
  EXPECT_EQ(scene.materials[0].density, 2600.0);
  EXPECT_EQ(scene.materials[0].youngs_modulus, 40e9);
  EXPECT_EQ(scene.materials[0].poissons_ratio, 0.25);
  EXPECT_EQ(scene.materials[1].name, "clay");
  EXPECT_EQ(scene.materials[1].density, 1900.5);

  ASSERT_EQ(scene.joints.laws.size(), 3U);
  const JointLaw &base = scene.joints.laws[0];
  EXPECT_EQ(base.name, "default");
  EXPECT_EQ(base.normal_stiffness, 1e9);
  EXPECT_EQ(base.allowed_overlap, 0.0);
  EXPECT_EQ(base.tangential_ratio, 0.4);
  EXPECT_EQ(base.tan_friction, std::tan(30.0 * std::numbers::pi / 180.0));
  EXPECT_EQ(base.cohesion, 10.0);
  const JointLaw &fault = scene.joints.laws[1];
  EXPECT_EQ(fault.name, "fault");
  EXPECT_EQ(fault.normal_stiffness, 0.0);
  EXPECT_EQ(fault.allowed_overlap, 0.001);
  EXPECT_EQ(fault.tangential_ratio, 0.4);
  EXPECT_EQ(fault.tan_friction, base.tan_friction);
  EXPECT_EQ(fault.cohesion, 1e4);
  const JointLaw &mud = scene.joints.laws[2];
  EXPECT_EQ(mud.name, "mud");
  EXPECT_EQ(mud.normal_stiffness, 1e9);
  EXPECT_EQ(mud.tan_friction, 0.0);
  EXPECT_EQ(mud.cohesion, 10.0);

  EXPECT_EQ(scene.joints.between(0, 0), 0);
  EXPECT_EQ(scene.joints.between(0, 1), 1);
  EXPECT_EQ(scene.joints.between(1, 0), 1);
  EXPECT_EQ(scene.joints.between(1, 1), 2);
}

TEST(SceneReader, ReadsBlocksAndMonitors) {
  const Scene scene = good(full_scene);
  ASSERT_EQ(scene.blocks.size(), 2U);
  EXPECT_EQ(scene.blocks[0].name, "slider.1");
  EXPECT_EQ(scene.blocks[0].material, 0);
  // Clockwise in the file: turned round about its first vertex.
  EXPECT_EQ(scene.blocks[0].vertices, (std::vector<Vec2>{{0, 1}, {1, 1}, {1, 2.5}, {0, 2.5}}));
  EXPECT_EQ(scene.blocks[0].velocity, (std::array<double, 3>{1.0, 0.1, -2.0}));
  EXPECT_FALSE(scene.blocks[0].fixed);
  EXPECT_EQ(scene.blocks[0].where.file, "folder/small.scene.toml");
  EXPECT_EQ(scene.blocks[0].where.line, 36);
  EXPECT_EQ(scene.blocks[0].where.column, 1);
  EXPECT_EQ(scene.blocks[1].name, "b1");
  EXPECT_EQ(scene.blocks[1].material, 1);
  EXPECT_EQ(scene.blocks[1].vertices.size(), 5U); // collinear vertices are no fault
  EXPECT_TRUE(scene.blocks[1].fixed);
  ASSERT_EQ(scene.monitors.size(), 2U);
  EXPECT_EQ(scene.monitors[0].name, "b1");
  EXPECT_EQ(scene.monitors[0].block, 1);
  EXPECT_EQ(scene.monitors[1].name, "slider.1");
  EXPECT_EQ(scene.monitors[1].block, 0);
}

TEST(SceneReader, ReadsWhatHoldsAndMovesABlock) {
  const Scene scene = good(many_sources);
  ASSERT_EQ(scene.blocks.size(), 2U);
  const SceneBlock &lever = scene.blocks[0];
  EXPECT_EQ(lever.vertices.size(), 6U) << "need not be convex";
  EXPECT_EQ(lever.fidelity, Fidelity::rigid);
  EXPECT_EQ(lever.fixed_points, (std::vector<Vec2>{{0, 0}, {2.5, 2}, {2, 1.0000000001}}));
  ASSERT_EQ(lever.loads.size(), 2U);
  EXPECT_EQ(lever.loads[0].point, (Vec2{3, 3}));
  EXPECT_EQ(lever.loads[0].force, (Vec2{0, -1e5}));
  EXPECT_EQ(lever.loads[1].force, (Vec2{2, 0}));
  EXPECT_FALSE(lever.driven);
  EXPECT_TRUE(scene.blocks[1].driven);
  EXPECT_EQ(scene.blocks[1].velocity, (std::array<double, 3>{0.0, -0.1, 0.5}));
  expect_same(scene, good(scene.resolved));
}

TEST(SceneReader, TakesVelocityTables) {
  std::string text(many_sources);
  const std::string constant = "prescribed_velocity = [0, -0.1, 0.5]";
  text.replace(text.find(constant), constant.size(),
               "velocity_table = [[0, 1, -2, 0.5], [0.25, 3, 0, 0], [1, 0, 0, 0]]");
  const Scene scene = good(text);
  EXPECT_TRUE(scene.blocks[1].driven);
  EXPECT_EQ(scene.blocks[1].velocity, (std::array<double, 3>{1.0, -2.0, 0.5}));
  EXPECT_EQ(
      scene.blocks[1].velocity_table,
      (std::vector<VelocityRow>{{0.0, {1.0, -2.0, 0.5}}, {0.25, {3.0, 0.0, 0.0}}, {1.0, {0.0, 0.0, 0.0}}}));
  expect_same(scene, good(scene.resolved));
}

TEST(SceneReader, TakesGeneratorsInTheOrderOfTheFileAndNamesTheirBlocks) {
  const Scene scene = good(many_sources);
  ASSERT_EQ(scene.generators.size(), 3U);
  EXPECT_EQ(scene.generators[0].kind, BrickGenerator::Kind::pyramid);
  EXPECT_EQ(scene.generators[0].name, "pyramid0");
  EXPECT_EQ(scene.generators[0].origin, (Vec2{10, 0}));
  EXPECT_EQ(scene.generators[0].gap, 0.01);
  EXPECT_EQ(scene.generators[1].name, "east.wall");
  EXPECT_EQ(scene.generators[1].rows, 2);
  EXPECT_EQ(scene.generators[1].columns, 4);
  EXPECT_EQ(scene.generators[1].block_size, (Vec2{0.5, 0.25}));
  EXPECT_EQ(scene.generators[1].bond, 0.25);
  EXPECT_EQ(scene.generators[1].where.line, 33);
  EXPECT_EQ(scene.generators[2].name, "wall1");
  EXPECT_EQ(scene.generators[2].bond, 0.5);
  // 2 inline, 6 + 9 + 1 bricks, then the file.
  EXPECT_EQ(scene.block_file.path, "folder/sub/my \"blocks\".h5");
  EXPECT_EQ(scene.block_file.where.line, 48);
  ASSERT_EQ(scene.monitors.size(), 4U);
  EXPECT_EQ(scene.monitors[0].block, 2 + 6 + 4 + 4);
  EXPECT_EQ(scene.monitors[0].name, "east.wall.1.4");
  EXPECT_TRUE(scene.monitors[1].is_point);
  EXPECT_EQ(scene.monitors[1].block, -1);
  EXPECT_EQ(scene.monitors[1].name, "roof");
  EXPECT_EQ(scene.monitors[1].point, (Vec2{0.5, 6}));
  EXPECT_EQ(scene.monitors[1].where.line, 53);
  EXPECT_EQ(scene.monitors[2].block, 21);
  EXPECT_EQ(scene.monitors[3].block, 2 + 5);
}

TEST(SceneReader, AWallAloneIsAScene) {
  const std::string text = many_sources;
  const std::string head = text.substr(0, text.find("[[pyramid]]"));
  const std::string wall =
      text.substr(text.rfind("[[wall]]"), text.find("[blocks]") - text.rfind("[[wall]]"));
  const Scene scene = good(head + wall, {"wall.wall0.rows=7", "wall.wall0.name=w"});
  EXPECT_EQ(scene.generators.at(0).rows, 7);
  EXPECT_EQ(scene.generators.at(0).name, "w");
  EXPECT_EQ(good(head + "[blocks]\nfile = '/data/b.h5'\n").block_file.path, "/data/b.h5");
}

TEST(SceneReader, DefaultsAreThoseOfTheModel) {
  const Scene scene = good(small_scene);
  Scene expected = scene;
  expected.run = RunSettings{};
  expected.run.duration = 2.0;
  expected.output = OutputSettings{};
  expected.output.interval = 0.02;
  expected.output.history_interval = 0.02;
  expect_same(scene, expected);
  EXPECT_EQ(scene.joints.laws[0].tangential_ratio, JointLaw{}.tangential_ratio);
  EXPECT_EQ(scene.joints.laws[0].tan_friction, 0.0);
  EXPECT_EQ(scene.joints.laws[0].cohesion, 0.0);
}

// The table of keys describes the defaults; the model holds them. Stating each one changes nothing.
TEST(SceneReader, DefaultsOfTheKeyTableAreThoseInForce) {
  const std::string bricks = "material = \"granite\"\norigin = [5, 0]\nrows = 2\nblock_size = [1, 1]\n";
  const std::string text =
      small_scene + "[[wall]]\ncolumns = 2\n" + bricks + "[[pyramid]]\n" + bricks +
      "[water.lake]\nphreatic = [[0, 0], [1, 0]]\n[earthquake]\nrecord = \"r.csv\"\n"
      "[support.bar]\nkind = \"grouted\"\naxial_stiffness = 1e8\nactive_length = 0.3\n"
      "bond_strength = 1e5\n[[bolt]]\nsupport = \"bar\"\nfrom = [0, 0]\nto = [0, 1]\n"
      "[support.layer]\nkind = \"liner\"\nthickness = 0.1\nyoungs_modulus = 2e10\ntensile_strength = 2e6\n"
      "adhesion = 1e6\n[[liner]]\nsupport = \"layer\"\npoints = [[0, 0], [1, 0]]\n"
      "[region]\nmaterial = \"granite\"\npolygon = [[20, 0], [30, 0], [30, 9], [20, 9]]\n"
      "[[opening]]\nname = \"o\"\nshape = \"circle\"\ncentre = [25, 4]\nwidth = 3\n"
      "[[bolt_pattern]]\nsupport = \"bar\"\nopening = \"o\"\nlength = 2\ncount = 3\n"
      "[ensemble]\ncount = 3\n"
      "vary = [{key = \"joint.default.cohesion\", distribution = \"seed\"}]\n";
  const Scene scene = good(text);
  int compared = 0;
  for (const scene_text::Key &key : scene_text::scene_keys()) {
    if (key.fallback.empty() || key.fallback.front() == '<' || key.path.starts_with("stage[]")) {
      continue;
    }
    std::string path(key.path);
    for (const auto &[from, to] :
         {std::pair("block[]", "block.slider"), std::pair("joint.*", "joint.default"),
          std::pair("support.*.poissons", "support.layer.poissons"),
          std::pair("support.*.residual", "support.layer.residual"),
          std::pair("support.*.bond_width", "support.layer.bond_width"), std::pair("liner[]", "liner.liner0"),
          std::pair("wall[]", "wall.wall0"), std::pair("pyramid[]", "pyramid.pyramid0"),
          std::pair("water.*", "water.lake"), std::pair("support.*", "support.bar"),
          std::pair("bolt[]", "bolt.bolt0"), std::pair("bolt_pattern[]", "bolt_pattern.bolt_pattern0")}) {
      if (path.starts_with(from)) {
        path.replace(0, std::string(from).size(), to);
      }
    }
    SCOPED_TRACE(path);
    expect_same(good(text, {path + "=" + std::string(key.fallback)}), scene);
    ++compared;
  }
  EXPECT_EQ(compared, 54);
}

TEST(SceneReader, SettleStagesAreStaticUnlessDampingIsAskedFor) {
  const std::string text = "[run]\n" + small_scene.substr(small_scene.find("[material")) +
                           "[[stage]]\nkind = \"settle\"\nlimit = 3.0\n";
  const auto solver = [&](const std::string &keys) { return good(text + keys).stages.at(0).solver; };
  EXPECT_EQ(solver(""), Solver::statics);
  EXPECT_EQ(solver("solver = \"dynamic\"\n"), Solver::dynamic);
  for (const char *keys : {"local_damping = 0.5\n", "kinetic_damping = true\n", "mass_scaling = true\n"}) {
    EXPECT_EQ(solver(keys), Solver::dynamic) << keys;
    EXPECT_EQ(solver(std::string(keys) + "solver = \"static\"\n"), Solver::statics) << keys;
  }
}

// A duration of the run has no meaning beside stages, so they have a scene of their own.
TEST(SceneReader, DefaultsOfStagesAreThoseInForce) {
  const std::string text = "[run]\n" + small_scene.substr(small_scene.find("[material"));
  const Stage stage = good(text + "[[stage]]\nkind = \"settle\"\nlimit = 3.0\n").stages.at(0);
  const auto stated = [](const char *name) {
    return std::stod(std::string(scene_text::find_key("stage[]", name)->fallback));
  };
  EXPECT_EQ(stage.tolerance, stated("tolerance"));
  EXPECT_EQ(stage.failure_motion, stated("failure_motion"));
  EXPECT_EQ(stage.relax, stated("relax"));
  EXPECT_EQ(static_cast<double>(stage.increments), stated("increments"));
  EXPECT_EQ(stage.local_damping, 0.8);
  EXPECT_FALSE(stage.mass_scaling);
  EXPECT_TRUE(stage.until_verdict);
  EXPECT_EQ(stage.duration, 3.0);
  EXPECT_EQ(stage.name, "stage0");
  const Stage run = good(text + "[[stage]]\nkind = \"run\"\nduration = 3.0\n").stages.at(0);
  EXPECT_LT(run.local_damping, 0.0);
  EXPECT_FALSE(run.until_verdict);
}

// Every fault of the stages in one reading, those of what they set where it is set.
TEST(SceneReader, FaultsOfStagesAreTold) {
  const std::string text = "[run]\n" + small_scene.substr(small_scene.find("[material")) + R"([[stage]]
kind = "settle"
duration = 2
[[stage]]
kind = "excavate"
[[stage]]
kind = "excavate"
blocks = ["slidr"]
[[stage]]
name = "x"
kind = "change"
set = { "joint.default.friction_angle_deg" = 95, "joint.fault.cohesion" = 3, "run.scheme" = "newmark-dda", "block.b.fixed" = true }
[[stage]]
name = "x"
kind = "run"
[[stage]]
kind = "change"
)";
  const auto first =
      static_cast<int>(std::count(text.begin(),
                                  text.begin() + static_cast<std::ptrdiff_t>(text.find("[[stage]]")), '\n')) +
      1;
  const SceneReading reading = read_scene(text, "s.toml", {});
  struct Expected {
    int line;
    std::string said;
  };
  const std::vector<Expected> expected{{0, "'limit' in stage 'stage0' is missing"},
                                       {2, "'duration' in stage 'stage0' has no meaning"},
                                       {3, "stage 'stage1' names no blocks"},
                                       {7, "no block is named 'slidr'"},
                                       {11, "'friction_angle_deg' in [joint.default] is 95"},
                                       {11, "'joint.fault.cohesion' names no joint of the scene"},
                                       {11, "a stage cannot set 'run.scheme'"},
                                       {11, "no block is named 'b'"},
                                       {12, "stage 'x' gives neither duration nor limit"},
                                       {13, "two stages are named 'x'"},
                                       {15, "stage 'stage5' changes nothing"}};
  ASSERT_EQ(reading.diagnostics.size(), expected.size()) << ::testing::PrintToString(messages(reading));
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(reading.diagnostics[k].where.line, first + expected[k].line)
        << to_string(reading.diagnostics[k]);
    EXPECT_EQ(reading.diagnostics[k].what, expected[k].said);
  }
}

TEST(SceneReader, EveryKeyHasASentenceAndAnExample) {
  for (const scene_text::Key &key : scene_text::scene_keys()) {
    SCOPED_TRACE(key.path);
    EXPECT_TRUE(key.doc.ends_with('.'));
    EXPECT_FALSE(key.example.empty());
    EXPECT_EQ(scene_text::find_key(scene_text::parent_of(key), scene_text::name_of(key)), &key);
    if (const auto parent = scene_text::parent_of(key); !parent.empty()) {
      std::size_t rows = 0;
      for (const scene_text::Key &other : scene_text::scene_keys()) {
        rows += other.path == parent ? 1 : 0;
      }
      EXPECT_EQ(rows, 1U);
    }
  }
}

TEST(SceneReference, HasARowForEveryKey) {
  const std::string page = scene_reference();
  std::size_t rows = 0;
  for (std::size_t at = page.find("\n| `"); at != std::string::npos; at = page.find("\n| `", at + 1)) {
    ++rows;
  }
  std::size_t keys = 6; // datasets of the block file
  for (const scene_text::Key &key : scene_text::scene_keys()) {
    keys += scene_text::parent_of(key).empty() || key.path == "material.*" || key.path == "joint.*" ||
                    key.path == "water.*" || key.path == "support.*"
                ? 0U
                : 1U;
  }
  EXPECT_EQ(rows, keys);
  for (const char *line :
       {"\n## [run]\n", "\n## [material.NAME]\n", "\n## [[block.load]]\n",
        "\n| `safety` | number |  | `0.55` | above 0 and at most 1 | Fraction of the stability bound that "
        "\"auto\" takes. Settle stages take 0.9, unless safety is below 0.55. | `safety = 0.55` |\n",
        "\n| `density` | number | kg/m3 | required | above 0 and at most 1e+12 | Density. | `density = "
        "2600.0` "
        "|\n",
        "\n| `/offsets` | 64-bit integers | (nb + 1) |  | required | ",
        "its id is k plus the number of blocks of [[block]], [[wall]] and [[pyramid]].\n"}) {
    EXPECT_NE(page.find(line), std::string::npos) << line;
  }
}

TEST(SceneReader, ResidualAngleOfOneLawIsNotThatOfTheNext) {
  const Scene scene = good(R"(
[run]
duration = 1
[material.rock]
density = 2600
[material.clay]
density = 2000
[joint.default]
normal_stiffness = 1e9
friction_angle_deg = 35
[joint.rough]
materials = ["rock", "clay"]
law = "barton-bandis"
residual_friction_angle_deg = 30
jrc = 6
jcs = 5e7
[joint.smooth]
materials = ["clay", "clay"]
friction_angle_deg = 18
[[block]]
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1]]
)");
  EXPECT_EQ(scene.joints.laws[2].residual_tan_friction, scene.joints.laws[2].tan_friction);
}

TEST(SceneReader, MaterialsMayStandInlineAndInAnyOrder) {
  const Scene scene = good(R"(
block = [{material = "z", vertices = [[0, 0], [1, 0], [0, 1]]}]
material = {z = {density = 2}, a = {density = 1}}
run.duration = 1
joint.default.allowed_overlap = 0.01
)");
  EXPECT_EQ(scene.materials[0].name, "z");
  EXPECT_EQ(scene.materials[1].name, "a");
  EXPECT_EQ(scene.joints.laws[0].allowed_overlap, 0.01);
  EXPECT_EQ(scene.joints.laws[0].normal_stiffness, 0.0);
  EXPECT_EQ(scene.blocks[0].name, "b0");
  expect_same(scene, good(scene.resolved));
}

TEST(SceneReader, OutlineThatIsStraightOrThinOrFarAwayIsGood) {
  for (const std::string vertices :
       {"[[0, 0], [0.1, 0.1], [0.3, 0.3], [0.7, 0.7], [0, 1]]", "[[0, 0], [1, 0], [1, 1e-6], [0, 1e-6]]",
        "[[1e6, 1e6], [1000000.1, 1e6], [1000000.1, 1000000.1], [1e6, 1000000.1]]"}) {
    good(small_scene, {"block.slider.vertices=" + vertices});
  }
}

// A law whose name holds a dot is quoted in the path by which a stage sets it.
TEST(SceneReader, ResolvedTextHoldsQuotedPaths) {
  const Scene scene = good(R"([run]
[material.rock]
density = 2600.0
[joint.default]
normal_stiffness = 1e8
[joint."j.b"]
friction_angle_deg = 30.0
[[block]]
material = "rock"
fixed = true
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
edge_joints = ["j.b", "", "", ""]
[output]
interval = 0.1
[[stage]]
kind = "settle"
limit = 1.0
[[stage]]
kind = "settle"
limit = 1.0
set = { "joint.\"j.b\".friction_angle_deg" = 20.0 }
)");
  const Scene again = good(scene.resolved);
  expect_same(scene, again);
  EXPECT_EQ(scene.resolved, again.resolved);
  EXPECT_EQ(again.stages.at(1).after->joints.laws.at(1).name, "j.b");
}

TEST(SceneReader, ResolvedTextReadsBackToTheSameScene) {
  const Sets sets{"run.time_step=auto",
                  "run.gravity=[0.1, -0.30000000000000004]",
                  "material.\"a.b\".density=1e-7",
                  "joint.fault.cohesion=1e19",
                  "material.aaa.density=3",
                  "block.slider.1.name=new.name",
                  "monitor=[{block=\"new.name\"}]"};
  const Scene scene = good(full_scene, sets);
  const Scene again = good(scene.resolved);
  expect_same(scene, again);
  EXPECT_EQ(scene.resolved, again.resolved);
  EXPECT_EQ(scene.materials[2].name, "a.b");
  EXPECT_EQ(scene.materials[3].name, "aaa");
}

// Numbers of blocks follow the order of the file: a restart reads the resolved text.
TEST(SceneReader, ResolvedTextKeepsTheOrderInWhichWallsAndPyramidsAlternate) {
  const std::string bricks = "material = \"granite\"\norigin = [5, 0]\nrows = 2\nblock_size = [1, 1]\n";
  const std::string wall = "[[wall]]\ncolumns = 2\n" + bricks;
  const Scene scene = good(small_scene + wall + "[[pyramid]]\n" + bricks + wall);
  const Scene again = good(scene.resolved);
  ASSERT_EQ(again.generators.size(), 3U);
  EXPECT_EQ(again.generators[1].kind, BrickGenerator::Kind::pyramid);
  EXPECT_EQ(again.generators[2].name, "wall1");
  EXPECT_EQ(scene.resolved, again.resolved);
}

TEST(SceneReader, ResolvedTextIsAsAPersonWouldWriteIt) {
  EXPECT_EQ(
      good(small_scene, {"run.scheme=newmark-dda", "block.slider.fixed=true", "run.safety=0.1"}).resolved,
      R"([run]
duration = 2.0
scheme = "newmark-dda"
safety = 0.1

[material.granite]
density = 2600.0

[joint.default]
normal_stiffness = 1000000000.0

[[block]]
name = "slider"
material = "granite"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
fixed = true
)");
}

} // namespace
} // namespace gcpdda::scene_reader_test
