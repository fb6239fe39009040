#include "dynamics/bolt_link.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

/// F*, of a rigid block its rotation.
Mat2 trial_gradient(const BlockSystem &system, std::size_t row) {
  if (system.is_deformable(row)) {
    return system.deformation_of(row).trial;
  }
  const Rotation turn = Rotation::of(system.trial[row].r);
  return {turn.c, -turn.s, turn.s, turn.c};
}

/// A force held within its capacity; what is beyond has flown.
struct Yielding {
  double force = 0.0;
  double slip = 0.0;
  double dissipated = 0.0;

  Yielding(double trial, double stiffness, double capacity) : force(std::clamp(trial, -capacity, capacity)) {
    if (force != trial) {
      slip = (trial - force) / stiffness;
      dissipated = force * slip;
    }
  }
};

} // namespace

LinkLaw law_of(const SupportType &support, const BoltLink &link) {
  const bool is_grouted = support.kind == SupportType::Kind::grouted;
  const double stiffness =
      support.axial_stiffness > 0.0 ? support.axial_stiffness : support.axial_rigidity / link.length;
  const double bond = is_grouted && std::isfinite(link.bond_length) && std::isfinite(support.bond_strength)
                          ? support.bond_strength * link.bond_length
                          : SupportType::unlimited;
  const double capacity = std::min(support.axial_yield, bond);
  LinkLaw law;
  law.axial_stiffness = stiffness / support.spacing;
  law.shear_stiffness = is_grouted ? support.shear_stiffness / support.spacing : 0.0;
  law.axial_yield = capacity / support.spacing;
  law.shear_yield = support.shear_yield / support.spacing;
  law.pretension = std::min(support.pretension, capacity) / support.spacing;
  law.rupture = support.rupture_strain * link.length;
  law.slack_in_compression = !is_grouted;
  return law;
}

// From displacements, not from world positions: a distant origin costs no digits.
LinkPose pose_of(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows) {
  const auto [a, b] = rows;
  const Mat2 map_a = trial_gradient(system, a);
  const Mat2 map_b = trial_gradient(system, b);
  const Vec2 r = (system.properties[b].centroid - system.properties[a].centroid) +
                 (system.trial[b].u - system.trial[a].u) +
                 (map_b(link.end[1].point) - map_a(link.end[0].point));
  const double distance = norm(r);
  LinkPose pose;
  pose.extension = distance - link.length;
  pose.axis = distance > 0.0 ? (1.0 / distance) * r : Vec2{};
  const Vec2 sum = map_a(link.end[0].along) + map_b(link.end[1].along);
  const double size = norm(sum);
  if (size > 0.0) {
    const Vec2 mean = (1.0 / size) * sum;
    pose.tangent = perp(mean);
    pose.slide = dot(pose.tangent, r);
    const double share = dot(mean, r) / size;
    pose.shear_point = {link.end[0].point + share * link.end[0].along,
                        link.end[1].point - share * link.end[1].along};
  }
  return pose;
}

LinkMemory respond(const LinkLaw &law, LinkMemory memory, double extension, double slide) {
  memory.extension = extension;
  memory.slide = slide;
  if (memory.broken) {
    return memory;
  }
  double trial = law.pretension + law.axial_stiffness * (extension - memory.axial_slip);
  if (law.slack_in_compression) {
    trial = std::max(trial, 0.0);
  }
  const Yielding axial(trial, law.axial_stiffness, law.axial_yield);
  const Yielding shear(law.shear_stiffness * (slide - memory.shear_slip), law.shear_stiffness,
                       law.shear_yield);
  memory.axial = axial.force;
  memory.axial_slip += axial.slip;
  memory.shear = shear.force;
  memory.shear_slip += shear.slip;
  memory.dissipated += axial.dissipated + shear.dissipated;
  memory.yielded = memory.yielded || axial.slip != 0.0 || shear.slip != 0.0;
  if (extension + law.pretension / law.axial_stiffness > law.rupture) {
    memory.dissipated += stored_energy(law, memory);
    memory.axial = 0.0;
    memory.shear = 0.0;
    memory.broken = true;
  }
  return memory;
}

double stored_energy(const LinkLaw &law, const LinkMemory &memory) {
  const double axial = 0.5 * memory.axial * memory.axial / law.axial_stiffness;
  return law.shear_stiffness > 0.0 ? axial + 0.5 * memory.shear * memory.shear / law.shear_stiffness : axial;
}

LinkForce force_of(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows,
                   const LinkPose &pose, const LinkMemory &memory) {
  LinkForce force;
  for (std::size_t k = 0; k < 2; ++k) {
    const double sign = k == 0 ? 1.0 : -1.0;
    const Mat2 map = trial_gradient(system, rows[k]);
    const auto act = [&](Vec2 f, Vec2 point) {
      force.rigid[k] += {f, cross(map(point), f)};
      force.gradient[k] += outer(f, point);
    };
    act((sign * memory.axial) * pose.axis, link.end[k].point);
    if (memory.shear != 0.0) {
      act((sign * memory.shear) * pose.tangent, pose.shear_point[k]);
    }
  }
  return force;
}

std::array<PointSpring, 2> springs_of(const LinkLaw &law, const BoltLink &link, std::size_t end) {
  const double sign = end == 0 ? 1.0 : -1.0;
  const LinkEnd &at = link.end[end];
  return {PointSpring{at.point, law.axial_stiffness},
          PointSpring{at.point + (0.5 * sign * link.length) * at.along, law.shear_stiffness}};
}

Vec2 trial_position(const BlockSystem &system, std::size_t row, Vec2 point) {
  return system.motion[row].centroid + trial_gradient(system, row)(point);
}

} // namespace gcpdda
