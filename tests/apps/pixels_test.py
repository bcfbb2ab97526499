# SPDX-License-Identifier: GPL-3.0-or-later
"""How pixels are read: 12 bits in 16, orientation, alpha. All programs refuse a bad file alike."""

import random
import re
import struct

from programs import main, png, read, write
from readers import Dmap, Ply, png_rows
from tiny_scene import WIDTH, TinyScene
from worlds import housing


class Pixels(TinyScene):
    def setUp(self):
        super().setUp()
        self.stored = [read(path) for path in self.images]
        self.rows = [png_rows(picture)[0] for picture in self.stored]

    def arguments(self, *more):
        return self.command("DensifyPointCloud", "--resolution-level", "0", "--iters", "1", "--geometric-iters", "0",
                            "--postprocess-dmaps", "0", *more)

    def put(self, files):
        for path, data in zip(self.images, files):
            write(path, data)

    def depths(self, files, *more):
        self.put(files)
        self.said = self.succeeds(*self.arguments(*more)).stdout
        return self.read_depths()

    def read_depths(self):
        return [Dmap(self.at(f"depth{i:04}.dmap")).rows for i in range(3)]

    def test_twelve_bits_in_sixteen_are_as_good_as_eight(self):
        expected = self.depths(self.stored)
        self.assertNotIn("16 bits", self.said)
        rng = random.Random(4)
        wide = [png([b"".join(struct.pack(">H", value << 4 | rng.randrange(16)) for value in row)
                     for row in rows], 2, 16) for rows in self.rows]
        self.assertEqual(self.depths(wide), expected)
        self.assertIn("The values of 3 images of 16 bits use 12", self.said)
        self.assertEqual(self.depths(wide, "--bit-depth", 12), expected)
        self.assertNotEqual(self.depths(wide, "--bit-depth", 16), expected)
        self.refuses("--bit-depth 17", *self.arguments("--bit-depth", "17"))

    def test_transparent_pixels_are_masked(self):
        def with_alpha(left):
            """The photographs with an alpha channel, which is `left` in their left half and not 0 in the right."""
            return [png([b"".join(row[i:i + 3] + bytes([left if i < len(row) // 2 else max(left, 1)])
                                  for i in range(0, len(row), 3)) for row in rows], 6) for rows in self.rows]

        self.assertEqual(self.depths(with_alpha(255)), self.depths(self.stored))
        half = with_alpha(0)
        for rows in self.depths(half):
            middle = WIDTH // 2
            self.assertFalse(any(depth > 0 for row in rows for depth in row[:middle]))
            self.assertTrue(any(depth > 0 for row in rows for depth in row[middle:]))

    def colors(self, name):
        return [tuple(vertex[channel][0] for channel in ("red", "green", "blue"))
                for vertex in Ply(self.at(name)).vertices]

    def test_a_cloud_takes_colours_from_another_folder_and_depth_maps_do_not(self):
        self.put_restored()
        self.succeeds(*self.densify())
        points = Ply(self.at("scene_dense.ply")).points
        restored = self.densify("--colors", "restored", "-o", "restored_cloud.mvs")
        self.assertIn("All 3 depth maps exist already", self.succeeds(*restored).stdout)
        self.assertEqual(Ply(self.at("restored_cloud.ply")).points, points)
        self.assertEqual({color[1:] for color in self.colors("restored_cloud.ply")}, {(0, 0)})
        self.assertGreater(len({color[1:] for color in self.colors("scene_dense.ply")}), 50)

    def test_restored_photographs_can_be_matched(self):
        self.put_restored()
        plain = self.depths(self.stored)
        self.refuses("--match-restored needs --colors", *self.densify("--match-restored", "1"))
        self.succeeds(*self.densify("--colors", "restored", "--match-restored", "1"))
        self.assertNotEqual(self.read_depths(), plain)

    def test_other_colours_make_a_tile_again(self):
        self.put_restored()
        self.succeeds(*self.densify())
        tile = self.densify("--colors", "restored", "--tile", "1/2")
        for expected in (False, True):
            self.assertEqual("exists already, " in self.succeeds(*tile).stdout, expected)
        write(self.path("work", "restored", "0001.png"), self.stored[1])
        self.assertNotIn("exists already, ", self.succeeds(*tile).stdout)

    def test_all_programs_refuse_a_file_alike(self):
        lens, image = self.path("colmap", "sparse", "cameras.txt"), self.images[1]
        write(self.path("housing.json"), housing())
        for data, expected in ((b"GIF89a" + bytes(50), "is GIF, a format that is not supported"),
                               (self.stored[1][:2000], "truncated")):
            write(image, data)
            said = [self.refuses(f"{image}: ", *self.arguments()),
                    self.refuses("0001.png: ", "InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                                 self.path("new.mvs")),
                    self.refuses(f"{image}: ", "CalibrateHousing", "-i", image, "--lens", lens, "--housing",
                                 self.path("housing.json"), "--board", "checkerboard:9x6:0.03", "-o",
                                 self.path("new.json"))]
            self.assertEqual(len({re.sub(".*0001.png: ", "", each.stderr) for each in said}), 1, said)
            self.assertIn(expected, said[0].stderr)

    def test_the_first_bad_image_is_named(self):
        # All chunks are there, but the pixels are damaged.
        self.put(picture[:60] + bytes(40) + picture[100:] for picture in self.stored)
        for image in self.images[:2]:
            for threads in (1, 8) * 4:
                self.refuses(f"{image}: cannot be decoded: ", *self.arguments("--max-threads", threads))
            write(self.images[0], self.stored[0])


if __name__ == "__main__":
    main()
