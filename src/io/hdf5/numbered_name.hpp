#pragma once

// Names of files with a number.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace gcpdda {

/// The number of a file named <stem>_<digits><extension>; nothing for other names.
inline std::optional<std::int64_t> number_of(const std::string &name, const std::string &stem,
                                             const std::string &extension) {
  constexpr std::size_t most_digits = 18;
  if (!name.starts_with(stem + "_") || !name.ends_with(extension) ||
      name.size() <= stem.size() + 1 + extension.size()) {
    return std::nullopt;
  }
  const std::string digits = name.substr(stem.size() + 1, name.size() - stem.size() - 1 - extension.size());
  if (digits.size() > most_digits ||
      !std::all_of(digits.begin(), digits.end(), [](char c) { return '0' <= c && c <= '9'; })) {
    return std::nullopt;
  }
  return std::stoll(digits);
}

inline bool is_numbered(const std::string &name, const std::string &stem, const std::string &extension) {
  return number_of(name, stem, extension).has_value();
}

} // namespace gcpdda
