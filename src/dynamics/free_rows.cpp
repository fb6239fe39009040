#include "dynamics/free_rows.hpp"

#include "dynamics/block_solve.hpp"

#include "base/prefetch.hpp"

#include <bit>

namespace gcpdda {

std::size_t advance_free_rows(BlockSystem &system, const FreeRows &rows, const Scheme &scheme,
                              double time_step, Elasticity elasticity, std::size_t first, std::size_t last,
                              AdvanceReport &report, Instructions instructions) {
  const BlockLanes &lanes = block_lanes(instructions);
  const BlockSolve step = block_solve({.local_damping = rows.local_damping}, scheme, time_step, elasticity);
  for (std::size_t end = first + lanes.width; end <= last; first = end, end += lanes.width) {
    const std::size_t entry = system.deformation_begin[first];
    const std::size_t num_deformable = system.deformation_begin[end] - entry;
    const bool are_rigid = num_deformable == 0 && system.matrix_begin[first] == system.matrix_begin[end];
    const bool are_deformable = rows.have_deformable && num_deformable == lanes.width;
    if (!(are_rigid || are_deformable) || !are_free(system, first, end)) {
      break;
    }
    if (are_deformable) { // of structures this large the processor fetches none ahead
      prefetch(system.deformation.data() + entry + lanes.width, lanes.width * sizeof(Deformation));
    }
    const FreeStep done = are_rigid ? lanes.step_free_rows(system, first, rows, scheme, time_step)
                                    : lanes.step_free_deformables(system, first, rows, step);
    if (done.broken != 0) {
      report.add_broken(first + static_cast<std::size_t>(std::countr_zero(done.broken)));
    }
    if (done.to_check != 0) {
      report.rows_to_check.push_back({first, end});
    }
    report.add_turn(done.largest_turn);
  }
  return first;
}

} // namespace gcpdda
