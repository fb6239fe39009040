#include "one_block.hpp"

#include "contact/block_view.hpp"
#include "contact/geometry/overlap_energy.hpp"
#include "support/setting.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gcpdda::study {

namespace {

using testing::earth_gravity;

constexpr double tangential_ratio = 0.5;

/// int q ds and int q s ds of q = max(-p, d) along a piece, p and d linear.
std::array<double, 2> without_tension(double length, std::array<double, 2> p, std::array<double, 2> d) {
  std::array<double, 2> sum{};
  const auto add = [&](double s0, double s1) {
    const auto q = [&](double s) {
      const auto at = [&](const std::array<double, 2> &f) { return f[0] + s / length * (f[1] - f[0]); };
      return std::max(-at(p), at(d));
    };
    const double q0 = q(s0);
    const double q1 = q(s1);
    sum[0] += 0.5 * (s1 - s0) * (q0 + q1);
    sum[1] += (s1 - s0) * (s0 * (2.0 * q0 + q1) + s1 * (q0 + 2.0 * q1)) / 6.0;
  };
  const double begin = p[0] + d[0];
  const double end = p[1] + d[1];
  const bool is_cut = (begin < 0.0) != (end < 0.0);
  const double middle = is_cut ? begin / (begin - end) * length : length;
  add(0.0, middle);
  if (is_cut) {
    add(middle, length);
  }
  return sum;
}

} // namespace

OneBlock::OneBlock(const OneBlockProblem &problem, const Variant &variant)
    : problem_(problem), variant_(variant),
      scheme_(
          make_scheme(SchemeKind::generalized_alpha, RunSettings{}.spectral_radius, ContactTime::leapfrog)),
      shear_(problem.shear_at_start) {
  const Material rock{"rock", testing::rock_density};
  SceneBlock block;
  block.vertices = problem.block;
  SceneBlock support;
  support.vertices = problem.support;
  support.fixed = true;
  append_block(system_, BlockId{1}, block, rock);
  append_block(system_, BlockId{0}, support, rock);
  system_.num_owned = 1;
  system_.num_fixed = 1;
  system_.velocity[0] = problem.velocity;
  pose(system_, 0, 2);
  system_.acceleration[0] = accelerate(system_.properties[0], evaluate());
}

void OneBlock::step() {
  const double dt = problem_.time_step;
  const RigidDof v = system_.velocity[0];
  const RigidDof a = system_.acceleration[0];
  const RigidDof before = system_.trial[0];
  system_.trial[0] =
      system_.displacement[0] + scheme_.trial_velocity * dt * v + scheme_.trial_acceleration * dt * dt * a;
  system_.motion[0].set_increment(system_.trial[0] - before);
  pose(system_, 0, 1);
  const RigidDof a_new =
      (1.0 / (1.0 - scheme_.alpha_m)) * (accelerate(system_.properties[0], evaluate()) - scheme_.alpha_m * a);
  system_.displacement[0] += dt * v + dt * dt * ((0.5 - scheme_.beta) * a + scheme_.beta * a_new);
  system_.velocity[0] += dt * ((1.0 - scheme_.gamma) * a + scheme_.gamma * a_new);
  system_.acceleration[0] = a_new;
}

Vec2 OneBlock::velocity_at(Vec2 arm) const {
  return system_.velocity[0].u + system_.velocity[0].r * perp(arm);
}

RigidDof OneBlock::evaluate() {
  RigidDof total{{0.0, -earth_gravity * mass()}, 0.0};
  shear_before_ = shear_;
  const bool touched = touches_;
  touches_ = overlap_.find(view_of(system_, 1, outlines_[1]), view_of(system_, 0, outlines_[0]),
                           PotentialKind::exact);
  if (!touches_) {
    shear_ = 0.0;
    longest_ = 0.0;
    return total;
  }
  const Region &region = overlap_.regions().front();
  const RegionIntegrals sum = overlap_.integrate(region);
  const double half = 0.5 * problem_.normal_stiffness;
  const Vec2 centroid = system_.motion[0].centroid;
  Vec2 on_support = half * sum.force;
  double torque = half * (sum.dyad[1] - sum.dyad[2]) + cross(sum.origin - centroid, on_support);
  const double normal_force = norm(on_support);
  const Vec2 normal = (1.0 / normal_force) * on_support;
  const Vec2 tangent = perp(normal);
  const Vec2 point = sum.origin + (1.0 / sum.pressure) * sum.pressure_moment;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Piece &piece : overlap_.pieces()) {
    for (const Vec2 x : {piece.begin, piece.end()}) {
      low = std::min(low, dot(x - point, tangent));
      high = std::max(high, dot(x - point, tangent));
    }
  }
  stretch_spring(normal_force, tangent, point - centroid, high - low, !touched);
  const double cap = problem_.tan_friction * normal_force;
  const double drag = 2.0 * problem_.damping_ratio * std::sqrt(spring_ * mass()) *
                      -dot(velocity_at(point - centroid), tangent);
  const Vec2 friction = -std::clamp(shear_ + drag, -cap, cap) * tangent;
  torque += cross(point - centroid, friction);
  on_support += friction;
  if (problem_.damping_ratio > 0.0) {
    on_support += normal_dashpot(region, normal, point, normal_force, high - low, torque);
  }
  total += {-on_support, -torque};
  return total;
}

