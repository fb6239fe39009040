// The consistent initial state of a Simulation, and what is wrong with it.

#include "gcpdda/contact/bonds.hpp"
#include "gcpdda/contact/initial_friction.hpp"
#include "gcpdda/simulation/simulation.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace gcpdda {

namespace {

struct InitialOverlap {
  std::int64_t lower = 0;
  std::int64_t higher = 0;
  double depth = 0.0;
  double width = 0.0; ///< of the narrower block, m
};

constexpr double deepest_share = 0.05;

bool is_too_deep(const InitialOverlap &overlap) {
  return overlap.depth > deepest_share * overlap.width;
}

Diagnostic too_deep(const Scene &scene, const InitialOverlap &overlap) {
  return {Severity::error, block_position(scene, overlap.higher),
          fmt::format("blocks '{}' and '{}' overlap by {:.3g} m", block_name(scene, overlap.lower),
                      block_name(scene, overlap.higher), overlap.depth),
          fmt::format("more than 5 % of the narrower block's width {:.3g} m", overlap.width),
          "move or trim one of them"};
}

} // namespace

// Each rank tells its too deep pairs and the deepest of the others; all make the same list of them.
void Simulation::check_initial_overlaps() {
  std::vector<InitialOverlap> mine;
  InitialOverlap deepest;
  for_regions(0, candidates_.pairs.size(), [&](std::uint32_t number, std::span<const RegionForce> regions) {
    const CandidatePair &pair = candidates_.pairs[number];
    if (!counts_here(pair)) {
      return;
    }
    const BlockProperties &a = blocks_.properties[pair.lower.value];
    const BlockProperties &b = blocks_.properties[pair.higher.value];
    for (const RegionForce &force : regions) {
      const InitialOverlap overlap{a.id.value, b.id.value, force.overlap, std::min(a.width, b.width)};
      if (is_too_deep(overlap)) {
        mine.push_back(overlap);
      } else if (overlap.depth > deepest.depth) {
        deepest = overlap;
      }
    }
  });
  mine.push_back(deepest);
  std::vector<InitialOverlap> all;
  for (const auto &from_rank : communicator_.all_gather(mine)) {
    all.insert(all.end(), from_rank.begin(), from_rank.end());
  }
  std::sort(all.begin(), all.end(), [](const InitialOverlap &a, const InitialOverlap &b) {
    return std::pair(a.lower, a.higher) < std::pair(b.lower, b.higher);
  });
  constexpr std::size_t most = 100;
  std::size_t count = 0;
  for (const InitialOverlap &overlap : all) {
    if (!is_too_deep(overlap)) {
      deepest = overlap.depth > deepest.depth ? overlap : deepest;
    } else if (++count <= most) {
      notes_.push_back(too_deep(scene_, overlap));
    }
  }
  if (count > most) {
    notes_.push_back({Severity::error,
                      {},
                      fmt::format("{} more pairs of blocks overlap too deep", count - most),
                      "",
                      "move or trim one of each pair"});
  }
  if (count > 0) {
    local_fault_.reset(); // told better here
  } else if (deepest.depth > 0.0) {
    notes_.push_back(
        {Severity::info,
         {},
         fmt::format("the deepest initial overlap is {:.3g} m between blocks '{}' and '{}'", deepest.depth,
                     block_name(scene_, deepest.lower), block_name(scene_, deepest.higher)),
         "initial overlaps are contacts",
         ""});
  }
}

// The blocks of a bond must stay candidates until it breaks.
void Simulation::check_bonds() {
  for (const JointLaw &law : scene_.joints.laws) {
    const double opening = law.tension / law.normal_stiffness;
    if (law.has_bonds && opening > 0.5 * base_skin_) {
      notes_.push_back(
          {Severity::error,
           {},
           fmt::format("bonds of [joint.{}] open by {:.3g} m before they break", law.name, opening),
           fmt::format("that is tension/normal_stiffness, and blocks are looked for within {:.3g} m",
                       0.5 * base_skin_),
           "raise normal_stiffness or lower tension"});
    }
  }
}

void Simulation::accelerate_owned() {
  sum_forces();
  prepare_forces();
  blocks_.body = {gravity(), ground_acceleration()};
  gather_forces(0, blocks_.num_owned, blocks_.body);
  accelerate(blocks_);
  prescribe_motion();
}

// a_0 = M^-1 F(0): constant acceleration is then exact from the first step.
void Simulation::find_initial_state() {
  check_bonds(); // told with the other faults of the initial state
  bond_joints(blocks_, candidates_, contacts_.parameters().joints, in_situ_overlap_, history_);
  take(contacts_.evaluate(blocks_, candidates_, history_)); // ghosts are whole copies yet
  evaluate_bolts();
  check_initial_overlaps();
  explain_slivers();
  if (scene_.run.initial_friction == InitialFriction::consistent && !scene_.in_situ.present) {
    find_initial_friction();
  } else {
    if (scene_.in_situ.present) {
      put_initial_shear();
    }
    accelerate_owned();
  }
  progress_.report.rows_to_check = {{0, blocks_.num_owned}};
  report();
  counters_.evaluations = 0; // these are of steps
  counters_.block_steps = 0;
  counters_.contact_steps = 0;
  counters_.messages = 0;
  counters_.bytes = 0;
}

void Simulation::find_initial_friction() {
  InitialStick stick(blocks_, candidates_, contacts_, history_);
  ghosts_.copy(stick.contact_counts());
  const auto sweep = [&] {
    ghosts_.copy_accelerations(blocks_);
    double residual = stick.sweep();
    communicator_.max(std::span(&residual, 1));
    accelerate_owned();
    return residual;
  };
  constexpr int num_sweeps = 50;
  accelerate_owned();
  const double before = sweep();
  double after = before;
  for (int done = 1; done <= num_sweeps && after > 0.0; ++done) {
    after = sweep();
  }
  if (before > 0.0 && !(after < before)) {
    stick.reset();
    accelerate_owned();
    notes_.push_back(
        {Severity::info,
         {},
         "friction starts at zero",
         fmt::format("{} sweeps did not bring the initial stick forces nearer to equilibrium", num_sweeps),
         ""});
  }
}

} // namespace gcpdda
