#include "blockgen/tile.hpp"

#include "blockgen/necks.hpp"
#include "blockgen/trace_ends.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace gcpdda::blockgen {

namespace {

bool is_before(Vec2 a, Vec2 b) {
  return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

/// By the parity of crossings: without a tolerance, so that a hair outside is outside.
bool is_inside(const std::vector<Vec2> &outline, Vec2 p) {
  bool inside = false;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 a = outline[k];
    const Vec2 b = outline[(k + 1) % outline.size()];
    if ((a.y > p.y) != (b.y > p.y)) {
      const double side = cross(b - a, p - a);
      inside ^= (b.y > a.y) == (side > 0.0);
    }
  }
  return inside;
}

bool holds(const Aabb &box, const Aabb &inner) {
  return box.holds(inner.low) && box.holds(inner.high);
}

bool owns(const Aabb &tile, Vec2 p) {
  return tile.low.x <= p.x && p.x < tile.high.x && tile.low.y <= p.y && p.y < tile.high.y;
}

Aabb moved(const Aabb &box, Vec2 by) {
  return {box.low + by, box.high + by};
}

/// Whether a face has a point in the box. What lies around all that is known of a tile is one face with a
/// hole, in which the tile lies: its box says nothing.
bool meets(const PlaneFace &shape, const Aabb &box) {
  const auto ring_passes = [&](const Ring &ring) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      if (Trace{ring[k], ring[(k + 1) % ring.size()]}.meets(box)) {
        return true;
      }
    }
    return false;
  };
  const auto surrounds = [&](const Ring &ring) { return is_inside(ring, box.low); };
  return ring_passes(shape.outer) || std::any_of(shape.holes.begin(), shape.holes.end(), ring_passes) ||
         (surrounds(shape.outer) && std::none_of(shape.holes.begin(), shape.holes.end(), surrounds));
}

double area_of(const PlaneFace &shape) {
  double area = signed_area(shape.outer);
  for (const Ring &hole : shape.holes) {
    area += signed_area(hole); // clockwise
  }
  return area;
}

bool is_straight(Vec2 before, Vec2 at, Vec2 after, double rounding) {
  const Vec2 chord = after - before;
  return std::abs(cross(chord, at - before)) <= rounding * norm(chord) && dot(at - before, after - at) > 0.0;
}

/// An outline with the joint of each edge.
struct Outline {
  Ring vertices;
  std::vector<std::int32_t> joints;
};

/// Takes out a tip at which the outline turns back on itself. A sliver between two lines that coincide to
/// within rounding, as the wall of an opening on a joint, may border on two blocks on one side: merged with
/// one of them, it would lie along the other as such a spike.
bool take_out_spike(Outline &outline, double rounding) {
  const std::size_t n = outline.vertices.size();
  for (std::size_t k = 0; k < n && n > 3; ++k) {
    const std::size_t before = (k + n - 1) % n;
    const Vec2 there = outline.vertices[k] - outline.vertices[before];
    const Vec2 back = outline.vertices[(k + 1) % n] - outline.vertices[k];
    const double longer = std::max(norm(there), norm(back));
    if (dot(there, back) < 0.0 && std::abs(cross(there, back)) <= rounding * longer) {
      outline.joints[before] = norm(there) == longer ? outline.joints[before] : outline.joints[k];
      outline.vertices.erase(outline.vertices.begin() + static_cast<std::ptrdiff_t>(k));
      outline.joints.erase(outline.joints.begin() + static_cast<std::ptrdiff_t>(k));
      return true;
    }
  }
  return false;
}

