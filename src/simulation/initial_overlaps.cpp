#include "simulation/initial_overlaps.hpp"

#include "contact/find_pairs.hpp"
#include "geometry/common_area.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <tuple>

namespace gcpdda {

namespace {

constexpr double deepest_share = 0.05;
constexpr double largest_common_share = 0.5; ///< of the smaller block's area
constexpr double share_of_same = 0.9;        ///< of the larger block's area: the same block twice

struct InitialOverlap {
  std::int64_t lower = 0;
  std::int64_t higher = 0;
  double depth = 0.0;
  double width = 0.0;       ///< of the narrower block, m
  double common_area = 0.0; ///< m2; 0 where it is not too large
  double smaller_area = 0.0;
  double larger_area = 0.0;

  [[nodiscard]] bool is_same_twice() const { return common_area > share_of_same * larger_area; }
  [[nodiscard]] bool is_too_large() const { return common_area > largest_common_share * smaller_area; }
  [[nodiscard]] bool is_too_deep() const { return depth > deepest_share * width; }
  [[nodiscard]] bool is_fault() const { return is_too_large() || is_too_deep(); }
};

Diagnostic fault_of(const Scene &scene, const InitialOverlap &overlap) {
  const std::string names = fmt::format("blocks '{}' and '{}'", block_name(scene, overlap.lower),
                                        block_name(scene, overlap.higher));
  const SourcePosition where = block_position(scene, overlap.higher);
  if (overlap.is_same_twice()) {
    return {Severity::error, where, names + " lie at the same place",
            fmt::format("{:.4g} % of the larger one's area is common to both",
                        100.0 * std::min(1.0, overlap.common_area / overlap.larger_area)),
            "leave one of them out"};
  }
  if (overlap.is_too_large()) {
    return {Severity::error, where, fmt::format("{} overlap by {:.3g} m2", names, overlap.common_area),
            fmt::format("that is {:.4g} % of the smaller one's area",
                        100.0 * std::min(1.0, overlap.common_area / overlap.smaller_area)),
            "move or trim one of them, or leave it out"};
  }
  return {Severity::error, where, fmt::format("{} overlap by {:.3g} m", names, overlap.depth),
          fmt::format("more than 5 % of the narrower block's width {:.3g} m", overlap.width),
          scene.in_situ.present ? "a stiffer joint, which the in-situ stress closes by less"
                                : "move or trim one of them"};
}

/// @param all  of all ranks: those with a fault and the deepest of the others
Diagnostics notes_of(const Scene &scene, std::vector<InitialOverlap> all) {
  std::stable_sort(all.begin(), all.end(), [](const InitialOverlap &a, const InitialOverlap &b) {
    return std::tuple(a.lower, a.higher, -a.common_area) < std::tuple(b.lower, b.higher, -b.common_area);
  });
  Diagnostics notes;
  constexpr std::size_t most = 100;
  std::size_t count = 0;
  InitialOverlap deepest;
  InitialOverlap last; // with a fault
  for (const InitialOverlap &overlap : all) {
    const bool is_known = last.is_too_large() && last.lower == overlap.lower && last.higher == overlap.higher;
    if (!overlap.is_fault()) {
      deepest = overlap.depth > deepest.depth ? overlap : deepest;
    } else if (!is_known) {
      last = overlap;
      if (++count <= most) {
        notes.push_back(fault_of(scene, overlap));
      }
    }
  }
  if (count > most) {
    notes.push_back({Severity::error,
                     {},
                     fmt::format("{} more pairs of blocks overlap too far", count - most),
                     "",
                     "move or trim one of each pair"});
  } else if (count == 0 && deepest.depth > 0.0) {
    notes.push_back(
        {Severity::info,
         {},
         fmt::format("the deepest initial overlap is {:.3g} m between blocks '{}' and '{}'", deepest.depth,
                     block_name(scene, deepest.lower), block_name(scene, deepest.higher)),
         "initial overlaps are contacts",
         ""});
  }
  return notes;
}

class OverlapCheck {
public:
  explicit OverlapCheck(const BlockSystem &blocks) : blocks_(&blocks) {}

