#include "limit_analysis/limit_regions.hpp"

#include "contact/contact_sums.hpp"
#include "contact/laws/region_law.hpp"
#include "simulation/evaluation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
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
  found.law = number;
  found.is_bond = region.bonded;
  joint.is_weakened = scene.reduction.weakens(static_cast<std::size_t>(number));
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
  found.law = number;
  found.is_open = true;
  found.joint.begin = point;
  found.joint.end = point;
  found.joint.normal = normal;
  found.joint.tan_friction = law.is_barton_bandis ? law.tan_friction_at(0.0)
                             : law.has_bonds      ? law.residual_tan_friction
                                                  : law.tan_friction;
  found.joint.is_weakened = scene.reduction.weakens(static_cast<std::size_t>(number));
  found.cohesion = law.has_bonds ? law.residual_cohesion : law.cohesion;
  return found;
}

constexpr double same_line = 0.98;         // cosine
constexpr double same_direction = 0.99995; // cosine of 0.01
/// How far a corner is from an edge that it touches, at most, in sizes of one of both blocks.
constexpr double slip_in_touch = 1e-3;

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
/// turns of both. A re-entrant vertex has its block on both sides.
bool may_lie_on(const TrialOutline &outline, std::size_t corner, Vec2 out, double turn) {
  const std::size_t before = (corner + outline.vertex.size() - 1) % outline.vertex.size();
  const Vec2 ahead = perp(outline.normal[corner]); // along the edge that begins at the corner
  const Vec2 back = -1.0 * perp(outline.normal[before]);
  return cross(ahead, back) >= -turn && std::min(dot(ahead, out), dot(back, out)) >= -turn;
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

/// A corner of one block of a pair that may come to lie on an edge of the other one.
struct Meeting {
  std::size_t side = 0; ///< of the corner: 0 on the lower block
  std::size_t corner = 0;
  std::size_t edge = 0;
  Vec2 point;         ///< the corner
  Vec2 normal;        ///< of pressure on the lower block
  double gap = 0.0;   ///< between the corner and the line of the edge, m
  double place = 0.0; ///< along the edge, m
  double length = 0.0;
};

using Outlines = std::array<TrialOutline, 2>;

/// Meetings of corners that are no farther from an edge, on either side of it, and from its ends than
/// `motion` reaches.
std::vector<Meeting> meetings(const Outlines &outlines, const Motion &motion) {
  std::vector<Meeting> found;
  for (std::size_t side = 0; side < 2; ++side) {
    const TrialOutline &corners = outlines[side];
    const TrialOutline &edges = outlines[1 - side];
    for (std::size_t k = 0; k < edges.vertex.size(); ++k) {
      const Vec2 out = edges.normal[k];
      for (std::size_t corner = 0; corner < corners.vertex.size(); ++corner) {
        const Vec2 from_edge = corners.vertex[corner] - edges.vertex[k];
        const double gap = dot(from_edge, out);
        const double place = dot(from_edge, perp(out));
        if (std::abs(gap) <= motion.reach && place >= -motion.reach &&
            place <= edges.length[k] + motion.reach && may_lie_on(corners, corner, out, motion.turn)) {
          found.push_back({side, corner, k, corners.vertex[corner], side == 0 ? out : -1.0 * out, gap, place,
                           edges.length[k]});
        }
      }
    }
  }
  return found;
}

double distance_to(const LimitJoint &joint, Vec2 point) {
  const Vec2 along = joint.end - joint.begin;
  const double square = dot(along, along);
  const double share = square > 0.0 ? std::clamp(dot(point - joint.begin, along) / square, 0.0, 1.0) : 0.0;
  return norm(point - (joint.begin + share * along));
}

/// The joints of a region that is closed. Blocks push on each other along the normal of an edge on which a
/// corner of the other block lies. The mean normal of a region is another one where the region has a part of
/// what overlaps at a corner alone, such as the side of a toe or what a vertex within a straight side parts:
/// such a part acts along all normals with which corners there lie on edges. As it is, it would hold blocks
/// in a direction in which nothing holds them.
std::vector<LimitRegion> along_edges(const Outlines &outlines, const Motion &touch, double overlap,
                                     const LimitRegion &region) {
  const Motion motion{touch.reach + overlap, touch.turn};
  std::vector<LimitRegion> found;
  for (const Meeting &meeting : meetings(outlines, motion)) {
    if (distance_to(region.joint, meeting.point) > motion.reach) {
      continue;
    }
    if (dot(meeting.normal, region.joint.normal) > same_direction) {
      return {region};
    }
    const bool is_known = std::any_of(found.begin(), found.end(), [&](const LimitRegion &other) {
      return dot(meeting.normal, other.joint.normal) > same_direction;
    });
    if (!is_known) {
      const Vec2 middle = 0.5 * (region.joint.begin + region.joint.end);
      const Vec2 half = 0.5 * norm(region.joint.end - region.joint.begin) * perp(meeting.normal);
      found.push_back(region);
      found.back().joint.normal = meeting.normal;
      found.back().joint.begin = middle - half;
      found.back().joint.end = middle + half;
      if (found.size() > 1) { // the load counts once
        found.back().force = {};
        found.back().torque = {};
      }
    }
  }
  return found.empty() ? std::vector<LimitRegion>{region} : found;
}

Outlines outlines_of(const BlockSystem &blocks, const CandidatePair &pair) {
  return {TrialOutline(blocks, pair.lower.value), TrialOutline(blocks, pair.higher.value)};
}

/// The joints of the regions of a pair, with what they do to its blocks.
std::vector<LimitRegion> closed_joints(const Simulation &settled, std::uint32_t number,
                                       std::span<const RegionForce> regions) {
  const BlockSystem &blocks = settled.blocks();
  const CandidatePair &pair = settled.candidates().pairs[number];
  const std::array<std::size_t, 2> rows{pair.lower.value, pair.higher.value};
  const Outlines outlines = outlines_of(blocks, pair);
  const Motion touch = motion_of(blocks, pair, slip_in_touch);
  std::vector<LimitRegion> joints;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    LimitRegion region = closed_joint(settled, regions[k], settled.history().state(number, k), pair);
    for (std::size_t side = 0; side < 2; ++side) {
      const ContactPart part = contact_part(regions[k], side == 0, blocks.motion[rows[side]].centroid);
      region.force[side] = part.force;
      region.torque[side] = part.dyad.xy - part.dyad.yx;
    }
    const std::vector<LimitRegion> own = region.is_bond
                                             ? std::vector<LimitRegion>{region}
                                             : along_edges(outlines, touch, regions[k].overlap, region);
    joints.insert(joints.end(), own.begin(), own.end());
  }
  return joints;
}

