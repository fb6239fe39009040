#include "blockgen/drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda {

namespace {

constexpr double longest_side = 1600.0; // pixels

std::string fill_of(const SceneBlock &block) {
  if (block.fixed) {
    return "#9a9a9a";
  }
  constexpr std::array<const char *, 6> rocks{"#efe3cf", "#d5dfe8", "#dfe8d0",
                                              "#ead5d5", "#e2d9ec", "#e8e8d0"};
  constexpr std::array<const char *, 6> in_opening{"#d8bf8e", "#a3bacf", "#b9cf97",
                                                   "#d19c9c", "#bda6d6", "#cfcf95"};
  return (block.opening >= 0 ? in_opening : rocks)[static_cast<std::size_t>(block.material) % rocks.size()];
}

/// Far apart for neighbouring numbers: golden angle around the colour circle.
std::string colour_of_joint(std::int32_t joint) {
  return joint < 0 ? "#555555"
                   : fmt::format("hsl({:.0f},75%,38%)", std::fmod(210.0 + 137.508 * joint, 360.0));
}

/// The region with what is fixed along its sides.
Aabb drawn_part(const Scene &scene) {
  const Aabb box = bounding_box(scene.region.outline);
  const auto &fixed = scene.region.fixed;
  const bool any_fixed = std::find(fixed.begin(), fixed.end(), true) != fixed.end();
  return any_fixed ? box.inflated(scene.region.fixed_thickness) : box;
}

} // namespace

RegionDrawing::RegionDrawing(const Scene &scene)
    : scene_(&scene), page_(drawn_part(scene), longest_side, 1) {}

std::string RegionDrawing::head() const {
  return page_.head();
}

std::string RegionDrawing::blocks(std::span<const SceneBlock> blocks) const {
  std::string text;
  for (const SceneBlock &block : blocks) {
    text += page_.polygon(block.vertices, fill_of(block), "#555555", 0.5);
    for (std::size_t k = 0; k < block.edge_joint.size(); ++k) {
      const Vec2 from = block.vertices[k];
      const Vec2 to = block.vertices[(k + 1) % block.vertices.size()];
      if (block.edge_joint[k] >= 0) {
        text += svg_line(page_.x(from.x), page_.y(from.y), page_.x(to.x), page_.y(to.y),
                         colour_of_joint(block.edge_joint[k]), 1.0);
      }
    }
  }
  return text;
}

std::string RegionDrawing::end(std::span<const PoorBlock> sharpest,
                               std::span<const PoorBlock> narrowest) const {
  std::string text;
  const auto mark = [&](const PoorBlock &block, const std::string &what) {
    const double x = page_.x(block.centroid.x);
    const double y = page_.y(block.centroid.y);
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"7\" fill=\"none\" stroke=\"#d00000\" "
                        "stroke-width=\"2\"/>\n",
                        x, y);
    text += svg_text(x + 10.0, y, "start", 14.0, fmt::format("b{}: {}", block.id, what), "#d00000");
  };
  for (const PoorBlock &block : sharpest) {
    if (block.value < BlockQuality::needle_angle) {
      mark(block, fmt::format("{:.1f} deg", block.value));
    }
  }
  for (const PoorBlock &block : narrowest) {
    if (block.value < BlockQuality::sliver_ratio) {
      mark(block, fmt::format("width {:.2g} of size", block.value));
    }
  }
  text += page_.axes();
  double at = page_.left();
  for (std::size_t k = 0; k < scene_->joints.laws.size(); ++k) {
    const std::string &name = scene_->joints.laws[k].name;
    text += page_.text_below(0, at, name, colour_of_joint(static_cast<std::int32_t>(k)));
    constexpr double letter = 11.0;
    constexpr double gap = 20.0;
    at += letter * static_cast<double>(name.size()) + gap;
  }
  return text + PlanDrawing::end();
}

} // namespace gcpdda
