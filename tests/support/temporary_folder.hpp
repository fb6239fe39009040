#pragma once

// A folder for the files of one test.

#include "base/check.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gcpdda::testing {

/// Removed with all that is in it when its life ends.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "gcpdda_test_XXXXXX").string();
    expect(mkdtemp(name.data()) != nullptr, "a temporary folder");
    path_ = name;
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;
  [[nodiscard]] const std::filesystem::path &path() const { return path_; }

private:
  std::filesystem::path path_;
};

} // namespace gcpdda::testing
