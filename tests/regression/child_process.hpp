#pragma once

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <sys/types.h>
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
  std::string err; ///< own_lines() of it
};

/// Standard error without what hwloc, MPI and mpirun say of the machine and of the end of a process: lines
/// that begin with [place/component] or [host:process] or *, and paragraphs between two rows of dashes.
std::string own_lines(const std::string &standard_error);

/// Waits until it is done, for twenty minutes at most: a machine may be slow.
/// @return whether it is done
bool wait_until(const std::function<bool()> &done);

/// A program started in a folder. It sees this process's environment without what MPI launchers left in it,
/// plus `environment` ("NAME=value").
class Process {
public:
  Process(const std::vector<std::string> &words, const std::filesystem::path &folder,
          const std::vector<std::string> &environment = {});
  ~Process();
  Process(const Process &) = delete;
  Process &operator=(const Process &) = delete;

  [[nodiscard]] pid_t id() const { return child_; }
  /// Of the processes it has started itself, mpirun's ranks say; sorted.
  [[nodiscard]] std::vector<pid_t> children() const;
  /// Until it is done or the program has ended, as wait_until().
  void wait_until(const std::function<bool()> &done) const;
  /// To its end; one that outlasts wait_until() is killed, children included.
  Outcome wait();

private:
  std::unique_ptr<WorkFolder> streams_ = std::make_unique<WorkFolder>();
  pid_t child_ = -1;
  bool ended_ = false;
};

/// Start a program and wait for it.
Outcome run_program(const std::vector<std::string> &words, const std::filesystem::path &folder,
                    const std::vector<std::string> &environment = {});

/// The words of gcpdda with these arguments: without mpirun, or on that many ranks (0: without).
std::vector<std::string> gcpdda_words(int ranks, const std::vector<std::string> &arguments);

/// gcpdda with these arguments in this folder: without mpirun, or on that many ranks (0: without).
Outcome run_gcpdda(int ranks, const std::vector<std::string> &arguments, const WorkFolder &folder);

} // namespace gcpdda::testing
