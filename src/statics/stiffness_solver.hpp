#pragma once

// (K + rho D) g = f by conjugate gradients with a preconditioner of two levels.
//
// K is the stiffness of contacts (springs.hpp) and of the blocks themselves, D the mass of pseudo-time
// (block_stiffness.hpp). No matrix but the coarse one is made: a product reads the springs (44 bytes a region
// of rigid blocks) and the matrix of each block. All of it is in single precision (spring_products.hpp) but
// the coarse matrix and the sums; f is scaled to about one. The preconditioner is
//     z = B^-1 r + P K_c^-1 P^T r,
// with B the blocks on the diagonal of K + rho D and K_c the coarse matrix of rigid motions of cells of
// blocks (coarse_grid.hpp). The iteration ends when r^T z has fallen to `accuracy` squared of what it began
// with: g is a direction of a motion in pseudo-time and need not be exact. A tenth is as far as that goes:
// with a fifth a slope of 10,883 blocks still rests after as many evaluations, but of 60 trials of a wet
// slope 0.2 to 1 % below its limit 7 run past the place where they would rest and fail, and none with a
// tenth.
//
// An iteration has one reduction. All that it adds over the ranks is known with q = (K + rho D) p: p^T q,
// P^T q on the coarse grid, and with w = B^-1 r and u = B^-1 q also w^T q and u^T q. Then a = r^T z/p^T q,
// and
//     x + a p,   w - a u,   P^T r - a P^T q,   r^T w - 2 a w^T q + a^2 u^T q
// follow without another one, as well as the coarse motions g = K_c^-1 P^T r, which every rank finds,
// r^T z = r^T w + (P^T r)^T g and the next p = w + P g + b p. r itself is not kept. Nothing in r^T w cancels
// but what the iteration takes away: its error is that of single precision, of the largest r^T w so far.
// Ranks wait for each other once: rows of u travel to their ghosts while the sums are added, and the w and p
// of a ghost go on from u as its owner's do, to the same bits.
//
// Same bits on any number of ranks: a block sums its springs in the order of its partners' ids, border
// springs are on both ranks, search directions of ghosts are those of their owners, and inner products are
// sums of one number a block, as integers in units of 2^-44 of r^T z (`SumInUnits`): one word each, and a
// rounding far below what the iteration leaves.
//
// Large models read their fields from main memory. An iteration passes over them twice: q with all sums, and
// the new x, w and p.

#include "statics/block_stiffness.hpp"
#include "statics/border_rows.hpp"
#include "statics/coarse_grid.hpp"
#include "statics/spring_products.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace gcpdda::statics {

class StiffnessSolver {
public:
  explicit StiffnessSolver(const Communicator &communicator)
      : communicator_(communicator), coarse_(communicator), border_(communicator) {}

  /// A neighbourhood that has been made anew. Collective.
  /// @param moving  rows to solve for
  /// @param mass  D of owned rows
  void lay(const BlockSystem &system, std::vector<RowRun> moving, BlockMatrices mass,
           std::vector<BorderRows> border);
  /// Solve for some of its rows from here on; the others stay where they are. Collective.
  /// @param moving  of the owned rows
  /// @param moves  the same by row, ghosts included
  void choose(const BlockSystem &system, std::vector<RowRun> moving, std::span<const std::uint8_t> moves);
  /// Copy rows to their ghosts. Collective.
  void copy_to_ghosts(Field &field) { border_.copy(field); }
  /// K of these springs, from here on. Collective.
  /// @param rho  of each owned row
  /// @param with_coarse  make the coarse matrix anew
  void set(const BlockSystem &system, const ContactSprings &springs, double rho, bool with_coarse);

  /// Solve for moving rows. Collective.
  /// @return number of products with K
  std::int64_t solve(const BlockSystem &system, const ContactSprings &springs, const Field &force,
                     Field &solution);
  /// force -= gamma (1 - s) K' v for moving rows, with the velocities v of pseudo-time, K' the stiffness of
  /// all that does not slip, without rho D, and s the share that K' has of v.q, within [0, 1]. Collective.
  /// @param momentum  v.q, positive
  void damp_strains(const BlockSystem &system, const ContactSprings &springs, double gamma, double momentum,
                    Field &force);
  /// y = (K + rho D) p for moving rows; p of ghosts is copied first. Collective.
  void multiply(const BlockSystem &system, const ContactSprings &springs, LeanField &p, LeanField &y);

  [[nodiscard]] const BlockMatrices &mass() const { return mass_; }
  /// What this rank has sent to others, but for reductions.
  [[nodiscard]] const BorderExchange::Sent &sent() const { return border_.sent(); }
  double accuracy = 0.1;
  std::int64_t most_products = 200;

private:
  /// Those for which moves(row).
  template <class Moves> void take_moving_ghosts(const BlockSystem &system, Moves &&moves);
  /// For rows of so many places.
  template <int places> std::int64_t solve_by(const BlockSystem &system, const Field &force, Field &solution);
  /// What q is multiplied by in an iteration: p^T q, w^T q and u^T q.
  struct AlongQ {
    double p = 0.0;
    double w = 0.0;
    double u = 0.0;
  };
  /// x = 0, w, of ghosts too, and P^T r on the coarse grid. Collective.
  /// @return r^T w
  template <int places> double begin(const BlockSystem &system, const Field &force, double scale);
  /// p = w + P g
  template <int places> void find_first_p(const BlockSystem &system);
  /// Finds q, u in its place, of ghosts too, P^T q on the coarse grid, and what q is multiplied by.
  /// Collective.
  /// @param size  r^T z
  template <int places> AlongQ find_q_and_u(const BlockSystem &system, double size);
  /// x + a p, and where the iteration goes on w - a u and the next p.
  template <int places> void advance(const BlockSystem &system, float step, float share, bool goes_on);
  /// y = (K + rho D) p with the springs at hand. visit(row, its p, its y).
  template <int places, class Visit> void multiply_by(LeanField &p, LeanField &y, Visit &&visit);

  Communicator communicator_;
  CoarseGrid coarse_;
  BorderExchange border_;
  std::vector<RowRun> moving_;
  std::vector<RowRun> moving_ghosts_;
  BlockMatrices mass_;
  double rho_ = 0.0;
  SpringProducts springs_; ///< of the product at hand
  BlockMatrices diagonal_; ///< while B is made
  LeanField own_;          ///< rho D and own springs, a column of `lean_width` places for each freedom
  LeanField inverse_;      ///< B^-1, the same
  LeanField x_;
  LeanField w_;
  LeanField p_;
  LeanField q_; ///< and u, once q has been added up
};

/// A sum over rows in units of 2^-44 of a number of its size, which is positive and the same on all ranks.
/// What a row adds is at most 2^18 times that. Units of several ranks are added as integers.
class SumInUnits {
public:
  explicit SumInUnits(double size)
      : exponent_(std::ilogb(size) - 44), per_unit_(std::ldexp(1.0, -exponent_)) {}
  void add(double value) {
    constexpr double most = 0x1p62;
    sum_ += static_cast<std::uint64_t>(std::llrint(std::clamp(value * per_unit_, -most, most)));
  }
  [[nodiscard]] std::int64_t units() const { return static_cast<std::int64_t>(sum_); }
  [[nodiscard]] double value(std::int64_t units) const {
    return std::ldexp(static_cast<double>(units), exponent_);
  }

private:
  int exponent_;
  double per_unit_;
  std::uint64_t sum_ = 0; ///< that parts of it run over does not matter, the whole is small
};

} // namespace gcpdda::statics
