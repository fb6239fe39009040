#pragma once

// Contact laws of families of joints, and which of them a pair of edges or materials has.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

namespace gcpdda {

/// What a law gives to all contacts that have it, where nothing is bonded. Four numbers: the lanes read them
/// so.
struct LawConstants {
  double half_stiffness = 0.0;       ///< p_n/H = k_n/2, Pa/m
  double tangential_stiffness = 0.0; ///< per length of contact, Pa/m
  double tan_friction = 0.0;
  double cohesion = 0.0; ///< Pa
};

/// Contact law of a family of joints.
struct JointLaw {
  std::string name;
  double normal_stiffness = 0.0; ///< k_n = 2 p_n/H, Pa/m; 0 until an allowed overlap has been resolved
  double allowed_overlap = 0.0;  ///< share of the block size; 0 where normal_stiffness is given
  double tangential_ratio = 0.5; ///< k_t per length over k_n
  double tan_friction = 0.0;     ///< tan of the friction angle
  double cohesion = 0.0;         ///< Pa

  /// Edges that lie on each other at t = 0 are bonded (contact/laws/bonds.hpp): friction and cohesion above
  /// are those of the bond, what follows holds once it is broken and where there never was one.
  bool has_bonds = false;
  double tension = 0.0; ///< tensile strength of the bond, Pa
  double residual_tan_friction = 0.0;
  double residual_cohesion = 0.0; ///< Pa
  /// Slip opens the joint by tan_dilation of it (contact/laws/dilation.hpp), until it has slipped by
  /// dilation_limit.
  double tan_dilation = 0.0;
  double dilation_limit = 0.0; ///< m
  /// Friction angle by Barton and Bandis, see tan_friction_at(); tan_friction is then that of the residual
  /// angle.
  bool is_barton_bandis = false;
  double roughness = 0.0; ///< JRC
  double reduction = 1.0; ///< its tangent is divided by this
  double strength = 0.0;  ///< JCS, Pa
  /// Whence normal_stiffness follows where the scene gives a rock mass modulus, else zero: moduli of rock
  /// mass and intact rock (Pa) and spacing of the joints (m).
  double rock_mass_modulus = 0.0;
  double intact_modulus = 0.0;
  double spacing = 0.0;
  bool is_on_edges = false; ///< some edge of some block has it; known once all blocks have been looked at

  /// It resists shear.
  [[nodiscard]] bool has_friction() const { return tan_friction > 0.0 || cohesion > 0.0 || roughness > 0.0; }
  /// The same constants for every contact at all times.
  [[nodiscard]] bool is_constant() const { return !has_bonds && !is_barton_bandis && dilation_limit == 0.0; }
  /// Slip opens the joint.
  [[nodiscard]] bool dilates() const { return tan_dilation > 0.0; }
  /// What contacts with this law take from it.
  [[nodiscard]] LawConstants constants() const {
    return {0.5 * normal_stiffness, tangential_ratio * normal_stiffness,
            has_bonds ? residual_tan_friction : tan_friction, has_bonds ? residual_cohesion : cohesion};
  }
  /// With strengths divided by a factor: tan(phi) of friction, for Barton and Bandis at every pressure,
  /// cohesion, tension. A dilation angle above the friction that is left is lowered to it: otherwise slip
  /// would do more work than friction takes.
  void weaken(double factor) {
    if (is_barton_bandis) {
      reduction = factor;
    } else {
      tan_friction /= factor;
      residual_tan_friction /= factor;
    }
    cohesion /= factor;
    residual_cohesion /= factor;
    tension /= factor;
    const double left = has_bonds          ? residual_tan_friction
                        : is_barton_bandis ? tan_friction / factor
                                           : tan_friction;
    tan_dilation = std::min(tan_dilation, left);
  }
  /// By how much slip opens the joint, from a fresh one, m.
  [[nodiscard]] double dilation_at(double slip) const {
    return tan_dilation * std::min(slip, dilation_limit);
  }

  /// Barton and Choubey, Barton and Bandis [doi:10.1007/BF01261801]:
  ///     phi = phi_r + JRC log10(JCS/sigma_n), at least phi_r and at most 70 degrees (or phi_r, if that is
  /// more), the bounds that Barton and Choubey give for the curve.
  ///
  /// @param normal_stress  of the contact, compression positive, Pa
  [[nodiscard]] double tan_friction_at(double normal_stress) const {
    if (!is_barton_bandis || normal_stress >= strength) {
      return tan_friction / reduction;
    }
    constexpr double degree = std::numbers::pi / 180.0;
    const double residual = std::atan(tan_friction);
    const double steepest = std::max(70.0 * degree, residual);
    const double angle = residual + roughness * degree * std::log10(strength / normal_stress);
    return std::tan(std::min(angle, steepest)) / reduction;
  }

