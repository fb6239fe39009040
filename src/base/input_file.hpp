#pragma once

// The one way in which files that a user names are opened and read.

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

namespace gcpdda {

/// A file that a person names, read by one process. Only a regular file of a bounded size is read: a device
/// may have no end, a pipe no beginning.
struct InputFile {
  std::string text;
  std::string trouble;     ///< why it cannot be read, as a clause; empty if it can
  bool is_missing = false; ///< nothing has this name
};

namespace input_file {

/// Of a file that is opened by another library: its size is that library's business.
inline constexpr std::int64_t any_size = INT64_MAX;

inline std::string kind_of(mode_t mode) {
  return S_ISDIR(mode) ? "a folder" : S_ISFIFO(mode) ? "a pipe" : S_ISSOCK(mode) ? "a socket" : "a device";
}

inline std::string reason_of(int error) {
  const bool is_usual = error == ENOENT || error == ENOTDIR || error == EACCES;
  return is_usual ? "no such file or no right to read it" : std::strerror(error);
}

inline std::string trouble_of(const struct stat &facts, std::int64_t most_bytes) {
  if (!S_ISREG(facts.st_mode)) {
    return "it is " + kind_of(facts.st_mode) + " and no file";
  }
  return facts.st_size <= most_bytes ? std::string()
                                     : "it has " + std::to_string(facts.st_size) + " bytes and at most " +
                                           std::to_string(most_bytes) + " are read";
}

// By steps of what is there: some file systems give files no size.
inline void read_all(int descriptor, std::int64_t most_bytes, InputFile &file) {
  constexpr std::size_t step = std::size_t{1} << 20U;
  while (file.trouble.empty()) {
    const std::size_t before = file.text.size();
    file.text.resize(before + step);
    const ssize_t count = ::read(descriptor, file.text.data() + before, step);
    file.text.resize(before + static_cast<std::size_t>(count > 0 ? count : 0));
    if (count == 0) {
      return;
    }
    if (count < 0 && errno != EINTR) {
      file.trouble = reason_of(errno);
    } else if (static_cast<std::int64_t>(file.text.size()) > most_bytes) {
      file.trouble = "it has more than the " + std::to_string(most_bytes) + " bytes that are read";
    }
  }
}

} // namespace input_file

/// Whether a file can be read, without reading it: `text` stays empty.
inline InputFile look_at_input_file(const std::string &path, std::int64_t most_bytes = input_file::any_size) {
  InputFile file;
  struct stat facts {};
  if (::stat(path.c_str(), &facts) != 0) {
    file.is_missing = errno == ENOENT || errno == ENOTDIR;
    file.trouble = input_file::reason_of(errno);
  } else if (file.trouble = input_file::trouble_of(facts, most_bytes); file.trouble.empty()) {
    file.trouble = ::access(path.c_str(), R_OK) == 0 ? std::string() : input_file::reason_of(errno);
  }
  return file;
}

inline InputFile read_input_file(const std::string &path, std::int64_t most_bytes) {
  InputFile file = look_at_input_file(path, most_bytes);
  if (!file.trouble.empty()) {
    return file;
  }
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    file.trouble = input_file::reason_of(errno);
    return file;
  }
  input_file::read_all(descriptor, most_bytes, file);
  ::close(descriptor);
  return file;
}

} // namespace gcpdda
