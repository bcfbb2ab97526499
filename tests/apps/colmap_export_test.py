# SPDX-License-Identifier: GPL-3.0-or-later
"""InterfaceCOLMAP exports a scene as a COLMAP model."""

import json
import os
import shutil

import tiny_scene
from programs import ProgramTest, cloud_size, main, read, write
from readers import records, with_paths
from worlds import Densified, flat, housing


class Export(Densified):
    def export(self, folder, *arguments):
        return ("InterfaceCOLMAP", "-i", "scene.mvs", "-w", folder, *arguments)

    def model(self, folder):
        """Cameras by id, images by name, and points of a text model, read without our programs."""
        lines = lambda name: [line.split() for line in records(os.path.join(folder, name))]
        cameras = {line[0]: line[1:] for line in lines("cameras.txt")}
        text = lines("images.txt")
        images = {head[9]: (head[0], [float(x) for x in head[1:8]], head[8],
                            [tuple(map(float, points[i:i + 2])) for i in range(0, len(points), 3)])
                  for head, points in zip(text[::2], text[1::2])}
        names = {image[0]: name for name, image in images.items()}
        points = []
        for line in lines("points3D.txt"):
            track = [(names[line[i]], int(line[i + 1])) for i in range(8, len(line), 2)]
            points.append(([float(x) for x in line[1:4]], line[4:7], track))
        return cameras, images, points

    def check_round_trip(self, medium, cameras_too):
        folder = self.copy(medium)
        self.succeeds(*self.export(folder, "-o", "back"))
        cameras, images, points = self.model(os.path.join(self.truth, "sparse"))
        again = self.model(os.path.join(folder, "back", "sparse"))
        self.assertEqual(len(again[0]), len(cameras))
        self.assertEqual(again[1].keys(), images.keys())
        for name, (_, pose, camera, pixels) in images.items():
            found_id, found, found_camera, _ = again[1][name]
            sign = 1 if pose[0] * found[0] + pose[1] * found[1] + pose[2] * found[2] \
                + pose[3] * found[3] > 0 else -1
            self.near([sign * value for value in found[:4]] + found[4:], pose, 5e-13)
            if cameras_too:
                self.assertEqual([float(x) for x in again[0][found_camera][1:]],
                                 [float(x) for x in cameras[camera][1:]])
        self.assertEqual(len(again[2]), len(points))
        largest = 0
        for (xyz, color, track), (found, found_color, found_track) in zip(points, again[2]):
            self.near(xyz, found, 5e-6)  # points of a scene are float32
            self.assertEqual(found_color, color)
            self.assertEqual(sorted({name for name, _ in found_track}),
                             sorted({name for name, _ in track}))
            pixel = {name: again[1][name][3][index] for name, index in found_track}
            for name, index in track:
                there = images[name][3][index]
                largest = max(largest, abs(there[0] - pixel[name][0]),
                              abs(there[1] - pixel[name][1]))
        return largest

    def test_in_air(self):
        # The true observations have noise of up to about a pixel; the exported ones have none.
        self.assertLess(self.check_round_trip("air", True), 3)

    def test_only_an_export_is_overwritten(self):
        folder = self.copy("air")
        command = self.export(folder)
        for part in ("cameras.txt", "points3D.bin", "frames.txt"):
            mine = os.path.join(folder, "sparse", part)
            write(mine, "mine")
            self.refuses(part, *command)
            self.assertEqual(os.listdir(os.path.dirname(mine)), [part])
            os.remove(mine)
        self.succeeds(*command)
        first = self.model(os.path.join(folder, "sparse"))
        self.succeeds(*command)
        self.assertEqual(self.model(os.path.join(folder, "sparse")), first)
        write(os.path.join(folder, "sparse", "images.bin"), "COLMAP would read it")
        self.refuses("images.bin", *command)

    def test_run_from_another_folder(self):
        """Relative image paths start at the working folder, or at the folder of the scene if it has
        images. The message names the folder of the images, and if images are missing, also the
        working folder and -w."""
        folder = self.copy("air")
        for name in ("0000.jpg", "0001.jpg"):
            os.makedirs(os.path.join(folder, "there"), exist_ok=True)
            shutil.copy(os.path.join(self.truth, "air", name), os.path.join(folder, "there", name))
        os.makedirs(self.path("elsewhere"), exist_ok=True)
        scene = read(os.path.join(folder, "scene.mvs"))
        for place, found in (("../truth/air", 5), ("there", 2), ("nowhere", 0)):
            write(os.path.join(folder, "scene.mvs"), with_paths(scene, lambda path: place + path[-9:]))
            missing = 5 - found
            for start in (folder, self.path("elsewhere")):
                with self.subTest(place=place, start=start):
                    said = self.succeeds("InterfaceCOLMAP", "-i",
                                         os.path.join(folder, "scene.mvs"), cwd=start).stdout
                    line = [text for text in said.splitlines() if "images below" in text]
                    self.assertEqual(len(line), 1, said)
                    looked_in = os.path.normpath(os.path.join(folder if 0 < found else start, place))
                    self.assertIn(f"5 images below {looked_in}", line[0])
                    self.assertEqual(f"{missing} of them do not exist" in line[0], missing > 0)
                    self.assertEqual(f"working folder, {start}, which -w sets" in line[0],
                                     missing > 0)
        self.succeeds(*self.export(folder), cwd=start)

    def test_goes_to_no_file_name(self):
        folder = self.copy("air")
        for name in ("x.mvs", "new/scene.mvs", "cloud.ply", "cameras.txt"):
            self.refuses(f"--output-file {name}: must be a folder", *self.export(folder, "-o", name))
            self.assertFalse(os.path.exists(os.path.join(folder, name)))
        write(os.path.join(folder, "photo.jpg"), "mine")
        self.refuses("--output-file photo.jpg: is a file", *self.export(folder, "-o", "photo.jpg"))
        self.succeeds(*self.export(folder, "-o", "dive.2"))
        self.assertIn("cameras.txt", os.listdir(os.path.join(folder, "dive.2", "sparse")))

    def test_behind_a_port(self):
        folder = self.copy("water")
        said = self.succeeds(*self.export(folder)).stdout
        self.assertIn("5 of 5 images are behind ports", said)
        self.assertIn("FLATPORT", read(os.path.join(folder, "sparse", "cameras.txt")).decode())
        # The exported model is imported again: its ports replace the housing file.
        os.remove(os.path.join(folder, "scene.housing.json"))
        self.imported(os.path.join(folder, "scene.mvs"), "water", model=folder, port=())
        self.said(folder, "--refractive")
        self.assertAlmostEqual(cloud_size(self.cloud(folder)) /
                               cloud_size(self.whole("water")), 1, 1)


