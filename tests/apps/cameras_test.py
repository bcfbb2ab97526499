# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs of several sizes, turned or zoomed, in `reconstruct`."""

import argparse
import json
import random
import struct

from pipeline_folder import InFolder
from programs import grey_png, main
from stand_ins import StandIns

from axial_pipeline import cameras, gps, photographs

LENS = cameras.Lens("OPENCV", (480, 360), (300, 310, 250, 170, 0.1, -0.05, 0.01, -0.02))


def pixel(lens, u, v):
    """The image of the direction (u, v, 1) by COLMAP's model OPENCV."""
    fx, fy, cx, cy, k1, k2, p1, p2 = lens.numbers
    r = u * u + v * v
    radial = 1 + k1 * r + k2 * r * r
    return (fx * (u * radial + 2 * p1 * u * v + p2 * (r + 2 * u * u)) + cx,
            fy * (v * radial + p1 * (r + 2 * v * v) + 2 * p2 * u * v) + cy)


def jpeg(width, height, focal=None):
    """A photograph of this size. `focal`: of the Exif data [mm]."""
    exif = b""
    if focal:
        first = struct.pack("<HHHIII", 1, 0x8769, 4, 1, 26, 0)
        table = struct.pack("<HHHIII", 1, 0x920A, 5, 1, 44, 0) + struct.pack("<II", round(10 * focal), 10)
        body = b"Exif\0\0II*\0\x08\0\0\0" + first + table
        exif = b"\xff\xe1" + struct.pack(">H", len(body) + 2) + body
    frame = b"\xff\xc0" + struct.pack(">HBHH", 8, 8, height, width) + b"\1"
    return b"\xff\xd8" + exif + frame + b"\xff\xd9"


class Lenses(InFolder):
    def test_a_turned_lens_images_turned_pixels(self):
        turned, draw = cameras.turned(LENS), random.Random(1)
        self.assertEqual(turned.size, (360, 480))
        for _ in range(20):
            u, v = draw.uniform(-0.7, 0.7), draw.uniform(-0.5, 0.5)
            x, y = pixel(LENS, u, v)
            for found, expected in zip(pixel(turned, -v, u), (360 - y, x)):
                self.assertAlmostEqual(found, expected, places=9)

    def test_four_quarter_turns_are_none(self):
        lens = LENS
        for _ in range(4):
            lens = cameras.turned(lens)
        self.assertEqual(lens, LENS)

    def test_a_turned_port_leads_turned_rays(self):
        self.assertEqual(cameras.turned_port({"type": "flat", "normal": [0.1, 0.2, 0.9]})["normal"], [-0.2, 0.1, 0.9])

    def test_a_smaller_photograph_has_a_scaled_lens(self):
        group = cameras.Group((240, 180), None, ("a.jpg",))
        lens, words = cameras.lens_of(group, LENS, None)
        x, y = pixel(LENS, 0.3, -0.2)
        self.assertEqual(tuple(round(number, 9) for number in pixel(lens, 0.3, -0.2)),
                         (round(x / 2, 9), round(y / 2, 9)))
        self.assertEqual(words, "of another size")
        self.assertIsNone(cameras.lens_of(cameras.Group((240, 200), None, ("a.jpg",)), LENS, None))


class Folders(InFolder):
    def write(self, sizes):
        images = self.folder / "images"
        images.mkdir()
        for number, one in enumerate(sizes):
            (images / f"{number}.jpg").write_bytes(jpeg(*one))
        lens = self.folder / "lens.txt"
        lens.write_text("# a lens\n1 OPENCV 480 360 300 310 250 170 0.1 -0.05 0.01 -0.02\n")
        housing = self.folder / "housing.json"
        housing.write_text(json.dumps({"version": 1, "default": "main", "ports": {"main": {
            "type": "flat", "normal": [0, 0.1, 0.99]}}}))
        given = argparse.Namespace(images=str(images), lens=str(lens), housing=str(housing))
        given.cameras = cameras.of(given, photographs.check(images, one_size=False))
        return given

    def test_one_size_is_one_camera(self):
        self.assertEqual(self.write([(480, 360, 18)] * 3).cameras, [])

    def test_the_focal_length_is_that_of_the_exif_data(self):
        self.write([(480, 360, 18.5), (480, 360)])
        self.assertEqual([gps.focal_length(self.folder / "images" / f"{i}.jpg") for i in (0, 1)], [18.5, None])

    def test_each_group_gets_its_lens(self):
        given = self.write([(480, 360, 18)] * 4 + [(480, 360, 24)] * 3 + [(360, 480, 18)] * 2)
        self.assertEqual([len(group.names) for group, _, _ in given.cameras], [4, 3, 2])
        cameras.write(given, given.cameras, self.folder)
        lines = (self.folder / "cameras" / "lenses.txt").read_text().splitlines()
        self.assertEqual(lines[0].split()[:6], ["1", "OPENCV", "480", "360", "300.0", "310.0"])
        self.assertEqual(lines[1].split()[4:6], ["400.0", repr(310 * 24 / 18)])
        self.assertEqual(lines[2].split()[2:4], ["360", "480"])
        self.assertEqual((self.folder / "cameras" / "3.txt").read_text(), "7.jpg\n8.jpg\n")
        housing = json.loads(cameras.housing_file(given, self.folder).read_text())
        self.assertEqual(housing["cameras"], {"3": "main turned"})
        self.assertEqual(housing["ports"]["main turned"]["normal"], [-0.1, 0, 0.99])
        said = "\n".join(cameras.lines_about(given.cameras))
        self.assertIn("warning: 3 photographs are at 24 mm instead of 18 mm", said)
        self.assertIn("2 photographs are turned by a quarter", said)


class InARun(StandIns):
    def test_several_sizes_reach_the_programs(self):
        (self.folder / "lens").write_text("1 PINHOLE 4 3 9 9 2 1.5\n")
        for number in range(3, 5):
            (self.folder / "images" / f"{number}.png").write_bytes(grey_png([bytes(8)] * 6))
        ended = self.ended("--until", "poses")
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        commands = (self.folder / "commands").read_text().splitlines()
        lists = [line.split("--image_list_path ")[1] for line in commands if "feature_extractor" in line]
        self.assertEqual(lists, [f"{self.folder}/out/cameras/{number}.txt" for number in (1, 2)])
        self.assertEqual(sum(f"--lens {self.folder}/out/cameras/lenses.txt" in line for line in commands), 2)


if __name__ == "__main__":
    main()
