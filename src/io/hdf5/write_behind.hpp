#pragma once

// Closing and publishing of files beside the run.

#include <functional>
#include <future>

namespace gcpdda {

/// Waits for the disk in its own thread, while the run goes on: pieces of work on files, one after the other.
/// They call neither MPI nor HDF5.
class WriteBehind {
public:
  WriteBehind() = default;
  ~WriteBehind();
  WriteBehind(const WriteBehind &) = delete;
  WriteBehind &operator=(const WriteBehind &) = delete;

  void add(std::function<void()> piece);
  /// All pieces are done afterwards. Throws what the first that failed threw; those behind it were left out.
  void finish();

private:
  std::future<void> last_;
};

} // namespace gcpdda
