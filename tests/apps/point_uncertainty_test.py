# SPDX-License-Identifier: GPL-3.0-or-later
"""`DensifyPointCloud --estimate-uncertainty`: each point gets an error and a confidence."""

import json

from openmvs_scene import Cloud, Scene
from programs import main, read


class Uncertainty(Scene):
    ON = ("--estimate-uncertainty", "1")

    def fused(self, folder, *arguments):
        self.fuse(folder, *arguments)
        return self.cloud(folder)

    def test_adds_two_properties_and_changes_nothing_else(self):
        for more in ((), ("--estimate-normals", "0"), ("--estimate-normals", "1"),
                     ("--output-precision", "float", "--crop-to-roi", "0")):
            with self.subTest(more=more):
                folder = self.copy("water", "_dense.ply")
                plain = self.fused(folder, *more)
                self.assertEqual(self.fused(folder, "--estimate-uncertainty", "0", *more), plain)
                self.assertNotIn(b"property float32 error", plain)
                told = self.fused(folder, *self.ON, "--max-threads", "1", *more)
                self.assertEqual(self.fused(folder, *self.ON, *more), told)
                without, points = Cloud(plain).points, Cloud(told).points
                self.assertEqual(len(points), len(without))
                for point, same in zip(points, without, strict=True):
                    error, confidence = point.pop("error")[0], point.pop("confidence")[0]
                    self.assertGreater(error, 0)
                    self.assertGreater(confidence, 0)
                    self.assertLessEqual(confidence, 1)
                    self.assertEqual(point, same)

    # Wide bounds: the errors were not fitted to maps like these, of one sweep and 160 x 120 pixels.
    def test_errors_are_those_that_the_truth_shows(self):
        for medium in self.MEDIA:
            with self.subTest(medium=medium):
                folder = self.copy(medium, "_dense.ply")
                self.fuse(folder, *self.ON)
                self.succeeds("EvaluateReconstruction", "-i", self.path(folder, "scene_dense.ply"),
                              "-m", self.path(self.truth, "mesh.ply"), "--samples", "2000",
                              "--json", self.path(folder, "result.json"))
                calibration = json.loads(read(self.path(folder, "result.json")))["calibration"]
                self.assertGreater(calibration["rms"], 0.5)
                self.assertLess(calibration["rms"], 2)
                self.assertGreater(calibration["within_1_2_3"][2], 0.93)

    def test_a_point_of_one_map_is_of_unknown_worth(self):
        folder = self.copy("air", "_dense.ply")
        points = Cloud(self.fused(folder, *self.ON, "--number-views-fuse", "1")).points
        self.assertTrue(points)
        for point in points:
            self.assertEqual((point["error"][0], point["confidence"][0]), (0, 0))


if __name__ == "__main__":
    main()
