#include "io/scene/scene_support.hpp"

#include "base/edit_distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <span>

namespace gcpdda::scene_text {

namespace {

constexpr std::array keys_of_any_bolt{"axial_stiffness", "axial_rigidity", "axial_yield",
                                      "rupture_strain",  "pretension",     "spacing"};
constexpr std::array keys_of_grouted{"shear_stiffness", "shear_yield", "active_length", "bond_strength",
                                     "plate"};
constexpr std::array keys_of_liners{"thickness",        "youngs_modulus",
                                    "poissons_ratio",   "compressive_strength",
                                    "tensile_strength", "residual_tensile_strength",
                                    "shear_strength",   "adhesion",
                                    "bond_width"};

void refuse_keys(const SceneSource &source, const Section &section, std::span<const char *const> keys,
                 const char *why, const char *hint) {
  for (const char *key : keys) {
    if (const toml::node *node = section.given(key)) {
      source.faults.add(node->source(), section.subject(key) + " has no meaning", why, hint);
    }
  }
}

/// A key that means something only beside another one.
void expect_beside(const SceneSource &source, const Section &section, const char *key, const char *other,
                   const char *why) {
  const toml::node *node = section.given(key);
  if (node != nullptr && section.given(other) == nullptr) {
    source.faults.add(node->source(),
                      fmt::format("{} has no meaning without '{}'", section.subject(key), other), why,
                      fmt::format("give {}, or leave it out", other));
  }
}

void expect_given(const SceneSource &source, const Section &section, const char *key, const char *why,
                  const char *hint) {
  if (section.given(key) == nullptr) {
    source.faults.add(section.source(), section.subject(key) + " is missing", why, hint);
  }
}

void expect_bolt_keys(const SceneSource &source, const Section &section, SupportType::Kind kind) {
  refuse_keys(source, section, keys_of_liners, "it belongs to liners",
              "leave it out, or write kind = \"liner\"");
  if (kind == SupportType::Kind::anchored) {
    refuse_keys(source, section, keys_of_grouted,
                "it belongs to grouted bolts; an anchored one acts at its ends alone",
                "leave it out, or write kind = \"grouted\"");
    return;
  }
  expect_given(source, section, "active_length", "a grouted bolt stretches over a length about each joint",
               "for example active_length = 0.3");
  expect_beside(source, section, "plate", "bond_strength",
                "grout that never slips holds the head without a plate");
  expect_beside(source, section, "shear_yield", "shear_stiffness", "without a stiffness there is no shear");
}

void expect_liner_keys(const SceneSource &source, const Section &section, const SupportType &support) {
  const char *const why =
      "it belongs to bolts; a liner is a layer with the modulus and strength of its material";
  const char *const hint = "leave it out, or write kind = \"grouted\"";
  refuse_keys(source, section, keys_of_any_bolt, why, hint);
  refuse_keys(source, section, keys_of_grouted, why, hint);
  expect_given(source, section, "thickness", "the stiffness of a liner rises with its thickness",
               "for example thickness = 0.1");
  expect_given(source, section, "youngs_modulus", "the stiffness of a liner is that of its material",
               "for example youngs_modulus = 20e9");
  expect_beside(source, section, "residual_tensile_strength", "tensile_strength",
                "a liner that never cracks has no strength after cracking");
  expect_beside(source, section, "bond_width", "adhesion", "without an adhesion the bond never fails");
  if (section.sound("residual_tensile_strength") != nullptr && section.known("tensile_strength") &&
      support.residual_tensile_strength > support.tensile_strength) {
    source.faults.add(
        section.given("residual_tensile_strength")->source(),
        fmt::format("{} is {:g} Pa", section.subject("residual_tensile_strength"),
                    support.residual_tensile_strength),
        fmt::format("the liner cracks at {:g} Pa and bears no more after it", support.tensile_strength),
        "use a value below tensile_strength");
  }
}

void expect_strength(const SceneSource &source, const Section &section, const SupportType &support) {
  const toml::node *stiffness = section.given("axial_stiffness");
  const toml::node *rigidity = section.given("axial_rigidity");
  if ((stiffness == nullptr) == (rigidity == nullptr) && section.is_table()) {
    source.faults.add(stiffness == nullptr ? section.source() : rigidity->source(),
                      fmt::format("{} gives {} axial_stiffness {} axial_rigidity", section.label(),
                                  stiffness == nullptr ? "neither" : "both",
                                  stiffness == nullptr ? "nor" : "and"),
                      "the stiffness of a bolt is one of them, or the rigidity over a length",
                      stiffness == nullptr ? "for example axial_stiffness = 5e7" : "leave one of them out");
  }
  if (section.sound("pretension") != nullptr && section.known("axial_yield") &&
      support.pretension > support.axial_yield) {
    source.faults.add(section.given("pretension")->source(),
                      fmt::format("{} is {:g} N", section.subject("pretension"), support.pretension),
                      fmt::format("the bolt yields at {:g} N", support.axial_yield),
                      "use a smaller pretension or a larger axial_yield");
  }
}

/// What bolts and liners have in common.
class PlacedReader {
public:
  PlacedReader(const SceneSource &source, const Scene &scene) : source_(source), scene_(&scene) {
    for (const SupportType &support : scene.supports) {
      support_names_.push_back(support.name);
    }
  }

protected:
  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) const {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

  std::optional<std::int32_t> support_of(const Section &section, bool is_liner) const {
    const auto name = section.text("support");
    if (!name) {
      return std::nullopt;
    }
    const auto found = std::find(support_names_.begin(), support_names_.end(), *name);
    if (found == support_names_.end()) {
      const std::string near = nearest_word(*name, support_names_);
      fault(section.given("support")->source(), fmt::format("no support is named '{}'", *name), "",
            near.empty() ? fmt::format("write [support.{}]", *name)
                         : fmt::format("did you mean '{}'?", near));
      return std::nullopt;
    }
    const auto index = static_cast<std::size_t>(found - support_names_.begin());
    if ((scene_->supports[index].kind == SupportType::Kind::liner) != is_liner) {
      fault(section.given("support")->source(),
            fmt::format("'{}' is a support of {}", *name, is_liner ? "bolts" : "liners"),
            is_liner ? "a liner needs a thickness and a modulus" : "a bolt needs an axial stiffness",
            is_liner ? fmt::format("give {} kind = \"liner\"", *name)
                     : fmt::format("give {} kind = \"grouted\" or \"anchored\"", *name));
      return std::nullopt;
    }
    return static_cast<std::int32_t>(index);
  }

  const Opening *opening_of(const Section &section) const {
    const auto name = section.text("opening");
    const std::vector<Opening> &openings = scene_->region.openings;
    const auto found = std::find_if(openings.begin(), openings.end(),
                                    [&](const Opening &opening) { return name && opening.name == *name; });
    if (found != openings.end()) {
      return found->outline.empty() ? nullptr : &*found; // a faulty one is told of there
    }
    if (name) {
      std::vector<std::string> names;
      for (const Opening &opening : openings) {
        names.push_back(opening.name);
      }
      const std::string near = nearest_word(*name, names);
      fault(section.given("opening")->source(), fmt::format("no opening is named '{}'", *name), "",
            openings.empty() ? "the scene has no [[opening]]"
            : near.empty()   ? fmt::format("the first one is '{}'", names.front())
                             : fmt::format("did you mean '{}'?", near));
    }
    return nullptr;
  }

  /// The arc between two angles, in degrees.
  void expect_angles(const Section &section, double from, double to) const {
    const bool known = section.known("from_angle_deg") && section.known("to_angle_deg");
    if (known && !is_arc(from, to)) {
      const toml::node *node =
          section.given(section.given("to_angle_deg") != nullptr ? "to_angle_deg" : "from_angle_deg");
      fault(node->source(), fmt::format("{} has no arc to stand on", section.label()),
            "it goes counter-clockwise from from_angle_deg to to_angle_deg, at most once around",
            "for example from_angle_deg = 0, to_angle_deg = 180");
    }
  }
  static bool is_arc(double from, double to) { return to > from && to - from <= 360.0 * (1.0 + 1e-12); }

  SceneSource source_;
  const Scene *scene_;

private:
  std::vector<std::string> support_names_;
};

class BoltReader : PlacedReader {
public:
  using PlacedReader::PlacedReader;

