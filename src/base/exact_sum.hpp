#pragma once

// Sum of doubles that does not depend on their order: a fixed-point number of 70 digits of 32 bits that spans
// the whole range of double. Each digit sits in a signed 64-bit limb, so 2^30 summands fit before a carry is
// due and limbs of several ranks may be added as integers. Written sums are made this way, so that they are
// the same for any number of ranks. A summand goes whole into one number of 128 bits that begins with its
// lowest digit, and these are parted into limbs when limbs are asked for.

#include "base/check.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

namespace gcpdda {

__extension__ using SignedWide = __int128;

class ExactSum {
public:
  static constexpr int num_limbs = 70;

  /// value must be finite.
  void add(double value) {
    // |value| = mantissa * 2^(exponent - 1075), an integer of at most 53 bits: the fields of a binary64.
    const auto bits = std::bit_cast<std::uint64_t>(value);
    constexpr std::uint64_t hidden_bit = std::uint64_t{1} << 52;
    const std::uint64_t biased = (bits >> 52) & 0x7ff;
    expect(biased != 0x7ff, "summands are finite");
    const bool is_subnormal = biased == 0; // it has no hidden bit
    const std::uint64_t mantissa = (bits & (hidden_bit - 1)) | (is_subnormal ? 0 : hidden_bit);
    const std::uint64_t shift = biased + (is_subnormal ? 1 : 0) + offset - 1075;
    const auto magnitude = static_cast<SignedWide>(mantissa) << (shift % 32); // below 2^84
    const bool is_negative = bits >> 63 != 0;
    added_[shift / 32] += is_negative ? -magnitude : magnitude;
  }

  /// For adding the limbs of all ranks.
  [[nodiscard]] std::span<std::int64_t, num_limbs> limbs() {
    part();
    return limbs_;
  }

  /// The sum, rounded the same way for equal sums.
  [[nodiscard]] double value() const {
    ExactSum parted = *this;
    parted.part();
    std::array<std::int64_t, num_limbs> &digits = parted.limbs_;
    // Canonical digits in [0, 2^32), the sign in the last one.
    for (std::size_t k = 0; k + 1 < digits.size(); ++k) {
      const std::int64_t carry = digits[k] >> 32;
      digits[k] -= carry * (std::int64_t{1} << 32);
      digits[k + 1] += carry;
    }
    if (digits.back() < 0) {
      ExactSum opposite;
      for (std::size_t k = 0; k < limbs_.size(); ++k) {
        opposite.limbs_[k] = -digits[k];
      }
      return -opposite.value();
    }
    double sum = 0.0;
    for (std::size_t k = digits.size(); k-- > 0;) {
      if (digits[k] != 0) {
        sum +=
            std::ldexp(static_cast<double>(digits[k]), static_cast<int>(32 * k) - static_cast<int>(offset));
      }
    }
    return sum;
  }

private:
  /// Puts the last bit of the smallest subnormal, 2^-1074, above bit 0.
  static constexpr std::uint64_t offset = 1152;

  void part() {
    SignedWide carry = 0;
    for (std::size_t k = 0; k < limbs_.size(); ++k) {
      carry += added_[k];
      const auto digit = static_cast<std::int64_t>(static_cast<std::uint64_t>(carry) & 0xffffffffU);
      limbs_[k] += digit;
      carry = (carry - digit) >> 32;
      added_[k] = 0;
    }
    limbs_.back() += static_cast<std::int64_t>(carry) * (std::int64_t{1} << 32);
  }

  std::array<SignedWide, num_limbs> added_{};
  std::array<std::int64_t, num_limbs> limbs_{};
};

} // namespace gcpdda
