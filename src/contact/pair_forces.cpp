#include "contact/pair_forces.hpp"

#include "contact/block_view.hpp"
#include "contact/laws/bond_work.hpp"
#include "contact/laws/dilation.hpp"
#include "contact/laws/grip.hpp"
#include "contact/laws/region_law.hpp"
#include "contact/pair_motion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

namespace gcpdda {

namespace {

double deepest(std::span<const Piece> pieces) {
  double depth = 0.0;
  for (const Piece &piece : pieces) {
    depth = std::max({depth, piece.depth_begin, piece.depth_end});
  }
  return depth;
}

/// Thickness along n_r and extent along t_r of the pieces, relative to x_r.
void measure_region(std::span<const Piece> pieces, RegionForce &force) {
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

/// u.n of a piece: how far it faces the other block along n_r.
double facing_of(const Piece &piece, bool is_lower, Vec2 normal) {
  return is_lower ? -dot(normal, piece.normal) : dot(normal, piece.normal);
}

void take(const std::optional<Grip> &grip, RegionMemory &memory, RegionForce &force) {
  if (grip) {
    memory.grip = grip->reference();
    force.grip = grip->point();
  }
}

/// Where a region has no shear.
void take_middle(std::optional<Grip> &grip, RegionMemory &memory, RegionForce &force) {
  if (grip) {
    grip->move_to_middle();
    take(grip, memory, force);
  }
}

} // namespace

PairForces::PairForces(std::shared_ptr<const ContactParameters> parameters)
    : parameters_(std::move(parameters)) {}
PairForces::~PairForces() = default;
PairForces::PairForces(PairForces &&) noexcept = default;
PairForces &PairForces::operator=(PairForces &&) noexcept = default;

void PairForces::begin(bool keeps) {
  if (keeps) {
    std::swap(forces_, before_);
  }
  num_forces_ = 0;
  memory_.clear();
  opening_works_.clear();
  report_ = {};
}

std::size_t PairForces::evaluate(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                                 std::span<RegionMemory> old) {
  first_of_pair_ = num_forces_;
  dyads_.clear();
  find_regions(system, pair, number, old);
  return num_forces_ - first_of_pair_;
}

void PairForces::keep_again(const BlockSystem &system, const CandidatePair &pair, RegionRange before,
                            std::span<const RegionMemory> memory) {
  first_of_pair_ = num_forces_;
  dyads_.clear();
  for (const RegionForce &force : std::span(before_).subspan(before.begin, before.count)) {
    RegionForce &again = append_force(force);
    again.born = false;
    note(system, pair, again);
  }
  memory_.insert(memory_.end(), memory.begin(), memory.end());
}

void PairForces::drop_last() {
  --num_forces_;
  memory_.pop_back();
}

RegionForce &PairForces::append_force(const RegionForce &force) {
  grow(forces_, num_forces_ + 1);
  return forces_[num_forces_++] = force;
}

bool PairForces::measure(const Region &region, RegionForce &force) const {
  const RegionIntegrals sum = overlap_.integrate(region);
  if (!(sum.pressure > 0.0)) {
    return false;
  }
  force.origin = sum.origin;
  force.force = sum.force;
  force.dyad = Mat2{sum.dyad[0], sum.dyad[1], sum.dyad[2], sum.dyad[3]};
  // Divided, not multiplied by the inverse: faces that just touch leave pressures whose inverse overflows.
  force.point = sum.origin + Vec2{sum.pressure_moment.x / sum.pressure, sum.pressure_moment.y / sum.pressure};
  force.grip = force.point; // unless a block deforms
  const double resultant = norm(sum.force);
  force.normal_force = resultant;
  const auto pieces = overlap_.pieces().subspan(region.begin, region.end - region.begin);
  if (resultant <= least_resultant * sum.pressure) { // of denormals both sides are 0
    force.normal_undefined = true;
    // No direction to measure along: twice the deepest point stands for the thickness.
    force.overlap = 2.0 * deepest(pieces);
  } else {
    force.normal = (1.0 / resultant) * sum.force;
    measure_region(pieces, force);
  }
  return true;
}

// A memory can be that of a region between the same stretches which the old and the new extent reach. The
// nearest two of all belong together, then the nearest of those that are left: a tip that has just begun to
// touch beside a joint does not take the joint's memory, whatever the order of the regions.
void PairForces::match_memories(const BlockSystem &system, const CandidatePair &pair,
                                std::span<RegionMemory> old) {
  matches_.clear();
  for (std::size_t k = 0; k < found_.size(); ++k) {
    FoundRegion &found = found_[k];
    found.position = reference_point(system, pair.lower.value, found.force.point);
    const double extent = found.force.extent_end - found.force.extent_begin;
    for (std::size_t m = 0; m < old.size(); ++m) {
      const double distance = norm(old[m].position - found.position);
      if (old[m].lower_stretch == found.region->faces.first &&
          old[m].higher_stretch == found.region->faces.second && distance <= old[m].longest + extent &&
          (!old[m].is_opened() || goes_with_opening(system, pair, old[m], found.force.normal))) {
        matches_.push_back({distance, k, m});
      }
    }
  }
  std::sort(matches_.begin(), matches_.end());
  for (const auto &[distance, k, m] : matches_) {
    RegionMemory *const nearest = &old[m];
    const bool is_taken = std::any_of(found_.begin(), found_.end(),
                                      [nearest](const FoundRegion &found) { return found.known == nearest; });
    if (found_[k].known == nullptr && !is_taken) {
      found_[k].known = nearest;
    }
  }
}

void PairForces::find_touching(const BlockSystem &system, const CandidatePair &pair,
                               std::span<RegionMemory> old) {
  found_.clear();
  for (const Region &region : overlap_.regions()) {
    FoundRegion found{&region, {}, {}, nullptr};
    if (measure(region, found.force)) {
      found_.push_back(found);
    }
  }
  if (!pair.is_convex) {
    match_memories(system, pair, old);
  } else if (!found_.empty() && !old.empty()) {
    found_.front().known = &old.front(); // its only region
  }
}

// What the spring has beyond its cap is slip.
void PairForces::slip(const BlockSystem &system, const CandidatePair &pair, const JointLaw &law,
                      double stiffness, RegionMemory &memory, const RegionForce &force) {
  const double slip_before = memory.slip;
  memory.slip += (std::abs(memory.shear) - force.cap) / stiffness;
  memory.shear = std::copysign(force.cap, memory.shear);
  memory.state = ContactState::slip;
  if (law.dilates()) {
    const double work = dilate(system, pair, law, slip_before, force, memory);
    opening_works_.push_back({force.pair, opening_works_.size(), work});
  }
}

void PairForces::add_friction(const BlockSystem &system, const CandidatePair &pair,
                              const RelativeVelocity &velocity, const BondShare &bonds, RegionMemory &memory,
                              RegionForce &force) {
  const double extent = force.extent_end - force.extent_begin;
  std::optional<Grip> grip; // none between rigid blocks
  if (has_grip(system, pair)) {
    grip.emplace(system, pair, force, memory.grip, force.born, memory.longest);
  }
  memory.longest = std::max(memory.longest, extent);
  if (bonds.holds) {
    memory.shear = 0.0;
    memory.state = ContactState::stick;
    take_middle(grip, memory, force);
    return;
  }
  const JointLaw &law = parameters_->joints.strength(pair.law);
  const LawConstants constants = parameters_->constants(pair.law);
  const double tan_friction =
      law.is_barton_bandis ? law.tan_friction_at(force.normal_force / extent) : constants.tan_friction;
  force.cap = force.normal_force * tan_friction + constants.cohesion * extent;
  memory.state = force.cap > 0.0 ? ContactState::stick : ContactState::slip;
  if (force.cap <= 0.0) {
    memory.shear = 0.0;
    take_middle(grip, memory, force);
    return;
  }
  take(grip, memory, force);
  const Vec2 tangent = perp(force.normal);
  const double stiffness = constants.tangential_stiffness * memory.longest;
  if (bonds.released) {
    // Stretched to this configuration already. A region without extent has no spring to take it.
    memory.shear += stiffness > 0.0 ? bonds.shear : 0.0;
  } else if (!force.born) {
    const Vec2 slide = slide_at(system, pair, force.grip);
    memory.shear += stiffness * dot(slide, tangent);
  }
  if (std::abs(memory.shear) > force.cap) {
    if (grip) {
      grip->slip(std::abs(memory.shear) - force.cap, force.cap);
      take(grip, memory, force);
    }
    slip(system, pair, law, std::max(stiffness, constants.tangential_stiffness * bonds.length), memory,
         force);
  }
  double viscous = 0.0;
  if (parameters_->has_dashpots()) {
    const double drag = (2.0 * parameters_->damping_ratio * std::sqrt(stiffness * pair.mass) +
                         parameters_->stiffness_damping * stiffness) *
                        dot(velocity.at(force.grip - force.origin), tangent);
    viscous = std::clamp(memory.shear + drag, -force.cap, force.cap) - memory.shear;
  }
  add_shear(force, memory.shear, viscous);
}

void PairForces::add_shear(RegionForce &force, double elastic, double viscous) {
  const Vec2 tangent = perp(force.normal);
  force.shear = elastic + viscous;
  force.shear_force = -elastic * tangent;
  const Vec2 drag = -viscous * tangent;
  add_damping(force, drag, force.grip - force.origin, drag);
  add_force(force, force.grip, -force.shear * tangent);
}

void PairForces::add_normal_dashpot(const CandidatePair &pair, const RelativeVelocity &velocity,
                                    const Region &region, RegionForce &force) {
  const Vec2 n = force.normal;
  // Closing speed (v_own - v_other).u at an offset from the origin, the same for both blocks' pieces.
  const double closing_at_origin = -dot(velocity.at_origin, n);
  const Vec2 closing_gradient = -transposed(velocity.gradient)(n);
  const std::span<const Piece> pieces = overlap_.pieces();

  // Share of the facing pieces' pressure along n_r that the resultant keeps: what may be taken away.
  facing_.resize(pieces.size());
  double facing_pressure = 0.0;
  for (std::uint32_t i = region.begin; i < region.end; ++i) {
    const Piece &piece = pieces[i];
    facing_[i] = std::max(0.0, facing_of(piece, i < region.middle, n));
    facing_pressure += facing_[i] * 0.5 * piece.length * (piece.depth_begin + piece.depth_end);
  }
  const double half_stiffness = parameters_->constants(pair.law).half_stiffness;
  const double share = std::min(1.0, force.normal_force / half_stiffness / facing_pressure);

  double total = 0.0;
  Vec2 moment;
  for (std::uint32_t i = region.begin; i < region.end; ++i) {
    const Piece &piece = pieces[i];
    if (facing_[i] <= 0.0) {
      continue;
    }
    const Vec2 begin = piece.begin - force.origin;
    const Vec2 tangent = perp(piece.normal);
    const double rate = pair.damping * facing_[i];
    const double releasable = share * facing_[i] * half_stiffness;
    const double closing = closing_at_origin + dot(closing_gradient, begin);
    const double closing_end = closing + piece.length * dot(closing_gradient, tangent);
    const std::array<double, 2> depth = overlap_.depth_floor(piece);
    const TractionIntegral q = integrate_without_tension(
        piece.length, releasable * depth[0], releasable * depth[1], rate * closing, rate * closing_end);
    total += q.total;
    moment += q.total * begin + q.along * tangent;
  }
  force.force += total * n;
  force.dyad += outer(moment, n);
  add_damping(force, total * n, moment, n);
}

void PairForces::add_damping(RegionForce &force, Vec2 f, Vec2 moment, Vec2 direction) {
  force.damping_force += f;
  damping_dyad_ += outer(moment, direction);
}

void PairForces::finish_region(const BlockSystem &system, const CandidatePair &pair, RegionForce &force) {
  for (const bool is_lower : {true, false}) {
    const std::size_t row = (is_lower ? pair.lower : pair.higher).value;
    const double sign = is_lower ? 1.0 : -1.0;
    const std::size_t k = is_lower ? 0 : 1;
    const Vec2 arm = force.origin - system.motion[row].centroid;
    const auto torque = [&](const Mat2 &dyad, Vec2 f) { return sign * (dyad.xy - dyad.yx + cross(arm, f)); };
    force.torque[k] = torque(force.dyad, force.force);
    force.shear_torque[k] = sign * cross(force.grip - system.motion[row].centroid, force.shear_force);
    force.damping_torque[k] = torque(damping_dyad_, force.damping_force);
  }
  note_dyads(system, pair, force);
}

void PairForces::note_dyads(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force,
                            const Mat2 &beyond) {
  if (!system.is_deformable(pair.lower.value) && !system.is_deformable(pair.higher.value)) {
    return;
  }
  const std::size_t number = num_forces_ - 1 - first_of_pair_;
  grow(dyads_, number + 1);
  const Vec2 centroid = system.motion[pair.lower.value].centroid;
  const Vec2 arm = force.origin - centroid;
  dyads_[number] = {force.dyad + outer(arm, force.force),
                    outer(force.grip - centroid, force.shear_force) + beyond,
                    damping_dyad_ + outer(arm, force.damping_force)};
}

// Region and memory join those of the evaluation.
void PairForces::load_found(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                            const FoundRegion &found) {
  const Region &region = *found.region;
  RegionForce &force = append_force(found.force);
  force.pair = number;
  force.born = found.known == nullptr;
  damping_dyad_ = {};
  RegionMemory &memory = memory_.emplace_back();
  if (!force.born) {
    memory = *found.known;
  }
  if (!pair.is_convex) {
    memory.position = found.position;
    memory.lower_stretch = region.faces.first;
    memory.higher_stretch = region.faces.second;
  }
  const BondShare share = bonds_.empty() ? BondShare{} : share_of_bonds(pair, region);
  if (!pair.is_mixed) {
    load_region(system, pair, region, share, memory, force);
    return;
  }
  const bool chooses = force.born || chooses_law(pair, memory);
  if (force.born && !pair.is_convex) {
    memory.law = law_beside(system, pair, region);
  }
  const std::int32_t before = memory.law;
  if (chooses) {
    choose_law(system, pair, region, memory);
  }
  load_region(system, constants_of(system, *parameters_, pair, memory.law), region, share, memory, force);
  if (chooses) {
    note_choice(pair, !force.born && memory.law != before, memory);
  }
}

// With the opening that its law gives it in this evaluation.
void PairForces::evaluate_opened(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                                 const RegionMemory &known) {
  const CandidatePair constants = constants_of(system, *parameters_, pair, known.law);
  const JointLaw &law = parameters_->joints.strength(constants.law);
  const bool opens = law.dilates() && known.longest > 0.0 && known.slip < law.dilation_limit;
  RegionForce force;
  const Region *region = nullptr;
  const auto touches_after = [&](double slip) {
    const double opened = law.dilation_at(known.slip + slip) - law.dilation_at(known.slip);
    force = {};
    region = find_opened(system, pair, known, (1.0 + opened / norm(known.opening)) * known.opening);
    return region != nullptr && measure(*region, force);
  };
  const double guess =
      opens && known.state == ContactState::slip ? guessed_slip(system, pair, known, closed_) : 0.0;
  bool touches = touches_after(guess);
  if (touches && opens && !force.normal_undefined) {
    if (const double slip = consistent_slip(system, constants, law, known, force, guess); slip != guess) {
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
  memory_.push_back(memory);
  const BondShare share = bonds_.empty() ? BondShare{} : share_of_bonds(pair, *region);
  load_region(system, constants, *region, share, memory_.back(), forces_[num_forces_ - 1]);
  if (chooses_law(pair, known)) { // for what follows
    choose_law(system, pair, *region, memory_.back());
    note_choice(pair, false, memory_.back());
  }
}

void PairForces::find_regions(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                              std::span<RegionMemory> old) {
  opened_.clear();
  std::copy_if(old.begin(), old.end(), std::back_inserter(opened_),
               [](const RegionMemory &m) { return m.is_opened(); });
  const bool all_opened = pair.is_convex && !opened_.empty(); // its only region
  const bool touches =
      !all_opened && system.motion[pair.lower.value].box.meets(system.motion[pair.higher.value].box) &&
      overlap_.find(view_of(system, pair.lower.value, outlines_[0]),
                    view_of(system, pair.higher.value, outlines_[1]), parameters_->potential);
  const auto first_bond =
      std::find_if(old.begin(), old.end(), [](const RegionMemory &m) { return m.is_bond(); });
  const std::span<RegionMemory> bonds(first_bond, old.end());
  old = old.first(old.size() - bonds.size());
  bonds_.clear();
  if (!bonds.empty()) {
    find_bonds(system, pair, touches ? overlap_.pieces() : std::span<const Piece>(), bonds);
  }
  found_.clear();
  if (touches) {
    find_touching(system, pair, old);
  }
  for (const FoundRegion &found : found_) {
    if (found.known != nullptr && found.known->is_opened()) { // on its own below
      continue;
    }
    load_found(system, pair, number, found);
  }
  for (const RegionMemory &known : opened_) {
    evaluate_opened(system, pair, number, known);
  }
  if (!bonds_.empty()) {
    append_bonds(system, pair, number);
  }
}

void PairForces::load_region(const BlockSystem &system, const CandidatePair &pair, const Region &region,
                             const BondShare &bonds, RegionMemory &memory, RegionForce &force) {
  const double half_stiffness = parameters_->constants(pair.law).half_stiffness;
  force.force = half_stiffness * force.force;
  force.dyad = half_stiffness * force.dyad;
  force.normal_force *= half_stiffness;
  if (force.normal_undefined) {
    memory.shear = 0.0;
    memory.state = ContactState::slip;
    if (has_grip(system, pair)) {
      memory.grip = reference_point(system, pair.lower.value, force.point);
    }
  } else {
    RelativeVelocity velocity(system, pair, force.origin);
    const Vec2 opening_before = memory.opening;
    add_friction(system, pair, velocity, bonds, memory, force);
    if (memory.opening != opening_before) { // what slip opens does not part the surfaces that touch
      const JointLaw &law = parameters_->joints.strength(pair.law);
      const double sliding = dot(velocity.at(force.grip - force.origin), perp(force.normal));
      velocity.at_origin -= law.tan_dilation * std::abs(sliding) * force.normal;
    }
    if (pair.damping > 0.0) {
      add_normal_dashpot(pair, velocity, region, force);
    }
  }
  finish_region(system, pair, force);
  note(system, pair, force);
}

void PairForces::note(const BlockSystem &system, const CandidatePair &pair, const RegionForce &force) {
  report_.normals_undefined += force.normal_undefined ? 1 : 0;
  report_.max_overlap = std::max(report_.max_overlap, force.overlap);
  report_.max_overlap_share = std::max(report_.max_overlap_share, 0.5 * force.overlap / pair.allowed_overlap);
  report_.note_depth(system, pair, force.overlap);
}

} // namespace gcpdda
