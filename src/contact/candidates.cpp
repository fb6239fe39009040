#include "contact/candidates.hpp"

#include "contact/laws/region_law.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace gcpdda {

namespace {

/// A pair, plain as far as its laws allow.
CandidatePair make_pair(const BlockSystem &system, BlockIndex lower, BlockIndex higher,
                        const ContactParameters &parameters) {
  const BlockProperties &a = system.properties[lower.value];
  const BlockProperties &b = system.properties[higher.value];
  CandidatePair pair;
  pair.lower = lower;
  pair.higher = higher;
  const PossibleLaws laws = possible_laws(system, parameters.joints, pair);
  pair.is_mixed = !laws.only.has_value();
  pair.is_plain = laws.are_constant && parameters.potential == PotentialKind::exact;
  take_law(system, parameters, laws.only.value_or(parameters.joints.between(a.material, b.material)), pair);
  pair.allowed_overlap = 0.5 * std::min(a.width, b.width);
  pair.is_convex = a.is_convex && b.is_convex;
  return pair;
}

/// Edges of a convex block, counter-clockwise from `first` on.
struct EdgeChain {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Which edges of two convex blocks can take part in their contact while no point of either moves by more
/// than half the skin.
///
/// Whatever touches lies in both boxes, and in the axes of either block it has moved by half the skin at most
/// since the refresh: so it lies, as seen then, in the common part of both boxes inflated by half the skin,
/// inflated by as much again: call it C. An edge that does not meet C cannot touch. Over C the line of edge j
/// lies between low_j and high_j; where low_j is above the smallest high_k, line k is nearer all over C. An
/// edge that neither touches nor is nearest is out. Where the smallest high_k is negative no point of C is
/// inside: the blocks cannot touch. The distances of a deformable block are those in its reference polygon,
/// which do not change with time, at the material point that was in C.
class ChainFinder {
public:
  ChainFinder(const BlockSystem &system, double skin) : system_(system), half_skin_(0.5 * skin) {}

  /// Do the shapes of a pair allow it to be plain?
  [[nodiscard]] bool is_plain(std::size_t lower, std::size_t higher) const {
    return has_few_edges(lower) && has_few_edges(higher);
  }
  /// The edges of a plain pair that can take part; false if the blocks cannot touch.
  bool find(std::size_t lower, std::size_t higher, EdgeChain &lower_chain, EdgeChain &higher_chain) {
    lower_.take(system_, lower);
    higher_.take(system_, higher);
    const double rounding = 1e-9 * (norm(lower_.box.extent()) + norm(higher_.box.extent()));
    const Aabb first = lower_.box.inflated(half_skin_);
    const Aabb second = higher_.box.inflated(half_skin_);
    const Aabb common{{std::max(first.low.x, second.low.x), std::max(first.low.y, second.low.y)},
                      {std::min(first.high.x, second.high.x), std::min(first.high.y, second.high.y)}};
    const Aabb region = common.inflated(half_skin_ + rounding);
    if (!mark_edges(lower_, region, rounding)) {
      return false;
    }
    lower_chain = chain_of(lower_, higher_);
    if (!mark_edges(higher_, region, rounding)) {
      return false;
    }
    higher_chain = chain_of(higher_, lower_);
    return true;
  }

  [[nodiscard]] bool is_deformable(std::size_t lower, std::size_t higher) const {
    return system_.is_deformable(lower) || system_.is_deformable(higher);
  }

private:
  /// A block with few edges at the refresh.
  struct Shape {
    std::size_t row = static_cast<std::size_t>(-1);
    std::size_t count = 0;
    std::array<Vec2, most_plain_edges> vertex;
    std::array<Vec2, most_plain_edges> slope; ///< minus the gradient of each edge's distance, that of the
                                              ///< reference polygon
    Aabb box;

    void take(const BlockSystem &system, std::size_t wanted) {
      if (row == wanted) { // pairs of one lower block follow one another
        return;
      }
      row = wanted;
      count = 0;
      box = {};
      const Rotation turn = Rotation::of(system.refreshed[row].r);
      const Mat2 gradient = system.is_deformable(row) ? system.deformation_of(row).refreshed
                                                      : Mat2{turn.c, -turn.s, turn.s, turn.c};
      const Mat2 of_slopes = transposed(inverse(gradient));
      const Vec2 centre = system.properties[row].centroid + system.refreshed[row].u;
      for (std::size_t k = system.vertex_begin[row]; k < system.vertex_begin[row + 1]; ++k, ++count) {
        vertex[count] = centre + gradient(system.reference_vertex[k]);
        slope[count] = of_slopes(system.reference_normal[k]);
        box.include(vertex[count]);
      }
    }
  };

  [[nodiscard]] bool has_few_edges(std::size_t row) const {
    return system_.properties[row].is_convex && system_.num_vertices(row) <= most_plain_edges;
  }

