#pragma once

// The list of all keys of a scene: kind, range, default, text.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gcpdda::scene_text {

/// What a key holds.
enum class Kind {
  table,          ///< [run]
  named_tables,   ///< [material.NAME]
  table_list,     ///< [[block]]
  number,         ///< real or integer
  number_or_auto, ///< the same, or "auto"
  boolean,
  choice, ///< one of a few words
  words,  ///< a list of some of a few words
  name,
  text, ///< any one line
  pair_of_names,
  names_or_blanks, ///< list of names or empty texts
  vector2,
  vector3,
  points,         ///< list of [x, y]
  polygon,        ///< the same, at least three
  velocity_table, ///< list of [t, vx, vy, omega]
  factor_table,   ///< list of [t, factor]
  count,          ///< integer, or a real number that is one
  names,          ///< list of names
  assignments     ///< table of dotted paths and their values
};

/// Numbers a key accepts; also each number of a vector or polygon.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;

  [[nodiscard]] bool holds(double x) const {
    return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high);
  }
};

constexpr Range any{};
constexpr Range from_to(double low, double high) {
  return {low, high, false, false};
}
constexpr Range above_to(double low, double high) {
  return {low, high, true, false};
}
constexpr Range from_below(double low, double high) {
  return {low, high, false, true};
}
constexpr Range between(double low, double high) {
  return {low, high, true, true};
}

enum class Need { required, optional };
constexpr auto required = Need::required;
constexpr auto optional = Need::optional;

/// One row of the table of scene keys: all that is known of a key by itself. What several keys mean together
/// is checked where the scene is put together.
struct Key {
  std::string_view path; ///< `[]` ends a list of tables, `*` stands for a name a person chooses
  Kind kind;
  Need need;
  Range range;
  std::string_view choices;  ///< separated by blanks, in the order of the enumeration they are read into
  std::string_view fallback; ///< value when absent, as TOML or, between < and >, in words
  std::string_view example;  ///< as TOML
  std::string_view doc;      ///< one sentence; starts with the unit in brackets if there is one
};

inline constexpr std::size_t most_blocks = 10'000; ///< and other tables of one list
inline constexpr std::size_t most_vertices = 10'000;
inline constexpr std::size_t most_table_rows = 100'000;
inline constexpr std::size_t longest_name = 100;
inline constexpr std::size_t longest_text = 4096;
/// Of inline blocks, generators and block file together: ids fit 32 bits, which METIS and VTK count with.
inline constexpr std::int64_t most_blocks_in_all = 2'147'483'647;
inline constexpr double largest_coordinate = 1e9;

/// Every key of the scene contract, in the order of its description.
std::span<const Key> scene_keys();

/// "block[].vertices" -> "block[]", "vertices"; "block[]" -> "", "block".
std::string_view parent_of(const Key &key);
std::string_view name_of(const Key &key);

/// The row of `name` directly below the row `parent` ("" for the top level); null if there is none.
const Key *find_key(std::string_view parent, std::string_view name);

/// Names of the keys directly below `parent`, in table order.
std::vector<std::string> names_below(std::string_view parent);

/// How a person writes the table a key lives in: "[run]", "[material.*]", "[[block]]", "[[block.load]]".
std::string header_of(std::string_view parent);

/// The words of a choice.
std::vector<std::string> words_of(std::string_view choices);

/// "above 0 and at most 1".
std::string describe(const Range &range);

/// What the name of an unnamed element of a list begins with, before its position: "b", "wall", "pyramid".
std::string_view prefix_of_unnamed(std::string_view list);

/// Letters, digits, _ . and -, 1 to longest_name of them: fit for a file name on any system.
bool is_name(std::string_view text);

} // namespace gcpdda::scene_text
