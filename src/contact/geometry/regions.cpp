// Which pieces of a contact share one friction spring, if a block has re-entrant vertices, or vertices within
// straight sides where laws change.
//
// Such vertices cut an outline into stretches. A piece belongs to two of them: that of its own edge and that
// of the nearest edge of the other block. Pieces with the same two can still lie apart (a bar over both
// prongs of a U), or on both sides of a block's only re-entrant vertex. So they are projected on the outline
// of each re-entrant block in turn, by arc length from the beginning of the stretch: pieces on its own edges
// as they are, the other block's by the feet of their ends on the nearest edge. Neighbours on the outline
// whose gap is no longer than the depths at its ends belong together: about that far from its corner a sunk
// edge lets go of one face and the next piece begins on another. Where the two outlines cross, both depths
// and the gap are zero; there a millionth of the pieces' own lengths (and their rounding) decides, so that
// the rounding of the crossing does not.

#include "contact/geometry/regions.hpp"

#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace gcpdda {

void RegionSplitter::Outline::follow(const BlockView &block) {
  const std::size_t n = block.vertex.size();
  stretch.assign(n, 0);
  arc.assign(n, 0.0);
  if (block.is_convex) {
    return;
  }
  // The reference polygon: deformation must not renumber anything.
  find_reentrant_vertices(block.frame ? block.frame->vertex : block.vertex, parts);
  const std::span<const Vec2> normal = block.frame ? block.frame->normal : block.normal;
  for (std::size_t e = 0; e < n && block.has_parted_sides; ++e) {
    parts[e] = parts[e] || are_in_one_side(normal[e == 0 ? n - 1 : e - 1], normal[e]);
  }
  const auto num_parts = static_cast<std::int32_t>(std::count(parts.begin(), parts.end(), true));
  const auto start =
      static_cast<std::size_t>(std::find(parts.begin(), parts.end(), true) - parts.begin()) % n;
  std::int32_t passed = 0;
  for (std::size_t e = 0; e < n; ++e) {
    passed += e > 0 && parts[e] ? 1 : 0;
    stretch[e] = num_parts > 0 ? passed % num_parts : 0;
  }
  // The only vertex of this kind has a stretch on each side, or nothing would tell both parts from each
  // other.
  for (std::size_t e = 0; e < n && num_parts == 1 && block.has_parted_sides; ++e) {
    stretch[e] = (e + n - start) % n < n / 2 ? 0 : 1;
  }
  for (std::size_t step = 1; step < n; ++step) {
    const std::size_t e = (start + step) % n;
    const std::size_t last = (start + step - 1) % n;
    arc[e] = parts[e] ? 0.0 : arc[last] + block.length[last];
  }
}

// Where a piece lies along a block's outline; `on` is its own edge or the nearest one.
void RegionSplitter::project(const Piece &piece, const BlockView &block, const Outline &outline,
                             std::int32_t on, Placed &placed) {
  const auto e = static_cast<std::size_t>(on);
  const auto along = [&](Vec2 x) {
    const double s = dot(x - block.vertex[e], perp(block.normal[e]));
    return outline.arc[e] + std::clamp(s, 0.0, block.length[e]);
  };
  const double begin = along(piece.begin);
  const double end = along(piece.end());
  const double crossing = 1e-6 * piece.length + 64.0 * std::numeric_limits<double>::epsilon() *
                                                    (end + std::abs(piece.begin.x) + std::abs(piece.begin.y));
  placed.low = std::min(begin - piece.depth_begin, end - piece.depth_end) - crossing;
  placed.high = std::max(begin + piece.depth_begin, end + piece.depth_end) + crossing;
}

