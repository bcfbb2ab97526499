# SPDX-License-Identifier: GPL-3.0-or-later
"""Options of DensifyPointCloud that scripts written for OpenMVS use."""

import os
import struct

from openmvs_scene import Cloud, Dmap, Scene, ascii_ply, dmap_names, position
from programs import cloud_size, files_below, main, read, run, write


class Options(Scene):
    MEDIA = ("air",)

    def same_cloud(self, folder, *arguments):
        """Runs DensifyPointCloud with these options, which must not change the cloud. Returns its
        output."""
        said = self.succeeds(*self.command(folder, *arguments)).stdout
        self.assertEqual(self.cloud(folder), read(self.densified("air", "scene_dense.ply")))
        return said

    def sparse(self, folder):
        self.succeeds(*self.command(folder, "--fusion-mode", "1", "-o", "sparse.mvs"))
        return Cloud(read(os.path.join(folder, "sparse.ply")))

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

    def test_all_are_in_the_help(self):
        said = run("DensifyPointCloud", "--help").stdout
        for option in ("dense-config-file", "view-neighbors-file", "filter-point-cloud",
                       "export-number-views", "estimate-scale", "tower-mode", "archive-type",
                       "pointcloud-file", "log-file"):
            self.assertIn("--" + option, said)

    def test_the_output_s_folder_is_made(self):
        folder = self.copy("air")
        self.succeeds(*self.command(folder, "-o", "new/folders/result.mvs"))
        self.assertEqual(read(os.path.join(folder, "new", "folders", "result.ply")),
                         read(self.densified("air", "scene_dense.ply")))

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
        said = self.succeeds(*self.command(folder, *config)).stdout
        self.assertIn("All 5 depth maps exist already", said)
        self.assertLess(cloud_size(self.cloud(folder)), 0.7 * whole)

        write(file, "NCC Threshold Keep = 0.05\n")
        said = self.succeeds(*self.command(folder, *config)).stdout
        self.assertNotRegex(said, "exist(ed)? already")
        self.assertLess(cloud_size(self.cloud(folder)), 0.9 * whole)

        for wrong, said in (("Max Views", "line 2"), ("Max Views = many", "many"),
                            ("Max Views = -1", "Max Views")):
            write(file, "\n" + wrong + "\n")
            self.refuses(said, *self.command(folder, *config))

    def test_a_cloud_in_place_of_the_sparse_points(self):
        folder = self.copy("air")
        self.sparse(folder)
        said = self.same_cloud(folder, "-p", "sparse.ply")
        self.assertIn("All 5 depth maps exist already", said)
        for points, with_views, expected in (
                ([((0, 0, 1), [0])], False, "view_indices"),
                ([((0, 0, 1), [0, 5])], True, "image 5"),
                ([((0, 0, "nan"), [0, 1])], True, "other.ply")):
            write(os.path.join(folder, "other.ply"), ascii_ply(points, with_views))
            self.refuses(expected, *self.command(folder, "-p", "other.ply"))

    def test_view_neighbours(self):
        folder = self.copy("air", "_dense.ply")
        said = self.succeeds(*self.command(folder, "--output-view-neighbors-file", "views.txt"))
        lines = [list(map(int, line.split()))
                 for line in read(os.path.join(folder, "views.txt")).decode().splitlines()]
        self.assertEqual([line[0] for line in lines], list(range(self.VIEWS)), said.stdout)
        for image, *neighbours in lines:
            self.assertEqual(sorted([image, *neighbours]), list(range(self.VIEWS)))
        self.assertNotIn("scene_dense.ply", files_below(folder))

        pairs = {0: [3], 1: [4, 0], 4: [2]}
        write(os.path.join(folder, "views.txt"), "# pairs\n" + "".join(
            f"{image} {' '.join(map(str, others))}\n" for image, others in pairs.items()))
        self.succeeds(*self.command(folder, "--view-neighbors-file", "views.txt",
                                    "--fusion-mode", "1"))
        for image, name in enumerate(dmap_names()):
            ids = Dmap(read(os.path.join(folder, name))).ids
            if image in pairs:
                self.assertEqual(ids, (image, *pairs[image]))
            else:
                self.assertEqual(len(ids), self.VIEWS)

        for wrong, expected in (("0 9", "line 1: '9'"), ("0 x", "'x'"), ("0", "image 0"),
                                ("0 0", "its own"), ("0 1\n0 2", "line 2")):
            write(os.path.join(folder, "views.txt"), wrong + "\n")
            self.refuses(expected, *self.command(folder, "--view-neighbors-file", "views.txt"))

    def test_points_with_many_views(self):
        folder = self.copy("air")
        sparse = self.sparse(folder)
        for least, with_scene in ((3, False), (-4, True)):
            self.succeeds(*self.command(folder, "--export-number-views", least))
            name = os.path.join(folder, f"scene_dense_{abs(least)}views")
            expected = [position(p) for p in sparse.points
                        if len(set(p["view_indices"])) >= abs(least)]
            self.assertGreater(len(expected), 10)
            self.assertLess(len(expected), len(sparse.points))
            self.assertEqual([position(p) for p in Cloud(read(name + ".ply")).points], expected)
            self.assertEqual(os.path.exists(name + ".mvs"), with_scene)

    def test_scales_of_points(self):
        folder = self.copy("air")
        sparse = self.sparse(folder)
        cameras = [Dmap(read(os.path.join(folder, name))).camera for name in dmap_names()]
        self.succeeds(*self.command(folder, "--estimate-scale", "2.5"))
        cloud = Cloud(read(os.path.join(folder, "scene_dense_scale.ply")))
        self.assertEqual(len(cloud.points), len(sparse.points))
        for point, known in zip(cloud.points, sparse.points):
            widths = []
            for view in known["view_indices"]:
                focal, R, C = cameras[view][0] * 2, cameras[view][9:18], cameras[view][18:]
                z = sum(r * (x - c) for r, x, c in zip(R[6:], position(known), C))
                widths.append(z / focal)
            self.assertAlmostEqual(point["value"][0], 2.5 * sum(widths) / len(widths), 5)
            self.assertEqual(point["confidence"][0], len(widths))

    def test_points_that_others_see_through_are_filtered(self):
        folder = self.copy("air")
        dense = Cloud(self.cloud(folder)).points[::7]
        centre = Dmap(read(os.path.join(folder, "depth0000.dmap"))).camera[18:]
        surface = [(position(p), p["view_indices"]) for p in dense]
        seen = [xyz for xyz, views in surface if 0 in views][:100]
        self.assertGreater(len(seen), 50)
        floating = [(tuple((a + b) / 2 for a, b in zip(xyz, centre)), [0]) for xyz in seen]
        write(os.path.join(folder, "points.ply"), ascii_ply(surface + floating))
        self.succeeds(*self.command(folder, "-p", "points.ply", "--filter-point-cloud", "-1"))
        kept = Cloud(read(os.path.join(folder, "scene_dense_filtered.ply"))).points
        self.assertIn("scene_dense_filtered.mvs", os.listdir(folder))
        single = lambda xyz: struct.pack("<3f", *xyz)
        kept = {single(position(p)) for p in kept}
        self.assertFalse(kept & {single(xyz) for xyz, _ in floating})
        self.assertGreater(len(kept), 0.9 * len(surface))

    def test_log_file(self):
        folder = self.copy("air")
        said = self.succeeds(*self.command(folder, "--log-file", "run.log")).stdout
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
        self.copy("air")
        self.succeeds("InterfaceCOLMAP", "-i", self.truth, "--image-folder",
                      os.path.join(self.truth, "air"), "-o", self.path("copy", "scene.mvs"),
                      "--normalize", "1")
        scene = read(self.path("copy", "scene.mvs"))
        # Skips the header and the names of platform and camera, up to the resolution and K.
        at = 12 + 8
        for _ in range(3):
            at += 8 + struct.unpack_from("<Q", scene, at)[0]
            at += 8 if _ == 0 else 0
        self.assertEqual(struct.unpack_from("<II", scene, at), (0, 0))
        k = struct.unpack_from("<9d", scene, at + 8)
        lens = [float(x) for x in read(os.path.join(self.truth, "sparse", "cameras.txt")).decode()
                .splitlines()[-1].split()[4:]]
        for found, pixels in ((k[0], lens[0]), (k[4], lens[1]), (k[2] + 0.5, lens[2]),
                              (k[5] + 0.5, lens[3])):
            self.assertAlmostEqual(found, pixels / 320, 9)
        said = self.succeeds(*self.command(self.path("copy"))).stdout
        self.assertIn("stored without a resolution", said)
        self.assertAlmostEqual(cloud_size(self.cloud(self.path("copy"))) /
                               cloud_size(read(self.densified("air", "scene_dense.ply"))), 1, 1)


if __name__ == "__main__":
    main()
