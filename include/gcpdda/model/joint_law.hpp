#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <tuple>
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

  bool is_on_edges = false; ///< some edge of some block has it; known once all blocks have been looked at

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

  /// Law where an edge of law a meets one of law b, -1 for an edge without; `by_materials` where neither has
  /// one. Of two the weaker, whichever block it is on: the one with the smaller friction angle, then the
  /// smaller cohesion, then the one that the scene names first.
  [[nodiscard]] std::int32_t of_edges(std::int32_t a, std::int32_t b, std::int32_t by_materials) const {
    if (a < 0 || b < 0) {
      return a >= 0 ? a : b >= 0 ? b : by_materials;
    }
    const auto strength = [&](std::int32_t law) {
      const JointLaw &of = laws[static_cast<std::size_t>(law)];
      return std::tuple(of.tan_friction, of.cohesion, law);
    };
    return std::min(strength(a), strength(b)) == strength(a) ? a : b;
  }
};

} // namespace gcpdda
