#pragma once

// Standard output that may not be lost in silence.

#include "base/check.hpp"

#include <iostream>

namespace gcpdda {

/// Hands all that was written to standard output to the system.
/// @throws FileError where any of it could not be written, on a full disk say
inline void flush_standard_output() {
  std::cout.flush();
  if (!std::cout) {
    throw FileError("stdout: cannot be written");
  }
}

} // namespace gcpdda
