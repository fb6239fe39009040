#pragma once

// The state of the blocks of one rank as plain arrays by field: owned rows, ghosts, fixed blocks.

#include "base/ids.hpp"
#include "gcpdda/geometry/mat2.hpp"
#include "gcpdda/geometry/vec2.hpp"
#include "gcpdda/model/scene.hpp"
#include "geometry/aabb.hpp"
#include "model/row_offsets.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace gcpdda {

enum class BlockKind : std::uint8_t { fixed = 0, rigid = 1, deformable = 2 };

/// Three degrees of freedom of a rigid block: translation of the centroid and rotation (m, rad), or their
/// rates, or the forces that work on them (N/m, N).
struct RigidDof {
  Vec2 u;
  double r = 0.0;

  RigidDof &operator+=(const RigidDof &b) { return u += b.u, r += b.r, *this; }
  friend bool operator==(const RigidDof &, const RigidDof &) = default;
};

inline RigidDof operator+(const RigidDof &a, const RigidDof &b) {
  return {a.u + b.u, a.r + b.r};
}
inline RigidDof operator-(const RigidDof &a, const RigidDof &b) {
  return {a.u - b.u, a.r - b.r};
}
inline RigidDof operator*(double s, const RigidDof &a) {
  return {s * a.u, s * a.r};
}
/// Work of a force over a motion.
inline double work(const RigidDof &force, const RigidDof &motion) {
  return dot(force.u, motion.u) + force.r * motion.r;
}

/// Constants of one block.
struct BlockProperties {
  BlockId id;
  std::int32_t material = 0;
  BlockKind kind = BlockKind::rigid;
  bool is_convex = true;         ///< and without parted sides
  bool has_edge_joints = false;  ///< some of its edges have a law of their own
  bool has_parted_sides = false; ///< part_sides()
  double area = 0.0;             ///< m2
  double mass = 0.0;             ///< kg per metre; infinite for a fixed or driven block
  double inertia = 0.0;      ///< about the centroid, kg m2 per metre; infinite for a fixed or driven block
  double mass_scaling = 1.0; ///< of mass and inertia against inertial forces alone, a power of two
  double radius = 0.0;       ///< largest centroid-to-vertex distance, m
  double width = 0.0;        ///< narrowest width, m
  Vec2 centroid;             ///< at t = 0, m

  /// Whatever acts on it.
  [[nodiscard]] bool keeps_its_velocity() const { return std::isinf(mass); }
  /// What gravity acts on, kg per metre.
  [[nodiscard]] double heavy_mass() const { return mass / mass_scaling; }
};

/// What contacts do to F of a deformable block, or of a row before its reference axes are known: int (x -
/// x_c) df^T or int t X^T, N.
struct BlockGradientSum {
  Mat2 force;
  Mat2 shear;
  Mat2 damping;
};

/// Everything a deformable block has beyond a rigid one. Its points are x = x_c + F X, X in its reference
/// axes; F = R (I + E). With S = rho int X X^T dA its kinetic energy is m v^2/2 + tr(F' S F'^T)/2: a constant
/// mass, without centrifugal terms.
///
/// What a step of a free block reads and writes fills whole lines of a cache; what only others have stands
/// behind.
struct alignas(64) Deformation {
  Mat2 gradient = Mat2::identity();  ///< F_n
  Mat2 rate;                         ///< F'_n, 1/s
  Mat2 acceleration;                 ///< F''_n, 1/s2
  Mat2 trial = Mat2::identity();     ///< F*_n, where contact forces are taken
  Mat2 refreshed = Mat2::identity(); ///< F at the last refresh of the neighbourhood
  Mat2 second_moment;                ///< S, kg m2 per metre
  Mat2 initial_strain;               ///< E_0 of a block that is born under stress: sigma is D (E + E_0)
  Mat2 internal; ///< of the last evaluation: the elastic force applied, K (E_{n+1-af} - E*) included, N
  BlockGradientSum contact; ///< of the last evaluation; gathered as BlockSystem::contact
  /// Stiffness area * D of (eps_x, eps_y, gamma_xy) is [a b 0; b a 0; 0 0 c], N.
  double stiffness_direct = 0.0; ///< a
  double stiffness_cross = 0.0;  ///< b
  double stiffness_shear = 0.0;  ///< c
  // Of the last evaluation, zero of blocks that are free: forces that work on F (N), sum of t X^T.
  alignas(64) Mat2 load_force; ///< point loads, water, unloading
  Mat2 anchor_force;           ///< fixed points and viscous sides
};

