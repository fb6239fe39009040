#pragma once

// Sum of doubles that does not depend on their order: a fixed-point number of 70 digits of 32 bits that spans
// the whole range of double. Each digit sits in a signed 64-bit limb, so 2^30 summands fit before a carry is
// due and limbs of several ranks may be added as integers. Written sums are made this way, so that they are
// the same for any number of ranks.

#include "base/check.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace gcpdda {

__extension__ using Wide = unsigned __int128;

class ExactSum {
public:
  static constexpr int num_limbs = 70;

  /// value must be finite.
  void add(double value) {
    // |value| = mantissa * 2^(exponent - 1075), an integer of at most 53 bits: the fields of a binary64.
    const auto bits = std::bit_cast<std::uint64_t>(value);
    constexpr std::uint64_t hidden_bit = std::uint64_t{1} << 52;
    const auto biased = static_cast<int>((bits >> 52) & 0x7ff);
    expect(biased != 0x7ff, "summands are finite");
    const int exponent = biased == 0 ? 1 : biased; // a subnormal has no hidden bit
    const std::uint64_t mantissa = (bits & (hidden_bit - 1)) | (biased == 0 ? 0 : hidden_bit);
    if (mantissa == 0) {
      return;
    }
    const int shift = exponent - 1075 + offset;
    const auto limb = static_cast<std::size_t>(shift / 32);
    const bool negative = bits >> 63 != 0;
    const auto magnitude = static_cast<Wide>(mantissa) << (shift % 32);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto digit =
          static_cast<std::int64_t>(static_cast<std::uint64_t>(magnitude >> (32 * k)) & 0xffffffffU);
      limbs_[limb + k] += negative ? -digit : digit;
    }
  }

  /// For adding the limbs of all ranks.
  [[nodiscard]] std::span<std::int64_t, num_limbs> limbs() { return limbs_; }

  /// The sum, rounded the same way for equal sums.
  [[nodiscard]] double value() const {
    std::array<std::int64_t, num_limbs> digits = limbs_;
    // Canonical digits in [0, 2^32), the sign in the last one.
    for (std::size_t k = 0; k + 1 < digits.size(); ++k) {
      const std::int64_t carry = digits[k] >> 32;
      digits[k] -= carry * (std::int64_t{1} << 32);
      digits[k + 1] += carry;
    }
    if (digits.back() < 0) {
      ExactSum opposite;
      for (std::size_t k = 0; k < limbs_.size(); ++k) {
        opposite.limbs_[k] = -limbs_[k];
      }
      return -opposite.value();
    }
    double sum = 0.0;
    for (std::size_t k = digits.size(); k-- > 0;) {
      sum += std::ldexp(static_cast<double>(digits[k]), static_cast<int>(32 * k) - offset);
    }
    return sum;
  }

private:
  static constexpr int offset = 1152; ///< puts the last bit of the smallest subnormal, 2^-1074, above bit 0
  std::array<std::int64_t, num_limbs> limbs_{};
};

} // namespace gcpdda
