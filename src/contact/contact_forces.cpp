#include "gcpdda/contact/contact_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

/// Relative velocity of two blocks as a field: v(x) = at_origin + spin perp(x - origin).
struct ContactForces::RelativeVelocity {
  Vec2 at_origin;
  double spin = 0.0;

  RelativeVelocity(const BlockSystem &system, const CandidatePair &pair, Vec2 origin) {
    const RigidDof &a = system.velocity[pair.lower.value];
    const RigidDof &b = system.velocity[pair.higher.value];
    at_origin = (a.u + a.r * perp(origin - system.trial_centroid[pair.lower.value])) -
                (b.u + b.r * perp(origin - system.trial_centroid[pair.higher.value]));
    spin = a.r - b.r;
  }
  [[nodiscard]] Vec2 at(Vec2 from_origin) const { return at_origin + spin * perp(from_origin); }
};

namespace {

/// Normals of a region cancel when the resultant falls below this share of the total pressure.
constexpr double least_resultant = 0.1;

/// How a trial configuration moved since the one before, in a form without cancellation.
TrialIncrement trial_increment(const BlockSystem &system, std::size_t row) {
  const RigidDof step = system.trial[row] - system.trial_previous[row];
  const double half = std::sin(0.5 * step.r);
  return {step.u, std::sin(step.r), 2.0 * half * half};
}

/// Motion of the material point now at offset r from the trial centroid since the last trial configuration.
Vec2 increment_at(const TrialIncrement &step, Vec2 r) {
  return step.u +
         Vec2{step.one_minus_cosine * r.x - step.sine * r.y, step.sine * r.x + step.one_minus_cosine * r.y};
}

/// Motion of the lower block's material point now at x relative to the higher one's.
Vec2 slide_at(const BlockSystem &system, const CandidatePair &pair, Vec2 x, const TrialIncrement &lower,
              const TrialIncrement &higher) {
  return increment_at(lower, x - system.trial_centroid[pair.lower.value]) -
         increment_at(higher, x - system.trial_centroid[pair.higher.value]);
}

/// int q ds and int q s ds of q = max(-p, d) over [0, length], p >= 0 and d linear with the given end values.
struct TractionIntegral {
  double total = 0.0;
  double along = 0.0;

  void add_linear(double s0, double q0, double s1, double q1) {
    const double length = s1 - s0;
    const double stretch = 0.5 * length * (q0 + q1);
    total += stretch;
    along += s0 * stretch + length * length * (q0 + 2.0 * q1) / 6.0;
  }
};

TractionIntegral integrate_without_tension(double length, double p0, double p1, double d0, double d1) {
  TractionIntegral q;
  const double sum0 = p0 + d0;
  const double sum1 = p1 + d1;
  if (sum0 >= 0.0 && sum1 >= 0.0) {
    q.add_linear(0.0, d0, length, d1);
  } else if (sum0 <= 0.0 && sum1 <= 0.0) {
    q.add_linear(0.0, -p0, length, -p1);
  } else {
    const double share = sum0 / (sum0 - sum1);
    const double cut = share * length;
    const double p_cut = p0 + share * (p1 - p0);
    q.add_linear(0.0, std::max(-p0, d0), cut, -p_cut);
    q.add_linear(cut, -p_cut, length, std::max(-p1, d1));
  }
  return q;
}

double deepest(std::span<const Piece> pieces) {
  double depth = 0.0;
  for (const Piece &piece : pieces) {
    depth = std::max({depth, piece.depth_begin, piece.depth_end});
  }
  return depth;
}

/// Thickness along n_r and extent along t_r of the pieces, relative to x_r.
void measure_region(std::span<const Piece> pieces, PairForce &force) {
  const Vec2 tangent = perp(force.normal);
  double low_n = std::numeric_limits<double>::infinity();
  double low_t = low_n;
  double high_n = -low_n;
  double high_t = -low_n;
  for (const Piece &piece : pieces) {
    for (const Vec2 x : {piece.begin - force.point, piece.end() - force.point}) {
      const double along_n = dot(x, force.normal);
      const double along_t = dot(x, tangent);
      low_n = std::min(low_n, along_n);
      high_n = std::max(high_n, along_n);
      low_t = std::min(low_t, along_t);
      high_t = std::max(high_t, along_t);
    }
  }
  // Faces that coincide up to rounding leave only their ends to set n_r, which then lies along the joint: the
  // deepest point, never far below the thickness of a real overlap, keeps its length out.
  force.overlap = std::min(high_n - low_n, 4.0 * deepest(pieces));
  force.extent_begin = low_t;
  force.extent_end = high_t;
}

void add_force(PairForce &force, Vec2 at, Vec2 f) {
  const Vec2 arm = at - force.origin;
  force.force += f;
  force.dyad[0] += arm.x * f.x;
  force.dyad[1] += arm.x * f.y;
  force.dyad[2] += arm.y * f.x;
  force.dyad[3] += arm.y * f.y;
}

} // namespace

