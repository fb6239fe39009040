#include "io/scene/scene_support.hpp"

#include "base/edit_distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

namespace gcpdda::scene_text {

namespace {

void expect_support_keys(const SceneSource &source, const Section &section, SupportType::Kind kind) {
  const bool is_grouted = kind == SupportType::Kind::grouted;
  for (const char *key : {"shear_stiffness", "shear_yield", "active_length", "bond_strength", "plate"}) {
    if (const toml::node *node = section.given(key); node != nullptr && !is_grouted) {
      source.faults.add(node->source(), section.subject(key) + " has no meaning",
                        "it belongs to grouted bolts; an anchored one acts at its ends alone",
                        "leave it out, or write kind = \"grouted\"");
    }
  }
  if (is_grouted && section.given("active_length") == nullptr) {
    source.faults.add(section.source(), section.subject("active_length") + " is missing",
                      "a grouted bolt stretches over a length about each joint",
                      "for example active_length = 0.3");
  }
  const auto needs = [&](const char *key, const char *other, const char *why) {
    const toml::node *node = section.given(key);
    if (is_grouted && node != nullptr && section.given(other) == nullptr) {
      source.faults.add(node->source(),
                        fmt::format("{} has no meaning without '{}'", section.subject(key), other), why,
                        fmt::format("give {}, or leave it out", other));
    }
  };
  needs("plate", "bond_strength", "grout that never slips holds the head without a plate");
  needs("shear_yield", "shear_stiffness", "without a stiffness there is no shear");
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

class BoltReader {
public:
  BoltReader(const SceneSource &source, const Scene &scene) : source_(source), scene_(&scene) {
    for (const SupportType &support : scene.supports) {
      support_names_.push_back(support.name);
    }
  }

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
  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

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

  std::optional<std::int32_t> support_of(const Section &section) {
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
    return static_cast<std::int32_t>(found - support_names_.begin());
  }

  void read_single(const Section &section, const std::string &name) {
    Bolt bolt;
    bolt.name = name;
    bolt.where = source_.faults.origins().position(section.source());
    const auto support = support_of(section);
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

  const Opening *opening_of(const Section &section) {
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

  void expect_arc(const Section &section, const BoltPattern &pattern) {
    const bool has_count = section.given("count") != nullptr;
    if (has_count == (section.given("spacing") != nullptr) && section.is_table()) {
      fault(has_count ? section.given("spacing")->source() : section.source(),
            fmt::format("{} gives {} count {} spacing", section.label(), has_count ? "both" : "neither",
                        has_count ? "and" : "nor"),
            "the number of bolts is given, or follows from their distance",
            has_count ? "leave one of them out" : "for example spacing = 1.5");
    }
    const double arc = pattern.to_angle - pattern.from_angle;
    const bool known = section.known("from_angle_deg") && section.known("to_angle_deg");
    if (known && !(arc > 0.0 && arc <= 2.0 * std::numbers::pi * (1.0 + 1e-12))) {
      const toml::node *node =
          section.given(section.given("to_angle_deg") != nullptr ? "to_angle_deg" : "from_angle_deg");
      fault(node->source(), fmt::format("{} has no arc to stand on", section.label()),
            "it goes counter-clockwise from from_angle_deg to to_angle_deg, at most once around",
            "for example from_angle_deg = 0, to_angle_deg = 180");
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
    const auto support = support_of(section);
    const Opening *opening = opening_of(section);
    expect_arc(section, pattern);
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

  SceneSource source_;
  const Scene *scene_;
  std::vector<std::string> support_names_;
  std::map<std::string, toml::source_region> first_of_name_;
  std::vector<Bolt> bolts_;
};

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
    expect_strength(source, section, support);
    if (section.sound("kind") != nullptr) {
      expect_support_keys(source, section, support.kind);
    }
    all.push_back(std::move(support));
  }
  return all;
}

std::vector<Bolt> read_bolts(const SceneSource &source, const Scene &scene) {
  return BoltReader(source, scene).read();
}

} // namespace gcpdda::scene_text
