#include "dynamics/bolt_link.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

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

/// What the grout bears after a slip.
double bond_left(const LinkLaw &law, double slip) {
  return slip > 0.0 ? std::max(0.0, law.bond_capacity - law.bond_strength * slip) : law.bond_capacity;
}

/// How far a bar slips under a force beyond what its grout bears. Equilibrium with the spring of the bar,
///   trial - k slip = +-bond_left(g + slip),
/// is linear on either side of g = 0. None where the bar is drawn out: the spring gives way less steeply than
/// the grout does.
std::optional<double> slip_in_grout(const LinkLaw &law, double slipped, double trial) {
  const double k = law.axial_stiffness;
  const double beyond = std::abs(trial) - bond_left(law, slipped);
  if (trial < 0.0) { // first back to the full length, then on
    const double back = std::max(0.0, slipped);
    const double slip = beyond / (k + law.bond_strength);
    return slip <= back ? -slip : -(back + (beyond - (k + law.bond_strength) * back) / k);
  }
  const double even = std::max(0.0, -slipped);
  if (beyond <= k * even) {
    return beyond / k;
  }
  return k > law.bond_strength ? std::optional(even + (beyond - k * even) / (k - law.bond_strength))
                               : std::nullopt;
}

/// Let the grout slip under a force beyond what it bears.
/// @return  the force that is left
double slip_grout(const LinkLaw &law, LinkMemory &memory, double trial) {
  const double before = memory.grout_slip;
  const double out = law.bond_capacity / law.bond_strength; // slip at which nothing is left
  const std::optional<double> slip = slip_in_grout(law, before, trial);
  const double after = slip ? std::min(before + *slip, out) : std::max(before, 0.0);
  const auto work_to = [&](double g) {
    const double drawn = std::max(0.0, g);
    return law.bond_capacity * g - 0.5 * law.bond_strength * drawn * drawn;
  };
  memory.dissipated += std::abs(work_to(after) - work_to(before));
  memory.axial_slip += after - before;
  memory.grout_slip = after;
  memory.broken = !slip || after >= out;
  return std::copysign(bond_left(law, after), trial);
}

/// A link that breaks loses what it stores.
void lose_all(const LinkLaw &law, LinkMemory &memory) {
  memory.dissipated += stored_energy(law, memory);
  memory.axial = 0.0;
  memory.shear = 0.0;
  memory.broken = true;
}

/// The law of an element of a liner.
LinkLaw law_of_liner(const SupportType &support, const BoltLink &link) {
  const double length = link.length;
  const double t = support.thickness;
  const double nu = support.poissons_ratio;
  const double plane_modulus = support.youngs_modulus / (1.0 - nu * nu);
  const double shear_modulus = support.youngs_modulus / (2.0 * (1.0 + nu));
  const double rigidity = plane_modulus * t * t * t / 12.0;
  constexpr double shear_share = 5.0 / 6.0; // of a rectangular section
  const double phi = 12.0 * rigidity / (shear_share * shear_modulus * t * length * length);
  LinkLaw law;
  law.axial_stiffness = plane_modulus * t / length;
  law.shear_stiffness = 12.0 * rigidity / (length * length * length * (1.0 + phi));
  law.bending_stiffness = rigidity / length;
  law.length = length;
  law.section = section_of(support);
  // Rock lies on the right: with Q > 0 the first end on the face is drawn into the void.
  const std::size_t first = link.head_first ? 0 : 1;
  law.section.away = {link.end[first].away, link.end[1 - first].away};
  return law;
}

