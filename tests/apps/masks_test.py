# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks: which file is used; a mask that is missing or not used is reported."""

import array
import contextlib
import os
import shutil
import sqlite3
import subprocess

import pipeline_folder  # noqa: F401 (makes axial_pipeline importable)
import tiny_scene
from axial_pipeline import colmap
from programs import ProgramTest, main, png, read, write
from readers import Dmap

LEFT, RIGHT = bytes([0] * 48 + [255] * 48), bytes([255] * 48 + [0] * 48)


class Masks(ProgramTest):
    """LEFT masks the left half of an image, RIGHT the right half."""

    def setUp(self):
        super().setUp()
        self.names = tiny_scene.names()
        self.images = [self.path("images", name) for name in self.names]
        self.write_images()

    def write_images(self):
        for path, centre in zip(self.images, tiny_scene.CENTRES):
            write(path, tiny_scene.picture(centre))
        write(self.path("scene.mvs"), tiny_scene.mvs(self.images))

    def put(self, row, *parts):
        write(self.path(*parts), png([row] * 72))

    def arguments(self, *more):
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", self.folder, "--resolution-level", "0",
                "--iters", "1", "--geometric-iters", "0", "--postprocess-dmaps", "0", *more)

    def densify(self, *more):
        return self.succeeds(*self.arguments(*more)).stdout

    def matched(self, image):
        """Whether any pixel has a depth: in the left half, in the right half."""
        rows = Dmap(read(self.path(f"depth{image:04}.dmap"))).rows
        middle = len(rows[0]) // 2
        return tuple(any(depth > 0 for row in rows for depth in half(row))
                     for half in (lambda row: row[:middle], lambda row: row[middle:]))

    def test_a_folder_alone_means_label_zero(self):
        for kind in ("{}.mask.png", "{}.png.png", "{}_mask.png", "{}.png"):
            folder = "masks" + kind.strip("{}")
            for name in self.names:
                self.put(LEFT, folder, kind.format(name[:-4]))
            self.assertNotIn("mask", self.densify("--mask-path", folder).replace(folder, ""))
            for image in range(3):
                self.assertEqual(self.matched(image), (False, True), kind)

    def test_beside_the_image(self):
        self.put(LEFT, "images", "0000.png.png")
        self.put(LEFT, "images", "0001_mask.png")
        said = self.densify("--ignore-mask-label", "0")
        self.assertEqual([self.matched(i) for i in range(3)],
                         [(False, True), (False, True), (True, True)])
        warnings = [line for line in said.splitlines() if "mask" in line]
        self.assertEqual(len(warnings), 1, said)
        self.assertIn(f"{self.images[2]}: no mask: looked for 0002.mask.png, 0002.png.png and "
                      f"0002_mask.png in {self.path('images')}", warnings[0])

    def test_two_masks_for_an_image(self):
        for name in self.names:
            self.put(LEFT, "masks", name[:-4] + ".mask.png")
            self.put(RIGHT, "masks", name + ".png")
        said = self.densify("--mask-path", "masks")
        self.assertEqual(self.matched(0), (False, True))
        warnings = [line for line in said.splitlines() if "differs and is ignored" in line]
        self.assertEqual(len(warnings), 1, said)
        for part in (self.path("masks", "0000.mask.png"), self.path("masks", "0000.png.png"),
                     "3 images"):
            self.assertIn(part, warnings[0])


class MasksForColmap(ProgramTest):
    """InterfaceCOLMAP writes masks in COLMAP's form, which the other programs understand, too."""

    def test_they_mean_the_same_to_colmap_and_to_the_programs(self):
        for name, centre in zip(tiny_scene.names(), tiny_scene.CENTRES):
            write(self.path("images", name), tiny_scene.picture(centre))
            write(self.path("masks", name), png([bytes([7] * 48 + [3] * 48)] * 72))
        said = self.succeeds("InterfaceCOLMAP", "-i", self.path("images"), "--mask-path", self.path("masks"),
                             "--ignore-mask-label", 7, "-o", self.path("out")).stdout
        self.assertIn("3 masks, which leave out 50.0 % of the pixels", said)
        self.refuses("is in the folder of the photographs", "InterfaceCOLMAP", "-i", self.path("images"), "--mask-path",
                     self.path("masks"), "-o", self.path("images", "new", "masks"))
        self.assertFalse(os.path.exists(self.path("images", "new")))
        write(self.path("scene.mvs"), tiny_scene.mvs([self.path("images", name)
                                                      for name in tiny_scene.names()]))
        self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.folder, "--resolution-level", "0",
                      "--iters", "1", "--geometric-iters", "0", "--postprocess-dmaps", "0", "--mask-path",
                      "out")
        rows = Dmap(read(self.path("depth0000.dmap"))).rows
        self.assertFalse(any(depth > 0 for row in rows for depth in row[:48]))
        self.assertTrue(any(depth > 0 for row in rows for depth in row[48:]))
        if shutil.which("colmap"):
            self.assertEqual({x > 48 for x in self.features(self.path("out"))}, {True})

    def features(self, masks):
        """The x of the features that COLMAP finds."""
        command = colmap.features(self.path("f.db"), self.path("images"), "PINHOLE", threads=1, masks=masks)
        subprocess.run(list(map(str, command)), check=True, capture_output=True)
        with contextlib.closing(sqlite3.connect(self.path("f.db"))) as connection:
            for columns, data in connection.execute("SELECT cols, data FROM keypoints"):
                yield from array.array("f", data)[::columns]

    def test_what_writes_no_masks_is_refused(self):
        write(self.path("images", "a.png"), tiny_scene.picture(tiny_scene.CENTRES[0]))
        write(self.path("mask.png"), png([bytes(96)] * 72))
        given = ("InterfaceCOLMAP", "-i", self.path("images"), "--mask-path", self.path("mask.png"))
        self.refuses("--mask-path", *given)  # without -o
        self.refuses("--ignore-mask-label -1: must be from 0", *given, "-o", "x", "--ignore-mask-label=-1")
        self.refuses("--housing: contradicts --mask-path", *given, "-o", "x", "--housing", "h")
        self.refuses("is only for --mask-path", *given[:3], "--ignore-mask-label", "0")


if __name__ == "__main__":
    main()
