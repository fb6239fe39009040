#include "io/scene/scene_changes.hpp"

#include "io/scene/scene_faults.hpp"
#include "io/scene/scene_keys.hpp"
#include "io/scene/scene_section.hpp"
#include "io/scene/scene_sets.hpp"
#include "io/scene/scene_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>
#include <utility>

namespace gcpdda {

namespace scene_text {

namespace {

/// A value as TOML text in which equal numbers are equal texts.
std::string text_of(const toml::node &node) {
  std::string text;
  if (const auto *array = node.as_array()) {
    for (const toml::node &element : *array) {
      text += (text.empty() ? "" : ", ") + text_of(element);
    }
    return "[" + text + "]";
  }
  if (const auto *table = node.as_table()) {
    for (const auto &[key, value] : *table) {
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key.str(), text_of(value));
    }
    return "{" + text + "}";
  }
  if (node.is_number()) {
    const double x = node.value_or(0.0);
    const std::string brief = fmt::format("{:g}", x);
    return std::stod(brief) == x ? brief : fmt::format("{}", x);
  }
  return node.is_boolean() ? (node.value_or(false) ? "true" : "false") : quoted(node.value_or(std::string()));
}

/// A value with what a person knows about it.
struct Value {
  std::string path; ///< as with --set
  std::string text;
  std::string by_default; ///< text of the value where the scene does not give it; empty if there is none
  std::int64_t stage = -1;
};

/// The default of a key; in words where it is no single value.
std::string default_of(const Key *key) {
  if (key == nullptr || key->need == required || key->kind == Kind::table_list) {
    return {};
  }
  try {
    const toml::table table = toml::parse(fmt::format("value = {}", key->fallback));
    return text_of(*table.get("value"));
  } catch (const toml::parse_error &) {
    return "its default";
  }
}

/// All values of a scene by their places, which are the same in another scene.
class Values {
public:
  explicit Values(const std::string &scene) {
    const Origins origins({}, {});
    Faults faults(origins);
    if (const auto root = parse_scene(scene, faults)) {
      add_table(*root, "", {}, {});
    }
  }

  std::map<std::string, Value> by_place;
  std::vector<std::string> stages;                         ///< names
  std::map<std::string, std::vector<std::int64_t>> set_in; ///< stages that set a path, by the path

private:
  /// @param pattern  path of the table among the scene keys
  /// @param place  of the table, which ends with a dot
  /// @param path  of the table as with --set, which ends with a dot
  void add_table(const toml::table &table, const std::string &pattern, const std::string &place,
                 const std::string &path) {
    for (const auto &[name, node] : table) {
      const std::string key(name.str());
      const Key *row = find_key(pattern, key);
      const std::string below = pattern.empty() ? key : pattern + '.' + key;
      const bool is_list = node.is_array_of_tables() && pattern.empty() && is_named_list(key);
      if (is_list) {
        add_list(*node.as_array(), key);
      } else if (row != nullptr && row->kind == Kind::named_tables && node.is_table()) {
        for (const auto &[own, element] : *node.as_table()) {
          const std::string path_of_own = fmt::format("{}.{}.", key, own.str());
          if (const toml::table *sub_table = element.as_table()) {
            add_table(*sub_table, below + ".*", path_of_own, path_of_own);
          }
        }
      } else if (const toml::table *sub_table = node.as_table()) {
        add_table(*sub_table, below, place + key + '.', path + key + '.');
      } else {
        by_place[place + key] = {path + key, text_of(node), default_of(row), stage_};
      }
    }
  }

  void add_list(const toml::array &list, const std::string &key) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string name = name_of_element(key, list[i], i);
      const toml::table &element = *list[i].as_table();
      const bool is_stage = key == "stage";
      const std::string path = fmt::format("{}.{}.", key, name);
      if (is_stage) {
        stages.push_back(name);
        stage_ = static_cast<std::int64_t>(i);
        note_sets(element);
      }
      add_table(element, key + "[]", is_stage ? fmt::format("stage.{}.", i) : path, path);
      stage_ = -1;
    }
  }

  void note_sets(const toml::table &stage) {
    if (const toml::table *set = stage.get_as<toml::table>("set")) {
      for (const auto &[path, value] : *set) {
        set_in[std::string(path.str())].push_back(stage_);
      }
    }
  }

  std::int64_t stage_ = -1;
};

std::string words_of_missing(const Value &other) {
  return other.by_default == "its default" ? other.by_default
         : other.by_default.empty()        ? "none"
                                           : "its default " + other.by_default;
}

} // namespace

} // namespace scene_text

std::vector<SceneChange> changes_between(const std::string &before, const std::string &after) {
  using scene_text::Value;
  const scene_text::Values old(before);
  const scene_text::Values changed(after);
  std::vector<SceneChange> changes;
  const auto add = [&](const Value &value, const std::string &from, const std::string &to) {
    const auto set = changed.set_in.find(value.path);
    changes.push_back({value.path, scene_text::shown(from), scene_text::shown(to), value.stage,
                       set == changed.set_in.end() ? std::vector<std::int64_t>{} : set->second});
  };
  const std::int64_t in_both = static_cast<std::int64_t>(std::min(old.stages.size(), changed.stages.size()));
  for (const auto &[place, value] : old.by_place) {
    const auto found = changed.by_place.find(place);
    if (value.stage >= in_both) {
      continue;
    }
    if (found == changed.by_place.end()) {
      if (value.text != value.by_default) {
        add(value, value.text, scene_text::words_of_missing(value));
      }
    } else if (found->second.text != value.text) {
      add(value, value.text, found->second.text);
    }
  }
  for (const auto &[place, value] : changed.by_place) {
    if (value.stage < in_both && !old.by_place.contains(place) && value.text != value.by_default) {
      add(value, scene_text::words_of_missing(value), value.text);
    }
  }
  for (auto k = static_cast<std::size_t>(in_both); k < old.stages.size(); ++k) {
    changes.push_back({"stage." + old.stages[k], "a stage", "none", static_cast<std::int64_t>(k)});
  }
  for (auto k = static_cast<std::size_t>(in_both); k < changed.stages.size(); ++k) {
    changes.push_back({"stage." + changed.stages[k], "none", "a stage", static_cast<std::int64_t>(k)});
  }
  return changes;
}

} // namespace gcpdda
