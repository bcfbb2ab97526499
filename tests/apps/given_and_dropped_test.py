# SPDX-License-Identifier: GPL-3.0-or-later
"""Every input that the user gives is used, refused, or reported as not used."""

import json
import math
import os
import struct

import tiny_scene
from places import FAR, move_model
from programs import ProgramTest, cloud_size, main, must, read, write
from readers import Ply, added, centres_of, points_of, records
from worlds import TRIANGLE, flat, geo_offset, housing, lake

QUICK = ("--resolution-level", "0", "--min-resolution", "48")
MODEL = ("cameras", "images", "points3D")


class Tiny(ProgramTest):
    """Scenes in air: near/ at the origin of the world, and far/ far from it where a case makes it."""

    def setUp(self):
        super().setUp()
        self.tiny("near")

    def tiny(self, name, shift=None):
        """Writes a COLMAP model in air, with all places moved by `shift`, and imports it."""
        folder = self.path(name)
        tiny_scene.write_colmap(folder)
        if shift:
            move_model(os.path.join(folder, "sparse"), os.path.join(folder, "moved"), shift)
            for part in MODEL:
                os.rename(os.path.join(folder, "moved", part + ".txt"), os.path.join(folder, "sparse", part + ".txt"))
        must("InterfaceCOLMAP", "-i", folder)

    def command(self, *arguments, name="near"):
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(name), *QUICK, *arguments)

    def densify(self, *arguments, name="near"):
        return self.succeeds(*self.command(*arguments, name=name)).stdout

    def exported(self, name, *arguments):
        """The model of the export of a scene."""
        self.succeeds("InterfaceCOLMAP", "-i", self.path(name, "scene.mvs"), "-o", self.path(name, "exported"),
                      *arguments)
        return self.path(name, "exported", "sparse")


class Housings(Tiny):
    def test_one_that_gives_no_image_a_port(self):
        write(self.path("other.json"), housing(flat(), "none", images={"lost.png": "main"}))
        write(self.path("truth.ply"), TRIANGLE)
        port, near = ("--housing", self.path("other.json")), self.path("near")
        for command in (("InterfaceCOLMAP", "-i", near, "-o", self.path("near", "again.mvs")),
                        ("EvaluateReconstruction", "-i", self.path("truth.ply"), "-m", self.path("truth.ply"),
                         "--cameras", near, "--samples", "100"), self.command()):
            said = self.refuses("--housing", *command, *port).stderr
            self.assertIn("gives no image a port", said)
            said = self.succeeds(*command, *port, "--allow-missing").stdout
            self.assertIn("gives no image a port; it is not used", said)


