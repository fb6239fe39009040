#include "gcpdda/io/scene_reader.hpp"

#include "../../src/io/edit_distance.hpp"
#include "../../src/io/scene_keys.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace gcpdda {
namespace {

using Sets = std::vector<std::string>;

const std::string full_scene = R"(# every key of this version
[run]
duration = 2
gravity = [1, -9.5]
gravity_ramp = 0.5
time_step = 1e-4
safety = 0.2
scheme = "explicit-generalized-alpha"
spectral_radius = 0.5
potential = "linear"
fidelity = "rigid"
accepted_error = 0.02
initial_friction = "zero"
contact_damping = 0.1
local_damping = 0.0
plane = "stress"
[material.granite]
density = 2600
youngs_modulus = 40e9
poissons_ratio = 0.25
[material.clay]
density = 1900.5
[joint.fault]
materials = ["clay", "granite"]
allowed_overlap = 0.001
cohesion = 1e4
[joint.default]
normal_stiffness = 1e9
tangential_ratio = 0.4
friction_angle_deg = 30
cohesion = 10.0
[joint.mud]
materials = ["clay", "clay"]
friction_angle_deg = 0
[[block]]
name = "slider.1"
material = "granite"
vertices = [[0, 1], [0, 2.5], [1, 2.5], [1, 1]]
velocity = [1, 0.1, -2]
fidelity = "auto"
[[block]]
material = "clay"
vertices = [[-5, 0], [0, 0], [5, 0], [5, 1], [-5, 1]]
fixed = true
[output]
interval = 0.02
history_interval = 0.001
contacts = false
[[monitor]]
block = "b1"
[[monitor]]
block = "slider.1"
)";

const std::string small_scene = R"([run]
duration = 2.0
[material.granite]
density = 2600.0
[joint.default]
normal_stiffness = 1e9
[[block]]
name = "slider"
material = "granite"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
)";

std::vector<std::string> messages(const SceneReading &reading) {
  std::vector<std::string> result;
  for (const Diagnostic &diagnostic : reading.diagnostics) {
    result.push_back(to_string(diagnostic));
  }
  return result;
}

Scene good(const std::string &text, const Sets &sets = {}) {
  const SceneReading reading = read_scene(text, "folder/small.scene.toml", sets);
  EXPECT_EQ(messages(reading), std::vector<std::string>{});
  return reading.scene;
}

std::vector<std::string> faults(const Sets &sets) {
  return messages(read_scene(small_scene, "s.toml", sets));
}

