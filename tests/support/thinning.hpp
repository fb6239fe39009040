#pragma once

namespace gcpdda::testing {

/// Of many like trials one in so many is made: all but under the sanitizers.
inline constexpr int thinning = GCPDDA_THINNING;

} // namespace gcpdda::testing
