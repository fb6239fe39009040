#pragma once

// Links as springs of the static solver (statics/springs.hpp): one along the axis of the link, between the
// material points of its ends, with its bending, and one for its shear at its middle. Both hold by their
// tangential springs, so that what flows is treated as a region that slips: a share of its stiffness is left,
// and all of it where the motion begins anew. A slack cable keeps that share, by which it brakes what is
// about to tighten it. Bending keeps all of its stiffness. Left out is what the turning of the axis adds, of
// the order of the force over the length.

#include "dynamics/bolt_link.hpp"
#include "statics/springs.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace gcpdda {

/// Of a link that is not broken, in the posed trial configuration; it has been evaluated there.
/// @param rows  of the blocks of its ends
/// @param share  that is left of the stiffness of what gives
void append_springs(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows,
                    const LinkLaw &law, double share, std::vector<statics::ContactSpring> &springs);

} // namespace gcpdda
