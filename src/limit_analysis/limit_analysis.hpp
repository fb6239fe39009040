#pragma once

// An upper bound of the factor of safety by limit analysis of rigid blocks (static theorem), without a run.
//
// Blocks and the joints between them are taken as they lie. A joint is a straight piece that carries normal
// forces n1, n2 >= 0 at its ends and shear along it. Written as a sum over the edges of the friction cones at
// both ends, with the normal n and the tangent t of the joint and m = tan(phi),
//     force = sum over ends k of (a_k (n + m t) + b_k (n - m t) - T l/2 n) + s t,
//     a_k, b_k >= 0,   |s| <= (c - m T) l,
// so that |shear| <= m N + c l, and N >= -T l/2 at each end, with the tensile strength T <= c/m of a bond.
// These are all forces that the law of the joint admits. The blocks can hold only if some of them balance the
// load of every block: three linear equations for each. The set of admissible forces shrinks where m, c and T
// are divided by a larger factor, and the largest factor for which a balance exists is found by bisection,
// each time by a linear programme: the largest share of the loads, up to all of them, that admissible forces
// balance.
//
// Bolts, liners and fixed points pull as they do in the load, and as much more or less as they may come to.
//
// No equilibrium with a larger factor exists at this geometry, whatever path led to it, so that the factor of
// a run lies below the bound, but where blocks first move on to another geometry and hold there (joints that
// may close on the way can be given, too). It is no lower bound: friction is not associated (slip does not
// open joints), and a run need not find the forces that would balance the load.

#include "gcpdda/geometry/vec2.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace gcpdda {

/// A linear programme took too long; the same on every rank.
class UnsolvedProgramme : public std::runtime_error {
public:
  UnsolvedProgramme(std::size_t blocks, std::size_t forces);
};

/// What a block has to bear.
struct LimitBlock {
  Vec2 centroid;
  double size = 1.0; ///< m: the arm that makes a force of a moment
  Vec2 load;         ///< of all but its joints, N/m
  double torque = 0.0;
};

struct LimitJoint {
  std::int64_t first = -1; ///< number of a block; -1: one that is fixed
  std::int64_t second = -1;
  Vec2 begin;
  Vec2 end;
  Vec2 normal; ///< of pressure on the first block
  double tan_friction = 0.0;
  double cohesion = 0.0; ///< force over the whole joint, N/m
  double tension = 0.0;  ///< the same
  bool is_weakened = true;
};

/// A force or a couple that may differ from what the load has of it, whatever strengths are divided by.
struct LimitForce {
  std::int64_t first = -1; ///< number of a block; -1: one that is fixed
  std::int64_t second = -1;
  std::array<Vec2, 2> point; ///< on each of them
  Vec2 direction;            ///< of the force on the first block; zero: a couple
  double least = 0.0;        ///< change, N/m; of a couple N
  double most = 0.0;
};

struct LimitModel {
  std::vector<LimitBlock> blocks;
  std::vector<LimitJoint> joints;
  std::vector<LimitForce> forces;
};

/// Whether some admissible forces balance the loads when the strengths of weakened joints are divided by
/// `factor`.
/// @throws UnsolvedProgramme
bool can_hold(const LimitModel &model, double factor);

/// The bound to `tolerance` of it, from above; nothing where the blocks could still hold at `most`, and
/// `least` where they cannot even hold at that.
/// @throws UnsolvedProgramme
std::optional<double> bound_of_factor(const LimitModel &model, double least, double most, double tolerance);

} // namespace gcpdda
