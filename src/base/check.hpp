#pragma once

// Promises between functions, and the errors that end a program.

#include <stdexcept>

namespace gcpdda {

/// A broken promise inside the program (exit_code::internal_error): never thrown for people's input.
class InternalError : public std::logic_error {
public:
  using std::logic_error::logic_error;
};

/// Trouble with a file or folder (exit_code::file_trouble).
class FileError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// @throws InternalError "<kind> broken: <what>"
[[noreturn]] void throw_broken(const char *kind, const char *what);

/// What a function needs from its caller. Stays on in every build: it stands outside the inner loops.
inline void expect(bool condition, const char *what) {
  if (!condition) {
    throw_broken("expectation", what);
  }
}

/// What a function promises to leave behind.
inline void ensure(bool condition, const char *what) {
  if (!condition) {
    throw_broken("promise", what);
  }
}

} // namespace gcpdda
