// Details of contacts may be asked for at any step, of all pairs or of one, and that changes nothing.

#include "support/blocks.hpp"
#include "support/contact_regions.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace gcpdda::contact_details_test {
namespace {

using namespace testing;

/// What has been seen of contacts.
struct Seen {
  std::size_t born = 0;
  std::size_t sliding = 0;
  std::size_t sticking = 0;

  void add(const RegionForce &force, const RegionMemory &memory) {
    born += force.born ? 1 : 0;
    (memory.state == ContactState::slip ? sliding : sticking) += 1;
  }
  Seen &operator+=(const Seen &other) {
    born += other.born;
    sliding += other.sliding;
    sticking += other.sticking;
    return *this;
  }
};

void expect_same_regions(std::span<const RegionForce> got, std::span<const RegionForce> wanted) {
  ASSERT_EQ(got.size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    expect_same_bits(got[k], wanted[k]);
  }
}

/// Pair by pair, and all of them once more.
Seen expect_same_details(Simulation &simulation) {
  Seen seen;
  const Regions regions(simulation);
  for (std::size_t pair = 0; pair < simulation.candidates().pairs.size(); ++pair) {
    const auto wanted = regions.of_pair(pair);
    const std::vector<RegionMemory> memories = simulation.history().of_pair(pair);
    EXPECT_EQ(memories.size(), wanted.size());
    bool is_told = false;
    for_regions(simulation.state(), pair, pair + 1, [&](std::uint32_t, std::span<const RegionForce> got) {
      expect_same_regions(got, wanted);
      is_told = true;
    });
    EXPECT_EQ(is_told, !wanted.empty());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      seen.add(wanted[k], memories[k]);
    }
  }
  expect_same_regions(regions_of(simulation), regions.all());
  return seen;
}

void expect_same_state(const Simulation &a, const Simulation &b) {
  EXPECT_EQ(a.blocks().velocity, b.blocks().velocity);
  EXPECT_EQ(a.blocks().displacement, b.blocks().displacement);
  EXPECT_EQ(a.counters().evaluations, b.counters().evaluations);
}

void expect_no_trace(const std::string &toml, double time_step, int steps) {
  const Scene scene = scene_of(toml, {fmt::format("run.time_step={}", time_step)});
  Simulation asked(Communicator::self(), scene);
  Simulation silent(Communicator::self(), scene);
  Seen seen;
  for (int step = 0; step < steps && !::testing::Test::HasFailure(); ++step) {
    asked.step();
    silent.step();
    seen += expect_same_details(asked);
    expect_same_state(asked, silent);
  }
  expect_same_regions(regions_of(asked), regions_of(silent));
  EXPECT_GT(seen.born, 10U);
  EXPECT_GT(seen.sliding, 50U);
  EXPECT_GT(seen.sticking, 50U);
}

TEST(ContactDetails, LeaveNoTrace) {
  expect_no_trace(settling_pyramid_toml(12, 10.0), 2e-4, 60);
  expect_no_trace(settling_pyramid_toml(12, 10.0, "deformable"), 2e-5, 60);
  expect_no_trace(falling_pile_toml(60, 10.0), 1e-3, 400);
}

// Rigid and deformable bricks that are shaken: details that an evaluation has kept have the bits of those
// that are found when they are asked for.
TEST(ContactDetails, ThatAreKeptAreThoseThatAreFound) {
  std::mt19937 engine(5);
  std::vector<std::vector<Vec2>> bricks;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      const Vec2 low{column + 0.4 * (row % 2), 0.5 * row};
      bricks.push_back(rectangle(low, low + Vec2{1.001, 0.501}));
    }
  }
  ContactBench bench(system_of(bricks, {rectangle({-2.0, -1.0}, {9.0, 0.001})}, 1000.0,
                               [](std::size_t row) { return row % 5 == 0; }),
                     one_law(1e9, 0.3));
  bench.forces.keep_details(true);
  std::size_t seen = 0;
  for (int round = 0; round < 20; ++round) {
    for (std::size_t row = 0; row < bench.system.num_owned; ++row) {
      const auto random = [&] { return uniform(engine, -3e-4, 3e-4); };
      bench.system.trial[row] +=
          RigidDof{{random(), random()}, bench.system.is_deformable(row) ? 0.0 : random()};
    }
    bench.evaluate();
    std::size_t next = 0;
    const auto compare = [&](std::uint32_t pair, std::uint32_t, const RegionDetails &kept) {
      const RegionForce &found = bench.regions.all()[next++];
      const auto all = [](const RegionDetails &d) {
        return std::tie(d.dyad, d.origin, d.point, d.normal, d.normal_force, d.shear, d.cap, d.overlap,
                        d.extent_begin, d.extent_end, d.grip, d.normal_undefined, d.bonded);
      };
      EXPECT_EQ(found.pair, pair);
      EXPECT_EQ(all(kept), all(found));
    };
    for (std::uint32_t pair = 0; pair < bench.candidates.pairs.size(); ++pair) {
      bench.forces.for_kept_details(bench.candidates, bench.history, pair, compare);
    }
    EXPECT_EQ(next, bench.regions.all().size());
    seen += next;
  }
  EXPECT_GT(seen, 1000U);
}

} // namespace
} // namespace gcpdda::contact_details_test
