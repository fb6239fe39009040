#include "contact/opened_regions.hpp"

#include "contact/block_view.hpp"
#include "contact/geometry/overlap_energy.hpp"
#include "contact/pair_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

/// Share of the pair's energy that is in the regions for which `counts` holds.
template <class Counts> double energy_share(const Overlap &overlap, Counts &&counts) {
  double all = 0.0;
  double counted = 0.0;
  for (const Region &region : overlap.regions()) {
    const double weight = energy_weight(overlap, region);
    all += weight;
    counted += counts(region) ? weight : 0.0;
  }
  return all > 0.0 ? counted / all : 0.0;
}

} // namespace

Rotation opening_axes(const BlockSystem &system, const CandidatePair &pair) {
  return Rotation::of(0.5 * (system.trial[pair.lower.value].r + system.trial[pair.higher.value].r));
}

void ClosedPair::move(const BlockSystem &system, const CandidatePair &pair, Vec2 opening) {
  const Vec2 turned = opening_axes(system, pair)(opening);
  for (const std::size_t k : {0U, 1U}) {
    const Vec2 shift = (k == 0 ? -0.5 : 0.5) * turned;
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

bool goes_with_opening(const BlockSystem &system, const CandidatePair &pair, const RegionMemory &memory,
                       Vec2 normal) {
  constexpr double cosine = 0.7; // of about 45 degrees
  const Vec2 opening = opening_axes(system, pair)(memory.opening);
  return dot(opening, normal) >= cosine * norm(opening) * norm(normal);
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
    if (!(sum.pressure > 0.0) || !goes_with_opening(system, pair, memory, sum.force)) {
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

double opened_energy(const BlockSystem &system, const CandidatePair &pair,
                     const ContactParameters &parameters, std::span<const RegionMemory> known,
                     const BlockView &lower, const BlockView &higher, double half_stiffness_of_rest) {
  Overlap overlap;
  ClosedPair closed;
  double sum = 0.0;
  for (const RegionMemory &memory : known) {
    if (!memory.is_opened()) {
      continue;
    }
    closed.move(system, pair, memory.opening);
    if (!closed.lower().box.meets(closed.higher().box) ||
        !overlap.find(closed.lower(), closed.higher(), parameters.potential)) {
      continue;
    }
    const Region *own = region_of(system, pair, overlap, memory);
    sum += parameters.constants(memory.law >= 0 ? memory.law : pair.law).half_stiffness *
           overlap_energy(closed.lower(), closed.higher()) *
           energy_share(overlap, [&](const Region &region) { return &region == own; });
  }
  if (pair.is_convex || !overlap.find(lower, higher, parameters.potential)) {
    return sum;
  }
  const auto is_fresh = [&](const Region &region) {
    return std::none_of(known.begin(), known.end(), [&](const RegionMemory &memory) {
      return memory.is_opened() && region.faces == RegionFaces{memory.lower_stretch, memory.higher_stretch};
    });
  };
  return sum + half_stiffness_of_rest * overlap_energy(lower, higher) * energy_share(overlap, is_fresh);
}

const Region *PairForces::find_opened(const BlockSystem &system, const CandidatePair &pair,
                                      const RegionMemory &memory, Vec2 opening) {
  closed_.move(system, pair, opening);
  return closed_.lower().box.meets(closed_.higher().box) &&
                 overlap_.find(closed_.lower(), closed_.higher(), parameters_->potential)
             ? region_of(system, pair, overlap_, memory)
             : nullptr;
}

// Without a force, as long as it is not open by as much again.
void PairForces::keep_open(const BlockSystem &system, const CandidatePair &pair, std::uint32_t number,
                           const RegionMemory &known) {
  RegionForce nearest;
  const Region *region = find_opened(system, pair, known, 2.0 * known.opening);
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
  RegionMemory &memory = memory_.emplace_back(known);
  memory.shear = 0.0;
  memory.longest = 0.0;
  memory.state = ContactState::slip;
}

void PairForces::add_opening_works(const Candidates &candidates, BlockSystem &system) {
  // Interior pairs were evaluated before those with a ghost: sums of a block go by its partners' ids, and
  // then by the regions.
  std::sort(opening_works_.begin(), opening_works_.end(), [](const OpeningWork &a, const OpeningWork &b) {
    return std::tie(a.pair, a.found_as) < std::tie(b.pair, b.found_as);
  });
  for (const OpeningWork &work : opening_works_) {
    const CandidatePair &pair = candidates.pairs[work.pair];
    const bool alone = system.is_fixed(pair.lower.value) || system.is_fixed(pair.higher.value);
    for (const BlockIndex row : {pair.lower, pair.higher}) {
      if (row.value < system.num_owned) {
        system.ledger[row.value].shear += (alone ? 1.0 : 0.5) * work.work;
      }
    }
  }
  opening_works_.clear();
}

} // namespace gcpdda
