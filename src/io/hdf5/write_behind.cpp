#include "io/hdf5/write_behind.hpp"

#include <memory>
#include <utility>

namespace gcpdda {

WriteBehind::~WriteBehind() {
  if (last_.valid()) {
    last_.wait(); // who wants to know of a failure asks before
  }
}

// Where no thread can be had, std::async puts the piece off until finish(). It gets a copy of the work:
// libstdc++ takes what it is given a second time then, and what was moved the first time would be empty.
void WriteBehind::add(std::function<void()> piece) {
  const auto before = std::make_shared<std::future<void>>(std::move(last_));
  const auto work = [before, act = std::move(piece)] {
    if (before->valid()) {
      before->get();
    }
    act();
  };
  last_ = std::async(work);
}

void WriteBehind::finish() {
  if (last_.valid()) {
    last_.get();
  }
}

} // namespace gcpdda
