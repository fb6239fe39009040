#pragma once

// Several doubles at once, one for each of as many contacts or blocks. What a lane holds never depends on its
// neighbours.
//
// This and all that is made of it is compiled once for each set of instructions (plain_batch_*.cpp,
// block_lanes_*.cpp), in a namespace of that set's name: GCPDDA_INSTRUCTIONS, with GCPDDA_NUM_LANES
// doubles in a register.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#if GCPDDA_NUM_LANES == 8
#include <immintrin.h>
#endif

namespace gcpdda::GCPDDA_INSTRUCTIONS {

constexpr std::size_t num_lanes = GCPDDA_NUM_LANES;

using LaneValues = double __attribute__((vector_size(num_lanes * sizeof(double))));
/// As they stand in memory, where they need not begin with a register's worth. Registers are read and written
/// by this: a std::memcpy() becomes one by halves, and the processor waits for both before it reads the
/// whole.
using UnalignedValues [[gnu::may_alias, gnu::aligned(sizeof(double))]] = LaneValues;
#if GCPDDA_NUM_LANES == 8 // registers of masks have a bit a lane
using LaneMask = __mmask8;
// Intrinsics without a mask are warned about (g++ bug 105593).
constexpr LaneMask all_lanes = 0xff;
#else
using LaneMask = decltype(LaneValues{} < LaneValues{});
#endif

/// True in the lanes where a comparison holds.
struct Mask {
  LaneMask bits;

  [[gnu::always_inline]] friend Mask operator&(const Mask &a, const Mask &b) { return of(a.bits & b.bits); }
  [[gnu::always_inline]] friend Mask operator|(const Mask &a, const Mask &b) { return of(a.bits | b.bits); }
  [[gnu::always_inline]] friend Mask operator^(const Mask &a, const Mask &b) { return of(a.bits ^ b.bits); }
  [[gnu::always_inline]] friend Mask operator!(const Mask &a) { return of(~a.bits); }
  /// Bit i is lane i.
  [[nodiscard, gnu::always_inline]] unsigned by_lane() const {
#if GCPDDA_NUM_LANES == 8
    return bits;
#elif defined(__x86_64__) && GCPDDA_NUM_LANES == 4
    return static_cast<unsigned>(__builtin_ia32_movmskpd256(reinterpret_cast<LaneValues>(bits)));
#elif defined(__x86_64__)
    return static_cast<unsigned>(__builtin_ia32_movmskpd(reinterpret_cast<LaneValues>(bits)));
#else
    unsigned all = 0;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      all |= bits[i] != 0 ? 1U << i : 0U;
    }
    return all;
#endif
  }
  [[nodiscard, gnu::always_inline]] bool any() const {
    return by_lane() != 0;
  }

  /// True where bit i is set.
  [[gnu::always_inline]] static Mask from(unsigned bits) {
#if GCPDDA_NUM_LANES == 8
    return {static_cast<LaneMask>(bits)};
#else
    Mask result;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      result.bits[i] = (bits >> i & 1U) != 0 ? -1 : 0;
    }
    return result;
#endif
  }

private:
  template <class Bits> [[gnu::always_inline]] static Mask of(const Bits &bits) {
    return {static_cast<LaneMask>(bits)};
  }
};

class Lanes {
public:
  Lanes() = default;
  [[gnu::always_inline]] Lanes(double a) : values_(LaneValues{} + a) {} // a number stands for all lanes
  [[gnu::always_inline]] explicit Lanes(const LaneValues &values) : values_(values) {}
  /// Lane i holds get(i).
  template <class Get> [[gnu::always_inline]] static Lanes of(Get &&get) {
    Lanes result;
    for (std::size_t i = 0; i < num_lanes; ++i) {
      result.values_[i] = get(i);
    }
    return result;
  }
  [[nodiscard, gnu::always_inline]] double operator[](std::size_t lane) const { return values_[lane]; }

