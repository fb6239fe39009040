#pragma once

// Numbers of blocks: global ids and local rows as types that cannot be mixed up.

#include <compare>
#include <cstdint>
#include <limits>

namespace gcpdda {

/// Global, stable name of a block: its position in the scene's block order. Travels in messages and files.
struct BlockId {
  std::int64_t value = -1;
  friend constexpr auto operator<=>(const BlockId &, const BlockId &) = default;
};

/// Local row of a block on this rank; never goes into a message or a file.
struct BlockIndex {
  std::uint32_t value = std::numeric_limits<std::uint32_t>::max();
  friend constexpr auto operator<=>(const BlockIndex &, const BlockIndex &) = default;
};

} // namespace gcpdda
