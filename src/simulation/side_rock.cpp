#include "simulation/side_rock.hpp"

#include "base/exact_sum.hpp"
#include "contact/stiffness_bound.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/polygon.hpp"
#include "model/fidelity.hpp"
#include "model/generators.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

struct JointSums {
  ExactSum area;
  std::array<ExactSum, 6> compliance; ///< times area
};

std::size_t place_of(std::int32_t material, bool is_deformable) {
  return 2 * static_cast<std::size_t>(material) + (is_deformable ? 1 : 0);
}

Vec2 edge_of(const SceneBlock &block, std::size_t edge) {
  return block.vertices[(edge + 1) % block.vertices.size()] - block.vertices[edge];
}

bool is_whole(const Scene &scene, const SceneBlock &block) {
  const double rounding = scene.earthquake.viscous.front().rounding;
  for (std::size_t k = 0; k < block.vertices.size(); ++k) {
    const Vec2 middle = block.vertices[k] + 0.5 * edge_of(block, k);
    if (distance_to_boundary(scene.region.outline, middle) <= rounding) {
      return false;
    }
  }
  return true;
}

bool deforms(const Scene &scene, const SceneBlock &block) {
  const double stiffness = stiffness_bound(scene.joints, block.material, block.edge_joint).normal;
  return choose_fidelity(block, signed_area(block.vertices),
                         scene.materials[static_cast<std::size_t>(block.material)], stiffness, scene.run)
             .kind == BlockKind::deformable;
}

/// The edge of a block that faces away from one of its edges.
std::size_t opposite(const SceneBlock &block, std::size_t edge) {
  std::size_t found = edge;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < block.vertices.size(); ++k) {
    const Vec2 other = edge_of(block, k);
    const double cosine = dot(other, edge_of(block, edge)) / norm(other);
    if (cosine < least) {
      least = cosine;
      found = k;
    }
  }
  return found;
}

} // namespace

SideRock::SideRock(const RunState &run, std::span<const SceneBlock> slab, std::int64_t first)
    : scene_(&run.scene), of_joints_(2 * run.scene.materials.size()) {
  const std::int64_t first_of_region = num_blocks(*scene_) - scene_->num_region_blocks;
  std::vector<JointSums> sums(of_joints_.size());
  for (std::size_t i = 0; i < slab.size(); ++i) {
    const SceneBlock &block = slab[i];
    if (block.fixed || block.driven || first + static_cast<std::int64_t>(i) < first_of_region ||
        !is_whole(*scene_, block)) {
      continue;
    }
    JointSums &sum = sums[place_of(block.material, deforms(*scene_, block))];
    sum.area.add(signed_area(block.vertices));
    for (std::size_t k = 0; k < block.vertices.size(); ++k) {
      const Compliance compliance = compliance_along(edge_of(block, k), stiffness_on(block, k));
      for (std::size_t c = 0; c < compliance.size(); ++c) {
        sum.compliance[c].add(compliance[c]);
      }
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    run.communicator.sum(sums[i].area.limbs());
    for (ExactSum &sum : sums[i].compliance) {
      run.communicator.sum(sum.limbs());
    }
    if (const double area = sums[i].area.value(); area > 0.0) {
      Compliance &mean = of_joints_[i].emplace();
      for (std::size_t c = 0; c < mean.size(); ++c) {
        mean[c] = sums[i].compliance[c].value() / area;
      }
    }
  }
}

// As two such blocks have it that meet with such edges (JointLaws::of_edges).
std::array<double, 2> SideRock::stiffness_on(const SceneBlock &block, std::size_t edge) const {
  const JointLaws &joints = scene_->joints;
  const std::int32_t named = block.edge_joint.empty() ? -1 : block.edge_joint[edge];
  const JointLaw &law = joints.laws[static_cast<std::size_t>(
      joints.of_edges(named, named, joints.between(block.material, block.material)))];
  return {law.normal_stiffness, law.tangential_ratio * law.normal_stiffness};
}

Impedance SideRock::beyond(const BlockSystem &blocks, std::size_t row, const SceneBlock &block,
                           std::size_t edge) const {
  const double density = scene_->materials[static_cast<std::size_t>(block.material)].density;
  const double area = blocks.properties[row].area;
  const double length = norm(edge_of(block, edge));
  const Deformation *rock = blocks.is_deformable(row) ? &blocks.deformation_of(row) : nullptr;
  const std::optional<Compliance> &joints = of_joints_[place_of(block.material, rock != nullptr)];
  Impedance impedance;
  if (joints) {
    Compliance compliance = *joints;
    if (rock != nullptr) {
      const Compliance own = compliance_of_rock(rock->stiffness_direct / area, rock->stiffness_cross / area,
                                                rock->stiffness_shear / area);
      for (std::size_t c = 0; c < compliance.size(); ++c) {
        compliance[c] += own[c];
      }
    }
    const auto [direct, shear] = wave_moduli(compliance, (1.0 / length) * perp(edge_of(block, edge)));
    impedance = {std::sqrt(density * direct), std::sqrt(density * shear)};
  } else {
    const std::array<double, 2> moduli =
        rock != nullptr ? std::array{rock->stiffness_direct / area, rock->stiffness_shear / area}
                        : std::array{0.0, 0.0};
    impedance = impedance_of(density, moduli, stiffness_on(block, opposite(block, edge)), area / length);
  }
  const Earthquake &earthquake = scene_->earthquake;
  return {earthquake.p_wave_speed > 0.0 ? density * earthquake.p_wave_speed : impedance.normal,
          earthquake.s_wave_speed > 0.0 ? density * earthquake.s_wave_speed : impedance.tangential};
}

} // namespace gcpdda
