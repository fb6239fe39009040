#include "driver/svg.hpp"

#include "geometry/plan_drawing.hpp"

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

std::string draw_mechanism(const SafetyReport &report) {
  double farthest = 0.0;
  for (const FailingBlock &block : report.mechanism) {
    farthest = std::max(farthest, block.motion);
  }
  const PlanDrawing page(region_of(report.mechanism), 1200.0, 2);
  const double outline = outline_of(page, report.mechanism.size());
  const auto colour = [](double share) {
    return fmt::format("hsl({:.0f},85%,{:.0f}%)", 50.0 - 50.0 * share, 97.0 - 45.0 * share);
  };
  std::string text = page.head();
  for (const FailingBlock &block : report.mechanism) {
    const double share = farthest > 0.0 ? block.motion / farthest : 0.0;
    text +=
        page.polygon(block.vertices, block.fixed ? std::string(fixed_colour) : colour(share), ink, outline);
  }
  const std::string words = fmt::format(
      "at factor {:.5g}: motion since the strengths were lowered; grey: fixed", report.fails.value_or(0.0));
  return text + page.axes() + page.colour_bar(0, farthest, "m", colour) +
         page.text_below(1, PlanDrawing::left, words) + PlanDrawing::end();
}

} // namespace gcpdda
