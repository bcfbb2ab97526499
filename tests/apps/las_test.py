# SPDX-License-Identifier: GPL-3.0-or-later
"""TransformScene writes clouds as LAS, which a reader made from the specification alone (LAS) compares with PLY."""

import os
import struct

from places import FAR
from programs import ProgramTest, files_below, main, must, read, write
from readers import Ply
from worlds import TRIANGLE, Densified, geo_offset, ply

UTM = 32617  # the zone of FAR, north
TYPES = {1: "B", 2: "b", 3: "H", 4: "h", 5: "I", 6: "i", 7: "Q", 8: "q", 9: "f", 10: "d"}  # of extra bytes
COLORS = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))


def text(field):
    return field.split(b"\0", 1)[0].decode()


class Las:
    """A file of LAS 1.4 (specification R15) with points of the formats 6 or 7. `records`: the contents of variable
    length records by user and number; `points`: dictionaries of the fields and the extra bytes of a point; `places`:
    their coordinates."""
    FIELDS = {"stored": "3i", "intensity": "H", "returns": "B", "flags": "B", "classification": "B", "user": "B",
              "angle": "h", "source": "H", "time": "d"}
    COLOR = {"color": "3H"}

    def __init__(self, data):
        self.data = data
        signature, _, self.encoding, _, major, minor, _, self.software, self.day, self.year, size, begin, records, \
            self.format, length = struct.unpack_from("<4sHH16sBB32s32sHHHIIBH", data)
        assert (signature, major, minor, size) == (b"LASF", 1, 4, 375)
        self.legacy = struct.unpack_from("<6I", data, 107)
        numbers = struct.unpack_from("<12d", data, 131)
        self.scale, self.offset = numbers[:3], numbers[3:6]
        self.high, self.low = numbers[6::2], numbers[7::2]
        assert struct.unpack_from("<QQI", data, 227) == (0, 0, 0)  # waveforms, and records behind the points
        count, *self.by_return = struct.unpack_from("<16Q", data, 247)
        self.read_records(records, begin)
        self.read_points(begin, length, count)

    def read_records(self, count, begin):
        self.records, at = {}, 375
        for _ in range(count):
            _, user, number, size, _ = struct.unpack_from("<H16sHH32s", self.data, at)
            self.records[text(user), number] = self.data[at + 54:at + 54 + size]
            at += 54 + size
        assert at == begin
        self.extras, described = {}, self.records.get(("LASF_Spec", 4), b"")
        assert len(described) % 192 == 0
        for at in range(0, len(described), 192):
            kind, options, name = struct.unpack_from("<xxBB32s", described, at)
            assert options & 0b11110 == 0  # neither ranges nor scales
            no_data = struct.unpack_from("<d", described, at + 40)[0] if options & 1 else None
            self.extras[text(name)] = TYPES[kind], no_data

    def read_points(self, begin, length, count):
        fields = {**self.FIELDS, **(self.COLOR if self.format == 7 else {}),
                  **{name: kind for name, (kind, _) in self.extras.items()}}
        assert sum(struct.calcsize("<" + kind) for kind in fields.values()) == length
        assert len(self.data) == begin + count * length
        self.points = []
        for at in range(begin, len(self.data), length):
            point = {}
            for name, kind in fields.items():
                values = struct.unpack_from("<" + kind, self.data, at)
                point[name] = values if len(kind) > 1 else values[0]
                at += struct.calcsize("<" + kind)
            self.points.append(point)

    @property
    def places(self):
        return [tuple(a * scale + b for a, scale, b in zip(point["stored"], self.scale, self.offset))
                for point in self.points]


