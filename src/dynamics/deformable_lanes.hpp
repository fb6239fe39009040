#pragma once

// The step of deformable blocks (deformable.hpp), several at a time.

#include "own_springs.hpp"

#include "gcpdda/base/instructions.hpp"

#include <array>
#include <cstddef>

namespace gcpdda {

/// Where and how long all blocks step, and where they take springs.
struct OwnStep {
  const Scheme &scheme;
  double time_step;
  SpringTime spring;
  Vec2 wave;                ///< velocity of the one that comes in through viscous sides, m/s
  double stiffness_damping; ///< s
  bool is_implicit;         ///< the elasticity of blocks

  // Q is Vec2, RigidDof or Mat2.
  /// At the spring's time but for the coming acceleration.
  template <class Q> [[nodiscard]] Q base(const Q &q, const Q &v, const Q &a) const {
    return q + (spring.velocity * v + spring.acceleration * a);
  }
  /// And its rate there.
  template <class Q> [[nodiscard]] Q base_rate(const Q &v, const Q &a) const {
    return v + spring.rate_acceleration * a;
  }
  template <class Q> [[nodiscard]] Q position(const Q &q, const Q &v, const Q &a, const Q &a_new) const {
    return q + (time_step * v + time_step * time_step * ((0.5 - scheme.beta) * a + scheme.beta * a_new));
  }
  template <class Q> [[nodiscard]] Q velocity(const Q &v, const Q &a, const Q &a_new) const {
    return v + time_step * ((1.0 - scheme.gamma) * a + scheme.gamma * a_new);
  }
};

/// Up to as many deformable rows as there are lanes, and what comes of them.
struct DeformableLanes {
  std::size_t count = 0;
  std::array<std::size_t, most_lanes> row;
  // At the trial configuration, but for the elasticity that is taken from the rows.
  std::array<Vec2, most_lanes> force;          ///< N/m
  std::array<Mat2, most_lanes> gradient_force; ///< on F, N
  std::array<Mat2, most_lanes> viscous;        ///< out: what beta K adds to the elastic force, N
};

/// Advances the rows and notes their elastic force. A row whose new state is not finite or turned inside out
/// keeps its old one.
/// @return bit i is set where row i is such a one
using StepDeformables = unsigned (*)(BlockSystem &system, DeformableLanes &lanes, const OwnStep &step);

struct DeformableStepper {
  std::size_t width; ///< of lanes, what may be given at a time
  StepDeformables step;
};

/// All instructions give the same bits.
DeformableStepper deformable_stepper(Instructions instructions);
// Without a step where the compiler or the machine lacks these instructions, or the whole build uses AVX.
DeformableStepper avx2_stepper();
DeformableStepper avx512_stepper();

} // namespace gcpdda
