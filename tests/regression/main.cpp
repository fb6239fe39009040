// A plain main: these tests start mpirun themselves, which a process that has called MPI_Init cannot do
// reliably (its children inherit the job's variables and descriptors).

#include <gtest/gtest.h>

int main(int argc, char **argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
