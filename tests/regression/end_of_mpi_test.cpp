// The end of a process in which Open MPI's own thread lags behind: the event that MPI_Init leaves to it is
// handled before MPI_Finalize unloads the code for it.

#include "child_process.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

namespace gcpdda::end_of_mpi_test {
namespace {

TEST(EndOfMpi, WaitsForALateThread) {
  const testing::WorkFolder folder;
  std::vector<std::string> words = testing::gcpdda_words(1, {"inspect", "nowhere.toml"});
  words.insert(words.end() - 3, {"env", "LD_PRELOAD=" GCPDDA_LATE_THREAD});
  const testing::Outcome outcome = testing::run_program(words, folder.path());
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_EQ(testing::count_of(outcome.err, "a thread is late\n"), 1)
      << "else nothing is tested: " << outcome.err;
}

} // namespace
} // namespace gcpdda::end_of_mpi_test
