// The formatter of toml++ sorts the keys, which would change the order of the materials, and writes 0.1 as
// 0.10000000000000001.

#include "io/scene/scene_writer.hpp"

#include "base/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace gcpdda::scene_text {

namespace {

std::string real_text(double x) {
  std::string text = fmt::format("{}", x); // shortest text that reads back to x
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

std::string value_text(const toml::node &node) {
  if (const auto *array = node.as_array()) {
    std::string text;
    for (const toml::node &element : *array) {
      text += (text.empty() ? "" : ", ") + value_text(element);
    }
    return "[" + text + "]";
  }
  if (const auto *real = node.as_floating_point()) {
    return real_text(real->get());
  }
  if (const auto *integer = node.as_integer()) {
    return fmt::format("{}", integer->get());
  }
  if (const auto *boolean = node.as_boolean()) {
    return boolean->get() ? "true" : "false";
  }
  const auto *string = node.as_string();
  expect(string != nullptr, "scene: a sound scene holds no dates");
  return scene_text::quoted(string->get()); // no control characters in a sound scene
}

class Writer {
public:
  explicit Writer(const Origins &origins) : origins_(&origins) {}

  // Values stand before sub-tables, as TOML demands.
  void write(const toml::table &table, const std::string &path) {
    std::vector<std::pair<Origins::Order, std::pair<std::string, const toml::node *>>> entries;
    for (const auto &[key, node] : table) {
      entries.emplace_back(origins_->order(key.source()), std::pair(std::string(key.str()), &node));
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto &a, const auto &b) { return a.first < b.first; });
    for (const auto &[order, entry] : entries) {
      if (!is_table(*entry.second)) {
        text_ += fmt::format("{} = {}\n", key_text(entry.first), value_text(*entry.second));
      }
    }
    for (const auto &[order, entry] : entries) {
      const std::string below = path.empty() ? key_text(entry.first) : path + "." + key_text(entry.first);
      if (const auto *sub_table = entry.second->as_table()) {
        if (path.empty() && holds_only_tables(*sub_table)) {
          write(*sub_table, below); // [material] itself needs no header
        } else {
          write_below(fmt::format("[{}]", below), *sub_table, below);
        }
      } else if (is_table(*entry.second)) {
        for (const toml::node &element : *entry.second->as_array()) {
          write_below(fmt::format("[[{}]]", below), *element.as_table(), below);
        }
      }
    }
  }

  [[nodiscard]] std::string take_text() { return std::move(text_); }

private:
  static bool is_table(const toml::node &node) { return node.is_table() || node.is_array_of_tables(); }

  static bool holds_only_tables(const toml::table &table) {
    return !table.empty() &&
           std::all_of(table.begin(), table.end(), [](const auto &entry) { return is_table(entry.second); });
  }

  static std::string key_text(const std::string &key) {
    const bool is_bare = std::all_of(key.begin(), key.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
             c == '-';
    });
    return is_bare && !key.empty() ? key : scene_text::quoted(key);
  }

  void write_below(const std::string &header, const toml::table &table, const std::string &path) {
    text_ += (text_.empty() ? "" : "\n") + header + "\n";
    write(table, path);
  }

  const Origins *origins_;
  std::string text_;
};

} // namespace

std::string quoted(const std::string &text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += '\\';
    }
    result += c;
  }
  return result + '"';
}

std::string to_toml(const toml::table &root, const Origins &origins) {
  Writer writer(origins);
  writer.write(root, "");
  return writer.take_text();
}

} // namespace gcpdda::scene_text
