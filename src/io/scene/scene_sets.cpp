#include "io/scene/scene_sets.hpp"

#include "base/edit_distance.hpp"
#include "io/scene/scene_keys.hpp"
#include "io/scene/scene_section.hpp"
#include "io/scene/scene_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace gcpdda::scene_text {

namespace {

using Path = std::vector<std::string>;

// toml++ recurses once per dotted level and would overflow the stack: the position of a key with absurdly
// many levels, if there is one. A stretch of text that can hold a dotted key ends at any of the other marks
// of TOML.
std::optional<toml::source_position> find_endless_key(std::string_view text) {
  constexpr int most_levels = 200;
  toml::source_position at{1, 1};
  int dots = 0;
  bool comment = false;
  bool line_start = true;
  for (const char c : text) {
    if (c == '\n') {
      at = {at.line + 1, 0};
      comment = false;
    }
    comment = comment || (line_start && c == '#');
    line_start = c == '\n' || (line_start && (c == ' ' || c == '\t'));
    const bool ends = c == '\n' || std::string_view("=,{}[]").find(c) != std::string_view::npos;
    dots = ends ? 0 : dots + (c == '.' ? 1 : 0);
    if (dots > most_levels && !comment) {
      return at;
    }
    ++at.column;
  }
  return std::nullopt;
}

std::optional<toml::table> parse(std::string_view text, const toml::source_path_ptr &path, Faults &faults) {
  toml::source_region where{{1, 1}, {1, 1}, path};
  if (const auto position = find_endless_key(text)) {
    where.begin = *position;
    faults.add(where, "key with more than 200 levels", "", "remove the superfluous dots");
    return std::nullopt;
  }
  try {
    return toml::parse(text, path ? std::string_view(*path) : std::string_view());
  } catch (const toml::parse_error &error) {
    where.begin = error.source().begin;
    faults.add(where, "not valid TOML", shown(error.description(), 200),
               "check quotes, brackets and = up to this place");
    return std::nullopt;
  }
}

// "block.'a b'.fixed" -> block, a b, fixed; nothing where a segment is empty or a quote stays open.
std::optional<Path> split(std::string_view dotted) {
  Path path(1);
  char quote = '\0';
  bool complete = false; // a quoted segment takes nothing more
  for (const char c : dotted) {
    if (quote != '\0') {
      complete = c == quote;
      quote = complete ? '\0' : quote;
      if (!complete) {
        path.back() += c;
      }
    } else if (c == '.') {
      if (path.back().empty()) {
        return std::nullopt;
      }
      path.emplace_back();
      complete = false;
    } else if ((c == '"' || c == '\'') && path.back().empty() && !complete) {
      quote = c;
    } else if (is_name(std::string_view(&c, 1)) && !complete) {
      path.back() += c;
    } else {
      return std::nullopt;
    }
  }
  constexpr std::size_t deepest = 16;
  if (quote != '\0' || path.back().empty() || path.size() > deepest) {
    return std::nullopt;
  }
  return path;
}

bool is_bare_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return is_name(std::string_view(&c, 1)) || c == '+' || c == '/';
  });
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  const std::size_t last = text.find_last_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

// The tree of one assignment. The value is tried alone first, so that a bare word can be told from broken
// TOML.
std::optional<toml::table> parse_assignment(const Path &path, std::string_view value,
                                            const toml::source_path_ptr &label, Faults &faults) {
  std::string text(trimmed(value));
  if (is_bare_word(text)) {
    try {
      (void)toml::parse(fmt::format("value = {}", text));
    } catch (const toml::parse_error &) {
      text = scene_text::quoted(text);
    }
  }
  std::string keys;
  for (const std::string &segment : path) {
    keys += keys.empty() ? "" : ".";
    keys += scene_text::quoted(segment);
  }
  auto tree = parse(fmt::format("{} = {}", keys, text), label, faults);
  // A line break in the value could smuggle in a second assignment.
  const toml::table *level = tree ? &*tree : nullptr;
  for (std::size_t i = 0; level != nullptr && i < path.size(); ++i) {
    if (level->size() != 1) {
      faults.add({{}, {}, label}, "the value is more than one TOML value", "",
                 "give every assignment its own --set");
      return std::nullopt;
    }
    level = level->begin()->second.as_table();
  }
  return tree;
}

constexpr std::array makers_of_blocks{"wall", "pyramid", "blocks", "region"};

