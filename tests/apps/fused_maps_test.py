# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth maps that exist already: maps of other programs are kept, recognised as foreign, and fused; a masked pixel
has no depth; and each point gets an error and a confidence."""

import os
import random
import struct

from programs import cloud_size, files_below, main, png, read, write
from readers import Dmap, Ply
from worlds import Densified, dmap_names


class ForeignMaps(Densified):
    def assert_refused_and_kept(self, folder, expected, *arguments):
        before = self.maps(folder)
        self.refuses(expected, *self.command(folder, *arguments))
        self.assertEqual(self.maps(folder), before)

    def test_are_never_overwritten_unasked(self):
        for medium in ("air", "water"):
            for mode in ("0", "1"):
                for which in (dmap_names(), ["depth0003.dmap"]):
                    with self.subTest(medium=medium, mode=mode, which=which):
                        folder = self.copy(medium, "_dense.ply", "_dense.mvs",
                                           *(name + ".json" for name in which))
                        self.assert_refused_and_kept(folder, which[0], "--fusion-mode", mode)
        self.assert_refused_and_kept(folder, "--overwrite-dmaps 1")
        write(os.path.join(folder, "depth0003.dmap"), b"")  # of an unknown program
        self.assert_refused_and_kept(folder, "depth0003.dmap")

    def test_are_overwritten_when_asked(self):
        for medium in ("air", "water"):
            folder = self.copy(medium, "_dense.ply", "depth0001.dmap.json")
            write(os.path.join(folder, "depth0002.dmap"), b"DR of another program")
            said = self.said(folder, "--overwrite-dmaps", "1")
            self.assertIn("depth0001.dmap", said)
            for name in files_below(folder):
                if name.endswith((".dmap", ".ply", ".json")):
                    self.assertEqual(read(os.path.join(folder, name)),
                                     read(self.at(medium, name)), name)

    def test_ours_that_are_damaged_are_made_anew_with_a_word(self):
        folder = self.copy("air")
        path = os.path.join(folder, "depth0001.dmap")
        whole = read(path)
        for wrong in (whole[:1000], b""):
            write(path, wrong)
            said = self.said(folder)
            self.assertIn("depth0001.dmap: the depth map or its side file is damaged", said)
            self.assertEqual(read(path), whole)


class FusingWhatExists(Densified):
    def test_maps_of_others_give_the_cloud_that_ours_give(self):
        # For cameras in air, the side files hold nothing that the maps do not hold.
        folder = self.copy("air", "_dense.ply", "_dense.mvs", ".dmap.json")
        said = self.fuse(folder)
        self.assertIn("5 of 5 images have a depth map, 5 by other programs", said)
        expected = self.whole("air")
        self.assertGreater(cloud_size(expected), 3000)
        self.assertEqual(self.cloud(folder), expected)
        self.fuse(folder, "--max-threads", "1")
        self.assertEqual(self.cloud(folder), expected)

    def test_our_own_maps_behind_a_port(self):
        folder = self.copy("water", "_dense.ply")
        self.fuse(folder, "--iters", "7")  # options of matching do not matter
        self.assertEqual(self.cloud(folder), self.whole("water"))

    def test_foreign_content_beside_our_side_file(self):
        folder = self.copy("air", "_dense.ply")
        path = os.path.join(folder, "depth0002.dmap")
        foreign = Dmap(read(path))
        foreign.depths = bytes(len(foreign.depths))
        write(path, foreign.bytes())
        self.assertIn("1 by other programs", self.fuse(folder))
        self.assertLess(cloud_size(self.cloud(folder)),
                        cloud_size(self.whole("air")))

    def test_without_normals(self):
        folder = self.copy("air", "_dense.ply", ".dmap.json")
        for name in dmap_names():
            path = os.path.join(folder, name)
            write(path, Dmap(read(path)).bytes(normals=False))
        self.fuse(folder)
        whole = cloud_size(self.whole("air"))
        self.assertGreater(cloud_size(self.cloud(folder)), 0.7 * whole)

    def test_only_some_images(self):
        folder = self.copy("air", "_dense.ply", "depth0004.dmap", "depth0004.dmap.json")
        quiet = self.fuse(folder, "-v", "0")
        self.assertIn("depth0004.dmap", quiet)
        said = self.fuse(folder)
        self.assertIn("0004.jpg: has no depth map", said)
        for text in (quiet, said):
            self.assertIn("4 of 5 images have a depth map", text)
        self.assertGreater(cloud_size(self.cloud(folder)), 1000)

    def test_what_cannot_be_fused(self):
        folder = self.copy("air", ".dmap", ".dmap.json", "_dense.ply", "_dense.mvs")
        self.refuses("no depth map found", *self.command(folder, *self.FUSE))
        folder = self.copy("water", "depth0001.dmap.json", "_dense.ply", "_dense.mvs")
        self.refuses("depth0001.dmap: is the depth map of a pinhole camera",
                     *self.command(folder, *self.FUSE))
        self.refuses("disparity", *self.command(folder, "--fusion-mode", "-2"))

    def test_maps_of_other_poses_or_lenses(self):
        folder = self.copy("air", ".dmap.json", "_dense.ply", "_dense.mvs")
        path = os.path.join(folder, "depth0002.dmap")
        whole = read(path)
        # A focal length 2 % off, a principal point 3 px off, a centre 2 cm off.
        for number, change in ((0, lambda f: 1.02 * f), (2, lambda c: c + 6), (18, lambda x: x + 0.02)):
            other = Dmap(whole)
            other.camera[number] = change(other.camera[number])
            write(path, other.bytes())
            self.refuses("depth0002.dmap: its camera projects the scene",
                         *self.command(folder, *self.FUSE))
        write(path, whole[:-4])
        self.refuses("depth0002.dmap: has", *self.command(folder, *self.FUSE))

    def test_refractive_outputs_say_which_of_openmvs_programs_may_read_them(self):
        for medium, mentioned in (("water", True), ("air", False)):
            said = self.said(self.copy(medium))
            last = said.strip().splitlines()[-1]
            for program in ("ReconstructMesh", "RefineMesh", "TextureMesh", "scene_dense.mvs"):
                self.assertEqual(program in last, mentioned, said)


WIDTH, HEIGHT = 160, 120  # of the maps; the photographs are twice as large
NAMES = [f"{i:04}" for i in range(Densified.VIEWS)]


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


class Fusing(Densified):
    def put(self, folder, labels, name="masks/{}.mask.png", factor=1):
        for image, rows in zip(NAMES, labels, strict=True):
            write(os.path.join(folder, name.format(image)), png(enlarged(rows, factor)))

    def test_is_as_if_the_maps_had_no_depth_there(self):
        whole = cloud_size(self.whole("air"))
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
            path, mask = f"{image}.jpg".encode(), f"masks/{image}.mask.png".encode()
            self.assertEqual(scene.count(path + bytes(8)), 1)
            scene = scene.replace(path + bytes(8), path + struct.pack("<Q", len(mask)) + mask)
        write(os.path.join(folder, "scene.mvs"), scene)
        self.fuse(folder, "--ignore-mask-label", "0")
        self.assertEqual(self.cloud(folder), expected)
        self.fuse(folder)  # without any option for masks, they are not used
        self.assertEqual(self.cloud(folder), self.whole("air"))

    def test_behind_a_port(self):
        labels = [random_labels(i) for i in range(self.VIEWS)]
        folder = self.copy("water", "_dense.ply")
        self.put(folder, labels)
        masks = ("--mask-path", "masks")
        for label in ("7", "-1"):
            self.fuse(folder, *masks, "--ignore-mask-label", label)
            self.assertEqual(self.cloud(folder), self.whole("water"))
        self.fuse(folder, *masks)
        masked = cloud_size(self.cloud(folder))
        self.assertLess(masked, 0.9 * cloud_size(self.whole("water")))
        # Fusion masks the pixels that matching masked, so the cloud does not change.
        self.said(folder, *masks)
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
            said = [[text.split("] ", 1)[1] for text in self.said(
                folder, *masks, *arguments, "--fusion-mode", mode).splitlines()
                if line in text] for mode in ("0", "-1")]
            self.assertEqual(len(said[0]), 1)
            self.assertEqual(said[0], said[1])
        write(os.path.join(folder, "masks", "0002.mask.png"), png([bytes(100)] * 100))
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
        self.said(folder, *self.FUSE, "--mask-path", "masks",
                                    "--ignore-mask-label", label, "--pinhole-export", "out" + label)
        after = self.maps(folder)
        self.assertEqual({name: after[name] for name in before}, before)


class Uncertainty(Densified):
    ON = ("--estimate-uncertainty", "1")

    def fused(self, folder, *arguments):
        self.fuse(folder, *arguments)
        return self.cloud(folder)

    def test_adds_two_properties_and_changes_nothing_else(self):
        for more in ((), ("--estimate-normals", "0"), ("--estimate-normals", "1"),
                     ("--output-precision", "float", "--crop-to-roi", "0")):
            with self.subTest(more=more):
                folder = self.copy("water", "_dense.ply")
                plain = self.fused(folder, *more)
                self.assertEqual(self.fused(folder, "--estimate-uncertainty", "0", *more), plain)
                self.assertNotIn(b"property float32 error", plain)
                told = self.fused(folder, *self.ON, "--max-threads", "1", *more)
                self.assertEqual(self.fused(folder, *self.ON, *more), told)
                without, points = Ply(plain).vertices, Ply(told).vertices
                self.assertEqual(len(points), len(without))
                for point, same in zip(points, without, strict=True):
                    error, confidence = point.pop("error")[0], point.pop("confidence")[0]
                    self.assertGreater(error, 0)
                    self.assertGreater(confidence, 0)
                    self.assertLessEqual(confidence, 1)
                    self.assertEqual(point, same)

    # Wide bounds: the errors were not fitted to maps like these, of one sweep and 160 x 120 pixels.
    def test_errors_are_those_that_the_truth_shows(self):
        for medium in self.MEDIA:
            with self.subTest(medium=medium):
                folder = self.copy(medium, "_dense.ply")
                self.fuse(folder, *self.ON)
                report = self.evaluated(medium, os.path.join(folder, "scene_dense.ply"), samples=2000)
                calibration = report["calibration"]
                self.assertGreater(calibration["rms"], 0.5)
                self.assertLess(calibration["rms"], 2)
                self.assertGreater(calibration["within_1_2_3"][2], 0.93)


if __name__ == "__main__":
    main()
