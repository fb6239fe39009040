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
  const auto join = [&](Vec2 end, Vec2 far) {
    const auto ends_there = [&](std::uint32_t k) { return traces[k].from == end || traces[k].to == end; };
    std::vector<std::uint32_t> own = near.at(end);
    const auto middle = std::stable_partition(own.begin(), own.end(), ends_there);
    const std::vector<std::uint32_t> others(middle, own.end());
    own.erase(middle, own.end());
    for (const std::uint32_t k : others) {
      if (std::any_of(own.begin(), own.end(),
                      [&](std::uint32_t i) { return meet(graph, traces[i], traces[k]); })) {
        return; // joined already
      }
    }
    for (const std::uint32_t k : others) {
      if (!near.lies_on(far, traces[k])) { // else the trace runs along the other one
        if (const auto bridge = bridge_to(graph, end, traces[k], rounding)) {
          found.push_back(*bridge);
        }
        return;
      }
    }
  };
  for (const Trace &trace : traces) {
    if (!trace.is_side && box.holds(trace.from)) {
      join(trace.from, trace.to);
    }
    if (!trace.is_side && box.holds(trace.to)) {
      join(trace.to, trace.from);
    }
  }
  return found;
}

} // namespace gcpdda::blockgen