  /// Mark the edges of a block that can take part; false if none can.
  bool mark_edges(const Shape &shape, const Aabb &region, double rounding) {
    const auto &[row, count, vertex, slope, box] = shape;
    takes_part_.fill(true);
    if (!std::isfinite(half_skin_)) {
      return true;
    }
    const Vec2 centre = 0.5 * (region.low + region.high);
    const Vec2 half = 0.5 * region.extent();
    double smallest_high = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < count; ++j) {
      const double middle = dot(slope[j], vertex[j] - centre);
      const double spread = std::abs(slope[j].x) * half.x + std::abs(slope[j].y) * half.y;
      smallest_high = std::min(smallest_high, middle + spread);
      low_[j] = middle - spread;
    }
    for (std::size_t j = 0; j < count; ++j) {
      const std::array<Vec2, 2> ends{vertex[j], vertex[j + 1 == count ? 0 : j + 1]};
      takes_part_[j] = low_[j] <= smallest_high + rounding || bounding_box(ends).meets(region);
    }
    return smallest_high >= -rounding;
  }

  /// The marked edges, or all where they are not neighbours. All of them start at the vertex farthest outside
  /// the other block, as good as a gap: sums along the chain so meet the edges that touch in the same order
  /// whatever else is in it, and whatever number a vertex has.
  [[nodiscard]] EdgeChain chain_of(const Shape &shape, const Shape &other) const {
    const std::size_t n = shape.count;
    EdgeChain chain;
    std::size_t starts = 0;
    for (std::size_t j = 0; j < n; ++j) {
      chain.count += takes_part_[j] ? 1 : 0;
      if (takes_part_[j] && !takes_part_[j == 0 ? n - 1 : j - 1]) {
        chain.first = j;
        ++starts;
      }
    }
    return starts == 1 ? chain : EdgeChain{farthest_outside(shape, other), n};
  }

  static std::size_t farthest_outside(const Shape &shape, const Shape &other) {
    std::size_t farthest = 0;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < shape.count; ++k) {
      double outside = -std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < other.count; ++j) {
        outside = std::max(outside, dot(other.slope[j], shape.vertex[k] - other.vertex[j]));
      }
      if (outside > most) {
        most = outside;
        farthest = k;
      }
    }
    return farthest;
  }

  const BlockSystem &system_;
  double half_skin_;
  // Of the pair at hand.
  Shape lower_;
  Shape higher_;
  // Of the block at hand.
  std::array<double, most_plain_edges> low_{};
  std::array<bool, most_plain_edges> takes_part_{};
};

/// Pairs without a ghost can be evaluated before the ghosts have come.
void order_evaluation(const BlockSystem &system, Candidates &candidates) {
  const auto has_ghost = [&](std::uint32_t number) {
    const CandidatePair &pair = candidates.pairs[number];
    const auto is_ghost = [&](BlockIndex row) {
      return row.value >= system.num_owned && !system.is_fixed(row.value);
    };
    return is_ghost(pair.lower) || is_ghost(pair.higher);
  };
  const auto order = [&](const PlainPair &plain) {
    const bool is_border = has_ghost(plain.pair);
    return std::tuple(is_border, is_border ? 0 : plain.group(), plain.kind.is_deformable,
                      plain.kind.lower_edges, plain.kind.higher_edges, plain.kind.has_few_edges, plain.pair);
  };
  std::sort(candidates.plain.begin(), candidates.plain.end(),
            [&](const PlainPair &a, const PlainPair &b) { return order(a) < order(b); });
  candidates.num_interior_plain =
      static_cast<std::size_t>(std::count_if(candidates.plain.begin(), candidates.plain.end(),
                                             [&](const PlainPair &plain) { return !has_ghost(plain.pair); }));
  for (std::uint32_t k = 0; k < candidates.pairs.size(); ++k) {
    if (!candidates.pairs[k].is_plain) {
      candidates.general.push_back(k);
    }
  }
  const auto border = std::stable_partition(candidates.general.begin(), candidates.general.end(),
                                            [&](std::uint32_t k) { return !has_ghost(k); });
  candidates.num_interior_general = static_cast<std::size_t>(border - candidates.general.begin());
}