/// Whether the scene has blocks that no [[block]] table describes.
bool has_made_blocks(const toml::table &root) {
  return std::any_of(makers_of_blocks.begin(), makers_of_blocks.end(),
                     [&](const char *maker) { return root.contains(maker); });
}

// Finds the block, wall, joint set or other element with a name that path[1], or path[1] to path[k] joined by
// dots (names may hold dots), names, and takes these segments off the path.
toml::table *find_element(toml::table &root, Path &path, const toml::source_region &where, Faults &faults) {
  const std::string list = path.front();
  std::vector<std::string> names;
  toml::array *elements = root[list].as_array();
  for (std::size_t i = 0; elements != nullptr && i < elements->size(); ++i) {
    names.push_back(name_of_element(list, (*elements)[i], i));
  }
  std::string name;
  for (std::size_t k = 1; k + 1 < path.size(); ++k) {
    name += (k == 1 ? "" : ".") + path[k];
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      continue;
    }
    if (toml::table *element = (*elements)[static_cast<std::size_t>(found - names.begin())].as_table()) {
      path.erase(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(k + 1));
      return element;
    }
  }
  if (name.empty()) {
    faults.add(where, fmt::format("'{}.{}' names no key of a {}", list, shown(path[1]), list), "",
               list == "block" ? "for example --set block.slider.fixed=true"
                               : fmt::format("for example --set {0}.{0}0.rows=20", list));
    return nullptr;
  }
  const std::string near = nearest_word(name, names);
  if (list == "block" && near.empty() && has_made_blocks(root)) {
    faults.add(where, fmt::format("no [[block]] is named '{}'", shown(name)),
               "values can be set of blocks that have a [[block]] table, not of those that walls, pyramids, "
               "a block file or a region make",
               "write the block as a [[block]] of its own");
    return nullptr;
  }
  faults.add(where, fmt::format("no {} is named '{}'", list, shown(name)), "",
             near.empty()
                 ? fmt::format("unnamed {}s are {}<n>, from 0 in file order", list, prefix_of_unnamed(list))
                 : fmt::format("did you mean '{}'?", near));
  return nullptr;
}

/// What a stage may set: nothing that would need another state.
bool can_change(const Path &path) {
  const std::string &last = path.back();
  const auto is_one_of = [&](std::initializer_list<const char *> names) {
    return std::find(names.begin(), names.end(), last) != names.end();
  };
  if (path.front() == "run") {
    return path.size() == 2 && is_one_of({"gravity", "time_step", "safety", "contact_damping", "rayleigh",
                                          "local_damping", "elasticity", "potential"});
  }
  if (path.front() == "joint") {
    return path.size() == 3 && !is_one_of({"materials", "allowed_overlap"}) &&
           find_key("joint.*", last) != nullptr;
  }
  for (const char *whole : {"material", "water"}) {
    if (path.front() == whole) {
      return path.size() == 3 && find_key(std::string(whole) + ".*", last) != nullptr;
    }
  }
  if (path.front() == "support") {
    return path.size() == 3 && !is_one_of({"kind"}) && find_key("support.*", last) != nullptr;
  }
  if (path.front() == "bolt" || path.front() == "bolt_pattern" || path.front() == "liner") {
    return path.size() > 2 && is_one_of({"active"});
  }
  if (path.front() == "in_situ") {
    return path.size() == 1 || (path.size() == 2 && find_key("in_situ", last) != nullptr);
  }
  if (path.front() == "region") {
    return path.size() == 2 && is_one_of({"stress"});
  }
  return path.front() == "block" && path.size() > 2 && is_one_of({"fixed", "load"});
}

} // namespace

bool is_named_list(std::string_view key) {
  return key == "block" || key == "wall" || key == "pyramid" || key == "joint_set" || key == "fault" ||
         key == "opening" || key == "stage" || key == "bolt" || key == "bolt_pattern" || key == "liner";
}

bool sets_stress(std::string_view dotted) {
  const auto path = split(trimmed(dotted));
  return path && (path->front() == "in_situ" || path->front() == "region");
}

bool sets_load(std::string_view dotted) {
  const auto path = split(trimmed(dotted));
  return path && path->front() == "block" && path->back() == "load";
}

bool sets_gravity_or_water(std::string_view dotted) {
  const auto path = split(trimmed(dotted));
  return path && (path->front() == "water" || (path->front() == "run" && path->back() == "gravity"));
}

