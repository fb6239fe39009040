#pragma once

// Who computes what, and when that changes.
//
// Work is counted, never timed: a step costs a rank one for each of its blocks and one for each candidate
// pair that it looks at closely; a pair across a border costs both ranks. The weight of a block is twice its
// share of that: two for itself, one for each such pair of the last step. The last step says more about the
// next ones than a sum over many: what falls has moved on.
//
// Hysteresis is twofold: a new map is made only when the work since the last look was more uneven than is
// tolerated and unevenness since the last map has cost a good part of what a map costs, and taken only when
// it is better by more than moving the blocks is worth. A map that was not taken raises what is tolerated. A
// map that is taken brings a refresh of the neighbourhood, which may come at any time.
//
// The grid is laid over the blocks as they lie then, few strays left out, so that a pile that has left its
// place is still cut into small cells. No result depends on any of this.

#include "contact/candidates.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "partition/domain_map.hpp"
#include "partition/partition_cells.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gcpdda {

/// Twice the share of each owned row in the work of a step.
class WorkOfBlocks {
public:
  explicit WorkOfBlocks(std::size_t num_owned) : work_(num_owned, 2) {}
  /// Of rows whose boxes meet.
  void add_pair(BlockIndex lower, BlockIndex higher);
  [[nodiscard]] const std::vector<std::int64_t> &counted() const { return work_; }

private:
  std::vector<std::int64_t> work_;
};
/// That of candidates at the system's trial configuration.
std::vector<std::int64_t> work_of_blocks(const BlockSystem &system, const Candidates &candidates);

/// Grid over the mobile blocks of all ranks, known by their centroids: about a cell for two blocks, up to
/// two for each where these are few, so that balance is fine and a new map soon made, but never more than all
/// ranks can hold. Collective.
CellGrid lay_grid(const Communicator &communicator, std::span<const Vec2> centroids);

/// Sum by cell of everybody's weighted points. Collective.
std::vector<std::int64_t> weights_by_cell(const Communicator &communicator, const CellGrid &grid,
                                          std::span<const Vec2> points,
                                          std::span<const std::int64_t> weights);

/// Watches the balance of a run.
class Balance {
public:
  explicit Balance(const Communicator &communicator) : communicator_(communicator) {}

  /// Whether it is time for a new map: the same on all ranks. To be asked after equal numbers of steps.
  /// Collective.
  /// @param work  of this rank since the start of the run
  bool is_lost(std::int64_t work);

  /// A better map for blocks of these weights, each part with the rank that owns most of it; nothing where
  /// none is better. Collective.
  std::optional<DomainMap> better_map(std::span<const Vec2> centroids, std::span<const std::int64_t> weights,
                                      PartitionReport &report);

private:
  Communicator communicator_;
  std::int64_t work_before_ = 0;
  double measured_ = 1.0;
  double tolerated_ = least_tolerated;
  double lost_ = 0.0; ///< sum of max/mean - 1 over the calls since the last map

  static constexpr double least_tolerated = 1.01; ///< max/mean of the work
  static constexpr double least_gain = 1.005;
  /// What unevenness may cost first, in the time between two calls, 64 steps. A map and the refresh behind it
  /// take about ten steps on two ranks; a third of that keeps the sum of both small.
  static constexpr double worth_a_map = 0.05;
};

} // namespace gcpdda
