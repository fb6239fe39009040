#pragma once

#include "gcpdda/contact/contact_forces.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace gcpdda {

/// What frames, histories and rows of energies tell of all contacts of the last evaluation: one pass over
/// their details, which stand nowhere.
struct ContactDigest {
  struct OnRow {
    RigidDof force; ///< N/m and N, torque about the trial centroid
    Mat2 dyad;      ///< int (x - x_c) df^T, N
  };
  /// One region's part of a fixed block's reaction.
  struct OnFixed {
    std::uint32_t row = 0;
    std::uint32_t other = 0; ///< row of the other block
    ContactPart part;
  };
  /// A region whose stick spring is stretched, or a bond.
  struct Spring {
    std::uint32_t pair = 0;
    std::uint32_t number = 0; ///< in ContactHistory
    Vec2 point;               ///< x_r
    Vec2 normal;              ///< n_r
  };
  std::vector<OnRow> on_rows; ///< owned rows, each in the order of the other blocks' ids
  std::vector<OnFixed> on_fixed;
  std::vector<Spring> springs; ///< that count on this rank

  /// @param history  that `contacts` left behind
  void find(const BlockSystem &blocks, const Candidates &candidates, const ContactHistory &history,
            ContactForces &contacts);

  /// (1/area) int sym(x f) of a row: xx, yy, xy in Pa, tension positive.
  [[nodiscard]] std::array<double, 3> mean_stress(const BlockSystem &blocks, std::size_t row) const;
};

} // namespace gcpdda
