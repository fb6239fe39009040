
#include "io/scene/scene_sides.hpp"

#include "geometry/aabb.hpp"
#include "geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda::scene_text {

namespace {

constexpr const char *law_name = "roller";

/// The number of [joint.roller], which is made of the default law where the scene has none.
std::int32_t roller_law(JointLaws &joints) {
  const auto known = std::find_if(joints.laws.begin(), joints.laws.end(),
                                  [](const JointLaw &law) { return law.name == law_name; });
  if (known != joints.laws.end()) {
    return static_cast<std::int32_t>(known - joints.laws.begin());
  }
  JointLaw law;
  law.name = law_name;
  law.normal_stiffness = joints.laws.front().normal_stiffness;
  law.allowed_overlap = joints.laws.front().allowed_overlap;
  law.tangential_ratio = joints.laws.front().tangential_ratio;
  joints.laws.push_back(law);
  return static_cast<std::int32_t>(joints.laws.size() - 1);
}

std::vector<Vec2> strip_along(Side side, const Aabb &box, double t) {
  Vec2 low{box.low.x - t, box.low.y - t};
  Vec2 high{box.high.x + t, box.high.y + t};
  switch (side) {
  case Side::bottom:
    high.y = box.low.y;
    break;
  case Side::top:
    low.y = box.high.y;
    break;
  case Side::left:
    high.x = box.low.x;
    break;
  case Side::right:
    low.x = box.high.x;
    break;
  }
  return {low, {high.x, low.y}, high, {low.x, high.y}};
}

/// A side that a list of [region] names.
struct NamedSide {
  Side side;
  std::string word;
  const toml::node *node;
};

std::vector<NamedSide> sides_in(const SceneSource &source, const Scene &scene, const char *key,
                                const char *table = "region") {
  std::vector<NamedSide> sides;
  if (!source.root.contains("region") || !scene.region.present()) {
    return sides;
  }
  const toml::node *given = section(source.root, table, source.faulty).sound(key);
  const std::vector<std::string> words = words_of(find_key(table, key)->choices);
  for (std::size_t i = 0; given != nullptr && i < given->as_array()->size(); ++i) {
    const toml::node &node = (*given->as_array())[i];
    const std::string &word = node.as_string()->get();
    sides.push_back(
        {static_cast<Side>(std::find(words.begin(), words.end(), word) - words.begin()), word, &node});
  }
  return sides;
}

bool is_fixed(const Scene &scene, const NamedSide &named) {
  return scene.region.fixed[static_cast<std::size_t>(named.side)];
}

Boundary boundary_along(Side side, const Aabb &box) {
  const double rounding = 1e-7 * norm(box.extent());
  switch (side) {
  case Side::bottom:
    return {{0.0, -1.0}, -box.low.y, rounding};
  case Side::top:
    return {{0.0, 1.0}, box.high.y, rounding};
  case Side::left:
    return {{-1.0, 0.0}, -box.low.x, rounding};
  case Side::right:
    break;
  }
  return {{1.0, 0.0}, box.high.x, rounding};
}

} // namespace

void add_rollers(const SceneSource &source, Scene &scene) {
  if (scene.joints.laws.empty()) {
    return;
  }
  for (const NamedSide &named : sides_in(source, scene, "roller")) {
    if (is_fixed(scene, named)) {
      source.faults.add(named.node->source(),
                        fmt::format("the {} side of [region] is fixed and a roller", named.word),
                        "a fixed side holds along itself too", "leave it out of 'fixed' or of 'roller'");
      continue;
    }
    SceneBlock block;
    block.name = fmt::format("{}.{}", law_name, named.word);
    block.material = scene.region.material;
    block.fixed = true;
    block.vertices =
        strip_along(named.side, bounding_box(scene.region.outline), scene.region.fixed_thickness);
    block.edge_joint.assign(block.vertices.size(), roller_law(scene.joints));
    block.where = source.faults.origins().position(named.node->source());
    scene.blocks.push_back(std::move(block));
  }
}

