#include "io/scene/scene_joints.hpp"

#include "io/scene/joint_parameters.hpp"
#include "io/scene/scene_joint_stiffness.hpp"

#include "base/edit_distance.hpp"
#include "io/scene/scene_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace gcpdda::scene_text {

namespace {

constexpr std::string_view strength_sources =
    "Hoek & Bray (1981) table 1: 10 kPa (bentonite) to 55 MPa (granite); EN 10138: steel 1.9 GPa";
constexpr std::string_view angle_sources = "Barton & Choubey (1977): at most 70 degrees; Hoek & Bray (1981) "
                                           "table 1: bentonite 7, broken rock 50; Lama "
                                           "& Vutukuri (1978)";

double degrees_of(double tangent) {
  return std::atan(tangent) * 180.0 / std::numbers::pi;
}

using MaterialPair = std::pair<std::int32_t, std::int32_t>;

class JointReader {
public:
  JointReader(const SceneSource &source, const MaterialIndex &materials)
      : source_(source), materials_(&materials), stiffness_(source) {
    laws_.num_materials = static_cast<std::int32_t>(materials.size());
    laws_.of_material.assign(materials.size() * materials.size(), 0);
  }

  JointLaws read() {
    const auto sections = named_sections(source_.root, "joint", source_.faulty, source_.faults.origins());
    JointLaw base;
    base.name = "default";
    laws_.laws.push_back(base);
    const NamedSection *base_section = nullptr;
    for (const NamedSection &named : sections) {
      if (named.name == "default") {
        base_section = &named;
      }
    }
    if (base_section != nullptr) {
      read_default(base_section->section);
    } else if (!sections.empty()) {
      source_.faults.add(source_.root.get("joint")->source(), "'default' in [joint] is missing",
                         "pairs of materials without a law of their own take it", "write [joint.default]");
    }
    for (const NamedSection &named : sections) {
      if (&named != base_section) {
        read_special(named);
      }
    }
    return std::move(laws_);
  }

private:
  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

  void read_default(const Section &law) {
    if (const toml::node *materials = law.given("materials")) {
      fault(materials->source(), law.subject("materials") + " has no meaning",
            "the default law is for all pairs without their own", "leave it out");
    }
    read_values(law, laws_.laws.front());
  }

  void read_special(const NamedSection &named) {
    const Section &law = named.section;
    const auto index = static_cast<std::int32_t>(laws_.laws.size());
    laws_.laws.push_back(laws_.laws.front());
    laws_.laws.back().name = named.name;
    read_values(law, laws_.laws.back());
    if (const toml::node *materials = law.sound("materials")) {
      assign(law, *materials->as_array(), index);
    } else if (law.given("materials") == nullptr && law.is_table() && !may_be_on_edges(named.name)) {
      fault(law.source(), law.subject("materials") + " is missing",
            "a law other than default is for one pair of materials, or for edges that name it",
            hint_for_lone(named));
    }
  }

  /// A law that --set makes alone has a slip in its name, most likely.
  [[nodiscard]] std::string hint_for_lone(const NamedSection &named) const {
    std::vector<std::string> names;
    for (const JointLaw &law : laws_.laws) {
      if (law.name != named.name) {
        names.push_back(law.name);
      }
    }
    const bool is_set = named.section.source().path != nullptr;
    const std::string near = is_set ? nearest_word(named.name, names) : "";
    return near.empty() ? "for example materials = [\"granite\", \"clay\"]"
                        : fmt::format("did you mean '{}'?", near);
  }

  /// Blocks that are not written out here may name any law.
  [[nodiscard]] bool may_be_on_edges(const std::string &name) const {
    for (const char *source : {"blocks", "region"}) {
      if (source_.root.contains(source)) {
        return true;
      }
    }
    const toml::array *blocks = source_.root["block"].as_array();
    for (std::size_t i = 0; blocks != nullptr && i < blocks->size(); ++i) {
      const toml::table *block = (*blocks)[i].as_table();
      const toml::array *edges = block == nullptr ? nullptr : (*block)["edge_joints"].as_array();
      for (std::size_t k = 0; edges != nullptr && k < edges->size(); ++k) {
        if ((*edges)[k].value<std::string>() == name) {
          return true;
        }
      }
    }
    return false;
  }

