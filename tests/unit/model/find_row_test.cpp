#include "model/find_row.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace gcpdda::find_row_test {
namespace {

// Each range begins again with small ids: a search may not leave its own.
TEST(FindRow, AgreesWithALookAtEveryRow) {
  BlockSystem system;
  for (const std::int64_t id : {3, 7, 8, 20, 1, 9, 21, 0, 4, 30}) {
    system.properties.push_back({});
    system.properties.back().id = BlockId{id};
  }
  system.num_owned = 4;
  system.num_ghosts = 3;
  system.num_fixed = 3;
  const auto by_looking = [&](std::size_t first, std::size_t last, std::int64_t id) {
    std::optional<std::size_t> row;
    for (std::size_t k = first; k < last; ++k) {
      row = system.properties[k].id.value == id ? std::optional(k) : row;
    }
    return row;
  };
  for (std::int64_t id = -1; id < 32; ++id) {
    EXPECT_EQ(find_owned_row(system, id), by_looking(0, 4, id)) << id;
    EXPECT_EQ(find_row(system, 4, 7, id), by_looking(4, 7, id)) << id;
    EXPECT_EQ(find_row(system, 4, 4, id), std::nullopt) << id;
    EXPECT_EQ(find_fixed_row(system, id), by_looking(7, 10, id)) << id;
    EXPECT_EQ(find_row(system, id), by_looking(0, 10, id)) << id;
    const std::size_t from = first_row_from(system, 4, 7, id);
    for (std::size_t k = 4; k < 7; ++k) {
      EXPECT_EQ(k >= from, system.properties[k].id.value >= id) << id;
    }
  }
}

} // namespace
} // namespace gcpdda::find_row_test
