#pragma once

// What an evaluation of contact forces says of itself, and why a step cannot go on.

#include "base/ids.hpp"
#include "contact/candidates.hpp"
#include "model/block_system.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <tuple>

namespace gcpdda {

/// Something a step cannot go on with.
struct Fault {
  enum class Cause : std::int32_t { not_finite = 0, too_deep = 1, too_fast = 2 };
  Cause cause = Cause::not_finite;
  BlockId block;
  BlockId other; ///< invalid where no pair is involved
  /// Overlap (m) or motion per step (m); where a state is not finite the largest strain of the other blocks.
  double value = 0.0;
  double limit = 0.0;

  /// Which of several faults is reported: a choice that does not depend on the ranks.
  friend bool operator<(const Fault &a, const Fault &b) {
    return std::tie(a.block, a.other, a.cause) < std::tie(b.block, b.other, b.cause);
  }
};

/// Keep the first of two faults.
inline void keep_first(std::optional<Fault> &kept, const Fault &fault) {
  if (!kept || fault < *kept) {
    kept = fault;
  }
}

/// What an evaluation of pairs saw.
struct ForceReport {
  std::int64_t evaluations = 0; ///< pairs whose boxes met
  std::int64_t normals_undefined = 0;
  double max_overlap = 0.0;       ///< m
  double max_overlap_share = 0.0; ///< of the pair's narrowest width
  std::optional<Fault> fault;     ///< the one with the smallest ids

  /// @param overlap  of a region of the pair, m
  void note_depth(const BlockSystem &system, const CandidatePair &pair, double overlap) {
    if (overlap > pair.allowed_overlap) {
      keep_first(fault, {Fault::Cause::too_deep, system.properties[pair.lower.value].id,
                         system.properties[pair.higher.value].id, overlap, pair.allowed_overlap});
    }
  }
  /// Of other pairs.
  void add(const ForceReport &other) {
    evaluations += other.evaluations;
    normals_undefined += other.normals_undefined;
    max_overlap = std::max(max_overlap, other.max_overlap);
    max_overlap_share = std::max(max_overlap_share, other.max_overlap_share);
    if (other.fault) {
      keep_first(fault, *other.fault);
    }
  }
};

} // namespace gcpdda
