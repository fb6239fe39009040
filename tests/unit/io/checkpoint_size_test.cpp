// What a checkpoint holds for each row, as run/guide/10_long_runs_and_clusters.md says.

#include "io/checkpoint/checkpoint_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace gcpdda::checkpoint_size_test {
namespace {

template <class Fields> std::size_t bytes_of(const Fields &fields) {
  return std::accumulate(
      fields.begin(), fields.end(), std::size_t{0},
      [](std::size_t sum, const auto &field) { return sum + field.columns * sizeof(double); });
}

constexpr std::size_t id = sizeof(std::int64_t);

TEST(CheckpointSize, IsThatOfTheGuide) {
  constexpr std::size_t kind = 1;
  EXPECT_EQ(id + kind + bytes_of(checkpoint::block_fields), 321U);
  EXPECT_EQ(bytes_of(checkpoint::unshaken_fields), 16U);
  EXPECT_EQ(id + bytes_of(checkpoint::deformation_fields), 296U);
  constexpr std::size_t state = 1;
  constexpr std::size_t stretches_law_and_age = 4 * sizeof(std::int32_t);
  EXPECT_EQ(2 * id + stretches_law_and_age + state + bytes_of(checkpoint::region_fields), 105U);
}

} // namespace
} // namespace gcpdda::checkpoint_size_test
