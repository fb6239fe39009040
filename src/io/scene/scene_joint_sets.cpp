#include "io/scene/scene_joint_sets.hpp"

#include "io/scene/scene_joints.hpp"
#include "io/scene/scene_outline.hpp"
#include "model/joint_plane.hpp"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>

namespace gcpdda::scene_text {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180.0;

class JointSetReader {
public:
  JointSetReader(const SceneSource &source, const Section &region, const JointLaws &joints)
      : source_(source), region_(&region), joints_(&joints) {}

  /// Nothing where a value on which the set rests is at fault.
  std::optional<JointSet> read(const Section &section) {
    JointSet set;
    set.name = section.label();
    set.where = source_.faults.origins().position(section.source());
    if (const toml::node *name = section.sound("joint")) {
      set.joint = find_joint(source_, *name, *joints_).value_or(-1);
    }
    sound_ = true;
    read_direction(section, set);
    read_traces(section, set);
    read_intensity(section, set);
    section.read("origin", set.origin);
    section.read("seed", set.seed);
    const bool has_window =
        section.given("within") == nullptr || read_polygon(source_, section, "within", set.within);
    return sound_ && has_window ? std::optional(std::move(set)) : std::nullopt;
  }

private:
  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

  /// The set cannot be drawn without this value.
  void need(bool is_there) { sound_ = sound_ && is_there; }

  void read_direction(const Section &section, JointSet &set) {
    const toml::node *in_section = section.given("dip_deg");
    const toml::node *in_space =
        section.given("dip") != nullptr ? section.given("dip") : section.given("dip_direction");
    if (in_section != nullptr && in_space != nullptr) {
      fault(in_space->source(),
            fmt::format("{} gives both dip_deg and dip or dip_direction", section.label()),
            "the angle in the section follows from dip, dip_direction and region.azimuth",
            "leave dip_deg out, or the other two");
    } else if (in_section == nullptr && in_space == nullptr && section.is_table()) {
      fault(section.source(),
            fmt::format("{} gives neither dip_deg nor dip and dip_direction", section.label()),
            "the joints need a direction", "for example dip_deg = -35.0");
    }
    if (in_space != nullptr) {
      read_plane(section, set);
      need(in_section == nullptr);
      return;
    }
    if (const toml::node *fisher = section.given("fisher_k")) {
      fault(fisher->source(), section.subject("fisher_k") + " has no meaning",
            "it scatters planes in space, which dip and dip_direction give",
            "give these, or dip_scatter = {kind = \"fisher\", concentration = 200}");
    }
    need(section.sound("dip_deg") != nullptr);
    section.read("dip_deg", set.dip.mean);
    set.dip.mean *= radians_per_degree;
    read_scatter(section, "dip_scatter", "deviation_deg", set.dip);
  }

  void read_plane(const Section &section, JointSet &set) {
    for (const auto &[key, example] : {std::pair("dip", "40.0"), std::pair("dip_direction", "120.0")}) {
      need(section.sound(key) != nullptr);
      if (section.given(key) == nullptr) {
        fault(
            section.source(), section.subject(key) + " is missing",
            "a plane in space has dip and dip_direction",
            fmt::format("for example {} = {}, or dip_deg alone for the angle in the section", key, example));
      }
    }
    if (region_->given("azimuth") == nullptr) {
      fault(section.source(),
            fmt::format("{} is missing for {}", region_->subject("azimuth"), section.label()),
            "the trace of a plane depends on the direction of the x axis",
            "for example azimuth = 90.0 for a section from west to east");
    }
    if (const toml::node *scatter = section.given("dip_scatter")) {
      fault(scatter->source(), section.subject("dip_scatter") + " has no meaning with dip and dip_direction",
            "planes in space scatter in all directions", "give fisher_k instead, for example fisher_k = 200");
    }
    need(region_->sound("azimuth") != nullptr && section.known("fisher_k"));
    if (!sound_) {
      return;
    }
    JointPlane plane;
    double direction = 0.0;
    double azimuth = 0.0;
    section.read("dip", plane.dip);
    section.read("dip_direction", direction);
    section.read("fisher_k", plane.fisher);
    region_->read("azimuth", azimuth);
    plane.dip *= radians_per_degree;
    plane.bearing = (direction - azimuth) * radians_per_degree;
    const Pole pole = pole_of(plane);
    if (share_in_section(pole) < std::sin(parallel_deg * radians_per_degree)) {
      need(false);
      fault(
          section.given("dip_direction")->source(), section.label() + " is parallel to the section",
          fmt::format("planes that dip by {:g} degrees towards {:g} meet a section towards {:g} nowhere, or "
                      "at less than {:g} degree",
                      plane.dip / radians_per_degree, direction, azimuth, parallel_deg),
          "leave the set out, or choose another azimuth");
    }
    set.dip.mean = trace_angle(pole);
    set.plane = plane;
  }

