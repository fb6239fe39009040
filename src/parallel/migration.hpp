#pragma once

// Blocks move to the rank whose cell holds their centroid, with the memory of their contacts.

#include "gcpdda/parallel/communicator.hpp"
#include "model/block_system.hpp"
#include "model/contact_history.hpp"
#include "partition/domain_map.hpp"

#include <cstdint>
#include <vector>

namespace gcpdda {

/// Move every owned block to the rank whose cells hold its centroid at t_n; the memory of all its contacts
/// goes with it (and stays here too, for partners that stay). Ghosts are dropped; owned rows, sorted by id
/// before, are so again.
///
/// A contact between blocks of two ranks has its memory on both, equal by construction, so wherever either
/// block goes its new owner finds a copy: with the block, or already there.
///
/// @param memory  in: of all contacts this rank evaluated; out: plus what arrived
/// @return number of blocks that left this rank
std::int64_t migrate(const Communicator &communicator, const DomainMap &map, BlockSystem &system,
                     ContactMemory &memory);

} // namespace gcpdda
