# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the build into an empty folder and builds the sample project against it. Makes the Debian package, unpacks it
and runs its programs. Makes a program independent of the system, as the archive has it. Arguments: the build folder,
the source folder, the version."""

import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE, VERSION = sys.argv[1:4]
sys.path.insert(0, os.path.join(SOURCE, "packaging"))
import archive  # noqa: E402

PROGRAMS = ["AlignModel", "CalibrateHousing", "CompareSurveys", "DensifyPointCloud", "EvaluateReconstruction",
            "ExtractFrames", "FindTargets", "InterfaceCOLMAP", "MapSurface", "MeasureSurface", "ProjectLabels",
            "ReconstructMesh", "RefineMesh", "RefinePoses", "ReproducePaper", "RestoreColors", "SimulateUnderwater",
            "TextureMesh", "TransformScene", "ViewScene"]


def output_of(*command):
    result = subprocess.run([str(word) for word in command], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=240)
    assert result.returncode == 0, f"{command}: {result.returncode}\n{result.stdout}"
    return result.stdout


def pixel_by_snell(point):
    """The pixel of a point behind the sample's port, by bisection on Snell's law."""
    focal, distance, thickness = 800, 0.02, 0.014
    n_glass, n_water = 1.52, 1.333
    x, y, z = point
    radius = math.hypot(x, y)

    def reached(tangent):
        sine = tangent / math.hypot(1, tangent)
        tan_of = lambda n: (sine / n) / math.sqrt(1 - (sine / n) ** 2)
        return (distance * tangent + thickness * tan_of(n_glass) +
                (z - distance - thickness) * tan_of(n_water))

    low, high = 0.0, 10.0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if reached(middle) < radius else (low, middle)
    return 511.5 + focal * low * x / radius, 383.5 + focal * low * y / radius


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axial-install-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check_programs(self, prefix):
        for program in PROGRAMS:
            said = output_of(prefix / "bin" / program, "--version")
            self.assertRegex(said, rf"^{program} {re.escape(VERSION)}, commit ([0-9a-f]+\+?|unknown), "
                                   "instruction sets: SSE2, AVX2, AVX-512\n$")
            self.assertTrue(list((prefix / "share/man/man1").glob(program + ".1*")), program)
        page = "share/axialmvs/view/viewer.js"
        self.assertEqual((prefix / page).exists(), pathlib.Path(BUILD, page).exists())
        self.assertIn("--housing", output_of(prefix / "bin/axial-reconstruct", "--help"))
        self.assertIn("--camera-model", output_of(prefix / "bin/axial-colmap-model", "--help"))
        self.assertTrue((prefix / "share/doc").is_dir())


class Installed(Case):
    def test_the_sample_project_finds_the_package(self):
        prefix, build = self.folder / "usr", self.folder / "build"
        output_of("cmake", "--install", BUILD, "--prefix", prefix)
        self.check_programs(prefix)
        include = prefix / "include/axialmvs"
        headers = {path.relative_to(include).parts[:-1] for path in prefix.rglob("*.h")}
        self.assertEqual(headers, {("axial",), ("refractive",)})
        self.assertLessEqual(len(list(include.glob("axial/*.h"))), 25)
        output_of("cmake", "-S", os.path.join(SOURCE, "tests/install/sample"), "-B", build,
                  "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")
        output_of("cmake", "--build", build)

        visible, x, y, miss = map(float, output_of(build / "project_point").split())
        expected = pixel_by_snell((0.5, -0.3, 1.5))
        self.assertEqual(visible, 1)
        self.assertAlmostEqual(x, expected[0], delta=1e-5)  # six digits are printed
        self.assertAlmostEqual(y, expected[1], delta=1e-5)
        self.assertLess(miss, 1e-9)

        cloud = self.folder / "cloud.ply"
        cloud.write_bytes(b"ply\nformat binary_little_endian 1.0\nelement vertex 2\n"
                          b"property float x\nproperty float y\nproperty float z\nend_header\n" +
                          struct.pack("<6f", 1, 2, 3, 4, 5, 6))
        self.assertEqual(output_of(build / "count_points", cloud), "2\n")
        self.assertRegex(output_of(build / "use_mesh"),
                         r"^mesh: 8 faces\nmap: 20 columns\ncompare: 0 changes\nrefine: .+\ntexture: .+\n$")
        self.check_python(prefix)
        self.check_densify(prefix / "bin", build / "densify_scene")
        self.check_memory(build / "densify_memory")

    def check_python(self, prefix):
        """The Python package finds all that it needs in its folder."""
        folder = prefix / "lib/python3/dist-packages"
        said = output_of("env", f"PYTHONPATH={folder}", "/usr/bin/python3", "-B", "-c",
                         "import axialmvs; print(axialmvs.Lens(9, 9, 4, 3), axialmvs.__file__)")
        self.assertEqual(said, f"Lens(9, 9, 4, 3) {folder}/axialmvs/__init__.py\n")
        self.assertTrue((folder / "axialmvs/py.typed").exists())

    def check_densify(self, programs, densify):
        """Runs a survey under water by the library: with progress, stopped, continued, and with a refused option."""
        dive, scene, out = self.folder / "dive", self.folder / "scene.mvs", self.folder / "out"
        output_of(programs / "SimulateUnderwater", "--preset", "closeup", "--views", 4, "--width", 240, "--height", 180,
                  "--coarseness", 4, "--medium", "water", "-o", dive)
        output_of(programs / "InterfaceCOLMAP", "-i", dive / "sparse", "--image-folder", dive / "water", "--housing",
                  dive / "housing.json", "-o", scene)
        out.mkdir()

        def run(*arguments):
            return subprocess.run([str(word) for word in (densify, scene, out, *arguments)], text=True,
                                  capture_output=True, timeout=240)

        refused = run(0, 0)
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertRegex(refused.stderr, r"^tiles 0: .*\n$")
        stopped = run(1)
        self.assertEqual((stopped.returncode, stopped.stdout.splitlines()[-1]), (2, "stopped"), stopped.stderr)
        self.assertFalse((out / "dense.ply").exists())
        whole = run()
        self.assertEqual(whole.returncode, 0, whole.stderr)
        self.assertRegex(whole.stdout, r"Estimated depth maps: [123] maps existed already\n")
        self.assertRegex(whole.stdout, r"Fused depth maps: 4 of 4\n(.*\n)*[1-9]\d{3,} points in ")


    def check_memory(self, densify):
        """Runs a simulated survey whose data are in memory: refused, stopped, continued in a folder, and without
        files."""
        out, temporary = self.folder / "memory", self.folder / "temporary"
        out.mkdir()
        temporary.mkdir()

        def run(*arguments):
            return subprocess.run([str(word) for word in (densify, *arguments)], text=True, capture_output=True,
                                  timeout=240, env={**os.environ, "TMPDIR": str(temporary)})

        refused = run(0, 0)
        self.assertEqual(refused.returncode, 1, refused.stdout)
        self.assertRegex(refused.stderr, r"^tiles 0: .*\n$")
        for folder in ([], [out]):
            stopped = run(2, 1, *folder)
            self.assertEqual(stopped.returncode, 2, stopped.stderr)
            self.assertLess(float(re.search(r"^stopped after (.*) s$", stopped.stdout, re.M)[1]), 2)
        whole, continued = run(), run(0, 1, out)
        self.assertEqual((whole.returncode, continued.returncode), (0, 0), whole.stderr + continued.stderr)
        self.assertRegex(continued.stdout, r"Estimated depth maps: [234] maps existed already\n")
        result = re.search(r"\n6 maps, (\d+) points, mean distance (.*) m\n$", whole.stdout)
        self.assertTrue(result, whole.stdout)
        self.assertGreater(int(result[1]), 5000)
        self.assertLess(float(result[2]), 0.01)  # one pixel of disparity: 1.5 m * 1.5 m / (213 px * 0.2 m) = 0.05 m
        self.assertTrue(continued.stdout.endswith(result[0]), continued.stdout)
        self.assertEqual(list(temporary.iterdir()), [])
        self.assertTrue((out / "dense.ply").exists())


class DebianPackage(Case):
    def test_it_has_its_dependencies_and_runs(self):
        output_of("cpack", "-G", "DEB", "--config", os.path.join(BUILD, "CPackConfig.cmake"),
                  "-B", self.folder)
        package, = self.folder.glob("axialmvs_*.deb")
        depends = output_of("dpkg-deb", "--field", package, "Depends")
        for needed in ("colmap", "python3", "libopencv-imgcodecs", "libtbb",
                       "libboost-program-options", "libembree", "libc6"):
            self.assertIn(needed, depends)
        root = self.folder / "root"
        output_of("dpkg-deb", "--extract", package, root)
        self.assertEqual(list(root.rglob("axialmvs/__init__.py")), [])
        self.check_programs(root / "usr")
        for program in PROGRAMS:
            self.assertNotIn("not found", output_of("ldd", root / "usr/bin" / program))
        package, = self.folder.glob("python3-axialmvs_*.deb")
        self.assertIn("python3-numpy", output_of("dpkg-deb", "--field", package, "Depends"))
        names = output_of("dpkg-deb", "--contents", package)
        self.assertIn("./usr/lib/python3/dist-packages/axialmvs/__init__.py", names)
        self.assertNotIn("./usr/bin", names)


class Archive(Case):
    def test_a_program_loads_only_libraries_and_data_of_the_archive(self):
        prefix = self.folder / "axialmvs"
        (prefix / "bin").mkdir(parents=True)
        shutil.copy(pathlib.Path(BUILD, "bin/MapSurface"), prefix / "bin")  # all programs would take a minute
        archive.complete(prefix)
        self.assertEqual(archive.loaded_from_outside(prefix), [])
        documented = re.search(r"glibc (\d+)\.(\d+) is in", pathlib.Path(SOURCE, "docs/install.md").read_text())
        self.assertLessEqual(archive.newest_glibc(prefix), tuple(map(int, documented.groups())))
        self.assertIn("libgdal", (prefix / archive.NOTICES / "packages.txt").read_text())

        # Without a library of the archive, its programs would take that of the system.
        tiff = next((prefix / archive.LIBRARIES).glob("libtiff.so*"))
        tiff.rename(self.folder / tiff.name)
        self.assertIn(("MapSurface", tiff.name),
                      [(program, os.path.basename(path)) for program, path in archive.loaded_from_outside(prefix)])
        (self.folder / tiff.name).rename(tiff)
        self.check_data(prefix)

    def test_its_bytes_depend_on_the_contents_alone(self):
        packed = []
        for order in ("ab", "ba"):
            prefix = self.folder / order / "axialmvs"
            prefix.mkdir(parents=True)
            for name in order:
                (prefix / name).write_text(name)
                os.utime(prefix / name, (len(packed), len(packed)))
                (prefix / name).chmod(0o600 if packed else 0o644)
            archive.pack(prefix, self.folder / f"{order}.tar.xz")
            packed.append((self.folder / f"{order}.tar.xz").read_bytes())
        self.assertEqual(packed[0], packed[1])
        (prefix / "a").write_text("other")
        archive.pack(prefix, self.folder / "other.tar.xz")
        self.assertNotEqual((self.folder / "other.tar.xz").read_bytes(), packed[0])

    def check_data(self, prefix):
        """Programs look for coordinate systems in the archive: with an empty data base they know none."""
        def said():
            result = subprocess.run([prefix / "bin/MapSurface", "-i", self.folder / "none.mvs", "--epsg", "32633"],
                                    capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 1)
            return result.stderr

        self.assertIn("none.mvs", said())
        (prefix / "share/axialmvs/proj/proj.db").write_bytes(b"")
        self.assertIn("--epsg 32633: is no coordinate reference system", said())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
