#pragma once

// One gcpdda at a time in a result folder.

#include <filesystem>

namespace gcpdda {

/// Keeps other gcpdda out of a result folder as long as it lives, by an advisory lock on a file that the
/// system takes back from a dead process. Where the file system knows no locks there is none. Root only.
class FolderLock {
public:
  FolderLock() = default;
  ~FolderLock() { release(); }
  FolderLock(const FolderLock &) = delete;
  FolderLock &operator=(const FolderLock &) = delete;

  /// Lock the folder of a run by the run.log that is in it now; nothing happens where there is none.
  /// @throws FileError where another process holds it
  void acquire(const std::filesystem::path &directory);

  /// Lock the folder of a search or an ensemble, which has no run.log, by an empty file in_use.lock. The file
  /// is made where it is missing and stays: a folder is in use only while a process holds the lock on it.
  /// @throws FileError where another process holds it
  void acquire_for_many_runs(const std::filesystem::path &directory);

private:
  void lock(const std::filesystem::path &directory, const char *name, int flags);
  void release();
  int descriptor_ = -1;
};

} // namespace gcpdda