/// Where a corner stands at an edge.
enum class Standing { away, before, at_end };

/// Before it or before what lies beside its ends; or at an end, on either side of its line: where two corners
/// meet they push along the normal of any of their edges. A corner on the line is before it, whatever
/// rounding leaves of the gap.
Standing standing_of(const Meeting &meeting, double reach) {
  constexpr double rounding = 1e-6;
  const bool is_at_end = meeting.place < reach || meeting.place > meeting.length - reach;
  return meeting.gap > -rounding * reach ? Standing::before : is_at_end ? Standing::at_end : Standing::away;
}

/// What may close where a corner comes to lie on an edge, for each law that may hold there: of those of the
/// corner's edges that face the edge, or of both where the block stands on the corner.
std::vector<LimitRegion> joints_of_corner(const Simulation &settled, const CandidatePair &pair,
                                          const Outlines &outlines, const Meeting &meeting) {
  const TrialOutline &corners = outlines[meeting.side];
  const Vec2 out = outlines[1 - meeting.side].normal[meeting.edge];
  const auto with = [&](std::size_t own) {
    const auto lower = static_cast<std::int32_t>(meeting.side == 0 ? own : meeting.edge);
    const auto higher = static_cast<std::int32_t>(meeting.side == 0 ? meeting.edge : own);
    const std::int32_t law = pair.is_mixed
                                 ? law_of_edges(settled.blocks(), settled.scene().joints, pair, lower, higher)
                                 : pair.law;
    return open_joint(settled, law, meeting.normal, meeting.point);
  };
  const std::array<std::size_t, 2> own{meeting.corner,
                                       (meeting.corner + corners.vertex.size() - 1) % corners.vertex.size()};
  std::vector<LimitRegion> found;
  for (const std::size_t edge : own) {
    if (dot(corners.normal[edge], out) < -same_line) {
      found.push_back(with(edge));
    }
  }
  return found.empty() ? std::vector<LimitRegion>{with(own[0]), with(own[1])} : found;
}

