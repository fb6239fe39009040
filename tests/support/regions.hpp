#pragma once

// Regions of rock and their joints, for tests.

#include "blockgen/region_cutter.hpp"
#include "geometry/polygon.hpp"

#include <memory>
#include <numbers>
#include <vector>

namespace gcpdda::testing {

inline constexpr double per_degree = std::numbers::pi / 180.0;

/// Rock without joints, with laws "default" (0), "one" (1) and "two" (2).
inline Scene region_scene(std::vector<Vec2> outline) {
  Scene scene;
  scene.stem = "region";
  scene.materials = {{"rock", 2600.0, 0.0, 0.0}, {"clay", 2000.0, 0.0, 0.0}};
  for (const char *name : {"default", "one", "two"}) {
    JointLaw law;
    law.name = name;
    law.normal_stiffness = 1e8;
    law.tan_friction = 0.6;
    scene.joints.laws.push_back(law);
  }
  scene.joints.num_materials = 2;
  scene.joints.of_material = {0, 0, 0, 0};
  scene.region.outline = std::move(outline);
  scene.region.max_blocks = 1'000'000;
  scene.region.fixed_thickness = 1.0;
  return scene;
}

inline std::vector<Vec2> rectangle_of(double width, double height) {
  return {{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}};
}

inline JointSet through_going(double dip_deg, double spacing, std::int32_t joint, Vec2 origin = {}) {
  JointSet set;
  set.dip.mean = dip_deg * per_degree;
  set.spacing.mean = spacing;
  set.joint = joint;
  set.origin = origin;
  return set;
}

/// Two scattered sets of joints that end, on a slope with a tunnel: a bit of everything.
inline Scene jointed_slope() {
  Scene scene = region_scene({{0.0, 0.0}, {40.0, 0.0}, {40.0, 24.0}, {22.0, 24.0}, {12.0, 8.0}, {0.0, 8.0}});
  JointSet bedding = through_going(20.0, 1.1, 1, {0.3, 0.2});
  bedding.dip.spread = Spread::fisher;
  bedding.dip.width = 800.0;
  bedding.spacing.spread = Spread::lognormal;
  bedding.spacing.width = 0.3;
  JointSet cross = through_going(105.0, 1.3, 2);
  cross.spacing.spread = Spread::exponential;
  cross.through_going = false;
  cross.trace.mean = 5.0;
  cross.trace.spread = Spread::lognormal;
  cross.trace.width = 2.0;
  cross.gap.mean = 1.5;
  cross.gap.spread = Spread::exponential;
  scene.region.joint_sets = {bedding, cross};
  scene.region.min_width = 0.05;
  scene.region.min_area = 0.0025;
  Opening tunnel;
  tunnel.name = "tunnel";
  tunnel.outline = {{18.0, 4.0}, {23.0, 4.0}, {23.0, 7.0}, {20.5, 9.0}, {18.0, 7.0}};
  scene.region.openings = {tunnel};
  scene.region.fixed = {true, true, true, false};
  return scene;
}

inline std::vector<SceneBlock> all_blocks(const Scene &scene) {
  const RegionCutter cutter(scene);
  return cutter.make(0, cutter.num_tiles()).blocks;
}

inline double total_area(const std::vector<SceneBlock> &blocks) {
  double area = 0.0;
  for (const SceneBlock &block : blocks) {
    area += block.fixed ? 0.0 : signed_area(block.vertices);
  }
  return area;
}

inline bool same(const SceneBlock &a, const SceneBlock &b) {
  return a.vertices == b.vertices && a.edge_joint == b.edge_joint && a.material == b.material &&
         a.opening == b.opening && a.fixed == b.fixed;
}

} // namespace gcpdda::testing
