#pragma once

// One run at a time in a result folder.

#include <filesystem>

namespace gcpdda {

/// Keeps other gcpdda out of a result folder as long as it lives, by an advisory lock on run.log that the
/// system takes back from a dead process. Where the file system knows no locks there is none. Root only.
class FolderLock {
public:
  FolderLock() = default;
  ~FolderLock() { release(); }
  FolderLock(const FolderLock &) = delete;
  FolderLock &operator=(const FolderLock &) = delete;

  /// Lock the run.log that is in the folder now; nothing happens where there is none.
  /// @throws FileError where another process holds it
  void acquire(const std::filesystem::path &directory);

private:
  void release();
  int descriptor_ = -1;
};

} // namespace gcpdda