class Clouds(Tiny):
    """The cloud given with -p, exports, and the files written beside them."""

    def test_exports_of_a_far_scene_say_their_offset(self):
        self.tiny("far", FAR)
        for arguments, suffix in ((("--filter-point-cloud", "-1000"), "_filtered"),
                                  (("--export-number-views", "-2"), "_2views"), (("--estimate-scale", "2"), "_scale")):
            cloud = f"scene_dense{suffix}.ply"
            for name in ("near", "far"):
                self.densify(*arguments, name=name)
            near, far = (Ply(read(self.path(name, cloud))) for name in ("near", "far"))
            self.assertEqual((near.offset, far.offset), (None, FAR))
            self.assertEqual((near.header, len(near.body)), (far.header, len(far.body)))
            if suffix == "_scale":
                self.assertFalse(os.path.exists(self.path("far", "scene_dense_scale.mvs")))
            else:
                self.assertFalse(os.path.exists(self.path("near", f"scene_dense{suffix}.geo.json")))
                self.assertEqual(json.loads(read(self.path("far", f"scene_dense{suffix}.geo.json"))),
                                 json.loads(geo_offset(*FAR)))
            self.densify(*arguments, "--output-precision", "double", name="far")
            world = Ply(read(self.path("far", cloud)))
            self.assertIsNone(world.offset)
            self.assertIn("property float64 x", world.header)
            self.assertEqual(len(world.body) - len(far.body), 12 * 60)  # 60 points, 12 bytes more each

    def test_a_cloud_given_to_a_far_scene_counts_from_its_own_offset(self):
        """A local cloud with a comment geo_offset, a local cloud without it, and a world cloud in
        double are read as the same points."""
        self.tiny("far", FAR)
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
        self.tiny("far", FAR)
        places = {}
        for name in ("near", "far"):
            given, model = centres_of(self.path(name, "sparse")), self.exported(name)
            found, places[name] = centres_of(model), points_of(model)
            self.assertEqual(set(found), set(given))
            for image, centre in given.items():
                self.assertLess(math.dist(found[image], centre), 1e-6)
        for point, place in places["near"].items():
            self.assertLess(math.dist(added(place, FAR), places["far"][point]), 1e-5)

    def test_a_water_surface_is_exported_with_a_far_scene(self):
        self.tiny("far", FAR)
        cameras = []
        for name, shift in (("near", (0, 0, 0)), ("far", FAR)):
            write(self.path(name, "lake.json"), housing(lake(added(shift, (0, 0, 0.3)), (0.1, 0, 1))))
            self.succeeds("InterfaceCOLMAP", "-i", self.path(name), "--housing", self.path(name, "lake.json"))
            lines = records(os.path.join(self.exported(name), "cameras.txt"))
            cameras.append([[float(w) for w in line.split() if w[0] in "0123456789-."] for line in lines])
        self.assertEqual(len(cameras[0]), 3)
        for a, b in zip(*cameras, strict=True):
            for x, y in zip(a, b, strict=True):
                self.assertAlmostEqual(x, y, delta=1e-6)

    def test_a_scene_is_exported_with_the_points_of_a_cloud(self):
        self.tiny("far", FAR)
        for name in ("near", "far"):
            self.densify(name=name)
            given = ("-p", self.path(name, "scene_dense.ply"))
            exported = points_of(self.exported(name, *given))
            for place, expected in zip(exported.values(), Ply(read(given[1])).places, strict=True):
                self.assertLess(math.dist(place, expected), 1e-5)
            self.refuses("--pointcloud-file", "InterfaceCOLMAP", "-i", self.path(name), *given)


class NoEffect(Tiny):
    """A warning names each option that has no effect together with the other options."""

    def said(self, *command):
        return [line for line in self.succeeds(*command).stdout.split("\n")
                if "without effect" in line]

    def test_in_densify(self):
        command = self.command()
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
        images = [self.path("near", "images", name) for name in tiny_scene.names()]
        region = struct.pack("<6d", -1, -1, 0.5, 1, 1, 1.5)
        for name, end in (("without", bytes(48)), ("with", region)):
            write(self.path("near", name + ".mvs"), tiny_scene.mvs(images)[:-48] + end)
            lines = self.said("DensifyPointCloud", "-i", name + ".mvs", "-w", self.path("near"),
                              *QUICK, "--estimate-roi", "1")
            self.assertEqual(len(lines), int(name == "with"), lines)

    def test_in_interface_colmap(self):
        self.assertEqual(self.said("InterfaceCOLMAP", "-i", self.path("near")), [])
        lines = self.said("InterfaceCOLMAP", "-i", self.path("near", "scene.mvs"), "-o",
                          self.path("out"), "--undistort", "0", "--normalize", "1")
        self.assertEqual(len(lines), 1, lines)
        self.assertIn("--undistort, --normalize: without effect", lines[0])

    def test_in_evaluation(self):
        self.densify()
        write(self.path("truth.ply"), TRIANGLE)
        command = ("EvaluateReconstruction", "-i", self.path("near", "scene_dense.ply"), "-m",
                   self.path("truth.ply"), "--samples", "100")
        self.assertEqual(self.said(*command), [])
        self.assertEqual(len(self.said(*command, "--min-views", "3", "--picture-width", "100")), 2)
        self.refuses("--estimated", *command, "--estimated", self.path("near"))
        # If there are two models, one message names the model that is read.
        for part in MODEL:
            write(self.path("near", "sparse", "0", part + ".txt"),
                  read(self.path("near", "sparse", part + ".txt")))
        said = self.succeeds(*command, "--cameras", self.path("near")).stdout
        self.assertEqual(said.count("this model is read"), 1, said)
        said = self.succeeds(*command, "--cameras", self.path("near"), "--align", "centres",
                             "--estimated", self.path("near", "sparse", "0")).stdout
        self.assertEqual(said.count("this model is read"), 1, said)

    def test_centres_of_other_images(self):
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
