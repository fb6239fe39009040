#pragma once

// Files of folders that are removed again: nobody waits until they are on the disk.

namespace gcpdda {

/// As long as one lives, nobody waits until what this rank writes is on the disk: for folders that go again
/// before anybody could miss them.
class PassingFiles {
public:
  PassingFiles();
  ~PassingFiles();
  PassingFiles(const PassingFiles &) = delete;
  PassingFiles &operator=(const PassingFiles &) = delete;
};

} // namespace gcpdda
