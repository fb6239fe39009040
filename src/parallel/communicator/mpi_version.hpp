#pragma once

// The name and version of the MPI library.

#include <string>

namespace gcpdda {

/// First line of what the MPI library that runs says of itself: "Open MPI v4.1.4, ...".
std::string mpi_version();

} // namespace gcpdda
