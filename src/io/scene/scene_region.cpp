#include "io/scene/scene_region.hpp"

#include "geometry/aabb.hpp"
#include "geometry/polygon.hpp"
#include "io/scene/scene_joint_sets.hpp"
#include "io/scene/scene_joints.hpp"
#include "io/scene/scene_materials.hpp"
#include "io/scene/scene_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

namespace gcpdda::scene_text {

namespace {

constexpr double per_degree = std::numbers::pi / 180.0;
constexpr std::array<const char *, 7> lists{"joint_set", "fault",   "joint_map", "opening",
                                            "layer",     "voronoi", "bricks"};

class RegionReader {
public:
  RegionReader(const SceneSource &source, Materials &materials, Fidelity of_run, const JointLaws &joints,
               const std::string &scene_file)
      : source_(source), materials_(&materials), of_run_(of_run), joints_(&joints), scene_file_(scene_file) {}

  RockRegion read() {
    if (source_.root.get("region") == nullptr) {
      refuse_lists();
      return {};
    }
    const Section section = scene_text::section(source_.root, "region", source_.faulty);
    region_.where = position(section);
    region_.material = material_of(section);
    read_outline(section);
    region_.joint_sets = read_joint_sets(source_, section, *joints_);
    section.read("azimuth", region_.azimuth);
    region_.azimuth *= per_degree;
    read_lines();
    read_openings();
    read_layers();
    read_patterns();
    read_limits(section);
    if (region_.present()) {
      check_numbers(section);
    }
    return std::move(region_);
  }

private:
  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint) {
    source_.faults.add(where, std::move(what), std::move(why), std::move(hint));
  }

  SourcePosition position(const Section &section) const {
    return source_.faults.origins().position(section.source());
  }

  std::vector<Section> all(const char *list) const {
    return listed_sections(source_.root, list, source_.faulty);
  }

  void refuse_lists() {
    for (const char *list : lists) {
      if (const std::vector<Section> sections = all(list); !sections.empty()) {
        fault(sections[0].source(), fmt::format("{} has nothing to lie in", sections[0].label()),
              "the scene has no region", "write [region]");
      }
    }
  }

  void read_outline(const Section &section) {
    const bool has_polygon = section.given("polygon") != nullptr;
    const bool has_slope = section.given("slope") != nullptr;
    if (has_polygon == has_slope && section.is_table()) {
      fault(has_polygon ? section.given("slope")->source() : section.source(),
            fmt::format("[region] gives {} polygon {} slope", has_polygon ? "both" : "neither",
                        has_polygon ? "and" : "nor"),
            "its outline is one of them",
            has_polygon ? "leave one of them out"
                        : "for example polygon = [[0, 0], [20, 0], [20, 10], [0, 10]]");
      return;
    }
    read_polygon(source_, section, "polygon", region_.outline);
    if (const auto slope = section.table("slope")) {
      region_.outline = read_slope(*slope);
    }
  }

  std::vector<Vec2> read_slope(const Section &section) {
    SlopeProfile slope;
    section.read("toe", slope.toe);
    section.read("toe_length", slope.toe_length);
    section.read("crest_length", slope.crest_length);
    section.read("depth", slope.depth);
    bool sound = section.known("toe") && section.sound("toe_length") != nullptr &&
                 section.sound("crest_length") != nullptr && section.sound("depth") != nullptr;
    for (const Section &bench : section.list("bench")) {
      SlopeProfile::Bench &one = slope.benches.emplace_back();
      bench.read("height", one.height);
      bench.read("face_angle_deg", one.face_angle);
      bench.read("width", one.width);
      one.face_angle *= per_degree;
      sound = sound && bench.sound("height") != nullptr && bench.sound("face_angle_deg") != nullptr &&
              bench.known("width");
    }
    if (slope.benches.empty() && section.sound("bench") != nullptr) {
      fault(section.given("bench")->source(), "[region.slope] has no benches",
            "a slope has at least one face", "write [[region.slope.bench]]");
    }
    return sound && !slope.benches.empty() ? outline_of(slope) : std::vector<Vec2>();
  }

  std::int32_t joint_of(const Section &section) {
    const toml::node *name = section.sound("joint");
    return name == nullptr ? -1 : find_joint(source_, *name, *joints_).value_or(-1);
  }

