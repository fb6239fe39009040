#pragma once

// What `gcpdda --version` prints.

#include <string>

namespace gcpdda {

/// The program, its compiler and the libraries that it uses, each on a line with its version.
std::string versions();

} // namespace gcpdda
