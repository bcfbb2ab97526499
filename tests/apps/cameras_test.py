# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs of several sizes, focal lengths and cameras, and turned photographs, in `reconstruct`."""

import dataclasses
import json
import os
import pathlib
import random
import shutil
import struct
import subprocess
import unittest

from colmap_databases import SHARP, Databases
from pipeline_folder import InFolder, options_of, reconstruct_command, simulate
from programs import ProgramTest, main, png, read, write
from stand_ins import StandIns
from support import colmap_text

from axial_pipeline import cameras, control, database, exif, features, lenses, photographs, turns
from axial_pipeline.failure import Failure
from axial_pipeline.reconstruct_steps import colmap_steps

NUMBERS = {"OPENCV": (0.1, -0.05, 0.01, -0.02), "THIN_PRISM_FISHEYE": (0.1, -0.05, 0.01, -0.02, 0, 0, 0.003, 0.004)}
LENS = lenses.Lens(1, "OPENCV", (480, 360), (300, 310, 250, 170, *NUMBERS["OPENCV"]))
TEXT = "1 OPENCV 480 360 300 310 250 170 0.1 -0.05 0.01 -0.02\n"


def pixel(lens, u, v):
    """The image of the direction (u, v, 1) by COLMAP's model OPENCV, with the thin prism after it."""
    fx, fy, cx, cy, k1, k2, p1, p2, *prism = lens.parameters
    r = u * u + v * v
    radial = 1 + k1 * r + k2 * r * r
    sx, sy = prism[2:] if prism else (0, 0)
    return (fx * (u * radial + 2 * p1 * u * v + p2 * (r + 2 * u * u) + sx * r) + cx,
            fy * (v * radial + p1 * (r + 2 * v * v) + 2 * p2 * u * v + sy * r) + cy)


def exif_of(focal=None, camera="", orientation=1, order="<"):
    """Exif data with a focal length [mm], a model and an orientation."""
    text = camera.encode() + b"\0" * (5 - len(camera))  # longer than the four bytes of an entry
    entries = [(0x0110, 2, len(text), 50), (0x0112, 3, 1, orientation << (16 if order == ">" else 0)),
               (0x8769, 4, 1, 50 + len(text))]
    first = struct.pack(f"{order}H", len(entries)) + b"".join(struct.pack(f"{order}HHII", *one) for one in entries)
    inner = struct.pack(f"{order}HHHII", 1 if focal else 0, 0x920A, 5, 1, 64 + len(text))
    mark = b"II*\0" if order == "<" else b"MM\0*"
    return (mark + struct.pack(f"{order}I", 8) + first + b"\0" * (42 - len(first)) + text + inner +
            struct.pack(f"{order}II", round(10 * (focal or 0)), 10))


def jpeg(width, height, focal=None, camera="", orientation=1, order="<"):
    """A photograph of this size."""
    body = b"Exif\0\0" + exif_of(focal, camera, orientation, order) if focal or camera or orientation != 1 else b""
    segment = b"\xff\xe1" + struct.pack(">H", len(body) + 2) + body if body else b""
    return (b"\xff\xd8" + segment + b"\xff\xc0" + struct.pack(">HBHH", 8, 8, height, width) + b"\1" + b"\xff\xd9")


