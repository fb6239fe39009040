// Work that is left to a thread: its order, and what becomes of a failure.

#include "io/hdf5/write_behind.hpp"

#include "base/check.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <vector>

namespace gcpdda {
namespace {

TEST(WriteBehind, DoesItsPiecesInOrderWhileTheCallerGoesOn) {
  WriteBehind behind;
  std::promise<void> gate;
  std::vector<int> done;
  behind.add([&] {
    gate.get_future().wait();
    done.push_back(1);
  });
  behind.add([&] { done.push_back(2); });
  gate.set_value(); // add() has not waited for the first piece, or nobody would come here
  behind.finish();
  EXPECT_EQ(done, (std::vector<int>{1, 2}));
}

TEST(WriteBehind, TellsOfAFailureAndLeavesOutWhatComesBehindIt) {
  WriteBehind behind;
  bool later = false;
  behind.add([] { throw FileError("no disk"); });
  behind.add([&] { later = true; });
  EXPECT_THROW(behind.finish(), FileError);
  EXPECT_FALSE(later);
  behind.finish(); // it has been told
  behind.add([&] { later = true; });
  behind.finish();
  EXPECT_TRUE(later);
}

TEST(WriteBehind, EndsWithItsWorkDone) {
  std::atomic<bool> done = false;
  {
    WriteBehind behind;
    behind.add([&] { done = true; });
  }
  EXPECT_TRUE(done);
}

} // namespace
} // namespace gcpdda
