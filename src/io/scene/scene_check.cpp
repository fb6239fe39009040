#include "io/scene/scene_check.hpp"

#include "base/edit_distance.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

namespace gcpdda::scene_text {

namespace {

std::string_view type_name(const toml::node &node) {
  switch (node.type()) {
  case toml::node_type::string:
    return "a string";
  case toml::node_type::integer:
    return "an integer";
  case toml::node_type::floating_point:
    return "a real number";
  case toml::node_type::boolean:
    return "a boolean";
  case toml::node_type::array:
    return "an array";
  case toml::node_type::table:
    return "a table";
  default:
    return "a date or time";
  }
}

std::string example_of(const Key &key) {
  if (key.example.starts_with('[') && key.kind <= Kind::table_list) {
    return fmt::format("write {}", key.example);
  }
  return fmt::format("for example {} = {}", name_of(key), key.example);
}

bool holds_number(const toml::node &node) {
  return node.is_integer() || node.is_floating_point();
}

class Checker {
public:
  explicit Checker(Faults &faults) : faults_(&faults) {}

  /// @param parent  row of the table in scene_keys
  /// @param label   what messages call the table, "" for the top level
  void check_table(const toml::table &table, std::string_view parent, const std::string &label) {
    for (const auto &[key, node] : table) {
      const Key *row = find_key(parent, key.str());
      if (row == nullptr) {
        report_unknown(key, parent, label);
      } else if (!check_entry(*row, key, node, label)) {
        faulty_.insert(&node);
      }
    }
    for (const Key &row : scene_keys()) {
      if (parent_of(row) == parent && row.need == Need::required && !table.contains(name_of(row))) {
        faults_->add(table.source(), subject(name_of(row), label) + " is missing", "it is required",
                     example_of(row));
      }
    }
  }

  [[nodiscard]] FaultyNodes take_faulty() { return std::move(faulty_); }

private:
  bool fault(const toml::node &node, std::string what, std::string why, std::string hint) {
    faults_->add(node.source(), std::move(what), std::move(why), std::move(hint));
    return false;
  }

  bool wrong_type(const Key &row, const toml::node &node, const std::string &who, std::string_view expected) {
    return fault(node, fmt::format("{} is {}", who, type_name(node)), fmt::format("it must be {}", expected),
                 example_of(row));
  }

  void report_unknown(const toml::key &key, std::string_view parent, const std::string &label) {
    const std::vector<std::string> names = names_below(parent);
    const std::string near = nearest_word(key.str(), names);
    std::string hint = near.empty() ? "" : fmt::format("did you mean '{}'?", near);
    for (const Key &row : scene_keys()) {
      if (hint.empty() && name_of(row) == key.str()) {
        hint = parent_of(row).empty() ? fmt::format("'{}' belongs to the top level", key.str())
                                      : fmt::format("it belongs to {}", header_of(parent_of(row)));
      }
    }
    if (hint.empty()) {
      hint = fmt::format("known here: {}", fmt::join(names, " "));
    }
    faults_->add(key.source(), "unknown key " + subject(key.str(), label), "", hint);
  }

  bool check_entry(const Key &row, const toml::key &key, const toml::node &node, const std::string &label) {
    const std::string who = subject(key.str(), label);
    switch (row.kind) {
    case Kind::table:
      return check_single_table(row, key, node, label);
    case Kind::named_tables:
      return check_named_tables(row, node, who);
    case Kind::table_list:
      return check_table_list(row, node, label, who);
    case Kind::number:
      return check_number(row, node, who, "a number");
    case Kind::number_or_auto:
      return check_number_or_auto(row, node, who);
    case Kind::boolean:
      return node.is_boolean() || wrong_type(row, node, who, "true or false");
    case Kind::choice:
      return check_choice(row, node, who);
    case Kind::words:
      return check_words(row, node, who);
    case Kind::name:
      return check_name(row, node, who);
    case Kind::text:
      return check_text(row, node, who);
    case Kind::pair_of_names:
    case Kind::vector2:
      return check_array(row, node, who, 2);
    case Kind::vector3:
      return check_array(row, node, who, 3);
    case Kind::velocity_table:
      return check_time_table(row, node, who, "[t, vx, vy, omega]", 4);
    case Kind::factor_table:
      return check_time_table(row, node, who, "[t, factor]", 2);
    case Kind::names_or_blanks:
      return check_names_or_blanks(row, node, who);
    case Kind::points:
    case Kind::polygon:
      return check_points(row, node, who);
    case Kind::count:
      return check_count(row, node, who);
    case Kind::names:
      return check_names(row, node, who);
    case Kind::assignments:
      return (node.is_table() && !node.as_table()->empty()) ||
             wrong_type(row, node, who, "a table of paths and values");
    }
    return true;
  }

