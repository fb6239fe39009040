#include "driver/safety_bound.hpp"

#include "contact/contact_sums.hpp"
#include "driver/safety_search.hpp"
#include "limit_analysis/limit_analysis.hpp"
#include "simulation/evaluation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

namespace gcpdda {

namespace {

/// A region and what it does to its blocks; ids of blocks in place of their numbers.
struct LimitRegion {
  LimitJoint joint;
  std::array<Vec2, 2> force;
  std::array<double, 2> torque;
};

struct OwnedBlock {
  std::int64_t id;
  LimitBlock block;
};

LimitJoint joint_of(const Simulation &settled, const RegionForce &region, const RegionState &memory,
                    const CandidatePair &pair) {
  const Scene &scene = settled.scene();
  const std::int32_t number = scene.joints.named(memory.law >= 0 ? memory.law : pair.law);
  const JointLaw &law = scene.joints.laws[static_cast<std::size_t>(number)];
  const double length = region.extent_end - region.extent_begin;
  const Vec2 along = perp(region.normal);
  const bool is_residual = law.has_bonds && !region.bonded;
  LimitJoint joint;
  joint.begin = region.point + region.extent_begin * along;
  joint.end = region.point + region.extent_end * along;
  joint.normal =
      region.normal_force * dot(region.force, region.normal) >= 0.0 ? region.normal : -1.0 * region.normal;
  joint.tan_friction = law.is_barton_bandis
                           ? law.tan_friction_at(std::abs(region.normal_force) / std::max(length, 1e-300))
                       : is_residual ? law.residual_tan_friction
                                     : law.tan_friction;
  joint.cohesion = length * (is_residual ? law.residual_cohesion : law.cohesion);
  joint.tension = region.bonded ? length * law.tension : 0.0;
  joint.is_weakened = is_weakened(scene.reduction, static_cast<std::size_t>(number));
  return joint;
}

std::vector<LimitRegion> regions_of(Simulation &settled) {
  std::vector<LimitRegion> found;
  const BlockSystem &blocks = settled.blocks();
  const auto add = [&](std::uint32_t number, std::span<const RegionForce> regions) {
    const CandidatePair &pair = settled.candidates().pairs[number];
    if (!settled.counts_here(pair)) {
      return;
    }
    const std::array<std::size_t, 2> rows{pair.lower.value, pair.higher.value};
    for (std::size_t k = 0; k < regions.size(); ++k) {
      LimitRegion region{joint_of(settled, regions[k], settled.history().state(number, k), pair), {}, {}};
      for (std::size_t side = 0; side < 2; ++side) {
        const BlockProperties &block = blocks.properties[rows[side]];
        (side == 0 ? region.joint.first : region.joint.second) =
            block.keeps_its_velocity() ? -1 : block.id.value;
        const ContactPart part = contact_part(regions[k], side == 0, blocks.motion[rows[side]].centroid);
        region.force[side] = part.force;
        region.torque[side] = part.dyad.xy - part.dyad.yx;
      }
      found.push_back(region);
    }
  };
  for_regions(settled.state(), 0, settled.candidates().pairs.size(), add);
  return found;
}

template <class T> std::vector<T> gathered(const Communicator &communicator, const std::vector<T> &mine) {
  std::vector<T> all;
  for (const std::vector<T> &part : communicator.all_gather(mine)) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

} // namespace

std::optional<double> bound_at(Simulation &settled, double settled_factor) {
  evaluate_still(settled.state());
  std::vector<OwnedBlock> mine;
  for (std::size_t row = 0; row < settled.blocks().num_owned; ++row) {
    const BlockProperties &block = settled.blocks().properties[row];
    if (!block.keeps_its_velocity()) {
      mine.push_back(
          {block.id.value, {settled.blocks().motion[row].centroid, std::sqrt(block.area), {}, 0.0}});
    }
  }
  const Communicator &communicator = settled.communicator();
  std::vector<OwnedBlock> owned = gathered(communicator, mine);
  std::vector<LimitRegion> regions = gathered(communicator, regions_of(settled));
  std::sort(owned.begin(), owned.end(), [](const OwnedBlock &a, const OwnedBlock &b) { return a.id < b.id; });
  std::sort(regions.begin(), regions.end(),
            [](const LimitRegion &a, const LimitRegion &b) { // on any number of ranks
              return std::tuple(a.joint.first, a.joint.second, a.joint.begin.x, a.joint.begin.y) <
                     std::tuple(b.joint.first, b.joint.second, b.joint.begin.x, b.joint.begin.y);
            });
  const auto number_of = [&](std::int64_t id) {
    const auto found =
        std::lower_bound(owned.begin(), owned.end(), id,
                         [](const OwnedBlock &block, std::int64_t key) { return block.id < key; });
    return id < 0 ? std::int64_t{-1} : std::int64_t{found - owned.begin()};
  };
  std::vector<LimitBlock> blocks;
  for (const OwnedBlock &block : owned) {
    blocks.push_back(block.block);
  }
  std::vector<LimitJoint> joints;
  for (const LimitRegion &region : regions) {
    LimitJoint joint = region.joint;
    joint.first = number_of(region.joint.first);
    joint.second = number_of(region.joint.second);
    const std::array<std::int64_t, 2> ends{joint.first, joint.second};
    for (std::size_t side = 0; side < 2; ++side) {
      if (ends[side] >= 0) { // in equilibrium: the rest of the load is what its contacts balance
        LimitBlock &block = blocks[static_cast<std::size_t>(ends[side])];
        block.load = block.load - region.force[side];
        block.torque -= region.torque[side];
      }
    }
    joints.push_back(joint);
  }
  const StrengthReduction &reduction = settled.scene().reduction;
  const std::optional<double> further =
      bound_of_factor(blocks, joints, reduction.from / settled_factor, reduction.to / settled_factor, 1e-3);
  return further ? std::optional(settled_factor * *further) : std::nullopt;
}

} // namespace gcpdda