namespace {

/// u.n of a piece: how far it faces the other block along n_r.
double facing_of(const Piece &piece, bool is_lower, Vec2 normal) {
  return is_lower ? -dot(normal, piece.normal) : dot(normal, piece.normal);
}

/// Share of the facing pieces' pressure along n_r that the resultant keeps: what the dashpot may take away.
double releasable_share(const Overlap &overlap, Vec2 normal, double resultant) {
  double facing_pressure = 0.0;
  for (std::size_t i = 0; i < overlap.pieces().size(); ++i) {
    const Piece &piece = overlap.pieces()[i];
    const double facing = std::max(0.0, facing_of(piece, i < overlap.num_first(), normal));
    facing_pressure += facing * 0.5 * piece.length * (piece.depth_begin + piece.depth_end);
  }
  return std::min(1.0, resultant / facing_pressure);
}

} // namespace

void ContactForces::add_normal_dashpot(const CandidatePair &pair, const RelativeVelocity &velocity,
                                       PairForce &force) const {
  const Vec2 n = force.normal;
  const std::span<const Piece> pieces = overlap_.pieces();
  const double share = releasable_share(overlap_, n, force.normal_force / pair.half_stiffness);
  double total = 0.0;
  Vec2 moment;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece &piece = pieces[i];
    const double facing = facing_of(piece, i < overlap_.num_first(), n);
    if (facing <= 0.0) {
      continue;
    }
    // (v_own - v_other).u is the closing speed for both blocks' pieces.
    const Vec2 begin = piece.begin - force.origin;
    const double rate = pair.damping * facing;
    const double releasable = share * facing * pair.half_stiffness;
    const TractionIntegral q = integrate_without_tension(
        piece.length, releasable * piece.depth_begin, releasable * piece.depth_end,
        -rate * dot(velocity.at(begin), n), -rate * dot(velocity.at(piece.end() - force.origin), n));
    total += q.total;
    moment += q.total * begin + q.along * perp(piece.normal);
  }
  force.force += total * n;
  force.damping_force += total * n;
  force.damping_moment += cross(moment, n);
  force.dyad[0] += moment.x * n.x;
  force.dyad[1] += moment.x * n.y;
  force.dyad[2] += moment.y * n.x;
  force.dyad[3] += moment.y * n.y;
}

ConvexView view_of(const BlockSystem &system, std::size_t row) {
  return {system.of_row(system.vertex, row), system.of_row(system.normal, row),
          system.of_row(system.edge_length, row), system.box[row]};
}

void ContactForces::add_shear(PairForce &force, double elastic, double viscous) const {
  const Vec2 tangent = perp(force.normal);
  force.shear = elastic + viscous;
  force.shear_force = -elastic * tangent;
  force.shear_moment = cross(force.point - force.origin, force.shear_force);
  const Vec2 drag = -viscous * tangent;
  force.damping_force += drag;
  force.damping_moment += cross(force.point - force.origin, drag);
  add_force(force, force.point, -force.shear * tangent);
}