std::size_t RegionSplitter::connect() {
  std::size_t num_regions = 0;
  std::sort(placed_.begin(), placed_.end(), [](const Placed &p, const Placed &q) {
    return std::tie(p.faces, p.region, p.low, p.piece) < std::tie(q.faces, q.region, q.low, q.piece);
  });
  for (auto begin = placed_.begin(); begin != placed_.end();) {
    double high = begin->high;
    std::size_t lowest = begin->piece;
    auto end = begin + 1;
    for (; end != placed_.end() && end->faces == begin->faces && end->region == begin->region &&
           end->low <= high;
         ++end) {
      lowest = std::min(lowest, end->piece);
      high = std::max(high, end->high);
    }
    std::for_each(begin, end, [&](Placed &p) { p.region = lowest; });
    begin = end;
    num_regions += 1;
  }
  return num_regions;
}

void RegionSplitter::place(const BlockView &first, const BlockView &second, std::span<const Piece> pieces,
                           std::size_t num_first) {
  on_first_.follow(first);
  on_second_.follow(second);
  placed_.assign(pieces.size(), {});
  const auto edge_of = [&](std::size_t i, bool of_first) {
    return i < num_first ? (of_first ? pieces[i].edge : pieces[i].face)
                         : (of_first ? pieces[i].face : pieces[i].edge);
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    placed_[i].piece = i;
    placed_[i].faces = {on_first_.stretch[static_cast<std::size_t>(edge_of(i, true))],
                        on_second_.stretch[static_cast<std::size_t>(edge_of(i, false))]};
  }
  // A cut on one outline can take away what held pieces together on the other one: until nothing changes.
  std::size_t num_regions = 0;
  std::size_t before = 0;
  do {
    before = num_regions;
    for (const bool of_first : {true, false}) {
      const BlockView &block = of_first ? first : second;
      if (!block.is_convex) {
        for (Placed &p : placed_) {
          project(pieces[p.piece], block, of_first ? on_first_ : on_second_, edge_of(p.piece, of_first), p);
        }
        num_regions = connect();
      }
    }
  } while (num_regions != before && !first.is_convex && !second.is_convex);
}

void start_at_entry(std::span<Piece> pieces) {
  const auto start = std::min_element(pieces.begin(), pieces.end(), [](const Piece &p, const Piece &q) {
    if (p.enters != q.enters) {
      return p.enters;
    }
    return p.begin.x != q.begin.x ? p.begin.x < q.begin.x : p.begin.y < q.begin.y;
  });
  std::rotate(pieces.begin(), start, pieces.end());
}

void RegionSplitter::split(const BlockView &first, const BlockView &second, std::vector<Piece> &pieces,
                           std::size_t num_first, std::vector<Region> &regions) {
  regions.clear();
  if (pieces.empty()) {
    return;
  }
  place(first, second, pieces, num_first);
  std::sort(placed_.begin(), placed_.end(), [](const Placed &p, const Placed &q) {
    return std::tie(p.faces, p.region, p.piece) < std::tie(q.faces, q.region, q.piece);
  });
  sorted_.clear();
  for (auto begin = placed_.begin(); begin != placed_.end();) {
    const auto end = std::find_if(begin, placed_.end(), [&](const Placed &p) {
      return p.faces != begin->faces || p.region != begin->region;
    });
    const bool carries = std::any_of(begin, end, [&](const Placed &p) {
      const Piece &piece = pieces[p.piece];
      return piece.length > 0.0 && piece.depth_begin + piece.depth_end > 0.0;
    });
    if (carries) {
      Region region;
      region.faces = begin->faces;
      region.begin = static_cast<std::uint32_t>(sorted_.size());
      std::for_each(begin, end, [&](const Placed &p) { sorted_.push_back(pieces[p.piece]); });
      region.middle = region.begin + static_cast<std::uint32_t>(std::count_if(
                                         begin, end, [&](const Placed &p) { return p.piece < num_first; }));
      region.end = static_cast<std::uint32_t>(sorted_.size());
      start_at_entry(std::span(sorted_).subspan(region.begin, region.middle - region.begin));
      start_at_entry(std::span(sorted_).subspan(region.middle));
      regions.push_back(region);
    }
    begin = end;
  }
  pieces.swap(sorted_);
}

} // namespace gcpdda
