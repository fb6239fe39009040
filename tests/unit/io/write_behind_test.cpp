// Work that is left to a thread: its order, and what becomes of a failure.

#include "io/hdf5/write_behind.hpp"

#include "base/check.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <pthread.h>
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

/// While it lives the process can have no other thread: the stack of one would be larger than any memory.
class NoThreads {
public:
  NoThreads() {
    pthread_attr_t attributes;
    EXPECT_EQ(pthread_getattr_default_np(&before_), 0);
    EXPECT_EQ(pthread_attr_init(&attributes), 0);
    EXPECT_EQ(pthread_attr_setstacksize(&attributes, std::size_t{1} << 50U), 0);
    EXPECT_EQ(pthread_setattr_default_np(&attributes), 0);
    pthread_attr_destroy(&attributes);
  }
  ~NoThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  NoThreads(const NoThreads &) = delete;
  NoThreads &operator=(const NoThreads &) = delete;

private:
  pthread_attr_t before_{};
};

TEST(WriteBehind, DoesItsPiecesInTheEndWhereNoThreadCanBeHad) {
  std::vector<int> done;
  WriteBehind behind;
  behind.add([&] { done.push_back(1); });
  {
    const NoThreads none;
    behind.add([&] { done.push_back(2); });
    behind.add([&] { done.push_back(3); });
  }
  behind.add([&] { done.push_back(4); });
  behind.finish();
  EXPECT_EQ(done, (std::vector<int>{1, 2, 3, 4}));
}

} // namespace
} // namespace gcpdda
