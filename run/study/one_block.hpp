#pragma once

// One rigid block on a fixed one, stepped by the default scheme with the program's contact integral, and a
// friction and a dashpot of its own whose rejected forms can be switched on.

#include "contact/contact_forces.hpp"
#include "dynamics/scheme.hpp"

#include <vector>

namespace gcpdda::study {

/// What stretches the stick spring.
enum class Slide { trial_configurations, velocities };
/// Its stiffness as the region's length l changes; `scaled` is the longest so far, but the force shrinks with
/// l.
enum class SpringLength { longest, current, scaled };
/// Where the normal dashpot acts: along n_r on every piece, along every piece's own normal, or at x_r.
enum class Dashpot { distributed, piece_normals, resultant };

struct Variant {
  Slide slide = Slide::trial_configurations;
  SpringLength length = SpringLength::longest;
  Dashpot dashpot = Dashpot::distributed;
};

struct OneBlockProblem {
  std::vector<Vec2> block;
  std::vector<Vec2> support;
  RigidDof velocity{};
  double normal_stiffness = 1e9; ///< Pa/m
  double tan_friction = 0.0;
  double damping_ratio = 0.0;
  double time_step = 0.0;      ///< s
  double shear_at_start = 0.0; ///< N/m, cut at the cap
};

class OneBlock {
public:
  OneBlock(const OneBlockProblem &problem, const Variant &variant);

  void step();
  [[nodiscard]] const RigidDof &displacement() const { return system_.displacement[0]; }
  [[nodiscard]] double mass() const { return system_.properties[0].mass; }
  /// Kinetic, contact, stick and weight between the last two trial configurations, N.
  [[nodiscard]] double energy();

private:
  /// Moves `shear_` on; total on the block about its trial centroid.
  RigidDof evaluate();
  void stretch_spring(double normal_force, Vec2 tangent, Vec2 arm, double extent, bool is_new);
  /// On the support; adds its torque about the block's trial centroid.
  Vec2 normal_dashpot(const Region &region, Vec2 normal, Vec2 point, double normal_force, double extent,
                      double &torque) const;
  [[nodiscard]] Vec2 velocity_at(Vec2 arm) const;
  [[nodiscard]] double potential_at(const RigidDof &trial);

  OneBlockProblem problem_;
  Variant variant_;
  Scheme scheme_;
  BlockSystem system_; ///< row 0 the block, row 1 its support
  Overlap overlap_;
  std::array<TrialOutline, 2> outlines_;
  bool touches_ = true;
  double longest_ = 0.0;
  double last_extent_ = 0.0;
  double spring_ = 0.0; ///< stiffness of the stick spring, N/m per metre
  double shear_ = 0.0;
  double shear_before_ = 0.0;
};

} // namespace gcpdda::study
