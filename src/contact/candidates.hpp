#pragma once

// Pairs of blocks that may touch until the next refresh, in groups and by the way they are computed.

#include "base/ids.hpp"
#include "gcpdda/model/scene.hpp"
#include "model/block_system.hpp"
#include "model/contact_history.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// Two blocks that may touch before the next refresh, with what stays constant for the pair.
struct CandidatePair {
  // The lanes read these with what stands behind them.
  double damping = 0.0;         ///< c'/2 of the normal dashpot, Pa s/m
  double mass = 0.0;            ///< m_A m_B/(m_A + m_B), kg per metre
  double allowed_overlap = 0.0; ///< half the narrowest width: deeper than this the force reverses, m
  BlockIndex lower;             ///< row of the block with the lower id
  BlockIndex higher;            ///< row of the block with the higher id
  std::int32_t law = 0;
  bool is_convex = true; ///< both blocks are: one region at most
  /// Its regions may take different laws, see region_law.hpp; law and damping are those of one of them.
  bool is_mixed = false;
  bool is_plain = false; ///< listed in Candidates::plain
};

/// A pair of convex blocks with few edges, and those neighbouring ones of each that can take part in the
/// contact before the next refresh. Whether a pair is plain depends on its shapes and the laws of its edges
/// alone, so that no bit of a run depends on when the neighbourhood is refreshed.
struct PlainPair {
  std::uint32_t pair = 0;
  /// Pairs that have these in common may share an evaluation.
  struct Kind {
    std::uint8_t lower_edges = 0;
    std::uint8_t higher_edges = 0;
    bool is_deformable = false; ///< at least one block is
    bool has_few_edges = false; ///< neither block has more than most_corner_edges

    /// One corner of each block may be inside the other one.
    [[nodiscard]] bool may_be_corners() const { return has_few_edges && lower_edges > 1 && higher_edges > 1; }
  };
  Kind kind;
  // The ends of the lower and of the higher block's edges, one more than edges: numbers of vertices in their
  // blocks, in `rings` from here on.
  std::uint8_t lower_ends = 0;
  std::uint8_t higher_ends = 0;
  bool is_mixed = false; ///< CandidatePair::is_mixed

  /// Pairs of neighbouring numbers are evaluated together, while their blocks are in the cache.
  static constexpr std::uint32_t pairs_in_group = 1024;
  [[nodiscard]] std::uint32_t group() const { return pair / pairs_in_group; }
  [[nodiscard]] bool is_like(const PlainPair &other) const {
    return std::bit_cast<std::uint32_t>(kind) == std::bit_cast<std::uint32_t>(other.kind);
  }
};

/// Most edges of one block of a plain pair.
constexpr std::size_t most_plain_edges = 8;

constexpr std::size_t least_vertices = 3;
/// Where vertex `first` of a block with so many vertices stands in `rings`.
constexpr std::size_t place_in_rings(std::size_t num_vertices, std::size_t first) {
  return num_vertices * (num_vertices - 1) - least_vertices * (least_vertices - 1) + first;
}
/// Numbers of vertices twice around blocks with three vertices, with four and so on: a chain of edges that
/// starts anywhere goes on in one piece.
inline constexpr auto rings = [] {
  std::array<std::uint8_t, place_in_rings(most_plain_edges + 1, 0)> numbers{};
  for (std::size_t n = least_vertices; n <= most_plain_edges; ++n) {
    for (std::size_t k = 0; k < 2 * n; ++k) {
      numbers[place_in_rings(n, k)] = static_cast<std::uint8_t>(k % n);
    }
  }
  return numbers;
}();

