#include "simulation/fault_doubts.hpp"

#include "geometry/edge_tree.hpp"
#include "geometry/holds_point.hpp"
#include "geometry/point_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

namespace gcpdda {

namespace {

constexpr double near_share = 1e-3; ///< of the region's extent

/// Faults one after the other, so that one tree holds the pieces of all of them.
class FaultPieces {
public:
  explicit FaultPieces(const RockRegion &region) {
    for (std::size_t k = 0; k < region.faults.size(); ++k) {
      const std::vector<Vec2> &points = region.faults[k].points;
      points_.insert(points_.end(), points.begin(), points.end());
      fault_.resize(points_.size(), static_cast<std::int64_t>(k));
      fault_.back() = -1; // leads to the next fault
    }
  }
  [[nodiscard]] const std::vector<Vec2> &points() const { return points_; }
  /// Of the piece behind point k; -1 where there is none.
  [[nodiscard]] std::int64_t fault_of(std::size_t k) const { return fault_[k]; }
  [[nodiscard]] bool is_near(std::size_t k, Vec2 p, double reach) const {
    return distance_to_boundary(std::array{points_[k], points_[k + 1]}, p) <= reach;
  }

private:
  std::vector<Vec2> points_;
  std::vector<std::int64_t> fault_;
};

void mark_used(const FaultPieces &pieces, const EdgeTree &tree, const std::vector<Vec2> &vertices,
               double reach, std::vector<std::int64_t> &is_used) {
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const std::array edge{vertices[k], vertices[(k + 1) % vertices.size()]};
    tree.any_meeting(bounding_box(edge).inflated(reach), [&](std::size_t piece) {
      const std::int64_t fault = pieces.fault_of(piece);
      if (fault >= 0 && is_used[static_cast<std::size_t>(fault)] == 0 &&
          pieces.is_near(piece, edge[0], reach) && pieces.is_near(piece, edge[1], reach)) {
        is_used[static_cast<std::size_t>(fault)] = 1;
      }
      return false;
    });
  }
}

/// Upwards along a piece of a fault from a corner that it passes, if it goes on upwards for `far`.
std::optional<Vec2> way_up(Vec2 a, Vec2 b, Vec2 corner, Vec2 up, double far) {
  const Vec2 high = dot(a, up) > dot(b, up) ? a : b;
  const Vec2 low = dot(a, up) > dot(b, up) ? b : a;
  const double length = norm(high - low);
  const Vec2 along = (1.0 / length) * (high - low);
  return dot(along, up) > 0.0 && dot(high - corner, along) > far ? std::optional(along) : std::nullopt;
}

} // namespace

std::optional<Diagnostic> doubt_idle_faults(const Communicator &communicator, const RockRegion &region,
                                            std::span<const SceneBlock> slab, std::int64_t first,
                                            std::int64_t first_cut) {
  if (region.faults.empty()) {
    return std::nullopt;
  }
  const FaultPieces pieces(region);
  const EdgeTree tree(pieces.points());
  // The cut moves vertices by its rounding, and by a tenth of min_width where it shrinks dust.
  constexpr double rounding = 1e-9;
  const double reach =
      std::max(rounding * norm(bounding_box(region.outline).extent()), 0.1 * region.min_width);
  std::vector<std::int64_t> is_used(region.faults.size(), 0);
  for (std::size_t k = 0; k < slab.size(); ++k) {
    if (first + static_cast<std::int64_t>(k) >= first_cut) {
      mark_used(pieces, tree, slab[k].vertices, reach, is_used);
    }
  }
  communicator.max(is_used);
  const auto idle = std::find(is_used.begin(), is_used.end(), 0);
  if (idle == is_used.end()) {
    return std::nullopt;
  }
  const FaultLine &fault = region.faults[static_cast<std::size_t>(idle - is_used.begin())];
  const auto others = std::count(idle + 1, is_used.end(), 0);
  return Diagnostic{Severity::warning, fault.where,
                    fmt::format("{} bounds no block{}", fault.name,
                                others == 0   ? ""
                                : others == 1 ? ", nor does 1 other fault"
                                              : fmt::format(", nor do {} other faults", others)),
                    "a fault is shortened to the last joint or outline that it crosses at either end, and "
                    "slivers along it are merged",
                    "let it begin and end a little beyond an outline or another joint"};
}

std::optional<Diagnostic> doubt_faults_at_corners(const RockRegion &region, Vec2 gravity) {
  if (norm(gravity) == 0.0) {
    return std::nullopt;
  }
  const Vec2 up = (-1.0 / norm(gravity)) * gravity;
  const std::vector<Vec2> &outline = region.outline;
  const double reach = near_share * norm(bounding_box(outline).extent());
  for (std::size_t c = 0; c < outline.size(); ++c) {
    const Vec2 corner = outline[c];
    const Vec2 before = outline[(c + outline.size() - 1) % outline.size()];
    const Vec2 behind = outline[(c + 1) % outline.size()];
    if (cross(corner - before, behind - corner) >= 0.0) {
      continue;
    }
    for (const FaultLine &fault : region.faults) {
      for (std::size_t k = 0; k + 1 < fault.points.size(); ++k) {
        const std::array piece{fault.points[k], fault.points[k + 1]};
        const auto along = distance_to_boundary(piece, corner) <= reach
                               ? way_up(piece[0], piece[1], corner, up, 4.0 * reach)
                               : std::nullopt;
        if (along && holds_point(outline, corner + 4.0 * reach * *along) &&
            holds_point(outline, corner - 4.0 * reach * *along)) {
          return Diagnostic{
              Severity::warning, fault.where,
              fmt::format("{} comes out at the corner {} of the outline", fault.name, point_text(corner)),
              "a block that slides down along it pushes its tip into the rock before the corner and is held "
              "there, whatever the friction",
              "where blocks are to slide out along it let it come out above the corner, by more than they "
              "may slide"};
        }
      }
    }
  }
  return std::nullopt;
}

} // namespace gcpdda
