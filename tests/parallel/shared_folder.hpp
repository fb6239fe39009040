#pragma once

#include "base/check.hpp"
#include "gcpdda/parallel/communicator.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <string>

namespace gcpdda::testing {

/// A temporary folder all ranks see. Collective.
class SharedFolder {
public:
  explicit SharedFolder(const Communicator &world) : world_(world) {
    std::string name = (std::filesystem::temp_directory_path() / "gcpdda_parallel_XXXXXX").string();
    if (world_.is_root()) {
      expect(mkdtemp(name.data()) != nullptr, "a temporary folder");
    }
    world_.broadcast(name);
    path_ = name;
  }
  ~SharedFolder() {
    world_.barrier();
    if (world_.is_root()) {
      std::filesystem::remove_all(path_);
    }
  }
  SharedFolder(const SharedFolder &) = delete;
  SharedFolder &operator=(const SharedFolder &) = delete;
  [[nodiscard]] std::filesystem::path path(const std::string &name) const { return path_ / name; }

private:
  Communicator world_;
  std::filesystem::path path_;
};

/// Keeps what is written to std::cerr while it lives.
class CapturedLog {
public:
  CapturedLog() : before_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~CapturedLog() { std::cerr.rdbuf(before_); }
  CapturedLog(const CapturedLog &) = delete;
  CapturedLog &operator=(const CapturedLog &) = delete;
  [[nodiscard]] std::string text() const { return text_.str(); }

private:
  std::ostringstream text_;
  std::streambuf *before_;
};

/// Keeps what is written to std::cout while it lives.
class CapturedOutput {
public:
  CapturedOutput() : before_(std::cout.rdbuf(text_.rdbuf())) {}
  ~CapturedOutput() { std::cout.rdbuf(before_); }
  CapturedOutput(const CapturedOutput &) = delete;
  CapturedOutput &operator=(const CapturedOutput &) = delete;

private:
  std::ostringstream text_;
  std::streambuf *before_;
};

} // namespace gcpdda::testing
