#include "necks.hpp"

#include "gcpdda/geometry/polygon.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

namespace gcpdda::blockgen {

namespace {

bool is_on(Vec2 x, Vec2 from, Vec2 to, double rounding) {
  const Vec2 along = to - from;
  const double length = norm(along);
  const double at = dot(x - from, along);
  return at > 0.0 && at < length * length && std::abs(cross(along, x - from)) <= rounding * length;
}

/// More than a line.
bool has_area(const Ring &ring, double rounding) {
  double length = 0.0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    length += norm(ring[(k + 1) % ring.size()] - ring[k]);
  }
  return signed_area(ring) > rounding * length;
}

/// The two parts of a ring with a vertex on an edge.
std::optional<std::array<Ring, 2>> parted(const Ring &ring, double rounding) {
  const std::size_t n = ring.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 1; k + 1 < n; ++k) { // from the k-th vertex behind this one to the next
      const auto vertex = [&](std::size_t behind) { return ring[(i + behind) % n]; };
      if (!is_on(ring[i], vertex(k), vertex(k + 1), rounding)) {
        continue;
      }
      std::array<Ring, 2> parts{Ring{ring[i]}, Ring{ring[i]}};
      for (std::size_t behind = 1; behind < n; ++behind) {
        parts[behind <= k ? 0 : 1].push_back(vertex(behind));
      }
      if (has_area(parts[0], rounding) && has_area(parts[1], rounding)) {
        return parts;
      }
    }
  }
  return std::nullopt;
}

} // namespace

std::vector<Ring> without_necks(const Ring &ring, double rounding) {
  std::vector<Ring> whole;
  std::vector<Ring> rest{ring};
  while (!rest.empty()) {
    const Ring next = std::move(rest.back());
    rest.pop_back();
    if (auto parts = parted(next, rounding)) {
      rest.insert(rest.end(), parts->begin(), parts->end());
    } else {
      whole.push_back(next);
    }
  }
  for (Ring &part : whole) {
    std::rotate(part.begin(),
                std::min_element(part.begin(), part.end(),
                                 [](Vec2 a, Vec2 b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); }),
                part.end());
  }
  return whole;
}

} // namespace gcpdda::blockgen