/// Held by the section. What a crack takes is what the element stores less after it: the strength falls at
/// once, with no deformation that could do work. A crack that has opened closes without thrust.
LinkMemory respond_as_liner(const LinkLaw &law, LinkMemory memory) {
  const double opened = std::max(0.0, memory.extension);
  const bool is_open = memory.cracked && memory.axial_slip > opened;
  memory.axial_slip = is_open ? opened : memory.axial_slip;
  const LinerForces trial{law.axial_stiffness * (memory.extension - memory.axial_slip),
                          law.shear_stiffness * (memory.slide - memory.shear_slip),
                          law.bending_stiffness * (memory.turn - memory.turn_slip)};
  const auto take = [&](const LinerForces &forces) {
    memory.axial = forces.axial;
    memory.shear = forces.shear;
    memory.moment = forces.moment;
  };
  take(trial);
  const double stored = stored_energy(law, memory);
  const bool cracks = !memory.cracked && is_overstretched(law.section, law.length, trial);
  memory.cracked = memory.cracked || cracks;
  const LinerForces held = held_forces(law.section, memory.cracked, law.length, trial);
  take(held);
  const LinerForces slip{(trial.axial - held.axial) / law.axial_stiffness,
                         (trial.shear - held.shear) / law.shear_stiffness,
                         (trial.moment - held.moment) / law.bending_stiffness};
  memory.axial_slip += slip.axial;
  memory.shear_slip += slip.shear;
  memory.turn_slip += slip.moment;
  memory.axial_gives = is_open || slip.axial != 0.0;
  memory.shear_gives = slip.shear != 0.0;
  const bool yields = slip.axial != 0.0 || memory.shear_gives || slip.moment != 0.0;
  memory.yielded = memory.yielded || yields;
  if (yields) {
    memory.dissipated += cracks
                             ? stored - stored_energy(law, memory)
                             : held.axial * slip.axial + held.shear * slip.shear + held.moment * slip.moment;
  }
  if (std::abs(held.shear) > law.section.shear_limit ||
      pull_on_bond(law.section, held) > law.section.bond_limit) {
    memory.dissipated += stored_energy(law, memory);
    take({});
    memory.broken = true;
  }
  return memory;
}

} // namespace

LinkLaw law_of(const SupportType &support, const BoltLink &link) {
  if (support.kind == SupportType::Kind::liner) {
    return law_of_liner(support, link);
  }
  const bool is_grouted = support.kind == SupportType::Kind::grouted;
  const double stiffness =
      support.axial_stiffness > 0.0 ? support.axial_stiffness : support.axial_rigidity / link.length;
  const double embedded = std::min(link.grout[0], link.grout[1]);
  const bool is_limited = is_grouted && std::isfinite(embedded) && std::isfinite(support.bond_strength);
  // More than the grout bears cannot be put in.
  const double capacity = std::min(support.axial_yield, is_limited ? support.bond_strength * link.bond_length
                                                                   : SupportType::unlimited);
  LinkLaw law;
  if (is_limited) {
    law.bond_capacity = support.bond_strength * embedded / support.spacing;
    law.bond_strength = support.bond_strength / support.spacing;
  }
  law.axial_stiffness = stiffness / support.spacing;
  law.shear_stiffness = is_grouted ? support.shear_stiffness / support.spacing : 0.0;
  law.axial_yield = support.axial_yield / support.spacing;
  law.shear_yield = support.shear_yield / support.spacing;
  law.pretension = std::min(support.pretension, capacity) / support.spacing;
  law.rupture = support.rupture_strain * link.length;
  law.slack_in_compression = !is_grouted;
  return law;
}

