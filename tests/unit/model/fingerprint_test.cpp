// What tells a state of one scene from that of another, and what a checkpoint says of its stages.

#include "model/fingerprint.hpp"

#include "base/check.hpp"
#include "simulation/stages.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace gcpdda::fingerprint_test {
namespace {

using testing::scene_of;

const std::string tables = R"([run]
duration = 1.0
[material.rock]
density = 2600.0
youngs_modulus = 1e9
poissons_ratio = 0.2
[joint.default]
normal_stiffness = 1e9
[output]
interval = 0.1
[[block]]
name = "floor"
material = "rock"
vertices = [[-5, -1], [5, -1], [5, 0], [-5, 0]]
fixed = true
[[block]]
name = "slider"
material = "rock"
vertices = [[0, 0], [1, 0], [1, 1], [0, 1]]
velocity = [1, 0, 0]
[[wall]]
name = "w"
material = "rock"
origin = [2, 0]
rows = 2
columns = 2
block_size = [0.5, 0.25]
[[monitor]]
block = "slider"
)";

// Every one of these is another block; a sum over blocks tells them apart wherever they stand.
TEST(Fingerprint, TellsBlocksApart) {
  SceneBlock block;
  block.vertices = {{0, 0}, {1, 0}, {1, 1}};
  std::set<std::uint64_t> seen{fingerprint(0, block), fingerprint(1, block)};
  const auto add = [&](auto change) {
    SceneBlock changed = block;
    change(changed);
    seen.insert(fingerprint(0, changed));
  };
  add([](SceneBlock &b) { b.vertices[2].y = std::nextafter(1.0, 2.0); });
  add([](SceneBlock &b) { std::swap(b.vertices[0], b.vertices[1]); });
  add([](SceneBlock &b) { b.material = 1; });
  add([](SceneBlock &b) { b.fixed = true; });
  add([](SceneBlock &b) { b.driven = true; });
  add([](SceneBlock &b) { b.velocity[2] = 1e-300; });
  add([](SceneBlock &b) { b.velocity_table = {{0.0, {1, 0, 0}}}; });
  add([](SceneBlock &b) { b.fixed_points = {{0, 0}}; });
  EXPECT_EQ(seen.size(), 10U);
  SceneBlock renamed = block;
  renamed.name = "new";
  renamed.loads = {{{0, 0}, {1, 1}}};
  EXPECT_EQ(fingerprint(0, renamed), fingerprint(0, block));
}

std::vector<std::string> changed_parts(const Scene &a, const Scene &b, std::size_t stages = 0) {
  const ScenePrints before = fingerprints(a, std::span(a.stages).first(stages));
  const ScenePrints after = fingerprints(b, std::span(b.stages).first(stages));
  std::vector<std::string> parts;
  for (std::size_t part = 0; part < before.size(); ++part) {
    if (before[part] != after[part]) {
      parts.emplace_back(scene_parts[part]);
    }
  }
  EXPECT_EQ(parts.empty(), fingerprint(before) == fingerprint(after));
  return parts;
}

const std::string more_tables = R"([support.bolt]
kind = "grouted"
axial_stiffness = 1e7
axial_yield = 1e5
shear_stiffness = 1e6
active_length = 0.2
[[bolt]]
name = "first"
support = "bolt"
from = [0.5, 1.0]
to = [0.5, -0.5]
[[bolt]]
name = "later"
support = "bolt"
from = [0.7, 1.0]
to = [0.7, -0.5]
active = false
[support.layer]
kind = "liner"
thickness = 0.1
youngs_modulus = 2e10
tensile_strength = 2e6
adhesion = 1e6
[[liner]]
name = "face"
support = "layer"
points = [[-0.5, 0.0], [1.5, 0.0]]
[[liner]]
name = "next"
support = "layer"
points = [[-0.5, 1.0], [1.5, 1.0]]
active = false
[water.lake]
phreatic = [[-5, 0.2], [5, 0.2]]
)";

const std::string stage_tables = R"([[stage]]
kind = "run"
duration = 0.1
[[stage]]
name = "weaker"
kind = "change"
set = { "joint.default.friction_angle_deg" = 10.0, "bolt.later.active" = true }
[[stage]]
kind = "excavate"
blocks = ["w.1.1"]
[[stage]]
kind = "settle"
limit = 0.5
)";

