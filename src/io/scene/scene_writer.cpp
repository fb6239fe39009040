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
    std::vector<std::pair<Origins::Order, std::string>> values;
    std::vector<std::pair<Origins::Order, Part>> parts;
    for (const auto &[key, node] : table) {
      const Origins::Order order = origins_->order(key.source());
      const std::string name = key_text(std::string(key.str()));
      const std::string below = path.empty() ? name : path + "." + name;
      if (const auto *sub_table = node.as_table()) {
        const bool has_header = !path.empty() || !holds_only_tables(*sub_table); // [material] needs none
        parts.emplace_back(order, Part{has_header ? fmt::format("[{}]", below) : "", below, sub_table});
      } else if (node.is_array_of_tables()) { // those of two arrays may alternate
        for (const toml::node &element : *node.as_array()) {
          parts.emplace_back(origins_->order(element.source()),
                             Part{fmt::format("[[{}]]", below), below, element.as_table()});
        }
      } else {
        values.emplace_back(order, fmt::format("{} = {}\n", name, value_text(node)));
      }
    }
    for (const auto &[order, text] : sorted(std::move(values))) {
      text_ += text;
    }
    for (const auto &[order, part] : sorted(std::move(parts))) {
      if (part.header.empty()) {
        write(*part.table, part.path);
      } else {
        write_below(part.header, *part.table, part.path);
      }
    }
  }

  [[nodiscard]] std::string take_text() { return std::move(text_); }

private:
  struct Part {
    std::string header; ///< empty where the parts of the table have headers alone
    std::string path;
    const toml::table *table;
  };

  template <class T>
  static std::vector<std::pair<Origins::Order, T>> sorted(std::vector<std::pair<Origins::Order, T>> entries) {
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto &a, const auto &b) { return a.first < b.first; });
    return entries;
  }

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