  /// All parameters that a saved state depends on, in the order of its fingerprint.
  static constexpr auto numbers() {
    return std::array{&JointLaw::normal_stiffness,
                      &JointLaw::allowed_overlap,
                      &JointLaw::tangential_ratio,
                      &JointLaw::tan_friction,
                      &JointLaw::cohesion,
                      &JointLaw::tension,
                      &JointLaw::residual_tan_friction,
                      &JointLaw::residual_cohesion,
                      &JointLaw::tan_dilation,
                      &JointLaw::dilation_limit,
                      &JointLaw::roughness,
                      &JointLaw::reduction,
                      &JointLaw::strength};
  }
  /// Its parameters of type bool that a user chooses.
  static constexpr auto choices() { return std::array{&JointLaw::has_bonds, &JointLaw::is_barton_bandis}; }
};
// A parameter that is added must join these lists. Each of the three flags fills a place of eight bytes; the
// three numbers from which normal_stiffness may follow are represented by it.
static_assert(sizeof(JointLaw) ==
              sizeof(std::string) + sizeof(double) * (JointLaw::numbers().size() + 3 + 3));

/// All laws of a scene and which one a pair of materials takes.
struct JointLaws {
  std::vector<JointLaw> laws;            ///< [0] is "default"
  std::vector<std::int32_t> of_material; ///< (materials, materials), symmetric
  std::int32_t num_materials = 0;

  /// Index of the law between two materials.
  [[nodiscard]] std::int32_t between(std::int32_t a, std::int32_t b) const {
    return of_material[static_cast<std::size_t>(a) * static_cast<std::size_t>(num_materials) +
                       static_cast<std::size_t>(b)];
  }

  // A contact that slides from edges of one law to edges of another keeps the stiffness of the one and takes
  // the strength of the other (contact/laws/region_law.hpp). Where the two laws differ in stiffness, that has
  // a number of its own, beyond those of the laws.

  /// The law of a contact that has slid on.
  ///
  /// @param law  that it had
  /// @param edges  law of the edges to which it has slid
  [[nodiscard]] std::int32_t slid_to(std::int32_t law, std::int32_t edges) const {
    const JointLaw &before = stiffness(law);
    const JointLaw &after = laws[static_cast<std::size_t>(edges)];
    if (before.normal_stiffness == after.normal_stiffness &&
        before.tangential_ratio == after.tangential_ratio) {
      return edges;
    }
    return count() * (1 + static_cast<std::int32_t>(&before - laws.data())) + edges;
  }
  /// Which law gives a contact its strength.
  [[nodiscard]] std::int32_t named(std::int32_t law) const { return law % count(); }
  /// That law.
  [[nodiscard]] const JointLaw &strength(std::int32_t law) const {
    return laws[static_cast<std::size_t>(named(law))];
  }
  /// Which law gives it its stiffness.
  [[nodiscard]] const JointLaw &stiffness(std::int32_t law) const {
    return laws[static_cast<std::size_t>(law < count() ? law : law / count() - 1)];
  }
  /// What a contact takes from both.
  [[nodiscard]] LawConstants constants(std::int32_t law) const {
    const LawConstants stiff = stiffness(law).constants();
    const LawConstants strong = strength(law).constants();
    return {stiff.half_stiffness, stiff.tangential_stiffness, strong.tan_friction, strong.cohesion};
  }
  /// Those of all contacts, by their laws.
  [[nodiscard]] std::vector<LawConstants> all_constants() const {
    std::vector<LawConstants> all;
    for (std::int32_t law = 0; law < count() * (1 + count()); ++law) {
      all.push_back(constants(law));
    }
    return all;
  }

  /// The most that a law opens any joint, m.
  [[nodiscard]] double largest_opening() const {
    double largest = 0.0;
    for (const JointLaw &law : laws) {
      largest = std::max(largest, law.dilation_at(law.dilation_limit));
    }
    return largest;
  }

  /// Law where an edge of law a meets one of law b, -1 for an edge without; `by_materials` where neither has
  /// one. Of two the weaker, whichever block it is on: the one with the smaller friction angle, then the
  /// smaller cohesion, then the one that the scene names first.
  [[nodiscard]] std::int32_t of_edges(std::int32_t a, std::int32_t b, std::int32_t by_materials) const {
    if (a < 0 || b < 0) {
      return a >= 0 ? a : b >= 0 ? b : by_materials;
    }
    const auto order = [&](std::int32_t law) {
      const JointLaw &of = laws[static_cast<std::size_t>(law)];
      return std::tuple(of.tan_friction, of.cohesion, law);
    };
    return std::min(order(a), order(b)) == order(a) ? a : b;
  }

private:
  [[nodiscard]] std::int32_t count() const { return static_cast<std::int32_t>(laws.size()); }
};

} // namespace gcpdda