  void read_values(const Section &law, JointLaw &values) {
    stiffness_.read(law, values.name == "default", values);
    law.read("tangential_ratio", values.tangential_ratio);
    law.read("cohesion", values.cohesion);
    read_angle(law, "friction_angle_deg", values.tan_friction);
    read_strength(law, values);
    read_dilation(law, values);
  }

  // Where a bond dilates it has broken.
  void read_dilation(const Section &law, JointLaw &values) {
    read_angle(law, "dilation_angle_deg", values.tan_dilation);
    law.read("dilation_limit", values.dilation_limit);
    if (!law.known("dilation_angle_deg") || !law.known("dilation_limit")) {
      return;
    }
    const toml::node *angle = law.given("dilation_angle_deg");
    const toml::source_region &where = angle != nullptr ? angle->source() : law.source();
    if (values.dilates() && values.dilation_limit == 0.0) {
      fault(where, law.subject("dilation_limit") + " is missing",
            "no joint opens for ever: its roughness ends where the slip is as long as an asperity",
            "for example dilation_limit = 0.01");
    }
    const bool has_residual = values.has_bonds || values.is_barton_bandis;
    const double tan_friction = has_residual ? values.residual_tan_friction : values.tan_friction;
    if (values.tan_dilation > (1.0 + 1e-12) * tan_friction) { // rounding of the tangents
      fault(where,
            fmt::format("{} has a dilation angle above its {}friction angle", law.label(),
                        has_residual ? "residual " : ""),
            "slip would do more work against the pressure than friction takes", "lower it");
    }
  }

  static void read_angle(const Section &law, const char *key, double &tangent) {
    if (law.sound(key) != nullptr) {
      double degrees = 0.0;
      law.read(key, degrees);
      tangent = std::tan(degrees * std::numbers::pi / 180.0);
    }
  }

  // What is not given is as in default, whose values stand in `values`; of default itself as without bonds.
  void read_strength(const Section &law, JointLaw &values) {
    enum class Kind { coulomb, barton_bandis };
    Kind kind = values.is_barton_bandis ? Kind::barton_bandis : Kind::coulomb;
    law.read_choice("joint.*", "law", kind);
    values.is_barton_bandis = kind == Kind::barton_bandis;
    law.read("jrc", values.roughness);
    law.read("jcs", values.strength);
    if (values.is_barton_bandis) {
      read_barton_bandis(law, values);
      return;
    }
    for (const char *key : {"jrc", "jcs"}) {
      if (const toml::node *node = law.given(key)) {
        fault(node->source(), law.subject(key) + " has no meaning for Coulomb's law",
              "it belongs to barton-bandis", "write law = \"barton-bandis\", or leave it out");
      }
    }
    values.roughness = 0.0;
    read_bonds(law, values);
  }

  // Another law takes the residual angle of [joint.default] only where that law gives one.
  void note_residual_of_default(const Section &law, const JointLaw &values) {
    if (values.name == "default") {
      residual_given_ = law.given("residual_friction_angle_deg") != nullptr;
    }
  }

  void read_barton_bandis(const Section &law, JointLaw &values) {
    for (const char *key : {"friction_angle_deg", "tension", "residual_cohesion"}) {
      if (const toml::node *node = law.given(key)) {
        fault(node->source(), law.subject(key) + " has no meaning for barton-bandis",
              "its friction angle follows from residual_friction_angle_deg, jrc, jcs and the pressure, and "
              "it has no bonds",
              "leave it out");
      }
    }
    for (const auto &[key, value] : {std::pair("jrc", values.roughness), std::pair("jcs", values.strength)}) {
      if (law.given(key) == nullptr && value == 0.0) {
        fault(law.source(), law.subject(key) + " is missing", "barton-bandis needs jrc and jcs",
              fmt::format("for example {}", key == std::string("jrc") ? "jrc = 8.0" : "jcs = 50e6"));
      }
    }
    // Without an angle of its own the law has that of [joint.default], whose values stand in `values`.
    read_angle(law, "residual_friction_angle_deg", values.residual_tan_friction);
    values.tan_friction = values.residual_tan_friction;
    note_residual_of_default(law, values);
    values.has_bonds = false;
    values.tension = 0.0;
  }

