#pragma once

#include "gcpdda/io/scene_reader.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

/// Scene texts that use all keys between them, and what the tests of reading them share.
namespace gcpdda::testing {

using Sets = std::vector<std::string>;

inline const std::string full_scene = R"(# every key of this version
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
local_damping = 0.7
elasticity = "explicit"
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
checkpoint_interval = 0.5
contacts = false
[[monitor]]
block = "b1"
[[monitor]]
block = "slider.1"
)";

inline const std::string small_scene = R"([run]
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

/// What the scene file can name without listing its blocks, and all a block may have.
inline const std::string many_sources = R"([run]
duration = 1
fidelity = "deformable"
[material.sand]
density = 1800
youngs_modulus = 1e8
poissons_ratio = 0
[joint.default]
normal_stiffness = 1e9
[[pyramid]]
material = "sand"
origin = [10, 0]
rows = 3
block_size = [0.4, 0.2]
gap = 0.01
[[block]]
name = "lever"
material = "sand"
vertices = [[0, 0], [3, 0], [3, 3], [2, 3], [2, 1], [0, 1]]
fixed_points = [[0, 0], [2.5, 2], [2, 1.0000000001]]
fidelity = "rigid"
[[block.load]]
point = [3, 3]
force = [0, -1e5]
[[block.load]]
point = [1, 0.5]
force = [2, 0]
[[block]]
name = "piston"
material = "sand"
vertices = [[0, 5], [1, 5], [1, 6], [0, 6]]
prescribed_velocity = [0, -0.1, 0.5]
[[wall]]
name = "east.wall"
material = "sand"
origin = [-10, 0]
rows = 2.0
columns = 4
block_size = [0.5, 0.25]
bond = 0.25
[[wall]]
material = "sand"
origin = [-20, 0]
rows = 1
columns = 1
block_size = [1, 1]
[blocks]
file = "sub/my \"blocks\".h5"
[[monitor]]
block = "east.wall.1.4"
[[monitor]]
name = "roof"
point = [0.5, 6]
[[monitor]]
block = "b21"
[[monitor]]
block = "pyramid0.2.0"
)";

inline std::vector<std::string> messages(const SceneReading &reading) {
  std::vector<std::string> result;
  for (const Diagnostic &diagnostic : reading.diagnostics) {
    result.push_back(to_string(diagnostic));
  }
  return result;
}

inline Scene good(const std::string &text, const Sets &sets = {}) {
  const SceneReading reading = read_scene(text, "folder/small.scene.toml", sets);
  EXPECT_EQ(messages(reading), std::vector<std::string>{});
  return reading.scene;
}

