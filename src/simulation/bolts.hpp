#pragma once

// The bolts and liners of a run: where they hold which blocks, and what their links do in the step. A link is
// a bolt at a joint, or the element of a liner between two blocks; all the rest is the same for both.
//
// Every rank knows all links, as it knows the scene (300 bytes each); a rank computes those of its own
// blocks, a link between blocks of two ranks on both from bit-equal data. The blocks of a link are ghosts of
// each other's owners however far apart they lie. At a refresh the ranks tell each other the memory of their
// links, so that whoever owns a block next has it; sums over links go in their order: along bolts in the
// order of the scene, then along liners.

#include "base/exact_sum.hpp"
#include "dynamics/bolt_link.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"
#include "parallel/ghosts.hpp"
#include "simulation/liners.hpp"
#include "statics/springs.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace gcpdda {

struct BlockContactSum;

/// A link as a line, from halfway to the link before, or the bolt's head, to halfway to the next, or its tip.
struct LinkLine {
  std::uint32_t link = 0; ///< index into Bolts::links()
  /// m; the second and third are the middle of the link as the block towards the head and the one towards the
  /// tip carry it, and part as the joint opens and slips.
  std::array<Vec2, 4> points;
  LinkMemory memory; ///< its largest forces with those of the last evaluation
};

/// What is written of a bolt: largest values over its links, for one bolt.
struct BoltReport {
  std::int64_t bolt = 0;
  Vec2 head; ///< m
  Vec2 tip;
  double axial = 0.0;     ///< largest tension, N
  double shear = 0.0;     ///< largest absolute value, N
  double extension = 0.0; ///< m
  double slide = 0.0;     ///< largest absolute value, m
  std::int64_t links = 0;
  std::int64_t yielded = 0; ///< links that have yielded, broken ones included
  std::int64_t broken = 0;
  double largest_axial = 0.0; ///< of the steps so far, N, as the next one
  double largest_shear = 0.0;
};

/// What a link does to an owned row at the last evaluation.
struct LinkPull {
  std::size_t row = 0;
  RigidDof rigid; ///< about the trial centroid
  Mat2 gradient;  ///< on F
};

/// Energies of links, J/m.
struct LinkEnergies {
  ExactSum stored;
  ExactSum dissipated;
};

class Bolts {
public:
  [[nodiscard]] bool empty() const { return links_.empty(); }
  [[nodiscard]] const std::vector<BoltLink> &links() const { return links_; }

  /// Put bolts of the scene in where the blocks are at t_n; what is odd about them becomes a note.
  /// Collective.
  /// @param system  owned and fixed rows
  /// @param which  indices into Scene::bolts, ascending
  /// @param is_gone  whether a block is to count as excavated
  void install(const Communicator &communicator, const Scene &scene, const BlockSystem &system,
               std::span<const std::int64_t> which, const std::function<bool(std::int64_t)> &is_gone,
               Diagnostics &notes);
  /// The same for liners.
  /// @param which  indices into Scene::liners, ascending
  void install_liners(const Communicator &communicator, const Scene &scene, const BlockSystem &system,
                      std::span<const std::int64_t> which, Diagnostics &notes);
  /// Take out the links for which it holds. The memory has been shared.
  void remove(const std::function<bool(const BoltLink &)> &is_gone);
  /// Bars end where blocks have been excavated. The memory has been shared.
  void end_at_voids(const std::function<bool(std::int64_t)> &is_gone);
  /// The laws of the scene from here on.
  void take_laws(const Scene &scene);

  /// Every rank learns the memory of all links. Collective.
  void share(const Communicator &communicator);
  /// The same without a change.
  [[nodiscard]] std::vector<BoltLink> shared(const Communicator &communicator) const;
  /// Owned rows that other ranks need. Collective.
  [[nodiscard]] std::vector<FarGhost> partners(const Communicator &communicator,
                                               const BlockSystem &system) const;
  /// Find the rows of this rank's links, ghosts among them.
  void connect(const BlockSystem &system);

