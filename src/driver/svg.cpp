#include "driver/svg.hpp"

#include "geometry/aabb.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <span>

namespace gcpdda {

namespace {

constexpr const char *fixed_colour = "#9a9a9a";

/// Colours far apart for neighbouring numbers: golden angle around the colour circle.
std::string colour_of(int subdomain) {
  return subdomain < 0 ? fixed_colour
                       : fmt::format("hsl({:.0f},60%,72%)", std::fmod(137.508 * subdomain, 360.0));
}

/// Polygons of the world on a page with a line of text below.
class Page {
public:
  Page(const Aabb &region, double longest_side)
      : region_(region), extent_(region.extent()), scale_(longest_side / std::max(extent_.x, extent_.y)),
        text_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\">\n"
                          "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                          scale_ * extent_.x + 2.0 * margin, scale_ * extent_.y + 2.0 * margin + legend)) {}

  void add(std::span<const Vec2> vertices, const std::string &fill, double outline) {
    text_ +=
        fmt::format("<polygon fill=\"{}\" stroke=\"#333\" stroke-width=\"{:.2g}\" points=\"", fill, outline);
    for (const Vec2 p : vertices) {
      text_ += fmt::format("{:.2f},{:.2f} ", margin + scale_ * (p.x - region_.low.x),
                           margin + scale_ * (region_.high.y - p.y));
    }
    text_ += "\"/>\n";
  }

  /// Width of outlines that leave the colours of so many blocks to be seen, in pixels.
  [[nodiscard]] double outline(std::size_t num_blocks) const {
    const double of_block = scale_ * std::sqrt(extent_.x * extent_.y / static_cast<double>(num_blocks));
    return std::min(0.5, 0.03 * of_block);
  }

  [[nodiscard]] std::string with(const std::string &line) const {
    return text_ +
           fmt::format(
               "<text x=\"{:.0f}\" y=\"{:.0f}\" font-family=\"sans-serif\" font-size=\"14\">{}</text>\n"
               "</svg>\n",
               margin, scale_ * extent_.y + 2.0 * margin + 0.5 * legend, line);
  }

private:
  static constexpr double margin = 20.0; // pixels
  static constexpr double legend = 24.0;
  Aabb region_;
  Vec2 extent_;
  double scale_;
  std::string text_;
};

template <class Block> Aabb region_of(const std::vector<Block> &blocks) {
  Aabb region;
  for (const Block &block : blocks) {
    region.include(bounding_box(block.vertices));
  }
  return region;
}

} // namespace

std::string draw_svg(const std::vector<DrawnBlock> &blocks, int num_subdomains) {
  const Aabb region = region_of(blocks);
  Page page(region, 1600.0);
  const double outline = page.outline(blocks.size());
  for (const DrawnBlock &block : blocks) {
    page.add(block.vertices, colour_of(block.subdomain), (block.deformable ? 3.0 : 1.0) * outline);
  }
  return page.with(fmt::format(
      "{} blocks, {} subdomain{}, {:.4g} m x {:.4g} m; grey: fixed; thick outline: deformable", blocks.size(),
      num_subdomains, num_subdomains == 1 ? "" : "s", region.extent().x, region.extent().y));
}

std::string draw_mechanism(const SafetyReport &report) {
  double farthest = 0.0;
  for (const FailingBlock &block : report.mechanism) {
    farthest = std::max(farthest, block.motion);
  }
  Page page(region_of(report.mechanism), 1200.0);
  const double outline = page.outline(report.mechanism.size());
  for (const FailingBlock &block : report.mechanism) {
    const double share = farthest > 0.0 ? block.motion / farthest : 0.0;
    page.add(block.vertices,
             block.fixed ? std::string(fixed_colour)
                         : fmt::format("hsl({:.0f},85%,{:.0f}%)", 50.0 - 50.0 * share, 97.0 - 45.0 * share),
             outline);
  }
  return page.with(fmt::format("at factor {:.5g}; colour: motion since the strengths were lowered, white 0 "
                               "to red {:.3g} m; grey: fixed",
                               report.fails.value_or(0.0), farthest));
}

} // namespace gcpdda