  [[nodiscard]] InitialOverlap of(BlockIndex lower, BlockIndex higher) const {
    const BlockProperties &a = blocks_->properties[lower.value];
    const BlockProperties &b = blocks_->properties[higher.value];
    return {a.id.value,
            b.id.value,
            0.0,
            std::min(a.width, b.width),
            0.0,
            std::min(a.area, b.area),
            std::max(a.area, b.area)};
  }

  /// The common area, if it is more than this; else 0.
  [[nodiscard]] double common_area_above(double least, BlockIndex lower, BlockIndex higher) {
    outlines_[0].clear();
    outlines_[1].clear();
    append_current_vertices(*blocks_, lower.value, outlines_[0]);
    append_current_vertices(*blocks_, higher.value, outlines_[1]);
    const Aabb a = bounding_box(outlines_[0]);
    const Aabb b = bounding_box(outlines_[1]);
    const Vec2 common{std::min(a.high.x, b.high.x) - std::max(a.low.x, b.low.x),
                      std::min(a.high.y, b.high.y) - std::max(a.low.y, b.low.y)};
    if (std::min(common.x, common.y) <= 0.0 || common.x * common.y <= least) { // nearly all neighbours
      return 0.0;
    }
    const double area = common_area(outlines_[0], outlines_[1]);
    return area > least ? area : 0.0;
  }

private:
  const BlockSystem *blocks_;
  std::array<std::vector<Vec2>, 2> outlines_;
};

} // namespace

// Each rank lists its faults and the deepest of its other overlaps; all ranks make the same list of them.
void check_initial_overlaps(RunState &run) {
  OverlapCheck check(run.blocks);
  std::vector<InitialOverlap> mine;
  for (const CandidatePair &pair : run.neighbours.candidates.pairs) {
    InitialOverlap overlap = check.of(pair.lower, pair.higher);
    if (counts_here(run.blocks, pair.lower)) {
      overlap.common_area =
          check.common_area_above(largest_common_share * overlap.smaller_area, pair.lower, pair.higher);
    }
    if (overlap.is_too_large()) {
      mine.push_back(overlap);
    }
  }
  for (const auto &[lower, higher] : find_kept_pairs(run.blocks, 0.0)) {
    InitialOverlap overlap = check.of(lower, higher);
    overlap.common_area = check.common_area_above(share_of_same * overlap.larger_area, lower, higher);
    if (overlap.is_same_twice()) {
      mine.push_back(overlap);
    }
  }
  InitialOverlap deepest;
  for_regions(run, 0, run.neighbours.candidates.pairs.size(),
              [&](std::uint32_t number, std::span<const RegionForce> regions) {
                const CandidatePair &pair = run.neighbours.candidates.pairs[number];
                if (!counts_here(run.blocks, pair.lower)) {
                  return;
                }
                for (const RegionForce &force : regions) {
                  InitialOverlap overlap = check.of(pair.lower, pair.higher);
                  overlap.depth = force.overlap;
                  if (overlap.is_too_deep()) {
                    mine.push_back(overlap);
                  } else if (overlap.depth > deepest.depth) {
                    deepest = overlap;
                  }
                }
              });
  mine.push_back(deepest);
  std::vector<InitialOverlap> all;
  for (const auto &from_rank : run.communicator.all_gather(mine)) {
    all.insert(all.end(), from_rank.begin(), from_rank.end());
  }
  const Diagnostics found = notes_of(run.scene, std::move(all));
  if (has_errors(found)) {
    run.local_fault.reset(); // the list says it better
  }
  run.notes.insert(run.notes.end(), found.begin(), found.end());
}

} // namespace gcpdda
