#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gcpdda::testing {

/// Whole content of a file; throws when it cannot be read.
std::string file_text(const std::filesystem::path &path);

/// Lines without their ends.
std::vector<std::string> lines_of(const std::string &text);

int count_of(const std::string &text, const std::string &part);

/// The value of the first `"key": value` in a JSON file as written there (objects and lists too); the key may
/// stand in an inner object. Throws when there is none.
std::string json_value(const std::filesystem::path &file, const std::string &key);
/// The same in a run's summary.json.
std::string summary_text(const std::filesystem::path &directory, const std::string &key);
double summary_number(const std::filesystem::path &directory, const std::string &key);

/// Folders and files below a folder, relative to it, sorted.
std::vector<std::string> listing(const std::filesystem::path &directory);

} // namespace gcpdda::testing
