#pragma once

// Heaps of tiny faces, where joints cross each other almost in one point, shrink to a vertex.

#include "blockgen/face_merger.hpp"

#include <map>
#include <utility>
#include <vector>

namespace gcpdda::blockgen {

/// Where the edges with a moved end were before: from and to by from and to.
class MovedEdges {
public:
  using Edge = std::pair<Vec2, Vec2>;

  void add(Edge after, Edge before) { before_.emplace(after, before); }
  /// The edge as the joints have cut it; itself if neither end has moved.
  [[nodiscard]] Edge before(Edge after) const {
    const auto found = before_.find(after);
    return found == before_.end() ? after : found->second;
  }

private:
  struct Less {
    bool operator()(const Edge &a, const Edge &b) const;
  };
  std::map<Edge, Edge, Less> before_;
};

/// Dust faces are slivers within a tenth of min_width. A heap of them that touch each other, together within
/// a tenth of min_width, shrinks to one of its vertices, and the faces around it meet there: merged, the heap
/// would leave a spike or a neck as narrow as itself on a neighbour, and the contacts of that whole block
/// would bear an overlap of half of that only. A sliver between two heaps, as between two traces that nearly
/// coincide, becomes a line and is no face any more. A heap stays where it touches a side of the region or
/// another material or opening, or where a face around it would cross itself.
/// @param moved  those edges are added that have a moved end
void shrink_dust(const SliverSizes &sizes, std::vector<RockFace> &faces, MovedEdges &moved);

} // namespace gcpdda::blockgen