/// An edge at the trial configuration, of a system where some block deforms. Four numbers: the lanes read
/// them so (src/contact/lanes/lane_motion.hpp).
struct DeformedEdge {
  Vec2 slope;          ///< minus the gradient of the depth below it: F^-T N/J, N the reference normal
  double length = 0.0; ///< m
  double unit = 0.0;   ///< 1/|slope|: this times the slope is the normal
};

/// A part of an edge and the law by which water tables choose it (contact/start_contacts.hpp).
struct WaterStretch {
  std::int32_t edge = 0;
  std::int32_t law = -1; ///< -1: dry in every water table with a list of laws
  double begin = 0.0;    ///< share of the edge's length from its first vertex
  double end = 1.0;

  friend bool operator==(const WaterStretch &, const WaterStretch &) = default;
};

/// A dead load at a material point.
struct MaterialLoad {
  Vec2 point;              ///< X, reference axes, m
  Vec2 force;              ///< N per metre
  std::int64_t course = 0; ///< number of the LoadCourse that multiplies it, 0 of a constant one
};

/// A material point held by a stiff spring, taken implicitly.
struct Anchor {
  Vec2 point;             ///< X, reference axes, m
  double stiffness = 0.0; ///< Pa (N/m per metre)
  Vec2 held;              ///< displacement of the spring's fixed end from the point at t = 0, m
};

/// The rock beyond a block's edges on viscous sides (dynamics/viscous_sides.hpp), over its degrees of freedom
/// in axes that turn with it.
struct Dashpot {
  std::array<double, 21> damping{}; ///< D, lower triangle by rows; N s/m and so on
  std::array<std::array<double, 2>, 6>
      wave{};            ///< what a wave that comes in with velocity v pushes is this times v
  double is_awake = 0.0; ///< 1 once it acts
};

/// Constant factorisation L D L^T of a block's own matrix over its degrees of freedom (u, v, r, eps_x, eps_y,
/// gamma_xy) in axes that turn with it; a rigid block uses the first three. Row by row below the diagonal of
/// L, 1/D on it.
struct BlockMatrix {
  std::array<double, 21> factor{};
  std::array<double, 6> by_torque{}; ///< the solution under a unit torque, of a deformable block
};

/// What the contacts of one block add up to, about the trial centroid. Once the forces of a step are
/// gathered, `force` is that of all that acts but the block's own springs, weight included, and `damping` has
/// local and mass damping in it.
struct BlockContactSum {
  RigidDof force;
  RigidDof shear;   ///< elastic friction in it
  RigidDof damping; ///< dashpots in it
};

/// What the energy ledger carries for one block: works so far of forces in BlockContactSum and of
/// AppliedForces over increments of the trial configuration (J/m), by the trapezoid; what the last forces do
/// over the increment that comes next is not yet in them.
struct BlockLedger {
  double shear = 0.0;
  double damping = 0.0;
  double load = 0.0;
  double gravity = 0.0;
};

/// Accelerations that act on every block alike, m/s2.
struct BodyForces {
  Vec2 gravity;
  Vec2 shaking; ///< of the ground
};

/// What acted on a block besides its contacts in the last evaluation.
struct AppliedForces {
  RigidDof load; ///< point loads, water, shaking; of a driven block what drives it
  Vec2 gravity;
  RigidDof anchor; ///< fixed points and viscous sides; a deformable block's turning part stands in its
                   ///< Deformation
};

/// Where contact forces are taken.
struct TrialConfiguration {
  RigidDof motion; ///< x* - x_0
  Mat2 gradient;   ///< F* of a deformable block
};

/// How a trial configuration moved since the last evaluation: the material point now at x_c + r by
/// u + turn(r).
struct TrialIncrement {
  Vec2 u;
  Mat2 turn;
};