void ContactForces::set_shear(std::size_t pair, double shear) {
  PairForce &force = forces_[pair];
  const Vec2 tangent = perp(force.normal);
  const double viscous = force.shear + dot(force.shear_force, tangent);
  add_force(force, force.point, (force.shear - shear) * tangent);
  force.damping_force += viscous * tangent;
  force.damping_moment += cross(force.point - force.origin, viscous * tangent);
  force.shear = shear;
  force.shear_force = -shear * tangent;
  force.shear_moment = cross(force.point - force.origin, force.shear_force);
}

bool ContactForces::find_region(const BlockSystem &system, const CandidatePair &pair, PairForce &force) {
  force = {};
  if (!overlap_.find(view_of(system, pair.lower.value), view_of(system, pair.higher.value),
                     parameters_.potential)) {
    return false;
  }
  const RegionIntegrals region = overlap_.integrate();
  if (!(region.pressure > 0.0)) {
    return false;
  }
  force.touching = true;
  force.origin = region.origin;
  force.force = pair.half_stiffness * region.force;
  for (std::size_t i = 0; i < 4; ++i) {
    force.dyad[i] = pair.half_stiffness * region.dyad[i];
  }
  force.point = region.origin + (1.0 / region.pressure) * region.pressure_moment;
  const double resultant = norm(region.force);
  force.normal_force = pair.half_stiffness * resultant;
  if (resultant < least_resultant * region.pressure) {
    force.normal_undefined = true;
    // No direction to measure along: twice the deepest point stands for the thickness.
    force.overlap = 2.0 * deepest(overlap_.pieces());
  } else {
    force.normal = (1.0 / resultant) * region.force;
    measure_region(overlap_.pieces(), force);
  }
  return true;
}

void ContactForces::add_friction(const BlockSystem &system, const CandidatePair &pair,
                                 const RelativeVelocity &velocity, RegionMemory &memory, PairForce &force) {
  const double extent = force.extent_end - force.extent_begin;
  memory.longest = std::max(memory.longest, extent);
  force.cap = force.normal_force * pair.tan_friction + pair.cohesion * extent;
  memory.state = force.cap > 0.0 ? ContactState::stick : ContactState::slip;
  if (force.cap <= 0.0) {
    memory.shear = 0.0;
    return;
  }
  const Vec2 tangent = perp(force.normal);
  const double stiffness = pair.tangential_stiffness * memory.longest;
  if (!force.born) {
    const Vec2 slide =
        slide_at(system, pair, force.point, increments_[pair.lower.value], increments_[pair.higher.value]);
    memory.shear += stiffness * dot(slide, tangent);
  }
  if (std::abs(memory.shear) > force.cap) {
    memory.slip += (std::abs(memory.shear) - force.cap) / stiffness;
    memory.shear = std::copysign(force.cap, memory.shear);
    memory.state = ContactState::slip;
  }
  double viscous = 0.0;
  if (parameters_.damping_ratio > 0.0) {
    const double drag = 2.0 * parameters_.damping_ratio * std::sqrt(stiffness * pair.mass) *
                        dot(velocity.at(force.point - force.origin), tangent);
    viscous = std::clamp(memory.shear + drag, -force.cap, force.cap) - memory.shear;
  }
  add_shear(force, memory.shear, viscous);
}

void ContactForces::evaluate_pair(const BlockSystem &system, const CandidatePair &pair, RegionMemory &memory,
                                  PairForce &force) {
  if (!find_region(system, pair, force)) {
    memory = {};
    return;
  }
  force.born = memory.state == ContactState::open;
  if (force.normal_undefined) {
    memory.shear = 0.0;
    memory.state = ContactState::slip;
    return;
  }
  const RelativeVelocity velocity(system, pair, force.origin);
  add_friction(system, pair, velocity, memory, force);
  if (pair.damping > 0.0) {
    add_normal_dashpot(pair, velocity, force);
  }
}

