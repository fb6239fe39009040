#pragma once

// Rows at rest: pairs of two of them keep what an evaluation has found before.
//
// The evaluation at which a block has stopped may still change its contacts: a region that slipped sticks
// from there on. The next one finds the same bits again, and so do all others until one of the two blocks
// moves. A row is therefore at rest from the second evaluation on at which it has neither an increment nor a
// velocity, and to leave out pairs of two such rows changes no result. A region that its law has opened
// (opened_regions.hpp) is found by iteration, a little nearer each time, and is not left out.

#include "model/block_system.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace gcpdda {

class RestingRows {
public:
  /// Evaluations from here on leave pairs out, or do not.
  void set_used(bool is_used) {
    if (is_used != is_used_) {
      forget();
    }
    is_used_ = is_used;
  }
  [[nodiscard]] bool is_used() const { return is_used_; }
  /// Rows, pairs or laws are others from here on.
  void forget() { still_.clear(); }
  /// Rows [first, last) begin an evaluation.
  void begin_rows(const BlockSystem &system, std::size_t first, std::size_t last) {
    if (is_used_) {
      still_.resize(system.num_rows());
      for (std::size_t row = first; row < last; ++row) {
        still_[row] = is_still(system, row)
                          ? static_cast<std::uint8_t>(std::min<unsigned>(still_[row] + 1U, at_rest))
                          : std::uint8_t{0};
      }
    }
  }
  [[nodiscard]] bool has(std::size_t row) const { return is_used_ && still_[row] == at_rest; }

private:
  static constexpr std::uint8_t at_rest = 2; ///< evaluations

  bool is_used_ = false;
  std::vector<std::uint8_t> still_; ///< by row: evaluations in a row at which it was still, up to at_rest
};

} // namespace gcpdda
