#include "geometry/plan_drawing.hpp"

#include "base/round_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gcpdda {

namespace {

constexpr const char *ink = "#333333";
constexpr double letters = 18.0; // height, pixels
constexpr double digit = 11.5;   // width of the widest usual font, pixels
constexpr double tick = 6.0;
constexpr double gap_at_axis = 2.0 * tick + 6.0; // between a number and the plane, and before the number
constexpr double ticks_of_longest_side = 8.0;

} // namespace

std::string svg_line(double x0, double y0, double x1, double y1, const std::string &stroke, double width) {
  return fmt::format("<path stroke=\"{}\" stroke-width=\"{:.2g}\" d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\"/>\n",
                     stroke, width, x0, y0, x1, y1);
}

std::string svg_text(double x, double y, const std::string &anchor, double size, const std::string &words,
                     const std::string &colour) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" font-family=\"sans-serif\" "
                     "font-size=\"{:g}\" fill=\"{}\">{}</text>\n",
                     x, y, anchor, size, colour, words);
}

PlanDrawing::PlanDrawing(const Aabb &region, double longest_side, int lines_below)
    : region_(region), scale_(longest_side / std::max(region.extent().x, region.extent().y)),
      lines_below_(lines_below) {
  for (const auto &[value, text] : ticks_of(region_.low.y, region_.high.y)) {
    left_ = std::max(left_, gap_at_axis + digit * static_cast<double>(text.size()));
  }
  for (const auto &[value, text] : ticks_of(region_.low.x, region_.high.x)) {
    right_ = std::max(right_, 0.5 * digit * static_cast<double>(text.size()));
  }
}

std::vector<std::pair<double, std::string>> PlanDrawing::ticks_of(double low, double high) const {
  const double longest = std::max(region_.extent().x, region_.extent().y);
  const double about = ticks_of_longest_side * (high - low) / longest;
  const std::vector<double> values =
      round_ticks(low, high, std::max(2, static_cast<int>(std::lround(about))));
  const double step = values.size() > 1 ? values[1] - values[0] : 1.0;
  std::vector<std::pair<double, std::string>> ticks;
  for (const double value : values) {
    ticks.emplace_back(value, tick_text(value, step));
  }
  return ticks;
}

std::string PlanDrawing::head() const {
  return fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\">\n"
                     "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                     x(region_.high.x) + right_, y(region_.low.y) + below + line_height * lines_below_);
}

std::string PlanDrawing::polygon(std::span<const Vec2> vertices, const std::string &fill,
                                 const std::string &stroke, double stroke_width) const {
  std::string text = fmt::format("<polygon fill=\"{}\" stroke=\"{}\" stroke-width=\"{:.2g}\" points=\"", fill,
                                 stroke, stroke_width);
  for (const Vec2 p : vertices) {
    text += fmt::format("{:.2f},{:.2f} ", x(p.x), y(p.y));
  }
  return text + "\"/>\n";
}

std::string PlanDrawing::axes() const {
  const double base = y(region_.low.y) + tick;
  const double side = x(region_.low.x) - tick;
  std::string text = svg_line(side, base, x(region_.high.x), base, ink, 1.5);
  text += svg_line(side, y(region_.high.y), side, base, ink, 1.5);
  for (const auto &[value, words] : ticks_of(region_.low.x, region_.high.x)) {
    text += svg_line(x(value), base, x(value), base + tick, ink, 1.5);
    text += svg_text(x(value), base + tick + letters, "middle", letters, words);
  }
  for (const auto &[value, words] : ticks_of(region_.low.y, region_.high.y)) {
    text += svg_line(side - tick, y(value), side, y(value), ink, 1.5);
    text += svg_text(side - tick - 4.0, y(value) + 0.35 * letters, "end", letters, words);
  }
  text += svg_text(0.5 * (x(region_.low.x) + x(region_.high.x)), base + tick + 2.2 * letters, "middle",
                   letters, "x (m)");
  return text + svg_text(side, y(region_.high.y) - 0.7 * letters, "middle", letters, "y (m)");
}

double PlanDrawing::line_at(int line) const {
  return y(region_.low.y) + below + line_height * (line + 0.6);
}

std::string PlanDrawing::text_below(int line, double at, const std::string &words,
                                    const std::string &colour) const {
  return svg_text(at, line_at(line), "start", letters, words, colour);
}

std::string PlanDrawing::sample_below(int line, double at, const std::string &colour, double width) const {
  constexpr double length = 32.0; // pixels
  const double height = line_at(line) - 0.35 * letters;
  return svg_line(at, height, at + length, height, colour, width);
}

std::pair<double, double> PlanDrawing::bar_ends() const {
  constexpr double longest = 480.0;
  const double begin = x(region_.low.x);
  return {begin, begin + std::min(longest, 0.6 * (x(region_.high.x) - begin))};
}

std::string PlanDrawing::bar_cell(int line, int k, const std::string &colour) const {
  const auto [begin, end] = bar_ends();
  const double width = (end - begin) / bar_cells;
  const double upper = line_at(line) - 1.5 * letters;
  // Cells overlap by a pixel, so that no seam is seen between them.
  return fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\"/>\n",
                     begin + k * width, upper, k + 1 < bar_cells ? width + 1.0 : width, 0.7 * letters,
                     colour);
}

std::string PlanDrawing::bar_ticks(int line, double most, const std::string &unit) const {
  const auto [begin, end] = bar_ends();
  const double base = line_at(line) - 0.8 * letters;
  std::string text = svg_line(begin, base, end, base, ink, 1.0);
  const std::vector<double> ticks = round_ticks(0.0, most, 4);
  const double step = ticks.size() > 1 ? ticks[1] - ticks[0] : 1.0;
  for (const double value : ticks) {
    const double at = begin + (end - begin) * (most > 0.0 ? value / most : 0.0);
    text += svg_line(at, base, at, base + tick, ink, 1.0);
    text += svg_text(at, base + tick + letters, "middle", letters, tick_text(value, step));
  }
  return text + svg_text(end + 2.0 * letters, line_at(line) - 0.7 * letters, "start", letters, unit);
}

} // namespace gcpdda