  void read_bonds(const Section &law, JointLaw &values) {
    for (const char *key : {"tension", "residual_friction_angle_deg", "residual_cohesion"}) {
      values.has_bonds = values.has_bonds || law.given(key) != nullptr;
    }
    law.read("tension", values.tension);
    law.read("residual_cohesion", values.residual_cohesion);
    note_residual_of_default(law, values);
    if (!residual_given_) {
      values.residual_tan_friction = values.tan_friction;
    }
    read_angle(law, "residual_friction_angle_deg", values.residual_tan_friction);
    const auto place = [&](const char *key) {
      return (law.given(key) != nullptr ? law.given(key)->source() : law.source());
    };
    if (values.residual_tan_friction > values.tan_friction) {
      fault(place("residual_friction_angle_deg"),
            law.label() + " has a residual friction angle above friction_angle_deg",
            "what is left when a bond breaks is less than before", "exchange them");
    }
    if (values.residual_cohesion > values.cohesion) {
      fault(place("residual_cohesion"), law.label() + " has a residual cohesion above its cohesion",
            "what is left when a bond breaks is less than before", "exchange them");
    }
    if (values.tension * values.tan_friction > (1.0 + 1e-12) * values.cohesion || // rounding of the tangent

        (values.tension > 0.0 && values.cohesion == 0.0)) {
      fault(place("tension"), fmt::format("{} has a tension of {} Pa", law.label(), values.tension),
            fmt::format(
                "Coulomb's line with a cohesion of {} Pa ends at cohesion/tan(friction angle) = {:.6g} Pa",
                values.cohesion, values.tan_friction > 0.0 ? values.cohesion / values.tan_friction : 0.0),
            "lower tension or raise cohesion");
    }
  }

  void assign(const Section &law, const toml::array &names, std::int32_t index) {
    const auto &first = names[0].as_string()->get();
    const auto &second = names[1].as_string()->get();
    const std::int32_t a = find_material(*materials_, first, names[0].source(), source_.faults);
    const std::int32_t b = find_material(*materials_, second, names[1].source(), source_.faults);
    if (a < 0 || b < 0) {
      return;
    }
    const auto [earlier, is_new] = law_of_pair_.emplace(MaterialPair(std::minmax(a, b)), law);
    if (!is_new) {
      fault(names.source(), fmt::format("{} is a second law for '{}' and '{}'", law.label(), first, second),
            fmt::format("{} at {} is for them too", earlier->second.label(),
                        source_.faults.origins().place(earlier->second.source())),
            "keep one of them");
      return;
    }
    const auto n = static_cast<std::size_t>(laws_.num_materials);
    const auto i = static_cast<std::size_t>(a);
    const auto j = static_cast<std::size_t>(b);
    laws_.of_material[i * n + j] = index;
    laws_.of_material[j * n + i] = index;
  }

  SceneSource source_;
  const MaterialIndex *materials_;
  StiffnessReader stiffness_;
  JointLaws laws_;
  bool residual_given_ = false; ///< in default
  std::map<MaterialPair, Section> law_of_pair_;
};

} // namespace

