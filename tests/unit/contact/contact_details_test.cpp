// Details of contacts may be asked for at any step, of all pairs or of one, and that changes nothing.

#include "support/blocks.hpp"
#include "support/contact_regions.hpp"
#include "support/scenes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

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

} // namespace
} // namespace gcpdda::contact_details_test
