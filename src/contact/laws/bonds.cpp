#include "contact/laws/bonds.hpp"

#include "contact/laws/bond_work.hpp"
#include "contact/laws/region_law.hpp"
#include "contact/pair_motion.hpp"
#include "contact/touching_edges.hpp"

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

RigidDof dofs_of(const BlockSystem &system, std::size_t row, Configuration configuration) {
  return configuration == Configuration::trial ? system.trial[row]
                                               : system.trial[row] - system.motion[row].increment();
}

/// Displacement of a block's material points: u + (F - I) X.
struct Displacement {
  Vec2 u;
  Mat2 stretch;

  Displacement(const BlockSystem &system, std::size_t row, Configuration configuration) {
    const bool now = configuration == Configuration::trial;
    const RigidDof dof = dofs_of(system, row, configuration);
    u = dof.u;
    if (system.is_deformable(row)) {
      const Mat2 &trial = system.deformation_of(row).trial;
      stretch = (now ? trial : trial - system.gradient_increment(row)) - Mat2::identity();
    } else {
      const double half = std::sin(0.5 * dof.r);
      const double sine = std::sin(dof.r);
      stretch = {-2.0 * half * half, -sine, sine, -2.0 * half * half};
    }
  }
  [[nodiscard]] Vec2 at(Vec2 x) const { return u + stretch(x); }
};

/// Where a linear function with these end values is positive, as parts of its interval.
std::array<double, 2> positive_part(double first, double last) {
  if (first <= 0.0 && last <= 0.0) {
    return {0.0, 0.0};
  }
  return {first >= 0.0 ? 0.0 : first / (first - last), last >= 0.0 ? 1.0 : first / (first - last)};
}

/// Pressure int d ds that acts between two edges.
double pressure_between(std::span<const Piece> pieces, std::size_t num_lower, std::int32_t lower_edge,
                        std::int32_t higher_edge) {
  double pressure = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Piece &piece = pieces[i];
    const bool on_lower = i < num_lower;
    if ((on_lower ? piece.edge : piece.face) == lower_edge &&
        (on_lower ? piece.face : piece.edge) == higher_edge) {
      pressure += 0.5 * piece.length * (piece.depth_begin + piece.depth_end);
    }
  }
  return pressure;
}

} // namespace

BondOpening opening_of(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &bond,
                       Configuration configuration) {
  BondOpening opening;
  const auto shared = shared_stretch(system, pair, -1 - bond.lower_stretch, -1 - bond.higher_stretch);
  if (!shared) { // of edges that shared one at t = 0
    return opening;
  }
  const Displacement lower(system, pair.lower.value, configuration);
  const Displacement higher(system, pair.higher.value, configuration);
  const auto turned = [&](BlockIndex row) { return dofs_of(system, row.value, configuration).r; };
  opening.normal = Rotation::of(0.5 * (turned(pair.lower) + turned(pair.higher)))(shared->normal);
  opening.length = shared->length;
  for (const std::size_t k : {0U, 1U}) {
    const Vec2 moved = lower.at(shared->lower_ends[k]);
    const Vec2 apart = higher.at(shared->higher_ends[k]) - moved + shared->gap[k] * shared->normal;
    // Closed to begin with: a gap of rounding does not pull.
    opening.opening[k] = dot(apart, opening.normal) - std::max(0.0, shared->gap[k]);
    opening.slide += 0.5 * dot(apart, perp(opening.normal));
    opening.end[k] =
        system.properties[pair.lower.value].centroid + shared->lower_ends[k] + moved + 0.5 * apart;
  }
  return opening;
}

double bond_energy(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &bond,
                   bool in_the_middle) {
  const BondOpening last = opening_of(system, pair, bond, Configuration::trial);
  const BondOpening first =
      in_the_middle ? opening_of(system, pair, bond, Configuration::trial_previous) : last;
  const auto [begin, end] = positive_part(first.opening[0], first.opening[1]);
  double energy = 0.0;
  for (const double gauss : {-1.0, 1.0}) { // exact for the product of two linear functions
    const double s = 0.5 * (begin + end) + 0.5 * (end - begin) * gauss / std::sqrt(3.0);
    const auto at = [&](const BondOpening &o) { return o.opening[0] + s * (o.opening[1] - o.opening[0]); };
    energy += 0.25 * (end - begin) * last.length * at(first) * at(last);
  }
  return energy;
}

void bond_joints(const BlockSystem &system, const Candidates &candidates, const JointLaws &joints,
                 double pressed, ContactHistory &history) {
  if (std::none_of(joints.laws.begin(), joints.laws.end(),
                   [](const JointLaw &law) { return law.has_bonds; })) {
    return;
  }
  for (std::size_t k = 0; k < candidates.pairs.size(); ++k) {
    const CandidatePair &pair = candidates.pairs[k];
    if (pair.is_plain) { // whose laws have no bonds
      continue;
    }
    history.ranges[k].begin = static_cast<std::uint32_t>(history.regions.size());
    for_touching_edges(system, pair, pressed,
                       [&](std::int32_t lower_edge, std::int32_t higher_edge, const SharedStretch &shared) {
                         const std::int32_t law = law_of_edges(system, joints, pair, lower_edge, higher_edge);
                         if (!joints.laws[static_cast<std::size_t>(law)].has_bonds) {
                           return;
                         }
                         RegionMemory &bond = history.regions.emplace_back();
                         bond.longest = shared.length;
                         bond.lower_stretch = -1 - lower_edge;
                         bond.higher_stretch = -1 - higher_edge;
                         bond.law = law;
                         bond.state = ContactState::bonded;
                       });
    history.ranges[k].count = static_cast<std::uint32_t>(history.regions.size()) - history.ranges[k].begin;
  }
}

