#pragma once

// A table of a scene while it is read: values by key, with what is wrong with them.

#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/scene.hpp"
#include "io/scene/scene_faults.hpp"
#include "io/scene/scene_keys.hpp"
#include "io/scene/scene_toml.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace gcpdda::scene_text {

/// Nodes already reported: nothing that rests on them is reported again.
using FaultyNodes = std::unordered_set<const toml::node *>;

/// What the parts of a scene are put together from.
struct SceneSource {
  const toml::table &root;
  const FaultyNodes &faulty;
  Faults &faults;
};

/// Whether the scene has a stage. An empty list of stages means what none means: one run of run.duration.
bool has_stages(const toml::table &root);

double as_number(const toml::node &node);

/// "'density' in [material.granite]"; without `in` at the top level.
std::string subject(std::string_view key, std::string_view label);

/// One table of the scene after the check against the table of keys.
class Section {
public:
  Section(const toml::node *node, std::string label, const FaultyNodes &faulty);

  [[nodiscard]] const std::string &label() const { return label_; }
  [[nodiscard]] std::string subject(std::string_view key) const { return scene_text::subject(key, label_); }
  [[nodiscard]] const toml::source_region &source() const { return node_->source(); }
  [[nodiscard]] bool is_table() const { return table_ != nullptr; }
  /// What is written for the key, right or wrong; null if nothing is.
  [[nodiscard]] const toml::node *given(std::string_view key) const;
  /// The same if it is right by itself.
  [[nodiscard]] const toml::node *sound(std::string_view key) const;
  /// Absent or right: the value in force is known.
  [[nodiscard]] bool known(std::string_view key) const { return given(key) == sound(key); }

  /// Where the key is given and sound, its value is put in; else `value` stays.
  void read(std::string_view key, double &value) const;
  void read(std::string_view key, bool &value) const;
  void read(std::string_view key, Vec2 &value) const;
  void read(std::string_view key, std::array<double, 3> &value) const;
  void read(std::string_view key, std::vector<Vec2> &value) const;
  void read(std::string_view key, std::vector<VelocityRow> &value) const;
  void read(std::string_view key, std::vector<LoadRow> &value) const;
  void read(std::string_view key, std::int64_t &value) const;
  /// The tables of a list below; none if the list as a whole is at fault.
  [[nodiscard]] std::vector<Section> list(std::string_view key) const;
  /// The table below, "<key> of <this>" in messages; nothing where it is absent or at fault.
  [[nodiscard]] std::optional<Section> table(std::string_view key) const;
  [[nodiscard]] std::optional<std::string> text(std::string_view key) const;

  /// The words of a choice stand in the order of the enumerators.
  template <typename Enum>
  void read_choice(std::string_view parent, std::string_view key, Enum &value) const {
    const auto word = text(key);
    const auto words = words_of(find_key(parent, key)->choices);
    for (std::size_t i = 0; word && i < words.size(); ++i) {
      if (words[i] == *word) {
        value = static_cast<Enum>(i);
      }
    }
  }

private:
  const toml::node *node_;
  const toml::table *table_; ///< null where the node is no table
  std::string label_;
  const FaultyNodes *faulty_;
};

/// The table `name` of the top level.
Section section(const toml::table &root, std::string_view name, const FaultyNodes &faulty);

struct NamedSection {
  std::string name;
  Section section;
};

/// [name.] for every , in the order they were written.
std::vector<NamedSection> named_sections(const toml::table &root, std::string_view name,
                                         const FaultyNodes &faulty, const Origins &origins);

/// Every [[name]], in order; none if the list as a whole is at fault.
std::vector<Section> listed_sections(const toml::table &root, std::string_view name,
                                     const FaultyNodes &faulty);

/// How messages call element number `index` of a list: "block 'slider'", "wall 'wall0'", "[[monitor]]"; below
/// another table, "load 0 of block 'slider'".
/// @param above  what messages call the table that holds the list, "" for the top level
std::string label_of_element(std::string_view list, const toml::node &element, std::size_t index,
                             std::string_view above = "");

/// The name of element number `index` of the blocks, walls or pyramids: its own if it has a fit one, else
/// b<index>, wall<index>, pyramid<index>.
std::string name_of_element(std::string_view list, const toml::node &element, std::size_t index);

} // namespace gcpdda::scene_text
