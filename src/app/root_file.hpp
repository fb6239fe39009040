#pragma once

// Files that the root reads for all ranks.

#include "gcpdda/parallel/communicator.hpp"

#include <cstdint>
#include <string>

namespace gcpdda {

/// Text of a file that the root reads, on all ranks. Collective; throws FileError on all ranks.
/// @param who  what the message calls it: "the scene"
/// @param most_bytes  a longer file is refused
std::string read_on_root(const Communicator &world, const std::string &path, const std::string &who,
                         std::int64_t most_bytes);

/// The root writes a text. Collective; throws FileError on all ranks.
void write_on_root(const Communicator &world, const std::string &path, const std::string &text,
                   const std::string &who);

} // namespace gcpdda
