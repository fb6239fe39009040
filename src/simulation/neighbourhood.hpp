#pragma once

// Who is near whom: the map of cells to ranks, ghosts, candidate pairs and what contacts remember.
//
// A refresh finds all of it anew, on a finished state: blocks migrate to the rank that owns their centroid,
// then ghosts and candidates are found within a skin. The neighbourhood holds until some block may have used
// up half of the skin.

#include "contact/candidates.hpp"
#include "dynamics/integrate.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "parallel/ghosts.hpp"
#include "partition/domain_map.hpp"
#include "partition/partition_cells.hpp"
#include "simulation/balance.hpp"
#include "simulation/bolts.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace gcpdda {

/// Blocks on the ranks that own them, with ghosts, and the pairs whose boxes meet.
struct PlacedBlocks {
  BlockSystem blocks;
  std::vector<std::pair<BlockIndex, BlockIndex>> pairs;
};

struct Neighbourhood {
  explicit Neighbourhood(const Communicator &world) : communicator(world), balance(world), ghosts(world) {}

  Communicator communicator;
  DomainMap map;
  PartitionReport partition;
  Balance balance;
  Ghosts ghosts;
  Candidates candidates;
  ContactHistory history;
  /// Rows that cannot be advanced with their group of pairs, in runs.
  std::vector<RowSpan> waiting;
  std::vector<TrialConfiguration> border_trials; ///< by entry of Ghosts::sent_rows()
  double base_skin = 0.0;                        ///< of blocks at rest, m
  double skin = 0.0;                             ///< m
  bool stale = true;                             ///< a step must not begin before a refresh

  /// What is remembered of all contacts, by the ids of their blocks.
  [[nodiscard]] ContactMemory remembered(const BlockSystem &blocks) const;
  [[nodiscard]] RegionRecord record_of(const BlockSystem &blocks, std::size_t pair,
                                       const RegionMemory &region) const;

  /// Place a copy of the blocks of the slabs, of which nothing has been evaluated yet. Collective.
  [[nodiscard]] PlacedBlocks place(BlockSystem blocks) const;

  /// Collective.
  /// @param memory  of contacts; that of the present candidates has been taken out
  /// @param least_skin  m
  /// @param time_step  s, for how far blocks go
  /// @return how many blocks have left this rank
  std::int64_t refresh(BlockSystem &blocks, const ContactParameters &parameters, Bolts &bolts,
                       ContactMemory memory, double least_skin, double time_step);

  /// Cut the map again if this rank's work since the start shows that it is uneven; blocks follow by the
  /// migration of a refresh. Collective.
  /// @return whether there is a new map
  bool rebalance(const BlockSystem &blocks, std::int64_t work);
};

} // namespace gcpdda
