#pragma once

// Several doubles at once, one for each of as many contacts: as wide as the registers the build may use. What
// a lane holds never depends on its neighbours.

#include <cmath>
#include <cstddef>
#include <cstring>

namespace gcpdda {

#if defined(__AVX__)
constexpr std::size_t num_lanes = 4;
#else
constexpr std::size_t num_lanes = 2;
#endif

using LaneValues = double __attribute__((vector_size(num_lanes * sizeof(double))));
using LaneMask = decltype(LaneValues{} < LaneValues{});

/// True in the lanes where a comparison holds.
struct Mask {
  LaneMask bits;

  [[gnu::always_inline]] friend Mask operator&(const Mask &a, const Mask &b) { return {a.bits & b.bits}; }
  [[gnu::always_inline]] friend Mask operator|(const Mask &a, const Mask &b) { return {a.bits | b.bits}; }
  [[gnu::always_inline]] friend Mask operator!(const Mask &a) { return {~a.bits}; }
  [[nodiscard, gnu::always_inline]] bool any() const {
    auto all = bits[0];
    for (std::size_t i = 1; i < num_lanes; ++i) {
      all |= bits[i];
    }
    return all != 0;
  }
  [[nodiscard, gnu::always_inline]] bool operator[](std::size_t lane) const { return bits[lane] != 0; }
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

  [[gnu::always_inline]] friend Mask operator<(const Lanes &a, const Lanes &b) {
    return {a.values_ < b.values_};
  }
  [[gnu::always_inline]] friend Mask operator>(const Lanes &a, const Lanes &b) {
    return {a.values_ > b.values_};
  }
  [[gnu::always_inline]] friend Mask operator<=(const Lanes &a, const Lanes &b) {
    return {a.values_ <= b.values_};
  }
  [[gnu::always_inline]] friend Mask operator>=(const Lanes &a, const Lanes &b) {
    return {a.values_ >= b.values_};
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
  [[gnu::always_inline]] friend Lanes clamp(const Lanes &a, const Lanes &low, const Lanes &high) {
    return min(max(a, low), high);
  }
  [[gnu::always_inline]] friend Lanes abs(const Lanes &a) { return max(a, -a); }
  [[gnu::always_inline]] friend Lanes sqrt(const Lanes &a) {
    return of([&](std::size_t i) { return std::sqrt(a.values_[i]); });
  }

private:
  LaneValues values_;
};

/// Points or directions, one in each lane.
struct LaneVec {
  Lanes x;
  Lanes y;

  [[gnu::always_inline]] friend LaneVec operator+(const LaneVec &a, const LaneVec &b) {
    return {a.x + b.x, a.y + b.y};
  }
  [[gnu::always_inline]] friend LaneVec operator-(const LaneVec &a, const LaneVec &b) {
    return {a.x - b.x, a.y - b.y};
  }
  [[gnu::always_inline]] friend LaneVec operator-(const LaneVec &a) { return {-a.x, -a.y}; }
  [[gnu::always_inline]] friend LaneVec operator*(const Lanes &s, const LaneVec &a) {
    return {s * a.x, s * a.y};
  }
  [[gnu::always_inline]] LaneVec &operator+=(const LaneVec &b) { return x += b.x, y += b.y, *this; }
  [[gnu::always_inline]] friend Lanes dot(const LaneVec &a, const LaneVec &b) {
    return a.x * b.x + a.y * b.y;
  }
  [[gnu::always_inline]] friend LaneVec perp(const LaneVec &a) { return {-a.y, a.x}; }
  [[gnu::always_inline]] friend LaneVec select(const Mask &mask, const LaneVec &a, const LaneVec &b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y)};
  }
};

} // namespace gcpdda