/// All that contacts of a block need besides its edges, in two lines of a cache. Four numbers each: the lanes
/// read them so (src/contact/lanes/lane_motion.hpp).
struct alignas(64) BlockMotion {
  Vec2 centroid; ///< of the trial configuration
  Vec2 velocity;
  Vec2 step;            ///< of the centroid between the last two trial configurations
  double rotated = 0.0; ///< between them, rad
  double spin = 0.0;    ///< rad/s
  /// TrialIncrement::turn of a deformable block. Of a rigid one its first row, from which the second one
  /// follows, and cosine and sine of the trial configuration's rotation, from which its outline does.
  std::array<Vec2, 2> turn;
  Aabb box; ///< of the trial configuration

  /// x*_n - x*_{n-1}.
  [[nodiscard]] RigidDof increment() const { return {step, rotated}; }
  void set_increment(const RigidDof &increment) { step = increment.u, rotated = increment.r; }
  /// Of a rigid block.
  [[nodiscard]] Rotation rotation() const { return {turn[1].x, turn[1].y}; }
};

/// Where a block was (x - x_0) when a stage began, when its motion was last looked at, and where the water of
/// a stage that asks for rest finds it.
struct BlockMark {
  RigidDof stage;
  RigidDof look;
  RigidDof water;
};

/// A block on its way to equilibrium in pseudo-time (statics/pseudo_time.hpp), by the freedoms of
/// statics/field.hpp.
struct PseudoMotion {
  std::array<double, 6> velocity{}; ///< motion of the next step
  std::array<double, 6> momentum{};
  std::array<double, 6> held{}; ///< force that was out of balance when the stage began
  double is_free = 0.0;         ///< 1: nothing touched it at the last evaluation
  double rests = 0.0;           ///< 1: it stays where it is while those far from balance move
  /// In sizes of the block, from the beginning of a trial to that of its window at hand; not in checkpoints,
  /// because nothing goes on with a trial.
  double moved = 0.0;

  friend bool operator==(const PseudoMotion &, const PseudoMotion &) = default;
};

/// The state of all blocks this rank sees, as arrays by field.
///
/// Rows: [0, num_owned) owned, then num_ghosts ghosts (exact copies of other ranks' blocks), then num_fixed
/// fixed blocks (the same on every rank, never exchanged). Each range is sorted by BlockId. Positions are
/// kept as displacements from the centroid at t = 0, so that a distant origin costs no digits of the motion.
struct BlockSystem {
  std::size_t num_owned = 0;
  std::size_t num_ghosts = 0;
  std::size_t num_fixed = 0;
  BodyForces body; ///< of the last evaluation

  // State, one entry a row. What stands here migrates, makes a ghost, and is all that a restart needs.
  std::vector<BlockProperties> properties;
  std::vector<RigidDof> displacement; ///< x_n - x_0
  // Of a deformable row r of velocity and acceleration is 0: F' and F'' turn it.
  std::vector<RigidDof> velocity;       ///< v_n
  std::vector<RigidDof> acceleration;   ///< a_n
  std::vector<RigidDof> trial;          ///< x*_n - x_0, where the contact forces are taken
  std::vector<RigidDof> refreshed;      ///< x - x_0 at the last refresh of the neighbourhood
  std::vector<BlockContactSum> contact; ///< of the last evaluation, of owned rows
  std::vector<BlockLedger> ledger;

  // Shape in the block's own axes, flat; row i owns [vertex_begin[i], vertex_begin[i + 1]). Edge k runs from
  // vertex k to the next one; its outward unit normal is stored, never recomputed from cut edges.
  std::vector<std::uint32_t> vertex_begin{0};
  std::vector<Vec2> reference_vertex; ///< relative to the centroid
  std::vector<Vec2> reference_normal;
  /// Law of each edge, index into JointLaws::laws, -1: by the materials. Empty until a row has one; then as
  /// long as the lists above. It is packed for rows with such edges alone.
  std::vector<std::int32_t> edge_joint;

