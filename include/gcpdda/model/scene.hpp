#pragma once

// The whole input of a run as plain data.

#include "gcpdda/base/diagnostic.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/earthquake.hpp"
#include "gcpdda/model/ensemble.hpp"
#include "gcpdda/model/in_situ.hpp"
#include "gcpdda/model/joint_law.hpp"
#include "gcpdda/model/load_course.hpp"
#include "gcpdda/model/rock_region.hpp"
#include "gcpdda/model/stage.hpp"
#include "gcpdda/model/support.hpp"
#include "gcpdda/model/water.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gcpdda {

enum class SchemeKind { generalized_alpha, newmark_dda, central_difference, explicit_generalized_alpha };
/// Where within the step the contact force is taken (generalized-alpha only).
enum class ContactTime { leapfrog, start, predictor, predictor_end };
enum class PotentialKind { exact, linear };
enum class Fidelity { automatic, rigid, deformable };
enum class InitialFriction { consistent, zero };
/// Where within the step the elastic force of a deformable block is taken.
enum class Elasticity { implicit, explicit_ };

/// A rock: density and, where blocks deform, elasticity.
struct Material {
  std::string name;
  double density = 0.0;        ///< kg/m3
  double youngs_modulus = 0.0; ///< Pa; 0 where the scene gives none
  double poissons_ratio = 0.0;
};

/// Rayleigh damping C = alpha M + beta K: the ratio of a motion of frequency f is alpha/(4 pi f) + beta pi f.
struct Rayleigh {
  double mass_damping = 0.0;      ///< alpha, 1/s
  double stiffness_damping = 0.0; ///< beta, s

  /// Whether the scene asks for it.
  [[nodiscard]] bool present() const { return mass_damping > 0.0; }
};

/// Table [run]: time, scheme, gravity, damping, fidelity.
struct RunSettings {
  double duration = 0.0; ///< s
  Vec2 gravity{0.0, -9.81};
  double gravity_ramp = 0.0; ///< s, smooth rise of gravity from 0
  double time_step = 0.0;    ///< s; 0 means "auto"
  double safety = 0.55;
  SchemeKind scheme = SchemeKind::generalized_alpha;
  double spectral_radius = 0.5;
  ContactTime contact_time = ContactTime::leapfrog;
  PotentialKind potential = PotentialKind::exact;
  Fidelity fidelity = Fidelity::automatic;
  double accepted_error = 0.01;
  InitialFriction initial_friction = InitialFriction::consistent;
  double contact_damping = 0.05; ///< ratio xi
  Rayleigh rayleigh{};           ///< without contact_damping
  double local_damping = 0.0;    ///< share of the net force taken against the motion; static problems only
  bool plane_strain = true;
  Elasticity elasticity = Elasticity::implicit;
};

/// A force (N per metre) at a material point (world coordinates at t = 0).
struct PointLoad {
  Vec2 point;
  Vec2 force;
  double ramp = 0.0;            ///< s over which it rises smoothly from 0
  std::vector<LoadRow> table{}; ///< of a force that changes, instead of a ramp
  std::int64_t course = 0;      ///< of a run: number of its LoadCourse, 0 of a constant force
};

/// A row of a velocity table; linear to the next row, the last velocity stays.
struct VelocityRow {
  double time = 0.0;                ///< s, 0 in the first row
  std::array<double, 3> velocity{}; ///< vx, vy (m/s), omega (rad/s)

  /// Equal in time and velocities.
  friend bool operator==(const VelocityRow &, const VelocityRow &) = default;
};

/// A block as the scene states it: world coordinates at t = 0, counter-clockwise.
struct SceneBlock {
  std::string name;
  std::int32_t material = 0; ///< index into Scene::materials
  std::vector<Vec2> vertices;
  std::vector<std::int32_t>
      edge_joint; ///< law of each edge, index into JointLaws::laws, -1: by the materials; empty: all
  std::int32_t opening = -1;        ///< index into RockRegion::openings, -1: in none
  std::array<double, 3> velocity{}; ///< vx, vy (m/s), omega (rad/s)
  bool fixed = false;
  bool driven = false; ///< keeps `velocity`, or follows its table, whatever acts on it
  std::vector<VelocityRow>
      velocity_table; ///< of a driven block whose velocity changes; `velocity` is its first
  Fidelity fidelity = Fidelity::automatic;
  std::vector<Vec2> fixed_points; ///< points of the block that are held where they are at t = 0
  std::vector<PointLoad> loads;
  SourcePosition where;
};