class ExifData(InFolder):
    def test_camera_focal_length_and_orientation(self):
        for order in "<>":
            data = jpeg(4, 3, 18.5, "Canon EOS", 6, order)
            self.assertEqual(exif.exif_in(data), exif.Exif("Canon EOS", 18.5, 6), order)
            self.assertEqual(photographs.image_of(self.write("a.jpg", data)).size, (4, 3))
        self.assertEqual(exif.exif_in(jpeg(4, 3)), exif.Exif())
        self.assertEqual(exif.camera_of("GoPro", "HERO9"), "GoPro HERO9")
        self.assertEqual(exif.camera_of("NIKON CORPORATION", "NIKON D5"), "NIKON D5")

    def test_exposures_are_time_by_sensitivity_over_squared_f_number(self):
        rational = lambda tag, number: (tag, 5, 1, number)
        for order in "<>":
            short = lambda value: value << (16 if order == ">" else 0)
            numbers = struct.pack(f"{order}IIII", 1, 250, 28, 10)  # 1/250 s, f/2.8
            for sensitivity, tags, expected in (
                    (200, 3, 200 / 250 / 2.8**2), (200, 2, 200 / 250), (0, 3, None), (200, 0, None)):
                rows = [rational(0x829A, 100), rational(0x829D, 108)][:tags] if tags != 2 else [rational(0x829A, 100)]
                rows.append((0x8827, 3, 1, short(sensitivity)))
                first = struct.pack(f"{order}HHHII", 1, 0x8769, 4, 1, 26)
                own = struct.pack(f"{order}H", len(rows)) + b"".join(
                    struct.pack(f"{order}HHII", *row) for row in rows)
                data = (b"II*\0" if order == "<" else b"MM\0*") + struct.pack(f"{order}I", 8) + first
                data = (data + b"\0" * (26 - len(data)) + own).ljust(100, b"\0") + numbers
                found = exif.exif_in(data).exposure
                self.assertEqual(found, expected) if expected is None else self.assertAlmostEqual(found, expected)

    def test_damaged_data_say_nothing(self):
        whole = jpeg(4, 3, 18.5, "Canon EOS")
        for at in range(len(whole)):
            exif.exif_in(whole[:at])
            exif.exif_in(whole[:at] + b"\xff" + whole[at + 1:])


class Lenses(InFolder):
    def test_a_turned_lens_images_turned_pixels(self):
        for model, rest in NUMBERS.items():
            lens = dataclasses.replace(LENS, model=model, parameters=(300, 310, 250, 170, *rest))
            turned, draw = lenses.turned(lens), random.Random(1)
            self.assertEqual(turned.size, (360, 480))
            for _ in range(20):
                u, v = draw.uniform(-0.7, 0.7), draw.uniform(-0.5, 0.5)
                x, y = pixel(lens, u, v)
                for found, expected in zip(pixel(turned, -v, u), (360 - y, x)):
                    self.assertAlmostEqual(found, expected, places=9)
            self.assertEqual(lenses.turned(lens, 4), lens)
            self.assertEqual(lenses.turned(turned, 3), lens)

    def test_a_smaller_photograph_has_a_scaled_lens(self):
        lens = lenses.fitted(LENS, (240, 180))
        for found, expected in zip(pixel(lens, 0.3, -0.2), pixel(LENS, 0.3, -0.2)):
            self.assertAlmostEqual(found, expected / 2, places=9)
        self.assertEqual(lenses.difference(LENS, (240, 180)), lenses.SCALED)
        self.assertEqual(lenses.difference(LENS, (181, 240)), lenses.SCALED_AND_TURNED)
        self.assertIsNone(lenses.difference(LENS, (240, 200)))

    def test_all_files_of_lenses_are_read(self):
        text = self.write("lens.txt", f"# focal_sigma 1 0.002\n{TEXT}2 SIMPLE_RADIAL 8 6 9 4 3 0.1\n")
        first, second = lenses.in_file(text)
        self.assertEqual(first, dataclasses.replace(LENS, focal_sigma=0.002, file=str(text)))
        self.assertEqual(second.parameters, (9, 9, 4, 3, 0.1))
        self.assertEqual(lenses.text_of([second, first]).splitlines(),
                         ["# focal_sigma 2 0.002", "1 SIMPLE_RADIAL 8 6 9.0 4.0 3.0 0.1",
                          "2 OPENCV 480 360 300.0 310.0 250.0 170.0 0.1 -0.05 0.01 -0.02"])
        binary = struct.pack("<Q", 2) + b"".join(
            struct.pack(f"<iiQQ{len(numbers)}d", number, model, *size, *numbers) for number, model, size, numbers in
            ((1, 4, (480, 360), LENS.parameters), (2, 2, (8, 6), (9, 4, 3, 0.1))))
        folder = self.write("model/cameras.bin", binary).parent
        self.assertEqual([one.parameters for one in lenses.in_file(folder)], [first.parameters, second.parameters])
        for numbers in ("[300, 310, 250, 170, 0.1, -0.05, 0.01, -2e-2]",
                        "\n  - 300\n  - 310\n- 250\n- 170\n- 0.1\n- -0.05\n- 0.01\n- -0.02"):
            calibmar = self.write("a.yaml", f"# x: 3\nmodel: 'OPENCV' # y\nparameters: {numbers}\n"
                                            "width: 480\nheight: 360")
            self.assertEqual(lenses.in_file(calibmar), [dataclasses.replace(LENS, file=str(calibmar))])
        for wrong in ("", "1 OPENCV 4 3 9\n", "1 NONE 4 3 9 9 9 9\n", "\xff\n", "x\n"):
            self.assertEqual(lenses.in_file(self.write("lens.txt", wrong)), [])

    def test_a_lens_states_its_focal_length(self):
        for text, given in (("18.5mm:a/b.txt", lenses.Given("a/b.txt", focal=18.5)),
                            ("left/:a/b.txt", lenses.Given("a/b.txt", prefix="left/")),
                            ("18mm.txt", lenses.Given("18mm.txt"))):
            self.assertEqual(lenses.given_as(text), given)
            self.assertEqual(given.with_file(given.file), text)
        with self.assertRaisesRegex(Failure, "must be FILE, a focal length and a file"):
            lenses.given_as("left/:18mm:a.txt")