  // What only some blocks have, flat in the same way: row i owns [begin[i], begin[i + 1]).
  RowOffsets deformation_begin; ///< one entry for a deformable block, none for others
  std::vector<Deformation> deformation;
  RowOffsets matrix_begin; ///< one entry for blocks with anchors or dashpots
  std::vector<BlockMatrix> matrix;
  /// Of edges that water tables do not choose by the law of the edge itself: stretches that cover these
  /// edges, ascending by edge and begin.
  RowOffsets water_stretch_begin;
  std::vector<WaterStretch> water_stretch;
  RowOffsets load_begin;
  std::vector<MaterialLoad> load;
  RowOffsets anchor_begin;
  std::vector<Anchor> anchor;
  RowOffsets dashpot_begin; ///< one entry for blocks on viscous sides
  std::vector<Dashpot> dashpot;
  /// One entry for blocks on which more acts than contacts and BodyForces, or that are driven.
  RowOffsets applied_begin;
  std::vector<AppliedForces> applied;
  RowOffsets mark_begin; ///< one entry for mobile blocks of a scene with stages
  std::vector<BlockMark> mark;
  /// One entry for mobile blocks once a stage has begun after the one with which the ground began to shake.
  RowOffsets unshaken_begin;
  std::vector<Vec2> unshaken; ///< displacement of the centroid at the beginning of that stage, m
  RowOffsets pseudo_begin;    ///< one entry for owned blocks in a stage with the static solver
  std::vector<PseudoMotion> pseudo;

  // Derived from the trial configuration, see pose(). Outlines of rigid blocks are not stored: to turn them
  // takes no longer than to read them (TrialOutline).
  std::vector<BlockMotion>
      motion; ///< pose() finds centroid, box and rotation of it, set_trial() the increment
  std::vector<Mat2> trial_inverse; ///< F*^-1, by entry of `deformation`
  // Empty where no block deforms.
  std::vector<Vec2> vertex;
  std::vector<DeformedEdge> deformed_edge;

  [[nodiscard]] std::size_t num_rows() const { return properties.size(); }
  [[nodiscard]] std::size_t num_mobile() const { return num_owned + num_ghosts; }
  [[nodiscard]] std::size_t first_fixed() const { return num_owned + num_ghosts; }
  [[nodiscard]] bool is_fixed(std::size_t row) const { return row >= first_fixed(); }
  [[nodiscard]] std::size_t num_vertices(std::size_t row) const {
    return vertex_begin[row + 1] - vertex_begin[row];
  }

  [[nodiscard]] bool is_deformable(std::size_t row) const {
    return deformation_begin[row + 1] > deformation_begin[row];
  }
  /// How the trial configuration of a row moved since the last evaluation.
  [[nodiscard]] TrialIncrement increment_of(std::size_t row) const {
    const auto &[first, second] = motion[row].turn;
    return {motion[row].step, is_deformable(row) ? Mat2{first.x, first.y, second.x, second.y}
                                                 : Mat2{first.x, first.y, -first.y, first.x}};
  }
  /// F*_n - F*_{n-1} of a deformable row.
  [[nodiscard]] Mat2 gradient_increment(std::size_t row) const {
    return increment_of(row).turn * deformation_of(row).trial;
  }
  [[nodiscard]] bool has_matrix(std::size_t row) const { return matrix_begin[row + 1] > matrix_begin[row]; }
  /// Of a deformable row.
  [[nodiscard]] const Deformation &deformation_of(std::size_t row) const {
    return deformation[deformation_begin[row]];
  }
  [[nodiscard]] Deformation &deformation_of(std::size_t row) { return deformation[deformation_begin[row]]; }
  [[nodiscard]] std::span<const WaterStretch> water_stretches(std::size_t row) const {
    return {water_stretch.data() + water_stretch_begin[row],
            water_stretch_begin[row + 1] - water_stretch_begin[row]};
  }
  [[nodiscard]] std::span<const MaterialLoad> loads_of(std::size_t row) const {
    return {load.data() + load_begin[row], load_begin[row + 1] - load_begin[row]};
  }
  [[nodiscard]] std::span<const Anchor> anchors_of(std::size_t row) const {
    return {anchor.data() + anchor_begin[row], anchor_begin[row + 1] - anchor_begin[row]};
  }

