// GoogleTest main for any number of ranks: the verdict is reduced, so that no rank leaves the others waiting.

#include "gcpdda/parallel/communicator.hpp"

#include <gtest/gtest.h>

int main(int argc, char **argv) {
  const gcpdda::MpiScope mpi(argc, argv);
  ::testing::InitGoogleTest(&argc, argv);
  const gcpdda::Communicator world = gcpdda::Communicator::world();
  std::int64_t failed = RUN_ALL_TESTS();
  world.max(std::span(&failed, 1));
  return static_cast<int>(failed);
}
