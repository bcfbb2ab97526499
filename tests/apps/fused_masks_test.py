# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks in the fusion of existing depth maps (--fusion-mode -1): a masked pixel has no depth."""

import os
import random
import re
import struct

from openmvs_scene import Dmap, Scene, dmap_names
from programs import cloud_size, grey_png, main, read, write

WIDTH, HEIGHT = 160, 120  # of the maps; the photographs are twice as large
NAMES = [f"{i:04}" for i in range(Scene.VIEWS)]


def random_labels(seed):
    """Labels 0, 5 and 9 of a map's pixels, the same within each block of 8 x 8 pixels."""
    rng = random.Random(seed)
    blocks = [[rng.choice((0, 5, 9)) for _ in range(WIDTH // 8)] for _ in range(HEIGHT // 8)]
    return [bytes(row[x // 8] for x in range(WIDTH)) for row in blocks for _ in range(8)]


def enlarged(rows, factor):
    return [bytes(label for label in row for _ in range(factor)) for row in rows
            for _ in range(factor)]


def without(dmap, rows, label):
    """The map's bytes with depth and normal set to zero where `rows` have the label."""
    dmap.depths, dmap.normals = bytearray(dmap.depths), bytearray(dmap.normals)
    for y, row in enumerate(rows):
        for x, found in enumerate(row):
            if found == label:
                at = y * WIDTH + x
                dmap.depths[4 * at:4 * at + 4] = bytes(4)
                dmap.normals[12 * at:12 * at + 12] = bytes(12)
    return dmap.bytes()


class Fusing(Scene):
    SAMPLES = 1

    def put(self, folder, labels, name="masks/{}.mask.png", factor=1):
        for image, rows in zip(NAMES, labels, strict=True):
            write(os.path.join(folder, name.format(image)), grey_png(enlarged(rows, factor)))

    def test_is_as_if_the_maps_had_no_depth_there(self):
        whole = cloud_size(read(self.densified("air", "scene_dense.ply")))
        for ours in (True, False):
            leave_out = ("_dense.ply",) if ours else ("_dense.ply", ".dmap.json")
            for seed, label, factor, more in (
                    (1, 0, 1, ()), (2, 0, 2, ("--max-threads", "1")),
                    (3, 9, 4, ("--ignore-mask-label", "9", "--estimate-colors", "0"))):
                with self.subTest(ours=ours, seed=seed):
                    labels = [random_labels(10 * seed + i) for i in range(self.VIEWS)]
                    folder = self.copy("air", "_dense.ply", ".dmap.json")
                    for name, rows in zip(dmap_names(), labels):
                        path = os.path.join(folder, name)
                        write(path, without(Dmap(read(path)), rows, label))
                    self.fuse(folder, *[word for word in more if word not in
                                        ("--ignore-mask-label", "9")])
                    expected = self.cloud(folder)
                    folder = self.copy("air", *leave_out)
                    self.put(folder, labels, factor=factor)
                    said = self.fuse(folder, "--mask-path", "masks", *more)
                    self.assertEqual(self.cloud(folder), expected)
                    self.assertLess(cloud_size(expected), 0.9 * whole)
                    self.assertGreater(cloud_size(expected), 0.1 * whole)
                    self.assertNotIn("mask", said.replace("/masks/", ""))

    def test_masks_that_the_scene_names_and_those_beside_it(self):
        labels = [random_labels(i) for i in range(self.VIEWS)]
        folder = self.copy("air", "_dense.ply")
        self.put(folder, labels)
        self.fuse(folder, "--mask-path", "masks")
        expected = self.cloud(folder)
        scene = read(os.path.join(folder, "scene.mvs"))
        for image in NAMES:
            path = re.search(rb"[^\0]*" + image.encode() + rb"\.jpg", scene)[0]
            mask = f"masks/{image}.mask.png".encode()
            before = struct.pack("<Q", len(path)) + path + struct.pack("<Q", 0)
            self.assertEqual(scene.count(before), 1)
            scene = scene.replace(before, before[:-8] + struct.pack("<Q", len(mask)) + mask)
        write(os.path.join(folder, "scene.mvs"), scene)
        self.fuse(folder, "--ignore-mask-label", "0")
        self.assertEqual(self.cloud(folder), expected)
        self.fuse(folder)  # without any option for masks, they are not used
        self.assertEqual(self.cloud(folder), read(self.densified("air", "scene_dense.ply")))

    def test_behind_a_port(self):
        labels = [random_labels(i) for i in range(self.VIEWS)]
        folder = self.copy("water", "_dense.ply")
        self.put(folder, labels)
        masks = ("--mask-path", "masks")
        for label in ("7", "-1"):
            self.fuse(folder, *masks, "--ignore-mask-label", label)
            self.assertEqual(self.cloud(folder), read(self.densified("water", "scene_dense.ply")))
        self.fuse(folder, *masks)
        masked = cloud_size(self.cloud(folder))
        self.assertLess(masked, 0.9 * cloud_size(read(self.densified("water", "scene_dense.ply"))))
        # Fusion masks the pixels that matching masked, so the cloud does not change.
        self.succeeds(*self.command(folder, *masks))
        matched = self.cloud(folder)
        self.fuse(folder, *masks)
        self.assertEqual(self.cloud(folder), matched)
        # With inverted masks, fusion masks all pixels that matching kept. No point is left.
        self.put(folder, [[bytes(255 * (label == 0) for label in row) for row in rows]
                          for rows in labels])
        self.fuse(folder, *masks)
        self.assertEqual(cloud_size(self.cloud(folder)), 0)

    def test_says_of_masks_what_matching_says(self):
        folder = self.copy("air")
        self.put(folder, [[bytes([0, 5] * (WIDTH // 2))] * HEIGHT] * self.VIEWS)
        masks = ("--mask-path", "masks")
        for arguments, line in ((("--ignore-mask-label", "7"), "no mask has this label"),
                                (("--ignore-mask-label", "-1"), "is not used, because")):
            said = [[text.split("] ", 1)[1] for text in self.succeeds(*self.command(
                folder, *masks, *arguments, "--fusion-mode", mode)).stdout.splitlines()
                if line in text] for mode in ("0", "-1")]
            self.assertEqual(len(said[0]), 1)
            self.assertEqual(said[0], said[1])
        write(os.path.join(folder, "masks", "0002.mask.png"), grey_png([bytes(100)] * 100))
        errors = {self.refuses("0002.mask.png", *self.command(
            folder, *masks, "--fusion-mode", mode)).stderr for mode in ("0", "-1")}
        self.assertEqual(len(errors), 1)

    def test_exported_pinholes_have_no_depth_there_either(self):
        folder = self.copy("water", "_dense.ply")
        self.put(folder, [[bytes([255 * (i != 1)] * WIDTH)] * HEIGHT for i in range(self.VIEWS)])
        exported = []
        for label in ("7", "0"):
            self.fuse_and_export(folder, label)
            exported.append([Dmap(read(os.path.join(folder, "out" + label, name))).depths
                             for name in dmap_names()])
        for i, (whole, masked) in enumerate(zip(*exported)):
            self.assertTrue(any(whole))
            self.assertEqual(masked, bytes(len(whole)) if i == 1 else whole)

    def fuse_and_export(self, folder, label):
        before = self.maps(folder)
        self.succeeds(*self.command(folder, *self.FUSE, "--mask-path", "masks",
                                    "--ignore-mask-label", label, "--pinhole-export", "out" + label))
        after = self.maps(folder)
        self.assertEqual({name: after[name] for name in before}, before)


if __name__ == "__main__":
    main()
