#pragma once

// Liners among the links of a run (bolts.hpp): how they are put in, and what is written of them.

#include "dynamics/bolt_link.hpp"
#include "gcpdda/model/scene.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace gcpdda {

/// An element of a liner as a line from node to node; rock lies on the right.
struct LinerLine {
  std::uint32_t link = 0;     ///< index into Bolts::links()
  std::array<Vec2, 2> points; ///< m
  LinkMemory memory;
  /// At both nodes, positive where the side of the rock is in tension, N.
  std::array<double, 2> moments{};
  double strength_used = 0.0; ///< largest share; 1 where it is broken
};

/// The elements of liners of the scene where the blocks are at t_n, liner by liner; their ends are world
/// positions yet, not those of a block. What is odd about a liner becomes a note. Collective.
/// @param system  owned and fixed rows
/// @param which  indices into Scene::liners, ascending
std::vector<BoltLink> lay_liners(const Communicator &communicator, const Scene &scene,
                                 const BlockSystem &system, std::span<const std::int64_t> which,
                                 Diagnostics &notes);

/// An element in the posed trial configuration, without its number.
LinerLine line_of(const BlockSystem &system, const BoltLink &link, const std::array<std::size_t, 2> &rows,
                  const LinkLaw &law);

} // namespace gcpdda