class RoundTrip(ProgramTest):
    """A scene that is exported and imported again is the same scene. The rotations of the tiny
    scene are exact in a quaternion, so the bytes are the same, except for the signs of zeros."""
    SIZE = f"{tiny_scene.WIDTH} {tiny_scene.HEIGHT}"
    CENTRE = f"{tiny_scene.CX} {tiny_scene.CY}"

    def round_trip(self, camera, *options):
        folder = self.path("a")
        shutil.rmtree(folder, ignore_errors=True)
        tiny_scene.write_colmap(folder, camera)
        self.succeeds("InterfaceCOLMAP", "-i", folder, "--undistort", 0, *options)
        self.succeeds("InterfaceCOLMAP", "-i", os.path.join(folder, "scene.mvs"), "-w", folder, "-o",
                      self.path("b"))
        again = os.path.join(folder, "again.mvs")
        self.succeeds("InterfaceCOLMAP", "-i", self.path("b"), "--undistort", 0, "-o", again,
                      "--image-folder", os.path.join(folder, "images"))
        scenes = [read(os.path.join(folder, name)).replace(b"\0" * 7 + b"\x80", b"\0" * 8)
                  for name in ("scene.mvs", "again.mvs")]
        self.assertEqual(*scenes)
        return [[json.loads(read(os.path.join(folder, f"{name}.{kind}.json")))
                 for name in ("scene", "again")
                 if os.path.exists(os.path.join(folder, f"{name}.{kind}.json"))]
                for kind in ("lenses", "housing")]

    def test_lenses(self):
        two, one = f"{self.SIZE} 90 91 {self.CENTRE}", f"{self.SIZE} 90 {self.CENTRE}"
        for camera, exported in ((f"PINHOLE {two}", "PINHOLE"),
                                 (f"SIMPLE_RADIAL {one} -0.1", "OPENCV"),
                                 (f"OPENCV {two} -0.1 0.02 0.001 -0.002", "OPENCV"),
                                 (f"FULL_OPENCV {two} -.1 .02 .001 -.002 .01 .02 .01 .003",
                                  "FULL_OPENCV"),
                                 (f"OPENCV_FISHEYE {two} -0.1 0.02 0.01 -0.01", "OPENCV_FISHEYE"),
                                 (f"THIN_PRISM_FISHEYE {two} -.1 .02 .001 .002 .01 .02 .003 .004",
                                  "THIN_PRISM_FISHEYE"),
                                 (f"FOV {two} 0.9", "FOV")):
            with self.subTest(camera=camera):
                lenses, _ = self.round_trip(camera)
                self.assertIn(exported + " ", read(self.path("b", "sparse", "cameras.txt")).decode())
                self.assertEqual(lenses[1:], lenses[:1])
                self.assertEqual(len(lenses), 0 if exported == "PINHOLE" else 2)

    def test_a_lens_behind_a_port(self):
        write(self.path("housing.json"), housing(flat(thickness_m=0.005, n_glass=1.49)))
        lenses, housings = self.round_trip(f"OPENCV {self.SIZE} 90 91 {self.CENTRE} -.1 .02 .001 0",
                                           "--housing", self.path("housing.json"))
        self.assertEqual(lenses[0], lenses[1])
        ports = [next(iter(housing["ports"].values())) for housing in housings]
        self.assertEqual(ports[0], ports[1])

    def test_a_lens_that_colmap_does_not_describe(self):
        folder = self.path("a")
        tiny_scene.write_colmap(folder)
        self.succeeds("InterfaceCOLMAP", "-i", folder)
        write(self.path("a", "scene.lenses.json"), json.dumps({"version": 1, "lenses": {
            "bent": {"type": "perspective", "radial": [1], "thin_prism": [0.01, 0]}},
            "default": "bent"}))
        self.refuses("no camera model of COLMAP describes its lens", "InterfaceCOLMAP", "-i",
                     os.path.join(folder, "scene.mvs"), "-w", folder, "-o", self.path("b"))


if __name__ == "__main__":
    main()
