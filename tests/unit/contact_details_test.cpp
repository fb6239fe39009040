// Details of contacts that are asked for after a step are those that it would have found itself.

#include "gcpdda/simulation/simulation.hpp"

#include "support/blocks.hpp"
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
};

void expect_same_regions(const Simulation &at_once, const Simulation &later, Seen &seen) {
  ASSERT_EQ(later.contacts().regions().size(), at_once.contacts().regions().size());
  for (std::size_t pair = 0; pair < at_once.candidates().pairs.size(); ++pair) {
    const auto wanted = at_once.contacts().of_pair(pair);
    const auto got = later.contacts().of_pair(pair);
    ASSERT_EQ(got.size(), wanted.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      expect_same_bits(got[k], wanted[k]);
      seen.add(wanted[k], at_once.history().of_pair(pair)[k]);
    }
  }
}

/// Of both runs the first one tells of each step, so that it finds details at once.
void expect_same_details(const std::string &toml, double time_step, int steps) {
  const auto started = [&](double interval) {
    return Simulation(Communicator::self(), scene_of(toml, {fmt::format("run.time_step={}", time_step),
                                                            fmt::format("output.interval={}", interval)}));
  };
  Simulation at_once = started(time_step);
  Simulation later = started(500.0 * time_step);
  ASSERT_EQ(at_once.plan().time_step, later.plan().time_step);
  Seen seen;
  for (int step = 0; step < steps && !::testing::Test::HasFailure(); ++step) {
    at_once.step();
    later.step();
    expect_same_regions(at_once, later, seen);
  }
  EXPECT_GT(seen.born, 10U);
  EXPECT_GT(seen.sliding, 50U);
  EXPECT_GT(seen.sticking, 50U);
}

TEST(ContactDetails, FoundLaterAreThoseFoundAtOnce) {
  expect_same_details(settling_pyramid_toml(12, 10.0), 2e-4, 60);
  expect_same_details(settling_pyramid_toml(12, 10.0, "deformable"), 2e-5, 60);
  expect_same_details(falling_pile_toml(60, 10.0), 1e-3, 400);
}

} // namespace
} // namespace gcpdda::contact_details_test
