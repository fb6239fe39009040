#pragma once

// The largest eigenvalue of a small matrix, for the stability of a scheme.

#include <span>

namespace gcpdda {

/// Largest absolute eigenvalue of a square real matrix given column by column.
double spectral_radius(std::span<const double> matrix);

} // namespace gcpdda