void PairForces::find_bonds(const BlockSystem &system, const CandidatePair &pair,
                            std::span<const Piece> pieces, std::span<const RegionMemory> memory) {
  for (const RegionMemory &known : memory) {
    BondAtWork &bond = bonds_.emplace_back();
    bond.memory = known;
    bond.constants = parameters_->constants(known.law);
    bond.damping = constants_of(system, *parameters_, pair, known.law).damping;
    bond.stretched = opening_of(system, pair, known, Configuration::trial);
    const JointLaw &law = parameters_->joints.laws[static_cast<std::size_t>(known.law)];
    const auto [o0, o1] = bond.stretched.opening;
    const TractionIntegral open = integrate_without_tension(bond.stretched.length, 0.0, 0.0, o0, o1);
    bond.pull = law.normal_stiffness * open.total;
    bond.pull_moment = law.normal_stiffness * open.along;
    double pressure = 0.0;
    for (const Region &region : pieces.empty() ? std::span<const Region>() : overlap_.regions()) {
      pressure += pressure_between(pieces.subspan(region.begin, region.end - region.begin),
                                   region.middle - region.begin, bond.lower_edge(), bond.higher_edge());
    }
    const double push = bond.constants.half_stiffness * pressure;
    bond.cap = std::max(0.0, law.cohesion * bond.stretched.length + (push - bond.pull) * law.tan_friction);
    bond.memory.shear +=
        bond.constants.tangential_stiffness * known.longest * (bond.stretched.slide - known.slip);
    bond.memory.slip = bond.stretched.slide;
    bond.broken =
        law.normal_stiffness * std::max(o0, o1) > law.tension || std::abs(bond.memory.shear) > bond.cap;
  }
}

PairForces::BondShare PairForces::share_of_bonds(const CandidatePair &pair, const Region &region) const {
  const std::span<const Piece> pieces = overlap_.pieces().subspan(region.begin, region.end - region.begin);
  BondShare share;
  for (const BondAtWork &bond : bonds_) {
    const bool here = pair.is_convex || pressure_between(pieces, region.middle - region.begin,
                                                         bond.lower_edge(), bond.higher_edge()) > 0.0;
    share.holds = share.holds || (here && !bond.broken);
    share.released = share.released || (here && bond.broken);
    share.shear += here && bond.broken ? bond.memory.shear : 0.0;
    share.length += here && bond.broken ? bond.memory.longest : 0.0;
  }
  return share;
}

// The dashpot of both sides' pieces, where the joint is open.
TractionIntegral PairForces::BondAtWork::drag(const RelativeVelocity &velocity, Vec2 along) const {
  const auto [first, last] = positive_part(stretched.opening[0], stretched.opening[1]);
  const auto at = [&](double share) {
    const Vec2 arm = (share - 0.5) * stretched.length * along;
    return -2.0 * damping * dot(velocity.at(arm), stretched.normal);
  };
  TractionIntegral sum;
  sum.add_linear(first * stretched.length, at(first), last * stretched.length, at(last));
  return sum;
}

void PairForces::append_bonds(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number) {
  for (const BondAtWork &bond : bonds_) {
    if (bond.broken) {
      continue;
    }
    const BondOpening &stretched = bond.stretched;
    RegionForce &force = append_force();
    memory_.push_back(bond.memory);
    damping_dyad_ = {};
    force.pair = number;
    force.bonded = true;
    force.normal = -stretched.normal;
    force.normal_force = -bond.pull;
    force.point = bond.middle();
    force.grip = force.point;
    force.origin = force.point;
    force.cap = bond.cap;
    force.extent_begin = -0.5 * stretched.length;
    force.extent_end = 0.5 * stretched.length;
    const Vec2 along = (1.0 / stretched.length) * (stretched.end[1] - stretched.end[0]);
    const auto moment_of = [&](double total, double first) {
      return (first - 0.5 * stretched.length * total) * along;
    };
    const Vec2 pull = bond.pull * stretched.normal;
    const Mat2 pull_dyad = outer(moment_of(bond.pull, bond.pull_moment), stretched.normal);
    force.force = pull;
    force.dyad = pull_dyad;

    const RelativeVelocity velocity(system, pair, force.origin);
    const TractionIntegral drag = bond.drag(velocity, along);
    const Vec2 drag_moment = moment_of(drag.total, drag.along);
    force.force += drag.total * stretched.normal;
    force.dyad += outer(drag_moment, stretched.normal);
    add_damping(force, drag.total * stretched.normal, drag_moment, stretched.normal);
    double viscous = 0.0;
    if (parameters_->has_dashpots()) {
      const double stiffness = bond.constants.tangential_stiffness * bond.memory.longest;
      viscous = (2.0 * parameters_->damping_ratio * std::sqrt(stiffness * pair.mass) +
                 parameters_->stiffness_damping * stiffness) *
                dot(velocity.at({}), perp(force.normal));
    }
    add_shear(force, bond.memory.shear, viscous);
    finish_region(system, pair, force);
    // The pull goes with the elastic forces of the ledger.
    force.shear_force += pull;
    for (const std::size_t k : {0U, 1U}) {
      const std::size_t row = (k == 0 ? pair.lower : pair.higher).value;
      const double torque =
          pull_dyad.xy - pull_dyad.yx + cross(force.point - system.motion[row].centroid, pull);
      force.shear_torque[k] += k == 0 ? torque : -torque;
    }
    note_dyads(system, pair, force, pull_dyad);
    note(system, pair, force);
  }
}

} // namespace gcpdda
