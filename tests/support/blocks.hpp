#pragma once

// Blocks without a scene, for tests of single modules.

#include "gcpdda/contact/contact_forces.hpp"
#include "gcpdda/contact/overlap.hpp"
#include "gcpdda/model/block_system.hpp"

#include <random>
#include <utility>
#include <vector>

namespace gcpdda::testing {

/// A convex polygon that owns what a ConvexView looks at; normals and lengths from its edges.
struct Shape {
  std::vector<Vec2> vertex;
  std::vector<Vec2> normal;
  std::vector<double> length;

  [[nodiscard]] ConvexView view() const { return {vertex, normal, length, bounding_box(vertex)}; }
};

inline Shape shape_of(std::vector<Vec2> vertices) {
  Shape shape;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 edge = vertices[(i + 1) % vertices.size()] - vertices[i];
    const double length = norm(edge);
    shape.normal.push_back({edge.y / length, -edge.x / length});
    shape.length.push_back(length);
  }
  shape.vertex = std::move(vertices);
  return shape;
}

/// The same block at another place, its normals turned, not recomputed.
inline Shape moved(const Shape &shape, double angle, Vec2 about, Vec2 by) {
  Shape result = shape;
  const Rotation turn = Rotation::of(angle);
  for (Vec2 &v : result.vertex) {
    v = about + by + turn(v - about);
  }
  for (Vec2 &n : result.normal) {
    n = turn(n);
  }
  return result;
}

/// Contact integrals of two blocks for k_n/2 = 1; zero where they do not meet.
inline RegionIntegrals contact_of(const Shape &first, const Shape &second,
                                  PotentialKind potential = PotentialKind::exact) {
  Overlap overlap;
  return overlap.find(first.view(), second.view(), potential) ? overlap.integrate() : RegionIntegrals{};
}

/// Torque of the force on the first block.
inline double torque_about(const RegionIntegrals &region, Vec2 point) {
  return region.dyad[1] - region.dyad[2] + cross(region.origin - point, region.force);
}

/// The standard distributions differ between libraries; the engine does not.
inline double uniform(std::mt19937 &engine, double low, double high) {
  return low + (high - low) * (static_cast<double>(engine()) / 4294967296.0);
}

/// Mobile blocks and then fixed ones as rows of one rank, ids in this order, posed at rest.
inline BlockSystem system_of(const std::vector<std::vector<Vec2>> &mobile,
                             const std::vector<std::vector<Vec2>> &fixed, double density = 1000.0) {
  BlockSystem system;
  Material material;
  material.density = density;
  for (const auto *blocks : {&mobile, &fixed}) {
    for (const std::vector<Vec2> &vertices : *blocks) {
      SceneBlock block;
      block.vertices = vertices;
      block.fixed = blocks == &fixed;
      append_block(system, BlockId{static_cast<std::int64_t>(system.num_rows())}, block, material);
    }
  }
  system.num_owned = mobile.size();
  system.num_fixed = fixed.size();
  pose(system, 0, system.num_rows());
  return system;
}

/// One law for one material.
inline JointLaws one_law(double normal_stiffness, double tan_friction = 0.0, double cohesion = 0.0,
                         double tangential_ratio = 0.5) {
  JointLaw law;
  law.name = "default";
  law.normal_stiffness = normal_stiffness;
  law.tangential_ratio = tangential_ratio;
  law.tan_friction = tan_friction;
  law.cohesion = cohesion;
  return {{law}, {0}, 1};
}

/// All pairs of a small system and their forces, configuration by configuration.
struct ContactBench {
  BlockSystem system;
  ContactForces forces;
  ContactHistory history;
  Candidates candidates;

  ContactBench(BlockSystem blocks, JointLaws joints, double damping_ratio = 0.0)
      : system(std::move(blocks)), forces({std::move(joints), damping_ratio, PotentialKind::exact}) {
    std::vector<std::pair<BlockIndex, BlockIndex>> pairs;
    for (std::uint32_t i = 0; i < system.num_rows(); ++i) {
      for (std::uint32_t j = i + 1; j < system.num_rows(); ++j) {
        if (!system.is_fixed(i)) {
          pairs.emplace_back(BlockIndex{i}, BlockIndex{j});
        }
      }
    }
    candidates = make_candidates(system, pairs, forces.parameters(), {}, history);
  }

  /// Forces at the present trial configuration; the last one becomes the previous one.
  const PairForce &evaluate() {
    pose(system, 0, system.num_rows());
    report = forces.evaluate(system, candidates, history);
    for (std::size_t row = 0; row < system.num_owned; ++row) {
      system.trial_previous[row] = system.trial[row];
    }
    return forces.pairs().front();
  }
  /// Move one row's trial configuration and evaluate.
  const PairForce &move(std::size_t row, RigidDof by) {
    system.trial[row] += by;
    return evaluate();
  }
  [[nodiscard]] const RegionMemory &memory() const { return history.regions.front(); }

  ForceReport report;
};

} // namespace gcpdda::testing
