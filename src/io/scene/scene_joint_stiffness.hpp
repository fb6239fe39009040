#pragma once

// The normal stiffness of joint laws in the three ways in which a scene can give it.

#include "io/scene/scene_section.hpp"

#include <map>
#include <optional>
#include <string>

namespace gcpdda::scene_text {

/// Reads normal_stiffness, allowed_overlap, or rock_mass_modulus with its companions.
class StiffnessReader {
public:
  explicit StiffnessReader(const SceneSource &source);

  /// The default law needs one of the three ways; another law keeps what `law` has where it gives none.
  void read(const Section &section, bool is_default, JointLaw &law);

private:
  void fault(const toml::source_region &where, std::string what, std::string why, std::string hint);
  bool are_exclusive(const Section &section);
  void read_overlap(const Section &section, JointLaw &law);
  void read_modulus(const Section &section, JointLaw &law);
  std::optional<double> modulus_of_materials(const Section &section);

  SceneSource source_;
  bool weightless_ = false;
  std::map<std::string, std::optional<double>> modulus_of_; ///< Young's moduli by material, Pa
  bool intact_of_default_ = false;                          ///< [joint.default] gives intact_modulus
};

} // namespace gcpdda::scene_text
