#pragma once

#include "gcpdda/contact/overlap.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace gcpdda {

/// Rotate the pieces of one block so that they start where its boundary comes in, the lowest leftmost such
/// place if there are several: a choice that cutting or renumbering the block elsewhere cannot change.
void start_at_entry(std::span<Piece> pieces);

/// Cut the pieces of two blocks, `num_first` of them on the first one's edges, into regions and sort them
/// accordingly. Pieces of regions without depth are dropped.
void split_into_regions(const BlockView &first, const BlockView &second, std::vector<Piece> &pieces,
                        std::size_t num_first, std::vector<Region> &regions);

} // namespace gcpdda