void expect_same(const Scene &a, const Scene &b) {
  EXPECT_EQ(a.run.duration, b.run.duration);
  EXPECT_EQ(a.run.gravity, b.run.gravity);
  EXPECT_EQ(a.run.gravity_ramp, b.run.gravity_ramp);
  EXPECT_EQ(a.run.time_step, b.run.time_step);
  EXPECT_EQ(a.run.safety, b.run.safety);
  EXPECT_EQ(a.run.scheme, b.run.scheme);
  EXPECT_EQ(a.run.spectral_radius, b.run.spectral_radius);
  EXPECT_EQ(a.run.contact_time, b.run.contact_time);
  EXPECT_EQ(a.run.potential, b.run.potential);
  EXPECT_EQ(a.run.fidelity, b.run.fidelity);
  EXPECT_EQ(a.run.accepted_error, b.run.accepted_error);
  EXPECT_EQ(a.run.initial_friction, b.run.initial_friction);
  EXPECT_EQ(a.run.contact_damping, b.run.contact_damping);
  EXPECT_EQ(a.run.plane_strain, b.run.plane_strain);
  EXPECT_EQ(a.output.interval, b.output.interval);
  EXPECT_EQ(a.output.history_interval, b.output.history_interval);
  EXPECT_EQ(a.output.contacts, b.output.contacts);
  EXPECT_EQ(a.joints.num_materials, b.joints.num_materials);
  EXPECT_EQ(a.joints.of_material, b.joints.of_material);
  ASSERT_EQ(a.joints.laws.size(), b.joints.laws.size());
  for (std::size_t i = 0; i < a.joints.laws.size(); ++i) {
    EXPECT_EQ(a.joints.laws[i].name, b.joints.laws[i].name);
    EXPECT_EQ(a.joints.laws[i].normal_stiffness, b.joints.laws[i].normal_stiffness);
    EXPECT_EQ(a.joints.laws[i].allowed_overlap, b.joints.laws[i].allowed_overlap);
    EXPECT_EQ(a.joints.laws[i].tangential_ratio, b.joints.laws[i].tangential_ratio);
    EXPECT_EQ(a.joints.laws[i].tan_friction, b.joints.laws[i].tan_friction);
    EXPECT_EQ(a.joints.laws[i].cohesion, b.joints.laws[i].cohesion);
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t i = 0; i < a.materials.size(); ++i) {
    EXPECT_EQ(a.materials[i].name, b.materials[i].name);
    EXPECT_EQ(a.materials[i].density, b.materials[i].density);
    EXPECT_EQ(a.materials[i].youngs_modulus, b.materials[i].youngs_modulus);
    EXPECT_EQ(a.materials[i].poissons_ratio, b.materials[i].poissons_ratio);
  }
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (std::size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].name, b.blocks[i].name);
    EXPECT_EQ(a.blocks[i].material, b.blocks[i].material);
    EXPECT_EQ(a.blocks[i].vertices, b.blocks[i].vertices);
    EXPECT_EQ(a.blocks[i].velocity, b.blocks[i].velocity);
    EXPECT_EQ(a.blocks[i].fixed, b.blocks[i].fixed);
  }
  ASSERT_EQ(a.monitors.size(), b.monitors.size());
  for (std::size_t i = 0; i < a.monitors.size(); ++i) {
    EXPECT_EQ(a.monitors[i].name, b.monitors[i].name);
    EXPECT_EQ(a.monitors[i].block, b.monitors[i].block);
  }
}

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
  EXPECT_FALSE(scene.run.plane_strain);
  EXPECT_EQ(scene.output.interval, 0.02);
  EXPECT_EQ(scene.output.history_interval, 0.001);
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
  EXPECT_EQ(scene.blocks[0].where.line, 35);
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
  const Scene scene = good(small_scene);
  int compared = 0;
  for (const scene_text::Key &key : scene_text::scene_keys()) {
    if (key.fallback.empty() || key.fallback.front() == '<') {
      continue;
    }
    std::string path(key.path);
    for (const auto &[from, to] :
         {std::pair("block[]", "block.slider"), std::pair("joint.*", "joint.default")}) {
      if (path.starts_with(from)) {
        path.replace(0, std::string(from).size(), to);
      }
    }
    SCOPED_TRACE(path);
    expect_same(good(small_scene, {path + "=" + std::string(key.fallback)}), scene);
    ++compared;
  }
  EXPECT_EQ(compared, 20);
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

TEST(SceneSets, ReplaceAndCreate) {
  const Scene scene =
      good(small_scene, {"run.duration=3", "run.duration = 4", "output.contacts=false",
                         "joint.self.materials=[\"granite\", 'granite']", "joint.self.friction_angle_deg=45",
                         "run.potential=\"linear\"", "run.contact_time=predictor-end"});
  EXPECT_EQ(scene.run.duration, 4.0); // the last one counts
  EXPECT_EQ(scene.output.interval, 0.04);
  EXPECT_FALSE(scene.output.contacts);
  EXPECT_EQ(scene.joints.between(0, 0), 1);
  EXPECT_EQ(scene.joints.laws[1].normal_stiffness, 1e9);
  EXPECT_EQ(scene.run.potential, PotentialKind::linear);
  EXPECT_EQ(scene.run.contact_time, ContactTime::predictor_end);
}

TEST(SceneSets, AddressBlocksByName) {
  EXPECT_TRUE(good(small_scene, {"block.slider.fixed=true"}).blocks[0].fixed);
  EXPECT_FALSE(good(full_scene, {"block.b1.fixed=false"}).blocks[1].fixed);
  const std::array<double, 3> still{};
  EXPECT_EQ(good(full_scene, {"block.slider.1.velocity=[0, 0, 0]"}).blocks[0].velocity, still);
  EXPECT_EQ(good(full_scene, {"block.'slider.1'.velocity=[0, 0, 0]"}).blocks[0].velocity, still);
}

