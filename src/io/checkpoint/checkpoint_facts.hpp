#pragma once

// What a checkpoint says of itself, without the state that it holds.

#include "io/checkpoint/checkpoint.hpp"

#include <cstdint>
#include <filesystem>

namespace gcpdda {

/// A checkpoint that opens.
struct FoundCheckpoint {
  std::filesystem::path path;
  RunFacts facts;
  std::int64_t checksum = 0;
};

/// By one process alone, of a file whose bytes are those that were written.
/// @throws FileError
FoundCheckpoint look_at(const std::filesystem::path &path);

} // namespace gcpdda
