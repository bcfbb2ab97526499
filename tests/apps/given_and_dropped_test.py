# SPDX-License-Identifier: GPL-3.0-or-later
"""Every input that the user gives is used, refused, or reported as not used."""

import json
import math
import os
import struct

import tiny_scene
from places import FAR, centres_of, move_model, points_of, positions, split_ply
from programs import ProgramTest, cloud_size, main, read, run, write


def tiny(folder, shift=None):
    """Writes a COLMAP model in air, with all places moved by `shift`, and imports it."""
    tiny_scene.write_colmap(folder)
    if shift:
        move_model(os.path.join(folder, "sparse"), os.path.join(folder, "moved"), shift)
        for part in ("cameras", "images", "points3D"):
            os.rename(os.path.join(folder, "moved", part + ".txt"),
                      os.path.join(folder, "sparse", part + ".txt"))
    made = run("InterfaceCOLMAP", "-i", folder)
    assert made.returncode == 0, made.stderr


QUICK = ("--resolution-level", "0", "--min-resolution", "48")


class Housings(ProgramTest):
    def test_one_that_gives_no_image_a_port(self):
        tiny(self.path("near"))
        port = {"type": "flat", "distance_m": 0.02, "thickness_m": 0.014, "normal": [0, 0, 1],
                "n_air": 1.0, "n_glass": 1.52, "n_water": 1.333}
        write(self.path("other.json"), json.dumps(
            {"version": 1, "ports": {"main": port}, "default": "none",
             "images": {"lost.png": "main"}}))
        write(self.path("truth.ply"), "ply\nformat ascii 1.0\nelement vertex 3\n"
              "property float x\nproperty float y\nproperty float z\nelement face 1\n"
              "property list uchar int vertex_indices\nend_header\n"
              "-1 -1 1\n1 -1 1\n0 1 1\n3 0 1 2\n")
        housing = ("--housing", self.path("other.json"))
        for command in (
                ("InterfaceCOLMAP", "-i", self.path("near"), "-o", self.path("near", "again.mvs")),
                ("EvaluateReconstruction", "-i", self.path("truth.ply"), "-m",
                 self.path("truth.ply"), "--cameras", self.path("near"), "--samples", "100"),
                ("DensifyPointCloud", "-i", self.path("near", "scene.mvs"), "-w",
                 self.path("near"), *QUICK)):
            said = self.refuses("--housing", *command, *housing).stderr
            self.assertIn("gives no image a port", said)
            said = self.succeeds(*command, *housing, "--allow-missing").stdout
            self.assertIn("gives no image a port; it is not used", said)


class Photographs(ProgramTest):
    def test_a_missing_one_is_left_out_if_that_is_allowed(self):
        tiny(self.path("near"))
        gone = tiny_scene.names()[1]
        os.remove(self.path("near", "images", gone))
        os.remove(self.path("near", "scene.mvs"))
        self.refuses(f"{gone}: image not found (--allow-missing continues without it)",
                     "InterfaceCOLMAP", "-i", self.path("near"))
        said = self.succeeds("InterfaceCOLMAP", "-i", self.path("near"), "--allow-missing").stdout
        self.assertRegex(said, f"warning: .*{gone}: image not found; it is not used")
        self.assertRegex(said, "scene.mvs: 2 images, ")
        self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path("near"), *QUICK)
        os.remove(self.path("near", "images", tiny_scene.names()[0]))
        self.refuses("has 1 registered images, at least 2 are needed", "InterfaceCOLMAP", "-i",
                     self.path("near"), "--allow-missing")


