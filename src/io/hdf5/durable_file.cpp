#include "io/hdf5/durable_file.hpp"

#include "base/check.hpp"
#include "io/hdf5/passing_files.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <initializer_list>

namespace gcpdda {

namespace {

std::atomic<int> num_passing = 0; // of PassingFiles that live

[[noreturn]] void fail(const std::string &what, const std::filesystem::path &path,
                       const std::string &reason) {
  throw FileError("cannot " + what + " " + path.string() + ": " + reason);
}

// Opens the file for one call, which returns 0 or sets errno; an errno in `harmless` is no failure.
template <class Call>
void call_on(const std::filesystem::path &path, int flags, const std::string &what,
             std::initializer_list<int> harmless, Call call) {
  const int descriptor = ::open(path.c_str(), flags);
  if (descriptor < 0) {
    fail("open", path, std::strerror(errno));
  }
  const int reason = call(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  if (reason != 0 && std::find(harmless.begin(), harmless.end(), reason) == harmless.end()) {
    fail(what, path, std::strerror(reason));
  }
}

void write_unfinished(const std::filesystem::path &path, const std::string &text) {
  const std::filesystem::path unfinished = unfinished_name(path);
  std::ofstream stream(unfinished, std::ios::binary | std::ios::trunc);
  if (!stream) {
    fail("create", unfinished, std::strerror(errno));
  }
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) {
    fail("write", unfinished, std::strerror(errno));
  }
}

void take_final_name(const std::filesystem::path &path) {
  std::error_code error;
  std::filesystem::rename(unfinished_name(path), path, error);
  if (error) {
    fail("rename to", path, error.message());
  }
}

} // namespace

PassingFiles::PassingFiles() {
  ++num_passing;
}

PassingFiles::~PassingFiles() {
  --num_passing;
}

std::filesystem::path unfinished_name(const std::filesystem::path &path) {
  return path.string() + ".tmp";
}

// The limit is looked at first: a file that grows beyond it ends the process by a signal.
void reserve(const std::filesystem::path &path, std::int64_t begin, std::int64_t end) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
      static_cast<std::uint64_t>(std::max<std::int64_t>(0, end)) > limit.rlim_cur) {
    fail("find space for", unfinished_name(path), std::strerror(EFBIG));
  }
  if (begin < end) {
    call_on(unfinished_name(path), O_WRONLY, "find space on the disk for", {}, [&](int descriptor) {
      if (::fallocate(descriptor, 0, begin, end - begin) == 0) {
        return 0;
      }
      const bool cannot = errno == EOPNOTSUPP || errno == ENOSYS || errno == EINVAL;
      return cannot ? ::ftruncate(descriptor, end) : -1; // some file systems only know how long a file is
    });
  }
}

void start_to_sync(const std::filesystem::path &path) {
  if (num_passing != 0) {
    return;
  }
  const int descriptor = ::open(unfinished_name(path).c_str(), O_RDONLY);
  if (descriptor >= 0) {
    ::sync_file_range(descriptor, 0, 0, SYNC_FILE_RANGE_WRITE);
    ::close(descriptor);
  }
}

void sync_file(const std::filesystem::path &path) {
  if (num_passing == 0) {
    call_on(path, O_RDONLY, "sync", {EINVAL}, ::fsync); // EINVAL: a file system without a disk
  }
}

void sync_directory(const std::filesystem::path &path) {
  if (num_passing == 0) {
    call_on(path, O_RDONLY | O_DIRECTORY, "sync", {EINVAL, EBADF, EACCES}, ::fsync);
  }
}

void publish(const std::filesystem::path &path) {
  const std::filesystem::path unfinished = unfinished_name(path);
  // Space reserved and not used goes back.
  call_on(unfinished, O_WRONLY, "end", {},
          [](int descriptor) { return ::ftruncate(descriptor, ::lseek(descriptor, 0, SEEK_END)); });
  sync_file(unfinished);
  take_final_name(path);
}

void write_file(const std::filesystem::path &path, const std::string &text) {
  write_unfinished(path, text);
  publish(path);
}

void write_index(const std::filesystem::path &path, const std::string &text) {
  write_unfinished(path, text);
  take_final_name(path);
}

void make_directory(const std::filesystem::path &path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) {
    fail("make the folder", path, error.message());
  }
}

} // namespace gcpdda
