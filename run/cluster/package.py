"""A Spack recipe for gcpdda: put it into packages/gcpdda of a repository (`spack repo create`), then

    spack develop --path FOLDER_OF_THIS_REPOSITORY gcpdda@main
    spack install gcpdda@main

Written by the list of Debian packages that are known to work (run/packages.txt); Spack was not at hand to try it.
"""
from spack.package import *


class Gcpdda(CMakePackage):
    """Block-by-block simulation of jointed rock slopes and tunnels on MPI ranks."""

    version("main")

    variant("tests", default=False, description="Build the tests and studies")

    depends_on("cmake@3.25:", type="build")
    depends_on("ninja", type="build")
    depends_on("mpi")
    depends_on("hdf5+mpi")
    depends_on("metis@5:")
    depends_on("eigen@3.4:")
    depends_on("tomlplusplus")
    depends_on("cli11")
    depends_on("fmt")
    depends_on("geos@3.11:")
    depends_on("coinutils")
    depends_on("clp")
    depends_on("googletest", when="+tests")
    depends_on("benchmark", when="+tests")
    depends_on("python@3.9:", type="run")
    depends_on("py-h5py", type="run")
    depends_on("py-matplotlib", type="run")
    depends_on("py-numpy", type="run")
    depends_on("py-pandas", type="run")

    conflicts("%gcc@:11", msg="gcpdda needs g++ 12 or later, or clang 14 or later")

    def cmake_args(self):
        return [self.define_from_variant("GCPDDA_TESTS", "tests")]
