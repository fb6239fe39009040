#pragma once

// Groups of plain pairs whose rows are all at rest (resting_rows.hpp): where few blocks move these are most,
// and to look at each of their pairs would take longer than to evaluate the others. Pairs with a ghost and
// pairs that are not plain are asked one by one.

#include "contact/candidates.hpp"
#include "contact/resting_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gcpdda {

class RestingGroups {
public:
  /// What pairs that are left out have found before.
  struct Kept {
    std::int64_t normals_undefined = 0;
    double max_overlap = 0.0;

    void add(const Kept &other) {
      normals_undefined += other.normals_undefined;
      max_overlap = std::max(max_overlap, other.max_overlap);
    }
  };

  /// Candidates or rows are others from here on.
  void forget() { first_row_.clear(); }
  /// An evaluation begins that leaves out pairs of rows at rest.
  void begin(const Candidates &candidates) {
    if (first_row_.empty()) {
      find_rows(candidates);
      kept_.assign(candidates.are_added.size(), std::nullopt);
    }
  }
  /// What all pairs of a group keep, if they do.
  [[nodiscard]] const std::optional<Kept> &rests(std::uint32_t number, const RestingRows &resting) const {
    static constexpr std::optional<Kept> none;
    const auto is_at_rest = [&](std::uint32_t row) { return resting.has(row); };
    return kept_[number] && std::ranges::all_of(rows(number), is_at_rest) ? kept_[number] : none;
  }
  /// What the pairs of a group have kept that was evaluated; none where some of them have not.
  void note(std::uint32_t number, const std::optional<Kept> &kept) { kept_[number] = kept; }

private:
  [[nodiscard]] std::span<const std::uint32_t> rows(std::uint32_t number) const {
    return std::span(rows_).subspan(first_row_[number], first_row_[number + 1] - first_row_[number]);
  }
  void find_rows(const Candidates &candidates);

  std::vector<std::size_t> first_row_;    ///< in rows_, by group, and where the last one ends
  std::vector<std::uint32_t> rows_;       ///< of the plain pairs without a ghost
  std::vector<std::optional<Kept>> kept_; ///< by group
};

} // namespace gcpdda