class CamerasCase(InFolder):
    def given(self, photos, *lens_texts, housing=None):
        """The options for these photographs, given by the arguments of jpeg()."""
        shutil.rmtree(self.folder / "images", ignore_errors=True)
        for number, one in enumerate(photos):
            self.write(f"images/{number}.jpg", jpeg(*one))
        files = []
        for number, text in enumerate(lens_texts or [TEXT]):
            focal, colon, text = text.rpartition("mm:")
            files.append(f"{focal}{colon}{self.write(f'lens{number}.txt', text)}")
        port = {"type": "flat", "normal": [0, 0.1, 0.99], "sigma": {"normal_degrees": [1, 2]}}
        file = self.write("housing.json", json.dumps(housing or {"version": 1, "default": "main",
                                                                 "ports": {"main": port}}))
        given = options_of(images=str(self.folder / "images"), lenses=files, lens=files[0], housing=str(file))
        given.cameras, self.left_out = cameras.of(given, photographs.found_in(given.images).images)
        return given

    def failure(self, *arguments):
        with self.assertRaises(Failure) as raised:
            self.given(*arguments)
        return str(raised.exception)

    def sizes(self, given):
        return [len(one.names) for one in given.cameras]


class Groups(CamerasCase):
    def test_alike_photographs_are_one_camera(self):
        """All programs use pixels as they are stored, so that the orientation makes no camera. Neither do a rounded
        focal length and missing data."""
        for photos in ([(480, 360, 18)] * 3, [(480, 360, 18), (480, 360, 18, "", 6)],
                       [(480, 360, 180), (480, 360, 180.1), (480, 360)]):
            with self.subTest(photos):
                self.assertEqual(self.given(photos).cameras, [])

    def test_all_photographs_may_be_smaller_than_the_lens(self):
        given = self.given([(240, 180)] * 3)
        self.assertEqual([one.lens.parameters[:4] for one in given.cameras], [(150, 155, 125, 85)])

    def test_each_group_gets_its_lens(self):
        given = self.given([(480, 360, 18)] * 4 + [(480, 360, 24)] * 3 + [(360, 480, 18)] * 2)
        self.assertEqual(self.sizes(given), [4, 3, 2])
        cameras.write(given, self.folder)
        lines = (self.folder / "cameras" / "lenses.txt").read_text().splitlines()
        self.assertEqual(lines[0], "# focal_sigma 2 0.03")
        self.assertEqual(lines[1].split()[:6], ["1", "OPENCV", "480", "360", "300.0", "310.0"])
        self.assertEqual([float(word) for word in lines[2].split()[4:6]], [300 * (24 / 18), 310 * (24 / 18)])
        self.assertEqual(lines[3].split()[2:4], ["360", "480"])
        self.assertEqual((self.folder / "cameras" / "3.txt").read_text(), "7.jpg\n8.jpg\n")
        said = "\n".join(cameras.lines_about(given.cameras))
        self.assertIn("warning: 3 photographs are at 24 mm instead of 18 mm", said)
        self.assertIn("2 photographs are turned by a quarter", said)

    def test_photographs_without_a_lens_are_left_out_if_they_are_few(self):
        given = self.given([(480, 360, 18, "A")] * 4 + [(480, 300, 18, "A"), (480, 360, 18, "B")])
        self.assertEqual([one.names for one in given.cameras], [["0.jpg", "1.jpg", "2.jpg", "3.jpg"]])
        self.assertEqual(self.left_out, [
            "warning: 1 photographs are left out (4.jpg): they are of 480 x 300 pixels: no lens has this size or this "
            "ratio of the sides",
            "warning: 1 photographs are left out (5.jpg): they are of another camera, B: its lens is missing"])
        self.assertIn("has no lens for 4 of 6 photographs: 0.jpg, 1.jpg, 2.jpg and 1 more are of 480 x 360 pixels",
                      self.failure([(480, 360)] * 4 + [(480, 300)] * 2, "1 PINHOLE 480 300 9 9 9 9\n"))

    def test_each_camera_has_the_lens_of_its_size(self):
        given = self.given([(480, 360, 5, "B"), (480, 360, 5, "B"), (640, 480, 5, "A"), (320, 240, 5, "A")],
                           f"{TEXT}2 PINHOLE 640 480 700 700 320 240\n")
        found = {one.names[0]: one.lens.parameters[0] for one in given.cameras}
        self.assertEqual(found, {"0.jpg": 300, "2.jpg": 700, "3.jpg": 350})

    def test_focal_lengths_tell_lenses_of_one_size_apart(self):
        photos = [(480, 360, 18), (480, 360, 18), (480, 360, 24)]
        longer = TEXT.replace(" 300 310 ", " 400 410 ")
        for texts in ((longer, TEXT), (TEXT, longer), (TEXT + longer.replace("1", "2", 1),),
                      (f"18mm:{TEXT}", longer), (f"24mm:{longer}", f"18mm:{TEXT}")):
            given = self.given(photos, *texts)
            self.assertEqual([(len(one.names), one.lens.parameters[0], one.words) for one in given.cameras],
                             [(2, 300, ""), (1, 400, "")], texts)
        self.assertIn("state the focal length for which each was calibrated", self.failure(photos[:2], TEXT, longer))
        self.given(photos[:2], f"18mm:{TEXT}", f"24mm:{longer}")
        self.assertIn("warning: no photograph belongs to the lens of", self.left_out[0])

    def test_names_tell_cameras_of_one_kind_apart(self):
        for name in ("left/0", "left/1", "right/0", "right/1", "right/2"):
            self.write(f"images/{name}.jpg", jpeg(480, 360, 18, "A"))
        left, right = self.write("left.txt", TEXT), self.write("right.txt", TEXT.replace("1 OPENCV", "2 OPENCV"))
        ports = {name: {"type": "flat", "normal": [0, 0, 1]} for name in ("a", "b")}
        housing = self.write("housing.json", json.dumps({"version": 1, "ports": ports,
                                                         "cameras": {"1": "a", "2": "b"}}))
        given = options_of(images=str(self.folder / "images"), lenses=[f"left/:{left}", f"right/:{right}"],
                           lens=str(left), housing=str(housing))
        images = photographs.found_in(given.images).images
        given.cameras, left_out = cameras.of(given, images)
        self.assertEqual([(one.names[0], len(one.names), one.lens.number, one.words) for one in given.cameras],
                         [("right/0.jpg", 3, 2, ""), ("left/0.jpg", 2, 1, "")])
        self.assertEqual(left_out, [])
        self.assertEqual(cameras.housing_of(housing, given.cameras, 1)["cameras"], {"1": "b", "2": "a"})
        given.lenses = [f"left/:{left}", str(right)]  # a lens without a prefix is for all other photographs
        self.assertEqual([one.lens.number for one in cameras.of(given, images)[0]], [2, 1])
        same = self.write("same.txt", TEXT)
        for words, said in (([f"left/:{left}"], "has no lens for 3 of 5 photographs"),
                            ([f"left/:{left}", f"LEFT/:{right}", str(right)], "no photograph begins with LEFT/"),
                            ([f"left/:{left}", f"right/:{same}"], "camera 1 is in .* different numbers")):
            given.lenses = words
            with self.assertRaisesRegex(Failure, said):
                cameras.of(given, images)

    def test_other_lenses_for_the_same_photographs_begin_anew(self):
        """Features are those of COLMAP's cameras."""
        given = self.given([(480, 360, 18), (480, 360, 24)], f"18mm:{TEXT}", f"24mm:{TEXT}")
        before = next(iter(colmap_steps(given, self.folder)))
        given.lenses.reverse()
        self.assertNotEqual(next(iter(colmap_steps(given, self.folder))).settings, before.settings)

    def test_lenses_that_cannot_be_read_are_for_alike_photographs(self):
        self.assertEqual(self.given([(480, 360)] * 2, "").cameras, [])
        self.assertIn("the photographs have different sizes", self.failure([(480, 360), (240, 180)], ""))


