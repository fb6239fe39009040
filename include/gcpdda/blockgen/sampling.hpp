#pragma once

#include "gcpdda/model/rock_region.hpp"

#include <cstdint>

namespace gcpdda::blockgen {

/// Numbers that depend on their address alone: the k-th number of a draw is the same whoever asks, in
/// whatever order. The distributions of the standard library differ between its implementations; these do
/// not.
class Draw {
public:
  /// @param what  which quantity of the joint, so that its quantities are independent
  Draw(std::int64_t seed, std::uint64_t set, std::int64_t line, std::int64_t joint, std::uint64_t what);

  /// In (0, 1).
  double uniform();
  /// Mean 0, deviation 1 (Box and Muller, doi:10.1214/aoms/1177706645).
  double normal();

private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

/// A length: within [lowest_share, highest_share] of its mean, drawn again until it is.
double sample_length(const Scattered &length, Draw draw);

/// An angle, rad. Fisher: angle a between two directions with density ~ sin(a) exp(k cos(a)), inverse of its
/// distribution in closed form (doi:10.1098/rspa.1953.0064), to either side alike.
double sample_angle(const Scattered &angle, Draw draw);

} // namespace gcpdda::blockgen