  bool check_single_table(const Key &row, const toml::key &key, const toml::node &node,
                          const std::string &label) {
    const std::string who = subject(key.str(), label);
    if (name_of(row) == "*" && !is_name(key.str())) {
      faults_->add(key.source(), fmt::format("{} is no name", who),
                   "a name holds 1 to 100 letters, digits, _ . and -", "choose another name");
    }
    if (!node.is_table()) {
      return wrong_type(row, node, who, "a table");
    }
    const std::string parent(parent_of(row));
    const std::string path =
        parent.empty() ? std::string(key.str()) : fmt::format("{}.{}", parent, shown(key.str()));
    check_table(*node.as_table(), row.path,
                parent.ends_with("[]") ? fmt::format("{} of {}", key.str(), label)
                                       : fmt::format("[{}]", path));
    return true;
  }

  bool check_named_tables(const Key &row, const toml::node &node, const std::string &who) {
    if (!node.is_table()) {
      return wrong_type(row, node, who, "a table of named tables");
    }
    if (node.as_table()->empty()) {
      return fault(node, fmt::format("{} is empty", who), "at least one is needed", example_of(row));
    }
    check_table(*node.as_table(), row.path, fmt::format("[{}]", row.path));
    return true;
  }

  bool check_table_list(const Key &row, const toml::node &node, const std::string &label,
                        const std::string &who) {
    const toml::array *list = node.as_array();
    if (list == nullptr) {
      return wrong_type(row, node, who, "a list of tables");
    }
    if (list->size() > most_blocks) {
      return fault((*list)[most_blocks], fmt::format("{} has {} entries", who, list->size()),
                   fmt::format("a scene file holds at most {}", most_blocks),
                   name_of(row) == "block" ? "put many blocks into a file and name it in [blocks] file"
                                           : "leave some of them out");
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
      const toml::node &element = (*list)[i];
      if (element.is_table()) {
        check_table(*element.as_table(), row.path, label_of_element(name_of(row), element, i, label));
      } else {
        wrong_type(row, element, fmt::format("'{}[{}]'", name_of(row), i), "a table");
      }
    }
    return true;
  }

  bool check_number(const Key &row, const toml::node &node, const std::string &who,
                    std::string_view expected) {
    if (!holds_number(node)) {
      return wrong_type(row, node, who, expected);
    }
    const double x = as_number(node);
    if (!std::isfinite(x)) {
      return fault(node, fmt::format("{} is {}", who, x), "it must be finite", example_of(row));
    }
    if (!row.range.holds(x)) {
      return fault(node, fmt::format("{} is {}", who, x), fmt::format("it must be {}", describe(row.range)),
                   example_of(row));
    }
    return true;
  }

  bool check_count(const Key &row, const toml::node &node, const std::string &who) {
    if (!check_number(row, node, who, "an integer")) {
      return false;
    }
    const double x = as_number(node);
    return x == std::floor(x) ||
           fault(node, fmt::format("{} is {}", who, x), "it must be an integer", example_of(row));
  }

  bool check_number_or_auto(const Key &row, const toml::node &node, const std::string &who) {
    constexpr std::string_view expected = "a number or \"auto\"";
    const auto word = node.value<std::string_view>();
    if (word && *word != "auto") {
      return fault(node, fmt::format("{} is '{}'", who, shown(*word)), fmt::format("it must be {}", expected),
                   example_of(row));
    }
    return word || check_number(row, node, who, expected);
  }

  bool check_choice(const Key &row, const toml::node &node, const std::string &who) {
    const auto word = node.value<std::string>();
    if (!node.is_string() || !word) {
      return wrong_type(row, node, who, "a string");
    }
    const std::vector<std::string> words = words_of(row.choices);
    for (const std::string &choice : words) {
      if (choice == *word) {
        return true;
      }
    }
    const std::string near = nearest_word(*word, words);
    return fault(node, fmt::format("{} is '{}'", who, shown(*word)),
                 fmt::format("it must be one of {}", fmt::join(words, " ")),
                 near.empty() ? example_of(row) : fmt::format("did you mean '{}'?", near));
  }

  bool check_words(const Key &row, const toml::node &node, const std::string &who) {
    const toml::array *list = node.as_array();
    if (list == nullptr) {
      return wrong_type(row, node, who, "a list of words");
    }
    bool sound = true;
    for (std::size_t i = 0; i < list->size(); ++i) {
      sound &= check_choice(row, (*list)[i], fmt::format("entry {} of {}", i, who));
    }
    return sound;
  }

  bool check_name(const Key &row, const toml::node &node, const std::string &who) {
    if (!node.is_string()) {
      return wrong_type(row, node, who, "a string");
    }
    const std::string &text = node.as_string()->get();
    return is_name(text) || fault(node, fmt::format("{} is '{}'", who, shown(text)),
                                  "a name holds 1 to 100 letters, digits, _ . and -", example_of(row));
  }

  bool check_text(const Key &row, const toml::node &node, const std::string &who) {
    if (!node.is_string()) {
      return wrong_type(row, node, who, "a string");
    }
    const std::string &text = node.as_string()->get();
    if (text.empty() || text.size() > longest_text) {
      return fault(node, fmt::format("{} has {} characters", who, text.size()),
                   fmt::format("it must have 1 to {}", longest_text), example_of(row));
    }
    return shown(text, longest_text) == text || fault(node, fmt::format("{} holds control characters", who),
                                                      "it must be one line of text", example_of(row));
  }

