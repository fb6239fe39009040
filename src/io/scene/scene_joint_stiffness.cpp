// Where a scene gives the modulus E_m of the rock mass, the stiffness is that of joints a spacing s apart in
// series with intact rock of modulus E_i, 1/E_m = 1/E_i + 1/(k_n s).

#include "io/scene/scene_joint_stiffness.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

namespace gcpdda::scene_text {

namespace {

constexpr std::array<const char *, 3> modulus_keys{"rock_mass_modulus", "intact_modulus", "spacing"};

const toml::node *first_given(const Section &section) {
  for (const char *key : modulus_keys) {
    if (const toml::node *node = section.given(key)) {
      return node;
    }
  }
  return nullptr;
}

} // namespace

StiffnessReader::StiffnessReader(const SceneSource &source) : source_(source) {
  const Section run = section(source.root, "run", source.faulty);
  Vec2 gravity = RunSettings{}.gravity;
  run.read("gravity", gravity);
  weightless_ = run.known("gravity") && gravity == Vec2{};
  for (const NamedSection &named :
       named_sections(source.root, "material", source.faulty, source.faults.origins())) {
    std::optional<double> &modulus = modulus_of_[named.name];
    if (named.section.sound("youngs_modulus") != nullptr) {
      modulus = 0.0;
      named.section.read("youngs_modulus", *modulus);
    }
  }
}

void StiffnessReader::fault(const toml::source_region &where, std::string what, std::string why,
                            std::string hint) {
  source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
}

bool StiffnessReader::are_exclusive(const Section &section) {
  const std::array<std::pair<const char *, const toml::node *>, 3> ways{
      {{"normal_stiffness", section.given("normal_stiffness")},
       {"allowed_overlap", section.given("allowed_overlap")},
       {"rock_mass_modulus", first_given(section)}}};
  const Origins &origins = source_.faults.origins();
  bool exclusive = true;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (std::size_t j = i + 1; j < ways.size(); ++j) {
      const toml::node *first = ways[i].second;
      const toml::node *second = ways[j].second;
      if (first == nullptr || second == nullptr) {
        continue;
      }
      exclusive = false;
      const bool first_last = origins.order(second->source()) < origins.order(first->source());
      const bool by_modulus = j == 2;
      fault((first_last ? first : second)->source(),
            by_modulus ? fmt::format("{} gives {} and {}", section.label(), ways[i].first,
                                     "keys of rock_mass_modulus")
                       : section.label() + " gives both normal_stiffness and allowed_overlap",
            "one follows from the other",
            by_modulus ? fmt::format("keep {}, or rock_mass_modulus with spacing", ways[i].first)
                       : "leave one of them out");
    }
  }
  return exclusive;
}

void StiffnessReader::read(const Section &section, bool is_default, JointLaw &law) {
  const bool by_stiffness = section.given("normal_stiffness") != nullptr;
  const bool by_overlap = section.given("allowed_overlap") != nullptr;
  const bool by_modulus = first_given(section) != nullptr;
  if (is_default && !by_stiffness && !by_overlap && !by_modulus) {
    fault(section.source(),
          section.label() + " gives none of normal_stiffness, allowed_overlap and rock_mass_modulus",
          "exactly one of them is needed", "for example normal_stiffness = 1e9");
  }
  if (!are_exclusive(section)) {
    return;
  }
  if (by_stiffness || by_overlap) {
    law.rock_mass_modulus = law.intact_modulus = law.spacing = 0.0;
  }
  if (by_stiffness) {
    law.allowed_overlap = 0.0;
    section.read("normal_stiffness", law.normal_stiffness);
  } else if (by_overlap) {
    read_overlap(section, law);
  } else if (by_modulus) {
    intact_of_default_ = intact_of_default_ || (is_default && section.given("intact_modulus") != nullptr);
    read_modulus(section, law);
  }
}

void StiffnessReader::read_overlap(const Section &section, JointLaw &law) {
  law.normal_stiffness = 0.0;
  section.read("allowed_overlap", law.allowed_overlap);
  if (weightless_) {
    fault(section.given("allowed_overlap")->source(),
          section.subject("allowed_overlap") + " has no meaning without gravity",
          "the stiffness follows from the weight of the blocks", "give normal_stiffness instead");
  }
}

void StiffnessReader::read_modulus(const Section &section, JointLaw &law) {
  law.allowed_overlap = 0.0;
  bool sound = true;
  for (const auto &[key, value, example] : {std::tuple("rock_mass_modulus", &law.rock_mass_modulus, "10e9"),
                                            std::tuple("spacing", &law.spacing, "0.5")}) {
    section.read(key, *value);
    sound = sound && section.known(key);
    if (section.given(key) == nullptr && *value == 0.0) {
      sound = false;
      fault(section.source(), section.subject(key) + " is missing",
            "the stiffness follows from rock_mass_modulus, spacing and the modulus of intact rock",
            fmt::format("for example {} = {}", key, example));
    }
  }
  if (section.given("intact_modulus") != nullptr) {
    section.read("intact_modulus", law.intact_modulus);
    sound = sound && section.known("intact_modulus");
  } else if (!intact_of_default_) {
    const std::optional<double> modulus = modulus_of_materials(section);
    sound = sound && modulus;
    law.intact_modulus = modulus.value_or(0.0);
  }
  if (!sound) {
    return;
  }
  if (law.rock_mass_modulus >= law.intact_modulus) {
    const toml::node *modulus = section.given("rock_mass_modulus");
    fault(modulus != nullptr ? modulus->source() : section.source(),
          fmt::format("{} has a rock mass of {:g} Pa and intact rock of {:g} Pa", section.label(),
                      law.rock_mass_modulus, law.intact_modulus),
          "joints make rock softer, and the stiffness E_m E_i/(s (E_i - E_m)) would not be positive",
          fmt::format("use a rock_mass_modulus below {:g}", law.intact_modulus));
    return;
  }
  law.normal_stiffness =
      law.rock_mass_modulus / (law.spacing * (1.0 - law.rock_mass_modulus / law.intact_modulus));
  if (const Range range = find_key("joint.*", "normal_stiffness")->range;
      !range.holds(law.normal_stiffness)) {
    fault(section.source(),
          fmt::format("{} would have a normal stiffness of {:g} Pa/m", section.label(), law.normal_stiffness),
          fmt::format("it must be {}", describe(range)), "check rock_mass_modulus and spacing");
  }
}

/// Young's modulus of the law's pair of materials, or of all materials where the law has no pair; a fault
/// where it is not the same for all of them.
std::optional<double> StiffnessReader::modulus_of_materials(const Section &section) {
  std::map<std::string, std::optional<double>> concerned = modulus_of_;
  if (const toml::node *materials = section.sound("materials")) {
    concerned.clear();
    for (const toml::node &name : *materials->as_array()) {
      const std::string &material = name.as_string()->get();
      if (const auto found = modulus_of_.find(material); found != modulus_of_.end()) {
        concerned.insert(*found);
      }
    }
  }
  if (concerned.empty()) {
    return std::nullopt; // reported where the materials are read
  }
  const std::optional<double> modulus = concerned.begin()->second;
  for (const auto &[name, other] : concerned) {
    if (!other || other != modulus) {
      fault(section.source(), section.subject("intact_modulus") + " is missing",
            other ? "the Young's moduli of its materials differ"
                  : fmt::format("[material.{}] has no youngs_modulus", name),
            "for example intact_modulus = 40e9");
      return std::nullopt;
    }
  }
  return modulus;
}

} // namespace gcpdda::scene_text
