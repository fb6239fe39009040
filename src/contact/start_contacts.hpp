#pragma once

// Which stretches of edges touch at the start, under which laws: by these water tables choose what they wet.
//
// A contact takes its law from whichever of its two edges names one, and by the materials where neither does
// (contact/laws/region_law.hpp). Water stands in the joint and pushes on both of its faces. A face is
// therefore wet where the contact has a listed law, whichever block names it: were it wet by its own name
// alone, the water would push one block and not the other one back.
//
// An edge may face several contacts. The law of each holds on the stretch of the edge that the contact
// covers, and the law of the edge itself on what faces nothing. Stretches are found from the shapes at the
// start, as bonds are (contact/laws/bonds.hpp), and stay with the block however far it moves, as edges with a
// name do.

#include "contact/candidates.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace gcpdda {

/// A stretch of an edge of one block that lies on an edge of another block.
struct StartContact {
  std::int64_t block = -1;
  std::int64_t other = -1;
  std::int32_t edge = 0; ///< of `block`
  std::int32_t law = -1;
  double begin = 0.0; ///< share of the edge's length from its first vertex
  double end = 1.0;
};

/// Both sides of all contacts of these pairs, sorted by block, edge, begin and other block.
///
/// @param system  at t = 0, with the shapes that the scene draws
/// @param pairs  whose boxes meet
/// @param joints  laws of contacts
std::vector<StartContact> find_start_contacts(const BlockSystem &system,
                                              std::span<const std::pair<BlockIndex, BlockIndex>> pairs,
                                              const JointLaws &joints);

/// Sort as find_start_contacts() does.
void sort_start_contacts(std::vector<StartContact> &contacts);

/// BlockSystem::water_stretch of a row: of those edges alone whose contacts change what is wet.
///
/// @param contacts  of this block, sorted
/// @param is_listed  by law, whether a water table lists it; others count as -1
std::vector<WaterStretch> water_stretches_of(const BlockSystem &system, std::size_t row,
                                             std::span<const StartContact> contacts,
                                             const std::vector<bool> &is_listed);

} // namespace gcpdda
