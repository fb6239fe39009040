#pragma once

// Faults of a scene with their places, and how its text is shown in messages.

#include "gcpdda/base/diagnostic.hpp"
#include "io/scene/scene_toml.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace gcpdda::scene_text {

/// Where things of the scene were written: in the file (nodes without path), or in one of the --set
/// arguments, whose label toml++ keeps as the path of every node parsed from it.
class Origins {
public:
  /// File first, then the sets in their order; within one, line and column.
  using Order = std::tuple<std::size_t, std::uint32_t, std::uint32_t>;

  Origins(std::string file, const std::vector<std::string> &sets);

  [[nodiscard]] const std::string &label_of_set(std::size_t i) const { return labels_[i]; }
  [[nodiscard]] SourcePosition position(const toml::source_region &region) const;
  [[nodiscard]] Order order(const toml::source_region &region) const;
  /// "line 12", or the --set argument.
  [[nodiscard]] std::string place(const toml::source_region &region) const;

private:
  std::string file_;
  std::vector<std::string> labels_;
};

/// Collects the faults of a scene.
class Faults {
public:
  explicit Faults(const Origins &origins) : origins_(&origins) {}

  void add(const toml::source_region &where, std::string what, std::string why, std::string hint);
  /// Those of another reading of the scene that are not here yet.
  void add_new(const Faults &other);
  [[nodiscard]] bool empty() const { return entries_.empty(); }
  [[nodiscard]] const Origins &origins() const { return *origins_; }
  /// All of them, by position; those at one position in the order they were added.
  [[nodiscard]] Diagnostics sorted() const;

private:
  const Origins *origins_;
  std::vector<std::pair<Origins::Order, Diagnostic>> entries_;
};

/// Text of a person as it may stand in a one-line message: no control characters, not endless.
std::string shown(std::string_view text, std::size_t most = 60);

} // namespace gcpdda::scene_text
