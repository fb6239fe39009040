#include "simulation/bolt_pieces.hpp"

#include "geometry/aabb.hpp"
#include "geometry/holds_point.hpp"
#include "simulation/outline_box.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace gcpdda {

namespace {

constexpr double least_share = 1e-9; ///< of a bolt's length: shorter stretches are none

/// One link over `length` about `middle` of the bolt, between the blocks on its head's and its tip's side.
BoltLink link_between(std::int64_t bolt, std::int64_t head_block, std::int64_t tip_block, Vec2 middle,
                      Vec2 direction, double length) {
  BoltLink link;
  link.bolt = static_cast<std::int32_t>(bolt);
  link.head_first = head_block < tip_block;
  link.length = length;
  const std::size_t head = link.head_first ? 0 : 1;
  const Vec2 along = link.head_first ? direction : -direction;
  link.end[head] = {head_block, middle - (0.5 * length) * direction, along};
  link.end[1 - head] = {tip_block, middle + (0.5 * length) * direction, along};
  return link;
}

/// Along a joint two blocks hold the same stretch: the lower id has it.
void drop_doubles(std::vector<BoltPiece> &pieces) {
  std::sort(pieces.begin(), pieces.end(), [](const BoltPiece &a, const BoltPiece &b) {
    return std::tuple(a.begin + a.end, a.block) < std::tuple(b.begin + b.end, b.block);
  });
  std::vector<BoltPiece> kept;
  for (const BoltPiece &piece : pieces) {
    if (kept.empty() || 0.5 * (piece.begin + piece.end) > kept.back().end) {
      kept.push_back(piece);
    }
  }
  pieces = std::move(kept);
}

/// Where the grouted bar around a joint between two pieces begins and ends, as shares of the bolt: at a void
/// that no link spans.
std::pair<double, double> bar_around(const std::vector<BoltPiece> &pieces, std::size_t joint,
                                     double widest_gap) {
  const auto goes_on = [&](std::size_t k) {
    return pieces[k].block == pieces[k + 1].block || pieces[k + 1].begin - pieces[k].end <= widest_gap;
  };
  std::size_t first = joint;
  while (first > 0 && goes_on(first - 1)) {
    --first;
  }
  std::size_t last = joint + 1;
  while (last + 1 < pieces.size() && goes_on(last)) {
    ++last;
  }
  return {pieces[first].begin, pieces[last].end};
}

/// Of the bar on one side of a link no more than a length is left in rock. Where it has been drawn out, what
/// is in the grout is counted from here on.
void end_bar(BoltLink &link, std::size_t side, double left) {
  if (left >= link.grout[side]) {
    return;
  }
  double &slip = link.memory.grout_slip;
  if (slip > 0.0) {
    link.grout[link.grout[0] < link.grout[1] ? 0 : 1] -= slip;
    slip = 0.0;
  }
  link.grout[side] = std::min(link.grout[side], left);
}

} // namespace

void append_pieces(const Bolt &bolt, std::int64_t index, std::span<const Vec2> polygon, std::int64_t block,
                   std::vector<BoltPiece> &pieces) {
  const std::array<Vec2, 2> ends{bolt.from, bolt.to};
  if (!bounding_box(polygon).meets(bounding_box(ends))) {
    return;
  }
  const Vec2 line = bolt.to - bolt.from;
  std::vector<double> cuts{0.0, 1.0};
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 begin = polygon[k] - bolt.from;
    const Vec2 edge = polygon[(k + 1) % polygon.size()] - polygon[k];
    const double turn = cross(line, edge);
    const double on_bolt = cross(begin, edge) / turn;
    const double on_edge = cross(begin, line) / turn;
    if (turn != 0.0 && on_bolt > 0.0 && on_bolt < 1.0 && on_edge > -least_share &&
        on_edge < 1.0 + least_share) {
      cuts.push_back(on_bolt);
    }
  }
  std::sort(cuts.begin(), cuts.end());
  bool goes_on = false;
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
    if (cuts[k + 1] - cuts[k] < least_share) {
      continue;
    }
    const bool inside = holds_point(polygon, bolt.from + (0.5 * (cuts[k] + cuts[k + 1])) * line);
    if (inside && goes_on) {
      pieces.back().end = cuts[k + 1];
    } else if (inside) {
      pieces.push_back({index, block, cuts[k], cuts[k + 1]});
    }
    goes_on = inside;
  }
}

