#pragma once

// Random numbers that depend on their address alone, and distributions that every compiler draws alike.

#include "model/fingerprint.hpp"

#include <cstdint>

namespace gcpdda {

/// Numbers that depend on their address alone: the k-th number of a draw is the same whoever asks, in
/// whatever order. The distributions of the standard library differ between its implementations; these do
/// not.
class Draw {
public:
  /// @param address  integers that tell what is drawn: which set, joint and quantity, say
  template <class... Part>
  Draw(std::int64_t seed, Part... address) : key_(scattered(static_cast<std::uint64_t>(seed))) {
    ((key_ = scattered(key_ ^ static_cast<std::uint64_t>(address))), ...);
  }

  /// In (0, 1).
  double uniform() {
    constexpr double unit = 0x1p-53;
    return (static_cast<double>(scattered(key_ + count_++) >> 11) + 0.5) * unit;
  }
  /// Mean 0, deviation 1 (Box and Muller, doi:10.1214/aoms/1177706645).
  double normal();

private:
  std::uint64_t key_;
  std::uint64_t count_ = 0;
};

} // namespace gcpdda