/// Without the vertices that a person would not draw: those on a straight edge of one joint, where another
/// joint ends or has ended, those that rounding has put beside another one, and spikes.
Outline simplified(const Ring &ring, const std::vector<std::int32_t> &joints, double rounding) {
  const std::size_t n = ring.size();
  // The vertex farthest from another one is a corner.
  const auto start = static_cast<std::size_t>(
      std::max_element(ring.begin(), ring.end(),
                       [&](Vec2 a, Vec2 b) { return norm(a - ring[0]) < norm(b - ring[0]); }) -
      ring.begin());
  Outline outline{{ring[start]}, {joints[start]}};
  for (std::size_t step = 1; step < n; ++step) {
    const std::size_t k = (start + step) % n;
    const Vec2 at = ring[k];
    const Vec2 after = ring[(k + 1) % n];
    if (norm(at - outline.vertices.back()) <= rounding) {
      outline.joints.back() = joints[k];
    } else if (norm(after - at) > rounding && !(joints[k] == outline.joints.back() &&
                                                is_straight(outline.vertices.back(), at, after, rounding))) {
      outline.vertices.push_back(at);
      outline.joints.push_back(joints[k]);
    }
  }
  if (take_out_spike(outline, rounding)) {
    return simplified(outline.vertices, outline.joints, rounding);
  }
  const auto first = std::min_element(outline.vertices.begin(), outline.vertices.end(), is_before) -
                     outline.vertices.begin();
  std::rotate(outline.vertices.begin(), outline.vertices.begin() + first, outline.vertices.end());
  std::rotate(outline.joints.begin(), outline.joints.begin() + first, outline.joints.end());
  return outline;
}

/// Corners of two neighbours on a straight edge of this face.
std::int64_t count_t_junctions(const RockFace &face, const EdgeMap &edges, double rounding) {
  const Ring &ring = face.shape.outer;
  const std::size_t n = ring.size();
  std::int64_t count = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 before = ring[(k + n - 1) % n];
    const Vec2 after = ring[(k + 1) % n];
    if (is_straight(before, ring[k], after, rounding)) {
      const std::int64_t one = edges.face_of(ring[k], before);
      const std::int64_t other = edges.face_of(after, ring[k]);
      count += one >= 0 && other >= 0 && one != other ? 1 : 0;
    }
  }
  return count;
}

} // namespace

double rounding_of(const RockRegion &region) {
  const Aabb world = bounding_box(region.outline);
  const double largest = std::max({std::abs(world.low.x), std::abs(world.low.y), std::abs(world.high.x),
                                   std::abs(world.high.y), norm(world.extent())});
  constexpr double digits = 64.0 * std::numeric_limits<double>::epsilon();
  return digits * largest;
}

TileCutter::TileCutter(const RockRegion &region, const JointLaws &laws, Vec2 origin, Gather gather)
    : region_(&region), laws_(&laws), origin_(origin), gather_(std::move(gather)),
      around_(moved(bounding_box(region.outline), -origin)),
      rounding_(rounding_of(region)), sizes_{region.min_width, region.min_area} {}

std::vector<SceneBlock> TileCutter::cut(const Tile &tile, CutReport &report) {
  const Tile local{moved(tile.box, -origin_), tile.halo};
  const Surroundings about = look_around(local, report);
  const EdgeJoints joints(about.traces, *laws_, about.seen, rounding_);
  const EdgeMap edges(about.faces);
  std::vector<const RockFace *> own;
  for (const RockFace &face : about.faces) {
    if (owns(local.box, face.corner())) {
      own.push_back(&face);
    }
  }
  std::sort(own.begin(), own.end(),
            [](const RockFace *a, const RockFace *b) { return is_before(a->corner(), b->corner()); });
  std::vector<SceneBlock> blocks;
  for (const RockFace *face : own) {
    if (face->opening >= 0 && region_->openings[static_cast<std::size_t>(face->opening)].excavated) {
      report.excavated_area.add(face->area);
      continue;
    }
    if (face->is_sliver) {
      report.kept_slivers.push_back(face->corner() + origin_);
    }
    report.t_junctions += count_t_junctions(*face, edges, rounding_);
    if (face->shape.holes.empty()) {
      blocks.push_back(block_of(*face, face->shape.outer, joints, about.moved));
      continue;
    }
    ++report.cut_rings;
    for (const PlaneFace &part : graph_.without_holes(face->shape)) {
      blocks.push_back(block_of(*face, part.outer, joints, about.moved));
    }
  }
  // A sliver that stays may be no wider than rounding.
  std::erase_if(blocks, [](const SceneBlock &block) { return block.vertices.size() < 3; });
  return blocks;
}