std::span<const JointParameter> joint_parameters() {
  // clang-format off
  static const std::vector<JointParameter> parameters{
    {{"joint", Kind::named_tables, required, any, "", "", "[joint.default]", "Contact laws: default for every pair of materials, further ones for the pair they name or for the edges of blocks that name them."}, nullptr, {}},
    {{"joint.*", Kind::table, optional, any, "", "", "[joint.default]", "One contact law; keys missing in another law than default are taken from default."}, nullptr, {}},
    {{"joint.*.materials", Kind::pair_of_names, optional, any, "", "<none: a law for edges that name it>", "[\"granite\", \"clay\"]", "The pair of materials that takes this law. A law without it must be named by edge_joints of a block, or the scene must have a region or a block file, whose edges may name it."}, nullptr, {}},
    {{"joint.*.normal_stiffness", Kind::number, optional, above_to(0, 1e20), "", "<exactly one of this, allowed_overlap and rock_mass_modulus>", "1e9", "[Pa/m] Normal stiffness k_n = 2 p_n/H."},
     [](const JointLaw &law) { return law.normal_stiffness; },
     {"", "Pa/m", 1e6, 1e14, 5e9, {{1e6, "MPa/m"}, {1e9, "GPa/m"}}, "clay-filled to tight rock joints, and what stands for a rigid contact, have", "Bandis, Lumsden & Barton (1983); Lama & Vutukuri (1978)"}},
    {{"joint.*.allowed_overlap", Kind::number, optional, between(0, 1), "", "<exactly one of this, normal_stiffness and rock_mass_modulus>", "0.001", "Overlap under the weight of the scene relative to the block size, from which the normal stiffness follows."},
     [](const JointLaw &law) { return law.allowed_overlap; },
     {"", "", 1e-8, 0.05, 1e-3, of_share, "overlaps that are small against a block have", "an overlap at rest above 5 % of a block is refused"}},
    {{"joint.*.rock_mass_modulus", Kind::number, optional, above_to(0, 1e20), "", "<exactly one of this, normal_stiffness and allowed_overlap>", "10e9", "[Pa] Modulus E_m of the rock mass across these joints, from which the normal stiffness E_m E_i/(s (E_i - E_m)) follows with intact_modulus E_i and spacing s: joints and intact rock in series."},
     [](const JointLaw &law) { return law.rock_mass_modulus; },
     {"", "Pa", 1e6, 1e11, 1e10, {{1e6, "MPa"}, {1e9, "GPa"}}, "fault zones to massive rock have", "Hoek & Diederichs (2006): 0.1 to 80 GPa"}},
    {{"joint.*.intact_modulus", Kind::number, optional, above_to(0, 1e20), "", "<youngs_modulus of the materials>", "40e9", "[Pa] Modulus E_i of the rock between the joints, above rock_mass_modulus; needed where the materials of the law (all of the scene, without a pair) have none or several."},
     [](const JointLaw &law) { return law.intact_modulus; },
     {"", "Pa", 1e7, 4e11, 4e10, {{1e6, "MPa"}, {1e9, "GPa"}}, "weak to very stiff intact rock has", "Deere & Miller (1966); Lama & Vutukuri (1978)"}},
    {{"joint.*.spacing", Kind::number, optional, above_to(0, 1e9), "", "<required with rock_mass_modulus>", "0.5", "[m] Mean spacing s of the joints that make the rock mass softer than intact rock."},
     [](const JointLaw &law) { return law.spacing; },
     {"", "m", 0.001, 500, 1, of_length, "joint sets have", "ISRM (1978): extremely close below 0.02 m, extremely wide above 6 m"}},
    {{"joint.*.tangential_ratio", Kind::number, optional, above_to(0, 1000), "", "0.5", "0.5", "Tangential stiffness over normal stiffness."},
     [](const JointLaw &law) { return law.tangential_ratio; },
     {"", "", 1e-3, 10, 0.5, {}, "rock joints and contacts have", "Bandis, Lumsden & Barton (1983)"}},
    {{"joint.*.friction_angle_deg", Kind::number, optional, from_below(0, 90), "", "0.0", "35.0", "[degrees] Friction angle."},
     [](const JointLaw &law) { return law.is_barton_bandis ? 0.0 : degrees_of(law.tan_friction); },
     {"", "degrees", 3, 80, 35, of_angle, "wet clay gouge to rough fresh joints have", angle_sources}},
    {{"joint.*.cohesion", Kind::number, optional, from_to(0, 1e20), "", "0.0", "0.0", "[Pa] Cohesion."},
     [](const JointLaw &law) { return law.cohesion; },
     {"", "Pa", 1e3, 2e9, 3e5, of_stress, "soil, joints, mortar, concrete, rock and steel have", strength_sources}},
    {{"joint.*.tension", Kind::number, optional, from_to(0, 1e20), "", "<none: no bonds>", "1e5", "[Pa] Tensile strength of the bonds, at most cohesion/tan(friction angle). A law with this key or a residual one has bonds: edges that lie on each other at the start hold together, with friction_angle_deg and cohesion in shear, until they break; then, and wherever else they touch, the residual values hold."},
     [](const JointLaw &law) { return law.tension; },
     {"", "Pa", 1e3, 2e9, 1e6, of_stress, "soil, mortar, concrete, rock and steel have", strength_sources}},
    {{"joint.*.residual_friction_angle_deg", Kind::number, optional, from_below(0, 90), "", "<friction_angle_deg>", "30.0", "[degrees] Friction angle without a bond, at most friction_angle_deg; of barton-bandis the angle that remains under high pressure, by default that of [joint.default]: its residual_friction_angle_deg if given, else its friction_angle_deg."},
     [](const JointLaw &law) { return degrees_of(law.residual_tan_friction); },
     {"", "degrees", 3, 80, 30, of_angle, "wet clay gouge to rough fresh joints have", angle_sources}},
    {{"joint.*.residual_cohesion", Kind::number, optional, from_to(0, 1e20), "", "<0 of a law with bonds>", "1e4", "[Pa] Cohesion without a bond, at most cohesion; only in a law with bonds."},
     [](const JointLaw &law) { return law.residual_cohesion; },
     {"", "Pa", 1e3, 2e9, 3e4, of_stress, "soil, joints, mortar, concrete and rock have", strength_sources}},
    {{"joint.*.dilation_angle_deg", Kind::number, optional, from_below(0, 90), "", "0.0", "8.0", "[degrees] Slip opens the joint by the tangent of this angle times itself, at most friction_angle_deg (or the residual one, where there is one), which holds the work that this takes."},
     [](const JointLaw &law) { return degrees_of(law.tan_dilation); },
     {"", "degrees", 0.3, 60, 8, of_angle, "rock joints have", "Barton & Choubey (1977); Wyllie & Mah (2004) chapter 4"}},
    {{"joint.*.dilation_limit", Kind::number, optional, above_to(0, 1e9), "", "<required with dilation_angle_deg>", "0.01", "[m] Slip of a contact after which it opens no further."},
     [](const JointLaw &law) { return law.dilation_limit; },
     {"", "m", 1e-5, 2, 0.01, of_length, "asperities of rock joints have lengths of", "Barton & Choubey (1977)"}},
    {{"joint.*.law", Kind::choice, optional, any, "coulomb barton-bandis", "\"coulomb\"", "\"coulomb\"", "Friction: Coulomb, or phi = residual angle + JRC log10(JCS/normal stress), at most 70 degrees."}, nullptr, {}},
    {{"joint.*.jrc", Kind::number, optional, above_to(0, 40), "", "<required for barton-bandis>", "8.0", "Joint roughness coefficient of barton-bandis."},
     [](const JointLaw &law) { return law.is_barton_bandis ? law.roughness : 0.0; },
     {"", "", 0.01, 20, 8, {}, "the profiles of Barton & Choubey have", "Barton & Choubey (1977): 0 to 20"}},
    {{"joint.*.jcs", Kind::number, optional, above_to(0, 1e20), "", "<required for barton-bandis>", "50e6", "[Pa] Joint wall compressive strength of barton-bandis."},
     [](const JointLaw &law) { return law.is_barton_bandis ? law.strength : 0.0; },
     {"", "Pa", 5e5, 5e8, 5e7, of_stress, "weathered walls to fresh rock have", "Barton & Choubey (1977); Hoek & Bray (1981)"}},
  };
  // clang-format on
  return parameters;
}

