#pragma once

// Memory that is read soon.

#include <bit>
#include <cstddef>
#include <cstdint>

namespace gcpdda {

/// Ask for the cache lines of something that is used soon; nothing may be there.
inline void prefetch(const void *first, std::size_t bytes) {
  constexpr std::size_t cache_line = 64;
  const auto address = std::bit_cast<std::uintptr_t>(first);
  for (std::size_t offset = 0; offset < bytes; offset += cache_line) {
    __builtin_prefetch(std::bit_cast<const void *>(address + offset));
  }
}

} // namespace gcpdda