  /// Either a spacing across the planes, in the section longer by their obliquity, or the length of traces
  /// per area of the section.
  void read_intensity(const Section &section, JointSet &set) {
    const toml::node *spacing = section.given("spacing");
    const toml::node *intensity = section.given("p21");
    if ((spacing == nullptr) == (intensity == nullptr) && section.is_table()) {
      fault(spacing != nullptr ? intensity->source() : section.source(),
            fmt::format("{} gives {} spacing {} p21", section.label(),
                        spacing != nullptr ? "both" : "neither", spacing != nullptr ? "and" : "nor"),
            "exactly one of them says how many joints there are",
            spacing != nullptr ? "leave one of them out" : "for example spacing = 2.0");
    }
    need((spacing == nullptr) != (intensity == nullptr) &&
         section.sound(spacing != nullptr ? "spacing" : "p21") != nullptr);
    const double share = set.plane ? share_in_section(pole_of(*set.plane)) : 1.0;
    section.read("spacing", set.spacing.mean);
    section.read("p21", set.intensity);
    read_scatter(section, "spacing_scatter", "deviation", set.spacing);
    if (!sound_) {
      return;
    }
    set.spacing.mean = spacing != nullptr ? set.spacing.mean / share : set.persistence() / set.intensity;
    set.spacing.width /= share;
    if (set.plane) {
      set.plane->spacing = share * set.spacing.mean;
    }
  }

  /// Angles have no smallest value, as lengths have: of the distributions of lengths they have the normal
  /// one.
  static Spread spread_of_angles(const Section &table) {
    enum class OfAngles { none, normal, fisher }; // in the order of the choices of the key
    OfAngles kind = OfAngles::none;
    table.read_choice("joint_set[].dip_scatter", "kind", kind);
    return kind == OfAngles::normal   ? Spread::normal
           : kind == OfAngles::fisher ? Spread::fisher
                                      : Spread::none;
  }

  /// @param deviation  key of the width of normal and lognormal
  void read_scatter(const Section &section, const char *key, const char *deviation, Scattered &scattered) {
    const auto table = section.table(key);
    if (!table) {
      return;
    }
    const bool is_angle = std::string_view(key) == "dip_scatter";
    if (is_angle) {
      scattered.spread = spread_of_angles(*table);
    } else {
      table->read_choice(fmt::format("joint_set[].{}", key), "kind", scattered.spread);
    }
    const bool by_deviation = scattered.spread == Spread::normal || scattered.spread == Spread::lognormal;
    expect_width(*table, deviation, by_deviation, "0.5");
    table->read(deviation, scattered.width);
    if (is_angle) {
      scattered.width *= radians_per_degree;
      expect_width(*table, "concentration", scattered.spread == Spread::fisher, "200");
      table->read("concentration", scattered.width);
    }
    if (std::string_view(key) == "trace_scatter") {
      read_power_law(*table, scattered);
    }
  }

  void read_power_law(const Section &table, Scattered &scattered) {
    const bool is_power_law = scattered.spread == Spread::power_law;
    expect_width(table, "exponent", is_power_law, "2.5");
    expect_width(table, "min", is_power_law, "1.0");
    expect_width(table, "max", is_power_law, "50.0");
    if (!is_power_law) {
      return;
    }
    table.read("exponent", scattered.width);
    table.read("min", scattered.low);
    table.read("max", scattered.high);
    const bool is_complete =
        table.sound("exponent") != nullptr && table.sound("min") != nullptr && table.sound("max") != nullptr;
    need(is_complete);
    if (is_complete && !(scattered.low < scattered.high)) {
      need(false);
      fault(table.given("max")->source(), fmt::format("{} is not above min", table.subject("max")),
            "lengths lie between min and max", "exchange them");
    } else if (is_complete) {
      scattered.mean = scattered.mean_of_power_law();
    }
  }

