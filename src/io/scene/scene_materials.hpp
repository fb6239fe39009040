#pragma once

// Tables [material.NAME] of a scene.

#include "io/scene/scene_section.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace gcpdda::scene_text {

using MaterialIndex = std::map<std::string, std::int32_t>;

/// The materials while the scene is read.
class Materials {
public:
  explicit Materials(const SceneSource &source);

  [[nodiscard]] const std::vector<Material> &all() const { return materials_; }
  [[nodiscard]] const MaterialIndex &index() const { return index_; }

  /// Index of the material that a section names; -1 where it names none, with a fault where it is unknown.
  std::int32_t find(const Section &section);
  /// Where `who` deforms, its material must say how: one fault per material.
  void expect_elastic(std::int32_t material, const std::string &who, const toml::node &where);
  /// The blocks of a file may be of any material.
  void expect_all_elastic();

private:
  void report_missing(std::int32_t material, const toml::source_region &where, const std::string &what,
                      const std::string &why);

  SceneSource source_;
  std::vector<Material> materials_;
  std::vector<NamedSection> sections_;
  MaterialIndex index_;
  std::set<std::int32_t> reported_;
};

/// Index of a material, -1 (and a fault at `where`) where no material has that name.
std::int32_t find_material(const MaterialIndex &materials, const std::string &name,
                           const toml::source_region &where, Faults &faults);

} // namespace gcpdda::scene_text