  std::vector<Bolt> read() {
    const std::vector<Section> single = listed_sections(source_.root, "bolt", source_.faulty);
    for (std::size_t i = 0; i < single.size(); ++i) {
      read_single(single[i], name_of_element("bolt", (*source_.root["bolt"].as_array())[i], i));
    }
    const std::vector<Section> patterns = listed_sections(source_.root, "bolt_pattern", source_.faulty);
    for (std::size_t i = 0; i < patterns.size(); ++i) {
      read_pattern(patterns[i],
                   name_of_element("bolt_pattern", (*source_.root["bolt_pattern"].as_array())[i], i));
    }
    return std::move(bolts_);
  }

private:
  /// Its own name is not taken yet.
  bool is_new(const Section &section, const std::string &name) {
    const auto [first, added] = first_of_name_.emplace(name, section.source());
    if (!added) {
      fault(section.source(), fmt::format("two bolts are named '{}'", name),
            fmt::format("the other one is at {}", source_.faults.origins().place(first->second)),
            "names of bolts are unique, those of a pattern are <pattern>.<n>");
    }
    return added;
  }

  void read_single(const Section &section, const std::string &name) {
    Bolt bolt;
    bolt.name = name;
    bolt.where = source_.faults.origins().position(section.source());
    const auto support = support_of(section, false);
    section.read("from", bolt.from);
    section.read("to", bolt.to);
    section.read("active", bolt.active);
    const bool placed = section.sound("from") != nullptr && section.sound("to") != nullptr;
    if (placed && bolt.from == bolt.to) {
      fault(section.given("to")->source(), fmt::format("{} has no length", section.label()),
            "'from' and 'to' are the same point", "give its head and its tip");
    }
    if (is_new(section, name) && support && placed) {
      bolt.support = *support;
      bolts_.push_back(std::move(bolt));
    }
  }