  void expect_width(const Section &table, const char *key, bool needed, const char *example) {
    const toml::node *given = table.given(key);
    if (table.sound("kind") == nullptr || (given != nullptr) == needed) {
      return;
    }
    if (needed) {
      fault(table.source(), fmt::format("{} is missing", table.subject(key)), "this kind of scatter needs it",
            fmt::format("for example {} = {}", key, example));
    } else {
      fault(given->source(), fmt::format("{} has no meaning", table.subject(key)),
            "this kind of scatter does not have it", "leave it out");
    }
  }

  void read_traces(const Section &section, JointSet &set) {
    const auto scatter = section.table("trace_scatter");
    const bool by_power_law = scatter && scatter->text("kind") == "power-law";
    if (const toml::node *length = section.given("trace_length"); by_power_law && length != nullptr) {
      fault(length->source(), section.subject("trace_length") + " has no meaning with a power law",
            "the mean follows from its exponent, min and max", "leave it out");
    }
    const bool has_trace = by_power_law || section.given("trace_length") != nullptr;
    const bool has_gap = section.given("gap") != nullptr;
    if (has_trace != has_gap) {
      const char *missing = has_trace ? "gap" : "trace_length";
      fault(section.source(), fmt::format("{} is missing", section.subject(missing)),
            "joints that end have a length and gaps between them",
            fmt::format("for example {} = 5.0, or leave both out", missing));
    }
    need(section.known("trace_length") && section.known("gap"));
    set.through_going = !has_trace || !has_gap;
    section.read("trace_length", set.trace.mean);
    read_scatter(section, "trace_scatter", "deviation", set.trace);
    section.read("gap", set.gap.mean);
    read_scatter(section, "gap_scatter", "deviation", set.gap);
    if (double stagger = 0.0; section.sound("stagger") != nullptr) {
      section.read("stagger", stagger);
      set.stagger = stagger;
    }
    for (const char *key : {"trace_scatter", "gap_scatter", "stagger"}) {
      if (!has_trace && !has_gap && section.given(key) != nullptr) {
        fault(section.given(key)->source(), fmt::format("{} has no meaning", section.subject(key)),
              "the joints are through-going", "give trace_length and gap, or leave it out");
      }
    }
  }

  /// Degrees between planes and the section below which they are taken as parallel.
  static constexpr double parallel_deg = 1.0;

  SceneSource source_;
  const Section *region_;
  const JointLaws *joints_;
  bool sound_ = true; ///< of the set that is being read
};

} // namespace

bool read_polygon(const SceneSource &source, const Section &section, const char *key,
                  std::vector<Vec2> &outline) {
  const toml::node *node = section.sound(key);
  if (node == nullptr) {
    return false;
  }
  std::vector<Vec2> vertices;
  section.read(key, vertices);
  std::vector<std::int32_t> no_joints;
  const std::vector<OutlineFault> faults = check_outline(vertices, no_joints, section.subject(key));
  for (const OutlineFault &f : faults) {
    source.faults.add(f.vertex ? (*node->as_array())[*f.vertex].source() : node->source(), f.what, f.why,
                      f.vertex ? f.hint : "list the vertices in order around the polygon");
  }
  if (faults.empty()) {
    outline = std::move(vertices);
  }
  return faults.empty();
}

std::vector<JointSet> read_joint_sets(const SceneSource &source, const Section &region,
                                      const JointLaws &joints) {
  std::vector<JointSet> sets;
  JointSetReader reader(source, region, joints);
  for (const Section &section : listed_sections(source.root, "joint_set", source.faulty)) {
    if (auto set = reader.read(section)) {
      sets.push_back(std::move(*set));
    }
  }
  return sets;
}

} // namespace gcpdda::scene_text
