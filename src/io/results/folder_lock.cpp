#include "io/results/folder_lock.hpp"

#include "base/check.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace gcpdda {

void FolderLock::acquire(const std::filesystem::path &directory) {
  release(); // run.log may be a new file
  descriptor_ = ::open((directory / "run.log").c_str(), O_RDWR | O_CLOEXEC);
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
