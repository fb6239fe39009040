#pragma once

#include "gcpdda/base/ids.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gcpdda {

enum class ContactState : std::uint8_t { open = 0, stick = 1, slip = 2 };

/// Memory of one contact region. Alive from its first evaluation with an overlap to its last.
struct RegionMemory {
  double shear = 0.0;   ///< F_t: along -t_r on the lower block, along t_r on the higher one, N/m
  double longest = 0.0; ///< largest extent along t_r so far, m: the tangential stiffness never falls
  double slip = 0.0;    ///< accumulated sliding distance, m
  ContactState state = ContactState::open;
};

/// A memory with its identity, as it travels with a block.
struct RegionRecord {
  BlockId lower;
  BlockId higher;
  RegionMemory memory;
};

/// Contact memory in the order of the candidate pairs; one region a pair of convex blocks.
struct ContactHistory {
  std::vector<RegionMemory> regions;
};

} // namespace gcpdda
