#pragma once

// Many faults of one kind in one line.

#include "gcpdda/base/diagnostic.hpp"

namespace gcpdda {

/// The same diagnostics, but of those that differ in names and numbers alone only the first ten and one line
/// that counts the others.
Diagnostics condensed(const Diagnostics &all);

} // namespace gcpdda
