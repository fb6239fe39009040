#include "blockgen/necks.hpp"

#include "geometry/edge_tree.hpp"
#include "geometry/polygon.hpp"

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

/// By how many vertices behind a vertex those edges begin on which it lies, ascending.
std::vector<std::size_t> edges_at(const Ring &ring, const EdgeTree &tree, std::size_t vertex,
                                  double rounding) {
  const std::size_t n = ring.size();
  std::vector<std::size_t> found;
  Aabb around;
  around.include(ring[vertex]);
  tree.any_meeting(around.inflated(2.0 * rounding), [&](std::size_t edge) {
    const std::size_t behind = (edge + n - vertex) % n;
    if (behind >= 1 && behind + 1 < n && is_on(ring[vertex], ring[edge], ring[(edge + 1) % n], rounding)) {
      found.push_back(behind);
    }
    return false;
  });
  std::sort(found.begin(), found.end());
  return found;
}

/// The two parts of a ring with a vertex on an edge.
std::optional<std::array<Ring, 2>> parted(const Ring &ring, double rounding, std::vector<NeckCut> &cuts) {
  const std::size_t n = ring.size();
  const EdgeTree tree(ring);
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t k : edges_at(ring, tree, i, rounding)) {
      std::array<Ring, 2> parts{Ring{ring[i]}, Ring{ring[i]}};
      for (std::size_t behind = 1; behind < n; ++behind) {
        parts[behind <= k ? 0 : 1].push_back(ring[(i + behind) % n]);
      }
      if (has_area(parts[0], rounding) && has_area(parts[1], rounding)) {
        cuts.push_back({ring[(i + k) % n], ring[(i + k + 1) % n], ring[i]});
        return parts;
      }
    }
  }
  return std::nullopt;
}

} // namespace

std::vector<Ring> without_necks(const Ring &ring, double rounding, std::vector<NeckCut> &cuts) {
  std::vector<Ring> whole;
  std::vector<Ring> rest{ring};
  while (!rest.empty()) {
    const Ring next = std::move(rest.back());
    rest.pop_back();
    if (auto parts = parted(next, rounding, cuts)) {
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

void share_vertices(std::span<const NeckCut> cuts, std::vector<PlaneFace> &faces) {
  const auto share = [&](const NeckCut &cut, Ring &ring) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      if (ring[k] == cut.to && ring[(k + 1) % ring.size()] == cut.from) {
        ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(k) + 1, cut.vertex);
        return;
      }
    }
  };
  for (const NeckCut &cut : cuts) {
    for (PlaneFace &face : faces) {
      share(cut, face.outer);
      for (Ring &hole : face.holes) {
        share(cut, hole);
      }
    }
  }
}

} // namespace gcpdda::blockgen
