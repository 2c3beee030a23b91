# SPDX-License-Identifier: BSD-3-Clause
"""Recipe of dem for Spack: docs/install.md."""

from spack_repo.builtin.build_systems.meson import MesonPackage

from spack.package import *


class Dem(MesonPackage):
    """Impact of elastic bodies as lattices of point masses and springs: a C library, a batch driver that reads
    Fortran namelists, pictures and conversion of its runs."""

    license("BSD-3-Clause")

    version("main", branch="main")

    variant("cairo", default=True, description="Build dem_plot, and read PNG images as masks")
    variant("fortran", default=True, description="Build the Fortran module")
    variant("mpi", default=False, description="Build libdem_mpi, by which processes share a model")

    depends_on("c", type="build")
    depends_on("fortran", type="build", when="+fortran")
    depends_on("meson@1.0:", type="build")
    depends_on("pkgconfig", type="build")
    # By which meson finds SUNDIALS.
    depends_on("cmake", type="build")

    depends_on("sundials@6.4:7 +ARKODE ~mpi")
    depends_on("hdf5@1.10: ~mpi")
    depends_on("gsl")
    depends_on("zlib-api")
    depends_on("cairo +png +svg +pdf", when="+cairo")
    depends_on("mpi", when="+mpi")

    conflicts("default_library=static", msg="libdem is a shared library")

    def meson_args(self):
        switch = lambda variant: "enabled" if self.spec.satisfies(f"+{variant}") else "disabled"
        return [
            f"-Dcairo={switch('cairo')}",
            f"-Dfortran={switch('fortran')}",
            f"-Dmpi={switch('mpi')}",
            "-Dtests=false",
        ]
