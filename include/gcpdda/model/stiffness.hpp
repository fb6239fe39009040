#pragma once

#include "gcpdda/model/scene.hpp"

namespace gcpdda {

/// Put a number into every law that was given as an allowed overlap e:
///
///     k_n = rho g h / (e L)                                             [README, "Stiffness"]
///
/// rho the densest material in use, g = |gravity|, h the extent of the mobile blocks along gravity, L the
/// median of their sqrt(area). The extent is a pressure head: the deepest joint then closes by about e.
/// Without mobile blocks the fixed ones stand in (nothing can touch, any positive number does).
void resolve_stiffness(Scene &scene);

} // namespace gcpdda
