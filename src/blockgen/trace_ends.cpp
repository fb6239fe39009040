#include "blockgen/trace_ends.hpp"

#include <algorithm>
#include <optional>

namespace gcpdda::blockgen {

namespace {

/// Whether two traces have a point in common, without a tolerance, as noding sees it.
bool meet(const PlanarGraph &graph, const Trace &a, const Trace &b) {
  const int from = graph.side(b, a.from);
  const int to = graph.side(b, a.to);
  if (from == 0 && to == 0) { // on one line
    return a.box().meets(b.box());
  }
  return from * to <= 0 && graph.side(a, b.from) * graph.side(a, b.to) <= 0;
}

/// From an end to a trace: to its own end if that is as near, else a little beyond it.
std::optional<Trace> bridge_to(const PlanarGraph &graph, Vec2 end, const Trace &trace, double rounding) {
  for (const Vec2 corner : {trace.from, trace.to}) {
    if (norm(corner - end) <= rounding) {
      return Trace{end, corner};
    }
  }
  const int side = graph.side(trace, end);
  if (side == 0) {
    return std::nullopt;
  }
  const Vec2 along = trace.to - trace.from;
  return Trace{end, end - (2.0 * rounding * side / norm(along)) * perp(along)};
}

} // namespace

std::vector<Trace> bridges(const PlanarGraph &graph, std::span<const Trace> traces, const EdgeJoints &near,
                           const Aabb &box, double rounding) {
  std::vector<Trace> found;
  const auto join = [&](Vec2 point) {
    const auto ends_there = [&](std::uint32_t k) { return traces[k].from == point || traces[k].to == point; };
    std::vector<std::uint32_t> own = near.at(point);
    const auto middle = std::stable_partition(own.begin(), own.end(), ends_there);
    const std::vector<std::uint32_t> others(middle, own.end());
    own.erase(middle, own.end());
    for (const std::uint32_t k : others) {
      const auto is_joined = [&](std::uint32_t i) { // or runs along the other one
        const Vec2 far = traces[i].from == point ? traces[i].to : traces[i].from;
        return meet(graph, traces[i], traces[k]) || near.lies_on(far, traces[k]);
      };
      if (std::any_of(own.begin(), own.end(), is_joined)) {
        continue;
      }
      if (const auto bridge = bridge_to(graph, point, traces[k], rounding)) {
        found.push_back(*bridge);
      }
    }
  };
  for (const Trace &trace : traces) {
    for (const Vec2 point : {trace.from, trace.to}) {
      if (box.holds(point)) {
        join(point);
      }
    }
  }
  return found;
}

} // namespace gcpdda::blockgen