  void read_lines() {
    for (const Section &section : all("fault")) {
      FaultLine line{section.label(), joint_of(section), {}, position(section)};
      section.read("points", line.points);
      if (section.sound("points") != nullptr && line.points.size() < 2) {
        fault(section.given("points")->source(), fmt::format("{} has one point", section.subject("points")),
              "a line has at least two", "add its other end");
      }
      region_.faults.push_back(std::move(line));
    }
    for (const Section &section : all("joint_map")) {
      JointMap map{"", "", joint_of(section), {}, position(section)};
      if (const auto path = section.text("file")) {
        map.path = (std::filesystem::path(scene_file_).parent_path() / *path).string();
        map.where = source_.faults.origins().position(section.given("file")->source());
        map.layer = section.text("layer").value_or("");
        const std::string end = std::filesystem::path(*path).extension().string();
        if (const toml::node *layer = section.given("layer");
            layer != nullptr && end != ".dxf" && end != ".DXF") {
          fault(layer->source(), fmt::format("{} has no meaning", section.subject("layer")),
                "only a .dxf drawing has layers", "leave it out");
        }
      }
      region_.maps.push_back(std::move(map));
    }
  }

  void read_openings() {
    std::map<std::string, toml::source_region> first_of_name;
    const std::vector<Section> sections = all("opening");
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const Section &section = sections[i];
      Opening opening;
      opening.name = name_of_element("opening", (*source_.root["opening"].as_array())[i], i);
      opening.joint = joint_of(section);
      opening.where = position(section);
      section.read("excavated", opening.excavated);
      if (const auto [first, is_new] = first_of_name.emplace(opening.name, section.source()); !is_new) {
        fault(section.source(), fmt::format("two openings are named '{}'", opening.name),
              fmt::format("the first is at {}", source_.faults.origins().place(first->second)),
              "names of openings are unique");
      }
      read_shape(section, opening);
      region_.openings.push_back(std::move(opening));
    }
  }

  void read_shape(const Section &section, Opening &opening) {
    OpeningShape shape;
    section.read_choice("opening[]", "shape", shape.kind);
    if (section.sound("shape") == nullptr) {
      return;
    }
    const bool is_polygon = shape.kind == OpeningShape::Kind::polygon;
    const bool has_height =
        shape.kind == OpeningShape::Kind::horseshoe || shape.kind == OpeningShape::Kind::d;
    bool sound = expect_given(section, "polygon", is_polygon, is_polygon);
    sound &= expect_given(section, "centre", !is_polygon, !is_polygon);
    sound &= expect_given(section, "width", !is_polygon, !is_polygon);
    sound &= expect_given(section, "height", false, has_height);
    sound &= expect_given(section, "chords", false, !is_polygon);
    if (is_polygon) {
      read_polygon(source_, section, "polygon", opening.outline);
      return;
    }
    section.read("centre", shape.centre);
    section.read("width", shape.width);
    shape.height = shape.width;
    section.read("height", shape.height);
    section.read("chords", shape.chords);
    if (!sound || !section.known("height") || !section.known("chords")) {
      return;
    }
    const double lowest = 0.5 * shape.width;
    const double highest =
        shape.kind == OpeningShape::Kind::horseshoe ? highest_horseshoe * shape.width : 1e9;
    if (has_height && !(shape.height > lowest && shape.height < highest)) {
      fault((section.given("height") != nullptr ? section.given("height") : section.given("width"))->source(),
            fmt::format("{} is {:g} m high and {:g} m wide", section.label(), shape.height, shape.width),
            "its walls do not meet roof and floor",
            fmt::format("use a height between {:g} and {:g} m", lowest, highest));
      return;
    }
    opening.outline = outline_of(shape);
  }

  bool expect_given(const Section &section, const char *key, bool needed, bool has_meaning) {
    const toml::node *given = section.given(key);
    if (needed && given == nullptr) {
      fault(section.source(), fmt::format("{} is missing", section.subject(key)), "its shape needs it",
            fmt::format("for example {} = {}", key, find_key("opening[]", key)->example));
    } else if (!has_meaning && given != nullptr) {
      fault(given->source(), fmt::format("{} has no meaning", section.subject(key)),
            "its shape does not have it", "leave it out");
    }
    return !needed || section.sound(key) != nullptr;
  }

  std::int32_t material_of(const Section &section) {
    const std::int32_t material = materials_->find(section);
    if (of_run_ == Fidelity::deformable && section.given("material") != nullptr) {
      materials_->expect_elastic(material, section.label(), *section.given("material"));
    }
    return std::max(0, material);
  }

  void read_layers() {
    for (const Section &section : all("layer")) {
      Layer layer;
      layer.joint = joint_of(section);
      layer.material = material_of(section);
      layer.where = position(section);
      if (read_polygon(source_, section, "polygon", layer.outline)) {
        region_.layers.push_back(std::move(layer));
      }
    }
  }

