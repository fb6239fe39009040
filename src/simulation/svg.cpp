#include "svg.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace gcpdda {

namespace {

/// Colours far apart for neighbouring numbers: golden angle around the colour circle.
std::string colour_of(int subdomain) {
  return subdomain < 0 ? "#9a9a9a"
                       : fmt::format("hsl({:.0f},60%,72%)", std::fmod(137.508 * subdomain, 360.0));
}

} // namespace

std::string draw_svg(const std::vector<DrawnBlock> &blocks, int num_subdomains) {
  Aabb region;
  for (const DrawnBlock &block : blocks) {
    region.include(bounding_box(block.vertices));
  }
  constexpr double longest_side = 1600.0; // pixels
  constexpr double margin = 20.0;
  constexpr double legend = 24.0;
  const Vec2 extent = region.extent();
  const double scale = longest_side / std::max(extent.x, extent.y);
  std::string text =
      fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\">\n"
                  "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                  scale * extent.x + 2.0 * margin, scale * extent.y + 2.0 * margin + legend);
  for (const DrawnBlock &block : blocks) {
    text += fmt::format("<polygon fill=\"{}\" stroke=\"#333\" stroke-width=\"{}\" points=\"",
                        colour_of(block.subdomain), block.deformable ? 1.5 : 0.5);
    for (const Vec2 p : block.vertices) {
      text += fmt::format("{:.2f},{:.2f} ", margin + scale * (p.x - region.low.x),
                          margin + scale * (region.high.y - p.y));
    }
    text += "\"/>\n";
  }
  text += fmt::format(
      "<text x=\"{0:.0f}\" y=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"14\">{2} blocks, {3} "
      "subdomain{4}, {5:.4g} m x {6:.4g} m; grey: fixed; thick outline: deformable</text>\n</svg>\n",
      margin, scale * extent.y + 2.0 * margin + 0.5 * legend, blocks.size(), num_subdomains,
      num_subdomains == 1 ? "" : "s", extent.x, extent.y);
  return text;
}

} // namespace gcpdda
