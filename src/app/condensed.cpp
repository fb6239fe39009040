#include "app/condensed.hpp"

#include <fmt/format.h>

#include <cctype>
#include <map>

namespace gcpdda {

namespace {

/// The text without quoted names and numbers.
std::string shape_of(const Diagnostic &diagnostic) {
  std::string shape = std::to_string(static_cast<int>(diagnostic.severity));
  bool is_quoted = false;
  for (const char c : diagnostic.what + ", " + diagnostic.why + ", " + diagnostic.hint) {
    is_quoted = is_quoted != (c == '\'');
    const bool in_number =
        std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+';
    if (!is_quoted && !in_number && c != 'e') { // the e of 1e-3, too
      shape += c;
    }
  }
  return shape;
}

} // namespace

Diagnostics condensed(const Diagnostics &all) {
  constexpr std::int64_t most = 10;
  struct Kind {
    std::int64_t count = 0;
    const Diagnostic *last = nullptr;
    std::size_t place = 0; ///< of its last line
  };
  std::map<std::string, Kind> kinds;
  Diagnostics few;
  for (const Diagnostic &diagnostic : all) {
    Kind &kind = kinds[shape_of(diagnostic)];
    kind.last = &diagnostic;
    if (++kind.count <= most + 1) { // a count of one would be as long as the line itself
      kind.place = few.size();
      few.push_back(diagnostic);
    }
  }
  for (const auto &[shape, kind] : kinds) {
    if (kind.count > most + 1) {
      Diagnostic &line = few[kind.place];
      line = *kind.last;
      line.what =
          fmt::format("{} more like these {}, the last of them: {}", kind.count - most, most, line.what);
    }
  }
  return few;
}

} // namespace gcpdda