/// Let what may close at a corner reach there: a joint of that law on the same line, the nearest one, or
/// another joint.
void close_at(const LimitRegion &open, Standing standing, std::vector<LimitRegion> &joints) {
  const Vec2 point = open.joint.begin;
  const auto on_line = [&](const LimitRegion &region) {
    return dot(region.joint.normal, open.joint.normal) > same_line;
  };
  const auto any_on_line = [&](const auto &holds) {
    return std::any_of(joints.begin(), joints.end(),
                       [&](const LimitRegion &region) { return on_line(region) && holds(region); });
  };
  if (any_on_line(
          [&](const LimitRegion &region) { return region.is_bond && is_beside(region.joint, point); }) ||
      (standing == Standing::at_end &&
       any_on_line([](const LimitRegion &region) { return !region.is_bond && !region.is_open; }))) {
    return;
  }
  LimitRegion *nearest = nullptr;
  for (LimitRegion &region : joints) {
    if (!region.is_bond && region.law == open.law && on_line(region) &&
        (nearest == nullptr || distance_to(region.joint, point) < distance_to(nearest->joint, point))) {
      nearest = &region;
    }
  }
  if (nearest == nullptr) {
    joints.push_back(open);
  } else {
    extend(nearest->joint, point);
  }
}

/// Where corners of the blocks of a pair stand before edges of each other, or beside the ends of them, their
/// joint may close. A bond keeps its length: its tension acts on no more of the side than it glues. What
/// comes out does not depend on the order of blocks and vertices.
/// @param motion  the farthest that a corner is from an edge and from its ends, and that it turns
/// @param joints  of the pair, those that are closed at first
void add_open_joints(const Simulation &settled, const CandidatePair &pair, const Outlines &outlines,
                     const Motion &motion, std::vector<LimitRegion> &joints) {
  for (const Meeting &meeting : meetings(outlines, motion)) {
    const Standing standing = standing_of(meeting, motion.reach);
    if (standing != Standing::away) {
      for (const LimitRegion &open : joints_of_corner(settled, pair, outlines, meeting)) {
        close_at(open, standing, joints);
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
    if (settled.counts_here(pair)) {
      of_pair[number] = closed_joints(settled, number, regions);
    }
  };
  for_regions(settled.state(), 0, settled.candidates().pairs.size(), add);
  std::vector<LimitRegion> found;
  for (std::size_t number = 0; number < of_pair.size(); ++number) {
    const CandidatePair &pair = settled.candidates().pairs[number];
    if (!settled.counts_here(pair)) {
      continue;
    }
    std::vector<LimitRegion> &joints = of_pair[number];
    add_open_joints(settled, pair, outlines_of(blocks, pair), motion_of(blocks, pair, slip), joints);
    const auto id_of = [&](BlockIndex row) {
      const BlockProperties &block = blocks.properties[row.value];
      return block.keeps_its_velocity() ? std::int64_t{-1} : std::int64_t{block.id.value};
    };
    for (LimitRegion &region : joints) {
      for (const LimitRegion &other : joints) {
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

// One pair may have several joints on one stretch: a bond beside friction, or laws that a corner has at once.
void put_in_order(std::vector<LimitRegion> &regions) {
  const auto key = [](const LimitRegion &region) {
    const LimitJoint &joint = region.joint;
    return std::tuple(joint.first, joint.second, joint.begin.x, joint.begin.y, joint.normal.x, joint.normal.y,
                      joint.end.x, joint.end.y, region.law, region.is_bond, joint.tan_friction,
                      joint.cohesion, joint.tension);
  };
  std::sort(regions.begin(), regions.end(),
            [&](const LimitRegion &a, const LimitRegion &b) { return key(a) < key(b); });
}

} // namespace gcpdda
