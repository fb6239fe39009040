#pragma once

// Files of folders that are removed again are written without waiting for the disk.

namespace gcpdda {

/// While one exists, writes of this rank skip fsync: for temporary folders, which are removed before a loss
/// of their files could matter.
class PassingFiles {
public:
  PassingFiles();
  ~PassingFiles();
  PassingFiles(const PassingFiles &) = delete;
  PassingFiles &operator=(const PassingFiles &) = delete;
};

} // namespace gcpdda