  /// Null where there is none.
  [[nodiscard]] const AppliedForces *applied_to(std::size_t row) const {
    return applied_begin[row] == applied_begin[row + 1] ? nullptr : &applied[applied_begin[row]];
  }
  [[nodiscard]] AppliedForces *applied_to(std::size_t row) {
    return applied_begin[row] == applied_begin[row + 1] ? nullptr : &applied[applied_begin[row]];
  }
  /// AppliedForces::anchor.
  [[nodiscard]] RigidDof anchor_force(std::size_t row) const {
    const AppliedForces *own = applied_to(row);
    return own == nullptr ? RigidDof{} : own->anchor;
  }

  /// The row's dashpot where it acts; null where there is none.
  [[nodiscard]] const Dashpot *dashpot_of(std::size_t row) const {
    const std::uint32_t at = dashpot_begin[row];
    return at == dashpot_begin[row + 1] || dashpot[at].is_awake == 0.0 ? nullptr : &dashpot[at];
  }

  /// Zero where nothing is marked.
  [[nodiscard]] BlockMark mark_of(std::size_t row) const {
    return mark_begin[row] == mark_begin[row + 1] ? BlockMark{} : mark[mark_begin[row]];
  }

  template <class T>
  [[nodiscard]] std::span<const T> of_row(const std::vector<T> &per_vertex, std::size_t row) const {
    return {per_vertex.data() + vertex_begin[row], num_vertices(row)};
  }

  /// Laws of a row's edges; empty where all are by the materials.
  [[nodiscard]] std::span<const std::int32_t> edge_joints(std::size_t row) const {
    return properties[row].has_edge_joints ? of_row(edge_joint, row) : std::span<const std::int32_t>();
  }

  /// Position of the centroid at t_n.
  [[nodiscard]] Vec2 centroid(std::size_t row) const {
    return properties[row].centroid + displacement[row].u;
  }

  /// Every field with one entry a row: the one list that packing, migration and reordering share.
  static constexpr auto row_fields() {
    return std::make_tuple(&BlockSystem::properties, &BlockSystem::displacement, &BlockSystem::velocity,
                           &BlockSystem::acceleration, &BlockSystem::trial, &BlockSystem::refreshed,
                           &BlockSystem::contact, &BlockSystem::ledger);
  }
  /// Every field with any number of entries a row that cannot be derived: the offsets, then the fields that
  /// share them.
  static constexpr auto lists() {
    return std::make_tuple(std::make_tuple(&BlockSystem::vertex_begin, &BlockSystem::reference_vertex,
                                           &BlockSystem::reference_normal),
                           std::make_tuple(&BlockSystem::deformation_begin, &BlockSystem::deformation),
                           std::make_tuple(&BlockSystem::matrix_begin, &BlockSystem::matrix),
                           std::make_tuple(&BlockSystem::water_stretch_begin, &BlockSystem::water_stretch),
                           std::make_tuple(&BlockSystem::load_begin, &BlockSystem::load),
                           std::make_tuple(&BlockSystem::anchor_begin, &BlockSystem::anchor),
                           std::make_tuple(&BlockSystem::dashpot_begin, &BlockSystem::dashpot),
                           std::make_tuple(&BlockSystem::applied_begin, &BlockSystem::applied),
                           std::make_tuple(&BlockSystem::mark_begin, &BlockSystem::mark),
                           std::make_tuple(&BlockSystem::unshaken_begin, &BlockSystem::unshaken),
                           std::make_tuple(&BlockSystem::pseudo_begin, &BlockSystem::pseudo));
  }
};

/// Stiffness of a block of that area (m2) and material.
void set_elasticity(Deformation &deformation, double area, const Material &material, bool plane_strain);

/// Rows [first, last) of a system, or of the one that joins it.
struct RowRun {
  std::size_t first = 0;
  std::size_t last = 0;
  bool joins = false;
};
/// The system's rows become those of these runs, field by field. The ranges' counts are the caller's.
/// @param spare  rows that there is room for behind them
void take_rows(BlockSystem &system, const BlockSystem &joining, std::span<const RowRun> runs,
               std::size_t spare);

