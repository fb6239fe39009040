#include "app/versions.hpp"

#include "base/program_facts.hpp"
#include "blockgen/planar_graph.hpp"
#include "io/hdf5/hdf5_version.hpp"
#include "parallel/communicator/mpi_version.hpp"
#include "partition/metis_cut.hpp"

namespace gcpdda {

std::string versions() {
  return "gcpdda " + program_version() + '\n' + mpi_version() + "\nHDF5 " + hdf5_version() + "\nMETIS " +
         metis_version() + "\nGEOS " + blockgen::geos_version() + '\n' + build_versions();
}

} // namespace gcpdda
