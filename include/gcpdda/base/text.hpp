#pragma once

// Bits of text files of people, as their readers and messages want them.

#include <string>
#include <string_view>

namespace gcpdda {

inline std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  const std::size_t last = text.find_last_not_of(" \t\r");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

/// Text of a file as it may stand in a message.
inline std::string printable(std::string_view text) {
  std::string result(text.substr(0, 40));
  for (char &c : result) {
    c = static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return result;
}

} // namespace gcpdda
