# SPDX-License-Identifier: GPL-3.0-or-later
"""What `reconstruct` finds out before COLMAP runs, and `reconstruct --check`."""

import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import unittest.mock

from pipeline_folder import InFolder, reconstruct_command
from programs import ProgramTest, main, png, read, run, write

from axial_pipeline import estimates, first_checks
from axial_pipeline.failure import Failure

FLAT = {"type": "flat", "distance_m": 0.02, "thickness_m": 0.01, "n_glass": 1.52, "n_water": 1.333}
DOME = {"type": "dome", "inner_radius_m": 0.05, "thickness_m": 0.007, "n_glass": 1.49, "n_water": 1.333}
SURFACE = {"type": "water-surface", "normal": [0, 0, 1], "point_m": [0, 0, 1], "n_water": 1.333}


def housing_with(port):
    return json.dumps({"version": 1, "ports": {"main": port}, "default": "main"})


class Values(InFolder):
    """--scale-from and --refine."""

    def reason(self, check, option, text, *more, **given):
        """The reason for which the value of an option is refused; empty if it is not."""
        try:
            check(argparse.Namespace(**given), *more)
        except Failure as failure:
            return str(failure).removeprefix(f"{option} {text}: ")
        return ""

    def scale(self, text, names=("a.jpg", "dive/b.jpg", "c,d.jpg")):
        return self.reason(first_checks.check_scale, "--scale-from", text, names, scale_from=text, images="images")

    def refine(self, text, housing):
        return self.reason(first_checks.check_refine, "--refine", text, refine=text, housing=str(housing))

    def test_names_and_lengths_are_checked(self):
        for text in ("", "positions:file", "points:3,4,0.5", "images:a.jpg,dive/b.jpg,0.5",
                     'images:"a.jpg",dive/b.jpg,1e-2', 'images:"c,d.jpg",a.jpg,0.5', "images:c,d.jpg,a.jpg,0.5"):
            self.assertEqual(self.scale(text), "", text)
        for text, reason in (("images:a.jpg,x.jpg,0.5", "images has no photograph 'x.jpg'"),
                             ("images:a.jpg,B.jpg,0.5", "images has no photograph 'B.jpg'; there is dive/b.jpg"),
                             ("images:a.jpg,a.jpg,0.5", "both ends are the same"),
                             ("images:a.jpg,0.5", "must give two ends and the distance between them in metres"),
                             ("points:1,2,3,4", "must give two ends and the distance between them in metres"),
                             ("images:a.jpg,dive/b.jpg,x", "'x' is not a number"),
                             ("points:3,4,0", "0 m is not a distance"),
                             ("points:3,4,nan", "nan m is not a distance"),
                             ('images:"a.jpg,0.5', "a double quote is not closed"),
                             ("image:a.jpg,c.jpg,0.5", "must begin with images:, points: or positions:"),
                             ("images", "must begin with images:, points: or positions:")):
            self.assertEqual(self.scale(text), reason)

    def test_unknowns_fit_the_ports(self):
        flat, dome = (self.write(f"{port['type']}.json", housing_with(port)) for port in (FLAT, DOME))
        for text, housing in (("", flat), ("normal,distance,thickness,index,focal", flat), ("centre", dome),
                              ("none", flat), ("auto", dome), ("normal", "flat"), ("centre,normal", "unknown"),
                              ("normal,centre", self.write("calibration.yaml", "model: OPENCV\n"))):
            self.assertEqual(self.refine(text, housing), "", text)
        words = "normal, distance, centre, thickness, index, focal"
        self.assertEqual(self.refine("normal,tilt", flat), f"'tilt' is not one of {words}")
        self.assertEqual(self.refine("normal,", flat), f"'' is not one of {words}")
        self.assertEqual(self.refine("centre", flat),
                         f"centre belongs to a dome port, and --housing {flat} has none")
        self.assertEqual(self.refine("distance", "dome"),
                         "distance belongs to a flat port, and --housing dome has none")

    def test_the_program_takes_the_same_unknowns(self):
        said = " ".join(run("RefinePoses", "--help").stdout.split())
        alone, listed = re.search(r"--refine arg .*?: (auto, none), or a list of (.*?);", said).groups()
        self.assertEqual([[word] for word in alone.split(", ")], list(first_checks.ALONE))
        self.assertEqual(re.findall(r"\w+", re.sub(r"\(.*?\)", "", listed)), list(first_checks.REFINED))


