// What tests compare is what gcpdda says, on any machine.

#include "child_process.hpp"
#include "support/run_facts.hpp"

#include <gtest/gtest.h>

namespace gcpdda::child_process_test {
namespace {

using testing::Outcome;
using testing::own_lines;

TEST(ChildProcess, DropsTheWordsOfHwlocAndMpi) {
  const std::string row(74, '-');
  const std::string paragraph =
      row + "\nPrimary job  terminated normally, but 1 process returned\n\n" + row + "\n";
  EXPECT_EQ(own_lines("[hwloc/linux] failed to find sysfs cpu topology directory, aborting linux discovery.\n"
                      "s.toml:1:2: error: one [run] too many\n" +
                      paragraph + paragraph +
                      "[vm:02293] *** Process received signal ***\n"
                      "[vm:02293] [ 0] /lib/libc.so.6(+0x3c050)[0x7ffff7e3c050]\n"
                      "[vm:02293] 3 more processes have sent help message\n"
                      "****************************************************************************\n"
                      "* hwloc 2.9.0 received invalid information from the operating system.\n"
                      "[run] is missing: a message\n"
                      "- a list\n"),
            "s.toml:1:2: error: one [run] too many\n[run] is missing: a message\n- a list\n");
  EXPECT_EQ(own_lines(row + "\nnever closed\n"), row + "\nnever closed\n") << "nothing is lost by a lone row";
  EXPECT_EQ(own_lines(""), "");
}

// hwloc looks for /sys below an empty folder and says that it finds none, on each rank and in mpirun.
TEST(ChildProcess, OnAMachineWithoutSysTheProgramHasOneVoice) {
  const testing::WorkFolder folder;
  folder.write("s.toml", "duration = = 2\n");
  for (const int ranks : {0, 3}) {
    const Outcome outcome = testing::run_program(testing::gcpdda_words(ranks, {"run", "s.toml"}),
                                                 folder.path(), {"HWLOC_FSROOT=" + folder.path().string()});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_EQ(testing::lines_of(outcome.err).size(), 1U) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("s.toml:1:12: error: not valid TOML, ")) << outcome.err;
  }
}

} // namespace
} // namespace gcpdda::child_process_test
