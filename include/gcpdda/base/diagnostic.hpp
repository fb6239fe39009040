#pragma once

// Messages to people: what, where, why, and what to try.

#include <string>
#include <vector>

namespace gcpdda {

/// A position in a scene file; line 0 means "no position" (a --set argument, say, names itself in `file`).
struct SourcePosition {
  std::string file;
  int line = 0;
  int column = 0;
};

enum class Severity { error, warning, info };

/// One message to a person: what is wrong, why it is, what to try.
struct Diagnostic {
  Severity severity = Severity::error;
  SourcePosition where;
  std::string what;
  std::string why;
  std::string hint;
};

using Diagnostics = std::vector<Diagnostic>;

inline bool has_errors(const Diagnostics &diagnostics) {
  for (const Diagnostic &d : diagnostics) {
    if (d.severity == Severity::error) {
      return true;
    }
  }
  return false;
}

/// `FILE:LINE:COLUMN: error: what, why, what to try`, one line without newline.
inline std::string to_string(const Diagnostic &d) {
  std::string text = d.where.file;
  if (d.where.line > 0) {
    text += ":" + std::to_string(d.where.line) + ":" + std::to_string(d.where.column);
  }
  const char *const names[] = {"error", "warning", "info"};
  text += (text.empty() ? "" : ": ") + std::string(names[static_cast<int>(d.severity)]) + ": " + d.what;
  for (const std::string *part : {&d.why, &d.hint}) {
    if (!part->empty()) {
      text += ", " + *part;
    }
  }
  return text;
}

} // namespace gcpdda
