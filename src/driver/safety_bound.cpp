#include "driver/safety_bound.hpp"

#include "contact/contact_sums.hpp"
#include "contact/laws/region_law.hpp"
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

/// A joint and what it does to its blocks as they lie; ids of blocks in place of their numbers.
struct LimitRegion {
  LimitJoint joint;
  double cohesion = 0.0; ///< Pa
  std::array<Vec2, 2> force{};
  std::array<double, 2> torque{};
};

struct OwnedBlock {
  std::int64_t id;
  LimitBlock block;
};

LimitRegion closed_joint(const Simulation &settled, const RegionForce &region, const RegionState &memory,
                         const CandidatePair &pair) {
  const Scene &scene = settled.scene();
  const std::int32_t number = scene.joints.named(memory.law >= 0 ? memory.law : pair.law);
  const JointLaw &law = scene.joints.laws[static_cast<std::size_t>(number)];
  const double length = region.extent_end - region.extent_begin;
  const Vec2 along = perp(region.normal);
  const bool is_residual = law.has_bonds && !region.bonded;
  LimitRegion found;
  LimitJoint &joint = found.joint;
  joint.begin = region.point + region.extent_begin * along;
  joint.end = region.point + region.extent_end * along;
  joint.normal =
      region.normal_force * dot(region.force, region.normal) >= 0.0 ? region.normal : -1.0 * region.normal;
  joint.tan_friction = law.is_barton_bandis
                           ? law.tan_friction_at(std::abs(region.normal_force) / std::max(length, 1e-300))
                       : is_residual ? law.residual_tan_friction
                                     : law.tan_friction;
  joint.tension = region.bonded ? length * law.tension : 0.0;
  joint.is_weakened = is_weakened(scene.reduction, static_cast<std::size_t>(number));
  found.cohesion = is_residual ? law.residual_cohesion : law.cohesion;
  return found;
}

/// A joint that is open and may close at a point.
LimitRegion open_joint(const Simulation &settled, std::int32_t law_number, Vec2 normal, Vec2 point) {
  const Scene &scene = settled.scene();
  const std::int32_t number = scene.joints.named(law_number);
  const JointLaw &law = scene.joints.laws[static_cast<std::size_t>(number)];
  LimitRegion found;
  found.joint.begin = point;
  found.joint.end = point;
  found.joint.normal = normal;
  found.joint.tan_friction = law.is_barton_bandis ? law.tan_friction_at(0.0)
                             : law.has_bonds      ? law.residual_tan_friction
                                                  : law.tan_friction;
  found.joint.is_weakened = is_weakened(scene.reduction, static_cast<std::size_t>(number));
  found.cohesion = law.has_bonds ? law.residual_cohesion : law.cohesion;
  return found;
}

/// Let a joint reach along its line to where a point lies beside it.
void extend(LimitJoint &joint, Vec2 point) {
  const Vec2 along = perp(joint.normal);
  Vec2 &low = dot(joint.end - joint.begin, along) >= 0.0 ? joint.begin : joint.end;
  Vec2 &high = &low == &joint.begin ? joint.end : joint.begin;
  const double before = dot(point - low, along);
  const double behind = dot(point - high, along);
  if (before < 0.0) {
    low = low + before * along;
  } else if (behind > 0.0) {
    high = high + behind * along;
  }
}

/// Where corners of the blocks of a pair stand before edges of each other, their joint may close.
/// @param reach  the farthest of them, m
/// @param joints  of the pair, those that are closed at first
void add_open_joints(const Simulation &settled, const CandidatePair &pair, double reach,
                     std::vector<LimitRegion> &joints) {
  constexpr double same_line = 0.98; // cosine
  const BlockSystem &blocks = settled.blocks();
  const std::array<TrialOutline, 2> outlines{TrialOutline(blocks, pair.lower.value),
                                             TrialOutline(blocks, pair.higher.value)};
  for (std::size_t side = 0; side < 2; ++side) {
    const TrialOutline &corners = outlines[side];
    const TrialOutline &edges = outlines[1 - side];
    for (std::size_t k = 0; k < edges.vertex.size(); ++k) {
      const Vec2 out = edges.normal[k];
      const Vec2 normal = side == 0 ? out : -1.0 * out; // of pressure on the lower block
      for (std::size_t corner = 0; corner < corners.vertex.size(); ++corner) {
        const Vec2 from_edge = corners.vertex[corner] - edges.vertex[k];
        const double gap = dot(from_edge, out);
        const double place = dot(from_edge, perp(out));
        if (gap <= 0.0 || gap > reach || place < 0.0 || place > edges.length[k]) {
          continue;
        }
        const auto known = std::find_if(joints.begin(), joints.end(), [&](const LimitRegion &joint) {
          return dot(joint.joint.normal, normal) > same_line;
        });
        if (known != joints.end()) {
          extend(known->joint, corners.vertex[corner]);
          continue;
        }
        const auto edge = static_cast<std::int32_t>(k);
        const auto other = static_cast<std::int32_t>(corner);
        const std::int32_t law = pair.is_mixed
                                     ? law_of_edges(blocks, settled.scene().joints, pair,
                                                    side == 0 ? other : edge, side == 0 ? edge : other)
                                     : pair.law;
        joints.push_back(open_joint(settled, law, normal, corners.vertex[corner]));
      }
    }
  }
}

std::vector<LimitRegion> regions_of(Simulation &settled) {
  std::vector<std::vector<LimitRegion>> of_pair(settled.candidates().pairs.size());
  const BlockSystem &blocks = settled.blocks();
  const auto add = [&](std::uint32_t number, std::span<const RegionForce> regions) {
    const CandidatePair &pair = settled.candidates().pairs[number];
    const std::array<std::size_t, 2> rows{pair.lower.value, pair.higher.value};
    for (std::size_t k = 0; k < regions.size(); ++k) {
      LimitRegion region = closed_joint(settled, regions[k], settled.history().state(number, k), pair);
      for (std::size_t side = 0; side < 2; ++side) {
        const ContactPart part = contact_part(regions[k], side == 0, blocks.motion[rows[side]].centroid);
        region.force[side] = part.force;
        region.torque[side] = part.dyad.xy - part.dyad.yx;
      }
      of_pair[number].push_back(region);
    }
  };
  for_regions(settled.state(), 0, settled.candidates().pairs.size(), add);
  std::vector<LimitRegion> found;
  for (std::size_t number = 0; number < of_pair.size(); ++number) {
    const CandidatePair &pair = settled.candidates().pairs[number];
    if (!settled.counts_here(pair)) {
      continue;
    }
    add_open_joints(settled, pair, settled.state().neighbours.base_skin, of_pair[number]);
    const auto id_of = [&](BlockIndex row) {
      const BlockProperties &block = blocks.properties[row.value];
      return block.keeps_its_velocity() ? std::int64_t{-1} : std::int64_t{block.id.value};
    };
    for (LimitRegion &region : of_pair[number]) {
      region.joint.first = id_of(pair.lower);
      region.joint.second = id_of(pair.higher);
      region.joint.cohesion = region.cohesion * norm(region.joint.end - region.joint.begin);
      found.push_back(region);
    }
  }
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
