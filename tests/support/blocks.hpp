#pragma once

// Blocks without a scene, for tests of single modules.

#include "contact/contact_forces.hpp"
#include "contact_regions.hpp"
#include "memories.hpp"
#include "model/block_system.hpp"
#include "shapes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace gcpdda::testing {

/// Mobile blocks and then fixed ones as rows of one rank, ids in this order, posed at rest.
inline BlockSystem system_of(
    const std::vector<std::vector<Vec2>> &mobile, const std::vector<std::vector<Vec2>> &fixed,
    double density = 1000.0, bool (*is_deformable)(std::size_t) = [](std::size_t) { return false; }) {
  BlockSystem system;
  Material material;
  material.density = density;
  material.youngs_modulus = 1e9;
  for (const auto *blocks : {&mobile, &fixed}) {
    for (const std::vector<Vec2> &vertices : *blocks) {
      SceneBlock block;
      block.vertices = vertices;
      block.fixed = blocks == &fixed;
      append_block(system, BlockId{static_cast<std::int64_t>(system.num_rows())}, block, material,
                   block.fixed                        ? BlockKind::fixed
                   : is_deformable(system.num_rows()) ? BlockKind::deformable
                                                      : BlockKind::rigid);
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

/// Blocks may move anywhere.
constexpr double infinite_skin = std::numeric_limits<double>::infinity();

/// The same blocks with laws on their edges; none for a row without.
inline BlockSystem with_edges(BlockSystem system, const std::vector<std::vector<std::int32_t>> &edge_joint) {
  BlockSystem result;
  for (std::size_t row = 0; row < system.num_rows(); ++row) {
    append_row(result, system, row);
    result.properties.back().has_edge_joints = !edge_joint[row].empty();
    result.edge_joint.resize(result.reference_vertex.size() - edge_joint[row].size(), -1);
    result.edge_joint.insert(result.edge_joint.end(), edge_joint[row].begin(), edge_joint[row].end());
  }
  result.num_owned = system.num_owned;
  result.num_fixed = system.num_fixed;
  pose(result, 0, result.num_rows());
  return result;
}

/// Pairs of a small system and their forces, configuration by configuration.
struct ContactBench {
  BlockSystem system;
  ContactForces forces;
  ContactHistory history;
  Candidates candidates;
  // Trial configurations at the last evaluation, of mobile rows and by entry of BlockSystem::deformation.
  std::vector<RigidDof> moved_on;
  std::vector<Mat2> stretched_on;

  /// @param reach  how far apart the boxes of a pair may be at first, m
  ContactBench(BlockSystem blocks, JointLaws joints, double damping_ratio = 0.0,
               Instructions instructions = Instructions::widest,
               double reach = std::numeric_limits<double>::infinity())
      : system(std::move(blocks)),
        forces({std::move(joints), damping_ratio, PotentialKind::exact}, instructions) {
    std::vector<std::pair<BlockIndex, BlockIndex>> pairs;
    for (std::uint32_t i = 0; i < system.num_rows(); ++i) {
      for (std::uint32_t j = i + 1; j < system.num_rows(); ++j) {
        if (i < system.num_owned && system.motion[i].box.inflated(reach).meets(system.motion[j].box)) {
          pairs.emplace_back(BlockIndex{i}, BlockIndex{j});
        }
      }
    }
    candidates = make_candidates(system, pairs, forces.parameters(), {}, history, infinite_skin);
    moved_on.resize(system.first_fixed());
    for (const Deformation &d : system.deformation) {
      stretched_on.push_back(d.trial);
    }
  }

  /// What evaluate() saw of the first region.
  struct Seen : RegionForce {
    bool touching = false;
  };

  /// Forces at the present trial configuration; the last one becomes the previous one.
  const Seen &evaluate() {
    pose(system, 0, system.num_rows());
    for (std::size_t row = 0; row < system.first_fixed(); ++row) {
      const RigidDof trial = std::exchange(system.trial[row], moved_on[row]);
      Mat2 gradient;
      if (system.is_deformable(row)) {
        gradient =
            std::exchange(system.deformation_of(row).trial, stretched_on[system.deformation_begin[row]]);
      }
      set_trial(system, row, {trial, gradient});
    }
    report = forces.evaluate(system, candidates, history);
    regions = Regions(system, candidates, history, forces);
    for (std::size_t row = 0; row < system.first_fixed(); ++row) {
      moved_on[row] = system.trial[row];
      if (system.is_deformable(row)) {
        stretched_on[system.deformation_begin[row]] = system.deformation_of(row).trial;
      }
    }
    seen = {};
    if (!regions.all().empty()) {
      static_cast<RegionForce &>(seen) = regions.all().front();
      seen.touching = true;
    }
    return seen;
  }
  /// Move one row's trial configuration and evaluate.
  const Seen &move(std::size_t row, RigidDof by) {
    system.trial[row] += by;
    return evaluate();
  }
  [[nodiscard]] RegionMemory memory() const { return memories(history).front(); }

  ForceReport report;
  Regions regions;
  Seen seen;
};

/// But for the numbers of their pairs.
inline void expect_same_bits(const RegionForce &a, const RegionForce &b) {
  const auto sums = [](const RegionForce &f) {
    return std::tie(f.force, f.torque, f.shear_force, f.shear_torque, f.damping_force, f.damping_torque);
  };
  const auto place = [](const RegionForce &f) {
    return std::tie(f.dyad, f.origin, f.point, f.grip, f.normal, f.extent_begin, f.extent_end);
  };
  const auto sizes = [](const RegionForce &f) {
    return std::tie(f.normal_force, f.shear, f.cap, f.overlap, f.born, f.normal_undefined);
  };
  EXPECT_EQ(sums(a), sums(b));
  EXPECT_EQ(place(a), place(b));
  EXPECT_EQ(sizes(a), sizes(b));
}

} // namespace gcpdda::testing
