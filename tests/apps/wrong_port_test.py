# SPDX-License-Identifier: GPL-3.0-or-later
"""DensifyPointCloud warns if port, lens or poses do not belong to the photographs, whichever of
them is wrong, and gives no warning if all are right."""

import json
import math
import os
import random
import re

from programs import cloud_size, files_below, main, must, png, read, read_json, run, write
from readers import records
from worlds import CLOSEUP, ROUGH, Simulated

NO_SCENE = "The photographs do not seem to show the scene"
WARNING = "Cameras and photographs do not seem to belong together"
# The check needs neither geometric passes nor filters nor a cloud.
QUICK = ("--geometric-iters", "0", "--postprocess-dmaps", "0", "--fusion-mode", "1")


def scaled_model(path, first, scale, every):
    """A COLMAP text file in which each record of `every` lines has the three numbers from column
    `first` multiplied by `scale`."""
    lines = records(path)
    for i in range(0, len(lines), every):
        words = lines[i].split()
        words[first:first + 3] = [repr(scale * float(word)) for word in words[first:first + 3]]
        lines[i] = " ".join(words)
    return "\n".join(lines) + "\n"


class PortTest(Simulated):
    def housing(self, **changes):
        housing = read_json(self.truth, "housing.json")
        housing["ports"]["main"].update(changes)
        return housing

    def scene(self, name, housing=None, medium="water", scale=1, focal=1, camera=None):
        """A folder with scene.mvs. The photographs are right; arguments make other inputs wrong."""
        sparse = os.path.join(self.truth, "sparse")
        words = records(os.path.join(sparse, "cameras.txt"))[-1].split()
        words[4:6] = [repr(focal * float(word)) for word in words[4:6]]
        if camera:
            words = camera(words)
        write(self.path(name, "sparse", "cameras.txt"), " ".join(words) + "\n")
        for part, first, every in (("images.txt", 5, 2), ("points3D.txt", 1, 1)):
            write(self.path(name, "sparse", part), scaled_model(os.path.join(sparse, part), first, scale, every))
        port = ()
        if housing:
            write(self.path(name, "port.json"), json.dumps(housing))
            port = ("--housing", self.path(name, "port.json"))
        self.imported(self.path(name, "scene.mvs"), os.path.join(self.truth, medium), model=self.path(name),
                      port=port)
        return self.path(name)

    def command(self, folder, *arguments):
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *QUICK, *arguments)

    def densify(self, folder, *arguments):
        return self.succeeds(*self.command(folder, "--report-file", "report.json", *arguments)).stdout

    def report(self, folder):
        return read_json(folder, "report.json")["agreement"]

    def warns(self, name, *expected, **wrong):
        folder = self.scene(name, **wrong)
        said = self.densify(folder)
        self.assertEqual(said.count(WARNING), 1, f"{name}: {said}")
        self.assertTrue(self.report(folder)["warning"], name)
        line = next(line for line in said.splitlines() if WARNING in line)
        self.assertRegex(line, r"\d px .*\d % of \d+ pixels agree.*Likely causes: ", name)
        for text in expected:
            self.assertIn(text, said, name)

    def passes(self, name, **right):
        folder = self.scene(name, **right)
        said = self.densify(folder)
        self.assertNotIn(WARNING, said, name)
        self.assertNotIn(NO_SCENE, said, name)
        self.assertIn("Agreement: ", said, name)
        self.assertNotIn("housing.ports.", said, name)
        self.assertFalse(self.report(folder)["warning"], name)
        return said


class FlatPort(PortTest):
    SCENE = CLOSEUP

    def test_what_is_right(self):
        self.passes("water", housing=self.housing())
        self.passes("air", medium="air")

    def test_a_wrong_port(self):
        self.warns("distance", housing=self.housing(distance_m=0.3))
        self.warns("normal", "housing.ports.main.normal is [", "45 degrees",
                   housing=self.housing(normal=[math.sqrt(0.5), 0, math.sqrt(0.5)]))
        self.warns("n1", "housing.ports.main.n_water is 1,", housing=self.housing(n_water=1.0))
        self.warns("n149", "housing.ports.main.n_water is 1.49,",
                   housing=self.housing(n_water=1.49))

    def test_a_wrong_lens(self):
        self.warns("twice", housing=self.housing(), focal=2)
        self.warns("absorbed", housing=self.housing(), focal=1.333)

    def test_a_housing_where_there_is_none(self):
        self.warns("forgotten", "a missing --housing")
        self.warns("in_air", housing=self.housing(), medium="air")

    def test_poses_that_are_not_in_metres(self):
        for scale in (10, 100, 1000, 0.1):
            clear = ("more than 25 m of water away",) if scale >= 100 else ()
            self.warns(f"times_{scale}", *clear, housing=self.housing(), scale=scale)
        # At these scales the scene lies inside the housing and is not visible.
        for scale in (0.01, 0.001):
            folder = self.scene(f"times_{scale}", housing=self.housing(), scale=scale)
            result = run(*self.command(folder))
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stdout, r"scene\.housing\.json: housing\.ports\.main\."
                             r"(distance_m|thickness_m) is .*"
                             r"check that port and poses are in metres")

    def test_one_line_whatever_is_run(self):
        """The warning is the same for resumed runs, existing maps, any number of threads, and
        little memory."""
        def line(said):
            return re.search(WARNING + ".*", said)[0]
        folder = self.scene("wrong", housing=self.housing(n_water=1.38, distance_m=0.1))
        first = line(self.succeeds(*self.command(folder)).stdout)
        for again in (("--max-threads", "1"), ("--max-memory", "200")):
            for name in files_below(folder):
                if name.endswith((".dmap", ".dmap.json")):
                    os.remove(os.path.join(folder, name))
            self.assertEqual(line(self.succeeds(*self.command(folder, *again)).stdout), first)
        # With all maps there already.
        base = self.command(folder)[:5]
        for command in (self.command(folder), (*base, "--fusion-mode", "-1")):
            self.assertEqual(line(self.succeeds(*command).stdout), first)
        for _ in range(2):  # with later stages
            self.assertEqual(self.succeeds(*base, "--geometric-iters", "1").stdout.count(WARNING), 1)
        self.assertGreater(cloud_size(read(os.path.join(folder, "scene_dense.ply"))), 0)
        self.assertFalse([name for name in files_below(folder) if "report" in name])

    def test_the_report_is_no_input(self):
        folder = self.scene("right", housing=self.housing())
        self.refuses("--report-file", *self.command(folder, "--report-file", "scene.mvs"))


