#pragma once

// The table of plausible values.

#include "io/scene/plausible_range.hpp"

#include <span>
#include <string>
#include <string_view>

namespace gcpdda {

/// All rows, in the order of scene_keys.md.
std::span<const PlausibleRange> plausible_ranges();
/// The row of a key.
const PlausibleRange &plausible_range(std::string_view key);

/// The page run/guide/plausible_values.md (Markdown).
std::string plausible_values_page();

} // namespace gcpdda
