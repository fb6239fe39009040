#pragma once

// What a restart that changes values of its scene refuses, and what it reports.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/model/scene.hpp"

#include <cstdint>

namespace gcpdda {

/// An error for each changed value that blocks have their shapes by, or contacts their laws.
Diagnostics changes_of_shapes(const Scene &before, const Scene &after);

/// Refuse changes of stages that are over in the state that a restart goes on with.
/// @param num_over  stages that are over, from the first
/// @throws SceneError
void expect_same_past(const Scene &before, const Scene &after, std::int64_t num_over);

/// A line for each changed value; a warning where a stage that has begun sets that value.
/// @param time  of the state that a restart goes on with, s
/// @param stage  number of its stage
Diagnostics reports_of_changes(const Scene &before, const Scene &after, double time, std::int64_t stage);

} // namespace gcpdda
