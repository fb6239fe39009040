#include "io/scene/scene_reference.hpp"

#include "io/blocks/block_file_layout.hpp"
#include "io/scene/scene_keys.hpp"

#include <fmt/format.h>

#include <cmath>

namespace gcpdda {

namespace {

using namespace scene_text;

bool is_table(const Key &key) {
  return key.kind == Kind::table || key.kind == Kind::named_tables || key.kind == Kind::table_list;
}

/// "[m] Length." is the unit "m" and the sentence "Length."
struct Doc {
  std::string unit;
  std::string sentence;
};

Doc split(std::string_view doc) {
  const std::size_t end = doc.find("] ");
  if (!doc.starts_with('[') || end == std::string_view::npos) {
    return {"", std::string(doc)};
  }
  return {std::string(doc.substr(1, end - 1)), std::string(doc.substr(end + 2))};
}

std::string_view type_of(const Key &key) {
  switch (key.kind) {
  case Kind::table:
  case Kind::named_tables:
    return "table";
  case Kind::table_list:
    return "list of tables";
  case Kind::number:
    return "number";
  case Kind::number_or_auto:
    return "number or \"auto\"";
  case Kind::boolean:
    return "boolean";
  case Kind::choice:
    return "word";
  case Kind::words:
    return "list of words";
  case Kind::name:
    return "name";
  case Kind::text:
    return "text";
  case Kind::pair_of_names:
    return "two names";
  case Kind::names:
  case Kind::names_or_blanks:
    return "list of names";
  case Kind::vector2:
    return "two numbers";
  case Kind::vector3:
    return "three numbers";
  case Kind::points:
    return "list of points";
  case Kind::polygon:
    return "list of at least 3 points";
  case Kind::velocity_table:
    return "list of rows of four numbers";
  case Kind::factor_table:
    return "list of rows of two numbers";
  case Kind::count:
    return "integer";
  case Kind::assignments:
    return "table of paths and values";
  }
  return "";
}

std::string allowed(const Key &key) {
  if (key.kind == Kind::choice || key.kind == Kind::words) {
    std::string words;
    for (const std::string &word : words_of(key.choices)) {
      words += fmt::format("{}`{}`", words.empty() ? "" : ", ", word);
    }
    return words;
  }
  if (key.kind == Kind::boolean) {
    return "`true`, `false`";
  }
  return std::isfinite(key.range.low) ? describe(key.range) : "";
}

std::string default_of(const Key &key) {
  if (key.need == Need::required) {
    return "required";
  }
  if (key.fallback.starts_with('<')) {
    return std::string(key.fallback.substr(1, key.fallback.size() - 2));
  }
  return key.fallback.empty() ? "" : fmt::format("`{}`", key.fallback);
}

std::string row_of(const Key &key) {
  const Doc doc = split(key.doc);
  const std::string example =
      is_table(key) ? std::string(key.example) : fmt::format("{} = {}", name_of(key), key.example);
  return fmt::format("| `{}` | {} | {} | {} | {} | {} | `{}` |\n", name_of(key), type_of(key), doc.unit,
                     default_of(key), allowed(key), doc.sentence, example);
}

/// A heading for the table, what it is for, and its keys. A table of named tables has no keys of its own.
std::string page_of(const Key &table) {
  if (table.kind == Kind::named_tables) {
    return "";
  }
  std::string header = header_of(table.path);
  if (const std::size_t star = header.find('*'); star != std::string::npos) {
    header.replace(star, 1, "NAME");
  }
  std::string doc(table.doc);
  for (const Key &key : scene_keys()) {
    if (key.kind == Kind::named_tables && parent_of(table) == key.path) {
      doc = std::string(key.doc) + " " + doc;
    }
  }
  const bool required = table.need == Need::required || name_of(table) == "*";
  std::string text = fmt::format("\n## {}\n\n{}{}\n\n", header, doc, required ? " Required." : "");
  text += "| key | type | unit | default | allowed | meaning | example |\n";
  text += "|---|---|---|---|---|---|---|\n";
  for (const Key &key : scene_keys()) {
    if (parent_of(key) == table.path) {
      text += row_of(key);
    }
  }
  return text;
}

std::string block_file_page() {
  std::string text = "\n## The file of [blocks]\n\nAn HDF5 file with n points and nb blocks. Block k of the "
                     "file is named b<id>, where its id is k plus the number of blocks of [[block]], "
                     "[[wall]] and [[pyramid]].\n\n"
                     "| dataset | values | shape | unit | | meaning |\n|---|---|---|---|---|---|\n";
  for (const block_file::DatasetRule &rule : block_file::layout) {
    const Doc doc = split(rule.doc);
    text += fmt::format("| `/{}` | {} | {} | {} | {} | {} |\n", rule.name, words_of(rule.number),
                        shape_of(rule), doc.unit, rule.required ? "required" : "optional", doc.sentence);
  }
  return text;
}

} // namespace

std::string scene_reference() {
  std::string text =
      "# Scene keys\n\nA scene is a TOML file: tables, and keys with values, in any order. Integers are "
      "accepted wherever numbers are. Lengths and all else are in SI units, x to the right, y up, angles "
      "counter-clockwise; the scene is 1 m thick. A name holds 1 to 100 letters, digits, _ . and -. A key "
      "that is left out has its default; an unknown one is a fault.\n\n`--set` replaces a value: "
      "`--set run.duration=3`, and by name `--set block.slider.fixed=true`, `--set wall.wall0.rows=20`.\n";
  for (const Key &key : scene_keys()) {
    if (is_table(key)) {
      text += page_of(key);
    }
  }
  return text + block_file_page();
}

} // namespace gcpdda
