#include "statics/spring_products.hpp"

#include <cstring>

namespace gcpdda::statics {

namespace {

float single(double value) {
  return static_cast<float>(value);
}

} // namespace

void SpringProducts::take(const ContactSprings &springs, SlipSprings of_slip, std::size_t width) {
  springs_.clear();
  fours_.clear();
  num_rigid_ = 0;
  springs.for_lists([&](std::span<const ContactSpring> list) {
    for (const ContactSpring &s : list) {
      const bool is_left_out = of_slip == SlipSprings::none_tangential && s.tangential < s.sticking;
      const double tangential = is_left_out ? 0.0 : s.tangential;
      if (width == 3) {
        append_rigid(s, tangential);
      } else {
        springs_.push_back({s.lower, s.higher, single(s.normal.x), single(s.normal.y), single(s.lower_arm.x),
                            single(s.lower_arm.y), single(s.higher_arm.x), single(s.higher_arm.y),
                            single(s.normal_stiffness), single(s.bending), single(tangential),
                            single(s.grip)});
      }
    }
  });
}

void SpringProducts::append_rigid(const ContactSpring &s, double tangential) {
  const std::size_t k = num_rigid_++ % 4;
  if (k == 0) {
    fours_.emplace_back();
  }
  FourSprings &four = fours_.back();
  const Vec2 t = perp(s.normal);
  four.lower[k] = s.lower;
  four.higher[k] = s.higher;
  four.normal_x[k] = single(s.normal.x);
  four.normal_y[k] = single(s.normal.y);
  four.lower_n[k] = single(cross(s.lower_arm, s.normal));
  four.higher_n[k] = single(cross(s.higher_arm, s.normal));
  four.lower_t[k] = single(cross(s.lower_arm, t));
  four.higher_t[k] = single(cross(s.higher_arm, t));
  four.normal_stiffness[k] = single(s.normal_stiffness);
  four.tangential[k] = single(tangential);
  four.bending[k] = single(s.bending);
}

namespace {

/// (u_x, u_y, r, 0) of four rows, or (u_x, u_y, r) of all four.
struct FourRows {
  Four a, b, c, d;
};

Four row_of(const LeanField &field, std::uint32_t row) {
  Four values;
  std::memcpy(&values, field.of(row), sizeof values);
  return values;
}
void add_to(LeanField &field, std::uint32_t row, const Four &values) {
  const Four sum = row_of(field, row) + values;
  std::memcpy(field.of(row), &sum, sizeof sum);
}

FourRows transposed(const FourRows &m) {
  const Four ab_low = __builtin_shufflevector(m.a, m.b, 0, 4, 1, 5);
  const Four ab_high = __builtin_shufflevector(m.a, m.b, 2, 6, 3, 7);
  const Four cd_low = __builtin_shufflevector(m.c, m.d, 0, 4, 1, 5);
  const Four cd_high = __builtin_shufflevector(m.c, m.d, 2, 6, 3, 7);
  return {__builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5),
          __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7),
          __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5),
          __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7)};
}

FourRows rows_of(const LeanField &p, const std::array<std::uint32_t, 4> &rows) {
  return transposed({row_of(p, rows[0]), row_of(p, rows[1]), row_of(p, rows[2]), row_of(p, rows[3])});
}

} // namespace

void SpringProducts::add_rigid(const LeanField &p, LeanField &y) const {
  for (const FourSprings &s : fours_) {
    const FourRows of_lower = rows_of(p, s.lower);
    const FourRows of_higher = rows_of(p, s.higher);
    const Four apart_x = of_lower.a - of_higher.a;
    const Four apart_y = of_lower.b - of_higher.b;
    const Four along_n = s.normal_stiffness * (s.normal_x * apart_x + s.normal_y * apart_y +
                                               s.lower_n * of_lower.c - s.higher_n * of_higher.c);
    const Four along_t = s.tangential * (s.normal_x * apart_y - s.normal_y * apart_x +
                                         s.lower_t * of_lower.c - s.higher_t * of_higher.c);
    const Four bent = s.bending * (of_lower.c - of_higher.c);
    const Four force_x = along_n * s.normal_x - along_t * s.normal_y;
    const Four force_y = along_n * s.normal_y + along_t * s.normal_x;
    const FourRows on_lower =
        transposed({force_x, force_y, s.lower_n * along_n + s.lower_t * along_t + bent, Four{}});
    const FourRows on_higher =
        transposed({-force_x, -force_y, -(s.higher_n * along_n + s.higher_t * along_t + bent), Four{}});
    add_to(y, s.lower[0], on_lower.a);
    add_to(y, s.higher[0], on_higher.a);
    add_to(y, s.lower[1], on_lower.b);
    add_to(y, s.higher[1], on_higher.b);
    add_to(y, s.lower[2], on_lower.c);
    add_to(y, s.higher[2], on_higher.c);
    add_to(y, s.lower[3], on_lower.d);
    add_to(y, s.higher[3], on_higher.d);
  }
}

void SpringProducts::add_any(const BlockSystem &system, const LeanField &p, LeanField &y) const {
  for (const Spring &s : springs_) {
    const bool lower_deforms = system.is_deformable(s.lower);
    const bool higher_deforms = system.is_deformable(s.higher);
    const PointMap a = motion_at(p.of(s.lower), lower_deforms);
    const PointMap b = motion_at(p.of(s.higher), higher_deforms);
    const Vec2 n{s.normal_x, s.normal_y};
    const Vec2 t = perp(n);
    const Vec2 lower_arm{s.lower_arm_x, s.lower_arm_y};
    const Vec2 higher_arm{s.higher_arm_x, s.higher_arm_y};
    const double grip = s.grip;
    const Vec2 apart = a.at(lower_arm) - b.at(higher_arm);
    const Vec2 strain = (a.gradient - b.gradient)(t);
    const double bent = s.bending * dot(n, strain);
    const double shear = s.tangential * (dot(t, apart) + grip * dot(t, strain));
    const Vec2 force = (s.normal_stiffness * dot(n, apart)) * n + shear * t;
    const Mat2 moment = bent * outer(n, t) + (grip * shear) * outer(t, t);
    add_force(y.of(s.lower), lower_deforms, force, outer(force, lower_arm) + moment);
    add_force(y.of(s.higher), higher_deforms, -force, -1.0 * (outer(force, higher_arm) + moment));
  }
}

void SpringProducts::add(const BlockSystem &system, const LeanField &p, LeanField &y) const {
  if (p.width() == lean_width(3)) {
    add_rigid(p, y);
  } else {
    add_any(system, p, y);
  }
}

} // namespace gcpdda::statics