class Noise(PortTest):
    """With few pixels per sparse point, maps of photographs without content stay at the sparse
    points and agree with each other."""
    SCENE = CLOSEUP
    SMALL = ("--resolution-level", "1", "--min-resolution", "100")

    def test_photographs_of_noise(self):
        rng = random.Random(3)
        folder = os.path.join(self.truth, "noise")
        for name in os.listdir(os.path.join(self.truth, "water")):
            # A PNG may be named .jpg, because the content tells the format.
            write(os.path.join(folder, name), png(
                [bytes(min(255, max(0, round(rng.gauss(128, 40)))) for _ in range(320))
                 for _ in range(240)]))
        for medium, housing in (("water", self.housing()), ("air", None)):
            noise = self.scene("noise_" + medium, housing=housing, medium="noise")
            said = self.densify(noise, *self.SMALL)
            self.assertEqual(said.count(NO_SCENE) + said.count(WARNING), 1, said)
            report = self.report(noise)
            self.assertIn(f"median score of {report['median_score']:.2f} (usual: over "
                          f"{report['limits']['median_score']})", said)
            self.assertTrue(report["warning"])
            self.assertLess(report["median_score"], report["limits"]["median_score"] - 0.04)
            right = self.scene(medium, housing=housing, medium=medium)
            said = self.densify(right, *self.SMALL)
            self.assertNotIn(NO_SCENE, said)
            self.assertNotIn(WARNING, said)
            self.assertGreater(self.report(right)["median_score"],
                               report["limits"]["median_score"] + 0.1)

    def test_hazy_and_noisy_photographs_are_right(self):
        truth = self.path("hazy")
        must("SimulateUnderwater", *self.SCENE, "--haze", 0.5, "--noise", 8, "-o", truth)
        self.truth, given = truth, self.truth
        try:
            self.passes("water", housing=self.housing())
            self.passes("air", medium="air")
        finally:
            self.truth = given


class DistortedLens(PortTest):
    SCENE = ("--preset", "closeup", *ROUGH, "--lens", "OPENCV,-0.25,0.08,0.001,0.001")

    def test_distortion(self):
        def straight(words):
            return [words[0], "PINHOLE", *words[2:8]]
        self.passes("right", housing=self.housing())
        self.warns("straight", housing=self.housing(), camera=straight)


class OtherPorts(PortTest):
    SCENE = ("--preset", "closeup", *ROUGH, "--dome-radius", 0.05, "--dome-z", 0.012)

    def test_a_dome(self):
        self.passes("right", housing=self.housing())
        self.warns("forgotten")


class FarScene(PortTest):
    """A scene 2 to 3 m away, behind a port without tilt."""
    SCENE = ("--preset", "reef", *ROUGH)

    def test_right_and_wrong(self):
        self.passes("right", housing=self.housing())
        self.warns("distance", housing=self.housing(distance_m=0.2))
        self.warns("n149", housing=self.housing(n_water=1.49))
        self.warns("absorbed", housing=self.housing(), focal=1.333)
        self.warns("forgotten")

    def test_a_unit_that_hardly_moves_a_point(self):
        """A port at 2 cm moves pixels of a scene at 3 m by a ninth of a pixel only. The distance of
        the scene shows the wrong unit."""
        for scale in (10, 100, 1000):
            folder = self.scene(f"times_{scale}", housing=self.housing(), scale=scale)
            said = self.densify(folder)
            line = "more than 25 m of water away: check that the poses are in metres"
            self.assertEqual(said.count(line), 1)
            self.assertLess(self.report(folder)["systematic_px"], 0.15)


if __name__ == "__main__":
    main()