  void read_patterns() {
    for (const Section &section : all("voronoi")) {
      VoronoiCells cells;
      cells.joint = joint_of(section);
      cells.where = position(section);
      section.read("size", cells.size);
      section.read("irregularity", cells.irregularity);
      section.read("seed", cells.seed);
      if (section.sound("size") != nullptr) {
        region_.voronoi.push_back(cells);
      }
    }
    for (const Section &section : all("bricks")) {
      BrickPattern bricks;
      bricks.joint = joint_of(section);
      bricks.where = position(section);
      section.read("block_size", bricks.size);
      section.read("origin", bricks.origin);
      section.read("bond", bricks.bond);
      if (section.sound("block_size") != nullptr) {
        region_.bricks.push_back(bricks);
      }
    }
  }

  void read_limits(const Section &section) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const JointSet &set : region_.joint_sets) {
      smallest = std::min(smallest, set.spacing.mean);
    }
    for (const VoronoiCells &cells : region_.voronoi) {
      smallest = std::min(smallest, cells.size);
    }
    for (const BrickPattern &bricks : region_.bricks) {
      smallest = std::min({smallest, bricks.size.x, bricks.size.y});
    }
    const double root = region_.present() ? std::sqrt(signed_area(region_.outline)) : 1.0;
    // In-situ stress presses a thin block together by as much as a thick one.
    const double sliver_share = source_.root.contains("in_situ") ? 0.05 : 0.02;
    constexpr double smallest_share = 1e-6; // where no spacing tells how large blocks are
    region_.min_width = std::isfinite(smallest) ? sliver_share * smallest : smallest_share * root;
    section.read("min_width", region_.min_width);
    region_.min_area = region_.min_width * region_.min_width;
    section.read("min_area", region_.min_area);
    section.read_choice("region", "slivers", region_.slivers);
    region_.max_blocks = 2'000'000;
    section.read("max_blocks", region_.max_blocks);
    constexpr double frame_share = 0.05;
    region_.fixed_thickness = frame_share * root;
    section.read("fixed_thickness", region_.fixed_thickness);
    const toml::node *fixed = section.sound("fixed");
    const toml::array *sides = fixed == nullptr ? nullptr : fixed->as_array();
    const std::vector<std::string> words = words_of(find_key("region", "fixed")->choices);
    for (std::size_t i = 0; sides != nullptr && i < sides->size(); ++i) {
      const auto side = std::find(words.begin(), words.end(), (*sides)[i].as_string()->get()) - words.begin();
      region_.fixed[static_cast<std::size_t>(side)] = true;
    }
  }

  void check_numbers(const Section &section) {
    constexpr double most = 1e8;
    const auto expect_few = [&](double count, const std::string &who, const char *what, const char *hint) {
      if (count > most) {
        fault(section.source(), fmt::format("{} would have about {:.3g} {}", who, count, what),
              fmt::format("a set has at most {:g} in the bounding box of the region", most), hint);
      }
      return count <= most;
    };
    bool are_few = true;
    for (const JointSet &set : region_.joint_sets) {
      are_few &=
          expect_few(expected_traces(set, region_), set.name, "joints",
                     "use a larger spacing or longer traces, or look for a vertex with a wrong coordinate");
    }
    for (const VoronoiCells &cells : region_.voronoi) {
      are_few &= expect_few(expected_cells(cells, region_), "the Voronoi pattern", "cells",
                            "use a larger size, or look for a vertex with a wrong coordinate");
    }
    for (const BrickPattern &bricks : region_.bricks) {
      are_few &= expect_few(expected_bricks(bricks, region_), "the brick pattern", "bricks",
                            "use a larger block_size, or look for a vertex with a wrong coordinate");
    }
    if (!are_few) {
      return;
    }
    const double blocks = expected_blocks(region_);
    if (blocks > static_cast<double>(region_.max_blocks)) {
      fault(section.source(), fmt::format("the region would be cut into about {:.3g} blocks", blocks),
            fmt::format("max_blocks is {}", region_.max_blocks), "use larger spacings, or raise max_blocks");
    }
  }

  SceneSource source_;
  Materials *materials_;
  Fidelity of_run_;
  const JointLaws *joints_;
  std::string scene_file_;
  RockRegion region_;
};

} // namespace

RockRegion read_region(const SceneSource &source, Materials &materials, Fidelity of_run,
                       const JointLaws &joints, const std::string &scene_file) {
  return RegionReader(source, materials, of_run, joints, scene_file).read();
}

} // namespace gcpdda::scene_text