  bool check_array(const Key &row, const toml::node &node, const std::string &who, std::size_t size) {
    const bool names = row.kind == Kind::pair_of_names;
    const toml::array *array = node.as_array();
    if (array == nullptr) {
      return wrong_type(row, node, who, fmt::format("an array of {} {}", size, names ? "names" : "numbers"));
    }
    if (array->size() != size) {
      return fault(node, fmt::format("{} has length {}", who, array->size()),
                   fmt::format("it must have length {}", size), example_of(row));
    }
    bool sound = true;
    for (std::size_t i = 0; i < size; ++i) {
      const toml::node &element = (*array)[i];
      const std::string element_name = fmt::format("entry {} of {}", i, who);
      sound &= names ? check_name(row, element, element_name)
                     : check_number(row, element, element_name, "a number");
    }
    return sound;
  }

  bool check_names(const Key &row, const toml::node &node, const std::string &who) {
    const toml::array *names = node.as_array();
    if (names == nullptr || names->empty() || names->size() > most_vertices) {
      return wrong_type(row, node, who, fmt::format("an array of 1 to {} names", most_vertices));
    }
    bool sound = true;
    for (std::size_t i = 0; i < names->size(); ++i) {
      sound &= check_name(row, (*names)[i], fmt::format("entry {} of {}", i, who));
    }
    return sound;
  }

  bool check_time_table(const Key &row, const toml::node &node, const std::string &who, const char *columns,
                        std::size_t num_columns) {
    const toml::array *rows = node.as_array();
    if (rows == nullptr) {
      return wrong_type(row, node, who, fmt::format("an array of rows {}", columns));
    }
    if (rows->empty() || rows->size() > most_table_rows) {
      return fault(node, fmt::format("{} has {} rows", who, rows->size()),
                   fmt::format("it must have 1 to {}", most_table_rows), example_of(row));
    }
    bool sound = true;
    for (std::size_t i = 0; i < rows->size(); ++i) {
      sound &= check_array(row, (*rows)[i], fmt::format("row {} of {}", i, who), num_columns);
    }
    return sound;
  }

  bool check_names_or_blanks(const Key &row, const toml::node &node, const std::string &who) {
    const toml::array *names = node.as_array();
    if (names == nullptr) {
      return wrong_type(row, node, who, "an array of names");
    }
    bool sound = true;
    for (std::size_t i = 0; i < names->size(); ++i) {
      const toml::node &element = (*names)[i];
      const bool is_empty = element.is_string() && element.as_string()->get().empty();
      sound &= is_empty || check_name(row, element, fmt::format("entry {} of {}", i, who));
    }
    return sound;
  }

  bool check_points(const Key &row, const toml::node &node, const std::string &who) {
    const bool is_polygon = row.kind == Kind::polygon;
    const toml::array *points = node.as_array();
    if (points == nullptr) {
      return wrong_type(row, node, who, "an array of points [x, y]");
    }
    if (points->size() < (is_polygon ? 3 : 1)) {
      return fault(node, fmt::format("{} has {} points", who, points->size()),
                   is_polygon ? fmt::format("{} has at least 3", polygon_of(row))
                              : std::string("at least one is needed"),
                   example_of(row));
    }
    if (points->size() > most_vertices) {
      return fault(node, fmt::format("{} has {} points", who, points->size()),
                   fmt::format("{} has at most {}", polygon_of(row), most_vertices),
                   is_polygon ? "simplify the outline" : "leave some of them out");
    }
    bool sound = true;
    for (std::size_t i = 0; i < points->size(); ++i) {
      const std::string point_name = fmt::format("{} {} of {}", is_polygon ? "vertex" : "point", i, who);
      sound &= check_point(row, (*points)[i], point_name);
    }
    return sound;
  }

  static std::string_view polygon_of(const Key &row) {
    return row.path.starts_with("block[]") ? "a block" : "a line or polygon";
  }

  bool check_point(const Key &row, const toml::node &node, const std::string &who) {
    const toml::array *point = node.as_array();
    if (point == nullptr) {
      return wrong_type(row, node, who, "a point [x, y]");
    }
    if (point->size() != 2) {
      return fault(node, fmt::format("{} has {} coordinates", who, point->size()), "the scene is plane",
                   "write [x, y]");
    }
    const bool sound = check_number(row, (*point)[0], who + ": x", "a number");
    return check_number(row, (*point)[1], who + ": y", "a number") && sound;
  }

  Faults *faults_;
  FaultyNodes faulty_;
};

} // namespace

FaultyNodes check_keys(const toml::table &root, Faults &faults) {
  Checker checker(faults);
  checker.check_table(root, "", "");
  return checker.take_faulty();
}

} // namespace gcpdda::scene_text