class Clouds(Densified):
    """A cloud of DensifyPointCloud with everything that it can hold, through a port."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        must("DensifyPointCloud", "-i", "scene.mvs", "-w", cls.at("water"), "--fusion-mode", "-1",
             "--estimate-uncertainty", "1", "--number-views-fuse", "2", "-o", "sure.mvs")

    def setUp(self):
        super().setUp()
        self.ply, self.las = self.at("water", "sure.ply"), self.path("cloud.las")

    def converted(self, *arguments):
        said = self.succeeds("TransformScene", "-i", self.ply, "-o", self.las, *arguments).stdout
        return Las(read(self.las)), said

    def check_places(self, las, places):
        """Stored in steps, and otherwise with the digits of a double."""
        self.assertEqual(las.scale, (1e-6,) * 3)
        for found, place in zip(las.places, places, strict=True):
            self.near(found, place, 0.51e-6)
        for axis, (low, high) in enumerate(zip(las.low, las.high)):
            found = [place[axis] for place in las.places]
            self.assertEqual((low, high), (min(found), max(found)))

    def test_every_property_of_a_cloud(self):
        cloud, (las, said) = Ply(read(self.ply)), self.converted()
        self.assertGreater(len(cloud.vertices), 1000)
        self.assertIn(f"{self.las}: {len(cloud.vertices)} points, x ", said)
        self.check_places(las, cloud.points)
        self.assertEqual((las.encoding, las.format, las.legacy, las.day, las.year), (16, 7, (0,) * 6, 0, 0))
        self.assertEqual(las.by_return, [len(cloud.vertices)] + 14 * [0])
        self.assertEqual(list(las.records), [("LASF_Spec", 4)])
        self.assertEqual(las.extras, {"NormalX": ("f", None), "NormalY": ("f", None), "NormalZ": ("f", None),
                                      "Views": ("H", None), "Error": ("f", 0.0), "Confidence": ("f", 0.0)})
        for point, vertex in zip(las.points, cloud.vertices, strict=True):
            self.assertEqual(point["color"], tuple(257 * vertex[name][0] for name in ("red", "green", "blue")))
            self.assertEqual(tuple(point[f"Normal{axis}"] for axis in "XYZ"),
                             tuple(vertex[f"n{axis}"][0] for axis in "xyz"))
            self.assertEqual(point["Views"], len(vertex["view_indices"]))
            self.assertEqual((point["Error"], point["Confidence"]), (vertex["error"][0], vertex["confidence"][0]))
            self.assertEqual((point["returns"], point["classification"], point["time"]), (0x11, 0, 0))
        self.assertGreater(max(point["Error"] for point in las.points), 0)
        again = self.path("again.las")
        self.succeeds("TransformScene", "-i", os.path.relpath(self.ply, self.folder), "-w", self.folder, "-o",
                      "again.las", "--max-threads", 1)
        self.assertEqual(read(again), read(self.las))

    def test_coordinates_of_a_reference_system(self):
        shift = "1 0 0 {}\n0 1 0 {}\n0 0 1 {}\n".format(*FAR)
        write(self.path("t.txt"), shift)
        self.succeeds("TransformScene", "-i", "sure.mvs", "-w", self.at("water"), "-p", "sure.ply", "-t",
                      self.path("t.txt"), "-o", self.path("utm.mvs"))
        self.ply = self.path("utm.ply")
        cloud = Ply(read(self.ply))
        self.assertIsNotNone(cloud.offset)
        las, said = self.converted("--epsg", UTM)
        self.assertNotIn("warning", said)
        self.check_places(las, cloud.places)
        wkt = las.records["LASF_Projection", 2112]
        self.assertTrue(wkt.endswith(b"]\0") and wkt.startswith(b'PROJCS["WGS 84 / UTM zone 17N"'), wkt)
        self.assertEqual(wkt.count(b"\0"), 1)
        # A program that dropped the offset: the scene's file states it.
        without = read(self.ply).replace(b"comment geo_offset", b"comment some_offset")
        write(self.ply, without)
        tells = f"{self.ply}: states no offset; its coordinates count from the scene's offset"
        self.assertNotIn(tells, said)
        again, said = self.converted("--epsg", UTM)
        self.assertEqual(again.places, las.places)
        self.assertIn(tells, said)


class SmallClouds(ProgramTest):
    def setUp(self):
        super().setUp()
        self.ply = self.path("cloud.ply")
        write(self.ply, ply([(1, 2, 3), (4.5, 5.25, 6)]))

    def las(self, *arguments):
        result = self.succeeds("TransformScene", "-i", self.ply, *arguments)
        return Las(read(self.path("cloud.las"))), result.stdout

    def test_positions_alone(self):
        las, _ = self.las()
        self.assertEqual((las.format, las.records), (6, {}))
        self.assertEqual(files_below(self.folder), {"cloud.ply", "cloud.las"})
        for found, place in zip(las.places, [(1, 2, 3), (4.5, 5.25, 6)], strict=True):
            self.near(found, place, 1e-9)  # whole steps

    def test_colors_alone(self):
        write(self.ply, ply([(1, 2, 3, 0, 128, 255)], more=COLORS))
        las, _ = self.las()
        self.assertEqual((las.format, las.points[0]["color"]), (7, (0, 32896, 65535)))

    def test_double_coordinates_keep_their_digits(self):
        points = [(534012.345678, 3378487.654321, -30.000001), (534013.0, 3378488.5, -29.5)]
        write(self.ply, ply(points, kind="double"))
        write(self.path("cloud.geo.json"), geo_offset(*FAR))  # of the scene; the cloud is in the world
        las, said = self.las("--epsg", UTM)
        self.assertNotIn("local coordinates", said)
        for found, place in zip(las.places, points, strict=True):
            self.near(found, place, 2e-9)  # twice the step of a double there

    def test_large_clouds_have_wider_steps(self):
        for length, step in ((5e3, 1e-5), (1e5, 1e-4), (1e6, 1e-3)):
            write(self.ply, ply([(0, 0, 0), (length, 0, 0)], kind="double"))
            las, said = self.las()
            self.assertEqual(las.scale, (step,) * 3)
            self.near(las.places[1], (length, 0, 0), 1e-8 + step / 1e3)

    def test_a_code_near_the_origin_is_doubtful(self):
        self.assertIn(f"--epsg {UTM}: the coordinates of {self.ply} are within 1 km", self.las("--epsg", UTM)[1])

    def test_refusals(self):
        convert = ("TransformScene", "-i", self.ply, "-o", self.path("out.las"))
        write(self.path("mesh.ply"), TRIANGLE)
        write(self.path("cloud.las"), "older")
        self.refuses_each(
            convert, (f"--transform-file: is for a scene, and --input-file {self.ply} is a cloud", "-t", "t.txt"),
            ("--mesh-file: is for a scene", "-m", "mesh.ply"), ("--refractive: is for a scene", "--refractive"),
            ("--epsg 99: is no coordinate reference system", "--epsg", 99),
            ("--epsg 4326: is no projected", "--epsg", 4326), ("--epsg", "--epsg", -1), ("--epsg", "--epsg", "x"))
        self.refuses_each(
            ("TransformScene", "-w", self.folder), ("is not a regular file", "-i", "none.ply"),
            ("mesh.ply: is a mesh, and LAS holds clouds", "-i", "mesh.ply"),
            ("a cloud is written as .las alone", "-i", "cloud.ply", "-o", "out.laz"),
            ("a cloud is written as .las alone", "-i", "cloud.ply", "-o", "out.ply"),
            ("only a cloud is written as .las", "-i", "scene.mvs", "-o", "out.las"))
        self.refuses_contents(
            self.path("cloud.geo.json"), convert, ("cloud.geo.json", "{"), ("geo_offset", '{"version": 1}'))
        for content, expected in ((ply([]), "has no points"), (ply([(1, 2, "nan")]), "vertex 0 has a position"),
                                  (ply([(1, 2, 3)]).replace("vertex 1", "vertex 3"), "truncated"),
                                  (ply([(0, 0, 0), (1e7, 0, 0)]), "its points are 1e+07 apart"),
                                  ("ply\n", "cloud.ply")):
            write(self.ply, content)
            self.refuses_and_keeps(expected, *convert)
        self.refuses_and_keeps("cloud.ply", *convert)
        os.symlink(self.ply, self.path("link.las"))
        self.refuses_and_keeps("--output-file", "TransformScene", "-i", self.ply, "-o", self.path("link.las"))

    def test_a_full_disk_leaves_the_older_file(self):
        write(self.ply, ply([(i, 0, 0) for i in range(4000)]))
        write(self.path("cloud.las"), "older")
        for limit in (100, 60000):  # the header, and the points
            self.refuses_and_keeps("cloud.las: cannot be written", "TransformScene", "-i", self.ply,
                                   file_size_limit=limit)


if __name__ == "__main__":
    main()