class Clouds(ProgramTest):
    """The cloud given with -p, exports, and the files written beside them."""

    def densify(self, *arguments, name="near"):
        return self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(name),
                             *QUICK, *arguments)

    def test_inputs_are_not_written_over(self):
        tiny(self.path("near"))
        self.densify()
        folder = self.path("near")
        os.rename(os.path.join(folder, "scene_dense.ply"), os.path.join(folder, "given.ply"))
        self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *QUICK,
                      "--output-view-neighbors-file", "list.txt")
        write(os.path.join(folder, "list.mvs"), read(os.path.join(folder, "list.txt")))
        write(os.path.join(folder, "config.mvs"), "Min Views = 2\n")
        os.link(os.path.join(folder, "list.txt"), os.path.join(folder, "linked.mvs"))
        command = ("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *QUICK)
        for option, given, out in (("-p", "given.ply", "given.mvs"),
                                   ("--view-neighbors-file", "list.mvs", "list.mvs"),
                                   ("--view-neighbors-file", "list.txt", "linked.mvs"),
                                   ("--dense-config-file", "config.mvs", "config.mvs")):
            before = read(os.path.join(folder, given))
            self.refuses("--output-file", *command, option, given, "-o", out)
            self.assertEqual(read(os.path.join(folder, given)), before)
        self.refuses("--output-view-neighbors-file", *command, "-p", "given.ply",
                     "--output-view-neighbors-file", "given.ply")
        os.rename(os.path.join(folder, "given.ply"), os.path.join(folder, "x_filtered.ply"))
        self.refuses("--output-file", *command, "-p", "x_filtered.ply", "-o", "x.mvs",
                     "--filter-point-cloud", "-1")

    def test_exports_of_a_far_scene_say_their_offset(self):
        tiny(self.path("near"))
        tiny(self.path("far"), FAR)
        for arguments, names in ((("--filter-point-cloud", "-1000"), ("_filtered",)),
                                 (("--export-number-views", "-2"), ("_2views",)),
                                 (("--estimate-scale", "2"), ("_scale",))):
            for name in ("near", "far"):
                self.densify(*arguments, name=name)
            for suffix in names:
                near = split_ply(read(self.path("near", f"scene_dense{suffix}.ply")))
                far = split_ply(read(self.path("far", f"scene_dense{suffix}.ply")))
                self.assertEqual((near[1], far[1]), (None, FAR))
                self.assertEqual((near[0], len(near[2])), (far[0], len(far[2])))
                if suffix == "_scale":
                    self.assertFalse(os.path.exists(self.path("far", "scene_dense_scale.mvs")))
                    continue
                self.assertFalse(os.path.exists(self.path("near", f"scene_dense{suffix}.geo.json")))
                self.assertEqual(json.loads(read(self.path("far", f"scene_dense{suffix}.geo.json"))),
                                 {"version": 1, "geo_offset": list(FAR)})
            self.densify(*arguments, "--output-precision", "double", name="far")
            world = split_ply(read(self.path("far", f"scene_dense{names[0]}.ply")))
            self.assertIsNone(world[1])
            self.assertIn("property float64 x", world[0])
            self.assertEqual(len(world[2]) - len(far[2]), 12 * 60)  # 60 points, 12 bytes more each

    def test_a_cloud_given_to_a_far_scene_counts_from_its_own_offset(self):
        """A local cloud with a comment geo_offset, a local cloud without it, and a world cloud in
        double are read as the same points."""
        tiny(self.path("far"), FAR)
        self.densify(name="far")
        write(self.path("far", "local.ply"), read(self.path("far", "scene_dense.ply")))
        plain = b"\n".join(line for line in read(self.path("far", "local.ply")).split(b"\n")
                           if not line.startswith(b"comment geo_offset"))
        write(self.path("far", "plain.ply"), plain)
        self.densify("--output-precision", "double", name="far")
        os.rename(self.path("far", "scene_dense.ply"), self.path("far", "world.ply"))
        clouds = []
        for given in ("local.ply", "plain.ply", "world.ply"):
            self.densify("-p", given, "--filter-point-cloud", "-100000", name="far")
            clouds.append(read(self.path("far", "scene_dense_filtered.ply")))
        self.assertGreater(cloud_size(clouds[0]), 100)
        self.assertEqual(clouds[0], clouds[1])
        self.assertEqual(clouds[0], clouds[2])

    def test_a_scene_is_exported_to_where_it_is_in_the_world(self):
        for name, shift in (("near", None), ("far", FAR)):
            tiny(self.path(name), shift)
            given = centres_of(self.path(name, "sparse"))
            self.succeeds("InterfaceCOLMAP", "-i", self.path(name, "scene.mvs"), "-o",
                          self.path(name, "exported"))
            found = centres_of(self.path(name, "exported", "sparse"))
            self.assertEqual(set(found), set(given))
            for image, centre in given.items():
                self.assertLess(math.dist(found[image], centre), 1e-6)
        places = {name: points_of(self.path(name, "exported", "sparse")) for name in ("near", "far")}
        for point, place in places["near"].items():
            moved = tuple(a + b for a, b in zip(place, FAR))
            self.assertLess(math.dist(moved, places["far"][point]), 1e-5)

    def test_a_water_surface_is_exported_with_a_far_scene(self):
        cameras = []
        for name, shift in (("near", (0, 0, 0)), ("far", FAR)):
            tiny(self.path(name), shift if name == "far" else None)
            write(self.path(name, "lake.json"), json.dumps(
                {"version": 1, "default": "lake", "ports": {"lake": {
                    "type": "water-surface", "normal": [0.1, 0, 1],
                    "point_m": [a + b for a, b in zip(shift, (0, 0, 0.3))], "n_water": 1.333}}}))
            self.succeeds("InterfaceCOLMAP", "-i", self.path(name), "--housing",
                          self.path(name, "lake.json"))
            self.succeeds("InterfaceCOLMAP", "-i", self.path(name, "scene.mvs"), "-o",
                          self.path(name, "exported"))
            lines = read(self.path(name, "exported", "sparse", "cameras.txt")).decode().split("\n")
            cameras.append([[float(w) for w in line.split() if w[0] in "0123456789-."]
                            for line in lines if line and line[0] != "#"])
        self.assertEqual(len(cameras[0]), 3)
        for a, b in zip(*cameras, strict=True):
            for x, y in zip(a, b, strict=True):
                self.assertAlmostEqual(x, y, delta=1e-6)

    def test_a_scene_is_exported_with_the_points_of_a_cloud(self):
        for name, shift in (("near", None), ("far", FAR)):
            tiny(self.path(name), shift)
            self.densify(name=name)
            cloud = read(self.path(name, "scene_dense.ply"))
            self.succeeds("InterfaceCOLMAP", "-i", self.path(name, "scene.mvs"), "-p",
                          self.path(name, "scene_dense.ply"), "-o", self.path(name, "exported"))
            exported = points_of(self.path(name, "exported", "sparse"))
            self.assertEqual(len(exported), cloud_size(cloud))
            for place, expected in zip(exported.values(), positions(cloud), strict=True):
                self.assertLess(math.dist(place, expected), 1e-5)
            self.refuses("--pointcloud-file", "InterfaceCOLMAP", "-i", self.path(name), "-p",
                         self.path(name, "scene_dense.ply"))


class NoEffect(ProgramTest):
    """A warning names each option that has no effect together with the other options."""

    def said(self, *command):
        return [line for line in self.succeeds(*command).stdout.split("\n")
                if "without effect" in line]

    def test_in_densify(self):
        tiny(self.path("near"))
        command = ("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path("near"), *QUICK)
        self.assertEqual(self.said(*command, "--iters", "2", "--estimate-colors", "2"), [])
        for given, named in (
                (("--fusion-mode", "1", "--estimate-colors", "1", "--remove-dmaps", "1"),
                 "--estimate-colors, --remove-dmaps"),
                (("--fusion-mode", "-1", "--iters", "4"), "--iters"),
                (("--tile", "1/2", "--remove-dmaps", "1"), "--remove-dmaps"),
                (("--fusion-mode", "-1", "--number-views", "2"),
                 "--resolution-level, --min-resolution, --number-views"),
                (("--projection", "line-search"), "--projection"),
                (("--estimate-roi", "0", "--roi-border", "2"), "--roi-border"),
                (("--camera-model", "pinhole", "--housing", self.path("none.json")), "--housing"),
                (("--estimate-scale", "1", "--export-number-views", "2"), "--estimate-scale"),
                (("--filter-point-cloud", "-1", "--fusion-mode", "1"), "--fusion-mode")):
            lines = self.said(*command, *given)
            self.assertTrue(any(named + ": without effect" in line for line in lines), (given, lines))

    def test_in_densify_on_a_scene_with_a_region(self):
        tiny(self.path("near"))
        images = [self.path("near", "images", name) for name in tiny_scene.names()]
        region = struct.pack("<6d", -1, -1, 0.5, 1, 1, 1.5)
        for name, end in (("without", bytes(48)), ("with", region)):
            write(self.path("near", name + ".mvs"), tiny_scene.mvs(images)[:-48] + end)
            lines = self.said("DensifyPointCloud", "-i", name + ".mvs", "-w", self.path("near"),
                              *QUICK, "--estimate-roi", "1")
            self.assertEqual(len(lines), int(name == "with"), lines)

    def test_in_interface_colmap(self):
        tiny(self.path("near"))
        self.assertEqual(self.said("InterfaceCOLMAP", "-i", self.path("near")), [])
        lines = self.said("InterfaceCOLMAP", "-i", self.path("near", "scene.mvs"), "-o",
                          self.path("out"), "--undistort", "0", "--normalize", "1")
        self.assertEqual(len(lines), 2, lines)

    def test_in_evaluation(self):
        tiny(self.path("near"))
        self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path("near"), *QUICK)
        mesh = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n-1 -1 1\n1 -1 1\n0 1 1\n3 0 1 2\n")
        write(self.path("truth.ply"), mesh)
        command = ("EvaluateReconstruction", "-i", self.path("near", "scene_dense.ply"), "-m",
                   self.path("truth.ply"), "--samples", "100")
        self.assertEqual(self.said(*command), [])
        self.assertEqual(len(self.said(*command, "--min-views", "3", "--picture-width", "100")), 2)
        self.refuses("--estimated", *command, "--estimated", self.path("near"))
        # If there are two models, one message names the model that is read.
        for part in ("cameras", "images", "points3D"):
            write(self.path("near", "sparse", "0", part + ".txt"),
                  read(self.path("near", "sparse", part + ".txt")))
        said = self.succeeds(*command, "--cameras", self.path("near")).stdout
        self.assertEqual(said.count("this model is read"), 1, said)
        said = self.succeeds(*command, "--cameras", self.path("near"), "--align", "centres",
                             "--estimated", self.path("near", "sparse", "0")).stdout
        self.assertEqual(said.count("this model is read"), 1, said)

    def test_centres_of_other_images(self):
        tiny(self.path("near"))
        lines = read(self.path("near", "sparse", "images.txt")).decode().split("\n")
        write(self.path("more", "images.txt"), "\n".join(
            lines[:-1] + ["9 1 0 0 0 0 -0.3 0 1 lost.png", ""]) + "\n")
        for part in ("cameras.txt", "points3D.txt"):
            write(self.path("more", part), read(self.path("near", "sparse", part)))
        command = ("AlignModel", "-i", self.path("near"), "-o", self.path("out"), "--reference")
        said = self.succeeds(*command, self.path("more")).stdout
        self.assertIn("1 of 4 centres belong to no image of the model and are ignored, first lost.png",
                      said)
        self.assertNotIn("belong to no image", self.succeeds(*command, self.path("near")).stdout)


if __name__ == "__main__":
    main()