class Commands(unittest.TestCase):
    def test_options_for_matches_go_to_the_command_of_the_matcher(self):
        for matcher, command in (("exhaustive", "exhaustive_matcher"), ("cascade", "matches_importer"),
                                 ("vocabulary", "vocab_tree_matcher"), ("spatial", "spatial_matcher")):
            self.assertEqual(first_checks.command_of("matches", argparse.Namespace(matcher=matcher)),
                             ["colmap", command])


class Estimates(InFolder):
    def needs(self, count, size=(6000, 4000), **more):
        given = argparse.Namespace(**{"until": "cloud", "matcher": "exhaustive", "restore_colors": False,
                                      "match_restored": False, **more})
        return estimates.needs_of(given, [size] * count)

    def test_pairs_dominate_large_surveys(self):
        few, many = self.needs(10), self.needs(1000)
        self.assertLess(few.seconds["matches"], few.seconds["depth maps"])
        self.assertGreater(many.seconds["matches"], many.seconds["depth maps"])
        self.assertLess(self.needs(1000, matcher="sequential").seconds["matches"], 0.1 * many.seconds["matches"])
        self.assertLess(self.needs(60, matcher="cascade").seconds["matches"],
                        self.needs(60).seconds["matches"] / 3)
        self.assertAlmostEqual(self.needs(1000, matcher="cascade").seconds["matches"],
                               10 * self.needs(100, matcher="cascade").seconds["matches"])
        self.assertEqual(self.needs(10, until="poses").seconds["depth maps"], 0)

    def test_sizes_are_those_of_the_programs(self):
        self.assertEqual(estimates.depth_pixels((1280, 960)), 640 * 480)
        self.assertEqual(estimates.depth_pixels((1270, 960)), 1270 * 960)
        self.assertEqual(estimates.depth_pixels((10240, 5120)), 2560 * 1280)

    def test_photographs_without_water_need_disk_space(self):
        more = self.needs(10, until="page", restore_colors=True).disk - self.needs(10, until="page").disk
        clouds = 10 * estimates.CLOUD_BYTES * estimates.depth_pixels((6000, 4000))
        self.assertAlmostEqual(more, 10 * 6000 * 4000 + clouds, delta=1)

    def test_matching_again_takes_time(self):
        once = self.needs(10, until="page", restore_colors=True)
        twice = self.needs(10, until="page", restore_colors=True, match_restored=True)
        self.assertEqual(twice.seconds, {**once.seconds, "depth maps without water": once.seconds["depth maps"]})
        self.assertEqual(twice.disk, once.disk)  # the depth maps are replaced

    def test_what_is_scarce_is_said(self):
        needs = self.needs(100)
        self.assertEqual(list(estimates.warnings_about(estimates.Needs({}, 1, 1, 2), self.folder / "new" / "out")), [])
        with unittest.mock.patch.object(estimates, "free_disk", return_value=5e8), \
                unittest.mock.patch.object(estimates, "memory_of_machine", return_value=1e9):
            disk, memory = estimates.warnings_about(needs, self.folder)
        self.assertIn(f"--output {self.folder}: 0.5 GB are free on this disk, and about ", disk)
        self.assertIn("this machine has 1.0 GB of memory", memory)

    def test_times_are_rounded(self):
        self.assertEqual([estimates.time_in_words(seconds) for seconds in (0, 33, 600, 36000)],
                         ["some seconds", "30 s", "10 min", "10.0 h"])


