# SPDX-License-Identifier: GPL-3.0-or-later
"""Depth maps of other programs in the working folder are kept, recognised as foreign, and fused."""

import os
import struct

from openmvs_scene import Dmap, Scene, dmap_names
from programs import cloud_size, files_below, main, read, write


class ForeignMaps(Scene):
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

    def test_are_told_from_ours_by_their_content(self):
        folder = self.copy("air")
        for i, name in enumerate(dmap_names()):
            path = os.path.join(folder, name)
            whole = read(path)
            foreign = Dmap(whole)
            foreign.depths = foreign.depths[:-4] + struct.pack("<f", 0.5 + i)
            write(path, foreign.bytes())
            self.assert_refused_and_kept(folder, name)
            write(path, whole)
        self.assertIn("depth maps exist already", self.succeeds(*self.command(folder)).stdout)

    def test_are_overwritten_when_asked(self):
        for medium in ("air", "water"):
            folder = self.copy(medium, "_dense.ply", "depth0001.dmap.json")
            write(os.path.join(folder, "depth0002.dmap"), b"DR of another program")
            said = self.succeeds(*self.command(folder, "--overwrite-dmaps", "1")).stdout
            self.assertIn("depth0001.dmap", said)
            for name in files_below(folder):
                if name.endswith((".dmap", ".ply", ".json")):
                    self.assertEqual(read(os.path.join(folder, name)),
                                     read(self.densified(medium, name)), name)

    def test_ours_of_other_options_are_replaced_as_before(self):
        for medium in ("air", "water"):
            folder = self.copy(medium)
            self.succeeds(*self.command(folder, "--geometric-iters", "1"))
            self.succeeds(*self.command(folder))
            self.assertEqual(self.cloud(folder), read(self.densified(medium, "scene_dense.ply")))

    def test_ours_that_are_damaged_are_made_anew_with_a_word(self):
        folder = self.copy("air")
        path = os.path.join(folder, "depth0001.dmap")
        whole = read(path)
        for wrong in (whole[:1000], b""):
            write(path, wrong)
            said = self.succeeds(*self.command(folder)).stdout
            self.assertIn("depth0001.dmap: the depth map or its side file is damaged", said)
            self.assertEqual(read(path), whole)


class FusingWhatExists(Scene):
    def test_maps_of_others_give_the_cloud_that_ours_give(self):
        # For cameras in air, the side files hold nothing that the maps do not hold.
        folder = self.copy("air", "_dense.ply", "_dense.mvs", ".dmap.json")
        said = self.fuse(folder)
        self.assertIn("5 of 5 images have a depth map, 5 by other programs", said)
        expected = read(self.densified("air", "scene_dense.ply"))
        self.assertGreater(cloud_size(expected), 3000)
        self.assertEqual(self.cloud(folder), expected)
        self.fuse(folder, "--max-threads", "1")
        self.assertEqual(self.cloud(folder), expected)

    def test_the_resolution_is_that_of_the_maps(self):
        folder = self.copy("air", "_dense.ply", ".dmap.json")
        for level in ("0", "3"):
            said = self.fuse(folder, "--resolution-level", level, "--min-resolution", "20")
            self.assertEqual(self.cloud(folder), read(self.densified("air", "scene_dense.ply")), said)

    def test_our_own_maps_behind_a_port(self):
        folder = self.copy("water", "_dense.ply")
        self.fuse(folder, "--iters", "7")  # options of matching do not matter
        self.assertEqual(self.cloud(folder), read(self.densified("water", "scene_dense.ply")))

    def test_foreign_content_beside_our_side_file(self):
        folder = self.copy("air", "_dense.ply")
        path = os.path.join(folder, "depth0002.dmap")
        foreign = Dmap(read(path))
        foreign.depths = bytes(len(foreign.depths))
        write(path, foreign.bytes())
        self.assertIn("1 by other programs", self.fuse(folder))
        self.assertLess(cloud_size(self.cloud(folder)),
                        cloud_size(read(self.densified("air", "scene_dense.ply"))))

    def test_without_normals(self):
        folder = self.copy("air", "_dense.ply", ".dmap.json")
        for name in dmap_names():
            path = os.path.join(folder, name)
            write(path, Dmap(read(path)).bytes(normals=False))
        self.fuse(folder)
        whole = cloud_size(read(self.densified("air", "scene_dense.ply")))
        self.assertGreater(cloud_size(self.cloud(folder)), 0.7 * whole)

    def test_only_some_images(self):
        folder = self.copy("air", "_dense.ply", "depth0004.dmap", "depth0004.dmap.json")
        said = self.fuse(folder)
        quiet = self.fuse(folder, "-v", "0")
        self.assertIn("4 of 5 images have a depth map", quiet)
        self.assertIn("depth0004.dmap", quiet)
        self.assertIn("4 of 5 images have a depth map", said)
        self.assertIn("0004.png: has no depth map", said.replace(".jpg", ".png"))
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
            said = self.succeeds(*self.command(self.copy(medium))).stdout
            last = said.strip().splitlines()[-1]
            for program in ("ReconstructMesh", "RefineMesh", "TextureMesh", "scene_dense.mvs"):
                self.assertEqual(program in last, mentioned, said)


if __name__ == "__main__":
    main()
