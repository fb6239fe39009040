#include "simulation/static_evaluation.hpp"

#include "contact/block_sums.hpp"
#include "contact/stiffness_bound.hpp"
#include "dynamics/static_springs.hpp"
#include "simulation/evaluation.hpp"
#include "simulation/step_rows.hpp"

#include <array>
#include <utility>
#include <vector>

namespace gcpdda {

void lay_statics(RunState &run) {
  std::vector<StiffnessBound> stiffness;
  for (std::size_t row = 0; row < run.blocks.num_owned; ++row) {
    stiffness.push_back(stiffness_bound(run.scene.joints, run.blocks.properties[row].material));
  }
  const bool any_deformable = run.communicator.max(run.blocks.deformation.empty() ? 0.0 : 1.0) > 0.0;
  std::vector<statics::BorderRows> border;
  run.neighbours.ghosts.for_neighbours(
      [&](int rank, const std::vector<std::uint32_t> &send, const std::vector<std::uint32_t> &receive) {
        border.push_back({rank, send, receive});
      });
  run.statics->lay(run.blocks, stiffness, any_deformable, std::move(border));
}

void evaluate_statically(RunState &run) {
  run.loads.time = run.clock.time();
  {
    const auto scope = run.phases.measure(Phase::forces);
    evaluate_all(run);
  }
  sum_forces(run);
  StepRows(run).load_all();
  take_own_springs(run.blocks);
}

// Springs are known to both ranks of a border pair; the one that counts the pair sends them to the owners of
// its blocks.
void refresh_statics(RunState &run) {
  std::vector<std::vector<statics::SpringRecord>> leaving(static_cast<std::size_t>(run.communicator.size()));
  for (const statics::SpringRecord &record : run.statics->springs().records()) {
    if (!counts_here(run.blocks, BlockIndex{record.spring.lower})) {
      continue;
    }
    std::array<int, 2> owners{-1, -1};
    const std::array<std::size_t, 2> rows{record.spring.lower, record.spring.higher};
    for (std::size_t k = 0; k < 2; ++k) {
      if (!run.blocks.is_fixed(rows[k])) {
        owners[k] =
            run.neighbours.map.rank_of(run.blocks.properties[rows[k]].centroid + run.blocks.trial[rows[k]].u);
      }
    }
    for (std::size_t k = 0; k < 2; ++k) {
      if (owners[k] >= 0 && (k == 0 || owners[1] != owners[0])) {
        leaving[static_cast<std::size_t>(owners[k])].push_back(record);
      }
    }
  }
  std::vector<statics::SpringRecord> here;
  refresh(run);
  for (const auto &brought : run.communicator.all_to_all(std::move(leaving))) {
    here.insert(here.end(), brought.begin(), brought.end());
  }
  run.statics->springs().take(run.blocks, std::move(here));
  lay_statics(run);
}

} // namespace gcpdda