class Rigs(InFolder):
    def test_refine_poses_reads_the_file_of_a_rig(self):
        file = self.write("rig_config.json", "[]")
        given = options_of(rig=os.path.relpath(file))
        control.check(given)
        self.assertEqual(given.rig, str(file))
        self.assertEqual(control.words(given, self.folder), ["--rig", str(file)])
        self.assertEqual(control.files_of(given, self.folder), [str(file)])
        given.rig = str(self.write("rigs.txt", ""))
        with self.assertRaisesRegex(Failure, "must be a file in the form of rig_config.json"):
            control.check(given)


class Turned(CamerasCase):
    PHOTOS = [(480, 360)] * 2 + [(360, 480)]

    def housing(self, given, quarters=1):
        return cameras.housing_of(given.housing, given.cameras, quarters)

    def test_the_port_is_turned_with_the_photographs(self):
        housing = self.housing(self.given(self.PHOTOS))
        self.assertEqual(housing["cameras"], {"2": "main turned"})
        self.assertEqual(housing["ports"]["main turned"]["normal"], [-0.1, 0, 0.99])
        self.assertEqual(housing["ports"]["main turned"]["sigma"], {"normal_degrees": [2, 1]})
        self.assertEqual(housing["ports"]["main"]["normal"], [0, 0.1, 0.99])
        other = cameras.turned_port({"type": "dome", "center_m": [1, 2, 3], "sigma": {"center_m": [4, 5, 6]}}, 3)
        self.assertEqual((other["center_m"], other["sigma"]["center_m"]), ([2, -1, 3], [5, 4, 6]))

    def test_entries_by_camera_and_photograph_are_kept(self):
        ports = {name: {"type": "flat", "normal": [0, value, 1]} for value, name in enumerate(("a", "b", "c"))}
        housing = {"version": 1, "default": "a", "ports": ports, "cameras": {"1": "b"}, "images": {"1.jpg": "none"}}
        found = self.housing(self.given(self.PHOTOS, housing=housing))
        self.assertEqual(found["cameras"], {"1": "b", "2": "b turned"})
        self.assertEqual(found["images"], {"1.jpg": "none"})
        housing["images"] = {"2.jpg": "c"}
        found = self.housing(self.given(self.PHOTOS, housing=housing))
        self.assertEqual(found["images"], {"2.jpg": "c turned"})
        self.assertEqual(found["ports"]["c turned"]["normal"], [-2, 0, 1])

    def choose(self, given, errors):
        """The side for which RefinePoses has these errors by its folder. Returns what was said."""
        script = "".join(f'case $2 in *{side}) echo {{\\"rms_after_px\\": {error}}} > $2/report.json ;; esac\n'
                         for side, error in errors.items())
        self.put_script("RefinePoses", f'mkdir -p "$2"\n{script}')
        (self.folder / "logs").mkdir(exist_ok=True)
        return self.said_by(turns.choose, given, self.folder,
                            lambda folder: [self.folder / "RefinePoses", "-o", folder])

    def test_the_turn_with_the_smaller_error_is_taken(self):
        given = self.given(self.PHOTOS)
        for errors, side, x in (({"right": 0.3, "left": 0.2}, "left", 0.1),
                                ({"right": 0.2, "left": 0.3}, "right", -0.1)):
            self.assertIn(f"turned to the {side} (RMS error 0.2 px, otherwise 0.3 px)", self.choose(given, errors))
            housing = json.loads(cameras.housing_file(given, self.folder).read_text())
            self.assertEqual(housing["ports"]["main turned"]["normal"], [x, 0, 0.99])
            lens = lenses.in_file(cameras.lens_file(given, self.folder))[1]
            self.assertEqual(lens.parameters[2:4], (360 - 170, 250) if side == "right" else (170, 480 - 250))
        self.assertEqual(self.choose(given, {}), "".join(
            f"    {self.folder}/RefinePoses -o {self.folder}/cameras/turned-{side}\n" for side in ("right", "left")))

    def test_a_symmetric_camera_is_not_tried(self):
        housing = {"version": 1, "default": "main", "ports": {"main": {"type": "flat", "normal": [0, 0, 1]}}}
        given = self.given(self.PHOTOS, "1 PINHOLE 480 360 300 300 240 180\n", housing=housing)
        self.assertEqual(self.choose(given, {}), "")
        self.assertTrue((self.folder / "cameras" / "lenses.txt").exists())


