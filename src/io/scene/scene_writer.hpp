#pragma once

// A scene after --set as TOML text.

#include "io/scene/scene_faults.hpp"
#include "io/scene/scene_toml.hpp"

#include <string>

namespace gcpdda::scene_text {

/// As a basic string of TOML; of a text without control characters.
std::string quoted(const std::string &text);

/// A sound scene as TOML text, tables and keys in the order they were written; reads back to the same scene.
std::string to_toml(const toml::table &root, const Origins &origins);

} // namespace gcpdda::scene_text
