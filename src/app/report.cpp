#include "app/report.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <span>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

/// What Python runs. Libraries are looked for first: another Python of the machine may have them.
constexpr const char *script = R"(
import sys
try:
    import tomllib, h5py, matplotlib, numpy, pandas
except ImportError:
    sys.exit(100)
from gcpdda import command_line
sys.exit(command_line.report(sys.argv[1:], "gcpdda report"))
)";
constexpr int misses_libraries = 100;
constexpr int not_started = 127; // of a child that could not be started, as a shell has it

/// The folder that holds the package: run/python of the tree whose build folder holds the program, or of the
/// installation; empty if it is in neither.
fs::path package_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  for (const char *place : {"run/python", "lib/python3/dist-packages"}) {
    fs::path folder = program.parent_path().parent_path() / place;
    if (fs::exists(folder / "gcpdda" / "__init__.py", error)) {
      return folder;
    }
  }
  return {};
}

/// Starts a Python and waits for it.
/// @return its exit code; misses_libraries also where there is no such Python
int run_python(const std::string &python, const std::vector<std::string> &words) {
  std::vector<std::string> all{python, "-c", script};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char *> pointers;
  for (std::string &word : all) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  pid_t child = 0;
  if (::posix_spawnp(&child, python.c_str(), nullptr, nullptr, pointers.data(), environ) != 0) {
    return misses_libraries;
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      return exit_code::internal_error;
    }
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : exit_code::internal_error;
  return code == not_started ? misses_libraries : code;
}

int report_on_root(const std::vector<std::string> &words) {
  const fs::path package = package_folder();
  if (package.empty()) {
    std::cerr
        << "error: the Python package that writes the report is neither in run/python of the sources nor in "
           "lib/python3/dist-packages beside this program, install with cmake --install, or call "
           "run/report.py of the sources\n";
    return exit_code::file_trouble;
  }
  const char *before = std::getenv("PYTHONPATH");
  const std::string path = package.string() + (before != nullptr ? std::string(":") + before : std::string());
  ::setenv("PYTHONPATH", path.c_str(), 1);
  for (const char *python : {"python3", "/usr/bin/python3"}) {
    if (const int code = run_python(python, words); code != misses_libraries) {
      return code;
    }
  }
  std::cerr
      << "error: no report is written, neither python3 on PATH nor /usr/bin/python3 is a Python 3.11 or "
         "later "
         "with h5py, matplotlib, numpy and pandas, install these or put a Python that has them on PATH\n";
  return exit_code::file_trouble;
}

} // namespace

ExitCode write_report(const Communicator &world, const std::vector<std::string> &words) {
  std::int64_t code = 0; // the others have none: the largest is that of the root
  if (world.is_root()) {
    code = report_on_root(words);
  }
  world.max(std::span(&code, 1));
  switch (code) {
  case exit_code::done:
  case exit_code::wrong_usage:
  case exit_code::file_trouble:
    return static_cast<ExitCode>(code);
  default:
    return exit_code::internal_error;
  }
}

} // namespace gcpdda
