// The linear programme of a bound is the same whatever rank tells its joints and supports first.

#include "limit_analysis/limit_regions.hpp"
#include "limit_analysis/support_reserves.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace gcpdda::limit_order_test {
namespace {

/// Sorts every permutation of a few things and expects one order of them.
template <class Thing, class Same> void expect_one_order(const std::vector<Thing> &things, Same &&same) {
  std::vector<std::size_t> order(things.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Thing> first;
  do {
    std::vector<Thing> sorted;
    for (const std::size_t k : order) {
      sorted.push_back(things[k]);
    }
    put_in_order(sorted);
    first = first.empty() ? sorted : first;
    EXPECT_TRUE(std::equal(sorted.begin(), sorted.end(), first.begin(), same));
  } while (std::next_permutation(order.begin(), order.end()));
}

// All on one stretch of one pair.
TEST(LimitOrder, OfJointsFollowsFromWhatTheyAre) {
  std::vector<LimitRegion> regions(6);
  for (LimitRegion &region : regions) {
    region.joint.first = 3;
    region.joint.second = 5;
    region.joint.normal = {0.0, 1.0};
  }
  regions[1].law = 1;
  regions[2].is_bond = true;
  regions[3].joint.tan_friction = 0.5;
  regions[4].joint.cohesion = 1e5;
  regions[5].joint.end = {1.0, 0.0};
  expect_one_order(regions, [](const LimitRegion &a, const LimitRegion &b) {
    return a.law == b.law && a.is_bond == b.is_bond && a.joint.tan_friction == b.joint.tan_friction &&
           a.joint.cohesion == b.joint.cohesion && a.joint.end == b.joint.end;
  });
}

// Two bolts on one line, and what they bear.
TEST(LimitOrder, OfSupportsFollowsFromWhatTheyAre) {
  std::vector<LimitForce> forces(4);
  for (LimitForce &force : forces) {
    force.first = 3;
    force.second = 5;
    force.direction = {0.0, 1.0};
  }
  forces[1].least = -1e4;
  forces[2].most = 1e4;
  forces[3].point[1] = {1.0, 0.0};
  expect_one_order(forces, [](const LimitForce &a, const LimitForce &b) {
    return a.least == b.least && a.most == b.most && a.point == b.point;
  });
}

} // namespace
} // namespace gcpdda::limit_order_test
