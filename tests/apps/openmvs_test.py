# SPDX-License-Identifier: GPL-3.0-or-later
"""As OpenMVS's users run the programs: options of DensifyPointCloud that scripts written for OpenMVS use, and the
whole chain from a scene of OpenMVS to a textured mesh."""

import json
import os
import re
import struct
import unittest

from programs import ProgramTest, cloud_size, files_below, main, read, run, write
from readers import Dmap, Glb, Mvs, Ply, png_samples
from worlds import Densified, cloud, dmap_names, ply


class Options(Densified):
    def same_cloud(self, folder, *arguments):
        """Runs DensifyPointCloud with these options, which must not change the cloud. Returns its output."""
        said = self.said(folder, *arguments)
        self.assertEqual(self.cloud(folder), self.whole("air"))
        return said

    def sparse(self, folder):
        self.said(folder, "--fusion-mode", "1", "-o", "sparse.mvs")
        return Ply(read(os.path.join(folder, "sparse.ply")))

    def test_values_without_effect_are_named(self):
        folder = self.copy("air")
        for option, values in (("--tower-mode", (4, 3, 2, 1, -1)), ("--filter-point-cloud", (1,)),
                               ("--archive-type", (0, 2, 3))):
            for value in values:
                said = self.same_cloud(folder, option, value)
                self.assertEqual(said.count(f"{option} {value}: "), 1, said)
        said = self.same_cloud(folder)
        for option in ("--tower-mode", "--filter-point-cloud", "--archive-type"):
            self.assertNotIn(option, said)
        self.refuses("--archive-type 7", *self.command(folder, "--archive-type", "7"))
        self.refuses("--no-option-of-2-4", *self.command(folder, "--no-option-of-2-4", "1"))

    def test_the_output_s_folder_is_made(self):
        folder = self.copy("air")
        self.said(folder, "-o", "new/folders/result.mvs")
        self.assertEqual(read(os.path.join(folder, "new", "folders", "result.ply")),
                         self.whole("air"))

    def test_dense_config_file(self):
        folder = self.copy("air")
        file = os.path.join(folder, "Densify.ini")
        config = ("--dense-config-file", "Densify.ini")
        self.assertIn("did not exist", self.same_cloud(folder, *config))
        self.assertIn("Depth Diff Threshold = 0.005", read(file).decode())
        self.assertIn("All 5 depth maps exist already", self.same_cloud(folder, *config))

        # As in OpenMVS, options take precedence over the first two titles. Random Iters has no
        # effect here, and the last two titles are unknown.
        write(file, "[Densify]\n# of 2.3\nEstimation Iters = 9\nMin Views Fuse = 5\n"
                    "Random Iters = 6\nDepth Dif Threshold = 1\nNo Such = 2\n")
        said = self.same_cloud(folder, *config)
        for line in ("unknown settings, ignored: Depth Dif Threshold, No Such\n",
                     "without effect here: Random Iters\n", "Estimation Iters, Min Views Fuse\n"):
            self.assertEqual(said.count(line), 1, said)

        whole = cloud_size(self.cloud(folder))
        write(file, "Depth Diff Threshold = 0.00001\n")
        said = self.said(folder, *config)
        self.assertIn("All 5 depth maps exist already", said)
        self.assertLess(cloud_size(self.cloud(folder)), 0.7 * whole)

        write(file, "NCC Threshold Keep = 0.05\n")
        said = self.said(folder, *config)
        self.assertNotRegex(said, "exist(ed)? already")
        self.assertLess(cloud_size(self.cloud(folder)), 0.9 * whole)

        self.refuses_contents(file, self.command(folder, *config), ("line 2", "\nMax Views\n"),
                              ("many", "\nMax Views = many\n"), ("Max Views", "\nMax Views = -1\n"))

    def test_a_cloud_in_place_of_the_sparse_points(self):
        folder = self.copy("air")
        self.sparse(folder)
        said = self.same_cloud(folder, "-p", "sparse.ply")
        self.assertIn("All 5 depth maps exist already", said)
        self.refuses_contents(os.path.join(folder, "other.ply"), self.command(folder, "-p", "other.ply"),
                              ("view_indices", ply([(0, 0, 1)])), ("image 5", cloud([((0, 0, 1), [0, 5])])),
                              ("other.ply", cloud([((0, 0, "nan"), [0, 1])])))

    def test_view_neighbours(self):
        folder = self.copy("air", "_dense.ply")
        said = self.said(folder, "--output-view-neighbors-file", "views.txt")
        lines = [list(map(int, line.split()))
                 for line in read(os.path.join(folder, "views.txt")).decode().splitlines()]
        self.assertEqual([line[0] for line in lines], list(range(self.VIEWS)), said)
        for image, *neighbours in lines:
            self.assertEqual(sorted([image, *neighbours]), list(range(self.VIEWS)))
        self.assertNotIn("scene_dense.ply", files_below(folder))

        pairs = {0: [3], 1: [4, 0], 4: [2]}
        write(os.path.join(folder, "views.txt"), "# pairs\n" + "".join(
            f"{image} {' '.join(map(str, others))}\n" for image, others in pairs.items()))
        self.said(folder, "--view-neighbors-file", "views.txt",
                                    "--fusion-mode", "1")
        for image, name in enumerate(dmap_names()):
            ids = Dmap(read(os.path.join(folder, name))).ids
            if image in pairs:
                self.assertEqual(ids, (image, *pairs[image]))
            else:
                self.assertEqual(len(ids), self.VIEWS)

        self.refuses_contents(
            os.path.join(folder, "views.txt"), self.command(folder, "--view-neighbors-file", "views.txt"),
            ("line 1: '9'", "0 9\n"), ("'x'", "0 x\n"), ("image 0", "0\n"), ("its own", "0 0\n"),
            ("line 2", "0 1\n0 2\n"))

    def test_points_with_many_views(self):
        folder = self.copy("air")
        sparse = self.sparse(folder)
        for least, with_scene in ((3, False), (-4, True)):
            self.said(folder, "--export-number-views", least)
            name = os.path.join(folder, f"scene_dense_{abs(least)}views")
            expected = [place for place, point in zip(sparse.points, sparse.vertices)
                        if len(set(point["view_indices"])) >= abs(least)]
            self.assertGreater(len(expected), 10)
            self.assertLess(len(expected), len(sparse.points))
            self.assertEqual(Ply(read(name + ".ply")).points, expected)
            self.assertEqual(os.path.exists(name + ".mvs"), with_scene)

    def test_scales_of_points(self):
        folder = self.copy("air")
        sparse = self.sparse(folder)
        cameras = [Dmap(read(os.path.join(folder, name))).camera for name in dmap_names()]
        self.said(folder, "--estimate-scale", "2.5")
        found = Ply(read(os.path.join(folder, "scene_dense_scale.ply")))
        for point, known, place in zip(found.vertices, sparse.vertices, sparse.points, strict=True):
            widths = []
            for view in known["view_indices"]:
                focal, R, C = cameras[view][0] * 2, cameras[view][9:18], cameras[view][18:]
                z = sum(r * (x - c) for r, x, c in zip(R[6:], place, C))
                widths.append(z / focal)
            self.assertAlmostEqual(point["value"][0], 2.5 * sum(widths) / len(widths), 5)
            self.assertEqual(point["confidence"][0], len(widths))

    def test_points_that_others_see_through_are_filtered(self):
        folder = self.copy("air")
        dense = Ply(self.cloud(folder))
        centre = Dmap(read(os.path.join(folder, "depth0000.dmap"))).camera[18:]
        surface = [(xyz, point["view_indices"]) for xyz, point in zip(dense.points, dense.vertices)][::7]
        seen = [xyz for xyz, views in surface if 0 in views][:100]
        self.assertGreater(len(seen), 50)
        floating = [(tuple((a + b) / 2 for a, b in zip(xyz, centre)), [0]) for xyz in seen]
        write(os.path.join(folder, "points.ply"), cloud(surface + floating))
        self.said(folder, "-p", "points.ply", "--filter-point-cloud", "-1")
        self.assertIn("scene_dense_filtered.mvs", os.listdir(folder))
        single = lambda xyz: struct.pack("<3f", *xyz)
        kept = {single(xyz) for xyz in Ply(read(os.path.join(folder, "scene_dense_filtered.ply"))).points}
        self.assertFalse(kept & {single(xyz) for xyz, _ in floating})
        self.assertGreater(len(kept), 0.9 * len(surface))

    def test_log_file(self):
        folder = self.copy("air")
        said = self.said(folder, "--log-file", "run.log")
        wrong = ("--log-file", "run.log", "-p", "no-such.ply")
        error = self.refuses("no-such.ply", *self.command(folder, *wrong)).stderr
        log = read(os.path.join(folder, "run.log")).decode()
        for line in said.splitlines() + [error.strip().replace("DensifyPointCloud: ", "] ")]:
            self.assertIn(line.split("] ", 1)[1], log)
        self.refuses("no/log", *self.command(folder, "--log-file", "/proc/no/log"))
        scene = read(self.path(folder, "scene.mvs"))
        self.refuses("is not a log file", *self.command(folder, "--log-file", "scene.mvs"))
        self.assertEqual(read(self.path(folder, "scene.mvs")), scene)
        for program in ("InterfaceCOLMAP", "SimulateUnderwater", "EvaluateReconstruction"):
            self.assertIn("--log-file", run(program, "--help").stdout)

    def test_normalised_intrinsics(self):
        folder = self.copy("air")
        self.imported(os.path.join(folder, "scene.mvs"), "air", "--normalize", "1")
        cameras, _ = Mvs(read(os.path.join(folder, "scene.mvs"))).platforms[0]
        size, k = cameras[0]
        self.assertEqual(size, (0, 0))
        lens = [float(x) for x in read(os.path.join(self.truth, "sparse", "cameras.txt")).decode()
                .splitlines()[-1].split()[4:]]
        for found, pixels in ((k[0], lens[0]), (k[4], lens[1]), (k[2] + 0.5, lens[2]),
                              (k[5] + 0.5, lens[3])):
            self.assertAlmostEqual(found, pixels / 320, 9)
        self.assertIn("stored without a resolution", self.said(folder))
        self.assertAlmostEqual(cloud_size(self.cloud(folder)) / cloud_size(self.whole("air")), 1, 1)


DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[".."] * 3, "shared", "data",
                    "openmvs-files")


@unittest.skipUnless(os.path.exists(os.path.join(DATA, "scene_v6.mvs")), "no scene_v6.mvs here")
class Chain(ProgramTest):
    """Four photographs of 640 x 479 pixels, matched and refined at half of this size."""

    def step(self, *command):
        return self.succeeds(*command, "-w", self.folder).stdout

    def median_distance(self, mesh):
        """Of the sparse points, which other software found, to the mesh."""
        points = Mvs(read(self.path("scene_dense.mvs"))).points
        write(self.path("sparse.ply"), ply([x for x, _ in points]))
        self.step("EvaluateReconstruction", "-i", "sparse.ply", "-m", mesh, "--samples", "1000",
                  "--json", "report.json")
        return json.loads(read(self.path("report.json")))["accuracy"]["median"]

    def check_glb(self, name, data):
        """The faces and the extent are those of the PLY, and the file says no more than it has."""
        mesh, glb = Ply(data), Glb(read(self.path(name)))
        lows, highs, faces = [], [], 0
        for primitive in glb.json["meshes"][0]["primitives"]:
            indices = glb.values(primitive["indices"])
            vertices = len(glb.values(primitive["attributes"]["POSITION"])) // 3
            uv = glb.values(primitive["attributes"]["TEXCOORD_0"])
            self.assertLess(max(indices), vertices)
            self.assertEqual(len(uv) // 2, vertices)
            self.assertTrue(0 <= min(uv) and max(uv) <= 1)
            low, high = glb.bounds(primitive)
            lows.append(low)
            highs.append(high)
            faces += len(indices) // 3
        self.assertEqual(faces, len(mesh.faces))
        for of, ends in ((min, lows), (max, highs)):
            self.assertEqual([of(values) for values in zip(*ends)], [of(values) for values in zip(*mesh.points)])
        for image in glb.json["images"]:
            png_samples(glb.view(image["bufferView"]))

    def test_from_photographs_to_a_textured_mesh(self):
        os.symlink(os.path.join(DATA, "images"), self.path("images"))
        write(self.path("scene.mvs"), read(os.path.join(DATA, "scene_v6.mvs")))
        half = ("--resolution-level", "1", "--min-resolution", "320")
        self.step("DensifyPointCloud", "scene.mvs", *half)
        self.step("ReconstructMesh", "scene_dense.mvs", "-p", "scene_dense.ply")
        self.step("RefineMesh", "scene_dense.mvs", "-m", "scene_dense_mesh.ply", "-o",
                  "scene_dense_mesh_refine.mvs", *half)
        said = self.step("TextureMesh", "scene_dense.mvs", "-m", "scene_dense_mesh_refine.ply", "-o",
                         "scene_texture.mvs", "--export-type", "ply,obj,glb")
        unseen, all_faces = map(int, re.search(r"(\d+) of (\d+) faces are not seen", said).groups())
        self.assertLess(unseen, all_faces / 20)
        # Where the points are, at about 9 units from the cameras, a pixel of half size is 0.027 wide.
        for mesh in ("scene_dense_mesh.ply", "scene_dense_mesh_refine.ply"):
            self.assertLess(self.median_distance(mesh), 0.027)
        ply = read(self.path("scene_texture.ply"))
        self.check_glb("scene_texture.glb", ply)
        self.assertIn(f"element face {all_faces}\n".encode(), ply)
        self.assertEqual(len(re.findall(rb"^f ", read(self.path("scene_texture.obj")), re.M)),
                         all_faces)


if __name__ == "__main__":
    main()
