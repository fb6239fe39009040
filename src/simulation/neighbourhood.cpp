#include "simulation/neighbourhood.hpp"

#include "contact/find_pairs.hpp"
#include "dynamics/integrate.hpp"
#include "parallel/migration.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace gcpdda {

namespace {

/// Runs of rows that hold one that must wait, as long as the SIMD lanes.
std::vector<RowSpan> waiting_rows(const BlockSystem &blocks, const Candidates &candidates) {
  constexpr std::size_t rows_together = 8; // most rows in the SIMD lanes
  std::vector<RowSpan> waiting;
  for (std::size_t first = 0; first < blocks.num_owned; first += rows_together) {
    const std::size_t last = std::min(blocks.num_owned, first + rows_together);
    const std::uint8_t *is_added = candidates.is_added.data();
    if (std::find(is_added + first, is_added + last, 0) == is_added + last) {
      continue;
    }
    if (waiting.empty() || waiting.back().last < first) {
      waiting.push_back({first, first});
    }
    waiting.back().last = last;
  }
  return waiting;
}

/// The most by which bonds of any law open before they break, m. A stage may raise it.
double largest_stretch(const JointLaws &joints) {
  double largest = 0.0;
  for (const JointLaw &law : joints.laws) {
    if (law.has_bonds) {
      largest = std::max(largest, law.tension / law.normal_stiffness);
    }
  }
  return largest;
}

} // namespace

PlacedBlocks Neighbourhood::place(BlockSystem blocks) const {
  PlacedBlocks placed{std::move(blocks), {}};
  ContactMemory none;
  migrate(communicator, map, placed.blocks, none);
  Ghosts around(communicator);
  around.rebuild(placed.blocks, reach_boxes(placed.blocks, base_skin));
  placed.pairs = find_pairs(placed.blocks, reach_boxes(placed.blocks, base_skin));
  return placed;
}

std::int64_t Neighbourhood::refresh(BlockSystem &blocks, const ContactParameters &parameters, Bolts &bolts,
                                    ContactMemory memory, double least_skin, double time_step) {
  // Rows change places. What is made anew goes first: old and new lists together would be the largest thing
  // in memory.
  blocks.motion = {};
  candidates = {};
  history.plain = {};
  const std::int64_t left = migrate(communicator, map, blocks, memory);

  // Fast blocks would use up the usual skin at once: it grows so that half of it outlasts several steps.
  constexpr double steps_in_skin = 16.0;
  std::array<double, 2> largest{};
  auto &[reach, opening] = largest;
  for (const RegionRecord &record : memory.others) { // a joint that its law has opened still acts
    opening = std::max(opening, norm(record.memory.opening));
  }
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    reach = std::max(reach, motion_bound(blocks, row, time_step));
    blocks.refreshed[row] = blocks.displacement[row];
    if (blocks.is_deformable(row)) {
      Deformation &d = blocks.deformation_of(row);
      d.refreshed = d.gradient;
    }
  }
  communicator.max(largest);
  opening += parameters.joints.largest_opening();
  skin = std::max(least_skin, steps_in_skin * reach);

  // A joint that its law has opened is remembered until it is open by twice that, a bond until it breaks;
  // only one of the blocks may be inflated.
  const double reach_skin = std::max(skin, 2.0 * largest_stretch(parameters.joints)) + 4.0 * opening;
  std::vector<Aabb> boxes = reach_boxes(blocks, reach_skin);
  ghosts.rebuild(blocks, boxes, bolts.partners(communicator, blocks), &map);
  border_trials.reserve(ghosts.sent_rows().size());
  const std::vector<Aabb> ghost_boxes =
      reach_boxes(blocks, reach_skin, blocks.num_owned, blocks.first_fixed());
  boxes.insert(boxes.begin() + static_cast<std::ptrdiff_t>(blocks.num_owned), ghost_boxes.begin(),
               ghost_boxes.end());
  const auto pairs = find_pairs(blocks, boxes);
  boxes = {};
  candidates = make_candidates(blocks, pairs, parameters, std::move(memory), history, skin);
  pose(blocks, blocks.first_fixed(), blocks.num_rows());
  pose_in_lanes(blocks, 0, blocks.num_mobile());
  bolts.connect(blocks);
  waiting = waiting_rows(blocks, candidates);
  stale = false;
  return left;
}

bool Neighbourhood::rebalance(const BlockSystem &blocks, std::int64_t work) {
  if (!balance.is_lost(work)) {
    return false;
  }
  std::vector<Vec2> centroids;
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    centroids.push_back(blocks.centroid(row));
  }
  std::optional<DomainMap> better =
      balance.better_map(centroids, work_of_blocks(blocks, candidates), partition);
  if (!better) {
    return false;
  }
  map = std::move(*better);
  stale = true;
  return true;
}

RegionRecord Neighbourhood::record_of(const BlockSystem &blocks, std::size_t pair,
                                      const RegionMemory &region) const {
  return {blocks.properties[candidates.pairs[pair].lower.value].id,
          blocks.properties[candidates.pairs[pair].higher.value].id, region};
}

ContactMemory Neighbourhood::remembered(const BlockSystem &blocks) const {
  ContactMemory memory;
  memory.plain.reserve(history.num_plain());
  for (std::size_t k = 0; k < candidates.pairs.size(); ++k) {
    const CandidatePair &pair = candidates.pairs[k];
    const bool deforms =
        blocks.is_deformable(pair.lower.value) || blocks.is_deformable(pair.higher.value); // has a grip, too
    if (history.has_plain(k) && !deforms) {
      memory.plain.push_back({blocks.properties[pair.lower.value].id, blocks.properties[pair.higher.value].id,
                              history.plain[k]});
    } else {
      history.for_pair(
          k, [&](const RegionMemory &region) { memory.others.push_back(record_of(blocks, k, region)); });
    }
  }
  return memory;
}

} // namespace gcpdda
