#pragma once

// Bolts and cables across joints, and liners on faces, as the scene states them.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/vec2.hpp"

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace gcpdda {

/// What support of one type is made of: a bolt's values are those of one bolt, a liner's those of its
/// material.
struct SupportType {
  /// How it holds the rock: at its ends, along its length, or as a layer on a face.
  enum class Kind { anchored, grouted, liner };
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  std::string name;
  Kind kind = Kind::grouted;
  double axial_stiffness = 0.0; ///< N/m; 0: by the rigidity
  double axial_rigidity = 0.0;  ///< EA, N; over the free or active length it is the stiffness
  double axial_yield = unlimited;
  double shear_stiffness = 0.0; ///< N/m, of a grouted bolt
  double shear_yield = unlimited;
  double rupture_strain = unlimited; ///< of the free or active length, pre-tension included
  double pretension = 0.0;           ///< N
  double active_length = 0.0;        ///< m of a grouted bolt that stretches where it crosses a joint
  double bond_strength = unlimited;  ///< N per metre of grout
  bool plate = false;                ///< the head of a grouted bolt cannot be pulled into the rock
  double spacing = 1.0;              ///< m out of plane

  // Of a liner.
  double thickness = 0.0;      ///< m
  double youngs_modulus = 0.0; ///< Pa
  double poissons_ratio = 0.2;
  double compressive_strength = unlimited; ///< Pa, this and the next four
  double tensile_strength = unlimited;
  double residual_tensile_strength = 0.0; ///< once it has cracked
  double shear_strength = unlimited;
  double adhesion = unlimited; ///< tensile strength of the bond to the rock
  double bond_width = 0.03;    ///< m beside a joint that the bond acts on

  /// Equal in all parameters.
  friend bool operator==(const SupportType &, const SupportType &) = default;
};

/// One bolt or cable.
struct Bolt {
  std::string name;
  std::int32_t support = 0; ///< index into Scene::supports
  Vec2 from;                ///< head, m
  Vec2 to;                  ///< tip, m
  bool active = true;       ///< it is in place
  SourcePosition where;
};

/// A layer of shotcrete or concrete on a face of the rock.
struct Liner {
  std::string name;
  std::int32_t support = 0;      ///< index into Scene::supports
  std::vector<Vec2> path;        ///< along the face, m
  bool is_closed = false;        ///< the path returns to its first point
  bool has_rock_on_right = true; ///< of the path; false: the blocks tell on which side they lie
  bool active = true;            ///< it is in place
  SourcePosition where;
};

/// `count` bolts of one length that start from an arc of an opening's outline and stand on it at right
/// angles.
struct BoltPattern {
  double length = 0.0;
  double from_angle = 0.0; ///< rad, of the normals of the first and the last bolt
  double to_angle = 0.0;
  double spacing = 0.0; ///< m along the outline; 0: by count
  std::int64_t count = 0;
};

/// Head and tip of a bolt of a pattern.
struct BoltLine {
  Vec2 from;
  Vec2 to;
};

/// The bolts of a pattern on a counter-clockwise outline, from the first angle to the last, evenly spaced
/// along the outline with half a spacing left at both ends of the arc. Normals point out of the outline and
/// turn evenly between the middles of neighbouring edges, so that those of a polygon stand like those of the
/// curve it was made from.
std::vector<BoltLine> bolts_of(const BoltPattern &pattern, const std::vector<Vec2> &outline);

/// The part of a counter-clockwise outline where the normal goes from one angle to another (rad, the second
/// larger by one turn at most).
std::vector<Vec2> arc_of(const std::vector<Vec2> &outline, double from_angle, double to_angle);

} // namespace gcpdda