TileCutter::Surroundings TileCutter::look_around(const Tile &tile, CutReport &report) const {
  for (double halo = tile.halo;; halo *= 2.0) {
    Surroundings about;
    about.seen = tile.box.inflated(halo);
    about.traces = traces_in(about.seen);
    std::vector<Trace> lines = about.traces;
    for (const Trace &bridge :
         bridges(graph_, about.traces, EdgeJoints(about.traces, *laws_, about.seen, rounding_), about.seen,
                 rounding_)) {
      lines.push_back(bridge);
    }
    about.faces = rock_in(lines);
    const bool sees_all = holds(about.seen, around_);
    bool is_enough = true;
    std::int64_t slivers = 0;
    for (RockFace &face : about.faces) {
      face.is_certain = sees_all || holds(about.seen, face.box);
      is_enough = is_enough && (face.is_certain || !face.box.meets(tile.box) || !meets(face.shape, tile.box));
      slivers += face.is_sliver && owns(tile.box, face.corner()) ? 1 : 0;
    }
    if (is_enough && region_->slivers == SliverRule::merge) {
      shrink_dust(sizes_, about.faces, about.moved);
      merge_slivers(graph_, sizes_, about.faces);
      for (const RockFace &face : about.faces) {
        is_enough = is_enough && (face.is_certain || !owns(tile.box, face.corner()));
        slivers -= face.is_sliver && owns(tile.box, face.corner()) ? 1 : 0;
      }
      report.merged_slivers += is_enough ? slivers : 0;
    }
    if (is_enough) {
      return about;
    }
  }
}

std::vector<Trace> TileCutter::traces_in(const Aabb &box) const {
  std::vector<Trace> traces = gather_(moved(box, origin_));
  for (Trace &trace : traces) {
    trace.from -= origin_;
    trace.to -= origin_;
  }
  for (const VoronoiCells &cells : region_->voronoi) {
    // A cell depends on the sites a few cells around it.
    constexpr double reach = 6.0;
    std::vector<Vec2> sites =
        voronoi_sites(cells, *region_, moved(box, origin_).inflated(reach * cells.size));
    for (Vec2 &site : sites) {
      site -= origin_;
    }
    for (Trace &edge : graph_.voronoi_edges(sites)) {
      if (edge.meets(box)) {
        edge.joint = cells.joint;
        traces.push_back(edge);
      }
    }
  }
  return traces;
}

std::vector<RockFace> TileCutter::rock_in(const std::vector<Trace> &traces) const {
  std::vector<PlaneFace> shapes;
  std::vector<NeckCut> cuts;
  for (PlaneFace &shape : graph_.faces(traces)) {
    if (!shape.holes.empty()) {
      shapes.push_back(std::move(shape));
      continue;
    }
    for (Ring &part : without_necks(shape.outer, rounding_, cuts)) {
      shapes.push_back({std::move(part), {}});
    }
  }
  share_vertices(cuts, shapes);
  std::vector<RockFace> faces;
  for (PlaneFace &shape : shapes) {
    const Vec2 inside = graph_.point_inside(shape) + origin_;
    if (!is_inside(region_->outline, inside)) {
      continue;
    }
    RockFace face;
    face.area = area_of(shape);
    face.box = bounding_box(shape.outer);
    face.material = region_->material;
    for (const Layer &layer : region_->layers) {
      face.material = is_inside(layer.outline, inside) ? layer.material : face.material;
    }
    for (std::size_t k = 0; k < region_->openings.size(); ++k) {
      face.opening =
          is_inside(region_->openings[k].outline, inside) ? static_cast<std::int32_t>(k) : face.opening;
    }
    face.shape = std::move(shape);
    face.is_sliver = is_sliver(face, sizes_);
    faces.push_back(std::move(face));
  }
  return faces;
}

SceneBlock TileCutter::block_of(const RockFace &face, const Ring &ring, const EdgeJoints &joints,
                                const MovedEdges &moved) const {
  std::vector<std::int32_t> of_edges(ring.size());
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const auto [from, to] = moved.before({ring[k], ring[(k + 1) % ring.size()]});
    of_edges[k] = joints.of(from, to);
  }
  Outline outline = simplified(ring, of_edges, rounding_);
  SceneBlock block;
  block.material = face.material;
  block.opening = face.opening;
  block.vertices = std::move(outline.vertices);
  for (Vec2 &vertex : block.vertices) {
    vertex += origin_;
  }
  if (std::any_of(outline.joints.begin(), outline.joints.end(),
                  [](std::int32_t joint) { return joint >= 0; })) {
    block.edge_joint = std::move(outline.joints);
  }
  return block;
}

} // namespace gcpdda::blockgen
