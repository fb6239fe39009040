#include "simulation/water_loads.hpp"

namespace gcpdda {

WaterLoad water_on(const RunState &run, std::size_t row, double gravity, TrialOutline &outline) {
  const RigidDof begin = run.blocks.mark_of(row).water;
  const bool asks_for_rest = run.clock.is_staged && run.clock.stage().asks_for_rest();
  return water_load(run.blocks, row, run.scene.water, gravity, asks_for_rest ? &begin : nullptr, outline);
}

} // namespace gcpdda
