#include "blockgen/drawing.hpp"

#include "geometry/aabb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace gcpdda {

namespace {

constexpr double longest_side = 1600.0; // pixels
constexpr double margin = 20.0;
constexpr double line_of_text = 20.0;

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

} // namespace

RegionDrawing::RegionDrawing(const Scene &scene) : scene_(&scene) {
  Aabb box = bounding_box(scene.region.outline);
  const auto &fixed = scene.region.fixed;
  if (std::find(fixed.begin(), fixed.end(), true) != fixed.end()) {
    box = box.inflated(scene.region.fixed_thickness);
  }
  low_ = box.low;
  high_ = box.high;
  scale_ = longest_side / std::max(box.extent().x, box.extent().y);
}

double RegionDrawing::x(double world) const {
  return margin + scale_ * (world - low_.x);
}

double RegionDrawing::y(double world) const {
  return margin + scale_ * (high_.y - world);
}

std::string RegionDrawing::head() const {
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\">\n"
                     "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                     2.0 * margin + scale_ * (high_.x - low_.x),
                     3.0 * margin + scale_ * (high_.y - low_.y) + line_of_text);
}

std::string RegionDrawing::blocks(std::span<const SceneBlock> blocks) const {
  std::string text;
  for (const SceneBlock &block : blocks) {
    text +=
        fmt::format("<polygon fill=\"{}\" stroke=\"#555555\" stroke-width=\"0.5\" points=\"", fill_of(block));
    for (const Vec2 p : block.vertices) {
      text += fmt::format("{:.2f},{:.2f} ", x(p.x), y(p.y));
    }
    text += "\"/>\n";
    for (std::size_t k = 0; k < block.edge_joint.size(); ++k) {
      const Vec2 from = block.vertices[k];
      const Vec2 to = block.vertices[(k + 1) % block.vertices.size()];
      if (block.edge_joint[k] >= 0) {
        text += fmt::format("<path stroke=\"{}\" stroke-width=\"1\" d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\"/>\n",
                            colour_of_joint(block.edge_joint[k]), x(from.x), y(from.y), x(to.x), y(to.y));
      }
    }
  }
  return text;
}

std::string RegionDrawing::end(std::span<const PoorBlock> sharpest,
                               std::span<const PoorBlock> narrowest) const {
  std::string text;
  const auto mark = [&](const PoorBlock &block, const std::string &what) {
    text += fmt::format("<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"7\" fill=\"none\" stroke=\"#d00000\" "
                        "stroke-width=\"2\"/>\n<text x=\"{2:.1f}\" y=\"{1:.1f}\" font-family=\"sans-serif\" "
                        "font-size=\"13\" fill=\"#d00000\">b{3}: {4}</text>\n",
                        x(block.centroid.x), y(block.centroid.y), x(block.centroid.x) + 10.0, block.id, what);
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
  double at = margin;
  const double line = y(low_.y) + 2.0 * margin;
  for (std::size_t k = 0; k < scene_->joints.laws.size(); ++k) {
    const std::string &name = scene_->joints.laws[k].name;
    text += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" font-family=\"sans-serif\" font-size=\"14\" "
                        "fill=\"{}\">{}</text>\n",
                        at, line, colour_of_joint(static_cast<std::int32_t>(k)), name);
    constexpr double letter = 9.0;
    at += letter * static_cast<double>(name.size()) + margin;
  }
  return text + "</svg>\n";
}

} // namespace gcpdda
