#include "blockgen/planar_graph.hpp"

#include "base/check.hpp"
#include "geometry/polygon.hpp"

#include <geos_c.h>

#include <algorithm>
#include <string>
#include <tuple>

namespace gcpdda::blockgen {

struct PlanarGraph::Context {
  GEOSContextHandle_t handle = GEOS_init_r();
  std::string trouble;

  Context() {
    GEOSContext_setErrorMessageHandler_r(
        handle, [](const char *message, void *self) { static_cast<Context *>(self)->trouble = message; },
        this);
  }
  ~Context() { GEOS_finish_r(handle); }
  Context(const Context &) = delete;
  Context &operator=(const Context &) = delete;
};

namespace {

struct Destroy {
  GEOSContextHandle_t handle;
  void operator()(GEOSGeometry *geometry) const { GEOSGeom_destroy_r(handle, geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, Destroy>;

bool is_before(Vec2 a, Vec2 b) {
  return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

/// Makes geometries of one context and takes them apart.
class Maker {
public:
  Maker(GEOSContextHandle_t handle, const std::string &trouble) : handle_(handle), trouble_(&trouble) {}

  Geometry own(GEOSGeometry *geometry) const {
    if (geometry == nullptr) {
      throw InternalError("GEOS: " + *trouble_);
    }
    return {geometry, {handle_}};
  }

  Geometry line(Vec2 a, Vec2 b) const {
    const std::array<double, 4> xy{a.x, a.y, b.x, b.y};
    return own(
        GEOSGeom_createLineString_r(handle_, GEOSCoordSeq_copyFromBuffer_r(handle_, xy.data(), 2, 0, 0)));
  }

  GEOSGeometry *closed(const Ring &ring) const {
    std::vector<double> xy;
    for (std::size_t k = 0; k <= ring.size(); ++k) {
      const Vec2 p = ring[k % ring.size()];
      xy.insert(xy.end(), {p.x, p.y});
    }
    const auto n = static_cast<unsigned>(ring.size() + 1);
    return GEOSGeom_createLinearRing_r(handle_, GEOSCoordSeq_copyFromBuffer_r(handle_, xy.data(), n, 0, 0));
  }

  Geometry polygon(const PlaneFace &face) const {
    std::vector<GEOSGeometry *> holes;
    for (const Ring &hole : face.holes) {
      holes.push_back(closed(hole));
    }
    return own(GEOSGeom_createPolygon_r(handle_, closed(face.outer), holes.data(),
                                        static_cast<unsigned>(holes.size())));
  }

  Geometry collection(int type, std::vector<Geometry> parts) const {
    std::vector<GEOSGeometry *> raw;
    for (Geometry &part : parts) {
      raw.push_back(part.release());
    }
    return own(GEOSGeom_createCollection_r(handle_, type, raw.data(), static_cast<unsigned>(raw.size())));
  }

  std::vector<Vec2> points_of(const GEOSGeometry *line) const {
    const GEOSCoordSequence *sequence = GEOSGeom_getCoordSeq_r(handle_, line);
    unsigned n = 0;
    GEOSCoordSeq_getSize_r(handle_, sequence, &n);
    std::vector<Vec2> points(n);
    for (unsigned k = 0; k < n; ++k) {
      GEOSCoordSeq_getXY_r(handle_, sequence, k, &points[k].x, &points[k].y);
    }
    return points;
  }

  PlaneFace face_of(const GEOSGeometry *polygon) const {
    PlaneFace face;
    face.outer = ring_of(GEOSGetExteriorRing_r(handle_, polygon), true);
    for (int k = 0; k < GEOSGetNumInteriorRings_r(handle_, polygon); ++k) {
      face.holes.push_back(ring_of(GEOSGetInteriorRingN_r(handle_, polygon, k), false));
    }
    std::sort(face.holes.begin(), face.holes.end(),
              [](const Ring &a, const Ring &b) { return is_before(a[0], b[0]); });
    return face;
  }

  /// Faces of the arrangement of these lines.
  std::vector<PlaneFace> faces_of(const Geometry &lines) const {
    GEOSGeometry *plain = GEOSUnaryUnion_r(handle_, lines.get());
    if (plain == nullptr) { // rounding has misled plain noding, so node again on a grid
      plain = GEOSUnaryUnionPrec_r(handle_, lines.get(), grid_of(lines));
    }
    const Geometry noded = own(plain);
    const GEOSGeometry *const all = noded.get();
    const Geometry polygons = own(GEOSPolygonize_r(handle_, &all, 1));
    std::vector<PlaneFace> faces;
    const int n = GEOSGetNumGeometries_r(handle_, polygons.get());
    faces.reserve(static_cast<std::size_t>(n));
    for (int k = 0; k < n; ++k) {
      faces.push_back(face_of(GEOSGetGeometryN_r(handle_, polygons.get(), k)));
    }
    return faces;
  }

  Vec2 point_inside(const Geometry &polygon) const {
    const Geometry point = own(GEOSPointOnSurface_r(handle_, polygon.get()));
    Vec2 p;
    GEOSGeomGetX_r(handle_, point.get(), &p.x);
    GEOSGeomGetY_r(handle_, point.get(), &p.y);
    return p;
  }

  bool contains(const Geometry &polygon, Vec2 p) const {
    const Geometry point = own(GEOSGeom_createPointFromXY_r(handle_, p.x, p.y));
    return GEOSContains_r(handle_, polygon.get(), point.get()) == 1;
  }

  GEOSContextHandle_t handle() const { return handle_; }

private:
  Ring ring_of(const GEOSGeometry *closed_line, bool counter_clockwise) const {
    Ring ring = points_of(closed_line);
    ring.pop_back();
    if ((signed_area(ring) > 0.0) != counter_clockwise) {
      std::reverse(ring.begin(), ring.end());
    }
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), is_before), ring.end());
    return ring;
  }

  double grid_of(const Geometry &lines) const {
    double low = 0.0;
    double high = 0.0;
    GEOSGeom_getXMin_r(handle_, lines.get(), &low);
    GEOSGeom_getXMax_r(handle_, lines.get(), &high);
    constexpr double digits = 1e-12;
    return digits * std::max(std::abs(low), std::abs(high));
  }

  GEOSContextHandle_t handle_;
  const std::string *trouble_;
};

} // namespace

PlanarGraph::PlanarGraph() : context_(std::make_unique<Context>()) {}
PlanarGraph::~PlanarGraph() = default;

std::vector<PlaneFace> PlanarGraph::faces(std::span<const Trace> segments) const {
  const Maker maker(context_->handle, context_->trouble);
  std::vector<Geometry> lines;
  lines.reserve(segments.size());
  for (const Trace &segment : segments) {
    // One way round, so that the crossing of two segments is computed one way.
    const bool forward = is_before(segment.from, segment.to);
    lines.push_back(forward ? maker.line(segment.from, segment.to) : maker.line(segment.to, segment.from));
  }
  return maker.faces_of(maker.collection(GEOS_MULTILINESTRING, std::move(lines)));
}

int PlanarGraph::side(const Trace &segment, Vec2 p) const {
  return GEOSOrientationIndex_r(context_->handle, segment.from.x, segment.from.y, segment.to.x, segment.to.y,
                                p.x, p.y);
}

Vec2 PlanarGraph::point_inside(const PlaneFace &face) const {
  const Maker maker(context_->handle, context_->trouble);
  return maker.point_inside(maker.polygon(face));
}

PlaneFace PlanarGraph::unite(std::span<const PlaneFace *const> faces) const {
  const Maker maker(context_->handle, context_->trouble);
  std::vector<Geometry> parts;
  for (const PlaneFace *face : faces) {
    parts.push_back(maker.polygon(*face));
  }
  const Geometry all = maker.collection(GEOS_MULTIPOLYGON, std::move(parts));
  const Geometry one = maker.own(GEOSCoverageUnion_r(maker.handle(), all.get()));
  const bool is_one = GEOSGeomTypeId_r(maker.handle(), one.get()) == GEOS_POLYGON;
  ensure(is_one || GEOSGetNumGeometries_r(maker.handle(), one.get()) == 1,
         "faces that share edges unite to one");
  return maker.face_of(is_one ? one.get() : GEOSGetGeometryN_r(maker.handle(), one.get(), 0));
}

std::vector<PlaneFace> PlanarGraph::without_holes(const PlaneFace &face) const {
  const Maker maker(context_->handle, context_->trouble);
  const Aabb box = bounding_box(face.outer);
  const double beyond = 0.01 * box.extent().y;
  std::vector<Geometry> lines;
  const auto add_ring = [&](const Ring &ring) {
    for (std::size_t k = 0; k < ring.size(); ++k) {
      lines.push_back(maker.line(ring[k], ring[(k + 1) % ring.size()]));
    }
  };
  add_ring(face.outer);
  for (const Ring &hole : face.holes) {
    add_ring(hole);
    const Aabb hole_box = bounding_box(hole);
    const double x = 0.5 * (hole_box.low.x + hole_box.high.x);
    lines.push_back(maker.line({x, box.low.y - beyond}, {x, box.high.y + beyond}));
  }
  const Geometry whole = maker.polygon(face);
  std::vector<PlaneFace> parts;
  for (PlaneFace &part : maker.faces_of(maker.collection(GEOS_MULTILINESTRING, std::move(lines)))) {
    if (maker.contains(whole, maker.point_inside(maker.polygon(part)))) {
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

std::vector<Trace> PlanarGraph::voronoi_edges(std::span<const Vec2> sites) const {
  const Maker maker(context_->handle, context_->trouble);
  std::vector<Geometry> points;
  for (const Vec2 site : sites) {
    points.push_back(maker.own(GEOSGeom_createPointFromXY_r(maker.handle(), site.x, site.y)));
  }
  const Geometry all = maker.collection(GEOS_MULTIPOINT, std::move(points));
  const Geometry edges = maker.own(GEOSVoronoiDiagram_r(maker.handle(), all.get(), nullptr, 0.0, 1));
  std::vector<Trace> traces;
  for (int k = 0; k < GEOSGetNumGeometries_r(maker.handle(), edges.get()); ++k) {
    const std::vector<Vec2> line = maker.points_of(GEOSGetGeometryN_r(maker.handle(), edges.get(), k));
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      traces.push_back({line[i], line[i + 1]});
    }
  }
  return traces;
}

std::string geos_version() {
  return GEOSversion();
}

} // namespace gcpdda::blockgen
