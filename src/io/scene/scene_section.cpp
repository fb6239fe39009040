#include "io/scene/scene_section.hpp"

#include "base/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace gcpdda::scene_text {

bool has_stages(const toml::table &root) {
  const toml::node *stages = root.get("stage");
  return stages != nullptr && !(stages->is_array() && stages->as_array()->empty());
}

double as_number(const toml::node &node) {
  if (const auto *integer = node.as_integer()) {
    return static_cast<double>(integer->get());
  }
  const auto *real = node.as_floating_point();
  expect(real != nullptr, "scene: a number has been checked to be one");
  return real->get();
}

std::string subject(std::string_view key, std::string_view label) {
  return label.empty() ? fmt::format("'{}'", shown(key)) : fmt::format("'{}' in {}", shown(key), label);
}

Section::Section(const toml::node *node, std::string label, const FaultyNodes &faulty)
    : node_(node), table_(node->as_table()), label_(std::move(label)), faulty_(&faulty) {}

const toml::node *Section::given(std::string_view key) const {
  return table_ == nullptr ? nullptr : table_->get(key);
}

const toml::node *Section::sound(std::string_view key) const {
  const toml::node *node = given(key);
  return node != nullptr && faulty_->count(node) == 0 ? node : nullptr;
}

void Section::read(std::string_view key, double &value) const {
  if (const toml::node *node = sound(key)) {
    value = as_number(*node);
  }
}

void Section::read(std::string_view key, bool &value) const {
  if (const toml::node *node = sound(key)) {
    value = node->as_boolean()->get();
  }
}

void Section::read(std::string_view key, Vec2 &value) const {
  if (const toml::node *node = sound(key)) {
    const toml::array &numbers = *node->as_array();
    value = {as_number(numbers[0]), as_number(numbers[1])};
  }
}

void Section::read(std::string_view key, std::array<double, 3> &value) const {
  if (const toml::node *node = sound(key)) {
    const toml::array &numbers = *node->as_array();
    value = {as_number(numbers[0]), as_number(numbers[1]), as_number(numbers[2])};
  }
}

void Section::read(std::string_view key, std::vector<Vec2> &value) const {
  const toml::node *node = sound(key);
  const toml::array *points = node == nullptr ? nullptr : node->as_array();
  for (std::size_t i = 0; points != nullptr && i < points->size(); ++i) {
    const toml::array &point = *(*points)[i].as_array();
    value.push_back({as_number(point[0]), as_number(point[1])});
  }
}

void Section::read(std::string_view key, std::vector<VelocityRow> &value) const {
  const toml::node *node = sound(key);
  const toml::array *rows = node == nullptr ? nullptr : node->as_array();
  for (std::size_t i = 0; rows != nullptr && i < rows->size(); ++i) {
    const toml::array &row = *(*rows)[i].as_array();
    value.push_back({as_number(row[0]), {as_number(row[1]), as_number(row[2]), as_number(row[3])}});
  }
}

void Section::read(std::string_view key, std::vector<LoadRow> &value) const {
  const toml::node *node = sound(key);
  const toml::array *rows = node == nullptr ? nullptr : node->as_array();
  for (std::size_t i = 0; rows != nullptr && i < rows->size(); ++i) {
    const toml::array &row = *(*rows)[i].as_array();
    value.push_back({as_number(row[0]), as_number(row[1])});
  }
}

void Section::read(std::string_view key, std::int64_t &value) const {
  if (const toml::node *node = sound(key)) {
    value = static_cast<std::int64_t>(as_number(*node));
  }
}

std::vector<Section> Section::list(std::string_view key) const {
  const toml::node *node = sound(key);
  const toml::array *elements = node == nullptr ? nullptr : node->as_array();
  std::vector<Section> sections;
  for (std::size_t i = 0; elements != nullptr && i < elements->size(); ++i) {
    const toml::node &element = (*elements)[i];
    sections.emplace_back(&element, label_of_element(key, element, i, label_), *faulty_);
  }
  return sections;
}

std::optional<Section> Section::table(std::string_view key) const {
  const toml::node *node = sound(key);
  return node == nullptr ? std::nullopt
                         : std::optional(Section(node, fmt::format("{} of {}", key, label_), *faulty_));
}

std::optional<std::string> Section::text(std::string_view key) const {
  const toml::node *node = sound(key);
  return node == nullptr ? std::nullopt : node->value<std::string>();
}

Section section(const toml::table &root, std::string_view name, const FaultyNodes &faulty) {
  const toml::node *node = root.get(name);
  static const toml::table absent;
  return {node == nullptr ? &absent : node, fmt::format("[{}]", name), faulty};
}

std::vector<NamedSection> named_sections(const toml::table &root, std::string_view name,
                                         const FaultyNodes &faulty, const Origins &origins) {
  const toml::table *tables = root[name].as_table();
  if (tables == nullptr) {
    return {};
  }
  std::vector<std::pair<Origins::Order, NamedSection>> ordered;
  for (const auto &[key, node] : *tables) {
    const std::string label = fmt::format("[{}.{}]", name, shown(key.str()));
    ordered.emplace_back(origins.order(key.source()),
                         NamedSection{std::string(key.str()), Section(&node, label, faulty)});
  }
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const auto &a, const auto &b) { return a.first < b.first; });
  std::vector<NamedSection> sections;
  for (auto &[order, named] : ordered) {
    sections.push_back(std::move(named));
  }
  return sections;
}

std::vector<Section> listed_sections(const toml::table &root, std::string_view name,
                                     const FaultyNodes &faulty) {
  return Section(&root, "", faulty).list(name);
}

std::string label_of_element(std::string_view list, const toml::node &element, std::size_t index,
                             std::string_view above) {
  if (!above.empty()) {
    return fmt::format("{} {} of {}", list, index, above);
  }
  return list == "monitor" ? "[[monitor]]"
                           : fmt::format("{} '{}'", list, name_of_element(list, element, index));
}

std::string name_of_element(std::string_view list, const toml::node &element, std::size_t index) {
  if (const toml::table *table = element.as_table()) {
    const auto name = (*table)["name"].value<std::string_view>();
    if (name && is_name(*name)) {
      return std::string(*name);
    }
  }
  return fmt::format("{}{}", prefix_of_unnamed(list), index);
}

} // namespace gcpdda::scene_text
