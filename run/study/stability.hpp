#pragma once

// The parts of the stability study.

#include "study.hpp"

namespace gcpdda::study {

/// Growth and limits of every scheme against their amplification matrices; rigid and deformable chains.
void linear_stability(const Options &options);
/// What the method rejects, shown failing: forces at the start of the step, other friction, dashpots,
/// potentials.
void rejected_variants(const Options &options);
/// Boundaries that no linear theory gives, found by bisection, and what the program does there.
void failures(const Options &options);
/// Many steps: energy without trend, blocks at rest that stay.
void soak(const Options &options);

} // namespace gcpdda::study