std::optional<std::int32_t> find_joint(const SceneSource &source, const toml::node &name,
                                       const JointLaws &joints) {
  const std::string &text = name.as_string()->get();
  std::vector<std::string> known;
  for (const JointLaw &law : joints.laws) {
    known.push_back(law.name);
  }
  const auto found = std::find(known.begin(), known.end(), text);
  if (found != known.end()) {
    return static_cast<std::int32_t>(found - known.begin());
  }
  const std::string near = nearest_word(text, known);
  source.faults.add(name.source(), fmt::format("no joint is named '{}'", text), "",
                    near.empty() ? fmt::format("add a table [joint.{}]", text)
                                 : fmt::format("did you mean '{}'?", near));
  return std::nullopt;
}

std::vector<std::int32_t> find_joints(const SceneSource &source, const Section &section, std::string_view key,
                                      const JointLaws &joints) {
  std::vector<std::int32_t> laws;
  const toml::node *names = section.sound(key);
  for (std::size_t i = 0; names != nullptr && i < names->as_array()->size(); ++i) {
    if (const auto law = find_joint(source, (*names->as_array())[i], joints)) {
      laws.push_back(*law);
    }
  }
  std::sort(laws.begin(), laws.end());
  return laws;
}

JointLaws read_joint_laws(const SceneSource &source, const MaterialIndex &materials) {
  return JointReader(source, materials).read();
}

} // namespace gcpdda::scene_text
