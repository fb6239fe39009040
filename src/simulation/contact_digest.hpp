#pragma once

// What frames and histories tell of contacts, from one pass over their details.

#include "contact/contact_forces.hpp"
#include "contact/contact_sums.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace gcpdda {

/// What frames and histories tell of all contacts of the last evaluation: one pass over their details, which
/// are not stored.
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
  std::vector<OnRow> on_rows; ///< owned rows, each in the order of the other blocks' ids
  std::vector<OnFixed> on_fixed;

  /// What else is to see region `number` (in ContactHistory) of a pair, on the way.
  using Look = std::function<void(std::uint32_t pair, std::size_t number, const RegionForce &force)>;
  /// @param history  that `contacts` left behind
  void find(const BlockSystem &blocks, const Candidates &candidates, const ContactHistory &history,
            ContactForces &contacts, const Look &look = {});

  /// (1/area) int sym(x f) of a row: xx, yy, xy in Pa, tension positive.
  [[nodiscard]] std::array<double, 3> mean_stress(const BlockSystem &blocks, std::size_t row) const;
};

} // namespace gcpdda
