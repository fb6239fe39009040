#include "gcpdda/model/water.hpp"

#include <algorithm>

namespace gcpdda {

double Water::head(double x) const {
  if (x <= phreatic.front().x) {
    return phreatic.front().y;
  }
  if (x >= phreatic.back().x) {
    return phreatic.back().y;
  }
  const auto right =
      std::upper_bound(phreatic.begin(), phreatic.end(), x, [](double a, Vec2 b) { return a < b.x; });
  const Vec2 a = *(right - 1);
  const Vec2 b = *right;
  return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
}

bool Water::wets(std::int32_t law) const {
  return joints.empty() || std::binary_search(joints.begin(), joints.end(), law);
}

} // namespace gcpdda
