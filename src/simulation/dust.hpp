#pragma once

// Blocks cut from a region that are dust beside the others: joints cross each other almost, but not quite, in
// one point, or a trace has been digitised twice.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace gcpdda {

/// Dust has a mean width below this share of the median side (the root of the area) of the blocks. Joints
/// with allowed_overlap = 1e-3 close by as much: they close through such a block, which ends the run.
inline constexpr double dust_share = 1e-3;
/// The region.min_width that removes dust, as a share of the side of the blocks: that which min_width has by
/// default where joint sets say how large the blocks are.
inline constexpr double sliver_share_of_side = 0.02;

/// Warning that a region has been cut into dust, with the number of such blocks, the narrowest of them and
/// the min_width that merges them; nothing without dust. Collective.
/// @param slab       blocks of this rank, in the order of their ids
/// @param first      id of the first of them
/// @param first_cut  blocks with smaller ids were not cut from the region
std::optional<Diagnostic> doubt_dust(const Communicator &communicator, const RockRegion &region,
                                     std::span<const SceneBlock> slab, std::int64_t first,
                                     std::int64_t first_cut);

/// What to try where a block has been overlapped by half of its width: the min_width that merges it if it has
/// been cut from the region and is a sliver beside the others, 0 otherwise.
/// @param width  narrowest width of the two blocks, m
double width_against_dust(const Scene &scene, std::int64_t block, std::int64_t other, double width);

} // namespace gcpdda