/// Append the row of a scene's block in its initial configuration. A deformable kind needs the material's
/// elastic constants. Its own matrix, where it has one, is made later (dynamics/deformable.hpp); the ranges'
/// counts are the caller's.
void append_block(BlockSystem &system, BlockId id, const SceneBlock &block, const Material &material,
                  BlockKind kind, bool plane_strain = true);
/// The same, fixed or rigid as the block says.
void append_block(BlockSystem &system, BlockId id, const SceneBlock &block, const Material &material);

/// Let vertices within straight sides of the last row part them, if laws change there or edges may be bonded:
/// a contact on both parts has a region on each.
void part_sides(BlockSystem &system, const JointLaws &joints);

/// The laws of the last row's edges, once its vertices stand in the system; none where it has none.
void append_edge_joints(BlockSystem &system, std::span<const std::int32_t> joints);

/// Make room for so many rows with so many vertices in all: to grow by doubling would take twice the memory.
void reserve_rows(BlockSystem &system, std::size_t rows, std::size_t vertices);

/// Append a copy of another system's row. The ranges' counts are the caller's.
void append_row(BlockSystem &to, const BlockSystem &from, std::size_t row);
/// The same of rows [first, last).
void append_rows(BlockSystem &to, const BlockSystem &from, std::size_t first, std::size_t last);

/// Marks of owned rows, all of which get one.
std::span<BlockMark> mark_rows(BlockSystem &system);
/// BlockSystem::unshaken of owned rows, all of which get an entry.
std::span<Vec2> unshaken_rows(BlockSystem &system);
/// A row loses its velocity and acceleration.
void set_to_rest(BlockSystem &system, std::size_t row);
/// Has a row neither an increment nor a velocity?
bool is_still(const BlockSystem &system, std::size_t row);
/// Motions in pseudo-time of owned rows, all of which get one.
std::span<PseudoMotion> pseudo_rows(BlockSystem &system);
/// No row has a motion in pseudo-time any more.
void drop_pseudo_rows(BlockSystem &system);

/// What weight and shaking do to a block that nothing else acts on but contacts.
inline AppliedForces applied_by(const BodyForces &body, const BlockProperties &block) {
  return {{Vec2{} - block.mass * body.shaking, 0.0}, block.heavy_mass() * body.gravity, {}};
}
/// What was applied to a row in the last evaluation.
inline AppliedForces applied_forces(const BlockSystem &system, std::size_t row) {
  const AppliedForces *own = system.applied_to(row);
  return own != nullptr ? *own : applied_by(system.body, system.properties[row]);
}
/// Rows that need an entry of BlockSystem::applied get one, others lose theirs.
/// @param all  more acts on all blocks
void list_applied(BlockSystem &system, bool all);

/// Where contact forces are taken next, with the way there; not posed yet.
void set_trial(BlockSystem &system, std::size_t row, const TrialConfiguration &trial);
/// There has been no way to the present trial configurations.
void forget_increments(BlockSystem &system);

/// Drop all rows from `count` on. The ranges' counts are the caller's.
void keep_rows(BlockSystem &system, std::size_t count);

/// Find what is derived from the trial configuration of rows [first, last).
void pose(BlockSystem &system, std::size_t first, std::size_t last);

/// World vertices of a row at its trial configuration, outward unit normals and lengths of the edges that
/// start at them.
struct TrialOutline {
  std::vector<Vec2> vertex;
  std::vector<Vec2> normal;
  std::vector<double> length;

  TrialOutline() = default;
  TrialOutline(const BlockSystem &system, std::size_t row) { find(system, row); }
  /// @param row  is posed
  void find(const BlockSystem &system, std::size_t row);
};

/// Length of the edge from vertex k of a row in its own axes, m.
double reference_length(const BlockSystem &system, std::size_t row, std::size_t k);

/// World vertices of one row at t_n.
std::vector<Vec2> current_vertices(const BlockSystem &system, std::size_t row);
/// The same behind others.
void append_current_vertices(const BlockSystem &system, std::size_t row, std::vector<Vec2> &vertices);

} // namespace gcpdda