  [[gnu::always_inline]] friend Lanes operator+(const Lanes &a, const Lanes &b) {
    return Lanes(a.values_ + b.values_);
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes &a, const Lanes &b) {
    return Lanes(a.values_ - b.values_);
  }
  [[gnu::always_inline]] friend Lanes operator-(const Lanes &a) { return Lanes(-a.values_); }
  [[gnu::always_inline]] friend Lanes operator*(const Lanes &a, const Lanes &b) {
    return Lanes(a.values_ * b.values_);
  }
  [[gnu::always_inline]] friend Lanes operator/(const Lanes &a, const Lanes &b) {
    return Lanes(a.values_ / b.values_);
  }
  [[gnu::always_inline]] Lanes &operator+=(const Lanes &b) { return *this = *this + b; }

#if GCPDDA_NUM_LANES == 8
  [[gnu::always_inline]] friend Mask operator<(const Lanes &a, const Lanes &b) {
    return {_mm512_cmp_pd_mask(a.values_, b.values_, _CMP_LT_OS)};
  }
  [[gnu::always_inline]] friend Mask operator<=(const Lanes &a, const Lanes &b) {
    return {_mm512_cmp_pd_mask(a.values_, b.values_, _CMP_LE_OS)};
  }
  [[gnu::always_inline]] friend Mask operator==(const Lanes &a, const Lanes &b) {
    return {_mm512_cmp_pd_mask(a.values_, b.values_, _CMP_EQ_OQ)};
  }
  /// a where the mask is true, else b.
  [[gnu::always_inline]] friend Lanes select(const Mask &mask, const Lanes &a, const Lanes &b) {
    return Lanes(_mm512_mask_blend_pd(mask.bits, b.values_, a.values_));
  }
  [[gnu::always_inline]] friend Lanes min(const Lanes &a, const Lanes &b) {
    return Lanes(_mm512_mask_min_pd(a.values_, all_lanes, a.values_, b.values_));
  }
  [[gnu::always_inline]] friend Lanes max(const Lanes &a, const Lanes &b) {
    return Lanes(_mm512_mask_max_pd(a.values_, all_lanes, a.values_, b.values_));
  }
#else
  [[gnu::always_inline]] friend Mask operator<(const Lanes &a, const Lanes &b) {
    return {a.values_ < b.values_};
  }
  [[gnu::always_inline]] friend Mask operator<=(const Lanes &a, const Lanes &b) {
    return {a.values_ <= b.values_};
  }
  [[gnu::always_inline]] friend Mask operator==(const Lanes &a, const Lanes &b) {
    return {a.values_ == b.values_};
  }
  /// a where the mask is true, else b.
  [[gnu::always_inline]] friend Lanes select(const Mask &mask, const Lanes &a, const Lanes &b) {
    return Lanes(mask.bits ? a.values_ : b.values_);
  }
  [[gnu::always_inline]] friend Lanes min(const Lanes &a, const Lanes &b) {
    return Lanes(a.values_ < b.values_ ? a.values_ : b.values_);
  }
  [[gnu::always_inline]] friend Lanes max(const Lanes &a, const Lanes &b) {
    return Lanes(a.values_ > b.values_ ? a.values_ : b.values_);
  }
#endif
  [[gnu::always_inline]] friend Mask operator>(const Lanes &a, const Lanes &b) {
    return b < a;
  }
  [[gnu::always_inline]] friend Mask operator>=(const Lanes &a, const Lanes &b) {
    return b <= a;
  }
  [[gnu::always_inline]] friend Lanes clamp(const Lanes &a, const Lanes &low, const Lanes &high) {
    return min(max(a, low), high);
  }
  [[gnu::always_inline]] friend Lanes abs(const Lanes &a) {
    return max(a, -a);
  }
  [[gnu::always_inline]] friend Lanes sqrt(const Lanes &a) {
#if GCPDDA_NUM_LANES == 8
    return Lanes(_mm512_mask_sqrt_pd(a.values_, all_lanes, a.values_));
#elif defined(__x86_64__) && GCPDDA_NUM_LANES == 4
    return Lanes(__builtin_ia32_sqrtpd256(a.values_));
#elif defined(__x86_64__)
    return Lanes(__builtin_ia32_sqrtpd(a.values_));
#else
    return of([&](std::size_t i) { return std::sqrt(a.values_[i]); });
#endif
  }
  [[nodiscard, gnu::always_inline]] const LaneValues &values() const {
    return values_;
  }

private:
  LaneValues values_;
};

