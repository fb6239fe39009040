// A region cut by all ranks: the same blocks, byte for byte, and the same run.

#include "io/results/id_slabs.hpp"
#include "simulation/region_slabs.hpp"
#include "simulation/simulation.hpp"
#include "support/regions.hpp"
#include "support/setting.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace gcpdda::region_test {
namespace {

using testing::jointed_slope;
using testing::same;

std::int64_t agreed_sum(const Communicator &world, std::int64_t value) {
  world.sum(std::span(&value, 1));
  return value;
}

TEST(Region, IsCutIntoTheSameBlocksByAnyNumberOfRanks) {
  const Communicator world = Communicator::world();
  const Scene scene = jointed_slope();
  const RegionCutter cutter(scene, 40);
  const std::vector<SceneBlock> whole = cutter.make(0, cutter.num_tiles()).blocks;
  constexpr std::int64_t first = 5; // blocks before those of the region
  const std::int64_t num_blocks = first + static_cast<std::int64_t>(whole.size());
  std::vector<SceneBlock> mine = cutter
                                     .make(slab_begin(cutter.num_tiles(), world.size(), world.rank()),
                                           slab_begin(cutter.num_tiles(), world.size(), world.rank() + 1))
                                     .blocks;
  std::vector<SceneBlock> slab;
  send_to_slabs(world, num_blocks, first, std::move(mine), slab);
  const std::int64_t begin = std::max(first, slab_begin(num_blocks, world.size(), world.rank()));
  const std::int64_t end = std::max(first, slab_begin(num_blocks, world.size(), world.rank() + 1));
  ASSERT_EQ(agreed_sum(world, static_cast<std::int64_t>(slab.size()) == end - begin ? 0 : 1), 0);
  for (std::size_t k = 0; k < slab.size(); ++k) {
    EXPECT_TRUE(same(slab[k], whole[static_cast<std::size_t>(begin - first) + k])) << k;
  }
}

TEST(Region, RunsTheSameOnAnyNumberOfRanks) {
  const Communicator world = Communicator::world();
  Scene scene = jointed_slope();
  scene.run.duration = 0.01;
  scene.output.interval = scene.output.history_interval = 0.005;
  scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
  Simulation alone(Communicator::self(), scene);
  Simulation together(world, scene);
  for (int step = 0; step < 20; ++step) {
    alone.step();
    together.step();
  }
  ASSERT_EQ(alone.num_blocks(), together.num_blocks());
  ASSERT_EQ(together.scene().groups.size(), 1U);
  EXPECT_EQ(together.scene().groups[0].name, "tunnel");
  EXPECT_EQ(together.scene().groups[0].blocks, alone.scene().groups[0].blocks);
  EXPECT_GT(alone.scene().groups[0].blocks.size(), 3U);
  std::vector<std::vector<Vec2>> expected(static_cast<std::size_t>(alone.num_blocks()));
  for (std::size_t row = 0; row < alone.blocks().num_rows(); ++row) {
    expected[static_cast<std::size_t>(alone.blocks().properties[row].id.value)] =
        current_vertices(alone.blocks(), row);
  }
  const BlockSystem &blocks = together.blocks();
  for (std::size_t row = 0; row < blocks.num_owned; ++row) {
    EXPECT_EQ(current_vertices(blocks, row),
              expected[static_cast<std::size_t>(blocks.properties[row].id.value)]);
  }
  std::int64_t touching = 0;
  for (std::size_t k = 0; k < together.candidates().pairs.size(); ++k) {
    touching +=
        together.counts_here(together.candidates().pairs[k]) && together.history().is_living(k) ? 1 : 0;
  }
  EXPECT_GT(agreed_sum(world, touching), 300);
}

TEST(Region, OpeningsAreExcavatedByName) {
  const Communicator world = Communicator::world();
  Scene scene = jointed_slope();
  scene.run.duration = 0.01;
  scene.output.interval = scene.output.history_interval = 0.005;
  scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
  Stage opening;
  opening.kind = StageKind::excavate;
  opening.excavated.openings = {0};
  Stage run;
  run.duration = 0.005;
  scene.stages = {run, opening, run};
  Simulation simulation(world, scene);
  const auto mobile = static_cast<std::int64_t>(simulation.blocks().num_owned);
  const std::int64_t before = agreed_sum(world, mobile);
  testing::run_stages(simulation);
  const std::vector<std::int64_t> &gone = simulation.scene().groups.at(0).blocks;
  EXPECT_EQ(agreed_sum(world, static_cast<std::int64_t>(simulation.blocks().num_owned)),
            before - std::ssize(gone));
  for (std::size_t row = 0; row < simulation.blocks().num_rows(); ++row) {
    const std::int64_t id = simulation.blocks().properties[row].id.value;
    EXPECT_FALSE(std::binary_search(gone.begin(), gone.end(), id)) << id;
  }
}

TEST(Region, FaultsOfOneRankAreThoseOfAll) {
  const Communicator world = Communicator::world();
  Scene scene = jointed_slope();
  scene.region.slivers = SliverRule::refuse;
  scene.region_blocks = std::make_shared<RegionCutter>(scene, 40);
  try {
    const Simulation simulation(world, scene);
    ADD_FAILURE() << "slivers were taken";
  } catch (const SceneError &error) {
    const RegionCutter cutter(scene, 40);
    const Diagnostics all = cutter.make(0, cutter.num_tiles()).faults;
    ASSERT_GT(all.size(), 2U);
    for (std::size_t k = 0; k < std::min<std::size_t>(all.size(), 20); ++k) {
      EXPECT_EQ(to_string(error.diagnostics().at(k)), to_string(all[k]));
    }
  }
}

} // namespace
} // namespace gcpdda::region_test
