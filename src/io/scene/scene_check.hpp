#pragma once

// The walk through the TOML tree along the table of keys (scene_keys.cpp).

#include "io/scene/scene_section.hpp"

namespace gcpdda::scene_text {

/// Reports everything that can be said of each key by itself: unknown, missing, of the wrong type,
/// out of range.
FaultyNodes check_keys(const toml::table &root, Faults &faults);

} // namespace gcpdda::scene_text
