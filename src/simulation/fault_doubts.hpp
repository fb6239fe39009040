#pragma once

// Faults that do not do what they were drawn for.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace gcpdda {

/// Warning of faults along which no block cut from the region has an edge; nothing if there are none.
/// Collective.
/// @param slab       blocks of this rank, in the order of their ids
/// @param first      id of the first of them
/// @param first_cut  blocks with smaller ids were not cut from the region
std::optional<Diagnostic> doubt_idle_faults(const Communicator &communicator, const RockRegion &region,
                                            std::span<const SceneBlock> slab, std::int64_t first,
                                            std::int64_t first_cut);

/// Warning of a fault that rises into the rock from a re-entrant corner of the outline, such as the toe of a
/// slope, and on whose other side there is rock as well. A block that slides down along it pushes its tip
/// into the rock before the corner, which holds it whatever the friction: limit equilibrium, in which it
/// slides out, does not apply.
/// @param gravity  m/s2
std::optional<Diagnostic> doubt_faults_at_corners(const RockRegion &region, Vec2 gravity);

} // namespace gcpdda
