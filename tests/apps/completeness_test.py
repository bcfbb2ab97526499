# SPDX-License-Identifier: GPL-3.0-or-later
"""`ReproducePaper completeness` as users run it, on a small strip of images behind the port."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from programs import ProgramTest, main, read, run

PROGRAM = "ReproducePaper"
DOCUMENTS = pathlib.Path(__file__).resolve().parents[2] / "docs" / "paper" / "documents.py"
SCENE = ("--preset", "transect", "--scene-options",
         "--views 4 --width 256 --height 192 --coarseness 5 --samples 1")
NAME = "completeness_transect_water_true"


class Strip(unittest.TestCase):
    """All cases check the results of one run."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="axial_")
        cls.work = os.path.join(cls.temporary.name, "work")
        cls.output = os.path.join(cls.temporary.name, "results")
        cls.completeness()

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def completeness(cls, *more):
        result = run(PROGRAM, "completeness", *SCENE, "--seeds", "11", "-o", cls.output, "--work",
                     cls.work, *more)
        assert result.returncode == 0, result.stderr

    def results(self):
        content = json.loads(read(os.path.join(self.output, NAME + ".json")))
        return content["parts"]["seed11"]["result"]

    def test_the_table_is_printed_and_written(self):
        made = subprocess.run([sys.executable, "-B", DOCUMENTS, self.output, "--tables"], check=True,
                              capture_output=True, text=True)
        text = read(os.path.join(self.output, NAME + ".md")).decode()
        self.assertEqual(text, made.stdout)
        for title in ("seen by 2 [%]", "by 3 [%]", "F", "mean [mm]", "gross [%]", "density", "CPU [s]"):
            self.assertIn(title, text)
        rows = [line for line in text.splitlines() if line.startswith("|")]
        self.assertEqual([row.split("|")[1].strip() for row in rows],
                         ["seed", "---", "11", "median"])

    def test_most_of_the_ground_is_seen_by_two(self):
        by_views = {one["least"]: one["places"] for one in self.results()["by_views"]}
        self.assertGreater(by_views[2], 2 * by_views[3])
        self.assertGreater(self.results()["cpu_seconds"], 0)
        self.assertTrue(self.results()["strip"]["pieces"])

    def test_scenes_stay_and_other_options_are_measured_anew(self):
        before = self.results()
        scene = [name for name in os.listdir(self.work) if name.startswith("transect-11-")]
        self.assertEqual(len(scene), 1)
        image = os.path.join(self.work, scene[0], "water", "0000.jpg")
        time = os.stat(image).st_mtime_ns
        self.completeness("--dense-options", "--number-views-fuse 2")
        self.assertEqual(os.stat(image).st_mtime_ns, time)
        two = self.results()["by_views"][0]["recall"][0]
        self.completeness("--dense-options", "--number-views-fuse 3")
        self.assertGreater(two, self.results()["by_views"][0]["recall"][0] + 0.2)
        self.completeness()
        self.assertEqual(self.results(), before)


class WrongInput(ProgramTest):
    def test_is_refused(self):
        def refuses(said, *arguments):
            self.refuses(said, PROGRAM, "completeness", "-o", self.path("a"), *arguments)
        refuses("--medium ice: must be", "--medium", "ice")
        refuses("--poses mine: must be", "--poses", "mine")
        refuses("--seeds 1,x", "--seeds", "1,x")
        refuses("--seeds names 3 twice", "--seeds", "3,4,3")
        refuses("--tolerance -1: must be", "--tolerance", "-1")

    def test_options_of_its_own_are_without_effect_elsewhere(self):
        result = run(PROGRAM, "figure3", "--quick", "--medium", "air", "-o", self.path("a"))
        self.assertEqual(result.returncode, 0)
        self.assertIn("--medium: without effect", result.stdout + result.stderr)


main()
