#include "contact/start_contacts.hpp"

#include "contact/laws/region_law.hpp"
#include "contact/touching_edges.hpp"

#include <algorithm>
#include <tuple>

namespace gcpdda {

namespace {

/// Share of an edge's length within which ends of stretches count as one.
constexpr double rounding = 1e-6;

/// @param first, last  relative to the centroid of the row
StartContact side_of(const BlockSystem &system, BlockIndex row, BlockIndex other, std::int32_t edge,
                     Vec2 first, Vec2 last) {
  const auto k = static_cast<std::size_t>(edge);
  const Vec2 tangent = perp(system.of_row(system.reference_normal, row.value)[k]);
  const Vec2 vertex = system.of_row(system.reference_vertex, row.value)[k];
  const double length = reference_length(system, row.value, k);
  const auto share = [&](Vec2 x) { return std::clamp(dot(x - vertex, tangent) / length, 0.0, 1.0); };
  return {system.properties[row.value].id.value,
          system.properties[other.value].id.value,
          edge,
          -1,
          share(first),
          share(last)};
}

void add_contacts(const BlockSystem &system, const JointLaws &joints, const CandidatePair &pair,
                  std::vector<StartContact> &contacts) {
  for_touching_edges(
      system, pair, 0.0, [&](std::int32_t lower_edge, std::int32_t higher_edge, const SharedStretch &shared) {
        const std::int32_t law = law_of_edges(system, joints, pair, lower_edge, higher_edge);
        const auto &[lower_first, lower_last] = shared.lower_ends;
        const auto &[higher_last, higher_first] = shared.higher_ends; // that edge runs the other way
        contacts.push_back(side_of(system, pair.lower, pair.higher, lower_edge, lower_first, lower_last));
        contacts.back().law = law;
        contacts.push_back(side_of(system, pair.higher, pair.lower, higher_edge, higher_first, higher_last));
        contacts.back().law = law;
      });
}

/// The stretches of one edge, which has contacts.
class EdgeStretches {
public:
  EdgeStretches(std::int32_t edge, std::vector<WaterStretch> &list)
      : edge_(edge), first_(list.size()), list_(&list) {}

  void add(std::int32_t law, double end) {
    if (end - at_ <= rounding) {
      return;
    }
    if (list_->size() > first_ && list_->back().law == law) {
      list_->back().end = end;
    } else {
      list_->push_back({edge_, law, at_, end});
    }
    at_ = end;
  }
  /// Drop them where the edge's own law says the same.
  void close(std::int32_t own_law) {
    if (list_->size() > first_) {
      list_->back().end = 1.0;
    }
    if (list_->size() == first_ || (list_->size() == first_ + 1 && list_->back().law == own_law)) {
      list_->resize(first_);
    }
  }

private:
  std::int32_t edge_;
  std::size_t first_;
  std::vector<WaterStretch> *list_;
  double at_ = 0.0;
};

} // namespace

void sort_start_contacts(std::vector<StartContact> &contacts) {
  const auto key = [](const StartContact &c) {
    return std::tuple(c.block, c.edge, c.begin, c.other, c.end, c.law);
  };
  std::sort(contacts.begin(), contacts.end(),
            [&](const StartContact &a, const StartContact &b) { return key(a) < key(b); });
}

std::vector<StartContact> find_start_contacts(const BlockSystem &system,
                                              std::span<const std::pair<BlockIndex, BlockIndex>> pairs,
                                              const JointLaws &joints) {
  std::vector<StartContact> contacts;
  for (const auto &[lower, higher] : pairs) {
    CandidatePair pair;
    pair.lower = lower;
    pair.higher = higher;
    add_contacts(system, joints, pair, contacts);
  }
  sort_start_contacts(contacts);
  return contacts;
}

std::vector<WaterStretch> water_stretches_of(const BlockSystem &system, std::size_t row,
                                             std::span<const StartContact> contacts,
                                             const std::vector<bool> &is_listed) {
  const auto known = [&](std::int32_t law) {
    return law >= 0 && is_listed[static_cast<std::size_t>(law)] ? law : -1;
  };
  const std::span<const std::int32_t> joints = system.edge_joints(row);
  std::vector<WaterStretch> list;
  for (std::size_t i = 0; i < contacts.size();) {
    const std::int32_t edge = contacts[i].edge;
    const std::int32_t own = joints.empty() ? -1 : known(joints[static_cast<std::size_t>(edge)]);
    EdgeStretches stretches(edge, list);
    for (; i < contacts.size() && contacts[i].edge == edge; ++i) {
      stretches.add(own, contacts[i].begin);
      stretches.add(known(contacts[i].law), contacts[i].end);
    }
    stretches.add(own, 1.0);
    stretches.close(own);
  }
  return list;
}

} // namespace gcpdda
