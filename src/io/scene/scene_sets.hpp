#pragma once

// The arguments of --set, put into the text of a scene.

#include "io/scene/scene_faults.hpp"
#include "io/scene/scene_toml.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gcpdda::scene_text {

/// The TOML tree of the scene file; nothing, and one fault, where the text is not TOML.
std::optional<toml::table> parse_scene(std::string_view text, Faults &faults);

/// Puts "dotted.path=value" into the tree; tables on the way are made. Whether the key exists is for the
/// check of the whole tree to say.
void apply_set(toml::table &root, const std::string &set, std::size_t index, Faults &faults);

/// Puts the value that a stage sets into the tree; what must stay as it was at the start is at fault.
/// @param path  as for --set
/// @param value  moved into the tree
void apply_change(toml::table &root, const toml::key &path, toml::node &value, Faults &faults);

/// True for a list whose tables --set knows by their names.
bool is_named_list(std::string_view key);

/// Is the path of a change that of a value by which stress acts on sides of the region, or of loads of a
/// block?
bool sets_stress(std::string_view path);
bool sets_load(std::string_view path);
/// Is it that of gravity or of a value of the water?
bool sets_gravity_or_water(std::string_view path);

} // namespace gcpdda::scene_text
