#pragma once

// Bits of text files of people, as their readers and messages want them.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace gcpdda {

inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  const std::size_t last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

/// With small letters for the capital ones of ASCII.
inline std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char &c : result) {
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return result;
}

/// Text of a file as it may stand in a message.
inline std::string printable(std::string_view text) {
  std::string result(text.substr(0, 40));
  for (char &c : result) {
    c = static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return result;
}

/// A row of a CSV file of at most `most` fields, without the spaces around them.
template <std::size_t most> struct CsvRow {
  std::array<std::string_view, most> fields;
  std::array<int, most> columns{}; ///< where each begins, from 1
  std::size_t count = 0;           ///< of fields in the row, also beyond the most

  explicit CsvRow(std::string_view row) {
    for (std::size_t at = 0; at <= row.size(); ++count) {
      const std::size_t end = std::min(row.find(',', at), row.size());
      if (count < most) {
        const std::string_view field = trimmed(row.substr(at, end - at));
        fields[count] = field;
        columns[count] =
            1 + static_cast<int>(field.empty() ? at : static_cast<std::size_t>(field.data() - row.data()));
      }
      at = end + 1;
    }
  }
};

/// A decimal number and nothing else, no larger than `largest`.
inline std::optional<double> to_number(std::string_view text, double largest) {
  text.remove_prefix(text.starts_with('+') ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::abs(value) <= largest ? std::optional(value) : std::nullopt;
}

} // namespace gcpdda
