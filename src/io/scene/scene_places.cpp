#include "io/scene/scene_places.hpp"

#include <utility>

namespace gcpdda::scene_text {

namespace {

using Places = std::map<std::string, SourcePosition>;

/// Puts in the node and all below it.
/// @param name  the key of the node, of which elements of a list of tables have their names
void add_places(const Origins &origins, const toml::node &node, const std::string &path,
                std::string_view name, Places &places) {
  const toml::array *list = node.as_array();
  const bool holds_tables = list != nullptr && !list->empty() && (*list)[0].is_table();
  for (std::size_t i = 0; holds_tables && i < list->size(); ++i) {
    const std::string element = name_of_element(name, (*list)[i], i);
    add_places(origins, (*list)[i], path + '.' + element, "", places);
  }
  if (holds_tables) {
    return;
  }
  places.emplace(path, origins.position(node.source()));
  const toml::table *table = node.as_table();
  for (auto entry = table == nullptr ? toml::table::const_iterator() : table->begin();
       table != nullptr && entry != table->end(); ++entry) {
    add_places(origins, entry->second, path + '.' + std::string(entry->first.str()), entry->first.str(),
               places);
  }
}

} // namespace

std::map<std::string, SourcePosition> places_of(const SceneSource &source) {
  Places places;
  for (const char *name : {"run",     "material",   "joint",   "wall",    "pyramid", "region", "joint_set",
                           "fault",   "joint_map",  "opening", "layer",   "voronoi", "bricks", "water",
                           "in_situ", "earthquake", "output",  "support", "bolt",    "liner"}) {
    if (const toml::node *node = source.root.get(name)) {
      add_places(source.faults.origins(), *node, name, name, places);
    }
  }
  return places;
}

} // namespace gcpdda::scene_text
