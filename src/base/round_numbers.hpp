#pragma once

// Round numbers for axes and histograms, 1, 2 or 5 times a power of ten and their multiples, and for hints.

#include <string>
#include <vector>

namespace gcpdda {

/// The round number nearest to a positive `x`, by ratio.
double round_number(double x);

/// A positive `x` rounded down to two digits; one that has two to within rounding keeps them.
double two_digits_below(double x);

/// A positive `x` rounded up to two digits.
double two_digits_above(double x);

/// Multiples of a round number from `low` to `high`, both of which may be among them, in ascending order.
/// There are between about 0.7 `about` and 1.5 `about` of them; `low` alone where the range is empty.
std::vector<double> round_ticks(double low, double high, int about);

/// Text of a tick with the decimals that `step`, the distance between ticks, needs.
std::string tick_text(double value, double step);

} // namespace gcpdda