  /// Forces at the posed trial configuration; the memory moves on to it.
  void evaluate(const BlockSystem &system);
  /// Forces of the last evaluation count among the largest ones.
  void note_largest();
  /// Add them to owned rows.
  void add_forces(const BlockSystem &system, std::span<BlockContactSum> sums) const;
  /// What they do to F, by entry of BlockSystem::deformation of owned rows.
  [[nodiscard]] Mat2 gradient_force(std::size_t deformation) const { return gradient_[deformation]; }

  /// On the owned blocks that stay, of links from blocks that go; in the order of the links.
  [[nodiscard]] std::vector<LinkPull> pulls_from(const std::function<bool(std::int64_t)> &goes,
                                                 const BlockSystem &system) const;

  /// visit(number of the link, link, its law, rows of its blocks) of those that count on this rank.
  template <class Visit> void for_counted(Visit &&visit) const {
    for (const Here &here : here_) {
      if (here.counts) {
        visit(here.link, links_[here.link], laws_[here.link], here.rows);
      }
    }
  }

  /// Of the links at a block.
  [[nodiscard]] std::span<const PointSpring> springs_at(std::int64_t block) const {
    return springs_.at(block);
  }
  /// All of this rank's links, which have been evaluated, as springs of the static solver.
  /// @param share  that is left of the stiffness of what gives
  [[nodiscard]] std::vector<statics::ContactSpring> static_springs(const BlockSystem &system,
                                                                   double share) const;

  /// Of the links that count on this rank: as they are ...
  void add_energies(double share, LinkEnergies &sums) const;
  /// ... and as they would be in the posed trial configuration.
  void add_energies_at(const BlockSystem &system, double share, LinkEnergies &sums) const;

  /// Of all links of bolts, in their order, in the posed trial configuration. Collective.
  [[nodiscard]] std::vector<LinkLine> lines(const Communicator &communicator,
                                            const BlockSystem &system) const;
  /// Of all elements of liners, in the same way. Collective.
  [[nodiscard]] std::vector<LinerLine> liner_lines(const Communicator &communicator,
                                                   const BlockSystem &system) const;
  /// Of all bolts that have links, in their order. Collective.
  [[nodiscard]] std::vector<BoltReport> report(const Communicator &communicator, const Scene &scene,
                                               const BlockSystem &system) const;

  /// For a checkpoint, and back.
  static constexpr std::size_t counts_per_link = 8;
  static constexpr std::size_t numbers_per_link = 33;
  static void to_numbers(const std::vector<BoltLink> &links, std::vector<std::int64_t> &counts,
                         std::vector<double> &numbers);
  static Bolts from_numbers(std::span<const std::int64_t> counts, std::span<const double> numbers);

private:
  /// A link with an owned block.
  struct Here {
    std::uint32_t link = 0;
    std::array<std::size_t, 2> rows{};
    bool counts = false; ///< this rank tells the others of it
  };
  /// Links in their order, once the ends of those from `first` on are in the axes of their blocks.
  void find_ends(const Communicator &communicator, const BlockSystem &system, std::size_t first);
  [[nodiscard]] std::array<double, 2> reach_of(std::size_t link) const;

  std::vector<BoltLink> links_;
  std::vector<LinkLaw> laws_;
  /// Springs by block.
  struct BlockSprings {
    std::vector<std::int64_t> block; ///< ascending, of each of springs
    std::vector<PointSpring> springs;

    [[nodiscard]] std::span<const PointSpring> at(std::int64_t wanted) const;
  };
  [[nodiscard]] BlockSprings springs_of_links() const;

  BlockSprings springs_;
  std::vector<Here> here_;
  std::vector<LinkForce> forces_; ///< by here_
  std::vector<Mat2> gradient_;    ///< by entry of BlockSystem::deformation
  bool connected_ = false;
};

} // namespace gcpdda
