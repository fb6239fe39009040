#include "io/hdf5/write_behind.hpp"

#include <utility>

namespace gcpdda {

WriteBehind::~WriteBehind() {
  if (last_.valid()) {
    last_.wait(); // who wants to know of a failure asks before
  }
}

// Where no thread can be had, std::async puts the piece off until finish().
void WriteBehind::add(std::function<void()> piece) {
  last_ = std::async([before = std::move(last_), act = std::move(piece)]() mutable {
    if (before.valid()) {
      before.get();
    }
    act();
  });
}

void WriteBehind::finish() {
  if (last_.valid()) {
    last_.get();
  }
}

} // namespace gcpdda
