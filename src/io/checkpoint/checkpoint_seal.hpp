#pragma once

// The seal of a checkpoint: its first 512 bytes, which HDF5 leaves alone (its user block). They are a text
// that says which format and step follow, how long the file is and what its bytes add up to. A reader
// compares that with plain reads before HDF5 opens the file: HDF5 takes sizes and places from the file as
// they stand there, and with a damaged one asks for gigabytes or reads beyond its buffers.

#include "gcpdda/parallel/communicator.hpp"

#include <cstdint>
#include <filesystem>

namespace gcpdda::checkpoint {

inline constexpr std::int64_t seal_size = 512; ///< bytes

struct Seal {
  std::int64_t version = 0; ///< of the format
  std::int64_t step = 0;
  std::int64_t size = 0; ///< bytes of the file, those of the seal included
  std::uint64_t sum = 0; ///< of the bytes behind the seal and of the numbers above
};

/// Adds up the bytes of an unfinished file that is complete but for its seal, and puts the seal. Every rank
/// reads a share of the file. Collective; throws FileError on all ranks.
void put_seal(const Communicator &communicator, const std::filesystem::path &unfinished, std::int64_t step);

/// What the seal of a checkpoint says, by one process alone.
/// @throws FileError where there is none, or one of another format version, or the file is not as long as it
///         says or has the name of another step
Seal read_seal(const std::filesystem::path &path);

/// Every byte of the file is as it was when it was sealed. Every rank reads a share. Collective.
/// @throws FileError on all ranks where that is not so
void expect_unchanged(const Communicator &communicator, const std::filesystem::path &path, const Seal &seal);

} // namespace gcpdda::checkpoint
