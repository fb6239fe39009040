#include "dynamics/viscous_sides.hpp"

#include "dynamics/block_matrix.hpp"

#include <cmath>

namespace gcpdda {

Impedance impedance_of(double density, std::array<double, 2> modulus, std::array<double, 2> joint_stiffness,
                       double height) {
  std::array<double, 2> result{};
  for (std::size_t k = 0; k < 2; ++k) {
    const double compliance =
        (modulus[k] > 0.0 ? 1.0 / modulus[k] : 0.0) + 1.0 / (joint_stiffness[k] * height);
    result[k] = std::sqrt(density / compliance);
  }
  return {result[0], result[1]};
}

Dashpot dashpot_of(std::span<const ViscousEdge> edges) {
  Dashpot dashpot;
  for (const ViscousEdge &edge : edges) {
    const Vec2 along = edge.end - edge.begin;
    const double length = norm(along);
    const Vec2 s = (1.0 / length) * along;
    for (const double gauss : {-1.0, 1.0}) {
      const Vec2 x = edge.begin + (0.5 + gauss / std::sqrt(12.0)) * along;
      const std::array<Vec2, 6> column{
          {{1.0, 0.0}, {0.0, 1.0}, {-x.y, x.x}, {x.x, 0.0}, {0.0, x.y}, {0.5 * x.y, 0.5 * x.x}}};
      const auto add = [&](double impedance, Vec2 direction) {
        for (std::size_t i = 0; i < 6; ++i) {
          const double row = 0.5 * length * impedance * dot(column[i], direction);
          for (std::size_t j = 0; j <= i; ++j) {
            dashpot.damping[packed(i, j)] += row * dot(column[j], direction);
          }
          if (edge.lets_wave_in) {
            dashpot.wave[i][0] += 2.0 * row * direction.x;
            dashpot.wave[i][1] += 2.0 * row * direction.y;
          }
        }
      };
      add(edge.impedance.normal, perp(s));
      add(edge.impedance.tangential, s);
    }
  }
  return dashpot;
}

std::array<double, 6> dashpot_force(const Dashpot &dashpot, const std::array<double, 6> &rate, Vec2 wave) {
  std::array<double, 6> force{};
  for (std::size_t i = 0; i < 6; ++i) {
    force[i] = dashpot.wave[i][0] * wave.x + dashpot.wave[i][1] * wave.y;
    for (std::size_t j = 0; j < 6; ++j) {
      force[i] -= dashpot.damping[i < j ? packed(j, i) : packed(i, j)] * rate[j];
    }
  }
  return force;
}

} // namespace gcpdda
