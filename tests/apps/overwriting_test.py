# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs told to overwrite their inputs refuse, and leave the inputs as they are."""

import os
import shutil

import tiny_scene
from every_program_test import Programs
from programs import main, png, read, write
from worlds import TRIANGLE, housing

MODEL = ("cameras", "images", "points3D")


class Overwriting(Programs):
    """An input is not overwritten under any of its names: its path, a symbolic or a hard link."""

    def test_names_that_follow_from_that_of_the_output(self):
        """An input in the folder of the scene has the name of a file that the program would write."""
        compare = ("CompareSurveys", "-w", self.work, "-o", "reef", "-i", "mesh.ply", "--other")
        densify, export = self.densify(), ("--output-view-neighbors-file", "given.ply")
        write(self.path("work", "pairs.txt"), "0 1\n")
        write(self.path("work", "dense.ini"), "Min Views = 2\n")
        for given, name, *command in (
                ("mesh.ply", "mesh.dem.tif", *self.program("MapSurface", "-o", "mesh", mesh="mesh.dem.tif")),
                ("mesh.ply", "reef.change.difference.tif", *compare, "reef.change.difference.tif"),
                ("scene.mvs", "reef.change.json", *compare, "mesh.ply", "--scene", "reef.change.json"),
                ("scene.mvs", "reef.change.json", *compare, "mesh.ply", "--other-scene", "reef.change.json"),
                ("mesh.ply", "scene_texture.ply", *self.program("TextureMesh", mesh="scene_texture.ply")),
                ("mesh.ply", "out.tile2-3.ply",
                 *self.program("TextureMesh", "-o", "out", "--tiles", "3", mesh="out.tile2-3.ply")),
                (self.images[0], "out0.png", *self.program("TextureMesh", "-o", "out")),
                ("mesh.ply", "fine.ply", *self.program("RefineMesh", "-o", "fine.ply", mesh="fine.ply")),
                ("scene.ply", "dense.ply", *self.program("ReconstructMesh", "-p", "dense.ply", "-o", "dense.ply",
                                                         mesh=None)),
                ("scene.ply", "moved.ply", *self.program("TransformScene", "-t", "t.txt", "-p", "moved.ply", "-o",
                                                         "moved.mvs")),
                ("scene.ply", "given.ply", *densify, "-p", "given.ply", "-o", "given.mvs"),
                ("scene.ply", "given.ply", *densify, "-p", "given.ply", *export),
                ("scene.ply", "x_filtered.ply", *densify, "-p", "x_filtered.ply", "-o", "x.mvs", "--filter-point-cloud",
                 "-1"),
                ("pairs.txt", "list.mvs", *densify, "--view-neighbors-file", "list.mvs", "-o", "list.mvs"),
                ("dense.ini", "config.mvs", *densify, "--dense-config-file", "config.mvs", "-o", "config.mvs")):
            os.link(self.path("work", given), self.path("work", name))
            option = export[0] if command[-2:] == list(export) else "--output-file"
            with self.subTest(command=command):
                self.refuses_and_keeps(option, *command)
            os.remove(self.path("work", name))

    def test_what_belongs_to_a_scene_is_never_an_output(self):
        sides = ("scene.housing.json", "scene.lenses.json", "scene.geo.json")
        for name in (*sides, "depth0001.dmap"):
            shutil.copyfile(self.cloud, self.path("work", name))
        move = self.program("TransformScene", "-t", "t.txt", "--transform-out")
        for name in sides:
            self.refuses_and_keeps(name + ": is ", *move, name)
            os.remove(self.path("work", name))
        for name in ("scene.ply", "depth0001.dmap", self.images[1]):
            self.refuses_and_keeps(name + ": is ", *move, name)
        for program in ("ReconstructMesh", "RefineMesh", "TextureMesh"):
            self.refuses_and_keeps("scene.ply: is ", *self.program(program, "-o", "scene.ply"))

    def test_an_import(self):
        """The files of the model, the photographs, and the housing that lies beside the scene."""
        sparse, port = self.path("colmap", "sparse"), self.path("lake.housing.json")
        write(port, housing())
        command = ("InterfaceCOLMAP", "-i", self.path("colmap"), "--housing", port)
        self.refuses_targets(command, ("--output-file",), (
            *(os.path.join(sparse, name + ".txt") for name in MODEL), self.images[0]))
        self.refuses_and_keeps(f"--output-file {port}: is ", *command, "-o", self.path("lake.mvs"))

    def refuses_targets(self, command, options, targets):
        self.refuses_each(command, *((f"{option} {target}: is ", option, target)
                                     for option in options for target in targets))

    def test_scene(self):
        links = [self.path(f"other.{kind}.mvs") for kind in ("soft", "hard")]
        os.symlink(self.scene, links[0])
        os.link(self.scene, links[1])
        for output in (self.scene, *links):
            self.refuses_and_keeps(f"--output-file {output}: is ", *self.densify("-o", output))

    def test_photographs_beside_depth_maps(self):
        images = [self.path("work", f"depth{i:04d}.png") for i in range(3)]
        for source, image in zip(self.images, images):
            shutil.copyfile(source, image)
        write(self.scene, tiny_scene.mvs(images))
        self.refuses_and_keeps("--working-folder " + images[0] + ": is an input", *self.densify("-v", "3"))
        before = [read(image) for image in images]
        self.succeeds(*self.densify("-v", "2"))  # draws nothing
        self.assertEqual([read(image) for image in images], before)

    def test_files_beside_the_reconstruction(self):
        mask = os.path.splitext(self.images[1])[0] + ".mask.png"
        write(mask, png([bytes(96)] * 72))
        masked = self.densify("--ignore-mask-label", "7")
        self.succeeds(*masked)
        options = ("--report-file", "--output-view-neighbors-file")
        depth, cloud = self.path("work", "depth0001.dmap"), self.path("work", "scene_dense.ply")
        self.refuses_targets(masked, options, (self.images[0], mask, depth, depth + ".json", cloud,
                                               self.path("work", "scene_dense.mvs")))
        # Paths of files that the run itself will write are refused, even if no file is there yet.
        os.remove(depth)
        os.remove(cloud)
        self.refuses_targets(masked, options[:1], (depth, cloud))
        for option in options:
            self.succeeds(*masked, option, self.path("work", "beside"))

    def test_housing(self):
        given = self.path("work", "scene_dense.housing.json")
        write(given, housing())
        self.succeeds(*self.densify("--refractive", "--housing", given))
        self.assertEqual(read(given).decode(), housing())
        self.succeeds(*self.densify("-o", self.path("work", "other.mvs"), "--housing", given))
        self.assertIn(b"distance_m", self.at("other.housing.json"))
        for output in (self.path("work", "a.mvs"), self.path("work", "a.ply")):
            os.link(given, output)
            self.refuses_and_keeps(f"{output}: is the input {given}", *self.densify(
                "-o", self.path("work", "a.mvs"), "--housing", given))
            os.remove(output)

    def put_binary_model(self, folder):
        """A program that reads the folder would take the binary model."""
        for part in MODEL:
            write(os.path.join(folder, part + ".bin"), "of COLMAP")

    def test_models(self):
        sparse, reference = self.path("colmap", "sparse"), self.path("reference")
        shutil.copytree(sparse, reference)
        os.symlink(sparse, self.path("link"))
        align = ("AlignModel", "-i", sparse, "--reference", reference, "-o")
        for output in (sparse, reference, self.path("link"), os.path.join(sparse, "..", "sparse")):
            self.refuses_and_keeps("--output-folder", *align, output)
        self.succeeds(*align, self.path("new"))
        self.put_binary_model(self.path("new"))
        self.refuses_and_keeps("holds a binary model", *align, self.path("new"))

    def test_evaluation(self):
        mesh, cloud, model = self.path("mesh.ply"), self.path("cloud.ply"), self.path("colmap", "sparse")
        for path in (mesh, cloud):
            write(path, TRIANGLE)
        self.refuses_targets(("EvaluateReconstruction", "-i", cloud, "-m", mesh, "--cameras", model),
                             ("--json", "--error-cloud", "--picture", "--aligned", "--transform-out"),
                             (cloud, mesh, os.path.join(model, "images.txt")))

    def test_refined_poses(self):
        out, lens = self.path("out"), self.path("out", "sparse", "cameras.txt")
        port, positions = self.path("out", "housing.json"), self.path("out", "report.json")
        shutil.copytree(self.path("colmap", "sparse"), self.path("out", "sparse"))
        write(port, housing())
        write(positions, "".join(f"{name} {x} {y} {z}\n" for name, (x, y, z) in zip(
            tiny_scene.names(), tiny_scene.CENTRES)))
        other_lens, other_port = self.path("cameras.txt"), self.path("housing.json")
        shutil.copyfile(lens, other_lens)
        shutil.copyfile(port, other_port)
        refine = ("RefinePoses", "-i", self.path("colmap"), "--lens")
        for arguments in ((other_lens, "--housing", port), (lens, "--housing", other_port),
                          (other_lens, "--housing", other_port, "--scale-from", "positions:" + positions)):
            self.refuses_and_keeps("--output-folder " + out, *refine, *arguments, "-o", out)
        self.put_binary_model(self.path("refined", "sparse"))
        self.refuses_and_keeps("holds a binary model", *refine, other_lens, "--housing", other_port, "-o",
                               self.path("refined"))

    def test_calibration(self):
        lens, port = self.path("colmap", "sparse", "cameras.txt"), self.path("housing.json")
        write(port, housing())
        given = ("CalibrateHousing", "-i", self.path("colmap", "images"), "--lens", lens, "--housing", port, "--board",
                 "checkerboard:9x6:0.03")
        targets = (lens, port, self.images[1])
        for target in targets:
            self.refuses_and_keeps(f"--output-file {target}: is ", *given, "-o", target)
        self.refuses_targets((*given, "-o", self.path("new.json")), ("--calibmar", "--report", "--coverage"), targets)


if __name__ == "__main__":
    main()
