#pragma once

// Earthquakes that are hardly meant: records of an implausible strength, and records that do not play in
// stages of kind run.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"

namespace gcpdda {

/// Warnings about the earthquake of a valid scene whose record has been read: the peak of the record is
/// outside of its plausible range, or a settle stage or the end of the run comes before the end of the
/// record. The list is empty for a scene without a record.
Diagnostics doubts_of_shaking(const Scene &scene);

} // namespace gcpdda
