#pragma once

// The table of plausible values.

#include "io/scene/plausible_range.hpp"

#include <span>
#include <string>

namespace gcpdda {

/// All rows, in the order of scene_keys.md.
std::span<const PlausibleRange> plausible_ranges();

/// The page run/guide/plausible_values.md (Markdown).
std::string plausible_values_page();

} // namespace gcpdda