/// Pairs without a ghost that are evaluated together, and the owned rows that this asks for and sets free.
struct PairGroup {
  std::uint32_t number = 0; ///< PlainPair::group of its plain pairs
  std::uint32_t first = 0;  ///< its plain pairs are entries [first, last) of Candidates::plain
  std::uint32_t last = 0;
  std::uint32_t rows_read = 0;     ///< this group and those before it read no owned row from here on
  std::uint32_t rows_finished = 0; ///< later groups add to no owned row below; at most rows_read
  bool is_last = false;            ///< the last group takes all general pairs without a ghost as well
};

/// Which pairs may touch, as flat lists.
struct Candidates {
  std::vector<CandidatePair> pairs; ///< with at least one owned block, by (lower id, higher id)
  std::vector<LawConstants> laws;   ///< by CandidatePair::law
  // In the order in which they are evaluated: first those without a ghost, whose number stands beside.
  std::vector<PlainPair> plain; ///< those of like numbers of edges together, in the first ones by groups
  std::size_t num_interior_plain = 0;
  std::vector<std::uint32_t> general; ///< numbers of all other pairs
  std::size_t num_interior_general = 0;
  /// By owned row: all of its pairs are plain and without a ghost, and come in the order of the other blocks'
  /// ids; see BlockSums.
  std::vector<std::uint8_t> is_added;
  std::vector<std::uint32_t> waiting; ///< numbers of the pairs of the others, in order
  /// Places in `waiting` of the plain pairs with a ghost, as these stand in `plain`; and these, by ascending
  /// pair.
  std::vector<std::uint32_t> border_places;
  std::vector<std::uint32_t> border_entries;
  std::vector<std::uint8_t> are_added; ///< by PlainPair::group: none of its pairs is one of these
  std::vector<PairGroup> groups;       ///< at least one; those that have a plain pair without a ghost

  /// Of an entry of `plain` with a ghost, in `waiting`.
  [[nodiscard]] std::size_t border_place(std::size_t entry) const {
    return border_places[entry - num_interior_plain];
  }
  /// visit(entry of `plain`) for all pairs of a group.
  template <class Visit> void for_plain_of_group(std::uint32_t group, Visit &&visit) const {
    const auto interior_end = plain.begin() + static_cast<std::ptrdiff_t>(num_interior_plain);
    const auto first = std::partition_point(plain.begin(), interior_end,
                                            [&](const PlainPair &p) { return p.group() < group; });
    for (auto entry = first; entry != interior_end && entry->group() == group; ++entry) {
      visit(static_cast<std::size_t>(entry - plain.begin()));
    }
    auto border = std::partition_point(border_entries.begin(), border_entries.end(),
                                       [&](std::uint32_t k) { return plain[k].group() < group; });
    for (; border != border_entries.end() && plain[*border].group() == group; ++border) {
      visit(std::size_t{*border});
    }
  }
};

/// Most edges of blocks whose overlap of two corners has a kernel of its own
/// (contact/lanes/lane_corners.hpp): of all edges, not of those in a chain, or the kernel would depend on the
/// refreshes.
constexpr std::size_t most_corner_edges = 4;

/// What a pair's constants follow from.
struct ContactParameters {
  JointLaws joints;
  double damping_ratio = 0.0; ///< xi
  PotentialKind potential = PotentialKind::exact;
  double stiffness_damping = 0.0; ///< beta, s: dashpots of beta times the springs besides those of xi

  [[nodiscard]] bool has_dashpots() const { return damping_ratio > 0.0 || stiffness_damping > 0.0; }
  [[nodiscard]] LawConstants constants(std::int32_t law) const { return joints.constants(law); }
};

/// The candidates of those pairs, but for pairs of convex rigid blocks that a line of one keeps apart, and
/// the memory of each taken from `memory` (duplicates allowed).
///
/// @param skin  no block moves by more than half of it before the next refresh, m
Candidates make_candidates(const BlockSystem &system,
                           std::span<const std::pair<BlockIndex, BlockIndex>> pairs,
                           const ContactParameters &parameters, ContactMemory memory, ContactHistory &history,
                           double skin);

} // namespace gcpdda
