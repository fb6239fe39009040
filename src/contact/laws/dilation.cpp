#include "contact/laws/dilation.hpp"

#include "contact/contact_forces.hpp"
#include "contact/laws/bond_work.hpp"
#include "contact/laws/region_law.hpp"
#include "contact/pair_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

/// The axes RegionMemory::dilation is kept in.
Rotation dilation_axes(const BlockSystem &system, const CandidatePair &pair) {
  return Rotation::of(0.5 * (system.trial[pair.lower.value].r + system.trial[pair.higher.value].r));
}

/// An opening in those axes.
Vec2 kept(const BlockSystem &system, const CandidatePair &pair, Vec2 opening) {
  const Rotation axes = dilation_axes(system, pair);
  return Rotation{axes.c, -axes.s}(opening);
}

} // namespace

void ClosedPair::move(const BlockSystem &system, const CandidatePair &pair, Vec2 dilation) {
  const Vec2 opening = dilation_axes(system, pair)(dilation);
  for (const std::size_t k : {0U, 1U}) {
    const Vec2 shift = (k == 0 ? -0.5 : 0.5) * opening;
    BlockView &view = view_[k];
    view = view_of(system, (k == 0 ? pair.lower : pair.higher).value, outline_[k]);
    for (Vec2 &x : outline_[k].vertex) {
      x += shift;
    }
    view.box = bounding_box(view.vertex);
    if (view.frame) {
      view.frame->centre += shift;
    }
  }
}

const Region *region_of(const BlockSystem &system, const CandidatePair &pair, const Overlap &overlap,
                        const RegionMemory &memory) {
  if (pair.is_convex) {
    return overlap.regions().empty() ? nullptr : overlap.regions().data();
  }
  const Region *nearest = nullptr;
  double smallest = std::numeric_limits<double>::infinity();
  for (const Region &region : overlap.regions()) {
    if (region.faces != RegionFaces{memory.lower_stretch, memory.higher_stretch}) {
      continue;
    }
    const RegionIntegrals sum = overlap.integrate(region);
    if (!(sum.pressure > 0.0)) {
      continue;
    }
    const Vec2 point =
        sum.origin + Vec2{sum.pressure_moment.x / sum.pressure, sum.pressure_moment.y / sum.pressure};
    const double distance = norm(reference_point(system, pair.lower.value, point) - memory.position);
    if (distance < smallest) {
      smallest = distance;
      nearest = &region;
    }
  }
  return nearest;
}

double energy_weight(const Overlap &overlap, const Region &region) {
  double weight = 0.0;
  for (const Piece &piece : overlap.pieces().subspan(region.begin, region.end - region.begin)) {
    const double depth = piece.depth_begin + piece.depth_end;
    weight += piece.length * depth * depth;
  }
  return weight;
}

const Region *ContactForces::find_dilated(const BlockSystem &system, const CandidatePair &pair,
                                          const RegionMemory &memory, Vec2 dilation) {
  closed_.move(system, pair, dilation);
  return closed_.lower().box.meets(closed_.higher().box) &&
                 overlap_.find(closed_.lower(), closed_.higher(), parameters_.potential)
             ? region_of(system, pair, overlap_, memory)
             : nullptr;
}

// How far the blocks slide on each other about where they meet, off the direction in which they open.
double ContactForces::guessed_slip(const BlockSystem &system, const CandidatePair &pair,
                                   const RegionMemory &known) {
  closed_.move(system, pair, known.dilation);
  const Aabb &a = closed_.lower().box;
  const Aabb &b = closed_.higher().box;
  const Vec2 middle = 0.5 * (Vec2{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)} +
                             Vec2{std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)});
  const Vec2 slide = slide_at(system, pair, middle);
  return std::abs(cross(dilation_axes(system, pair)(known.dilation), slide)) / norm(known.dilation);
}

// To first order from a contact in which `guess` has been opened already; `force` is for k_n/2 = 1.
double ContactForces::consistent_slip(const BlockSystem &system, const CandidatePair &pair,
                                      const RegionMemory &known, const RegionForce &force,
                                      double guess) const {
  const JointLaw &law = parameters_.joints.laws[static_cast<std::size_t>(pair.law)];
  const double extent = force.extent_end - force.extent_begin;
  const LawConstants constants = law.constants();
  const double normal_force = constants.half_stiffness * force.normal_force;
  const double tan_friction = law.is_barton_bandis && extent > 0.0
                                  ? law.tan_friction_at(normal_force / extent)
                                  : constants.tan_friction;
  const double stiffness = constants.tangential_stiffness * std::max(known.longest, extent);
  const Vec2 slide = slide_at(system, pair, force.point);
  const double trial = known.shear + stiffness * dot(slide, perp(force.normal));
  const double by_opening = 2.0 * constants.half_stiffness * extent * law.tan_dilation * tan_friction;
  const double excess = std::abs(trial) - (normal_force * tan_friction + constants.cohesion * extent);
  return std::max(0.0, (excess + by_opening * guess) / (stiffness + by_opening));
}

