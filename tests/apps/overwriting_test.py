# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs told to overwrite their inputs refuse, and leave the inputs as they are."""

import os
import shutil

import tiny_scene
from programs import grey_png, main, read, write
from tiny_scene import TinyScene


class Overwriting(TinyScene):
    """An input is not overwritten under any of its names: its path, a symbolic or a hard link."""

    def names_of(self, path, link):
        os.symlink(path, link + ".soft" + os.path.splitext(path)[1])
        os.link(path, link + ".hard" + os.path.splitext(path)[1])
        return (path, link + ".soft" + os.path.splitext(path)[1],
                link + ".hard" + os.path.splitext(path)[1])

    def test_scene(self):
        for output in self.names_of(self.scene, self.path("other")):
            self.refuses_and_keeps(f"--output-file {output}: is ", *self.densify("-o", output))

    def test_photographs_beside_depth_maps(self):
        images = [self.path("work", f"depth{i:04d}.png") for i in range(3)]
        for source, image in zip(self.images, images):
            shutil.copyfile(source, image)
        write(self.scene, tiny_scene.mvs(images))
        self.refuses_and_keeps("--working-folder " + images[0] + ": is an input",
                               *self.densify("-v", "3"))
        before = [read(image) for image in images]
        self.succeeds(*self.densify("-v", "2"))  # draws nothing
        self.assertEqual([read(image) for image in images], before)

    def test_files_beside_the_reconstruction(self):
        mask = os.path.splitext(self.images[1])[0] + ".mask.png"
        write(mask, grey_png([bytes(96)] * 72))
        masked = ("--ignore-mask-label", "7")
        self.succeeds(*self.densify(*masked))
        taken = [self.images[0], mask, self.path("work", "depth0001.dmap"),
                 self.path("work", "depth0001.dmap.json"), self.path("work", "scene_dense.mvs"),
                 self.path("work", "scene_dense.ply")]
        for option in ("--report-file", "--output-view-neighbors-file"):
            for output in taken:
                self.refuses_and_keeps(f"{option} {output}: is ",
                                       *self.densify(*masked, option, output))
        # Paths of files that the run itself will write are refused, even if no file is there yet.
        os.remove(taken[2])
        os.remove(taken[5])
        for output in (taken[2], taken[5]):
            self.refuses_and_keeps(f"--report-file {output}: is ",
                                   *self.densify(*masked, "--report-file", output))
        for option in ("--report-file", "--output-view-neighbors-file"):
            self.succeeds(*self.densify(*masked, option, self.path("work", "beside")))

    def test_housing(self):
        text = '{"version": 1,\n "ports": {"main": {"type": "flat", "distance_m": 0.001, ' \
               '"thickness_m": 0.001, "normal": [0, 0, 1],\n "n_air": 1, "n_glass": 1.5, ' \
               '"n_water": 1.33}}, "default": "main"}'
        housing = self.path("work", "scene_dense.housing.json")
        write(housing, text)
        self.succeeds(*self.densify("--refractive", "--housing", housing))
        self.assertEqual(read(housing).decode(), text)
        other = self.path("work", "other.housing.json")
        self.succeeds(*self.densify("-o", self.path("work", "other.mvs"), "--housing", housing))
        self.assertIn(b"distance_m", read(other))
        for output in (self.path("work", "a.mvs"), self.path("work", "a.ply")):
            os.link(housing, output)
            self.refuses_and_keeps(f"{output}: is the input {housing}", *self.densify(
                "-o", self.path("work", "a.mvs"), "--housing", housing))
            os.remove(output)

    def test_models(self):
        sparse = self.path("colmap", "sparse")
        reference = self.path("reference")
        shutil.copytree(sparse, reference)
        os.symlink(sparse, self.path("link"))
        for output in (sparse, reference, self.path("link"), os.path.join(sparse, "..", "sparse")):
            self.refuses_and_keeps("--output-folder", "AlignModel", "-i", sparse, "--reference",
                                   reference, "-o", output)
        self.succeeds("AlignModel", "-i", sparse, "--reference", reference, "-o", self.path("new"))
        # A program that reads the folder would take the binary model.
        for part in ("cameras", "images", "points3D"):
            write(self.path("new", part + ".bin"), "of COLMAP")
        self.refuses_and_keeps("holds a binary model", "AlignModel", "-i", sparse, "--reference",
                               reference, "-o", self.path("new"))

    def test_evaluation(self):
        mesh, model = self.path("mesh.ply"), self.path("colmap", "sparse")
        write(mesh, "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n")
        cloud = self.path("cloud.ply")
        shutil.copyfile(mesh, cloud)
        given = ("EvaluateReconstruction", "-i", cloud, "-m", mesh, "--cameras", model)
        for option in ("--json", "--error-cloud", "--picture", "--aligned", "--transform-out"):
            for target in (cloud, mesh, os.path.join(model, "images.txt")):
                self.refuses_and_keeps(f"{option} {target}: is ", *given, option, target)

    def test_refined_poses(self):
        out, lens = self.path("out"), self.path("out", "sparse", "cameras.txt")
        housing = self.path("out", "housing.json")
        shutil.copytree(self.path("colmap", "sparse"), self.path("out", "sparse"))
        write(housing, '{"version": 1, "ports": {"main": {"type": "flat", "distance_m": 0.02, '
              '"thickness_m": 0.01, "normal": [0, 0, 1], "n_air": 1, "n_glass": 1.5, '
              '"n_water": 1.33}}, "default": "main"}')
        positions = self.path("out", "report.json")
        write(positions, "".join(f"{name} {x} {y} {z}\n" for name, (x, y, z) in zip(
            tiny_scene.names(), tiny_scene.CENTRES)))
        other_lens, other_housing = self.path("cameras.txt"), self.path("housing.json")
        shutil.copyfile(lens, other_lens)
        shutil.copyfile(housing, other_housing)
        for arguments in (("--lens", other_lens, "--housing", housing),
                          ("--lens", lens, "--housing", other_housing),
                          ("--lens", other_lens, "--housing", other_housing, "--scale-from",
                           "positions:" + positions)):
            self.refuses_and_keeps("--output-folder " + out, "RefinePoses", "-i",
                                   self.path("colmap"), *arguments, "-o", out)
        for part in ("cameras", "images", "points3D"):
            write(self.path("refined", "sparse", part + ".bin"), "of COLMAP")
        self.refuses_and_keeps("holds a binary model", "RefinePoses", "-i", self.path("colmap"),
                               "--lens", other_lens, "--housing", other_housing, "-o",
                               self.path("refined"))

    def test_calibration(self):
        lens, housing = self.path("colmap", "sparse", "cameras.txt"), self.path("housing.json")
        write(housing, '{"version": 1, "ports": {"main": {"type": "flat", "distance_m": 0.02, '
              '"thickness_m": 0.01, "normal": [0, 0, 1], "n_air": 1, "n_glass": 1.5, '
              '"n_water": 1.33}}, "default": "main"}')
        given = ("CalibrateHousing", "-i", self.path("colmap", "images"), "--lens", lens,
                 "--housing", housing, "--board", "checkerboard:9x6:0.03")
        for target in (lens, housing, self.images[1]):
            self.refuses_and_keeps(f"--output-file {target}: is ", *given, "-o", target)
            for option in ("--calibmar", "--report", "--coverage"):
                self.refuses_and_keeps(f"{option} {target}: is ", *given, "-o",
                                       self.path("new.json"), option, target)


if __name__ == "__main__":
    main()
