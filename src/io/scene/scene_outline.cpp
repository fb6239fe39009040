#include "io/scene/scene_outline.hpp"

#include "geometry/polygon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace gcpdda::scene_text {

namespace {

double largest_coordinate(std::span<const Vec2> vertices) {
  double largest = 0.0;
  for (const Vec2 p : vertices) {
    largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
  }
  return largest;
}

// No vertex is further off one straight line than rounding puts it.
bool is_flat(std::span<const Vec2> vertices) {
  const Vec2 origin = vertices[0];
  Vec2 farthest;
  for (const Vec2 p : vertices) {
    if (norm(p - origin) > norm(farthest)) {
      farthest = p - origin;
    }
  }
  const double bound = norm(farthest) * coordinate_rounding(largest_coordinate(vertices));
  return std::all_of(vertices.begin(), vertices.end(),
                     [&](Vec2 p) { return std::abs(cross(farthest, p - origin)) <= bound; });
}

// Left turns only and once around: such a ring is simple, which spares the test of all edges.
bool turns_left_once(std::span<const Vec2> vertices) {
  constexpr double three_half_turns = 9.42477796076938;
  const std::size_t n = vertices.size();
  double turned = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = vertices[(i + 1) % n] - vertices[i];
    const Vec2 out = vertices[(i + 2) % n] - vertices[(i + 1) % n];
    turned += std::atan2(cross(in, out), dot(in, out));
  }
  return is_convex(vertices) && turned < three_half_turns;
}

std::vector<OutlineFault> find_equal_neighbours(std::span<const Vec2> vertices, const std::string &who) {
  const double rounding = coordinate_rounding(largest_coordinate(vertices));
  std::vector<OutlineFault> found;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::size_t next = (i + 1) % vertices.size();
    if (norm(vertices[next] - vertices[i]) > rounding) {
      continue;
    }
    // Of the last and the first vertex the last is the superfluous one.
    const std::size_t later = std::max(i, next);
    found.push_back(
        {later, fmt::format("vertex {} of {} equals vertex {}", later, who, later == i ? next : i),
         later == i ? "the outline closes by itself" : "an edge needs a length", "leave one of them out"});
  }
  return found;
}

} // namespace

double coordinate_rounding(double largest) {
  return 4.0 * std::numeric_limits<double>::epsilon() * largest;
}

std::vector<OutlineFault> check_outline(std::vector<Vec2> &vertices, std::vector<std::int32_t> &edge_joint,
                                        const std::string &who) {
  std::vector<OutlineFault> faults = find_equal_neighbours(vertices, who);
  if (!faults.empty()) {
    return faults;
  }
  if (is_flat(vertices)) {
    faults.push_back({{}, who + " has zero area", "all its vertices lie on one line", "check the vertices"});
    return faults;
  }
  if (signed_area(vertices) < 0.0) {
    std::reverse(vertices.begin() + 1, vertices.end());
    std::reverse(edge_joint.begin(), edge_joint.end()); // the last edge ends at vertex 0
  }
  if (!turns_left_once(vertices) && !is_simple(vertices)) {
    faults.push_back({{},
                      who + " crosses itself",
                      "two of its edges meet away from a common vertex",
                      "list the vertices in order around the block"});
  }
  return faults;
}

std::vector<OutlineFault> check_outline(std::vector<Vec2> &vertices, const std::string &who) {
  std::vector<std::int32_t> no_laws;
  return check_outline(vertices, no_laws, who);
}

} // namespace gcpdda::scene_text
