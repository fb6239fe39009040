#include "io/results/folder_lock.hpp"

#include "base/check.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace gcpdda {

void FolderLock::acquire(const std::filesystem::path &directory) {
  lock(directory, "run.log", 0);
}

void FolderLock::acquire_for_many_runs(const std::filesystem::path &directory) {
  lock(directory, "in_use.lock", O_CREAT);
}

void FolderLock::lock(const std::filesystem::path &directory, const char *name, int flags) {
  release(); // run.log may be a new file
  constexpr unsigned rights = 0666;
  descriptor_ = ::open((directory / name).c_str(), O_RDWR | O_CLOEXEC | flags, rights);
  if (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    release();
    throw FileError("the folder " + directory.string() +
                    " is in use: another gcpdda runs in it, wait for its end or choose another folder");
  }
}

void FolderLock::release() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

} // namespace gcpdda
