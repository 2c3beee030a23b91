#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What is installed, used as others would: `test_install.py BUILD SOURCE MESON COMPILER...`.

A scratch tree takes the installation. Programs are built against it with its pkg-config file and nothing else of ours,
and each drives the same body: docs/examples/drive.*."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

BUILD = SOURCE = MESON = COMPILER = None
FORTRAN = os.environ.get("FC", "").split()
SECONDS = 120

# Prints what ctypes takes the structures of a module for: "name field offset size", and "name size".
LAYOUT = """
import ctypes, inspect, sys
import drive
for name, kind in inspect.getmembers(drive, lambda a: inspect.isclass(a) and issubclass(a, ctypes.Structure) and hasattr(a, "_fields_")):
    for field, *_ in kind._fields_:
        print(name, field, getattr(kind, field).offset, getattr(kind, field).size)
    print(name, ctypes.sizeof(kind))
"""


def run(*command, fails=False, **more):
    done = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=SECONDS, check=False, **more)
    if done.returncode != 0 and not fails:
        raise AssertionError(f"{command}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.root = pathlib.Path(cls.folder.name, "root")
        cls.work = pathlib.Path(cls.folder.name, "work")
        cls.work.mkdir()
        run(MESON, "install", "-C", BUILD, "--destdir", cls.root, "--no-rebuild", "--quiet")
        cls.package = next(cls.root.rglob("dem.pc"))
        cls.lib = cls.package.parent.parent
        cls.bin = next(cls.root.rglob("bin/dem_batch")).parent
        cls.prefix = cls.bin.parent
        cls.include = next(cls.root.rglob("dem/dem.h")).parent
        # Nothing but this package is there to be found.
        cls.env = {**os.environ, "PKG_CONFIG_LIBDIR": str(cls.package.parent), "PKG_CONFIG_PATH": "",
                   "PKG_CONFIG_SYSROOT_DIR": str(cls.root), "LD_LIBRARY_PATH": str(cls.lib)}
        cls.programs = sorted(path.name for path in cls.bin.iterdir())

    def flags(self, *what, package="dem"):
        return run("pkg-config", *what, package, env=self.env).split()

    def compiled(self, *source, out):
        run(*COMPILER, "-std=c11", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", *source,
            *self.flags("--cflags", "--libs"), "-lm", "-o", self.work / out)
        return self.work / out

    def compiled_fortran(self, *source, out, package="dem-fortran"):
        run(*FORTRAN, "-std=f2018", "-O2", "-Wall", "-Wextra", "-pedantic", "-Werror", "-J", self.work, *source,
            *self.flags("--cflags", "--libs", package=package), "-o", self.work / out)
        return self.work / out

    def test_the_library_is_known_by_its_generation(self):
        version = self.flags("--modversion")[0]
        shared = self.lib / "libdem.so"
        self.assertEqual((os.readlink(shared), os.readlink(self.lib / "libdem.so.2")),
                         ("libdem.so.2", f"libdem.so.{version}"))
        dynamic = run("readelf", "-d", shared)
        self.assertEqual(re.findall(r"SONAME.*\[(.*)\]", dynamic), ["libdem.so.2"])
        needed = " ".join(re.findall(r"NEEDED.*\[(.*)\]", dynamic))
        self.assertRegex(needed, "libsundials_arkode.*libhdf5|libhdf5.*libsundials_arkode")
        self.assertNotRegex(needed, "gsl|cairo")
        self.assertNotIn(str(BUILD), dynamic)
        self.assertNotRegex(run("ldd", "-r", shared), "undefined|not found")

    def test_the_version_is_reported_alike(self):
        version = self.flags("--modversion")[0]
        self.assertIn(f"version: {version}\n", (SOURCE / "CITATION.cff").read_text(encoding="utf-8"))
        for page in (self.prefix / "share/man").rglob("dem_*"):
            self.assertIn(f'"dem {version}"', page.read_text().splitlines()[1])

    def test_every_program_has_its_page_and_its_completion(self):
        self.assertIn("dem_batch", self.programs)
        for program in self.programs:
            self.assertIn(f".TH {program.upper()} 1", (self.prefix / "share/man/man1" / f"{program}.1").read_text())
            self.assertIn("complete -F", (self.prefix / "share/bash-completion/completions" / program).read_text())
        self.assertIn(".TH DEM_DECK 5", (self.prefix / "share/man/man5/dem_deck.5").read_text())

    def test_programs_run_from_wherever_the_tree_is(self):
        deck = self.prefix / "share/dem/inputs/disc.nml"
        away = {name: value for name, value in os.environ.items() if name != "LD_LIBRARY_PATH"}
        for program in self.programs:
            self.assertIn(f"dem {self.flags('--modversion')[0]}", run(self.bin / program, "--version", env=away))
            self.assertIn(str(self.lib), os.path.realpath(re.search(
                r"libdem.so.2 => (\S+)", run("ldd", self.bin / program, env=away))[1]))
        run(self.bin / "dem_batch", "--set", "run.t_end=1e-4", "--outdir", self.work, deck, env=away)
        self.assertTrue((self.work / "disc.vtkhdf").exists())

    def test_the_package_asks_for_no_other(self):
        run("pkg-config", "--validate", "dem", env=self.env)
        self.assertEqual(self.flags("--print-requires", "--print-requires-private"), [])
        self.assertEqual(self.flags("--cflags"), [f"-I{self.include.parent}"])
        self.assertEqual(self.flags("--libs"), [f"-L{self.lib}", "-ldem"])

    def test_every_header_stands_alone_in_c_and_cpp(self):
        headers = sorted(path.name for path in self.include.glob("*.h") if path.name != "mpi.h")  # needs MPI's own
        self.assertIn("trajectory.h", headers)
        for header in headers:
            alone = self.work / "alone.c"
            alone.write_text(f"#include <dem/{header}>\n#include <dem/{header}>\ntypedef int something;\n")
            strict = ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-fsyntax-only", *self.flags("--cflags")]
            run(*COMPILER, "-std=c11", *strict, alone)
            run("c++", "-std=c++11", "-x", "c++", *strict, alone)

    def test_programs_in_all_languages_see_the_same_motion(self):
        """Each also holds it against the exact one, and the stress, and fails otherwise."""
        examples, said = SOURCE / "docs/examples", {}
        said["C"] = run(self.compiled(examples / "drive.c", out="drive"), env=self.env)
        said["Python"] = run(sys.executable, examples / "drive.py", env=self.env)
        if FORTRAN:
            said["Fortran"] = run(self.compiled_fortran(examples / "drive.f90", out="drive_fortran"), env=self.env)
        self.assertRegex(said["C"], r"^\d\.\d{9}e-0\d m\n$")
        self.assertEqual(len({line.lower() for line in said.values()}), 1, said)

    def test_structures_of_the_python_example_are_those_of_c(self):
        env = {**self.env, "PYTHONPATH": str(SOURCE / "docs/examples"), "PYTHONDONTWRITEBYTECODE": "1"}
        layout = run(sys.executable, "-c", LAYOUT, env=env)
        self.assertIn("dem_options force ", layout)
        rows = []
        for name, *field in map(str.split, layout.splitlines()):
            if len(field) == 3:
                place = f"offsetof({name}, {field[0]}), sizeof(({name} *)0)->{field[0]}"
                rows.append(f'printf("{name} {field[0]} %zu %zu\\n", {place});')
            else:
                rows.append(f'printf("{name} %zu\\n", sizeof({name}));')
        probe = self.work / "layout.c"
        probe.write_text("#include <dem/dem.h>\n#include <stdio.h>\nint main(void)\n{\n" + "\n".join(rows) + "\nreturn 0;\n}\n")
        self.assertEqual(run(self.compiled(probe, out="layout"), env=self.env), layout)

    def ranks_of(self, page, language, command, *flags):
        """What the program of a page prints on 1 and on 3 ranks, as numbers."""
        text = (SOURCE / "docs" / page).read_text(encoding="utf-8").split("\n## Several processes\n")[1]
        source, program = re.search(rf"{command} (\S+) .* -o (\S+) &&", text).groups()
        (self.work / source).write_text(re.search(rf"(?s)```{language}\n(.*?)```", text)[1])
        env = {**self.env, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
               "OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}
        line = re.search(rf"{command} .*(?= &&)", text)[0]
        run("sh", "-c", " ".join([line, *flags]), env=env, cwd=self.work)
        said = [run("mpirun", "-n", n, f"./{program}", env=env, cwd=self.work) for n in (1, 3)]
        self.assertEqual(said[0], said[1])
        return [float(number) for number in said[0].split()]

    def test_ranks_see_the_motion_of_one_as_the_manual_says(self):
        """Where the library was built with MPI."""
        if not (self.include / "mpi.h").exists():
            return
        in_c = self.ranks_of("linking.md", "c", "mpicc", "-std=c11", "-Wall", "-Wextra", "-Werror")
        self.assertGreater(len(in_c), 1000)
        if FORTRAN:
            self.assertEqual(self.ranks_of("fortran.md", "fortran", "mpif90", "-J", "."), in_c)
        self.assertIn("libmpi", run("ldd", self.lib / "libdem_mpi.so", env=self.env))
        self.assertNotIn("libdem_mpi", run("ldd", self.lib / "libdem.so", env=self.env))

    @unittest.skipUnless(FORTRAN, "there is no Fortran compiler")
    def test_the_fortran_module_can_be_made_from_its_sources(self):
        sources = [self.include / "dem_c.f90", self.include / "dem.f90", SOURCE / "docs/examples/drive.f90"]
        run(self.compiled_fortran(*sources, out="drive_sources", package="dem"), env=self.env)

    def test_cmake_finds_it_as_the_manual_says(self):
        manual = (SOURCE / "docs/linking.md").read_text(encoding="utf-8")
        (self.work / "CMakeLists.txt").write_text(re.search(r"(?s)```cmake\n(.*?)```", manual)[1])
        (self.work / "drive.c").write_bytes((SOURCE / "docs/examples/drive.c").read_bytes())
        run("cmake", "-G", "Ninja", f"-DCMAKE_C_COMPILER={COMPILER[-1]}", "-S", self.work, "-B", self.work / "cmake",
            env=self.env)
        run("cmake", "--build", self.work / "cmake", env=self.env)
        run(self.work / "cmake/drive", env=self.env)


if __name__ == "__main__":
    BUILD, SOURCE, MESON = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
    COMPILER = sys.argv[4:]
    sys.argv[1:] = []
    unittest.main()