void append_pieces(const Scene &scene, std::span<const std::int64_t> which, const BlockSystem &system,
                   std::size_t row, std::vector<BoltPiece> &pieces) {
  const Aabb around = box_around(system, row);
  std::vector<Vec2> polygon; // of the few blocks that are near
  for (const std::int64_t index : which) {
    const Bolt &bolt = scene.bolts[static_cast<std::size_t>(index)];
    const std::array<Vec2, 2> ends{bolt.from, bolt.to};
    if (around.meets(bounding_box(ends))) {
      if (polygon.empty()) {
        polygon = current_vertices(system, row);
      }
      append_pieces(bolt, index, polygon, system.properties[row].id.value, pieces);
    }
  }
}

std::vector<BoltLink> links_of(const Bolt &bolt, std::int64_t index, const SupportType &support,
                               std::vector<BoltPiece> &pieces) {
  drop_doubles(pieces);
  std::vector<BoltLink> links;
  if (pieces.empty()) {
    return links;
  }
  const Vec2 line = bolt.to - bolt.from;
  const double length = norm(line);
  const Vec2 direction = (1.0 / length) * line;
  const BoltPiece &first = pieces.front();
  const BoltPiece &last = pieces.back();
  if (support.kind == SupportType::Kind::anchored) {
    if (first.block != last.block) {
      const double middle = 0.5 * (first.begin + last.end);
      links.push_back(link_between(index, first.block, last.block, bolt.from + middle * line, direction,
                                   (last.end - first.begin) * length));
    }
    return links;
  }
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const BoltPiece &head = pieces[k];
    const BoltPiece &tip = pieces[k + 1];
    if (head.block == tip.block || (tip.begin - head.end) * length > support.active_length) {
      continue; // in and out of one block, or through a void
    }
    const double middle = 0.5 * (head.end + tip.begin);
    BoltLink link = link_between(index, head.block, tip.block, bolt.from + middle * line, direction,
                                 support.active_length);
    const double to_head = (middle - first.begin) * length;
    const double to_tip = (last.end - middle) * length;
    link.overhang = {to_head - 0.5 * link.length, to_tip - 0.5 * link.length};
    const auto [begin, end] = bar_around(pieces, k, support.active_length / length);
    link.grout = {support.plate && begin == first.begin ? SupportType::unlimited : (middle - begin) * length,
                  (end - middle) * length};
    link.bond_length = std::min(link.grout[0], link.grout[1]);
    links.push_back(link);
  }
  return links;
}

void end_bars_at_voids(std::vector<BoltLink> &links, const std::function<bool(std::int64_t)> &is_gone) {
  const auto place = [](const BoltLink &link) { return link.overhang[0] + 0.5 * link.length; };
  auto bolt_begin = links.begin();
  for (auto gone_link = links.begin(); gone_link != links.end(); ++gone_link) {
    const BoltLink &gone = *gone_link;
    bolt_begin = bolt_begin->bolt == gone.bolt ? bolt_begin : gone_link;
    const std::size_t head = gone.head_first ? 0 : 1;
    const bool head_goes = is_gone(gone.end[head].block);
    const bool tip_goes = is_gone(gone.end[1 - head].block);
    if (gone.liner >= 0 || !(head_goes || tip_goes)) {
      continue;
    }
    for (auto link = bolt_begin; link != links.end() && link->bolt == gone.bolt; ++link) {
      const double towards_tip = place(*link) - place(gone);
      if (head_goes && towards_tip > 0.0) {
        end_bar(*link, 0, towards_tip);
      } else if (tip_goes && towards_tip < 0.0) {
        end_bar(*link, 1, -towards_tip);
      }
    }
  }
}

} // namespace gcpdda