ForceReport ContactForces::evaluate(const BlockSystem &system, const Candidates &candidates,
                                    ContactHistory &history) {
  increments_.resize(system.num_rows());
  for (std::size_t row = 0; row < system.num_mobile(); ++row) {
    increments_[row] = trial_increment(system, row);
  }
  for (std::size_t row = system.first_fixed(); row < system.num_rows(); ++row) {
    increments_[row] = {};
  }

  ForceReport report;
  forces_.resize(candidates.pairs.size());
  for (std::size_t k = 0; k < candidates.pairs.size(); ++k) {
    const CandidatePair &pair = candidates.pairs[k];
    if (!system.box[pair.lower.value].meets(system.box[pair.higher.value])) {
      forces_[k].touching = false;
      history.regions[k] = {};
      continue;
    }
    ++report.evaluations;
    evaluate_pair(system, pair, history.regions[k], forces_[k]);
    if (!forces_[k].touching) {
      continue;
    }
    report.normals_undefined += forces_[k].normal_undefined ? 1 : 0;
    report.max_overlap = std::max(report.max_overlap, forces_[k].overlap);
    if (forces_[k].overlap > pair.allowed_overlap) {
      keep_first(report.fault,
                 {Fault::Cause::too_deep, system.properties[pair.lower.value].id,
                  system.properties[pair.higher.value].id, forces_[k].overlap, pair.allowed_overlap});
    }
  }
  return report;
}

double coming_slide(const BlockSystem &system, const CandidatePair &pair, const PairForce &force) {
  const auto increment = [&](BlockIndex row) {
    return system.is_fixed(row.value) ? TrialIncrement{} : trial_increment(system, row.value);
  };
  return dot(slide_at(system, pair, force.point, increment(pair.lower), increment(pair.higher)),
             perp(force.normal));
}

ContactPart contact_part(const PairForce &force, bool is_lower, Vec2 centroid) {
  const double sign = is_lower ? 1.0 : -1.0;
  const Vec2 arm = force.origin - centroid;
  return {sign * force.force,
          {sign * (force.dyad[0] + arm.x * force.force.x), sign * (force.dyad[1] + arm.x * force.force.y),
           sign * (force.dyad[2] + arm.y * force.force.x), sign * (force.dyad[3] + arm.y * force.force.y)}};
}

BlockContactSum sum_contacts(const BlockSystem &system, const Candidates &candidates,
                             std::span<const PairForce> forces, std::size_t row) {
  BlockContactSum sum;
  const Vec2 centroid = system.trial_centroid[row];
  for (std::uint32_t c = candidates.contact_begin[row]; c < candidates.contact_begin[row + 1]; ++c) {
    const BlockContact contact = candidates.block_contacts[c];
    const PairForce &f = forces[contact.pair];
    if (!f.touching) {
      continue;
    }
    const double sign = contact.is_lower ? 1.0 : -1.0;
    const Vec2 arm = f.origin - centroid;
    sum.force += sign * RigidDof{f.force, f.dyad[1] - f.dyad[2] + cross(arm, f.force)};
    sum.shear += sign * RigidDof{f.shear_force, f.shear_moment + cross(arm, f.shear_force)};
    sum.damping += sign * RigidDof{f.damping_force, f.damping_moment + cross(arm, f.damping_force)};
  }
  return sum;
}

std::array<double, 3> mean_stress(const BlockSystem &system, const Candidates &candidates,
                                  std::span<const PairForce> forces, std::size_t row) {
  std::array<double, 4> dyad{};
  for (std::uint32_t c = candidates.contact_begin[row]; c < candidates.contact_begin[row + 1]; ++c) {
    const BlockContact contact = candidates.block_contacts[c];
    if (forces[contact.pair].touching) {
      const ContactPart part =
          contact_part(forces[contact.pair], contact.is_lower, system.trial_centroid[row]);
      for (std::size_t i = 0; i < 4; ++i) {
        dyad[i] += part.dyad[i];
      }
    }
  }
  const double area = system.properties[row].area;
  return {dyad[0] / area, dyad[3] / area, 0.5 * (dyad[1] + dyad[2]) / area};
}

} // namespace gcpdda
