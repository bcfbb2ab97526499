# SPDX-License-Identifier: GPL-3.0-or-later
"""A test gets the same scene whether it is rendered or copied from another test."""

import os
import subprocess
import tempfile
import unittest.mock

import scenes
from programs import BIN, ProgramTest, files_below, main, read, run, write

SCENE = ("--preset", "closeup", "--coarseness", "8", "--views", "2", "--width", "64", "--height", "48")


class SharedScenes(ProgramTest):
    def setUp(self):
        super().setUp()
        kept = tempfile.TemporaryDirectory(prefix="axial_")
        self.addCleanup(kept.cleanup)
        replaced = unittest.mock.patch.object(scenes, "SCENES", kept.name)
        replaced.start()
        self.addCleanup(replaced.stop)

    def simulate(self, name, *more):
        return run("SimulateUnderwater", *SCENE, *more, "-o", self.path(name))

    def content(self, name):
        return {file: read(self.path(name, file)) for file in files_below(self.path(name))}

    def test_a_copy_has_the_bytes_of_a_rendered_scene(self):
        subprocess.run([os.path.join(BIN, "SimulateUnderwater"), *SCENE, "-o", self.path("direct")],
                       check=True, capture_output=True)
        first = self.simulate("first")
        write(self.path("first", "housing.json"), "changed by a test")
        with unittest.mock.patch("subprocess.run", side_effect=AssertionError("rendered again")):
            second = self.simulate("second")
        self.assertEqual((first.returncode, first.stdout), (second.returncode, second.stdout))
        self.assertEqual(self.content("second"), self.content("direct"))

    def test_other_arguments_make_another_scene(self):
        self.simulate("one")
        self.simulate("two", "--seed", "2")
        self.assertNotEqual(self.content("one"), self.content("two"))

    def test_a_failure_is_told_each_time(self):
        for _ in range(2):
            self.refuses("'none'", "SimulateUnderwater", "--preset", "none", "-o", self.path("none"))


if __name__ == "__main__":
    main()