/// Which blocks can add their contacts as they are evaluated.
void find_waiting(const BlockSystem &system, Candidates &candidates) {
  candidates.is_added.assign(system.num_owned, 1);
  std::vector<bool> comes_late(candidates.pairs.size(), true);
  for (std::size_t k = 0; k < candidates.num_interior_plain; ++k) {
    comes_late[candidates.plain[k].pair] = false;
  }
  const auto for_owned = [&](std::uint32_t pair, auto &&visit) {
    for (const BlockIndex row : {candidates.pairs[pair].lower, candidates.pairs[pair].higher}) {
      if (row.value < system.num_owned) {
        visit(candidates.is_added[row.value]);
      }
    }
  };
  for (std::uint32_t k = 0; k < candidates.pairs.size(); ++k) {
    for_owned(k, [&](std::uint8_t &is_added) { is_added = comes_late[k] ? 0 : is_added; });
  }
  for (std::uint32_t k = 0; k < candidates.pairs.size(); ++k) {
    bool waits = false;
    for_owned(k, [&](std::uint8_t is_added) { waits = waits || is_added == 0; });
    if (waits) {
      candidates.waiting.push_back(k);
    }
  }
  for (std::size_t k = candidates.num_interior_plain; k < candidates.plain.size(); ++k) {
    const auto place =
        std::lower_bound(candidates.waiting.begin(), candidates.waiting.end(), candidates.plain[k].pair);
    candidates.border_places.push_back(static_cast<std::uint32_t>(place - candidates.waiting.begin()));
    candidates.border_entries.push_back(static_cast<std::uint32_t>(k));
  }
  std::sort(
      candidates.border_entries.begin(), candidates.border_entries.end(),
      [&](std::uint32_t a, std::uint32_t b) { return candidates.plain[a].pair < candidates.plain[b].pair; });
  candidates.are_added.assign(candidates.pairs.size() / PlainPair::pairs_in_group + 1, 1);
  for (const std::uint32_t k : candidates.waiting) {
    candidates.are_added[k / PlainPair::pairs_in_group] = 0;
  }
}

/// Ids ascend with the lower blocks of pairs, which may be ghosts or fixed, and with the owned rows.
void find_groups(const BlockSystem &system, Candidates &candidates) {
  const std::size_t num_groups = candidates.pairs.size() / PlainPair::pairs_in_group + 1;
  const auto all = static_cast<std::uint32_t>(system.num_owned);
  const auto id_of = [&](std::uint32_t row) { return system.properties[row].id; };
  PairGroup group;
  candidates.groups.clear();
  for (; group.number < num_groups; ++group.number) {
    const std::span<const CandidatePair> left =
        std::span(candidates.pairs).subspan(std::size_t{group.number} * PlainPair::pairs_in_group);
    const std::span<const CandidatePair> own =
        left.first(std::min<std::size_t>(left.size(), PlainPair::pairs_in_group));
    for (const CandidatePair &pair : own) {
      for (const BlockIndex row : {pair.lower, pair.higher}) {
        group.rows_read = row.value < all ? std::max(group.rows_read, row.value + 1) : group.rows_read;
      }
    }
    const bool is_last = own.size() == left.size();
    while (group.rows_finished < all &&
           (is_last || id_of(group.rows_finished) < id_of(left[own.size()].lower.value))) {
      ++group.rows_finished;
    }
    group.rows_read = std::max(group.rows_read, group.rows_finished); // rows without a pair come along
    while (group.last < candidates.num_interior_plain &&
           candidates.plain[group.last].group() == group.number) {
      ++group.last;
    }
    if (group.first < group.last) {
      candidates.groups.push_back(group);
    }
    group.first = group.last;
  }
  if (candidates.groups.empty()) {
    candidates.groups.emplace_back();
  }
  PairGroup &last = candidates.groups.back();
  last.rows_read = all;
  last.rows_finished = all;
  last.is_last = true;
}

/// The last of all pairs is a plain one.
void append_plain(const BlockSystem &system, const ChainFinder &finder, const EdgeChain &lower_chain,
                  const EdgeChain &higher_chain, Candidates &candidates) {
  const CandidatePair &pair = candidates.pairs.back();
  const std::uint32_t lower = pair.lower.value;
  const std::uint32_t higher = pair.higher.value;
  candidates.plain.push_back(
      {static_cast<std::uint32_t>(candidates.pairs.size() - 1),
       {static_cast<std::uint8_t>(lower_chain.count), static_cast<std::uint8_t>(higher_chain.count),
        finder.is_deformable(lower, higher),
        system.num_vertices(lower) <= most_corner_edges && system.num_vertices(higher) <= most_corner_edges},
       static_cast<std::uint8_t>(place_in_rings(system.num_vertices(lower), lower_chain.first)),
       static_cast<std::uint8_t>(place_in_rings(system.num_vertices(higher), higher_chain.first)),
       pair.is_mixed});
}

/// None yet, with room for so many pairs.
Candidates with_room(std::size_t pairs, const JointLaws &joints) {
  Candidates candidates;
  candidates.laws = joints.all_constants();
  candidates.pairs.reserve(pairs);
  candidates.plain.reserve(pairs);
  return candidates;
}

