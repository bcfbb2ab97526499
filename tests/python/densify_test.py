# SPDX-License-Identifier: GPL-3.0-or-later
"""densify() of the Python package: the bytes of the program, scenes in memory, progress, stops and errors."""

import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np
import small_dive

import axialmvs

from programs import contents, must  # small_dive has the folder in sys.path

QUICK = {"resolution_level": 0, "iterations": 1, "geometric_iterations": 1, "max_threads": 2}


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(os.path.realpath(folder.name))


class OfFiles(InFolder):
    def test_writes_the_bytes_of_the_program(self):
        scene = small_dive.write_files(self.folder)
        before = contents(self.folder)
        must("DensifyPointCloud", "-i", scene, "-w", self.folder, "--resolution-level", 0, "--iters", 1,
             "--geometric-iters", 1, "--max-threads", 2, "--estimate-uncertainty", 1)
        expected = contents(self.folder)
        for name in expected.keys() - before.keys():
            (self.folder / name).unlink()
        result = axialmvs.densify(scene, errors=True, **QUICK)
        found = contents(self.folder)
        self.assertEqual({name for name in expected if found.get(name) != expected[name]}, set())
        self.assertEqual(found.keys(), expected.keys())
        self.assertEqual(result.cloud_file, self.folder / "scene_dense.ply")
        self.assertEqual((result.depth_maps, len(result.cloud.positions)), (6, result.points))
        self.assertFalse(result.only_pinholes)
        self.check_cloud(result.cloud)

    def check_cloud(self, cloud):
        # The ground is 1.5 m away, where a pixel is 9 mm wide. Matching finds a tenth of a pixel.
        self.assertLess(np.abs(cloud.positions[:, 2] - small_dive.GROUND).mean(), 0.005)
        self.assertGreater(len(cloud.positions), 10000)
        self.assertGreater((-cloud.normals[:, 2]).mean(), 0.9)
        self.assertEqual(len(cloud.view_images), cloud.view_begin[-1])
        self.assertGreater(cloud.errors.min(), 0)


class InMemory(InFolder):
    def run_quick(self, **more):
        dive = small_dive.scene()
        photograph = lambda image: small_dive.photograph(dive.images[image])
        return axialmvs.densify(dive, photographs=photograph, **QUICK | more)

    def test_gives_cloud_and_maps_and_keeps_no_file(self):
        maps, said = {}, []
        self.addCleanup(os.environ.__setitem__, "TMPDIR", os.environ.get("TMPDIR", "/tmp"))
        os.environ["TMPDIR"] = str(self.folder)
        result = self.run_quick(take_map=maps.__setitem__, progress=lambda *event: said.append(event))
        self.assertEqual(list(self.folder.iterdir()), [])
        self.assertIsNone(result.cloud_file)
        self.assertEqual(len(result.cloud.positions), result.points)
        self.assertLess(np.abs(result.cloud.positions[:, 2] - small_dive.GROUND).mean(), 0.005)
        self.assertEqual(sorted(maps), list(range(6)))
        ground = maps[0].points()
        self.assertLess(np.abs(ground[:, 2] - small_dive.GROUND).mean(), 0.005)
        self.assertIn(("Estimated depth maps", 6, 6), said)

    def test_a_function_that_returns_false_stops(self):
        with self.assertRaises(axialmvs.Stopped):
            self.run_quick(progress=lambda title, done, total: not (title == "Estimated depth maps" and done > 0))

    def test_exceptions_of_functions_are_passed_on(self):
        def broken(*_):
            raise LookupError("mine")

        for more in ({"progress": broken}, {"take_map": broken}, {"photographs": broken}):
            with self.assertRaisesRegex(LookupError, "mine"):
                axialmvs.densify(small_dive.scene(), **{"photographs": PIXELS} | QUICK | more)

    def test_a_photograph_of_another_shape_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "photograph: has the shape"):
            axialmvs.densify(small_dive.scene(), photographs=[np.zeros((120, 160), np.uint8)] * 6, **QUICK)
        with self.assertRaisesRegex(axialmvs.Error, "160 x 120 pixels"):
            axialmvs.densify(small_dive.scene(), photographs=[np.zeros((12, 16, 3), np.uint8)] * 6, **QUICK)


PIXELS = small_dive.photographs()


class Interrupts(unittest.TestCase):
    def test_a_keyboard_interrupt_stops_within_two_seconds(self):
        timers, asked = [], []

        def interrupt():
            asked.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        def progress(title, done, total):
            if title == "Estimated depth maps" and not timers:  # one interrupt: events may come together
                timers.append(threading.Timer(0, interrupt))
                timers[0].start()

        with self.assertRaises(KeyboardInterrupt):
            axialmvs.densify(small_dive.scene(), photographs=PIXELS, progress=progress, **QUICK | {"iterations": 20})
        self.assertLess(time.monotonic() - asked[0], 2)


class WrongArguments(InFolder):
    def test_an_unknown_keyword_is_named(self):
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'iters'"):
            axialmvs.densify("scene.mvs", iters=3)

    def test_wrong_values_are_named_with_their_setting(self):
        for setting, value in (("iterations", 0), ("resolution_level", 17), ("depth_threshold", 2), ("ports", "'dome'"),
                               ("min_views", -1), ("region", "'wide'"), ("bit_depth", 7)):
            with self.assertRaises(axialmvs.Error) as raised:
                axialmvs.densify("scene.mvs", **{setting: value.strip("'") if isinstance(value, str) else value})
            self.assertEqual(raised.exception.setting, setting, raised.exception)
            self.assertIn(f"{setting} {value}: must be", str(raised.exception))

    def test_keywords_of_files_are_refused_for_a_scene_in_memory(self):
        for name, value in (("ports", "ignored"), ("housing", "h.json"), ("errors", True)):
            with self.assertRaisesRegex(axialmvs.Error, f"{name}: is only for a scene in a file"):
                axialmvs.densify(small_dive.scene(), photographs=PIXELS, **{name: value})

    def test_photographs_of_16_bits_are_refused(self):
        with self.assertRaisesRegex(ValueError, "photograph: has the number 256, but must have numbers from 0 to 255"):
            axialmvs.densify(small_dive.scene(), photographs=[np.full((120, 160, 3), 256, np.uint16)] * 6, **QUICK)

    def test_values_of_another_type_are_refused(self):
        for name, value in (("iterations", 2.0), ("iterations", "2"), ("iterations", True), ("fuse", 1),
                            ("depth_threshold", "0.1"), ("mask_folder", 3), ("progress", 3), ("photographs", 3)):
            with self.assertRaisesRegex(TypeError, name):
                axialmvs.densify(small_dive.scene(), **{"photographs": PIXELS} | {name: value})

    def test_settings_of_the_library_have_the_names_of_keywords(self):
        for setting, options in (("tiles", {"fuse": False, "tiles": 2}), ("match_colors", {"match_colors": True})):
            with self.assertRaises(axialmvs.Error) as raised:
                axialmvs.densify("scene.mvs", **options)
            self.assertEqual(raised.exception.setting, setting)

    def test_a_missing_scene_is_named(self):
        with self.assertRaises(axialmvs.Error) as raised:
            axialmvs.densify(self.folder / "none.mvs")
        self.assertEqual(raised.exception.file, str(self.folder / "none.mvs"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
