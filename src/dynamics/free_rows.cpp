#include "block_lanes.hpp"

#include <algorithm>
#include <bit>

namespace gcpdda {

namespace {

bool are_free(const BlockSystem &system, std::size_t first, std::size_t last) {
  const auto has_none = [&](const std::vector<std::uint32_t> &begin) { return begin[first] == begin[last]; };
  return has_none(system.deformation_begin) && has_none(system.matrix_begin) && has_none(system.load_begin) &&
         has_none(system.anchor_begin) && has_none(system.dashpot_begin) &&
         std::none_of(system.properties.begin() + static_cast<std::ptrdiff_t>(first),
                      system.properties.begin() + static_cast<std::ptrdiff_t>(last),
                      [](const BlockProperties &p) { return p.keeps_its_velocity(); });
}

} // namespace

std::size_t advance_free_rows(BlockSystem &system, const FreeRows &rows, const Scheme &scheme,
                              double time_step, std::size_t first, std::size_t last,
                              std::optional<std::size_t> &broken, Instructions instructions) {
  const BlockLanes lanes = block_lanes(instructions);
  for (; first + lanes.width <= last && are_free(system, first, first + lanes.width); first += lanes.width) {
    const unsigned bad = lanes.step_free_rows(system, first, rows, scheme, time_step);
    if (bad != 0) {
      const std::size_t row = first + static_cast<std::size_t>(std::countr_zero(bad));
      broken = std::min(row, broken.value_or(row));
    }
  }
  return first;
}

} // namespace gcpdda
