#pragma once

// 2x2 matrices, one in each lane.

#include "base/lanes.hpp"
#include "gcpdda/geometry/mat2.hpp"

#include <cstddef>

namespace gcpdda::GCPDDA_INSTRUCTIONS {

/// Mat2, one in each lane, with its operations in the same order: to the same bits.
struct LaneMat {
  FourLanes entry; ///< xx, xy, yx, yy

  /// Lane i holds *get(i).
  template <class Get> [[gnu::always_inline]] static LaneMat of(Get &&get) {
    LaneMat result;
    result.entry = load_by_lane([&](std::size_t i) { return &get(i)->xx; });
    return result;
  }
  [[gnu::always_inline]] static LaneMat identity() { return {{1.0, 0.0, 0.0, 1.0}}; }

  [[nodiscard, gnu::always_inline]] const Lanes &xx() const { return entry[0]; }
  [[nodiscard, gnu::always_inline]] const Lanes &xy() const { return entry[1]; }
  [[nodiscard, gnu::always_inline]] const Lanes &yx() const { return entry[2]; }
  [[nodiscard, gnu::always_inline]] const Lanes &yy() const { return entry[3]; }

  [[gnu::always_inline]] LaneVec operator()(const LaneVec &a) const {
    return {entry[0] * a.x + entry[1] * a.y, entry[2] * a.x + entry[3] * a.y};
  }
  [[gnu::always_inline]] friend LaneMat operator+(const LaneMat &a, const LaneMat &b) {
    return {{a.xx() + b.xx(), a.xy() + b.xy(), a.yx() + b.yx(), a.yy() + b.yy()}};
  }
  [[gnu::always_inline]] friend LaneMat operator-(const LaneMat &a, const LaneMat &b) {
    return {{a.xx() - b.xx(), a.xy() - b.xy(), a.yx() - b.yx(), a.yy() - b.yy()}};
  }
  [[gnu::always_inline]] friend LaneMat operator*(const Lanes &s, const LaneMat &a) {
    return {{s * a.xx(), s * a.xy(), s * a.yx(), s * a.yy()}};
  }
  [[gnu::always_inline]] friend LaneMat operator*(const LaneMat &a, const LaneMat &b) {
    return {{a.xx() * b.xx() + a.xy() * b.yx(), a.xx() * b.xy() + a.xy() * b.yy(),
             a.yx() * b.xx() + a.yy() * b.yx(), a.yx() * b.xy() + a.yy() * b.yy()}};
  }
  [[gnu::always_inline]] friend LaneMat transposed(const LaneMat &a) {
    return {{a.xx(), a.yx(), a.xy(), a.yy()}};
  }
  [[gnu::always_inline]] friend Lanes contract(const LaneMat &a, const LaneMat &b) {
    return a.xx() * b.xx() + a.xy() * b.xy() + a.yx() * b.yx() + a.yy() * b.yy();
  }
  [[gnu::always_inline]] friend Lanes determinant(const LaneMat &a) {
    return a.xx() * a.yy() - a.xy() * a.yx();
  }
  [[gnu::always_inline]] friend LaneMat inverse(const LaneMat &a) {
    const Lanes d = Lanes(1.0) / determinant(a);
    return {{d * a.yy(), -d * a.xy(), -d * a.yx(), d * a.xx()}};
  }
};

} // namespace gcpdda::GCPDDA_INSTRUCTIONS