TEST(SceneSets, CanMendAScene) {
  EXPECT_EQ(read_scene("[run]\nduration = -1\n", "s.toml",
                       {"run.duration=1", "material.m.density=1", "joint.default.normal_stiffness=1",
                        "block=[{material='m', vertices=[[0,0],[1,0],[0,1]]}]"})
                .diagnostics.size(),
            0U);
}

TEST(SceneSets, FaultsNameTheArgument) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"run.time_step",
       "not of the form path=value, a path is made of names joined by dots, for example --set "
       "run.time_step=1e-4"},
      {"run..safety=1",
       "not of the form path=value, a path is made of names joined by dots, for example --set "
       "run.time_step=1e-4"},
      {"run.time_step=-1",
       "'time_step' in [run] is -1, it must be above 0 and at most 1e+12, for example time_step "
       "= 1e-4"},
      {"run.time_step=1e-4s", "'time_step' in [run] is '1e-4s', it must be a number or \"auto\", for example "
                              "time_step = 1e-4"},
      {"run.accepted_error=nan",
       "'accepted_error' in [run] is nan, it must be finite, for example accepted_error = "
       "0.01"},
      {"run.saftey=1", "unknown key 'saftey' in [run], did you mean 'safety'?"},
      {"rum.safety=1", "unknown key 'rum', did you mean 'run'?"},
      {"run.gravity=[0,", "not valid TOML, Error while parsing array: encountered end-of-file, check quotes, "
                          "brackets and = up to this place"},
      {"run.duration.x=1", "'duration' is not a table, the path goes on below it, shorten the path"},
      {"run.safety=0.5\nrun.x=1",
       "the value is more than one TOML value, give every assignment its own --set"},
      {"block.slidr.fixed=true", "no block is named 'slidr', did you mean 'slider'?"},
      {"block.slider=1", "'block.slider' names no key of a block, for example --set block.slider.fixed=true"},
      {"block.slider.vertices=[[0,0],[1,1],[1,0],[0,1]]",
       "block 'slider' crosses itself, two of its edges meet away from a common vertex, list the vertices in "
       "order "
       "around the block"},
      {"material.clay.youngs_modulus=1",
       "'density' in [material.clay] is missing, it is required, for example "
       "density = 2600.0"},
      {"wall.rows=3", "'wall' is not available in this version, leave it out"}};
  for (const auto &[set, message] : cases) {
    std::string label = set;
    if (const std::size_t line_break = label.find('\n'); line_break != std::string::npos) {
      label[line_break] = ' ';
    }
    EXPECT_EQ(faults({set}), std::vector<std::string>{"--set " + label + ": error: " + message});
  }
}

TEST(SceneSets, FaultsComeAfterThoseOfTheFileInTheOrderOfTheSets) {
  const SceneReading reading =
      read_scene("[run]\nduration = 0\n" + small_scene.substr(small_scene.find("[mat")), "s.toml",
                 {"zzz=1", "run.safety=2", "aaa=1"});
  ASSERT_EQ(reading.diagnostics.size(), 4U);
  EXPECT_EQ(reading.diagnostics[0].where.file, "s.toml");
  EXPECT_EQ(reading.diagnostics[0].where.line, 2);
  EXPECT_EQ(reading.diagnostics[1].where.file, "--set zzz=1");
  EXPECT_EQ(reading.diagnostics[1].where.line, 0);
  EXPECT_EQ(reading.diagnostics[2].where.file, "--set run.safety=2");
  EXPECT_EQ(reading.diagnostics[3].where.file, "--set aaa=1");
}

TEST(EditDistance, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("saftey", "safety"), 1U);
  EXPECT_EQ(nearest_word("colour", {"cohesion", "density"}), "");
  EXPECT_EQ(nearest_word("grav", {"duration", "gravity"}), "gravity");
}

} // namespace
} // namespace gcpdda
