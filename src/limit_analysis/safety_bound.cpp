#include "limit_analysis/safety_bound.hpp"

#include "dynamics/deformable.hpp"
#include "limit_analysis/limit_analysis.hpp"
#include "limit_analysis/limit_regions.hpp"
#include "limit_analysis/support_reserves.hpp"
#include "simulation/evaluation.hpp"
#include "simulation/static_stage.hpp"
#include "simulation/step_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace gcpdda {

namespace {

/// How far a block slides on and may still find hold, in sizes of it.
constexpr double slip_that_may_end = 0.1;
/// How far one moves that stays as it lies: gaps and overlaps of contacts are smaller.
constexpr double slip_at_rest = 1e-3;

/// All pairs become candidates whose joint may close when one of them slides so far.
void look_farther(RunState &run) {
  double largest = 0.0;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    largest = std::max(largest, size_of_mobile(run.blocks.properties[row]));
  }
  run.communicator.max(std::span(&largest, 1));
  // Boxes of blocks are half a skin larger, and those of fixed ones no larger.
  run.neighbours.base_skin = 2.0 * slip_that_may_end * largest;
  refresh(run);
}

struct OwnedBlock {
  std::int64_t id;
  LimitBlock block;
};

template <class T> std::vector<T> gathered(const Communicator &communicator, const std::vector<T> &mine) {
  std::vector<T> all;
  for (const std::vector<T> &part : communicator.all_gather(mine)) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// A stage without steps has changed the scene since the blocks came to rest.
bool is_changed(const Simulation &settled) {
  return !settled.state().clock.stage().takes_steps();
}

/// All forces on owned rows with the loads that stay, after an evaluation of the contacts.
void complete_loads(RunState &run) {
  run.loads.time = end_of_loads(run);
  run.local_damping = 0.0; // its share is no load
  accelerate_owned(run);
}

/// Add what nothing balances on a row.
void add_unbalanced(const BlockSystem &blocks, std::size_t row, LimitBlock &block) {
  const RigidDof force = blocks.contact[row].force + blocks.anchor_force(row);
  block.load = block.load + force.u;
  block.torque += force.r;
  if (blocks.is_deformable(row)) { // the moment stands in the force on F alone
    const Deformation &d = blocks.deformation_of(row);
    const Mat2 dyad = d.trial * transposed(unbalanced_on_gradient(d));
    block.torque += dyad.xy - dyad.yx - force.r;
  }
}

/// Of all ranks, by id.
std::vector<OwnedBlock> all_mobile(const Simulation &settled) {
  std::vector<OwnedBlock> mine;
  for (std::size_t row = 0; row < settled.blocks().num_owned; ++row) {
    const BlockProperties &block = settled.blocks().properties[row];
    if (!block.keeps_its_velocity()) {
      mine.push_back(
          {block.id.value, {settled.blocks().motion[row].centroid, std::sqrt(block.area), {}, 0.0}});
      if (is_changed(settled)) {
        add_unbalanced(settled.blocks(), row, mine.back().block);
      }
    }
  }
  std::vector<OwnedBlock> all = gathered(settled.communicator(), mine);
  std::sort(all.begin(), all.end(), [](const OwnedBlock &a, const OwnedBlock &b) { return a.id < b.id; });
  return all;
}

/// Of all ranks, in an order that does not depend on their number.
std::vector<LimitRegion> all_regions(Simulation &settled, double slip) {
  std::vector<LimitRegion> all = gathered(settled.communicator(), limit_regions(settled, slip));
  put_in_order(all);
  return all;
}

/// What is divided further than at the settled state, to a bound between `least` and `most`.
std::optional<double> further_bound(Simulation &settled, double slip, double least, double most) {
  const std::vector<OwnedBlock> owned = all_mobile(settled);
  const auto number_of = [&](std::int64_t id) {
    const auto found =
        std::lower_bound(owned.begin(), owned.end(), id,
                         [](const OwnedBlock &block, std::int64_t key) { return block.id < key; });
    return id < 0 ? std::int64_t{-1} : std::int64_t{found - owned.begin()};
  };
  LimitModel model;
  for (const OwnedBlock &block : owned) {
    model.blocks.push_back(block.block);
  }
  for (const LimitRegion &region : all_regions(settled, slip)) {
    LimitJoint joint = region.joint;
    joint.first = number_of(region.joint.first);
    joint.second = number_of(region.joint.second);
    const std::array<std::int64_t, 2> ends{joint.first, joint.second};
    for (std::size_t side = 0; side < 2; ++side) {
      if (ends[side] >= 0) { // the load is what is out of balance but for contacts
        LimitBlock &block = model.blocks[static_cast<std::size_t>(ends[side])];
        block.load = block.load - region.force[side];
        block.torque -= region.torque[side];
      }
    }
    model.joints.push_back(joint);
  }
  for (LimitForce force : support_reserves(settled, slip)) {
    force.first = number_of(force.first);
    force.second = number_of(force.second);
    model.forces.push_back(force);
  }
  constexpr double tolerance = 1e-3;
  return bound_of_factor(model, least, most, tolerance);
}

} // namespace

SafetyBounds bounds_at(Simulation &settled, double settled_factor) {
  look_farther(settled.state());
  evaluate_still(settled.state());
  if (is_changed(settled)) {
    complete_loads(settled.state());
  }
  const StrengthReduction &reduction = settled.scene().reduction;
  const double least = reduction.from / settled_factor;
  const double most = reduction.to / settled_factor;
  const std::optional<double> sliding = further_bound(settled, slip_that_may_end, least, most);
  // All that holds as it lies holds with joints that may close, too.
  std::optional<double> resting = further_bound(settled, slip_at_rest, least, sliding.value_or(most));
  resting = resting ? resting : sliding;
  const auto whole = [&](std::optional<double> further) {
    return further ? std::optional(settled_factor * *further) : std::nullopt;
  };
  return {whole(sliding), whole(resting)};
}

} // namespace gcpdda