void OneBlock::stretch_spring(double normal_force, Vec2 tangent, Vec2 arm, double extent, bool is_new) {
  longest_ = std::max(longest_, extent);
  if (variant_.length == SpringLength::scaled && !is_new && extent < last_extent_) {
    shear_ *= extent / last_extent_;
  }
  last_extent_ = extent;
  spring_ = tangential_ratio * problem_.normal_stiffness *
            (variant_.length == SpringLength::current ? extent : longest_);
  if (!is_new) {
    const RigidDof step = system_.motion[0].increment();
    const double half_sine = std::sin(0.5 * step.r);
    const Vec2 slide = variant_.slide == Slide::velocities
                           ? problem_.time_step * velocity_at(arm)
                           : step.u + std::sin(step.r) * perp(arm) + 2.0 * half_sine * half_sine * arm;
    shear_ -= spring_ * dot(slide, tangent);
  }
  const double cap = problem_.tan_friction * normal_force;
  shear_ = std::clamp(shear_, -cap, cap);
}

Vec2 OneBlock::normal_dashpot(const Region &region, Vec2 normal, Vec2 point, double normal_force,
                              double extent, double &torque) const {
  const double half = 0.5 * problem_.normal_stiffness;
  const double rate = problem_.damping_ratio *
                      std::sqrt(problem_.normal_stiffness * mass() / std::sqrt(system_.properties[0].area));
  const Vec2 centroid = system_.motion[0].centroid;
  if (variant_.dashpot == Dashpot::resultant) {
    const double closing = dot(velocity_at(point - centroid), normal);
    const Vec2 force = std::max(-normal_force, 2.0 * rate * extent * closing) * normal;
    torque += cross(point - centroid, force);
    return force;
  }
  const bool along_resultant = variant_.dashpot == Dashpot::distributed;
  const auto inward = [&](std::uint32_t i) { // force on the support that presses this piece
    return (i < region.middle ? -1.0 : 1.0) * overlap_.pieces()[i].normal;
  };
  const auto facing = [&](std::uint32_t i) {
    return along_resultant ? std::max(0.0, dot(inward(i), normal)) : 1.0;
  };
  double facing_pressure = 0.0;
  for (std::uint32_t i = region.begin; i < region.end; ++i) {
    const Piece &piece = overlap_.pieces()[i];
    facing_pressure += facing(i) * half * piece.length * 0.5 * (piece.depth_begin + piece.depth_end);
  }
  const double share = along_resultant ? std::min(1.0, normal_force / facing_pressure) : 1.0;
  Vec2 total;
  for (std::uint32_t i = region.begin; i < region.end; ++i) {
    const Piece &piece = overlap_.pieces()[i];
    const double w = facing(i);
    const Vec2 direction = along_resultant ? normal : inward(i);
    const auto closing = [&](Vec2 x) { return w * rate * dot(velocity_at(x - centroid), direction); };
    const double p = share * w * half;
    const auto q = without_tension(piece.length, {p * piece.depth_begin, p * piece.depth_end},
                                   {closing(piece.begin), closing(piece.end())});
    total += q[0] * direction;
    torque += cross(q[0] * (piece.begin - centroid) + q[1] * perp(piece.normal), direction);
  }
  return total;
}

double OneBlock::potential_at(const RigidDof &trial) {
  const RigidDof kept = system_.trial[0];
  system_.trial[0] = trial;
  pose(system_, 0, 1);
  const double contact = 0.5 * problem_.normal_stiffness *
                         overlap_energy(view_of(system_, 1, outlines_[1]), view_of(system_, 0, outlines_[0]));
  system_.trial[0] = kept;
  pose(system_, 0, 1);
  return contact + mass() * earth_gravity * trial.u.y;
}

double OneBlock::energy() {
  const RigidDof increment = system_.motion[0].increment();
  const RigidDof rate = (1.0 / problem_.time_step) * increment;
  const double kinetic =
      0.5 * (mass() * dot(rate.u, rate.u) + system_.properties[0].inertia * rate.r * rate.r);
  const double potential =
      0.5 * (potential_at(system_.trial[0] - increment) + potential_at(system_.trial[0]));
  const double stick = spring_ > 0.0 ? 0.5 * shear_before_ * shear_ / spring_ : 0.0;
  return kinetic + potential + stick;
}

} // namespace gcpdda::study
