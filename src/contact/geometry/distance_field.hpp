#pragma once

// The distance to the boundary of a polygon with re-entrant vertices, along edges that run into it.

#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/scene.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// An edge of the other block in the polygon's axes.
struct FieldEdge {
  Vec2 begin;
  Vec2 end;
  Vec2 tangent;
  double length = 0.0;
};

/// Part of an edge inside the polygon, with one feature nearest along it.
struct FieldPart {
  double anchor = 0.0; ///< where `begin` and `end` are measured from, along the edge
  double begin = 0.0;
  double end = 0.0;
  double depth_begin = 0.0;
  double depth_end = 0.0;
  std::int32_t face = 0;       ///< nearest edge, or the one on this side of the nearest vertex
  bool enters = false;         ///< the edge comes in from outside at `begin`
  bool nearest_vertex = false; ///< depth = sqrt(q^2 + (s - foot)^2), else linear
  double q = 0.0;
  double foot = 0.0; ///< from `begin`, outside the part or at one of its ends
};

/// That of one polygon after another; buffers are reused.
class DistanceField {
public:
  /// A simple polygon, counter-clockwise, with its unit normals, which must outlive what follows.
  void take(std::span<const Vec2> vertex, std::span<const Vec2> normal);

  /// Append the parts of an edge inside, in its direction.
  void trace(const FieldEdge &edge, PotentialKind potential, std::vector<FieldPart> &parts);

private:
  /// The nearest boundary point lies on `edge`: within it (end = 0), at its begin (-1) or its end (1).
  struct Nearest {
    double square = 0.0;
    std::size_t edge = 0;
    int end = 0;
  };
  /// What decides the depth: a line, or a re-entrant vertex and the face on the point's side of it.
  struct Feature {
    std::size_t face = 0;
    std::size_t vertex = 0;
    bool at_vertex = false;
    bool inside = false;

    [[nodiscard]] bool same_as(const Feature &other) const {
      return face == other.face && at_vertex == other.at_vertex && (!at_vertex || vertex == other.vertex);
    }
  };
  /// A line's signed distance alpha + beta s along the edge under trace.
  struct Line {
    double alpha = 0.0;
    double beta = 0.0;
    [[nodiscard]] double at(double s) const { return alpha + beta * s; }
  };
  struct Zero {
    double s = 0.0;
    double beta = 0.0;
    std::size_t line = 0;
  };
  /// A stretch inside: between two zeros, or an end of the edge where there is none.
  struct Stretch {
    double begin = 0.0;
    double end = 0.0;
    std::size_t entry = 0; ///< line it comes in through
    std::size_t exit = 0;
  };
  /// The same, measured from its entry.
  struct Anchored {
    Vec2 origin;
    Vec2 tangent;
    double anchor = 0.0;
    double begin = 0.0;
    double end = 0.0;
    double depth_begin = 0.0;
    double depth_end = 0.0;
    double rounding = 0.0; ///< of places along the edge
    bool enters = false;
    [[nodiscard]] Vec2 at(double s) const { return origin + s * tangent; }
  };

  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 == vertex_.size() ? 0 : i + 1; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i == 0 ? vertex_.size() - 1 : i - 1; }
  [[nodiscard]] Vec2 tangent(std::size_t edge) const { return perp(normal_[edge]); }
  [[nodiscard]] double signed_distance(std::size_t edge, Vec2 x) const;
  [[nodiscard]] Line line(std::size_t edge, Vec2 origin, Vec2 along) const;
  /// Distance of x from an edge; replaces `nearest` where it is smaller.
  void compare(std::size_t edge, Vec2 x, Nearest &nearest) const;
  [[nodiscard]] Nearest nearest(Vec2 x) const;
  [[nodiscard]] Nearest nearest_kept(Vec2 x) const;
  [[nodiscard]] Feature feature(Vec2 x, const Nearest &nearest) const;

  void find_stretches(const FieldEdge &edge);
  [[nodiscard]] Anchored anchored(const FieldEdge &edge, const Stretch &stretch) const;
  void keep_features(const Anchored &inside);
  void find_break_points(const Anchored &inside);
  void add_foot_ends(const Anchored &inside, std::size_t edge);
  void add_line_and_vertex(const Anchored &inside, std::size_t edge, Vec2 vertex);
  void add_break_point(const Anchored &inside, double s);
  void append_chord(const Anchored &inside, std::vector<FieldPart> &parts) const;
  void append_parts(const Anchored &inside, std::vector<FieldPart> &parts) const;
  void append_part(const Anchored &inside, const Feature &feature, double begin, double end,
                   std::vector<FieldPart> &parts) const;

  std::span<const Vec2> vertex_;
  std::span<const Vec2> normal_;
  std::vector<double> length_;
  std::vector<bool> reentrant_;
  // Of the edge under trace.
  std::vector<Zero> zeros_;
  std::vector<Stretch> stretches_;
  std::vector<std::size_t> kept_edges_;
  std::vector<std::size_t> kept_vertices_;
  std::vector<Line> lines_; ///< of kept_edges_
  std::vector<double> break_points_;
};

} // namespace gcpdda
