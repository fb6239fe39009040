#pragma once

// Memory that has been freed goes back to the system.

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <limits>
#include <string>

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

/// Bytes that this machine can still give to programs, those it would swap included, but no more than a
/// control group allows this one in all; infinite where the system does not say.
inline double available_memory() {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  double free = -1.0;
  double swap = 0.0;
  std::ifstream machine("/proc/meminfo");
  std::string key;
  std::string unit;
  for (double kilobytes = 0.0; machine >> key >> kilobytes; std::getline(machine, unit)) {
    free = key == "MemAvailable:" ? 1024.0 * kilobytes : free;
    swap = key == "SwapFree:" ? 1024.0 * kilobytes : swap;
  }
  double available = free >= 0.0 ? free + swap : unlimited;
  for (const char *path : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
    std::ifstream group(path);
    if (double limit = 0.0; group >> limit) { // not where it says "max"
      available = std::min(available, limit);
    }
  }
  return available;
}

} // namespace gcpdda
