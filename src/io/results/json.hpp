#pragma once

// JSON text.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gcpdda {

inline std::string json(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null"; // JSON knows no inf and nan
}

inline std::string json(std::integral auto value) {
  return fmt::format("{}", value);
}

/// Bytes of the UTF-8 character that begins here, 0 where none does (RFC 3629).
inline std::size_t length_of_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80    ? 1
                             : byte(0) < 0xc2  ? 0
                             : byte(0) < 0xe0  ? 2
                             : byte(0) < 0xf0  ? 3
                             : byte(0) <= 0xf4 ? 4
                                               : 0;
  if (length < 2 || length > text.size()) {
    return length == 1 ? 1 : 0;
  }
  // Longer forms than needed, halves of pairs of UTF-16, and numbers above 10FFFF are no characters.
  const unsigned low = byte(0) == 0xe0 ? 0xa0 : byte(0) == 0xf0 ? 0x90 : 0x80;
  const unsigned high = byte(0) == 0xed ? 0x9f : byte(0) == 0xf4 ? 0x8f : 0xbf;
  bool is_whole = byte(1) >= low && byte(1) <= high;
  for (std::size_t i = 2; i < length; ++i) {
    is_whole = is_whole && byte(i) >= 0x80 && byte(i) <= 0xbf;
  }
  return is_whole ? length : 0;
}

/// A byte that is part of no UTF-8 character becomes U+FFFD: names of files may hold such bytes, JSON may
/// not.
inline std::string json(const std::string &text) {
  std::string quoted = "\"";
  std::size_t length = 0;
  for (std::size_t at = 0; at < text.size(); at += std::max<std::size_t>(1, length)) {
    const char c = text[at];
    length = length_of_character(std::string_view(text).substr(at));
    if (length == 0) {
      quoted += "\\ufffd";
    } else if (length > 1) {
      quoted.append(text, at, length);
    } else if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

inline std::string json(const std::vector<std::int64_t> &values) {
  return fmt::format("[{}]", fmt::join(values, ", "));
}

inline std::string json(const std::vector<double> &values) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : ", ") + json(value);
  }
  return "[" + text + "]";
}

inline std::string json(const std::vector<std::string> &values) {
  std::string text;
  for (const std::string &value : values) {
    text += (text.empty() ? "" : ", ") + json(value);
  }
  return "[" + text + "]";
}

/// `{"key": value, ...}` on one line, or on a line per key.
class JsonObject {
public:
  explicit JsonObject(std::string between = ", ") : between_(std::move(between)) {}
  template <class Value> JsonObject &add(const std::string &key, const Value &value) {
    return add_raw(key, json(value));
  }
  JsonObject &add(const std::string &key, const JsonObject &value) { return add_raw(key, value.text()); }
  JsonObject &add(const std::string &key, const std::vector<JsonObject> &list) {
    std::string text;
    for (const JsonObject &object : list) {
      text += (text.empty() ? "" : ", ") + object.text();
    }
    return add_raw(key, "[" + text + "]");
  }
  [[nodiscard]] std::string text() const { return "{" + members_ + "}"; }

private:
  JsonObject &add_raw(const std::string &key, const std::string &value) {
    members_ += (members_.empty() ? "" : between_) + json(key) + ": " + value;
    return *this;
  }
  std::string between_;
  std::string members_;
};

} // namespace gcpdda