  void expect_number(const Section &section) const {
    const bool has_count = section.given("count") != nullptr;
    if (has_count == (section.given("spacing") != nullptr) && section.is_table()) {
      fault(has_count ? section.given("spacing")->source() : section.source(),
            fmt::format("{} gives {} count {} spacing", section.label(), has_count ? "both" : "neither",
                        has_count ? "and" : "nor"),
            "the number of bolts is given, or follows from their distance",
            has_count ? "leave one of them out" : "for example spacing = 1.5");
    }
  }

  void read_pattern(const Section &section, const std::string &name) {
    constexpr double per_degree = std::numbers::pi / 180.0;
    BoltPattern pattern;
    double from = 0.0;
    double to = 180.0;
    bool active = true;
    section.read("length", pattern.length);
    section.read("from_angle_deg", from);
    section.read("to_angle_deg", to);
    section.read("count", pattern.count);
    section.read("spacing", pattern.spacing);
    section.read("active", active);
    pattern.from_angle = from * per_degree;
    pattern.to_angle = to * per_degree;
    const auto support = support_of(section, false);
    const Opening *opening = opening_of(section);
    expect_number(section);
    expect_angles(section, from, to);
    const bool counted = pattern.count > 0 || pattern.spacing > 0.0;
    if (!support || opening == nullptr || !counted || !(pattern.to_angle > pattern.from_angle) ||
        section.sound("length") == nullptr) {
      return;
    }
    double around = 0.0;
    for (std::size_t k = 0; k < opening->outline.size(); ++k) {
      around += norm(opening->outline[(k + 1) % opening->outline.size()] - opening->outline[k]);
    }
    if (pattern.count == 0 && around / pattern.spacing > static_cast<double>(most_blocks)) {
      fault(section.given("spacing")->source(), fmt::format("{} has too many bolts", section.label()),
            fmt::format("a pattern has at most {}", most_blocks), "use a larger spacing");
      return;
    }
    const std::vector<BoltLine> lines = bolts_of(pattern, opening->outline);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      Bolt bolt{fmt::format("{}.{}", name, k),
                *support,
                lines[k].from,
                lines[k].to,
                active,
                source_.faults.origins().position(section.source())};
      if (!is_new(section, bolt.name)) {
        return;
      }
      bolts_.push_back(std::move(bolt));
    }
  }

  std::map<std::string, toml::source_region> first_of_name_;
  std::vector<Bolt> bolts_;
};

class LinerReader : PlacedReader {
public:
  using PlacedReader::PlacedReader;

  std::vector<Liner> read() {
    const std::vector<Section> sections = listed_sections(source_.root, "liner", source_.faulty);
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const Section &section = sections[i];
      Liner liner;
      liner.name = name_of_element("liner", (*source_.root["liner"].as_array())[i], i);
      liner.where = source_.faults.origins().position(section.source());
      const auto support = support_of(section, true);
      section.read("active", liner.active);
      place(section, liner);
      const auto [first, is_new] = first_of_name_.emplace(liner.name, section.source());
      if (!is_new) {
        fault(section.source(), fmt::format("two liners are named '{}'", liner.name),
              fmt::format("the other one is at {}", source_.faults.origins().place(first->second)),
              "names of liners are unique");
      }
      if (is_new && support && !liner.path.empty()) {
        liner.support = *support;
        liners_.push_back(std::move(liner));
      }
    }
    return std::move(liners_);
  }

private:
  void place(const Section &section, Liner &liner) const {
    const bool has_points = section.given("points") != nullptr;
    if (has_points == (section.given("opening") != nullptr) && section.is_table()) {
      fault(has_points ? section.given("points")->source() : section.source(),
            fmt::format("{} gives {} opening {} points", section.label(), has_points ? "both" : "neither",
                        has_points ? "and" : "nor"),
            "a liner follows the outline of an opening, or a line of points along a face",
            has_points ? "leave one of them out" : "for example opening = \"tunnel\"");
      return;
    }
    if (has_points) {
      place_on_points(section, liner);
    } else {
      place_on_opening(section, liner);
    }
  }

