#pragma once

// A picture (SVG) of a part of the plane: polygons and lines at one scale, axes with ticks in metres, text
// below.

#include "geometry/aabb.hpp"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gcpdda {

/// Where points of the plane are on a page with axes, and the elements of that page. The page has room for
/// `lines_below` lines of text below its axes. Elements are strings, so that several ranks can draw parts of
/// one picture: head, elements, axes, end.
class PlanDrawing {
public:
  PlanDrawing(const Aabb &region, double longest_side, int lines_below);

  [[nodiscard]] double x(double world) const { return left_ + scale_ * (world - region_.low.x); }
  [[nodiscard]] double y(double world) const { return top + scale_ * (region_.high.y - world); }
  [[nodiscard]] double left() const { return left_; }   ///< where axes and lines of text begin, pixels
  [[nodiscard]] double scale() const { return scale_; } ///< pixels per metre
  [[nodiscard]] const Aabb &region() const { return region_; }

  [[nodiscard]] std::string head() const;
  [[nodiscard]] std::string polygon(std::span<const Vec2> vertices, const std::string &fill,
                                    const std::string &stroke, double stroke_width) const;
  /// Lines along the lower and left side with ticks at round numbers, and the words x (m) and y (m).
  [[nodiscard]] std::string axes() const;
  /// Text in a line below the axes, the first of which is 0, from a place in pixels on.
  [[nodiscard]] std::string text_below(int line, double at, const std::string &words,
                                       const std::string &colour = "black") const;
  /// A short line that stands for all lines of its colour, before text in a line below the axes.
  [[nodiscard]] std::string sample_below(int line, double at, const std::string &colour, double width) const;
  /// A bar from `colour(0)` to `colour(1)` in a line below the axes, with ticks from 0 to `most`.
  template <class Colour>
  [[nodiscard]] std::string colour_bar(int line, double most, const std::string &unit,
                                       Colour &&colour) const {
    std::string text;
    for (int k = 0; k < bar_cells; ++k) {
      text += bar_cell(line, k, colour((k + 0.5) / bar_cells));
    }
    return text + bar_ticks(line, most, unit);
  }
  [[nodiscard]] static std::string end() { return "</svg>\n"; }

private:
  static constexpr double top = 34.0;
  static constexpr double below = 62.0; // numbers and name of the axis
  static constexpr double line_height = 34.0;
  static constexpr int bar_cells = 40;

  /// Values and texts of the ticks from `low` to `high`.
  [[nodiscard]] std::vector<std::pair<double, std::string>> ticks_of(double low, double high) const;
  [[nodiscard]] std::string bar_cell(int line, int k, const std::string &colour) const;
  [[nodiscard]] std::string bar_ticks(int line, double most, const std::string &unit) const;
  [[nodiscard]] std::pair<double, double> bar_ends() const; ///< pixels
  [[nodiscard]] double line_at(int line) const;             ///< its base line, pixels

  Aabb region_;
  double scale_;
  int lines_below_;
  double left_ = 76.0;  ///< pixels: room for the numbers of the axis
  double right_ = 32.0; ///< half of a number may stand out
};

/// A line of a picture between two places in pixels.
std::string svg_line(double x0, double y0, double x1, double y1, const std::string &stroke, double width);

/// Text of a picture; `anchor` is start, middle or end.
std::string svg_text(double x, double y, const std::string &anchor, double size, const std::string &words,
                     const std::string &colour = "black");

} // namespace gcpdda
