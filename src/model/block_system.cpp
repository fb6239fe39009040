#include "gcpdda/model/block_system.hpp"

#include "gcpdda/geometry/polygon.hpp"

#include <limits>

namespace gcpdda {

void append_block(BlockSystem &system, BlockId id, const SceneBlock &block, const Material &material) {
  const Moments moments = polygon_moments(block.vertices);
  BlockProperties p;
  p.id = id;
  p.material = block.material;
  p.kind = block.fixed ? BlockKind::fixed : BlockKind::rigid;
  p.area = moments.area;
  p.mass = block.fixed ? std::numeric_limits<double>::infinity() : material.density * moments.area;
  p.inertia =
      block.fixed ? std::numeric_limits<double>::infinity() : material.density * (moments.xx + moments.yy);
  p.width = narrowest_width(block.vertices);
  p.centroid = moments.centroid;
  const std::size_t n = block.vertices.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 offset = block.vertices[i] - moments.centroid;
    const Vec2 edge = block.vertices[(i + 1) % n] - block.vertices[i];
    const double length = norm(edge);
    p.radius = std::max(p.radius, norm(offset));
    system.reference_vertex.push_back(offset);
    system.reference_normal.push_back({edge.y / length, -edge.x / length});
    system.edge_length.push_back(length);
  }
  system.vertex_begin.push_back(static_cast<std::uint32_t>(system.reference_vertex.size()));
  const auto &v = block.velocity;
  system.properties.push_back(p);
  system.displacement.emplace_back();
  system.velocity.push_back(block.fixed ? RigidDof{} : RigidDof{{v[0], v[1]}, v[2]});
  system.acceleration.emplace_back();
  system.trial.emplace_back();
  system.trial_previous.emplace_back();
  system.refreshed.emplace_back();
  system.ledger.emplace_back();
}

void append_row(BlockSystem &to, const BlockSystem &from, std::size_t row) {
  std::apply([&](auto... field) { ((to.*field).push_back((from.*field)[row]), ...); },
             BlockSystem::row_fields());
  const auto begin = static_cast<std::ptrdiff_t>(from.vertex_begin[row]);
  const auto end = static_cast<std::ptrdiff_t>(from.vertex_begin[row + 1]);
  std::apply(
      [&](auto... field) {
        ((to.*field).insert((to.*field).end(), (from.*field).begin() + begin, (from.*field).begin() + end),
         ...);
      },
      BlockSystem::shape_fields());
  to.vertex_begin.push_back(static_cast<std::uint32_t>(to.reference_vertex.size()));
}

void pose(BlockSystem &system, std::size_t first, std::size_t last) {
  system.trial_centroid.resize(system.num_rows());
  system.box.resize(system.num_rows());
  system.vertex.resize(system.reference_vertex.size());
  system.normal.resize(system.reference_vertex.size());
  for (std::size_t row = first; row < last; ++row) {
    const Vec2 centre = system.properties[row].centroid + system.trial[row].u;
    const Rotation turn = Rotation::of(system.trial[row].r);
    Aabb box;
    for (std::size_t k = system.vertex_begin[row]; k < system.vertex_begin[row + 1]; ++k) {
      system.vertex[k] = centre + turn(system.reference_vertex[k]);
      system.normal[k] = turn(system.reference_normal[k]);
      box.include(system.vertex[k]);
    }
    system.trial_centroid[row] = centre;
    system.box[row] = box;
  }
}

std::vector<Vec2> current_vertices(const BlockSystem &system, std::size_t row) {
  const Rotation turn = Rotation::of(system.displacement[row].r);
  std::vector<Vec2> vertices;
  for (const Vec2 x : system.of_row(system.reference_vertex, row)) {
    vertices.push_back(system.centroid(row) + turn(x));
  }
  return vertices;
}

} // namespace gcpdda
