#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda {

/// Contact law of a family of joints.
struct JointLaw {
  std::string name;
  double normal_stiffness = 0.0; ///< k_n = 2 p_n/H, Pa/m; 0 until an allowed overlap has been resolved
  double allowed_overlap = 0.0;  ///< share of the block size; 0 where normal_stiffness is given
  double tangential_ratio = 0.5; ///< k_t per length over k_n
  double tan_friction = 0.0;     ///< tan of the friction angle
  double cohesion = 0.0;         ///< Pa

  [[nodiscard]] bool has_friction() const { return tan_friction > 0.0 || cohesion > 0.0; }
};

/// All laws of a scene and which one a pair of materials takes.
struct JointLaws {
  std::vector<JointLaw> laws;            ///< [0] is "default"
  std::vector<std::int32_t> of_material; ///< (materials, materials), symmetric
  std::int32_t num_materials = 0;

  [[nodiscard]] std::int32_t between(std::int32_t a, std::int32_t b) const {
    return of_material[static_cast<std::size_t>(a) * static_cast<std::size_t>(num_materials) +
                       static_cast<std::size_t>(b)];
  }
};

} // namespace gcpdda
