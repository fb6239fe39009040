#pragma once

// The rock beyond viscous sides goes on like that before them: what waves meet there is the mean of the
// blocks of the region that have the material of a block on the side, and deform or not as that one does
// (dynamics/jointed_rock.hpp). Only whole blocks count: one with an edge on the outline of the region is cut
// short by it, and that edge is no joint. Where rock has no whole block, as where slabs go through from side
// to side, a block on a side stands for a stack of blocks like it.

#include "dynamics/jointed_rock.hpp"
#include "dynamics/viscous_sides.hpp"
#include "simulation/run_state.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gcpdda {

/// Mean rock by material and kind of blocks.
class SideRock {
public:
  /// Collective.
  /// @param slab  blocks of this rank as the scene draws them, of ids from `first` on
  SideRock(const RunState &run, std::span<const SceneBlock> slab, std::int64_t first);

  /// What waves meet beyond an edge of a block.
  /// @param row  of the block
  [[nodiscard]] Impedance beyond(const BlockSystem &blocks, std::size_t row, const SceneBlock &block,
                                 std::size_t edge) const;

private:
  [[nodiscard]] std::array<double, 2> stiffness_on(const SceneBlock &block, std::size_t edge) const;

  const Scene *scene_;
  std::vector<std::optional<Compliance>> of_joints_; ///< by material, of rigid blocks before deformable ones
};

} // namespace gcpdda