/// A wall or pyramid of equal bricks: blocks made from their number, so that nobody has to hold them all
/// (generators.hpp).
struct BrickGenerator {
  /// What the bricks are laid to.
  enum class Kind { wall, pyramid };
  Kind kind = Kind::wall;
  std::string name;
  std::int32_t material = 0;
  Vec2 origin; ///< lower left corner, m
  std::int64_t rows = 1;
  std::int64_t columns = 1; ///< walls only; a pyramid has as many bricks in its base as rows
  Vec2 block_size;          ///< m
  double bond = 0.5;        ///< walls only: shift of every second row, in brick widths
  double gap = 0.0;         ///< between neighbours of a row, m
  SourcePosition where;
};

/// Blocks that stay in an HDF5 file; each rank reads its part.
struct BlockFile {
  std::string path;            ///< as the program opens it; empty without one
  std::int64_t num_blocks = 0; ///< 0 until the file has been looked at
  SourcePosition where;
};

/// Table [output]: what is written and when.
struct OutputSettings {
  double interval = 0.0;            ///< s; 0 until the default is put in
  double history_interval = 0.0;    ///< s
  double checkpoint_interval = 0.0; ///< s; 0 for no checkpoints by time
  bool contacts = true;
};

/// A block or a point whose history is written.
struct Monitor {
  std::string name;        ///< file stem of its history
  std::int64_t block = -1; ///< BlockId; of a point without block_name -1 until a block that holds it is found
  bool is_point = false;
  Vec2 point; ///< world coordinates at t = 0
  SourcePosition where;
  std::string block_name = {}; ///< block that the scene names for a point; empty where it names none
  /// A point of a profile, which one history holds: the points follow each other under its name. One in no
  /// block keeps `block` -1 and has no rows.
  bool is_on_profile = false;
  double distance = 0.0; ///< from the begin of the profile, m
};

/// Blocks that have a name together: those within an opening.
struct BlockGroup {
  std::string name;
  std::vector<std::int64_t> blocks; ///< ids, ascending
};

/// How the factor of safety is searched: strengths are divided by a factor until the blocks fail.
struct StrengthReduction {
  std::vector<std::int32_t> families; ///< laws that are weakened, index into JointLaws::laws; empty: all
  double from = 0.5;                  ///< factor that is expected to hold
  double to = 4.0;                    ///< one that is expected to fail
  double tolerance = 0.01;            ///< width of the last bracket over its lower end
  double limit = 0.0;          ///< s a trial lasts with local damping; 0: as long as the last settle stage
  std::int64_t patience = 8;   ///< limits that it goes on for without, where it has no verdict
  double failure_motion = 0.1; ///< share of its size that a block moves when it fails
  double largest_motion = std::numeric_limits<double>::infinity(); ///< as far may a block move until it rests
  double local_damping = 0.3; ///< without it blocks weakened at once swing beyond their new balance
  double ignored_area = 0.0;  ///< m^2; what fails and is smaller is no failure of the slope
  std::vector<Vec2> region;   ///< only blocks that begin in it count; empty for all

  /// Whether the strengths of a law are divided.
  [[nodiscard]] bool weakens(std::size_t law) const {
    return families.empty() ||
           std::count(families.begin(), families.end(), static_cast<std::int32_t>(law)) > 0;
  }
};

class BlockSource;

/// The whole input after validation; every rank holds the same one.
struct Scene {
  std::string stem; ///< file name without folder and extension
  RunSettings run;
  std::vector<Material> materials; ///< in file order
  JointLaws joints;
  std::vector<Water> water; ///< in file order
  std::vector<SupportType> supports;
  std::vector<Bolt> bolts;   ///< single ones, then those of patterns, in file order
  std::vector<Liner> liners; ///< in file order
  InSituStress in_situ;
  Earthquake earthquake;
  std::vector<SceneBlock> blocks;                   ///< of the scene file, the first BlockIds
  std::vector<BrickGenerator> generators;           ///< the next ones
  BlockFile block_file;                             ///< after them
  RockRegion region;                                ///< its blocks are the last ones
  std::shared_ptr<const BlockSource> region_blocks; ///< what cuts the region; null without one
  std::int64_t num_region_blocks = 0;               ///< 0 until the region has been cut
  std::vector<BlockGroup> groups;                   ///< one of each opening once the region has been cut
  OutputSettings output;
  std::vector<Monitor> monitors;
  std::vector<Stage> stages; ///< in their order; none for one run of run.duration
  StrengthReduction reduction;
  Ensemble ensemble;
  std::string resolved; ///< the scene after --set, as TOML text
  /// Where its values were written, by their path as with --set ("joint.default.cohesion"), but for those of
  /// blocks, monitors and stages, which have a place of their own; empty of a scene made in code.
  std::map<std::string, SourcePosition> places;
};

} // namespace gcpdda
