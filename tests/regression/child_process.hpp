#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda::testing {

/// A temporary folder to work in.
class WorkFolder {
public:
  WorkFolder();
  ~WorkFolder() { std::filesystem::remove_all(path_); }
  WorkFolder(const WorkFolder &) = delete;
  WorkFolder &operator=(const WorkFolder &) = delete;
  [[nodiscard]] const std::filesystem::path &path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string &name) const { return path_ / name; }
  void write(const std::string &name, const std::string &text) const;

private:
  std::filesystem::path path_;
};

/// What a finished process left.
struct Outcome {
  int exit_code = -1; ///< 128 + signal when it was killed; 1000 when it did not end in time
  std::string out;
  std::string err;
};

/// Start a program in a folder and wait for it. It sees this process's environment without what MPI
/// launchers left in it, plus `environment` ("NAME=value"). After two minutes it is killed, children
/// included.
Outcome run_program(const std::vector<std::string> &words, const std::filesystem::path &folder,
                    const std::vector<std::string> &environment = {});

/// gcpdda with these arguments in this folder: without mpirun, or on that many ranks (0: without).
Outcome run_gcpdda(int ranks, const std::vector<std::string> &arguments, const WorkFolder &folder);

} // namespace gcpdda::testing
