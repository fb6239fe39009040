#include "io/scene/scene_materials.hpp"

#include "base/edit_distance.hpp"

#include <fmt/format.h>

namespace gcpdda::scene_text {

Materials::Materials(const SceneSource &source)
    : source_(source),
      sections_(named_sections(source.root, "material", source.faulty, source.faults.origins())) {
  for (const auto &[name, section] : sections_) {
    Material &material = materials_.emplace_back();
    material.name = name;
    section.read("density", material.density);
    section.read("youngs_modulus", material.youngs_modulus);
    section.read("poissons_ratio", material.poissons_ratio);
    index_.emplace(name, static_cast<std::int32_t>(index_.size()));
  }
}

std::int32_t Materials::find(const Section &section) {
  const auto name = section.text("material");
  return name ? find_material(index_, *name, section.given("material")->source(), source_.faults) : -1;
}

void Materials::expect_elastic(std::int32_t material, const std::string &who, const toml::node &where) {
  if (material >= 0) {
    report_missing(material, where.source(),
                   fmt::format("{} is deformable but its material '{}' has", who,
                               sections_[static_cast<std::size_t>(material)].name),
                   "a deformable block has its stiffness from both");
  }
}

void Materials::expect_all_elastic() {
  for (std::int32_t m = 0; m < static_cast<std::int32_t>(sections_.size()); ++m) {
    const NamedSection &named = sections_[static_cast<std::size_t>(m)];
    report_missing(
        m, named.section.source(),
        fmt::format("the blocks of the block file are deformable but material '{}' has", named.name),
        "they may be of any material");
  }
}

void Materials::report_missing(std::int32_t material, const toml::source_region &where,
                               const std::string &what, const std::string &why) {
  const NamedSection &named = sections_[static_cast<std::size_t>(material)];
  const bool modulus = named.section.is_table() && named.section.given("youngs_modulus") == nullptr;
  const bool ratio = named.section.is_table() && named.section.given("poissons_ratio") == nullptr;
  if ((!modulus && !ratio) || !reported_.insert(material).second) {
    return;
  }
  const char *missing = modulus && ratio ? "neither youngs_modulus nor poissons_ratio"
                        : modulus        ? "no youngs_modulus"
                                         : "no poissons_ratio";
  const char *example = modulus && ratio ? "youngs_modulus = 40e9 and poissons_ratio = 0.25"
                        : modulus        ? "youngs_modulus = 40e9"
                                         : "poissons_ratio = 0.25";
  source_.faults.add(where, fmt::format("{} {}", what, missing), why,
                     fmt::format("for example {} in [material.{}]", example, named.name));
}

std::int32_t find_material(const MaterialIndex &materials, const std::string &name,
                           const toml::source_region &where, Faults &faults) {
  const auto found = materials.find(name);
  if (found != materials.end()) {
    return found->second;
  }
  std::vector<std::string> names;
  for (const auto &[known, index] : materials) {
    names.push_back(known);
  }
  const std::string near = nearest_word(name, names);
  faults.add(where, fmt::format("no material is named '{}'", name), "",
             near.empty() ? fmt::format("add a table [material.{}]", name)
                          : fmt::format("did you mean '{}'?", near));
  return -1;
}

} // namespace gcpdda::scene_text
