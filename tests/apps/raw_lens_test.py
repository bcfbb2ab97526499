# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs of distorted lenses behind a flat port, matched as they are and undistorted: four views
of 512 x 384 of the close-up scene, on true poses."""

import json
import os
import tempfile

from programs import ProgramTest, files_below, main, read, run, write

# One pixel's width at the scene's depth: the median distance (0.7 m) over the focal length (305 px).
GSD = 0.7 / 305
QUICK = ("--resolution-level", "1", "--min-resolution", "200")


class LensTest(ProgramTest):
    LENS = None  # --lens of the simulator

    @classmethod
    def setUpClass(cls):
        if cls.LENS is None:
            return
        cls.shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.truth = os.path.join(cls.shared.name, "closeup")
        made = run("SimulateUnderwater", "--preset", "closeup", "--views", 4, "--width", 512,
                   "--height", 384, "--seed", 1, "--samples", 2, "--medium", "water", "--truth", 0,
                   "--lens", cls.LENS, "-o", cls.truth)
        assert made.returncode == 0, made.stderr
        cls.housing = os.path.join(cls.truth, "housing.json")

    def import_scene(self, folder, *arguments):
        return self.succeeds("InterfaceCOLMAP", "-i", self.truth, "--image-folder",
                             os.path.join(self.truth, "water"), "-o",
                             self.path(folder, "scene.mvs"), *arguments).stdout

    def densify(self, folder, *arguments):
        return self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(folder),
                             *arguments).stdout

    def evaluate(self, folder):
        self.succeeds("EvaluateReconstruction", "-i", self.path(folder, "scene_dense.ply"), "-m",
                      os.path.join(self.truth, "mesh.ply"), "--cameras",
                      os.path.join(self.truth, "sparse"), "--housing", self.housing, "--tolerance",
                      "0.002", "--json", self.path(folder, "evaluation.json"))
        result = json.loads(read(self.path(folder, "evaluation.json")))
        mean, recall = result["accuracy"]["mean"] / GSD, result["scores"][0]["recall"]
        print(f"measured: {self.LENS.split(',')[0]} {folder} mean {mean:.4f} GSD, "
              f"recall {recall:.3f}")
        return mean, recall

    def check_raw_is_as_good(self):
        self.import_scene("raw", "--housing", self.housing)
        self.import_scene("undistorted", "--housing", self.housing, "--undistort", "1")
        self.assertNotIn("undistorted/0000.jpg", files_below(self.path("raw")))
        self.assertNotIn("scene.lenses.json", files_below(self.path("undistorted")))
        for folder in ("raw", "undistorted"):
            self.densify(folder, "--refractive", "--resolution-level", "0")
        mean, recall = self.evaluate("raw")
        mean_undistorted, recall_undistorted = self.evaluate("undistorted")
        self.assertLessEqual(mean, mean_undistorted)
        self.assertGreaterEqual(recall, recall_undistorted)
        self.assertLess(mean, 0.4)  # as the end-to-end test of straight lenses asks


class OpencvLens(LensTest):
    LENS = "OPENCV,-0.12,0.02,0.001,-0.0005"

    def test_raw_images_give_as_good_a_cloud(self):
        self.check_raw_is_as_good()

    def test_lenses_are_kept_and_obeyed(self):
        self.import_scene("scene", "--housing", self.housing)
        self.assertIn("4 images have distorted lenses", self.densify("scene", "--refractive", *QUICK))
        obeyed, _ = self.evaluate("scene")
        # The dense scene has the lenses, too: its maps are those that are there.
        self.assertEqual(read(self.path("scene", "scene_dense.lenses.json")),
                         read(self.path("scene", "scene.lenses.json")))
        again = self.succeeds("DensifyPointCloud", "-i", "scene_dense.mvs", "-w",
                              self.path("scene"), "--refractive", *QUICK).stdout
        self.assertIn("All 4 depth maps are there already", again)
        # Without them: the corners are 30 pixels off.
        os.remove(self.path("scene", "scene.lenses.json"))
        ignored = self.densify("scene", "--refractive", *QUICK)
        self.assertNotIn("there already", ignored, "maps of another lens were taken over")
        self.assertNotIn("scene_dense.lenses.json", files_below(self.path("scene")))
        self.assertGreater(self.evaluate("scene")[0], 3 * obeyed)

    def test_the_same_bytes_for_any_number_of_threads(self):
        for threads in ("1", "2"):
            self.import_scene(threads, "--housing", self.housing)
            self.densify(threads, "--refractive", "--max-threads", threads, *QUICK)
        for name in ("scene_dense.ply", "depth0002.dmap"):
            self.assertEqual(read(self.path("1", name)), read(self.path("2", name)))

    def test_images_in_air_are_undistorted_unless_told_otherwise(self):
        self.import_scene("air", "--undistort", "0")
        self.assertIn("scene.lenses.json", files_below(self.path("air")))
        self.import_scene("air")
        self.assertIn("undistorted/0000.jpg", files_below(self.path("air")))
        self.assertNotIn("scene.lenses.json", files_below(self.path("air")))

    def test_what_cannot_be_done_is_said(self):
        self.import_scene("wrong", "--housing", self.housing)
        for option in (("--projection", "line-search"), ("--warp", "homography")):
            self.refuses("--undistort 1", "DensifyPointCloud", "-i", "scene.mvs", "-w",
                         self.path("wrong"), "--refractive", *option, *QUICK)
        write(self.path("wrong", "scene.lenses.json"), '{ "version": 1 }\n')
        self.refuses("scene.lenses.json", "DensifyPointCloud", "-i", "scene.mvs", "-w",
                     self.path("wrong"), "--refractive", *QUICK)
        for lens, reason in (("OPENCV,1", "must have 4 coefficients"),
                             ("PINHOLE,1,2,3,4", "must begin with OPENCV"),
                             ("OPENCV,0,0,0,x", "'x' is no number"),
                             ("OPENCV,-0.5,0,0,0", "images nothing at pixel")):
            self.refuses(reason, "SimulateUnderwater", "--lens", lens, "-o", self.path("none"))


class FisheyeLens(LensTest):
    LENS = "OPENCV_FISHEYE,0.02,-0.01,0.002,0"

    def test_raw_images_give_as_good_a_cloud(self):
        self.check_raw_is_as_good()


if __name__ == "__main__":
    main()
