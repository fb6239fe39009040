# Installed: find_package(gcpdda) gives the target gcpdda::library.
include(CMakeFindDependencyMacro)
list(APPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR}) # FindMETIS.cmake, FindClp.cmake
set(MPI_CXX_SKIP_MPICXX ON)
set(HDF5_PREFER_PARALLEL ON)
enable_language(C) # what is linked statically is found by it
find_dependency(Threads)
find_dependency(MPI COMPONENTS C CXX)
find_dependency(HDF5 COMPONENTS C)
find_dependency(METIS)
find_dependency(Eigen3)
find_dependency(tomlplusplus)
find_dependency(fmt)
find_dependency(GEOS)
find_dependency(Clp)
include(${CMAKE_CURRENT_LIST_DIR}/gcpdda-targets.cmake)