inline void expect_same(const Scene &a, const Scene &b) {
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
  EXPECT_EQ(a.run.local_damping, b.run.local_damping);
  EXPECT_EQ(a.run.elasticity, b.run.elasticity);
  EXPECT_EQ(a.run.plane_strain, b.run.plane_strain);
  EXPECT_EQ(a.output.interval, b.output.interval);
  EXPECT_EQ(a.output.history_interval, b.output.history_interval);
  EXPECT_EQ(a.output.checkpoint_interval, b.output.checkpoint_interval);
  EXPECT_EQ(a.output.contacts, b.output.contacts);
  EXPECT_EQ(a.reduction.from, b.reduction.from);
  EXPECT_EQ(a.reduction.to, b.reduction.to);
  EXPECT_EQ(a.reduction.tolerance, b.reduction.tolerance);
  EXPECT_EQ(a.reduction.failure_motion, b.reduction.failure_motion);
  EXPECT_EQ(a.reduction.local_damping, b.reduction.local_damping);
  EXPECT_EQ(a.ensemble.count, b.ensemble.count);
  EXPECT_EQ(a.ensemble.seed, b.ensemble.seed);
  EXPECT_EQ(a.ensemble.measure, b.ensemble.measure);
  EXPECT_EQ(a.ensemble.keep, b.ensemble.keep);
  EXPECT_EQ(a.earthquake.quantity, b.earthquake.quantity);
  EXPECT_EQ(a.earthquake.baseline, b.earthquake.baseline);
  EXPECT_EQ(a.earthquake.scale, b.earthquake.scale);
  EXPECT_EQ(a.earthquake.start, b.earthquake.start);
  ASSERT_EQ(a.water.size(), b.water.size());
  for (std::size_t i = 0; i < a.water.size(); ++i) {
    EXPECT_EQ(a.water[i].density, b.water[i].density);
    EXPECT_EQ(a.water[i].active, b.water[i].active);
  }
  EXPECT_EQ(a.supports, b.supports);
  ASSERT_EQ(a.bolts.size(), b.bolts.size());
  for (std::size_t i = 0; i < a.bolts.size(); ++i) {
    EXPECT_EQ(a.bolts[i].name, b.bolts[i].name);
    EXPECT_EQ(a.bolts[i].support, b.bolts[i].support);
    EXPECT_EQ(a.bolts[i].from, b.bolts[i].from);
    EXPECT_EQ(a.bolts[i].to, b.bolts[i].to);
    EXPECT_EQ(a.bolts[i].active, b.bolts[i].active);
  }
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
    EXPECT_EQ(a.joints.laws[i].has_bonds, b.joints.laws[i].has_bonds);
    EXPECT_EQ(a.joints.laws[i].tension, b.joints.laws[i].tension);
    EXPECT_EQ(a.joints.laws[i].residual_tan_friction, b.joints.laws[i].residual_tan_friction);
    EXPECT_EQ(a.joints.laws[i].residual_cohesion, b.joints.laws[i].residual_cohesion);
    EXPECT_EQ(a.joints.laws[i].tan_dilation, b.joints.laws[i].tan_dilation);
    EXPECT_EQ(a.joints.laws[i].dilation_limit, b.joints.laws[i].dilation_limit);
    EXPECT_EQ(a.joints.laws[i].is_barton_bandis, b.joints.laws[i].is_barton_bandis);
    EXPECT_EQ(a.joints.laws[i].roughness, b.joints.laws[i].roughness);
    EXPECT_EQ(a.joints.laws[i].strength, b.joints.laws[i].strength);
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
    EXPECT_EQ(a.blocks[i].edge_joint, b.blocks[i].edge_joint);
    EXPECT_EQ(a.blocks[i].velocity, b.blocks[i].velocity);
    EXPECT_EQ(a.blocks[i].fixed, b.blocks[i].fixed);
    EXPECT_EQ(a.blocks[i].driven, b.blocks[i].driven);
    EXPECT_EQ(a.blocks[i].velocity_table, b.blocks[i].velocity_table);
    EXPECT_EQ(a.blocks[i].fidelity, b.blocks[i].fidelity);
    EXPECT_EQ(a.blocks[i].fixed_points, b.blocks[i].fixed_points);
    ASSERT_EQ(a.blocks[i].loads.size(), b.blocks[i].loads.size());
    for (std::size_t k = 0; k < a.blocks[i].loads.size(); ++k) {
      EXPECT_EQ(a.blocks[i].loads[k].point, b.blocks[i].loads[k].point);
      EXPECT_EQ(a.blocks[i].loads[k].force, b.blocks[i].loads[k].force);
      EXPECT_EQ(a.blocks[i].loads[k].ramp, b.blocks[i].loads[k].ramp);
      EXPECT_EQ(a.blocks[i].loads[k].table, b.blocks[i].loads[k].table);
    }
  }
  const auto whole = [](const std::string &path) { // the resolved text names it by its absolute path
    return path.empty() ? path : std::filesystem::absolute(path).string();
  };
  EXPECT_EQ(whole(a.block_file.path), whole(b.block_file.path));
  ASSERT_EQ(a.generators.size(), b.generators.size());
  for (std::size_t i = 0; i < a.generators.size(); ++i) {
    EXPECT_EQ(a.generators[i].kind, b.generators[i].kind);
    EXPECT_EQ(a.generators[i].name, b.generators[i].name);
    EXPECT_EQ(a.generators[i].material, b.generators[i].material);
    EXPECT_EQ(a.generators[i].origin, b.generators[i].origin);
    EXPECT_EQ(a.generators[i].rows, b.generators[i].rows);
    EXPECT_EQ(a.generators[i].columns, b.generators[i].columns);
    EXPECT_EQ(a.generators[i].block_size, b.generators[i].block_size);
    EXPECT_EQ(a.generators[i].bond, b.generators[i].bond);
    EXPECT_EQ(a.generators[i].gap, b.generators[i].gap);
  }
  ASSERT_EQ(a.monitors.size(), b.monitors.size());
  for (std::size_t i = 0; i < a.monitors.size(); ++i) {
    EXPECT_EQ(a.monitors[i].name, b.monitors[i].name);
    EXPECT_EQ(a.monitors[i].block, b.monitors[i].block);
    EXPECT_EQ(a.monitors[i].is_point, b.monitors[i].is_point);
    EXPECT_EQ(a.monitors[i].point, b.monitors[i].point);
  }
}

} // namespace gcpdda::testing
