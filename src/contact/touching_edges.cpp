#include "contact/touching_edges.hpp"

#include <algorithm>

namespace gcpdda {

std::optional<SharedStretch> shared_stretch(const BlockSystem &system, const CandidatePair &pair,
                                            std::int32_t lower_edge, std::int32_t higher_edge) {
  const auto a = static_cast<std::size_t>(lower_edge);
  const auto b = static_cast<std::size_t>(higher_edge);
  const auto lower = system.of_row(system.reference_vertex, pair.lower.value);
  const auto higher = system.of_row(system.reference_vertex, pair.higher.value);
  const Vec2 between =
      system.properties[pair.higher.value].centroid - system.properties[pair.lower.value].centroid;
  SharedStretch shared;
  shared.normal = system.of_row(system.reference_normal, pair.lower.value)[a];
  const Vec2 tangent = perp(shared.normal);
  const Vec2 begin = lower[a];
  // The higher block's edge runs the other way.
  const Vec2 far = higher[b] + between - begin;
  const Vec2 near = higher[(b + 1) % higher.size()] + between - begin;
  const double s_far = dot(far, tangent);
  const double s_near = dot(near, tangent);
  const double s0 = std::max(0.0, s_near);
  const double s1 = std::min(dot(lower[(a + 1) % lower.size()] - begin, tangent), s_far);
  if (!(s1 > s0) || !(s_far > s_near)) {
    return std::nullopt;
  }
  const double gap_near = dot(near, shared.normal);
  const double slope = (dot(far, shared.normal) - gap_near) / (s_far - s_near);
  shared.length = s1 - s0;
  for (const std::size_t k : {0U, 1U}) {
    const double s = k == 0 ? s0 : s1;
    shared.gap[k] = gap_near + slope * (s - s_near);
    shared.lower_ends[k] = begin + s * tangent;
    shared.higher_ends[k] = shared.lower_ends[k] + shared.gap[k] * shared.normal - between;
  }
  return shared;
}

bool lie_on_each_other(const SharedStretch &shared, double pressed) {
  constexpr double most_pressed = 0.02; // of the length: corners that meet are no edges
  const double overlap = std::min(pressed, most_pressed * shared.length);
  return std::all_of(shared.gap.begin(), shared.gap.end(), [&](double gap) {
    return gap <= coincidence * shared.length && -gap <= coincidence * shared.length + overlap;
  });
}

} // namespace gcpdda
