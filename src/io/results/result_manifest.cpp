#include "gcpdda/io/result_manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>

namespace gcpdda {

namespace {

namespace fs = std::filesystem;

/// Of the first bytes of a text.
struct Lines {
  std::int64_t count = 0; ///< that are complete
  bool end_here = false;  ///< the last byte ends one
};
Lines lines_in(const fs::path &path, std::int64_t bytes) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 65536> buffer{};
  Lines lines;
  while (bytes > 0 && stream) {
    stream.read(buffer.data(), std::min(bytes, std::ssize(buffer)));
    const std::streamsize read = stream.gcount();
    lines.count += std::count(buffer.data(), buffer.data() + read, '\n');
    lines.end_here = read > 0 && buffer[static_cast<std::size_t>(read - 1)] == '\n';
    bytes -= read;
  }
  return lines;
}

std::string damage_of_history(const fs::path &path, std::int64_t bytes, const ResultFile &file) {
  const Lines lines = lines_in(path, std::min(bytes, file.bytes));
  const std::int64_t rows = std::max<std::int64_t>(0, lines.count - 1);
  if (bytes < file.bytes) {
    return fmt::format("{} is cut short, it has {} of {} rows", file.name, rows, file.rows);
  }
  if (rows != file.rows || !lines.end_here) {
    return fmt::format("{} has changed, its first {} bytes had {} rows", file.name, file.bytes, file.rows);
  }
  return "";
}

} // namespace

std::string damage_of(const fs::path &directory, const ResultFile &file) {
  const fs::path path = directory / file.name;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    return file.name + " is missing";
  }
  const auto bytes = static_cast<std::int64_t>(fs::file_size(path, error));
  if (error) {
    return file.name + " cannot be looked at: " + error.message();
  }
  if (file.rows >= 0) {
    return damage_of_history(path, bytes, file);
  }
  return bytes == file.bytes
             ? ""
             : fmt::format("{} is damaged, it has {} of {} bytes", file.name, bytes, file.bytes);
}

std::vector<std::string> gaps_in(const fs::path &directory, const std::vector<ResultFile> &files) {
  std::vector<std::string> gaps;
  for (const ResultFile &file : files) {
    if (std::string damage = damage_of(directory, file); !damage.empty()) {
      gaps.push_back(std::move(damage));
    }
  }
  return gaps;
}

std::string words_on_gaps(const std::vector<std::string> &gaps) {
  constexpr std::size_t most_named = 5;
  std::string text;
  for (std::size_t k = 0; k < std::min(gaps.size(), most_named); ++k) {
    text += (k > 0 ? "; " : "") + gaps[k];
  }
  return text + (gaps.size() > most_named ? fmt::format("; and {} more", gaps.size() - most_named) : "");
}

} // namespace gcpdda