double axial_capacity(const LinkLaw &law, const LinkMemory &memory) {
  return std::min(law.axial_yield, bond_left(law, memory.grout_slip));
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
  const Vec2 along_a = map_a(link.end[0].along);
  const Vec2 along_b = map_b(link.end[1].along);
  pose.turn = link.liner >= 0 ? std::atan2(cross(along_a, along_b), dot(along_a, along_b)) : 0.0;
  const Vec2 sum = along_a + along_b;
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

LinkMemory respond(const LinkLaw &law, LinkMemory memory, double extension, double slide, double turn) {
  memory.extension = extension;
  memory.slide = slide;
  memory.turn = turn;
  if (memory.broken) {
    return memory;
  }
  if (law.section.thickness > 0.0) {
    return respond_as_liner(law, memory);
  }
  const double trial = law.pretension + law.axial_stiffness * (extension - memory.axial_slip);
  const bool is_slack = law.slack_in_compression && trial < 0.0;
  const double bond = bond_left(law, memory.grout_slip);
  const bool slips = bond < law.axial_yield && std::abs(trial) > bond && !is_slack;
  const double held = is_slack ? 0.0 : slips ? slip_grout(law, memory, trial) : trial;
  const Yielding axial(held, law.axial_stiffness, law.axial_yield);
  const Yielding shear(law.shear_stiffness * (slide - memory.shear_slip), law.shear_stiffness,
                       law.shear_yield);
  memory.axial = axial.force;
  memory.axial_slip += axial.slip;
  memory.steel_slip += axial.slip;
  memory.shear = shear.force;
  memory.shear_slip += shear.slip;
  memory.dissipated += axial.dissipated + shear.dissipated;
  memory.axial_gives = is_slack || slips || axial.slip != 0.0;
  memory.shear_gives = shear.slip != 0.0;
  memory.yielded = memory.yielded || slips || axial.slip != 0.0 || shear.slip != 0.0;
  const double slipped = memory.axial_slip - memory.steel_slip; // in all lengths of grout
  if (memory.broken || extension + law.pretension / law.axial_stiffness - slipped > law.rupture) {
    lose_all(law, memory);
  }
  return memory;
}

double strength_used(const LinkLaw &law, const LinkMemory &memory) {
  return memory.broken ? 1.0
                       : strength_used(law.section, memory.cracked, law.length,
                                       {memory.axial, memory.shear, memory.moment});
}

LinkPeaks with_last(const LinkLaw &law, const LinkMemory &memory) {
  LinkPeaks largest = memory.largest;
  const auto take = [](double &peak, double value) { peak = std::max(peak, value); };
  take(largest.tension, memory.axial);
  take(largest.shear, std::abs(memory.shear));
  if (law.section.thickness > 0.0) {
    take(largest.compression, -memory.axial);
    take(largest.moment, std::abs(memory.moment) + 0.5 * law.length * std::abs(memory.shear));
    take(largest.strength_used, strength_used(law, memory));
  }
  return largest;
}

double stored_energy(const LinkLaw &law, const LinkMemory &memory) {
  double energy = 0.5 * memory.axial * memory.axial / law.axial_stiffness;
  if (law.shear_stiffness > 0.0) {
    energy += 0.5 * memory.shear * memory.shear / law.shear_stiffness;
  }
  if (law.bending_stiffness > 0.0) {
    energy += 0.5 * memory.moment * memory.moment / law.bending_stiffness;
  }
  return energy;
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
    if (memory.moment != 0.0) {
      const Vec2 direction = map(link.end[k].along);
      const double couple = sign * memory.moment;
      force.rigid[k].r += couple;
      force.gradient[k] += outer((couple / dot(direction, direction)) * perp(direction), link.end[k].along);
    }
  }
  return force;
}

std::array<PointSpring, 4> springs_of(const LinkLaw &law, const BoltLink &link, std::size_t end) {
  const double sign = end == 0 ? 1.0 : -1.0;
  const LinkEnd &at = link.end[end];
  const Vec2 half = (0.5 * link.length) * at.along;
  const double bending = 2.0 * law.bending_stiffness / (link.length * link.length);
  return {PointSpring{at.point, law.axial_stiffness},
          PointSpring{at.point + (0.5 * sign * link.length) * at.along, law.shear_stiffness},
          PointSpring{at.point - half, bending}, PointSpring{at.point + half, bending}};
}

Vec2 trial_position(const BlockSystem &system, std::size_t row, Vec2 point) {
  return system.motion[row].centroid + trial_gradient(system, row)(point);
}

} // namespace gcpdda