void ContactForces::evaluate_dilated(const BlockSystem &system, const CandidatePair &pair,
                                     std::uint32_t number, const RegionMemory &known) {
  const CandidatePair constants = constants_of(system, parameters_, pair, known.law);
  const JointLaw &law = parameters_.joints.laws[static_cast<std::size_t>(constants.law)];
  const bool opens = law.dilates() && known.longest > 0.0 && known.slip < law.dilation_limit;
  RegionForce force;
  const Region *region = nullptr;
  const auto touches_after = [&](double slip) {
    const double opened = law.dilation_at(known.slip + slip) - law.dilation_at(known.slip);
    force = {};
    region = find_dilated(system, pair, known, (1.0 + opened / norm(known.dilation)) * known.dilation);
    return region != nullptr && measure(*region, force);
  };
  const double guess = opens && known.state == ContactState::slip ? guessed_slip(system, pair, known) : 0.0;
  bool touches = touches_after(guess);
  if (touches && opens && !force.normal_undefined) {
    if (const double slip = consistent_slip(system, constants, known, force, guess); slip != guess) {
      touches = touches_after(slip);
    }
  }
  if (!touches) {
    keep_open(system, pair, number, known);
    return;
  }
  force.pair = number;
  force.born = known.longest == 0.0;
  damping_dyad_ = {};
  RegionMemory memory = known;
  if (!pair.is_convex) {
    memory.position = reference_point(system, pair.lower.value, force.point);
  }
  append_force(force);
  next_.regions.push_back(memory);
  const BondShare share = bonds_.empty() ? BondShare{} : share_of_bonds(pair, *region);
  load_region(system, constants, *region, share, next_.regions.back(), forces_[num_forces_ - 1]);
}

// Without a force, as long as it is not open by as much again.
void ContactForces::keep_open(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                              const RegionMemory &known) {
  RegionForce nearest;
  const Region *region = find_dilated(system, pair, known, 2.0 * known.dilation);
  if (region == nullptr || !measure(*region, nearest)) {
    return;
  }
  RegionForce &force = append_force();
  force.pair = number;
  force.point = nearest.point;
  force.grip = nearest.point;
  force.origin = nearest.point;
  force.normal = nearest.normal;
  damping_dyad_ = {};
  note_dyads(system, pair, force);
  RegionMemory &memory = next_.regions.emplace_back(known);
  memory.shear = 0.0;
  memory.longest = 0.0;
  memory.state = ContactState::slip;
}

void ContactForces::dilate(const BlockSystem &system, const CandidatePair &pair, double slip_before,
                           const RegionForce &force, RegionMemory &memory) {
  const JointLaw &law = parameters_.joints.laws[static_cast<std::size_t>(pair.law)];
  const double opened = law.dilation_at(memory.slip) - law.dilation_at(slip_before);
  if (opened > 0.0) {
    memory.dilation += kept(system, pair, opened * force.normal);
    dilation_works_.push_back({force.pair, opened * force.normal_force});
  }
}

void ContactForces::add_dilation_works(const Candidates &candidates, BlockSystem &system) {
  // Interior pairs were evaluated before those with a ghost: sums of a block go by its partners' ids.
  std::sort(dilation_works_.begin(), dilation_works_.end(),
            [](const DilationWork &a, const DilationWork &b) { return a.pair < b.pair; });
  for (const DilationWork &work : dilation_works_) {
    const CandidatePair &pair = candidates.pairs[work.pair];
    const bool alone = system.is_fixed(pair.lower.value) || system.is_fixed(pair.higher.value);
    for (const BlockIndex row : {pair.lower, pair.higher}) {
      if (row.value < system.num_owned) {
        system.ledger[row.value].shear += (alone ? 1.0 : 0.5) * work.work;
      }
    }
  }
  dilation_works_.clear();
}

} // namespace gcpdda
