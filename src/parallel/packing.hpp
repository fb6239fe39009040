#pragma once

// Rows of blocks as bytes of a message, and back.

#include "gcpdda/parallel/communicator.hpp"
#include "model/block_system.hpp"

#include <span>

namespace gcpdda {

/// Append one row, state and shape, to a message.
void pack_row(const BlockSystem &system, std::size_t row, Bytes &message);

/// Append all rows of a message to a system, in message order. The ranges' counts are the caller's.
void unpack_rows(std::span<const std::byte> message, BlockSystem &system);

} // namespace gcpdda
