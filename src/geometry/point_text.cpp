#include "geometry/point_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace gcpdda {

std::string coordinate_text(double x, int digits) {
  constexpr int decimals = 3; // millimetres
  const bool has_them = std::abs(x) < std::pow(10.0, digits - decimals);
  if (has_them || !std::isfinite(x)) {
    return fmt::format("{:.{}g}", x, digits);
  }
  std::string text = fmt::format("{:.{}f}", x, decimals);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') {
    text.pop_back();
  }
  return text;
}

std::string point_text(Vec2 point, int digits) {
  return fmt::format("[{}, {}]", coordinate_text(point.x, digits), coordinate_text(point.y, digits));
}

} // namespace gcpdda