@unittest.skipUnless(shutil.which("colmap"), "COLMAP is not installed")
class Checked(ProgramTest):
    """The whole script, with the programs of the build. COLMAP looks at the photographs for
    --check only."""

    def setUp(self):
        super().setUp()
        for number in range(3):
            write(self.path("images", f"{number}.png"), png([bytes([number] * 48)] * 36))
        write(self.path("lens.txt"), "1 PINHOLE 48 36 40 40 24 18\n")
        write(self.path("housing.json"), housing_with(FLAT))

    def check(self, *more, housing="housing.json", lens="lens.txt"):
        return subprocess.run(reconstruct_command(*more, lens=lens, housing=housing), cwd=self.folder,
                              capture_output=True, text=True, timeout=60)

    def refused(self, *more, **files):
        """The line of a run that is refused, with and without --check, before it writes anything."""
        lines = set()
        for check in ([], ["--check"]):
            ended = self.check(*check, *more, **files)
            self.assertEqual((ended.returncode, ended.stderr.count("\n")), (1, 1), ended.stderr)
            self.assertFalse(os.path.exists(self.path("out")))
            lines.add(ended.stderr.removeprefix("reconstruct: ").strip())
        line, = lines
        return line.replace(str(pathlib.Path(self.folder).resolve()) + "/", "")

    def test_a_sound_dive_has_a_table(self):
        ended = self.check("--check", "--scale-from", "images:0.png,1.png,0.5", "--densify=--iters 3",
                           "--features=--SiftExtraction.max_num_features 100")
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        words = [line[:12].strip() for line in ended.stdout.splitlines()]
        self.assertEqual(words, ["photographs", "lens", "housing", "scale", "time", "memory", "disk", "looked at",
                                 "contrast", "contrast", "blur", "overlap", "No fault was"])
        self.assertIn("3 of 48 x 36 pixels", ended.stdout)
        self.assertIn("main: flat, distance_m 0.02, n_water 1.333", ended.stdout)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_contents_of_lens_and_housing(self):
        write(self.path("bad.txt"), "1 PINHOLE 48 36 40 x 24 18\n")
        self.assertIn("bad.txt: line 1: PINHOLE parameter is 'x'", self.refused(lens="bad.txt"))
        for number, port in enumerate((SURFACE, {**FLAT, "n_water": 0.5}, {**FLAT, "distance_mm": 20})):
            write(self.path(f"{number}.json"), housing_with(port))
        self.assertEqual(self.refused(housing="0.json"), "0.json: housing.ports.main is a water surface, expected "
                         "ports that are fixed to the camera")
        self.assertIn("1.json: housing.ports.main", self.refused(housing="1.json"))
        self.assertIn("2.json: housing.ports.main", self.refused(housing="2.json"))

    def test_another_lens_is_read_too(self):
        write(self.path("other.txt"), "1 PINHOLE 30 36 40 40 24 18 9\n")
        self.assertIn("other.txt: line 1: unexpected '9' at the end", self.refused("--lens", "other.txt"))

    def test_a_wrong_lens_is_named_before_the_photographs(self):
        write(self.path("images", "4.png"), png([bytes(24)] * 18))
        write(self.path("bad.txt"), "1 PINHOLE 48 36\n")
        self.assertIn("bad.txt: line 1", self.refused(lens="bad.txt"))

    def test_a_lens_of_another_size(self):
        write(self.path("lens.txt"), "1 PINHOLE 40 36 40 40 20 18\n")
        self.assertEqual(self.refused(), "--lens lens.txt: has no lens for 3 of 3 photographs: 0.png, 1.png, 2.png are "
                         "of 48 x 36 pixels: no lens has this size or this ratio of the sides")

    def test_options_of_programs(self):
        self.assertEqual(self.refused("--densify=--iterz 3"),
                         "--densify --iterz 3: command line: unrecognised option '--iterz'")
        self.assertIn("--mesh --smooth x: ", self.refused("--mesh=--smooth x"))
        self.assertIn("unrecognised option '--SiftMatching.nothing'",
                      self.refused("--matches=--SiftMatching.nothing 1"))
        self.assertIn("unrecognised option '--Mapper.nothing'", self.refused("--poses=--Mapper.nothing 1"))

    def test_names_and_unknowns(self):
        self.assertEqual(self.refused("--scale-from", "images:0.png,7.png,0.5"),
                         "--scale-from images:0.png,7.png,0.5: images has no photograph '7.png'")
        self.assertIn("'tilt' is not one of", self.refused("--refine", "tilt"))

    def test_files_of_others_in_the_output_folder(self):
        write(self.path("out", "scene.mvs"), "mine")
        self.assertIn("scene.mvs: no record of an earlier run", self.check("--check").stderr)
        self.assertEqual(read(self.path("out", "scene.mvs")), b"mine")


if __name__ == "__main__":
    main()
