#pragma once

// JSON text.

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace gcpdda {

inline std::string json(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "null"; // JSON knows no inf and nan
}

inline std::string json(std::integral auto value) {
  return fmt::format("{}", value);
}

inline std::string json(const std::string &text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
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
