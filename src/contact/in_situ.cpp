#include "contact/in_situ.hpp"

#include "contact/laws/region_law.hpp"
#include "contact/touching_edges.hpp"
#include "geometry/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda {

namespace {

/// What the contacts of one edge ask for: its overlap share is compliance times normal traction.
struct EdgeAsks {
  double length = 0.0;     ///< that touches, m
  double compliance = 0.0; ///< times that length, m2/Pa
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;

  void add(double touching, double asked) {
    length += touching;
    compliance += touching * asked;
    least = std::min(least, asked);
    most = std::max(most, asked);
  }
};

/// A vertex between edges with normals n1, n2 that move outwards by a and b. A tip may not run away.
Vec2 moved_vertex(Vec2 n1, double a, Vec2 n2, double b) {
  constexpr double farthest = 20.0;
  const Vec2 sum = n1 + n2;
  const Vec2 difference = n2 - n1;
  const auto along = [&](double share, Vec2 axis) {
    const double length = norm(axis);
    const double limit = farthest * std::max(a, b);
    return length > 0.0 ? (std::clamp(share / length, -limit, limit) / length) * axis : Vec2{};
  };
  return along(a + b, sum) + along(b - a, difference);
}

std::vector<EdgeAsks> ask_contacts(const BlockSystem &system,
                                   std::span<const std::pair<BlockIndex, BlockIndex>> pairs,
                                   const JointLaws &joints) {
  std::vector<EdgeAsks> asks(system.reference_vertex.size());
  for (const auto &[lower, higher] : pairs) {
    CandidatePair pair;
    pair.lower = lower;
    pair.higher = higher;
    const double share = system.is_fixed(lower.value) || system.is_fixed(higher.value) ? 1.0 : 0.5;
    for_touching_edges(
        system, pair, 0.0,
        [&](std::int32_t lower_edge, std::int32_t higher_edge, const SharedStretch &shared) {
          const std::int32_t law = law_of_edges(system, joints, pair, lower_edge, higher_edge);
          const double asked = share / joints.laws[static_cast<std::size_t>(law)].normal_stiffness;
          const auto add = [&](BlockIndex row, std::int32_t edge) {
            asks[system.vertex_begin[row.value] + static_cast<std::size_t>(edge)].add(shared.length, asked);
          };
          add(pair.lower, lower_edge);
          add(pair.higher, higher_edge);
        });
  }
  return asks;
}

} // namespace

std::vector<Vec2> find_swelling(const BlockSystem &system,
                                std::span<const std::pair<BlockIndex, BlockIndex>> pairs,
                                const JointLaws &joints, const InSituStress &stress, SwellReport &report) {
  const std::vector<EdgeAsks> asks = ask_contacts(system, pairs, joints);
  std::vector<Vec2> by(system.vertex_begin[system.num_owned]);
  std::vector<std::array<double, 2>> outwards; // of the ends of each edge of a row
  for (std::size_t row = 0; row < system.num_owned; ++row) {
    const std::size_t begin = system.vertex_begin[row];
    const auto normals = system.of_row(system.reference_normal, row);
    const auto vertices = system.of_row(system.reference_vertex, row);
    const std::size_t count = normals.size();
    outwards.assign(count, {});
    for (std::size_t k = 0; k < count; ++k) {
      const EdgeAsks &edge = asks[begin + k];
      const double mean = edge.length > 0.0 ? edge.compliance / edge.length : 0.0;
      report.spread = std::max(report.spread, mean > 0.0 ? (edge.most - edge.least) / mean : 0.0);
      const Vec2 centroid = system.properties[row].centroid;
      const bool is_loaded = stress.acts_on(centroid + vertices[k], centroid + vertices[(k + 1) % count]);
      for (const std::size_t end : {0U, 1U}) {
        const Vec2 x = centroid + vertices[(k + end) % count];
        const Vec2 traction = stress.compression_at(x)(normals[k]);
        report.largest = std::max(report.largest, norm(traction));
        if (edge.length == 0.0 && norm(traction) > report.unheld && !is_loaded) {
          report.unheld = norm(traction);
          report.at = system.properties[row].id.value;
        }
        outwards[k][end] = mean * std::max(0.0, dot(traction, normals[k]));
        report.widest = std::max(report.widest, 2.0 * outwards[k][end]);
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t before = (k + count - 1) % count;
      by[begin + k] = moved_vertex(normals[before], outwards[before][1], normals[k], outwards[k][0]);
    }
  }
  return by;
}

void swell(BlockSystem &system, std::size_t row, std::span<const Vec2> by) {
  const std::size_t begin = system.vertex_begin[row];
  const std::size_t count = system.num_vertices(row);
  BlockProperties &block = system.properties[row];
  for (std::size_t k = 0; k < count; ++k) {
    system.reference_vertex[begin + k] += by[k];
    block.radius = std::max(block.radius, norm(system.reference_vertex[begin + k]));
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Vec2 edge = system.reference_vertex[begin + (k + 1) % count] - system.reference_vertex[begin + k];
    const double length = norm(edge);
    system.reference_normal[begin + k] = {edge.y / length, -edge.x / length};
  }
  const auto shape = system.of_row(system.reference_vertex, row);
  const std::vector<Vec2> vertices(shape.begin(), shape.end());
  block.is_convex = is_convex(vertices) && !block.has_parted_sides;
  block.width = narrowest_width(vertices);
}

double put_in_situ_shear(const BlockSystem &system, const Candidates &candidates, const InSituStress &stress,
                         ContactForces &forces, ContactHistory &history) {
  double most_cut = 0.0;
  forces.change_shear(system, candidates, history, [&](ContactForces::ShearToSet region) {
    const RegionForce &force = region.force;
    const Vec2 middle = force.point + 0.5 * (force.extent_begin + force.extent_end) * region.tangent;
    // On the lower block, whose outward normal is minus the direction of N: -sigma n = C (N/|N|).
    const Vec2 traction = stress.compression_at(middle)(force.normal);
    const double pressure = dot(traction, force.normal);
    if (!(pressure > 0.0)) {
      return;
    }
    // An overlap force falls off at the ends of the joint, and the shear with it.
    const double normal_force =
        force.bonded ? pressure * (force.extent_end - force.extent_begin) : force.normal_force;
    const double wanted = -normal_force * dot(traction, region.tangent) / pressure;
    if (!force.bonded && force.cap == 0.0 && history.has_bonds(force.pair)) {
      return; // the bond carries it
    }
    constexpr double rounding = 1e-9;
    if (std::abs(wanted) > force.cap * (1.0 + rounding) && std::abs(wanted) > rounding * normal_force) {
      most_cut = std::max(most_cut, 1.0 - force.cap / std::abs(wanted));
    }
    if (force.cap > 0.0 && region.memory.longest > 0.0) {
      region.set(std::clamp(wanted, -force.cap, force.cap));
    }
  });
  return most_cut;
}

} // namespace gcpdda
