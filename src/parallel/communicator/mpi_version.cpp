#include "parallel/communicator/mpi_version.hpp"

#include <mpi.h>

#include <array>

namespace gcpdda {

std::string mpi_version() {
  std::array<char, MPI_MAX_LIBRARY_VERSION_STRING> text{};
  int length = 0;
  if (MPI_Get_library_version(text.data(), &length) != MPI_SUCCESS) {
    return "MPI, unknown version";
  }
  const std::string all(text.data()); // Open MPI counts the zero at the end in the length
  return all.substr(0, all.find('\n'));
}

} // namespace gcpdda