std::optional<toml::table> parse_scene(std::string_view text, Faults &faults) {
  return parse(text, nullptr, faults);
}

namespace {

/// A path of --set goes on below a node that is no table.
/// @param path  to the node
void tell_end_of_path(const toml::node &node, std::span<const std::string> path,
                      const toml::source_region &where, Faults &faults) {
  if (!node.is_array_of_tables()) {
    faults.add(where, fmt::format("'{}' is not a table", shown(path.back())), "the path goes on below it",
               "shorten the path");
    return;
  }
  const std::string list = shown(fmt::format("{}", fmt::join(path, ".")));
  faults.add(where, fmt::format("'{}' is a list of tables", list),
             "--set cannot change a key of a single table of it",
             fmt::format("give the whole list as --set '{}=[{{...}}]'", list));
}

} // namespace

void apply_set(toml::table &root, const std::string &set, std::size_t index, Faults &faults) {
  const auto label = std::make_shared<const std::string>(faults.origins().label_of_set(index));
  const toml::source_region where{{}, {}, label};
  const std::size_t equals = set.find('=');
  auto path =
      equals == std::string::npos ? std::nullopt : split(trimmed(std::string_view(set).substr(0, equals)));
  if (!path) {
    faults.add(where, "not of the form path=value", "a path is made of names joined by dots",
               "for example --set run.time_step=1e-4");
    return;
  }
  const Path whole_path = *path;
  toml::table *table = &root;
  if (is_named_list(path->front()) && path->size() > 1) {
    table = find_element(root, *path, where, faults);
  }
  auto tree = table == nullptr
                  ? std::nullopt
                  : parse_assignment(*path, std::string_view(set).substr(equals + 1), label, faults);
  if (!tree) {
    return;
  }
  // Down as far as the tables exist; what remains of the new tree, value or tables around it, is moved in.
  toml::table *added = &*tree;
  for (std::size_t i = 0;; ++i) {
    const auto entry = added->begin();
    toml::node *existing = table->get((*path)[i]);
    if (i + 1 == path->size() || existing == nullptr) {
      table->insert_or_assign(entry->first, std::move(entry->second));
      return;
    }
    if (!existing->is_table()) {
      tell_end_of_path(*existing, std::span(whole_path).first(whole_path.size() - path->size() + i + 1),
                       where, faults);
      return;
    }
    table = existing->as_table();
    added = entry->second.as_table();
  }
}

void apply_change(toml::table &root, const toml::key &dotted, toml::node &value, Faults &faults) {
  const auto path = split(trimmed(dotted.str()));
  if (!path || !can_change(*path)) {
    faults.add(dotted.source(), fmt::format("a stage cannot set '{}'", shown(dotted.str())),
               "it sets values of joints, materials, water and support, in_situ.KEY, region.stress, "
               "block.NAME.fixed, block.NAME.load, bolt.NAME.active, bolt_pattern.NAME.active, "
               "liner.NAME.active and some of "
               "[run]",
               "for example set = { \"joint.default.friction_angle_deg\" = 25.0 }");
    return;
  }
  Path below = *path;
  toml::table *table = &root;
  if (is_named_list(path->front())) {
    table = find_element(root, below, dotted.source(), faults);
    if (table == nullptr) {
      return;
    }
  }
  while (below.size() > 1) {
    toml::node *next = table->get(below.front());
    if (next == nullptr && path->front() == "run") {
      table->insert(below.front(), toml::table());
      next = table->get(below.front());
    }
    if (next == nullptr || !next->is_table()) {
      // Where the scene has no table [water] at all, the name is the next part of the path.
      const std::string &missing =
          below.size() == path->size() && path->size() > 1 ? (*path)[1] : below.front();
      const bool is_whole = below.size() == path->size() && !is_named_list(path->front()) &&
                            (path->front() == "in_situ" || path->front() == "region");
      faults.add(dotted.source(),
                 fmt::format("'{}' names no {} of the scene", shown(dotted.str()), path->front()),
                 is_whole ? fmt::format("[{}] is not there", path->front())
                          : fmt::format("[{}.{}] is not there", path->front(), shown(missing)),
                 is_whole ? "write the table into the scene" : "check the name");
      return;
    }
    table = next->as_table();
    below.erase(below.begin());
  }
  table->insert_or_assign(toml::key(below.front(), toml::source_region(dotted.source())), std::move(value));
}

} // namespace gcpdda::scene_text
