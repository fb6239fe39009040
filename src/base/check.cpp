#include "base/check.hpp"

#include <string>

namespace gcpdda {

void throw_broken(const char *kind, const char *what) {
  throw InternalError(std::string(kind) + " broken: " + what);
}

} // namespace gcpdda
