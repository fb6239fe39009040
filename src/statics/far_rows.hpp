#pragma once

// Blocks far from balance, and what surrounds them.
//
// A contact that opens, closes or begins to slip changes the stiffness around it at once. Where the others
// are nearly balanced, the few blocks with such contacts set the number of evaluations for all: in a slope of
// 10,883 blocks, at most 2.4 % of them are out of balance by more than 1e-5 of the largest force from the
// 95th of 148 evaluations on, and less than 1 % from the 108th. The iteration therefore goes on with these
// alone for a while, and the others stay where they are (nonlinear elimination, Lanzkron, Rose and Wilkes
// 1996, doi:10.1137/S106482759325154X). That costs what moves; a few evaluations of all blocks then spread
// what the few have found.
//
// A block that moves may be balanced, too, where a part of the pile slides. One whose stop would put more out
// of balance than anything is at hand, D v > f with D of its boundary (block_stiffness.hpp), the step v and
// the largest force f, goes on as well. (Where such a slide is stopped now and then it begins anew under a
// force that hardly exceeds what a block may have at rest: a slope of 1,223 bonded blocks just above its
// limit crept for 1,500 evaluations, and then failed after 48,000 steps of motion. It fails after 650
// evaluations.)
//
// What surrounds a block are the squares of `blocks_a_side` mean block sizes of its own place and the eight
// around: a force that one block sends out falls off within a few blocks, and what is left comes with the
// next evaluations of all.

#include "gcpdda/parallel/communicator.hpp"
#include "statics/block_stiffness.hpp"
#include "statics/field.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gcpdda::statics {

struct FarRules {
  double share_of_largest = 0.03; ///< force out of balance of a block that is far from it
  double most_far = 0.1;          ///< of the mobile blocks
  double most_around = 0.5;       ///< the same
};

class FarRows {
public:
  FarRows(const Communicator &communicator, const FarRules &rules)
      : communicator_(communicator), rules_(rules) {}

  /// Rows of a neighbourhood. Collective.
  /// @param mobile  owned rows that forces move
  void lay(const BlockSystem &system, std::vector<RowRun> mobile);
  [[nodiscard]] std::span<const RowRun> mobile() const { return mobile_; }

  /// 1 for each owned row that is far from balance or around one that is, or whose stop would be felt;
  /// nothing, on all ranks, where none is far from balance or too many would move. Collective.
  /// @param boundary  D of the owned rows
  /// @param balanced  N/m: a block with no more than this out of balance is never far from it
  [[nodiscard]] std::optional<std::vector<std::uint8_t>>
  find(const BlockSystem &system, const BlockMatrices &boundary, double balanced) const;

private:
  static constexpr double blocks_a_side = 6.0;

  [[nodiscard]] std::int64_t square_of(const BlockSystem &system, std::size_t row) const;

  Communicator communicator_;
  FarRules rules_;
  std::vector<RowRun> mobile_;
  std::int64_t num_mobile_ = 0; ///< of all ranks
  double side_ = 1.0;           ///< m
};

} // namespace gcpdda::statics
