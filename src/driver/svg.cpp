#include "driver/svg.hpp"

#include "geometry/plan_drawing.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace gcpdda {

namespace {

constexpr const char *fixed_colour = "#9a9a9a";

/// Colours far apart for neighbouring numbers: golden angle around the colour circle.
std::string colour_of(int subdomain) {
  return subdomain < 0 ? fixed_colour
                       : fmt::format("hsl({:.0f},60%,72%)", std::fmod(137.508 * subdomain, 360.0));
}

constexpr const char *ink = "#333";

/// Width of outlines that leave the colours of so many blocks to be seen, in pixels.
double outline_of(const PlanDrawing &page, std::size_t num_blocks) {
  const Vec2 extent = page.region().extent();
  const double of_block = page.scale() * std::sqrt(extent.x * extent.y / static_cast<double>(num_blocks));
  return std::min(0.5, 0.03 * of_block);
}

/// From the middle of a block in the direction of its motion, `longest` for the farthest.
std::string arrow(const PlanDrawing &page, const FailingBlock &block, double farthest) {
  constexpr double longest = 48.0; // pixels
  constexpr double head = 7.0;
  constexpr double width = 1.6;
  const Vec2 middle = polygon_moments(block.vertices).centroid;
  const double way = norm(block.displacement);
  if (way == 0.0) {
    return {};
  }
  const Vec2 along{block.displacement.x / way, -block.displacement.y / way}; // y goes down the page
  const Vec2 from{page.x(middle.x), page.y(middle.y)};
  const Vec2 to = from + (longest * std::min(1.0, way / farthest)) * along;
  std::string text = svg_line(from.x, from.y, to.x, to.y, ink, width);
  for (const double side : {-1.0, 1.0}) {
    const Vec2 back = to - head * along + (0.5 * side * head) * perp(along);
    text += svg_line(to.x, to.y, back.x, back.y, ink, width);
  }
  return text;
}

template <class Block> Aabb region_of(const std::vector<Block> &blocks) {
  Aabb region;
  for (const Block &block : blocks) {
    region.include(bounding_box(block.vertices));
  }
  return region;
}

} // namespace

std::string draw_svg(const std::vector<DrawnBlock> &blocks, int num_subdomains) {
  const PlanDrawing page(region_of(blocks), 1600.0, 1);
  const double outline = outline_of(page, blocks.size());
  std::string text = page.head();
  for (const DrawnBlock &block : blocks) {
    text += page.polygon(block.vertices, colour_of(block.subdomain), ink,
                         (block.deformable ? 3.0 : 1.0) * outline);
  }
  const Vec2 extent = page.region().extent();
  text += page.axes();
  text += page.text_below(
      0, PlanDrawing::left,
      fmt::format("{} blocks, {} subdomain{}, {:.4g} m x {:.4g} m; grey: fixed; thick outline: deformable",
                  blocks.size(), num_subdomains, num_subdomains == 1 ? "" : "s", extent.x, extent.y));
  return text + PlanDrawing::end();
}

std::string draw_mechanism(const std::vector<FailingBlock> &blocks, double factor) {
  double farthest = 0.0;
  for (const FailingBlock &block : blocks) {
    farthest = std::max(farthest, block.left_out ? 0.0 : block.motion);
  }
  const PlanDrawing page(region_of(blocks), 1200.0, 2);
  const double outline = outline_of(page, blocks.size());
  const auto colour = [](double share) {
    return fmt::format("hsl({:.0f},85%,{:.0f}%)", 50.0 - 50.0 * share, 97.0 - 45.0 * share);
  };
  std::string text = page.head();
  for (const FailingBlock &block : blocks) {
    const double share = farthest > 0.0 ? std::min(1.0, block.motion / farthest) : 0.0;
    text +=
        page.polygon(block.vertices, block.fixed ? std::string(fixed_colour) : colour(share), ink, outline);
  }
  for (const FailingBlock &block : blocks) {
    if (block.moves && !block.left_out) {
      text += arrow(page, block, farthest);
    }
  }
  const std::string words =
      fmt::format("at factor {:.5g}: motion since the strengths were lowered; grey: fixed", factor);
  return text + page.axes() + page.colour_bar(0, farthest, "m", colour) +
         page.text_below(1, PlanDrawing::left, words) + PlanDrawing::end();
}

} // namespace gcpdda
