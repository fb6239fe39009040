#include "limit_analysis/support_reserves.hpp"

#include "dynamics/bolt_link.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace gcpdda {

namespace {

constexpr double unlimited = std::numeric_limits<double>::max();

/// What a support bears at most.
struct Capacity {
  double tension = unlimited; ///< N/m
  double compression = unlimited;
  double shear = unlimited;
  double moment = 0.0; ///< N
};

Capacity capacity_of(const LinkLaw &law, const LinkMemory &memory) {
  const auto finite = [](double value) { return std::isfinite(value) ? value : unlimited; };
  const LinerSection &section = law.section;
  if (section.thickness == 0.0) {
    const double axial = finite(axial_capacity(law, memory));
    return {axial, law.slack_in_compression ? 0.0 : axial,
            law.shear_stiffness > 0.0 ? finite(law.shear_yield) : 0.0, 0.0};
  }
  const double t = section.thickness;
  const double tensile = memory.cracked ? section.residual_strength : section.tensile_strength;
  Capacity most;
  most.tension = finite(tensile * t);
  most.compression = finite(section.compressive_strength * t);
  // The largest plastic moment of all thrusts (dynamics/liner_section.hpp).
  most.moment = finite((section.compressive_strength + tensile) * t * t / 8.0);
  const double pressed = std::max({0.0, section.away[0], section.away[1]}) * most.compression;
  most.shear = std::min({finite(section.shear_limit), finite(section.bond_limit) + pressed,
                         finite(2.0 * most.moment / law.length)});
  return most;
}

/// A change of a force from `now` that stays between two values, by no more than `change`.
void append_change(LimitForce force, double now, double change, double least, double most,
                   std::vector<LimitForce> &all) {
  force.least = std::min(0.0, std::max(-change, least - now));
  force.most = std::max(0.0, std::min(change, most - now));
  if (force.least < force.most) {
    all.push_back(force);
  }
}

void append_link(const BlockSystem &system, const BoltLink &link, const LinkLaw &law,
                 const std::array<std::size_t, 2> &rows, double slip, std::vector<LimitForce> &all) {
  const LinkMemory &memory = link.memory;
  if (memory.broken) {
    return;
  }
  double motion = 0.0;
  double turn = 0.0;
  LimitForce force;
  for (std::size_t side = 0; side < 2; ++side) {
    const BlockProperties &block = system.properties[rows[side]];
    if (!block.keeps_its_velocity()) {
      (side == 0 ? force.first : force.second) = block.id.value;
      motion += slip * std::sqrt(block.area);
      turn += slip * std::sqrt(block.area) / block.radius;
    }
  }
  const LinkPose pose = pose_of(system, link, rows);
  const Capacity most = capacity_of(law, memory);
  const auto act_at = [&](Vec2 lower, Vec2 higher) {
    force.point = {trial_position(system, rows[0], lower), trial_position(system, rows[1], higher)};
  };
  act_at(link.end[0].point, link.end[1].point);
  force.direction = pose.axis;
  const double change = law.axial_stiffness * motion;
  append_change(force, memory.axial, change, -most.compression, most.tension, all);
  // As its ends slide it turns, and pulls across the line on which it lies.
  const double pull = std::min(std::abs(memory.axial) + change, std::max(most.compression, most.tension));
  force.direction = perp(pose.axis);
  append_change(force, 0.0, pull * motion / (link.length + pose.extension), -unlimited, unlimited, all);
  act_at(pose.shear_point[0], pose.shear_point[1]);
  force.direction = pose.tangent;
  append_change(force, memory.shear, law.shear_stiffness * motion, -most.shear, most.shear, all);
  force.direction = {};
  append_change(force, memory.moment, law.bending_stiffness * turn, -most.moment, most.moment, all);
}

} // namespace

std::vector<LimitForce> support_reserves(const Simulation &settled, double slip) {
  const BlockSystem &system = settled.blocks();
  std::vector<LimitForce> mine;
  settled.bolts().for_counted([&](std::uint32_t, const BoltLink &link, const LinkLaw &law, const auto &rows) {
    append_link(system, link, law, rows, slip, mine);
  });
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    for (const Anchor &anchor : system.anchors_of(row)) {
      for (const Vec2 direction : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}}) {
        const Vec2 point = trial_position(system, row, anchor.point);
        mine.push_back(
            {system.properties[row].id.value, -1, {point, point}, direction, -unlimited, unlimited});
      }
    }
  }
  std::vector<LimitForce> all;
  for (const std::vector<LimitForce> &part : settled.communicator().all_gather(mine)) {
    all.insert(all.end(), part.begin(), part.end());
  }
  put_in_order(all);
  return all;
}

// The axis of one bolt may be the line across another one, and two bolts may lie on one line.
void put_in_order(std::vector<LimitForce> &forces) {
  const auto key = [](const LimitForce &force) {
    return std::tuple(force.first, force.second, force.point[0].x, force.point[0].y, force.point[1].x,
                      force.point[1].y, force.direction.x, force.direction.y, force.least, force.most);
  };
  std::sort(forces.begin(), forces.end(),
            [&](const LimitForce &a, const LimitForce &b) { return key(a) < key(b); });
}

} // namespace gcpdda
