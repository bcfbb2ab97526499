# SPDX-License-Identifier: GPL-3.0-or-later
"""A test gets the same scene whether it is rendered or copied from another test."""

import os
import subprocess
import unittest.mock

import scenes
from programs import BIN, ProgramTest, contents, main, new_folder, read, run, write

SCENE = ("--preset", "closeup", "--coarseness", "8", "--views", "2", "--width", "64", "--height", "48")


class SharedScenes(ProgramTest):
    def setUp(self):
        super().setUp()
        replaced = unittest.mock.patch.object(scenes, "SCENES", new_folder(self.addCleanup))
        replaced.start()
        self.addCleanup(replaced.stop)

    def simulate(self, name, *more):
        return run("SimulateUnderwater", *SCENE, *more, "-o", self.path(name))

    def test_a_copy_has_the_bytes_of_a_rendered_scene(self):
        subprocess.run([os.path.join(BIN, "SimulateUnderwater"), *SCENE, "-o", self.path("direct")],
                       check=True, capture_output=True)
        first = self.simulate("first")
        write(self.path("first", "housing.json"), "changed by a test")
        with unittest.mock.patch("subprocess.run", side_effect=AssertionError("rendered again")):
            second = self.simulate("second")
        self.assertEqual((first.returncode, first.stdout), (second.returncode, second.stdout))
        self.assertEqual(contents(self.path("second")), contents(self.path("direct")))

    def test_other_arguments_make_another_scene(self):
        self.simulate("one")
        self.simulate("two", "--seed", "2")
        self.assertNotEqual(contents(self.path("one")), contents(self.path("two")))

    def test_a_folder_is_made_again_for_other_words_and_other_programs(self):
        folders = []

        def make(folder):
            folders.append(folder)
            write(os.path.join(folder, "a.txt"), f"{len(folders)}")

        write(self.path("program"), "first")
        for words, count in ((("a", 1), 1), (("a", 1), 1), (("b",), 2), (("a", 1), 2)):
            target = self.path(f"target{len(os.listdir(self.folder))}")
            scenes.made(words, [self.path("program")], target, make)
            self.assertEqual(len(folders), count)
            self.assertEqual(read(os.path.join(target, "a.txt")), b"2" if words == ("b",) else b"1")
        write(self.path("program"), "second")
        scenes.made(("a", 1), [self.path("program")], self.path("last"), make)
        self.assertEqual(contents(self.path("last")), {"a.txt": b"3"})

    def test_a_failure_is_told_each_time(self):
        for _ in range(2):
            self.refuses("'none'", "SimulateUnderwater", "--preset", "none", "-o", self.path("none"))


if __name__ == "__main__":
    main()
