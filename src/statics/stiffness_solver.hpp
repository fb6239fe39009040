#pragma once

// (K + rho D) g = f by conjugate gradients with a preconditioner of two levels.
//
// K is the stiffness of contacts (springs.hpp) and of the blocks themselves, D the mass of pseudo-time
// (block_stiffness.hpp). No matrix but the coarse one is made: a product reads 80 bytes a region and the
// matrix of each block. The preconditioner is
//     z = B^-1 r + P K_c^-1 P^T r,
// with B the blocks on the diagonal of K + rho D and K_c the coarse matrix of rigid motions of cells of
// blocks (coarse_grid.hpp). The iteration ends when r^T z has fallen to `accuracy` squared of what it began
// with: g is a direction of a motion in pseudo-time and need not be exact.
//
// Same bits on any number of ranks: a block sums its springs in the order of its partners' ids, border
// springs are on both ranks, search directions of ghosts are copies of their owners', and the two inner
// products of an iteration are sums of one number a block, as integers in units of 2^-44 of the product
// before: one word a reduction, and a rounding far below what the iteration leaves.

#include "statics/block_stiffness.hpp"
#include "statics/border_rows.hpp"
#include "statics/coarse_grid.hpp"

#include <cstdint>

namespace gcpdda::statics {

class StiffnessSolver {
public:
  explicit StiffnessSolver(const Communicator &communicator)
      : communicator_(communicator), coarse_(communicator), border_(communicator) {}

  /// A neighbourhood that has been made anew. Collective.
  /// @param moving  rows to solve for
  /// @param mass  D of owned rows
  /// @param bolts  of owned rows
  void lay(const BlockSystem &system, std::vector<RowRun> moving, BlockMatrices mass, BlockMatrices bolts,
           std::vector<BorderRows> border);
  /// K of these springs, from here on. Collective.
  /// @param rho  of each owned row
  /// @param with_coarse  make the coarse matrix anew
  void set(const BlockSystem &system, const ContactSprings &springs, double rho, bool with_coarse);

  /// Solve for moving rows. Collective.
  /// @return number of products with K
  std::int64_t solve(const BlockSystem &system, const ContactSprings &springs, const Field &force,
                     Field &solution);
  /// y = (K + rho D) p for moving rows, with p of ghosts copied. Collective.
  void multiply(const BlockSystem &system, const ContactSprings &springs, Field &p, Field &y);

  [[nodiscard]] const BlockMatrices &mass() const { return mass_; }
  double accuracy = 0.1;
  std::int64_t most_products = 200;

private:
  void precondition(const BlockSystem &system, const Field &r, Field &z);

  Communicator communicator_;
  CoarseGrid coarse_;
  BorderExchange border_;
  std::vector<RowRun> moving_;
  BlockMatrices mass_;
  BlockMatrices bolts_;
  BlockMatrices own_;     ///< rho D and own springs
  BlockMatrices inverse_; ///< B^-1
  Field r_;
  Field z_;
  Field p_;
  Field q_;
};

/// Sum over rows of products of two fields, to the last bit. Collective.
double exact_product(const Communicator &communicator, std::span<const RowRun> rows, const Field &a,
                     const Field &b);
/// The same in units of 2^-44 of a number of its size, which is positive and the same on all ranks; what a
/// row adds is at most 2^18 times that. Collective.
double product_near(const Communicator &communicator, std::span<const RowRun> rows, const Field &a,
                    const Field &b, double size);

} // namespace gcpdda::statics