class WeakFeatures(Databases):
    def test_photographs_of_each_size_are_given_to_colmap_by_themselves(self):
        """COLMAP skips photographs of another size than the first one. With each of three thresholds."""
        file = self.database({name: (0, SHARP) for name in "abc"})
        with database.opened(file) as connection:
            connection.execute("INSERT INTO cameras VALUES (2, 4, 240, 180, NULL, 0)")
            connection.execute("UPDATE images SET camera_id = 2 WHERE name = 'b'")
        self.put_script("detector", f"cat $1 >> {self.folder}/seen; echo . >> {self.folder}/seen")
        (self.folder / "logs").mkdir()
        self.said_by(features.take_weak_features, file, lambda _, names, __: [self.folder / "detector", names],
                     self.folder)
        self.assertEqual((self.folder / "seen").read_text(), 3 * "b\n.\na\nc\n.\n")


class InARun(StandIns):
    def setUp(self):
        super().setUp()
        self.write("lens", "1 PINHOLE 4 3 9 9 2 1.5\n")
        for number in range(3, 5):
            self.write(f"images/{number}.png", png([bytes(8)] * 6))

    def test_several_sizes_reach_the_programs(self):
        said = self.succeeds("--until", "poses")
        self.assertIn("2 photographs are of another size (3.png, 4.png)", said)
        commands = self.commands()
        lists = [line.split("--image_list_path ")[1] for line in commands if "feature_extractor" in line]
        self.assertEqual(lists, [f"{self.folder}/out/cameras/{number}.txt" for number in (1, 2)])
        self.assertEqual(sum(f"--lens {self.folder}/out/cameras/lenses.txt" in line for line in commands), 2)
        self.assertIn("- 2 photographs are of another size", (self.folder / "out" / "report.md").read_text())
        self.assertEqual(self.done_before("--until", "poses"), 5)

    def test_a_photograph_without_a_lens_reaches_no_program(self):
        self.write("images/5.png", png([bytes(9)] * 4))
        self.assertIn("warning: 1 photographs are left out (5.png)", self.succeeds("--until", "poses"))
        listed = "".join((self.folder / "out" / "cameras" / f"{number}.txt").read_text() for number in (1, 2))
        self.assertEqual(listed.split(), [f"{number}.png" for number in range(5)])

    def test_a_changed_lens_is_noticed(self):
        self.succeeds("--until", "poses")
        self.write("lens", "1 PINHOLE 4 3 8 8 2 1.5\n")
        self.assertEqual(self.done_before("--until", "poses"), 0)
        self.assertIn("\n2 PINHOLE 8 6 16.0", (self.folder / "out" / "cameras" / "lenses.txt").read_text())

    def test_jobs_of_a_cluster_have_the_cameras(self):
        found = [cameras.Camera(["a"], LENS, "turned", 1), cameras.Camera(["b"], LENS)]
        again = cameras.from_json(json.loads(json.dumps(cameras.as_json(found))))
        self.assertEqual([one.names for one in again], [["a"], ["b"]])
        self.assertEqual(cameras.lens_lines(again, 3), cameras.lens_lines(found, 3))
        self.assertEqual(json.dumps(cameras.as_json(again)), json.dumps(cameras.as_json(found)))


