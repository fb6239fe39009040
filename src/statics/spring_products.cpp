#include "statics/spring_products.hpp"

namespace gcpdda::statics {

namespace {

LeanSpring lean(const ContactSpring &s, double tangential) {
  const auto single = [](double value) { return static_cast<float>(value); };
  return {s.lower,
          s.higher,
          single(s.normal.x),
          single(s.normal.y),
          single(s.lower_arm.x),
          single(s.lower_arm.y),
          single(s.higher_arm.x),
          single(s.higher_arm.y),
          single(s.normal_stiffness),
          single(s.bending),
          single(tangential),
          single(s.grip)};
}

void add_rigid(std::span<const LeanSpring> springs, const Field &p, Field &y) {
  for (const LeanSpring &s : springs) {
    const double *const a = p.of(s.lower);
    const double *const b = p.of(s.higher);
    const Vec2 n{s.normal_x, s.normal_y};
    const Vec2 t = perp(n);
    const Vec2 lower_arm{s.lower_arm_x, s.lower_arm_y};
    const Vec2 higher_arm{s.higher_arm_x, s.higher_arm_y};
    const double lower_n = cross(lower_arm, n);
    const double higher_n = cross(higher_arm, n);
    const double lower_t = cross(lower_arm, t);
    const double higher_t = cross(higher_arm, t);
    const Vec2 apart{a[0] - b[0], a[1] - b[1]};
    const double along_n = s.normal_stiffness * (dot(n, apart) + lower_n * a[2] - higher_n * b[2]);
    const double along_t = s.tangential * (dot(t, apart) + lower_t * a[2] - higher_t * b[2]);
    const double bent = s.bending * (a[2] - b[2]);
    const Vec2 force = along_n * n + along_t * t;
    double *const to_a = y.of(s.lower);
    double *const to_b = y.of(s.higher);
    to_a[0] += force.x;
    to_a[1] += force.y;
    to_a[2] += lower_n * along_n + lower_t * along_t + bent;
    to_b[0] -= force.x;
    to_b[1] -= force.y;
    to_b[2] -= higher_n * along_n + higher_t * along_t + bent;
  }
}

void add_any(const BlockSystem &system, std::span<const LeanSpring> springs, const Field &p, Field &y) {
  for (const LeanSpring &s : springs) {
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

} // namespace

void take_lean(const ContactSprings &springs, SlipSprings of_slip, std::vector<LeanSpring> &lean_springs) {
  lean_springs.clear();
  springs.for_lists([&](std::span<const ContactSpring> list) {
    for (const ContactSpring &s : list) {
      const bool is_left_out = of_slip == SlipSprings::none_tangential && s.tangential < s.sticking;
      lean_springs.push_back(lean(s, is_left_out ? 0.0 : s.tangential));
    }
  });
}

void add_product(const BlockSystem &system, std::span<const LeanSpring> springs, const Field &p, Field &y) {
  if (p.width() == 3) {
    add_rigid(springs, p, y);
  } else {
    add_any(system, springs, p, y);
  }
}

} // namespace gcpdda::statics