#if GCPDDA_NUM_LANES == 8
/// One after the other.
using TwoValues = double __attribute__((vector_size(2 * sizeof(double))));
[[gnu::always_inline]] inline __m256d joined(const TwoValues &a, const TwoValues &b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3);
}
[[gnu::always_inline]] inline LaneValues joined(const __m256d &a, const __m256d &b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
/// a[0], b[0], a[2], b[2] ...
[[gnu::always_inline]] inline LaneValues interleaved_even(const LaneValues &a, const LaneValues &b) {
  return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
}
/// a[1], b[1], a[3], b[3] ...
[[gnu::always_inline]] inline LaneValues interleaved_odd(const LaneValues &a, const LaneValues &b) {
  return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
}
#endif

/// Points or directions, one in each lane.
struct LaneVec {
  Lanes x;
  Lanes y;

  /// Lane i holds *get(i).
  template <class Get> [[gnu::always_inline]] static LaneVec of(Get &&get) {
    using Point = double __attribute__((vector_size(2 * sizeof(double))));
    const auto load = [&](std::size_t i) __attribute__((always_inline)) {
      Point point;
      std::memcpy(&point, get(i), sizeof(point));
      return point;
    };
#if GCPDDA_NUM_LANES == 8
    const auto load_four = [&](std::size_t first) __attribute__((always_inline)) {
      return joined(joined(load(first), load(first + 2)), joined(load(first + 4), load(first + 6)));
    };
    const LaneValues even = load_four(0);
    const LaneValues odd = load_four(1);
    return {Lanes(interleaved_even(even, odd)), Lanes(interleaved_odd(even, odd))};
#elif GCPDDA_NUM_LANES == 4
    const LaneValues even = __builtin_shufflevector(load(0), load(2), 0, 1, 2, 3);
    const LaneValues odd = __builtin_shufflevector(load(1), load(3), 0, 1, 2, 3);
    return {Lanes(__builtin_shufflevector(even, odd, 0, 4, 2, 6)),
            Lanes(__builtin_shufflevector(even, odd, 1, 5, 3, 7))};
#else
    const LaneValues first = load(0);
    const LaneValues second = load(1);
    return {Lanes(__builtin_shufflevector(first, second, 0, 2)),
            Lanes(__builtin_shufflevector(first, second, 1, 3))};
#endif
  }

  [[gnu::always_inline]] friend LaneVec operator+(const LaneVec &a, const LaneVec &b) {
    return {a.x + b.x, a.y + b.y};
  }
  [[gnu::always_inline]] friend LaneVec operator-(const LaneVec &a, const LaneVec &b) {
    return {a.x - b.x, a.y - b.y};
  }
  [[gnu::always_inline]] friend LaneVec operator-(const LaneVec &a) {
    return {-a.x, -a.y};
  }
  [[gnu::always_inline]] friend LaneVec operator*(const Lanes &s, const LaneVec &a) {
    return {s * a.x, s * a.y};
  }
  [[gnu::always_inline]] LaneVec &operator+=(const LaneVec &b) {
    return x += b.x, y += b.y, *this;
  }
  [[gnu::always_inline]] friend Lanes dot(const LaneVec &a, const LaneVec &b) {
    return a.x * b.x + a.y * b.y;
  }
  [[gnu::always_inline]] friend Lanes cross(const LaneVec &a, const LaneVec &b) {
    return a.x * b.y - a.y * b.x;
  }
  [[gnu::always_inline]] friend LaneVec perp(const LaneVec &a) {
    return {-a.y, a.x};
  }
  [[gnu::always_inline]] friend LaneVec select(const Mask &mask, const LaneVec &a, const LaneVec &b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y)};
  }
};

