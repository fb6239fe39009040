#pragma once

// A tree of boxes over the edges of a polygon, for outlines with many vertices.

#include "geometry/aabb.hpp"

#include <bit>
#include <cstddef>
#include <functional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace gcpdda {

/// Boxes around the edges of a polygon, around two neighbouring edges, four and so on: what lies near a place
/// is found without a look at all edges. Edge i runs from vertex i to the next one.
class EdgeTree {
public:
  explicit EdgeTree(std::span<const Vec2> vertices)
      : first_leaf_(std::bit_ceil(vertices.size())), boxes_(2 * first_leaf_) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      boxes_[first_leaf_ + i].include(vertices[i]);
      boxes_[first_leaf_ + i].include(vertices[i + 1 == vertices.size() ? 0 : i + 1]);
    }
    for (std::size_t node = first_leaf_ - 1; node > 0; --node) {
      boxes_[node] = boxes_[2 * node];
      boxes_[node].include(boxes_[2 * node + 1]);
    }
  }

  [[nodiscard]] const Aabb &box(std::size_t edge) const { return boxes_[first_leaf_ + edge]; }

  /// Whether is_wanted(edge) holds for one of the edges whose boxes meet this one.
  template <class Wanted> bool any_meeting(const Aabb &box, Wanted &&is_wanted, std::size_t node = 1) const {
    if (!boxes_[node].meets(box)) {
      return false;
    }
    return node >= first_leaf_
               ? is_wanted(node - first_leaf_)
               : any_meeting(box, is_wanted, 2 * node) || any_meeting(box, is_wanted, 2 * node + 1);
  }

  /// visit(edge) in the order of distance(box), which is nowhere larger than that of what the box holds, as
  /// long as it is below limit().
  template <class Distance, class Limit, class Visit>
  void visit_nearest(Distance &&distance, Limit &&limit, Visit &&visit) const {
    using Place = std::pair<double, std::size_t>;
    std::priority_queue<Place, std::vector<Place>, std::greater<>> places;
    places.emplace(distance(boxes_[1]), 1);
    while (!places.empty() && places.top().first < limit()) {
      const std::size_t node = places.top().second;
      places.pop();
      if (node >= first_leaf_) {
        visit(node - first_leaf_);
        continue;
      }
      for (const std::size_t child : {2 * node, 2 * node + 1}) {
        if (!boxes_[child].empty()) {
          places.emplace(distance(boxes_[child]), child);
        }
      }
    }
  }

private:
  std::size_t first_leaf_;
  std::vector<Aabb> boxes_;
};

} // namespace gcpdda
