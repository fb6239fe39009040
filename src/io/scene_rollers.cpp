// Sides of the region that blocks may slide along but not move through or away sideways: rollers.
//
// A fixed block lies along such a side, as along a fixed one, and its edges have a law without friction and
// cohesion, which is the weaker one of any two: the side pushes along its normal and lets go along itself.
// Like every contact it only pushes, and yields by its normal stiffness, which is that of the default law.

#include "scene_parts.hpp"

#include "gcpdda/geometry/aabb.hpp"
#include "gcpdda/geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

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

} // namespace

void add_rollers(const SceneSource &source, Scene &scene) {
  if (!source.root.contains("region") || scene.joints.laws.empty()) {
    return;
  }
  const Section region = section(source.root, "region", source.faulty);
  const toml::node *given = region.sound("roller");
  if (given == nullptr || !scene.region.present()) {
    return;
  }
  const std::vector<std::string> words = words_of(find_key("region", "roller")->choices);
  const Aabb box = bounding_box(scene.region.outline);
  for (const toml::node &entry : *given->as_array()) {
    const std::string &word = entry.as_string()->get();
    const auto side = static_cast<std::size_t>(std::find(words.begin(), words.end(), word) - words.begin());
    if (scene.region.fixed[side]) {
      source.faults.add(entry.source(), fmt::format("the {} side of [region] is fixed and a roller", word),
                        "a fixed side holds along itself too", "leave it out of 'fixed' or of 'roller'");
      continue;
    }
    SceneBlock block;
    block.name = fmt::format("{}.{}", law_name, word);
    block.material = scene.region.material;
    block.fixed = true;
    block.vertices = strip_along(static_cast<Side>(side), box, scene.region.fixed_thickness);
    block.edge_joint.assign(block.vertices.size(), roller_law(scene.joints));
    block.where = source.faults.origins().position(entry.source());
    scene.blocks.push_back(std::move(block));
  }
}

} // namespace gcpdda::scene_text