/// Four numbers that stand together, by number and lane.
using FourLanes = std::array<Lanes, 4>;

/// Lane i holds those from get(i) on.
template <class Get> [[gnu::always_inline]] inline FourLanes load_by_lane(Get &&get) {
#if GCPDDA_NUM_LANES == 8
  const auto load = [&](std::size_t low, std::size_t high) __attribute__((always_inline)) {
    return joined(_mm256_loadu_pd(get(low)), _mm256_loadu_pd(get(high)));
  };
  const LaneValues rows_02 = load(0, 2);
  const LaneValues rows_13 = load(1, 3);
  const LaneValues rows_46 = load(4, 6);
  const LaneValues rows_57 = load(5, 7);
  // Two lanes at a time: entries 0 and 2, then 1 and 3.
  const LaneValues even_0123 = interleaved_even(rows_02, rows_13);
  const LaneValues even_4567 = interleaved_even(rows_46, rows_57);
  const LaneValues odd_0123 = interleaved_odd(rows_02, rows_13);
  const LaneValues odd_4567 = interleaved_odd(rows_46, rows_57);
  return {Lanes(__builtin_shufflevector(even_0123, even_4567, 0, 1, 4, 5, 8, 9, 12, 13)),
          Lanes(__builtin_shufflevector(odd_0123, odd_4567, 0, 1, 4, 5, 8, 9, 12, 13)),
          Lanes(__builtin_shufflevector(even_0123, even_4567, 2, 3, 6, 7, 10, 11, 14, 15)),
          Lanes(__builtin_shufflevector(odd_0123, odd_4567, 2, 3, 6, 7, 10, 11, 14, 15))};
#elif GCPDDA_NUM_LANES == 4
  const LaneValues row[] = {
      *reinterpret_cast<const UnalignedValues *>(get(0)), *reinterpret_cast<const UnalignedValues *>(get(1)),
      *reinterpret_cast<const UnalignedValues *>(get(2)), *reinterpret_cast<const UnalignedValues *>(get(3))};
  const LaneValues even_01 = __builtin_shufflevector(row[0], row[1], 0, 4, 2, 6);
  const LaneValues odd_01 = __builtin_shufflevector(row[0], row[1], 1, 5, 3, 7);
  const LaneValues even_23 = __builtin_shufflevector(row[2], row[3], 0, 4, 2, 6);
  const LaneValues odd_23 = __builtin_shufflevector(row[2], row[3], 1, 5, 3, 7);
  return {Lanes(__builtin_shufflevector(even_01, even_23, 0, 1, 4, 5)),
          Lanes(__builtin_shufflevector(odd_01, odd_23, 0, 1, 4, 5)),
          Lanes(__builtin_shufflevector(even_01, even_23, 2, 3, 6, 7)),
          Lanes(__builtin_shufflevector(odd_01, odd_23, 2, 3, 6, 7))};
#else
  const LaneVec first = LaneVec::of([&](std::size_t i) { return get(i); });
  const LaneVec second = LaneVec::of([&](std::size_t i) { return get(i) + 2; });
  return {first.x, first.y, second.x, second.y};
#endif
}

