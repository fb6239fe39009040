#include "driver/svg.hpp"

#include "geometry/plan_drawing.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <map>
#include <utility>

namespace gcpdda {

namespace {

constexpr const char *fixed_colour = "#9a9a9a";

/// Colours far apart for neighbouring numbers: golden angle around the colour circle.
std::string colour_of(int subdomain) {
  return subdomain < 0 ? fixed_colour
                       : fmt::format("hsl({:.0f},60%,72%)", std::fmod(137.508 * subdomain, 360.0));
}

constexpr const char *ink = "#333";

/// Size of a block if all are equal, in pixels.
double size_of_block(const PlanDrawing &page, std::size_t num_blocks) {
  const Vec2 extent = page.region().extent();
  return page.scale() * std::sqrt(extent.x * extent.y / static_cast<double>(num_blocks));
}

/// Width of outlines that leave the colours of so many blocks to be seen, in pixels.
double outline_of(const PlanDrawing &page, std::size_t num_blocks) {
  return std::min(0.5, 0.03 * size_of_block(page, num_blocks));
}

constexpr double longest_arrow = 48.0; // pixels

/// From the middle of a block in the direction of its motion, the longest for the farthest.
std::string arrow(const PlanDrawing &page, const FailingBlock &block, double farthest) {
  constexpr double head = 7.0; // pixels
  constexpr double width = 1.6;
  const Vec2 middle = polygon_moments(block.vertices).centroid;
  const double way = norm(block.displacement);
  if (way == 0.0) {
    return {};
  }
  const Vec2 along{block.displacement.x / way, -block.displacement.y / way}; // y goes down the page
  const Vec2 from{page.x(middle.x), page.y(middle.y)};
  const Vec2 to = from + (longest_arrow * std::min(1.0, way / farthest)) * along;
  std::string text = svg_line(from.x, from.y, to.x, to.y, ink, width);
  for (const double side : {-1.0, 1.0}) {
    const Vec2 back = to - head * along + (0.5 * side * head) * perp(along);
    text += svg_line(to.x, to.y, back.x, back.y, ink, width);
  }
  return text;
}

/// Arrows of blocks that move, in each cell of the size of the longest one that of the block that has moved
/// farthest, so that they do not cover each other.
std::string arrows(const PlanDrawing &page, const std::vector<FailingBlock> &blocks, double farthest) {
  std::map<std::pair<std::int64_t, std::int64_t>, const FailingBlock *> of_cell;
  for (const FailingBlock &block : blocks) {
    if (block.moves && !block.left_out) {
      const Vec2 middle = polygon_moments(block.vertices).centroid;
      const FailingBlock *&shown = of_cell[{static_cast<std::int64_t>(page.x(middle.x) / longest_arrow),
                                            static_cast<std::int64_t>(page.y(middle.y) / longest_arrow)}];
      shown = shown != nullptr && shown->motion >= block.motion ? shown : &block;
    }
  }
  std::string text;
  for (const auto &[cell, block] : of_cell) {
    text += arrow(page, *block, farthest);
  }
  return text;
}

constexpr const char *slip_colour = "#7a0fa8";
constexpr const char *open_colour = "#0f8bd0";
constexpr double joint_width = 3.0; // pixels

/// One element a line; what is too short to be seen becomes a dot.
std::string joint_lines(const PlanDrawing &page, const std::vector<FailingJoints::Line> &lines,
                        const char *colour, double width) {
  std::string text;
  for (const auto &[begin, end] : lines) {
    Vec2 from{page.x(begin.x), page.y(begin.y)};
    Vec2 to{page.x(end.x), page.y(end.y)};
    if (norm(to - from) < width) {
      const Vec2 middle = 0.5 * (from + to);
      from = middle - Vec2{0.5 * width, 0.0};
      to = middle + Vec2{0.5 * width, 0.0};
    }
    text += svg_line(from.x, from.y, to.x, to.y, colour, width);
  }
  return text;
}

/// A sample of each kind of line with its meaning, in a line below the axes.
std::string legend_of_joints(const PlanDrawing &page, int line, const FailingJoints &joints) {
  std::string text = page.sample_below(line, page.left(), slip_colour, joint_width) +
                     page.text_below(line, page.left() + 44.0, "joint that slips");
  const double second = page.left() + 210.0;
  return text + (joints.knows_opened
                     ? page.sample_below(line, second, open_colour, joint_width) +
                           page.text_below(line, second + 44.0, "joint that has opened")
                     : page.text_below(line, second, "(opened ones: with output.contacts = true)"));
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
      0, page.left(),
      fmt::format("{} blocks, {} subdomain{}, {:.4g} m x {:.4g} m; grey: fixed; thick outline: deformable",
                  blocks.size(), num_subdomains, num_subdomains == 1 ? "" : "s", extent.x, extent.y));
  return text + PlanDrawing::end();
}

double farthest_motion(const std::vector<FailingBlock> &blocks) {
  double farthest = 0.0;
  for (const FailingBlock &block : blocks) {
    farthest = std::max(farthest, block.left_out ? 0.0 : block.motion);
  }
  return farthest;
}

std::string draw_mechanism(const std::vector<FailingBlock> &blocks, const FailingJoints &joints,
                           double factor) {
  const double farthest = farthest_motion(blocks);
  const PlanDrawing page(region_of(blocks), 1200.0, 3);
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
  const double width = std::min(joint_width, std::max(1.0, 0.1 * size_of_block(page, blocks.size())));
  text += joint_lines(page, joints.opened, open_colour, width) +
          joint_lines(page, joints.slipping, slip_colour, width) + arrows(page, blocks, farthest);
  const std::string words =
      fmt::format("at factor {:.5g}: motion since the strengths were lowered; grey: fixed", factor);
  return text + page.axes() + page.colour_bar(0, farthest, "motion (m)", colour) +
         legend_of_joints(page, 1, joints) + page.text_below(2, page.left(), words) + PlanDrawing::end();
}

} // namespace gcpdda
