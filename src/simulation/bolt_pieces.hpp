#pragma once

// Where a bolt crosses which blocks.

#include "dynamics/bolt_link.hpp"
#include "gcpdda/model/scene.hpp"
#include "model/block_system.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace gcpdda {

/// A stretch of a bolt within one block, as shares of its way from head to tip.
struct BoltPiece {
  std::int64_t bolt = 0; ///< index into Scene::bolts
  std::int64_t block = 0;
  double begin = 0.0;
  double end = 0.0;
};

/// Append the stretches of a bolt inside a simple polygon.
void append_pieces(const Bolt &bolt, std::int64_t index, std::span<const Vec2> polygon, std::int64_t block,
                   std::vector<BoltPiece> &pieces);

/// Append the stretches of bolts inside a block at t_n.
/// @param which  into Scene::bolts
void append_pieces(const Scene &scene, std::span<const std::int64_t> which, const BlockSystem &system,
                   std::size_t row, std::vector<BoltPiece> &pieces);

/// The links of one bolt; their ends are world positions yet, not those of a block.
/// @param pieces  of the bolt, in any order; sorted on return
std::vector<BoltLink> links_of(const Bolt &bolt, std::int64_t index, const SupportType &support,
                               std::vector<BoltPiece> &pieces);

/// Blocks have been excavated: bars end where they went, and only grout in the rock that is left counts.
/// Links at these blocks stay as they are, to be taken out.
/// @param links  in the order of their bolts; their memory has been shared
void end_bars_at_voids(std::vector<BoltLink> &links, const std::function<bool(std::int64_t)> &is_gone);

} // namespace gcpdda
