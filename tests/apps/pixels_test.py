# SPDX-License-Identifier: GPL-3.0-or-later
"""How pixels are read: 12 bits in 16, orientation, alpha. All programs refuse a bad file alike."""

import random
import re
import struct
import zlib

import tiny_scene
from programs import ProgramTest, depth_rows, main, read, run, write
from tiny_scene import HEIGHT, WIDTH


def pixels_of(png):
    """The samples of a PNG that tiny_scene wrote, row by row."""
    size = struct.unpack_from(">I", png, 33)[0]
    raw = zlib.decompress(png[41:41 + size])
    stride = 1 + 3 * WIDTH
    return [raw[y * stride + 1:(y + 1) * stride] for y in range(HEIGHT)]


def png(rows, bits, color_type):
    """The bytes of a PNG. Each of `rows` holds its samples in the byte order of the format."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, bits, color_type, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows)))
            + chunk(b"IEND", b""))


def tiff(rows, orientation=1, sample_format=1, bits=8):
    """The bytes of an RGB TIFF of one strip."""
    pixels = b"".join(rows)
    entries = [(256, 4, 1, WIDTH), (257, 4, 1, HEIGHT), (258, 3, 3, 0), (259, 3, 1, 1),
               (262, 3, 1, 2), (273, 4, 1, 0), (274, 3, 1, orientation), (277, 3, 1, 3),
               (278, 4, 1, HEIGHT), (279, 4, 1, len(pixels)), (339, 3, 1, sample_format)]
    behind = 8 + 2 + 12 * len(entries) + 4
    values = {258: behind, 273: behind + 6}
    directory = struct.pack("<H", len(entries)) + b"".join(
        struct.pack("<HHII", tag, kind, count, values.get(tag, value))
        for tag, kind, count, value in entries) + struct.pack("<I", 0)
    return b"II*\0" + struct.pack("<I", 8) + directory + struct.pack("<HHH", bits, bits, bits) + pixels


class Pixels(ProgramTest):
    def setUp(self):
        super().setUp()
        self.images = [self.path("images", name) for name in tiny_scene.names()]
        self.stored = [tiny_scene.picture(centre) for centre in tiny_scene.CENTRES]
        write(self.path("scene.mvs"), tiny_scene.mvs(self.images))

    def arguments(self, *more):
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", self.folder, "--resolution-level", "0",
                "--iters", "1", "--geometric-iters", "0", "--postprocess-dmaps", "0", *more)

    def depths(self, files, *more):
        for path, data in zip(self.images, files):
            write(path, data)
        self.said = self.succeeds(*self.arguments(*more)).stdout
        return [depth_rows(read(self.path(f"depth{i:04}.dmap"))) for i in range(3)]

    def test_twelve_bits_in_sixteen_are_as_good_as_eight(self):
        expected = self.depths(self.stored)
        self.assertNotIn("16 bits", self.said)
        rng = random.Random(4)
        for bits in (10, 12, 16):
            wide = [png([b"".join(struct.pack(">H", value << bits - 8 | rng.randrange(1 << bits - 8))
                                  for value in row) for row in pixels_of(picture)], 16, 2)
                    for picture in self.stored]
            self.assertEqual(self.depths(wide), expected, bits)
            self.assertIn(f"The values of 3 images of 16 bits use {bits}", self.said)
            self.assertEqual(self.depths(wide, "--bit-depth", bits), expected, bits)
            if bits == 10:
                self.assertNotEqual(self.depths(wide, "--bit-depth", 16), expected)
        self.refuses("--bit-depth 17", *self.arguments("--bit-depth", "17"))

    def test_orientation_turns_nothing(self):
        expected = self.depths(self.stored)
        for orientation in range(1, 9):
            files = [tiff(pixels_of(picture), orientation) for picture in self.stored]
            self.assertEqual(self.depths(files), expected, orientation)

    def test_transparent_pixels_are_masked(self):
        opaque = [png([b"".join(row[i:i + 3] + b"\xff" for i in range(0, len(row), 3))
                       for row in pixels_of(picture)], 8, 6) for picture in self.stored]
        expected = self.depths(self.stored)
        self.assertEqual(self.depths(opaque), expected)
        half = [png([b"".join(row[i:i + 3] + (b"\0" if i < len(row) // 2 else b"\x01")
                              for i in range(0, len(row), 3))
                     for row in pixels_of(picture)], 8, 6) for picture in self.stored]
        for rows in self.depths(half):
            middle = WIDTH // 2
            self.assertFalse(any(depth > 0 for row in rows for depth in row[:middle]))
            self.assertTrue(any(depth > 0 for row in rows for depth in row[middle:]))

    def test_all_programs_refuse_a_file_alike(self):
        tiny_scene.write_colmap(self.path("colmap"))
        lens = self.path("colmap", "sparse", "cameras.txt")
        write(self.path("housing.json"),
              '{"version": 1, "ports": {"main": {"type": "flat", "distance_m": 0.02, '
              '"thickness_m": 0.01, "normal": [0, 0, 1], "n_air": 1, "n_glass": 1.5, '
              '"n_water": 1.33}}, "default": "main"}')
        floats = tiff([b"\0\0\x80\x3f" * 3 * WIDTH] * HEIGHT, sample_format=3, bits=32)
        whole = tiff(pixels_of(self.stored[1]))
        for data, expected in ((floats, "pixels are floating-point numbers of 32 bits"),
                               (whole[:len(whole) // 2], "truncated"),
                               (b"GIF89a" + bytes(50), "is GIF, a format that is not supported"),
                               (self.stored[1][:2000], "truncated"),
                               (b"never an image", "is not in a supported image format")):
            for path, picture in zip(self.images, self.stored):
                write(path, picture)
            write(self.images[1], data)
            write(self.path("colmap", "images", "0001.png"), data)
            said = [self.refuses(f"{self.images[1]}: ", *self.arguments()),
                    self.refuses("0001.png: ", "InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                                 self.path("new.mvs")),
                    self.refuses(f"{self.images[1]}: ", "CalibrateHousing", "-i", self.images[1],
                                 "--lens", lens, "--housing", self.path("housing.json"), "--board",
                                 "checkerboard:9x6:0.03", "-o", self.path("new.json"))]
            self.assertEqual(len({re.sub(".*0001.png: ", "", each.stderr) for each in said}), 1, said)
            self.assertIn(expected, said[0].stderr)

    def test_the_first_bad_image_is_named(self):
        for path, picture in zip(self.images, self.stored):
            # All chunks are there, but the pixels are damaged.
            write(path, picture[:60] + bytes(40) + picture[100:])
        for threads in (1, 8) * 4:
            self.refuses(f"{self.images[0]}: cannot be decoded: ",
                         *self.arguments("--max-threads", threads))
        write(self.images[0], self.stored[0])
        for threads in (1, 8) * 4:
            self.refuses(f"{self.images[1]}: cannot be decoded: ",
                         *self.arguments("--max-threads", threads))


if __name__ == "__main__":
    main()