  void place_on_points(const Section &section, Liner &liner) const {
    for (const char *key : {"from_angle_deg", "to_angle_deg"}) {
      if (const toml::node *node = section.given(key)) {
        fault(node->source(), section.subject(key) + " has no meaning",
              "it belongs to an opening; points begin and end where they are given", "leave it out");
      }
    }
    section.read("points", liner.path);
    liner.has_rock_on_right = false;
    const auto same = std::adjacent_find(liner.path.begin(), liner.path.end());
    if (section.sound("points") != nullptr && (liner.path.size() < 2 || same != liner.path.end())) {
      fault(section.given("points")->source(),
            fmt::format("{} {}", section.subject("points"),
                        liner.path.size() < 2 ? "has fewer than two points"
                                              : "has the same point twice in a row"),
            "a liner follows the line from point to point", "for example points = [[0, 0], [10, 0]]");
      liner.path.clear();
    }
  }

  void place_on_opening(const Section &section, Liner &liner) const {
    constexpr double per_degree = std::numbers::pi / 180.0;
    double from = 0.0;
    double to = 360.0;
    section.read("from_angle_deg", from);
    section.read("to_angle_deg", to);
    const bool has_from = section.given("from_angle_deg") != nullptr;
    const bool has_to = section.given("to_angle_deg") != nullptr;
    if (has_from != has_to) {
      fault(section.given(has_from ? "from_angle_deg" : "to_angle_deg")->source(),
            fmt::format("{} gives one angle", section.label()), "an arc has two ends",
            "give from_angle_deg and to_angle_deg, or neither of them for all around");
    } else {
      expect_angles(section, from, to);
    }
    const Opening *opening = opening_of(section);
    if (opening == nullptr || !is_arc(from, to)) {
      return;
    }
    liner.is_closed = !has_from || to - from > 360.0 * (1.0 - 1e-9);
    liner.path =
        liner.is_closed ? opening->outline : arc_of(opening->outline, from * per_degree, to * per_degree);
  }

  std::map<std::string, toml::source_region> first_of_name_;
  std::vector<Liner> liners_;
};

void read_liner_values(const Section &section, SupportType &support) {
  section.read("thickness", support.thickness);
  section.read("youngs_modulus", support.youngs_modulus);
  section.read("poissons_ratio", support.poissons_ratio);
  section.read("compressive_strength", support.compressive_strength);
  section.read("tensile_strength", support.tensile_strength);
  section.read("residual_tensile_strength", support.residual_tensile_strength);
  section.read("shear_strength", support.shear_strength);
  section.read("adhesion", support.adhesion);
  section.read("bond_width", support.bond_width);
}

} // namespace

std::vector<SupportType> read_supports(const SceneSource &source) {
  std::vector<SupportType> all;
  for (const NamedSection &named :
       named_sections(source.root, "support", source.faulty, source.faults.origins())) {
    const Section &section = named.section;
    SupportType support;
    support.name = named.name;
    section.read_choice("support.*", "kind", support.kind);
    section.read("axial_stiffness", support.axial_stiffness);
    section.read("axial_rigidity", support.axial_rigidity);
    section.read("axial_yield", support.axial_yield);
    section.read("shear_stiffness", support.shear_stiffness);
    section.read("shear_yield", support.shear_yield);
    section.read("rupture_strain", support.rupture_strain);
    section.read("pretension", support.pretension);
    section.read("active_length", support.active_length);
    section.read("bond_strength", support.bond_strength);
    section.read("plate", support.plate);
    section.read("spacing", support.spacing);
    read_liner_values(section, support);
    if (section.sound("kind") == nullptr) {
      // its keys cannot be judged
    } else if (support.kind == SupportType::Kind::liner) {
      expect_liner_keys(source, section, support);
    } else {
      expect_strength(source, section, support);
      expect_bolt_keys(source, section, support.kind);
    }
    all.push_back(std::move(support));
  }
  return all;
}

std::vector<Bolt> read_bolts(const SceneSource &source, const Scene &scene) {
  return BoltReader(source, scene).read();
}

std::vector<Liner> read_liners(const SceneSource &source, const Scene &scene) {
  return LinerReader(source, scene).read();
}

} // namespace gcpdda::scene_text
