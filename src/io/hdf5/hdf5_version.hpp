#pragma once

// The version of the HDF5 library.

#include <string>

namespace gcpdda {

/// Version of the HDF5 library that runs: "1.10.8".
std::string hdf5_version();

} // namespace gcpdda