/// Forget the memory of all pairs, with room for that of so many.
/// @param deforms  some block does
void forget_all(std::size_t pairs, bool deforms, ContactHistory &history) {
  history.overlaps.clear();
  history.plain.clear();
  history.grips.clear();
  history.ranges.clear();
  history.regions.clear();
  history.overlaps.reserve(pairs);
  history.plain.reserve(pairs);
  history.grips.reserve(deforms ? pairs : 0);
}

/// Of a pair whose regions are the last ones of all, from `begin` on: those of a plain pair move to its own
/// place.
/// @param overlap  of a plain pair: as what it is looked at first
/// @param deforms  some block does
void append_places(bool is_plain, PlainOverlap overlap, std::size_t begin, bool deforms,
                   ContactHistory &history) {
  const std::size_t count = history.regions.size() - begin;
  const bool has_plain = is_plain && count > 0;
  history.overlaps.push_back(has_plain ? overlap : PlainOverlap::none);
  history.plain.push_back(has_plain ? history.regions[begin] : RegionState{});
  if (deforms) {
    history.grips.push_back(has_plain ? history.regions[begin].grip : Vec2{});
  }
  if (is_plain) {
    history.regions.resize(begin);
  } else {
    history.ranges.resize(history.plain.size());
    history.ranges.back() = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(count)};
  }
}

/// Records of one kind, by pairs that are asked for in ascending order.
template <class Record> class RecordsInOrder {
public:
  explicit RecordsInOrder(std::vector<Record> &records) : records_(records), next_(records.begin()) {
    const auto by_pair = [](const Record &a, const Record &b) { return key(a) < key(b); };
    if (!std::is_sorted(records.begin(), records.end(), by_pair)) {
      // Several regions of a pair keep their order: both sides of a border wrote them in the same one.
      std::stable_sort(records.begin(), records.end(), by_pair);
    }
  }
  /// visit(memory).
  template <class Visit> void for_pair(BlockId lower, BlockId higher, Visit &&visit) {
    const std::pair wanted(lower, higher);
    while (next_ != records_.end() && key(*next_) < wanted) {
      ++next_;
    }
    for (; next_ != records_.end() && key(*next_) == wanted; ++next_) {
      visit(next_->memory);
    }
  }

private:
  static std::pair<BlockId, BlockId> key(const Record &record) { return {record.lower, record.higher}; }

  std::vector<Record> &records_;
  typename std::vector<Record>::const_iterator next_;
};

} // namespace

Candidates make_candidates(const BlockSystem &system,
                           std::span<const std::pair<BlockIndex, BlockIndex>> pairs,
                           const ContactParameters &parameters, ContactMemory memory, ContactHistory &history,
                           double skin) {
  Candidates candidates = with_room(pairs.size(), parameters.joints);
  RecordsInOrder plain_records(memory.plain);
  RecordsInOrder other_records(memory.others);
  const bool deforms = !system.deformation.empty();
  forget_all(pairs.size(), deforms, history);
  ChainFinder finder(system, skin);
  for (const auto &[lower, higher] : pairs) {
    EdgeChain lower_chain;
    EdgeChain higher_chain;
    CandidatePair candidate = make_pair(system, lower, higher, parameters);
    const bool is_plain = candidate.is_plain && finder.is_plain(lower.value, higher.value);
    if (is_plain && !finder.find(lower.value, higher.value, lower_chain, higher_chain)) {
      continue;
    }
    candidate.is_plain = is_plain;
    candidates.pairs.push_back(candidate);
    if (is_plain) {
      append_plain(system, finder, lower_chain, higher_chain, candidates);
    }
    const std::size_t begin = history.regions.size();
    const auto add = [&](const RegionMemory &memory_of_region) {
      const auto known = history.regions.begin() + static_cast<std::ptrdiff_t>(begin);
      if (std::none_of(known, history.regions.end(),
                       [&](const RegionMemory &m) { return m.is_same_region(memory_of_region); })) {
        history.regions.push_back(memory_of_region);
      }
    };
    const BlockId lower_id = system.properties[lower.value].id;
    const BlockId higher_id = system.properties[higher.value].id;
    plain_records.for_pair(lower_id, higher_id, [&](const RegionState &state) {
      add(RegionMemory{state, {}, {}, 0, 0, {}});
    });
    other_records.for_pair(lower_id, higher_id, add);
    if (candidate.is_mixed && history.regions.size() > begin && history.regions[begin].law >= 0) {
      take_law(system, parameters, history.regions[begin].law, candidates.pairs.back());
    }
    const bool may_be_corners = is_plain && candidates.plain.back().kind.may_be_corners();
    append_places(is_plain, may_be_corners ? PlainOverlap::corners : PlainOverlap::polygon, begin, deforms,
                  history);
  }

  order_evaluation(system, candidates);
  if (!candidates.general.empty()) {
    history.ranges.resize(candidates.pairs.size());
  }
  find_waiting(system, candidates);
  find_groups(system, candidates);
  return candidates;
}

} // namespace gcpdda
