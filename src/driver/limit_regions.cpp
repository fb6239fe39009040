#include "driver/limit_regions.hpp"

#include "contact/contact_sums.hpp"
#include "contact/laws/region_law.hpp"
#include "driver/safety_search.hpp"
#include "simulation/evaluation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace gcpdda {

namespace {

/// A line above the strength of a law by Barton and Bandis, which grows less and less with the pressure: the
/// one that touches it at a pressure.
struct StrengthLine {
  double tan_friction = 0.0;
  double cohesion = 0.0; ///< Pa
};
StrengthLine strength_line(const JointLaw &law, double pressure) {
  if (!(pressure > 0.0)) {
    return {law.tan_friction_at(0.0), 0.0};
  }
  const auto strength = [&](double p) { return p * law.tan_friction_at(p); };
  const double step = 1e-4 * pressure;
  const double slope = (strength(pressure + step) - strength(pressure - step)) / (2.0 * step);
  return {slope, std::max(0.0, strength(pressure) - slope * pressure)};
}

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
  joint.tan_friction = is_residual ? law.residual_tan_friction : law.tan_friction;
  joint.tension = region.bonded ? length * law.tension : 0.0;
  found.is_bond = region.bonded;
  joint.is_weakened = is_weakened(scene.reduction, static_cast<std::size_t>(number));
  found.cohesion = is_residual ? law.residual_cohesion : law.cohesion;
  if (law.is_barton_bandis) {
    const StrengthLine line = strength_line(law, length > 0.0 ? std::abs(region.normal_force) / length : 0.0);
    joint.tan_friction = line.tan_friction;
    found.cohesion = line.cohesion;
  }
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

constexpr double same_line = 0.98; // cosine

/// Where points lie along a joint, smaller first, m.
std::pair<double, double> places_on(const LimitJoint &joint, Vec2 one, Vec2 other) {
  const Vec2 along = perp(joint.normal);
  return std::minmax({dot(one - joint.begin, along), dot(other - joint.begin, along)});
}

/// The length of a joint that lies on another one of the same pair, m.
double common_length(const LimitJoint &joint, const LimitJoint &other) {
  if (dot(joint.normal, other.normal) < same_line) {
    return 0.0;
  }
  const auto [low, high] = places_on(joint, joint.begin, joint.end);
  const auto [from, to] = places_on(joint, other.begin, other.end);
  return std::max(0.0, std::min(high, to) - std::max(low, from));
}

/// Whether a point lies beside a joint and not beyond its ends.
bool is_beside(const LimitJoint &joint, Vec2 point) {
  const auto [low, high] = places_on(joint, joint.begin, joint.end);
  const double place = dot(point - joint.begin, perp(joint.normal));
  return place >= low && place <= high;
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

/// Whether a corner may come to lie on an edge that faces `out`: its block is on the other side, but for
/// turns of both.
bool may_lie_on(const TrialOutline &outline, std::size_t corner, Vec2 out, double turn) {
  const std::size_t before = (corner + outline.vertex.size() - 1) % outline.vertex.size();
  const Vec2 ahead = perp(outline.normal[corner]); // along the edge that begins at the corner
  const Vec2 back = -1.0 * perp(outline.normal[before]);
  return std::min(dot(ahead, out), dot(back, out)) >= -turn;
}

/// How far the blocks of a pair move until they have failed.
struct Motion {
  double reach = 0.0; ///< of one of both, m
  double turn = 0.0;  ///< of both, rad
};

/// @param slip  of each block, in sizes of it
Motion motion_of(const BlockSystem &blocks, const CandidatePair &pair, double slip) {
  Motion motion;
  for (const BlockIndex row : {pair.lower, pair.higher}) {
    const BlockProperties &block = blocks.properties[row.value];
    const double reach = slip * size_of_mobile(block);
    motion.reach = std::max(motion.reach, reach);
    motion.turn += reach / block.radius;
  }
  return motion;
}

/// Where a corner stands at an edge.
enum class Standing { away, before, at_end };

/// Before it or before what lies beside its ends; or at an end, on either side of its line: where two corners
/// meet they push along the normal of any of their edges.
Standing standing_of(const TrialOutline &edges, std::size_t edge, Vec2 corner, double reach) {
  const Vec2 from_edge = corner - edges.vertex[edge];
  const double gap = dot(from_edge, edges.normal[edge]);
  const double place = dot(from_edge, perp(edges.normal[edge]));
  const double length = edges.length[edge];
  if (std::abs(gap) > reach || place < -reach || place > length + reach) {
    return Standing::away;
  }
  const bool is_at_end = place < reach || place > length - reach;
  return gap > 0.0 ? Standing::before : is_at_end ? Standing::at_end : Standing::away;
}

/// A joint that may close where a corner comes to lie on an edge, as strong as with either edge at the
/// corner.
LimitRegion joint_of_corner(const Simulation &settled, const CandidatePair &pair, std::size_t side,
                            std::size_t edge, const TrialOutline &corners, std::size_t corner, Vec2 normal) {
  const auto with = [&](std::size_t own) {
    const auto lower = static_cast<std::int32_t>(side == 0 ? own : edge);
    const auto higher = static_cast<std::int32_t>(side == 0 ? edge : own);
    const std::int32_t law = pair.is_mixed
                                 ? law_of_edges(settled.blocks(), settled.scene().joints, pair, lower, higher)
                                 : pair.law;
    return open_joint(settled, law, normal, corners.vertex[corner]);
  };
  LimitRegion found = with(corner);
  const LimitRegion other = with((corner + corners.vertex.size() - 1) % corners.vertex.size());
  found.joint.tan_friction = std::max(found.joint.tan_friction, other.joint.tan_friction);
  found.cohesion = std::max(found.cohesion, other.cohesion);
  found.joint.is_weakened = found.joint.is_weakened && other.joint.is_weakened;
  return found;
}

/// Where corners of the blocks of a pair stand before edges of each other, or beside the ends of them, their
/// joint may close. A bond keeps its length: its tension acts on no more of the side than it glues.
/// @param motion  the farthest that a corner is from an edge and from its ends, and that it turns
/// @param joints  of the pair, those that are closed at first
void add_open_joints(const Simulation &settled, const CandidatePair &pair, const Motion &motion,
                     std::vector<LimitRegion> &joints) {
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
        const Standing standing = standing_of(edges, k, corners.vertex[corner], motion.reach);
        if (standing == Standing::away || !may_lie_on(corners, corner, out, motion.turn)) {
          continue;
        }
        const Vec2 point = corners.vertex[corner];
        const auto on_line = [&](const LimitRegion &region) {
          return dot(region.joint.normal, normal) > same_line;
        };
        if (std::any_of(joints.begin(), joints.end(), [&](const LimitRegion &region) {
              return region.is_bond && on_line(region) && is_beside(region.joint, point);
            })) {
          continue;
        }
        const auto known = std::find_if(joints.begin(), joints.end(), [&](const LimitRegion &region) {
          return !region.is_bond && on_line(region);
        });
        if (known == joints.end()) {
          joints.push_back(joint_of_corner(settled, pair, side, k, corners, corner, normal));
        } else if (standing == Standing::before) {
          extend(known->joint, point);
        }
      }
    }
  }
}

} // namespace

double size_of_mobile(const BlockProperties &block) {
  return block.keeps_its_velocity() ? 0.0 : std::sqrt(block.area);
}

std::vector<LimitRegion> limit_regions(Simulation &settled, double slip) {
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
    add_open_joints(settled, pair, motion_of(blocks, pair, slip), of_pair[number]);
    const auto id_of = [&](BlockIndex row) {
      const BlockProperties &block = blocks.properties[row.value];
      return block.keeps_its_velocity() ? std::int64_t{-1} : std::int64_t{block.id.value};
    };
    for (LimitRegion &region : of_pair[number]) {
      for (const LimitRegion &other : of_pair[number]) {
        region.bonded += other.is_bond && !region.is_bond ? common_length(region.joint, other.joint) : 0.0;
      }
      region.joint.first = id_of(pair.lower);
      region.joint.second = id_of(pair.higher);
      const double length = norm(region.joint.end - region.joint.begin);
      region.joint.cohesion = region.cohesion * std::max(0.0, length - region.bonded);
      found.push_back(region);
    }
  }
  return found;
}

} // namespace gcpdda