void read_stressed_sides(const SceneSource &source, Scene &scene) {
  const std::vector<NamedSide> rollers = sides_in(source, scene, "roller");
  for (const NamedSide &named : sides_in(source, scene, "stress")) {
    const bool is_roller = std::any_of(rollers.begin(), rollers.end(),
                                       [&](const NamedSide &roller) { return roller.side == named.side; });
    if (is_fixed(scene, named) || is_roller) {
      source.faults.add(named.node->source(),
                        fmt::format("the {} side of [region] is {} and under stress", named.word,
                                    is_roller ? "a roller" : "fixed"),
                        "what holds it bears whatever acts on it",
                        fmt::format("leave it out of '{}' or of 'stress'", is_roller ? "roller" : "fixed"));
    } else if (!source.root.contains("in_situ")) {
      source.faults.add(
          named.node->source(), fmt::format("no stress acts on the {} side of [region]", named.word),
          "the one of [in_situ] does, which is missing", "for example [in_situ] with level = 100.0");
    } else {
      scene.in_situ.boundaries.push_back(boundary_along(named.side, bounding_box(scene.region.outline)));
    }
  }
}

// C is linear along a side and its least principal value concave in it: the least one is at an end.
void check_changed_stress(const SceneSource &source, const toml::source_region &where, const Scene &scene,
                          const InSituStress &before) {
  const InSituStress &stress = scene.in_situ;
  if (stress.boundaries.empty() && before.boundaries.empty()) {
    source.faults.add(
        where, "the change of stress acts on nothing",
        "it acts on the sides of [region] that are under stress, and blocks follow by equilibrium",
        "name sides in region.stress, for example stress = [\"top\"]");
    return;
  }
  const Aabb box = bounding_box(scene.region.outline);
  for (const Boundary &side : stress.boundaries) {
    for (const Vec2 corner : {box.low, Vec2{box.high.x, box.low.y}, box.high, Vec2{box.low.x, box.high.y}}) {
      const PrincipalValues values = principal_values(stress.compression_at(corner));
      constexpr double rounding = 1e-9;
      if (side.holds(corner) && values.least < -rounding * std::abs(values.largest)) {
        source.faults.add(where,
                          fmt::format("the stress would pull at [{}, {}] with {:.3g} Pa", corner.x, corner.y,
                                      -values.least),
                          "a side of [region] under stress is only pushed",
                          "raise in_situ.level or in_situ.vertical_stress");
        return;
      }
    }
  }
}

void read_viscous_sides(const SceneSource &source, Scene &scene) {
  Earthquake &earthquake = scene.earthquake;
  const std::vector<NamedSide> rollers = sides_in(source, scene, "roller");
  for (const NamedSide &named : sides_in(source, scene, "viscous", "earthquake")) {
    const bool is_roller = std::any_of(rollers.begin(), rollers.end(),
                                       [&](const NamedSide &roller) { return roller.side == named.side; });
    if (earthquake.stage <= 0 && (is_fixed(scene, named) || is_roller)) {
      source.faults.add(named.node->source(),
                        fmt::format("the {} side of [region] is {} and viscous from the start", named.word,
                                    is_roller ? "a roller" : "fixed"),
                        "what holds it lets no wave out, and 'stage' names no stage that would take it away",
                        "name a later stage as 'stage' of [earthquake]");
    }
    const Boundary boundary = boundary_along(named.side, bounding_box(scene.region.outline));
    const bool is_bottom = named.side == Side::bottom; // where the wave comes in: the first one
    earthquake.is_compliant = earthquake.is_compliant || is_bottom;
    earthquake.viscous.insert(is_bottom ? earthquake.viscous.begin() : earthquake.viscous.end(), boundary);
  }
}

} // namespace gcpdda::scene_text
