#pragma once

// Tells whether deformable blocks are strained by more than linear elasticity is meant for.
//
// The strain of a block is the largest distance of a principal stretch of its deformation gradient from 1. It
// does not change when the block turns. Blocks are looked at where results are written; a step costs nothing.

#include "simulation/run_state.hpp"

#include <cstdint>
#include <optional>

namespace gcpdda {

/// Linear elasticity is meant for strains below this.
inline constexpr double large_strain = 0.1;

/// Largest distance of a principal stretch from 1.
double strain_of(const Mat2 &gradient);

/// The most strained of several deformable blocks.
struct LargestStrain {
  double strain = 0.0;
  std::int64_t block = -1;    ///< its id, the smallest of equally strained blocks; -1 without such blocks
  std::int32_t material = -1; ///< index into Scene::materials
};

/// Of all ranks together, without blocks whose state is no longer finite. Collective.
LargestStrain largest_strain(const Communicator &communicator, const BlockSystem &blocks);

class StrainWatch {
public:
  /// Look at the current state. Collective.
  /// @return a warning at the first look that sees a large strain
  std::optional<Diagnostic> look(const RunState &run);

private:
  bool has_told_ = false;
};

} // namespace gcpdda
