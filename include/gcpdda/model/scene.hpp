#pragma once

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/joint_law.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace gcpdda {

enum class SchemeKind { generalized_alpha, newmark_dda, central_difference, explicit_generalized_alpha };
/// Where within the step the contact force is taken (generalized-alpha only).
enum class ContactTime { leapfrog, start, predictor, predictor_end };
enum class PotentialKind { exact, linear };
enum class Fidelity { automatic, rigid, deformable };
enum class InitialFriction { consistent, zero };

struct Material {
  std::string name;
  double density = 0.0;        ///< kg/m3
  double youngs_modulus = 0.0; ///< Pa; 0 where the scene gives none
  double poissons_ratio = 0.0;
};

struct RunSettings {
  double duration = 0.0; ///< s
  Vec2 gravity{0.0, -9.81};
  double gravity_ramp = 0.0; ///< s, smooth rise of gravity from 0
  double time_step = 0.0;    ///< s; 0 means "auto"
  double safety = 0.25;
  SchemeKind scheme = SchemeKind::generalized_alpha;
  double spectral_radius = 0.8;
  ContactTime contact_time = ContactTime::leapfrog;
  PotentialKind potential = PotentialKind::exact;
  Fidelity fidelity = Fidelity::automatic;
  double accepted_error = 0.01;
  InitialFriction initial_friction = InitialFriction::consistent;
  double contact_damping = 0.05; ///< ratio xi
  bool plane_strain = true;
};

/// A block as the scene states it: world coordinates at t = 0, counter-clockwise.
struct SceneBlock {
  std::string name;
  std::int32_t material = 0; ///< index into Scene::materials
  std::vector<Vec2> vertices;
  std::array<double, 3> velocity{}; ///< vx, vy (m/s), omega (rad/s)
  bool fixed = false;
  SourcePosition where;
};

struct OutputSettings {
  double interval = 0.0;         ///< s; 0 until the default is put in
  double history_interval = 0.0; ///< s
  bool contacts = true;
};

struct Monitor {
  std::string name;        ///< file stem of its history
  std::int64_t block = -1; ///< BlockId
};

/// The whole input after validation; every rank holds the same one.
struct Scene {
  std::string stem; ///< file name without folder and extension
  RunSettings run;
  std::vector<Material> materials; ///< in file order
  JointLaws joints;
  std::vector<SceneBlock> blocks; ///< in BlockId order
  OutputSettings output;
  std::vector<Monitor> monitors;
  std::string resolved; ///< the scene after --set, as TOML text
};

} // namespace gcpdda