// A state is one of all that it has been computed with, and of nothing else.
TEST(Fingerprint, TellsScenesApartByWhatAStateDependsOn) {
  const std::string text = tables + more_tables;
  const Scene scene = scene_of(text);
  for (const auto &[set, part] : std::vector<std::pair<const char *, const char *>>{
           {"run.gravity=[0, -9.8]", "[run]"},
           {"run.gravity_ramp=0.5", "[run]"},
           {"run.scheme=newmark-dda", "[run]"},
           {"run.spectral_radius=0.8", "[run]"},
           {"run.potential=linear", "[run]"},
           {"run.contact_damping=0.2", "[run]"},
           {"run.local_damping=0.5", "[run]"},
           {"run.plane=stress", "[run]"},
           {"run.elasticity=explicit", "[run]"},
           {"joint.default.friction_angle_deg=20", "[joint]"},
           {"joint.default.cohesion=1e3", "[joint]"},
           {"joint.default.normal_stiffness=2e9", "[joint]"},
           {"joint.default.tangential_ratio=0.4", "[joint]"},
           {"material.rock.density=2601", "[material]"},
           {"material.rock.youngs_modulus=2e9", "[material]"},
           {"block.slider.load=[{point=[0.5, 1], force=[0, -1e4]}]", "[[block]]"},
           {"water.lake.active=false", "[water]"},
           {"water.lake.density=1001", "[water]"},
           {"support.bolt.axial_stiffness=2e7", "[[bolt]]"},
           {"bolt.first.active=false", "[[bolt]]"},
           {"support.layer.thickness=0.2", "[[liner]]"},
           {"support.layer.youngs_modulus=3e10", "[[liner]]"},
           {"support.layer.poissons_ratio=0.25", "[[liner]]"},
           {"support.layer.compressive_strength=3e7", "[[liner]]"},
           {"support.layer.tensile_strength=3e6", "[[liner]]"},
           {"support.layer.residual_tensile_strength=1e6", "[[liner]]"},
           {"support.layer.shear_strength=3e6", "[[liner]]"},
           {"support.layer.adhesion=2e6", "[[liner]]"},
           {"support.layer.bond_width=0.1", "[[liner]]"},
           {"liner.face.active=false", "[[liner]]"},
           {"liner.face.points=[[-0.5, 0.0], [1.0, 0.0]]", "[[liner]]"},
       }) {
    EXPECT_EQ(changed_parts(scene, scene_of(text, {set})), std::vector<std::string>{part}) << set;
  }
  for (const char *set :
       {"run.duration=3", "run.time_step=1e-4", "run.safety=0.1", "output.interval=0.2",
        "output.checkpoint_interval=0.2", "output.contacts=false", "monitor=[]", "bolt.later.to=[0.7, -0.6]",
        "liner.next.points=[[0, 1], [1, 1]]", "fos.tolerance=0.1"}) {
    EXPECT_EQ(changed_parts(scene, scene_of(text, {set})), std::vector<std::string>()) << set;
  }
}

// Stages count once a state has gone through them.
TEST(Fingerprint, KnowsTheStagesUpToThatOfTheState) {
  std::string text = tables + more_tables + stage_tables;
  text.erase(text.find("duration = 1.0\n"), 15); // the stages say it
  const Scene scene = scene_of(text);
  const Scene weaker = scene_of(
      text, {"stage.weaker.set={\"joint.default.friction_angle_deg\"=5.0, \"bolt.later.active\"=true}"});
  EXPECT_EQ(changed_parts(scene, weaker, 1), std::vector<std::string>());
  EXPECT_EQ(changed_parts(scene, weaker, 2), std::vector<std::string>{"[joint]"});
  const Scene moved = scene_of(text, {"bolt.later.to=[0.7, -0.6]"});
  EXPECT_EQ(changed_parts(scene, moved, 1), std::vector<std::string>());
  EXPECT_EQ(changed_parts(scene, moved, 2), std::vector<std::string>{"[[bolt]]"});
  Scene other = scene;
  other.stages[2].excavated.blocks = {4};
  EXPECT_EQ(changed_parts(scene, other, 2), std::vector<std::string>());
  EXPECT_EQ(changed_parts(scene, other, 3), std::vector<std::string>{"[[stage]]"});
  other = scene;
  other.stages[3].duration = 99.0;
  other.stages[0].name = "renamed";
  EXPECT_EQ(changed_parts(scene, other, 4), std::vector<std::string>()) << "a limit says nothing of a state";
}

TEST(StageNumbers, AreThoseOfAStateOrRefused) {
  StageState state;
  state.index = 2;
  state.results.resize(2);
  state.removed = {3, 5};
  state.unloading.resize(1);
  const StageNumbers good = to_numbers(state);
  EXPECT_EQ(to_numbers(to_state(good)).counts, good.counts);
  for (std::size_t k = 0; k < 3; ++k) { // lengths of the lists
    for (const std::int64_t count : {std::int64_t{-1}, good.counts[k] + 1, std::int64_t{1} << 40,
                                     std::numeric_limits<std::int64_t>::max()}) {
      StageNumbers bad = good;
      bad.counts[k] = count;
      EXPECT_THROW(to_state(bad), FileError) << k << ": " << count;
    }
  }
  StageNumbers bad = good;
  bad.counts.resize(2);
  EXPECT_THROW(to_state(bad), FileError);
  bad = good;
  bad.reals.pop_back();
  EXPECT_THROW(to_state(bad), FileError);
  bad = good;
  bad.counts[3] = 7; // the stage
  EXPECT_THROW(to_state(bad), FileError);
}

} // namespace
} // namespace gcpdda::fingerprint_test
