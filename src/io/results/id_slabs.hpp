#pragma once

// Which rank writes the rows of which blocks.

#include <cstdint>

namespace gcpdda {

/// Ids are cut into one contiguous slab per rank; a slab's owner writes its rows.
/// First id of rank's slab, of num_blocks ids over num_ranks ranks; slab_begin(n, p, p) == n.
std::int64_t slab_begin(std::int64_t num_blocks, int num_ranks, int rank);
int slab_owner(std::int64_t num_blocks, int num_ranks, std::int64_t block);

} // namespace gcpdda
