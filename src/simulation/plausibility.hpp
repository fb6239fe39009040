#pragma once

// Values that are hardly meant: outside what rock, soil, concrete, steel or masonry have.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"
#include "io/scene/plausible_range.hpp"

#include <span>
#include <string>

namespace gcpdda {

/// What is implausible in a scene that is valid: quantities outside the ranges above, with what was probably
/// meant, times that lie beyond the end of the run, and parts that lie outside the region. Every warning has
/// the place where the value was written; values that the scene does not give are not judged. A scene made in
/// code has no places (Scene::places), and all of its values are judged. Quantities that deviate in the same
/// way make one warning with their number.
///
/// A scene in normalised units has no unit slips: where |gravity| is 1 m/s2 or the density of all materials
/// is 1, only angles and ratios are judged.
Diagnostics implausible_values(const Scene &scene);

/// The same of the size of the median mobile block, sqrt(area) in m: a warning or none.
Diagnostics implausible_size(const Scene &scene, double size);

} // namespace gcpdda