@unittest.skipUnless(shutil.which("colmap"), "COLMAP is not installed")
class TwoSizes(ProgramTest):
    """A dive whose photographs have two sizes, from the photographs to the cloud. Both sizes are simulated with
    the same camera."""

    def test_the_lens_of_one_size_serves_both(self):
        for width in (480, 400):
            simulate(self.path(str(width)), "closeup", 6, (width, width * 3 // 4), "--tilt-degrees", 2)
        for number in range(3):
            name = f"000{number}.jpg"
            shutil.copyfile(self.path("400", "water", name), self.path("480", "water", name))
        write(self.path("positions.txt"), colmap_text.positions(pathlib.Path(self.path("480", "sparse"))))
        command = reconstruct_command(
            "--scale-from", f"positions:{self.path('positions.txt')}", "--until", "cloud",
            source=("--images", self.path("480", "water")), lens=self.path("480", "sparse", "cameras.txt"),
            housing=self.path("480", "housing.json"), out=self.path("out"))
        ended = subprocess.run(command, capture_output=True, text=True, timeout=600)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""), ended.stdout)
        self.assertIn("3 photographs are of another size", ended.stdout)
        self.assertIn("6 of 6 photographs have poses", ended.stdout)
        report = json.loads(read(self.path("out", "refined", "report.json")))
        self.assertLess(report["rms_after_px"], 0.5)
        self.succeeds("EvaluateReconstruction", "-i", self.path("out", "scene_dense.ply"), "-m",
                      self.path("480", "mesh.ply"), "--align", "centres", "--estimated",
                      self.path("out", "refined", "sparse"), "--cameras", self.path("480", "sparse"), "--json",
                      self.path("errors.json"))
        accuracy = json.loads(read(self.path("errors.json")))["accuracy"]
        print(f"measured: TwoSizes median {1e3 * accuracy['median']:.2f} mm, {accuracy['count']} points")
        self.assertLess(accuracy["median"], 0.001)


if __name__ == "__main__":
    main()
