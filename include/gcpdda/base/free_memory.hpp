#pragma once

#include <cstddef>
#include <limits>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace gcpdda {

/// Room that things have left goes back to the system, where others would not use it: that of many small
/// ones, or of some beneath others. Without an effect where the C library cannot do it.
/// @param freed  bytes, if known: to give back little is not worth the while
inline void give_back_free_memory(std::size_t freed = std::numeric_limits<std::size_t>::max()) {
  constexpr std::size_t much = std::size_t{16} << 20U;
  if (freed >= much) {
#if defined(__GLIBC__)
    malloc_trim(0);
#endif
  }
}

} // namespace gcpdda
