#include "block_lanes.hpp"

#include "gcpdda/base/prefetch.hpp"

#include <algorithm>
#include <bit>

namespace gcpdda {

namespace {

bool are_free_and_rigid(const BlockSystem &system, std::size_t first, std::size_t last) {
  return system.deformation_begin[first] == system.deformation_begin[last] &&
         system.matrix_begin[first] == system.matrix_begin[last] && are_free(system, first, last);
}

} // namespace

std::size_t gather_free_deformables(BlockSystem &system, const FreeRows &rows, std::size_t first,
                                    std::size_t last, Instructions instructions) {
  const BlockLanes lanes = block_lanes(instructions);
  const auto are_deformable = [&](std::size_t row) {
    return system.deformation_begin[row + lanes.width] - system.deformation_begin[row] == lanes.width;
  };
  while (first + lanes.width <= last && are_deformable(first) &&
         are_free(system, first, first + lanes.width)) {
    const std::size_t next = first + lanes.width; // of structures this large the processor fetches none ahead
    prefetch(system.deformation.data() + system.deformation_begin[next], lanes.width * sizeof(Deformation));
    prefetch(system.matrix.data() + system.matrix_begin[first], lanes.width * sizeof(BlockMatrix));
    lanes.gather_deformables(system, first, rows);
    first += lanes.width;
  }
  return first;
}

std::size_t advance_free_rows(BlockSystem &system, const FreeRows &rows, const Scheme &scheme,
                              double time_step, std::size_t first, std::size_t last,
                              std::optional<std::size_t> &broken, std::vector<RowSpan> &restless,
                              Instructions instructions) {
  const BlockLanes lanes = block_lanes(instructions);
  for (; first + lanes.width <= last && are_free_and_rigid(system, first, first + lanes.width);
       first += lanes.width) {
    const FreeStep step = lanes.step_free_rows(system, first, rows, scheme, time_step);
    if (step.broken != 0) {
      const std::size_t row = first + static_cast<std::size_t>(std::countr_zero(step.broken));
      broken = std::min(row, broken.value_or(row));
    }
    if (step.restless != 0) {
      restless.push_back({first, first + lanes.width});
    }
  }
  return first;
}

} // namespace gcpdda
