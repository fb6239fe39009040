#pragma once

// The picture of an ensemble: how often which factor of safety, or which permanent displacement, was found.

#include "io/results/ensemble_report.hpp"

#include <string>
#include <vector>

namespace gcpdda {

/// Bars of equal width, side by side.
struct Bars {
  double begin = 0.0; ///< of the first one
  double width = 1.0;
  std::vector<std::int64_t> counts;
};

/// Bars of a round width (1, 2 or 5 times a power of ten) near that of Scott's rule, 3.49 deviations over the
/// cube root of the number (doi:10.1093/biomet/66.3.605), with an edge at `edge`.
Bars bars_of(const std::vector<double> &values, double edge);

/// Picture (SVG) of how the factors of safety of the members lie about 1.
std::string draw_factors(const EnsembleReport &report);

/// Picture (SVG) of how far the blocks of the members that are at rest have moved since the ground began to
/// shake.
std::string draw_displacements(const EnsembleReport &report);

} // namespace gcpdda
