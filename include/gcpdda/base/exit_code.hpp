#pragma once

// Exit codes of the program, a contract with job scripts: their numbers never change. The page
// run/guide/11_errors_and_exit_codes.md explains what to do about each; a test compares it with this table.

#include <array>

namespace gcpdda {

namespace exit_code {
enum Code : int {
  done = 0,
  internal_error = 1,
  wrong_usage = 2,
  bad_scene = 3,
  file_trouble = 4,
  numerical_failure = 5,
  stopped = 6,
  undecided = 7
};
} // namespace exit_code

using ExitCode = exit_code::Code;

/// An exit code and what it says.
struct ExitCodeMeaning {
  ExitCode code;
  const char *meaning;
};

inline constexpr std::array<ExitCodeMeaning, 8> exit_codes{
    {{exit_code::done, "done"},
     {exit_code::internal_error, "internal error"},
     {exit_code::wrong_usage, "wrong use of the command line"},
     {exit_code::bad_scene, "errors in the scene"},
     {exit_code::file_trouble, "trouble with files"},
     {exit_code::numerical_failure, "numerical failure"},
     {exit_code::stopped, "stopped by SIGUSR1 with a checkpoint"},
     {exit_code::undecided, "undecided at the limit of a stage or of a search"}}};

} // namespace gcpdda
