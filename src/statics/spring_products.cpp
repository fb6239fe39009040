#include "statics/spring_products.hpp"

#include <cstring>

namespace gcpdda::statics {

namespace {

float single(double value) {
  return static_cast<float>(value);
}

} // namespace

void SpringProducts::take(const BlockSystem &system, const ContactSprings &springs, SlipSprings of_slip,
                          std::size_t width) {
  rigid_.clear();
  straining_.clear();
  num_springs_ = 0;
  springs.for_lists([&](std::span<const ContactSpring> list) {
    for (const ContactSpring &s : list) {
      const bool is_left_out = of_slip == SlipSprings::none_tangential && s.tangential < s.sticking;
      const double tangential = is_left_out ? 0.0 : s.tangential;
      if (width == 3) {
        append_rigid(s, tangential);
      } else {
        append_straining(system, s, tangential);
      }
    }
  });
}

void SpringProducts::append_rigid(const ContactSpring &s, double tangential) {
  const std::size_t k = num_springs_++ % 4;
  if (k == 0) {
    rigid_.emplace_back();
  }
  FourSprings &four = rigid_.back();
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

void SpringProducts::append_straining(const BlockSystem &system, const ContactSpring &s, double tangential) {
  const std::size_t k = num_springs_++ % 4;
  if (k == 0) {
    straining_.emplace_back();
  }
  FourStraining &four = straining_.back();
  four.lower[k] = s.lower;
  four.higher[k] = s.higher;
  four.lower_deforms[k] = system.is_deformable(s.lower) ? 1.0F : 0.0F;
  four.higher_deforms[k] = system.is_deformable(s.higher) ? 1.0F : 0.0F;
  four.normal_x[k] = single(s.normal.x);
  four.normal_y[k] = single(s.normal.y);
  four.lower_x[k] = single(s.lower_arm.x);
  four.lower_y[k] = single(s.lower_arm.y);
  four.higher_x[k] = single(s.higher_arm.x);
  four.higher_y[k] = single(s.higher_arm.y);
  four.grip[k] = single(s.grip);
  four.normal_stiffness[k] = single(s.normal_stiffness);
  four.tangential[k] = single(tangential);
  four.bending[k] = single(s.bending);
}

namespace {

/// Four places of four rows, or a place of all four.
struct FourRows {
  Four a, b, c, d;
};

Four row_of(const LeanField &field, std::uint32_t row, std::size_t place = 0) {
  Four values;
  std::memcpy(&values, field.of(row) + place, sizeof values);
  return values;
}
void add_to(LeanField &field, std::uint32_t row, const Four &values, std::size_t place = 0) {
  const Four sum = row_of(field, row, place) + values;
  std::memcpy(field.of(row) + place, &sum, sizeof sum);
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

FourRows rows_of(const LeanField &p, const std::array<std::uint32_t, 4> &rows, std::size_t place = 0) {
  return transposed({row_of(p, rows[0], place), row_of(p, rows[1], place), row_of(p, rows[2], place),
                     row_of(p, rows[3], place)});
}

/// PointMap of four rows.
struct FourMaps {
  Four x, y, xx, xy, yx, yy;

  [[nodiscard]] Four x_at(const Four &arm_x, const Four &arm_y) const {
    return x + (xx * arm_x + xy * arm_y);
  }
  [[nodiscard]] Four y_at(const Four &arm_x, const Four &arm_y) const {
    return y + (yx * arm_x + yy * arm_y);
  }
};

FourMaps maps_of(const LeanField &p, const std::array<std::uint32_t, 4> &rows, const Four &deforms) {
  const FourRows first = rows_of(p, rows);
  const FourRows second = rows_of(p, rows, 4);
  const Four strain = deforms * first.c;
  const Four turn = first.c - strain;
  return {first.a, first.b, strain, first.d - turn, second.a + turn, second.b};
}

/// Force and dyad as they work on the freedoms of four rows, by row: the first four places, and the others.
struct FourForces {
  FourRows first, second;
};

FourForces on_rows(const FourMaps &force, const Four &deforms) {
  const Four moment = (1.0F - deforms) * (force.yx - force.xy);
  return {transposed({force.x, force.y, deforms * force.xx + moment, deforms * force.xy}),
          transposed({deforms * force.yx, deforms * force.yy, Four{}, Four{}})};
}

void add_to(LeanField &y, std::uint32_t row, const Four &first, const Four &second) {
  add_to(y, row, first);
  add_to(y, row, second, 4);
}

} // namespace

void SpringProducts::add_rigid(const LeanField &p, LeanField &y) const {
  for (const FourSprings &s : rigid_) {
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

void SpringProducts::add_straining(const LeanField &p, LeanField &y) const {
  for (const FourStraining &s : straining_) {
    const FourMaps a = maps_of(p, s.lower, s.lower_deforms);
    const FourMaps b = maps_of(p, s.higher, s.higher_deforms);
    const Four &n_x = s.normal_x;
    const Four &n_y = s.normal_y;
    const Four apart_x = a.x_at(s.lower_x, s.lower_y) - b.x_at(s.higher_x, s.higher_y);
    const Four apart_y = a.y_at(s.lower_x, s.lower_y) - b.y_at(s.higher_x, s.higher_y);
    const Four strain_x = (a.xy - b.xy) * n_x - (a.xx - b.xx) * n_y; // of the tangent
    const Four strain_y = (a.yy - b.yy) * n_x - (a.yx - b.yx) * n_y;
    const Four along_n = s.normal_stiffness * (n_x * apart_x + n_y * apart_y);
    const Four along_t =
        s.tangential * (n_x * (apart_y + s.grip * strain_y) - n_y * (apart_x + s.grip * strain_x));
    const Four bent = s.bending * (n_x * strain_x + n_y * strain_y);
    const Four force_x = along_n * n_x - along_t * n_y;
    const Four force_y = along_n * n_y + along_t * n_x;
    // Of the dyad that is no force at the middle, the column along the tangent.
    const Four gripped = s.grip * along_t;
    const Four of_t_x = bent * n_x - gripped * n_y;
    const Four of_t_y = bent * n_y + gripped * n_x;
    const auto force_at = [&](const Four &arm_x, const Four &arm_y) {
      return FourMaps{force_x,
                      force_y,
                      force_x * arm_x - of_t_x * n_y,
                      force_x * arm_y + of_t_x * n_x,
                      force_y * arm_x - of_t_y * n_y,
                      force_y * arm_y + of_t_y * n_x};
    };
    const FourForces on_lower = on_rows(force_at(s.lower_x, s.lower_y), s.lower_deforms);
    const FourForces on_higher = on_rows(force_at(s.higher_x, s.higher_y), s.higher_deforms);
    add_to(y, s.lower[0], on_lower.first.a, on_lower.second.a);
    add_to(y, s.higher[0], -on_higher.first.a, -on_higher.second.a);
    add_to(y, s.lower[1], on_lower.first.b, on_lower.second.b);
    add_to(y, s.higher[1], -on_higher.first.b, -on_higher.second.b);
    add_to(y, s.lower[2], on_lower.first.c, on_lower.second.c);
    add_to(y, s.higher[2], -on_higher.first.c, -on_higher.second.c);
    add_to(y, s.lower[3], on_lower.first.d, on_lower.second.d);
    add_to(y, s.higher[3], -on_higher.first.d, -on_higher.second.d);
  }
}

void SpringProducts::add(const LeanField &p, LeanField &y) const {
  if (p.width() == lean_width(3)) {
    add_rigid(p, y);
  } else {
    add_straining(p, y);
  }
}

} // namespace gcpdda::statics