/// Lane i of a, b, c and d one after the other at to[i] + offset.
[[gnu::always_inline]] inline void store_by_lane(const std::array<std::byte *, num_lanes> &to,
                                                 std::size_t offset, const Lanes &a, const Lanes &b,
                                                 const Lanes &c, const Lanes &d) {
#if GCPDDA_NUM_LANES == 8
  const auto put = [&](std::size_t low, std::size_t high, const LaneValues &rows)
      __attribute__((always_inline)) {
    _mm256_storeu_pd(reinterpret_cast<double *>(to[low] + offset),
                     __builtin_shufflevector(rows, rows, 0, 1, 2, 3));
    _mm256_storeu_pd(reinterpret_cast<double *>(to[high] + offset),
                     __builtin_shufflevector(rows, rows, 4, 5, 6, 7));
  };
  const LaneValues ab_even = interleaved_even(a.values(), b.values());
  const LaneValues ab_odd = interleaved_odd(a.values(), b.values());
  const LaneValues cd_even = interleaved_even(c.values(), d.values());
  const LaneValues cd_odd = interleaved_odd(c.values(), d.values());
  put(0, 2, __builtin_shufflevector(ab_even, cd_even, 0, 1, 8, 9, 2, 3, 10, 11));
  put(1, 3, __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 8, 9, 2, 3, 10, 11));
  put(4, 6, __builtin_shufflevector(ab_even, cd_even, 4, 5, 12, 13, 6, 7, 14, 15));
  put(5, 7, __builtin_shufflevector(ab_odd, cd_odd, 4, 5, 12, 13, 6, 7, 14, 15));
#else
  const auto put = [&](std::size_t lane, const LaneValues &row, std::size_t behind = 0)
      __attribute__((always_inline)) {
    *reinterpret_cast<UnalignedValues *>(to[lane] + offset + behind) = row;
  };
#if GCPDDA_NUM_LANES == 4
  const LaneValues ab_even = __builtin_shufflevector(a.values(), b.values(), 0, 4, 2, 6);
  const LaneValues ab_odd = __builtin_shufflevector(a.values(), b.values(), 1, 5, 3, 7);
  const LaneValues cd_even = __builtin_shufflevector(c.values(), d.values(), 0, 4, 2, 6);
  const LaneValues cd_odd = __builtin_shufflevector(c.values(), d.values(), 1, 5, 3, 7);
  put(0, __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5));
  put(1, __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5));
  put(2, __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7));
  put(3, __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7));
#else
  put(0, __builtin_shufflevector(a.values(), b.values(), 0, 2), 0);
  put(0, __builtin_shufflevector(c.values(), d.values(), 0, 2), sizeof(LaneValues));
  put(1, __builtin_shufflevector(a.values(), b.values(), 1, 3), 0);
  put(1, __builtin_shufflevector(c.values(), d.values(), 1, 3), sizeof(LaneValues));
#endif
#endif
}

/// Lane i of a and b one after the other at to[i] + offset.
[[gnu::always_inline]] inline void store_pairs(const std::array<std::byte *, num_lanes> &to,
                                               std::size_t offset, const Lanes &a, const Lanes &b) {
  const auto put = [&](std::size_t lane, const auto &two) __attribute__((always_inline)) {
    std::memcpy(to[lane] + offset, &two, 2 * sizeof(double));
  };
#if GCPDDA_NUM_LANES == 8
  const LaneValues even = interleaved_even(a.values(), b.values());
  const LaneValues odd = interleaved_odd(a.values(), b.values());
  const auto put_four = [&](std::size_t first, const LaneValues &rows) __attribute__((always_inline)) {
    put(first, __builtin_shufflevector(rows, rows, 0, 1));
    put(first + 2, __builtin_shufflevector(rows, rows, 2, 3));
    put(first + 4, __builtin_shufflevector(rows, rows, 4, 5));
    put(first + 6, __builtin_shufflevector(rows, rows, 6, 7));
  };
  put_four(0, even);
  put_four(1, odd);
#elif GCPDDA_NUM_LANES == 4
  put(0, __builtin_shufflevector(a.values(), b.values(), 0, 4));
  put(1, __builtin_shufflevector(a.values(), b.values(), 1, 5));
  put(2, __builtin_shufflevector(a.values(), b.values(), 2, 6));
  put(3, __builtin_shufflevector(a.values(), b.values(), 3, 7));
#else
  put(0, __builtin_shufflevector(a.values(), b.values(), 0, 2));
  put(1, __builtin_shufflevector(a.values(), b.values(), 1, 3));
#endif
}

