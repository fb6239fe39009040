#pragma once

// How the two blocks of a pair move against each other at a point.

#include "contact/candidates.hpp"
#include "contact/region_sums.hpp"

#include <algorithm>
#include <vector>

namespace gcpdda {

/// Lists that are filled anew in each step do not shrink.
template <class T> void grow(std::vector<T> &list, std::size_t size) {
  if (list.size() < size) {
    list.resize(size);
  }
}

/// Motion of the material point now at offset r from the trial centroid since the last trial configuration.
inline Vec2 increment_at(const TrialIncrement &step, Vec2 r) {
  return step.u + step.turn(r);
}

/// Motion of the lower block's material point now at x relative to the higher one's.
inline Vec2 slide_at(const BlockSystem &system, const CandidatePair &pair, Vec2 x) {
  const auto of = [&](BlockIndex row) {
    return increment_at(system.increment_of(row.value), x - system.motion[row.value].centroid);
  };
  return of(pair.lower) - of(pair.higher);
}

inline void add_force(RegionForce &force, Vec2 at, Vec2 f) {
  force.force += f;
  force.dyad += outer(at - force.origin, f);
}

/// Relative velocity of two blocks as a field: v(x) = at_origin + gradient (x - origin).
struct RelativeVelocity {
  Vec2 at_origin;
  Mat2 gradient;

  RelativeVelocity(const BlockSystem &system, const CandidatePair &pair, Vec2 origin) {
    add(system, pair.lower.value, origin, 1.0);
    add(system, pair.higher.value, origin, -1.0);
  }
  [[nodiscard]] Vec2 at(Vec2 from_origin) const { return at_origin + gradient(from_origin); }

private:
  void add(const BlockSystem &system, std::size_t row, Vec2 origin, double sign) {
    const RigidDof &v = system.velocity[row];
    const Vec2 arm = origin - system.motion[row].centroid;
    if (system.is_deformable(row)) {
      const Mat2 own = system.deformation_of(row).rate * system.trial_inverse[system.deformation_begin[row]];
      at_origin += sign * (v.u + own(arm));
      gradient += sign * own;
    } else {
      at_origin += sign * (v.u + v.r * perp(arm));
      gradient.xy -= sign * v.r;
      gradient.yx += sign * v.r;
    }
  }
};

/// int q ds and int q s ds of q = max(-p, d) over [0, length], p >= 0 and d linear with the given end values.
struct TractionIntegral {
  double total = 0.0;
  double along = 0.0;

  void add_linear(double s0, double q0, double s1, double q1) {
    const double length = s1 - s0;
    const double stretch = 0.5 * length * (q0 + q1);
    total += stretch;
    along += s0 * stretch + length * length * (q0 + 2.0 * q1) / 6.0;
  }
};

inline TractionIntegral integrate_without_tension(double length, double p0, double p1, double d0, double d1) {
  TractionIntegral q;
  const double sum0 = p0 + d0;
  const double sum1 = p1 + d1;
  if (sum0 >= 0.0 && sum1 >= 0.0) {
    q.add_linear(0.0, d0, length, d1);
  } else if (sum0 <= 0.0 && sum1 <= 0.0) {
    q.add_linear(0.0, -p0, length, -p1);
  } else {
    const double share = sum0 / (sum0 - sum1);
    const double cut = share * length;
    const double p_cut = p0 + share * (p1 - p0);
    q.add_linear(0.0, std::max(-p0, d0), cut, -p_cut);
    q.add_linear(cut, -p_cut, length, std::max(-p1, d1));
  }
  return q;
}

} // namespace gcpdda