/// Three numbers that stand together, by number and lane.
using ThreeLanes = std::array<Lanes, 3>;

/// Lane i holds the three from 3 i on.
[[gnu::always_inline]] inline ThreeLanes load_triples(const double *first) {
  const UnalignedValues *three = reinterpret_cast<const UnalignedValues *>(first);
  const LaneValues a = three[0];
  const LaneValues b = three[1];
  const LaneValues c = three[2];
#if GCPDDA_NUM_LANES == 8
  const LaneValues x = __builtin_shufflevector(a, b, 0, 3, 6, 9, 12, 15, -1, -1);
  const LaneValues y = __builtin_shufflevector(a, b, 1, 4, 7, 10, 13, -1, -1, -1);
  const LaneValues z = __builtin_shufflevector(a, b, 2, 5, 8, 11, 14, -1, -1, -1);
  return {Lanes(__builtin_shufflevector(x, c, 0, 1, 2, 3, 4, 5, 10, 13)),
          Lanes(__builtin_shufflevector(y, c, 0, 1, 2, 3, 4, 8, 11, 14)),
          Lanes(__builtin_shufflevector(z, c, 0, 1, 2, 3, 4, 9, 12, 15))};
#elif GCPDDA_NUM_LANES == 4
  const LaneValues x = __builtin_shufflevector(a, b, 0, 3, 6, -1);
  const LaneValues y = __builtin_shufflevector(a, b, 1, 4, 7, -1);
  const LaneValues z = __builtin_shufflevector(a, b, 2, 5, -1, -1);
  return {Lanes(__builtin_shufflevector(x, c, 0, 1, 2, 5)), Lanes(__builtin_shufflevector(y, c, 0, 1, 2, 6)),
          Lanes(__builtin_shufflevector(z, c, 0, 1, 4, 7))};
#else
  return {Lanes(__builtin_shufflevector(a, b, 0, 3)), Lanes(__builtin_shufflevector(a, c, 1, 2)),
          Lanes(__builtin_shufflevector(b, c, 0, 3))};
#endif
}

/// And back.
[[gnu::always_inline]] inline void store_triples(double *first, const ThreeLanes &lanes) {
  const LaneValues &x = lanes[0].values();
  const LaneValues &y = lanes[1].values();
  const LaneValues &z = lanes[2].values();
  UnalignedValues *three = reinterpret_cast<UnalignedValues *>(first);
#if GCPDDA_NUM_LANES == 8
  const LaneValues a = __builtin_shufflevector(x, y, 0, 8, -1, 1, 9, -1, 2, 10);
  const LaneValues b = __builtin_shufflevector(x, y, -1, 3, 11, -1, 4, 12, -1, 5);
  const LaneValues c = __builtin_shufflevector(x, y, 13, -1, 6, 14, -1, 7, 15, -1);
  three[0] = __builtin_shufflevector(a, z, 0, 1, 8, 3, 4, 9, 6, 7);
  three[1] = __builtin_shufflevector(b, z, 10, 1, 2, 11, 4, 5, 12, 7);
  three[2] = __builtin_shufflevector(c, z, 0, 13, 2, 3, 14, 5, 6, 15);
#elif GCPDDA_NUM_LANES == 4
  const LaneValues a = __builtin_shufflevector(x, y, 0, 4, -1, 1);
  const LaneValues b = __builtin_shufflevector(x, y, 5, -1, 2, 6);
  const LaneValues c = __builtin_shufflevector(x, y, -1, 3, 7, -1);
  three[0] = __builtin_shufflevector(a, z, 0, 1, 4, 3);
  three[1] = __builtin_shufflevector(b, z, 0, 5, 2, 3);
  three[2] = __builtin_shufflevector(c, z, 6, 1, 2, 7);
#else
  three[0] = __builtin_shufflevector(x, y, 0, 2);
  three[1] = __builtin_shufflevector(z, x, 0, 3);
  three[2] = __builtin_shufflevector(y, z, 1, 3);
#endif
}

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
