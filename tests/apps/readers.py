# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of the files that the programs write, from the descriptions of the formats (docs/formats.md) and
without the programs under test: PLY, .mvs, .dmap, glTF, PNG and COLMAP's text models. geotiff.py reads maps."""

import array
import json
import math
import os
import pathlib
import re
import struct
import zlib

from programs import read
from support import colmap_text


class Ply:
    """A PLY file, ascii or binary little-endian. `vertices` and `faces`: dictionaries of tuples by property;
    `points`: the coordinates of the vertices; `triangles`: the vertices of the faces; `header`: its lines
    without comments; `offset`: the geo_offset or None; `body`: the bytes behind the header."""
    KINDS = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "int": "i", "int32": "i", "uint": "I",
             "uint32": "I", "float": "f", "float32": "f", "double": "d", "float64": "d"}

    def __init__(self, data):
        head, self.body = data.split(b"end_header\n", 1)
        lines = head.decode().splitlines()
        self.header = [line for line in lines if not line.startswith("comment")]
        offset = [line.split()[2:] for line in lines if line.startswith("comment geo_offset ")]
        self.offset = tuple(map(float, offset[0])) if offset else None
        self.at, self.words = 0, iter(self.body.split()) if "format ascii 1.0" in self.header else None
        elements = []
        for words in map(str.split, self.header):
            if words[0] == "element":
                elements.append((words[1], int(words[2]), []))
            elif words[0] == "property":
                *length, kind = (self.KINDS[kind] for kind in words[1:-1] if kind != "list")
                runs = elements[-1][2]
                if length or not runs or runs[-1][2]:
                    runs.append([[words[-1]], kind, length])
                else:
                    runs[-1][0].append(words[-1])
                    runs[-1][1] += kind
        rows = {name: [self.row(runs) for _ in range(count)] for name, count, runs in elements}
        assert self.words or self.at == len(self.body)
        self.vertices, self.faces = rows["vertex"], rows.get("face", [])

    def row(self, runs):
        """`runs`: names and kinds of numbers that follow each other, or of a list with the kind of its length."""
        found = {}
        for names, kinds, length in runs:
            if length:
                found[names[0]] = self.values(kinds * self.values(length[0])[0])
            else:
                found.update(zip(names, zip(self.values(kinds))))
        return found

    def values(self, kinds):
        if self.words:
            return tuple(float(word) if kind in "fd" else int(word) for kind, word in zip(kinds, self.words))
        found = struct.unpack_from("<" + kinds, self.body, self.at)
        self.at += struct.calcsize("<" + kinds)
        return found

    @property
    def points(self):
        return [(v["x"][0], v["y"][0], v["z"][0]) for v in self.vertices]

    @property
    def triangles(self):
        return [face["vertex_indices"] for face in self.faces]

    @property
    def places(self):
        """The coordinates in the world."""
        return [added(point, self.offset or (0, 0, 0)) for point in self.points]


class Mvs:
    """A scene of version 7. `platforms`: (cameras, poses); `names` and `masks` of the images; `ids`: platform,
    camera, pose and ID of each image; `points`: (coordinates, images)."""

    def __init__(self, data):
        assert data[:8] == b"MVSI" + struct.pack("<I", 7)
        self.data, self.at = data, 12
        self.platforms = [self.platform() for _ in range(self.number("Q"))]
        images = [self.image() for _ in range(self.number("Q"))]
        self.names, self.masks, self.ids = zip(*images)
        self.points = [(self.numbers("3f"), [self.numbers("If")[0] for _ in range(self.number("Q"))])
                       for _ in range(self.number("Q"))]

    def numbers(self, kind):
        values = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += struct.calcsize("<" + kind)
        return values

    def number(self, kind):
        return self.numbers(kind)[0]

    def string(self):
        length = self.number("Q")
        self.at += length
        return self.data[self.at - length:self.at].decode()

    def platform(self):
        self.string()
        cameras = []
        for _ in range(self.number("Q")):
            self.string(), self.string()
            cameras.append((self.numbers("2I"), self.numbers("9d")))
            self.numbers("12d")
        return cameras, [(self.numbers("9d"), self.numbers("3d")) for _ in range(self.number("Q"))]

    def image(self):
        name, mask, ids = self.string(), self.string(), self.numbers("4I")
        self.numbers("3f")
        for _ in range(self.number("Q")):
            self.numbers("2I4f")
        return name, mask, ids

    def camera(self, image):
        """Size, K, R and C of an image; None if the image has no pose."""
        platform, camera, pose, _ = self.ids[image]
        if pose == 0xFFFFFFFF:
            return None
        cameras, poses = self.platforms[platform]
        return *cameras[camera], *poses[pose]

    @property
    def cameras(self):
        return [self.camera(image) for image in range(len(self.names))]

    def project(self, image, point):
        """The pixel (x, y) and the z-depth of a point."""
        _, k, r, c = self.camera(image)
        x, y, z = (sum(r[3 * i + j] * (point[j] - c[j]) for j in range(3)) for i in range(3))
        return k[0] * x / z + k[2], k[4] * y / z + k[5], z


def with_paths(scene, change):
    """The bytes of a .mvs with the path of each image replaced by `change`(path)."""
    for path in Mvs(scene).names:
        before, after = (struct.pack("<Q", len(text.encode())) + text.encode() for text in (path, change(path)))
        assert scene.count(before) == 1
        scene = scene.replace(before, after)
    return scene


class Dmap:
    """A depth map of OpenMVS."""

    def __init__(self, data):
        self.content = data[2]
        self.image = struct.unpack_from("<II", data, 4)
        self.size = struct.unpack_from("<II", data, 12)
        self.range = struct.unpack_from("<ff", data, 20)
        length = struct.unpack_from("<H", data, 28)[0]
        self.name = data[30:30 + length]
        at = 30 + length
        count = struct.unpack_from("<I", data, at)[0]
        self.ids = struct.unpack_from(f"<{count}I", data, at + 4)
        at += 4 + 4 * count
        self.camera = list(struct.unpack_from("<21d", data, at))  # K, R, C
        at += 21 * 8
        pixels = self.size[0] * self.size[1]
        self.depths = data[at:at + 4 * pixels]
        self.normals = data[at + 4 * pixels:at + 16 * pixels]
        self.rest = data[at + 16 * pixels:]

    @property
    def rows(self):
        """The depths, row by row."""
        width, height = self.size
        depths = struct.unpack(f"<{width * height}f", self.depths)
        return [depths[y * width:(y + 1) * width] for y in range(height)]

    def bytes(self, normals=True):
        content = self.content if normals else self.content & ~2
        return (b"DR" + struct.pack("<BBIIIIff", content, 0, *self.image, *self.size, *self.range)
                + struct.pack("<H", len(self.name)) + self.name
                + struct.pack(f"<I{len(self.ids)}I", len(self.ids), *self.ids)
                + struct.pack("<21d", *self.camera) + self.depths
                + (self.normals if normals else b"") + self.rest)


class ColmapModel:
    """A binary model of COLMAP. `cameras`: number of the camera model, width, height and parameters by id; `images`:
    quaternion, translation, camera, name and observations (x, y, point) by id; `points`: coordinates, colour, error
    and track (image, observation) by id."""
    PARAMETERS = {1: 4}  # PINHOLE

    def __init__(self, folder):
        parts = [read(os.path.join(folder, name + ".bin")) for name in ("cameras", "images", "points3D")]
        self.cameras, self.images, self.points = map(self.records, parts, (self.camera, self.image, self.point))

    def records(self, data, record):
        self.data, self.at = data, 0
        found = dict(record() for _ in range(self.numbers("Q")[0]))
        assert self.at == len(data)
        return found

    def numbers(self, kinds):
        values = struct.unpack_from("<" + kinds, self.data, self.at)
        self.at += struct.calcsize("<" + kinds)
        return values

    def rows(self, kinds):
        return [self.numbers(kinds) for _ in range(self.numbers("Q")[0])]

    def camera(self):
        key, model, width, height = self.numbers("IiQQ")
        return key, (model, width, height, self.numbers(f"{self.PARAMETERS[model]}d"))

    def image(self):
        key, *pose, camera = self.numbers("I7dI")
        end = self.data.index(b"\0", self.at)
        name, self.at = self.data[self.at:end].decode(), end + 1
        return key, (pose[:4], pose[4:], camera, name, self.rows("ddQ"))

    def point(self):
        key, x, y, z, *color, error = self.numbers("Q3d3Bd")
        return key, ((x, y, z), tuple(color), error, self.rows("II"))

    def project(self, image, place):
        """The pixel (x, y) of a place in an image of a pinhole, with pixel centres at 0.5, and the z-depth."""
        turn, shift, camera, *_ = self.images[image]
        x, y, z = added(rotated(turn, place), shift)
        _, _, _, (fx, fy, cx, cy) = self.cameras[camera]
        return fx * x / z + cx, fy * y / z + cy, z


class Glb:
    """A binary glTF 2.0."""

    def __init__(self, data):
        magic, version, length, json_length, json_kind = struct.unpack_from("<4sIII4s", data)
        assert (magic, version, length, json_kind) == (b"glTF", 2, len(data), b"JSON")
        self.json = json.loads(data[20:20 + json_length])
        at = 20 + json_length
        binary_length, binary_kind = struct.unpack_from("<I4s", data, at)
        assert binary_kind == b"BIN\0" and at % 4 == 0 and at + 8 + binary_length == len(data)
        self.binary = data[at + 8:]

    def view(self, index):
        view = self.json["bufferViews"][index]
        begin = view.get("byteOffset", 0)
        assert begin % 4 == 0 and begin + view["byteLength"] <= len(self.binary)
        return self.binary[begin:begin + view["byteLength"]]

    def values(self, index):
        """The accessor's numbers, one after the other."""
        accessor = self.json["accessors"][index]
        result = array.array({5126: "f", 5125: "I"}[accessor["componentType"]],
                             self.view(accessor["bufferView"]))
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        assert len(result) == width * accessor["count"]
        return result

    def bounds(self, primitive):
        """The lowest and the highest corner of a primitive, which its accessor has to state."""
        stated = self.json["accessors"][primitive["attributes"]["POSITION"]]
        positions = self.values(primitive["attributes"]["POSITION"])
        found = [[of(positions[k::3]) for k in range(3)] for of in (min, max)]
        assert found == [stated["min"], stated["max"]]
        return found


def png_size(data):
    return struct.unpack_from(">II", data, 16)


def png_samples(data):
    """The size and the number of channels of a PNG of 8 bits in grey, RGB or RGBA, and its bytes, which have to be
    complete: a filter and the samples of each row."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height, bits, kind = struct.unpack_from(">IIBB", data, 16)
    assert bits == 8
    channels, at, packed = {0: 1, 2: 3, 6: 4}[kind], 8, b""
    while at < len(data):
        length, name = struct.unpack_from(">I4s", data, at)
        packed += data[at + 8:at + 8 + length] if name == b"IDAT" else b""
        at += 12 + length
    raw = zlib.decompress(packed)
    assert len(raw) == height * (1 + channels * width)
    return width, height, channels, raw


def png_rows(data):
    """The rows of samples, and the number of channels."""
    width, _, channels, raw = png_samples(data)
    stride = channels * width
    rows, above = [], bytes(stride)
    for start in range(0, len(raw), 1 + stride):
        row = bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride) if raw[start] else ():
            left, up = row[i - channels] if i >= channels else 0, above[i]
            corner = above[i - channels] if i >= channels else 0
            paeth = min((left, up, corner), key=lambda value: abs(left + up - corner - value))
            row[i] = (row[i] + (0, left, up, (left + up) // 2, paeth)[raw[start]]) & 255
        rows.append(bytes(row))
        above = row
    return rows, channels


def added(x, shift):
    return tuple(a + b for a, b in zip(x, shift))


def rotated(q, v):
    """R(q) v for a unit quaternion q = (w, x, y, z)."""
    w, x, y, z = q
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
    return tuple(math.fsum(a * b for a, b in zip(row, v)) for row in rows)


def records(path):
    """The lines of a file of a COLMAP text model, without comments."""
    return [line for line in colmap_text.records(pathlib.Path(path)) if line]


def image_lines(path):
    """Pairs of lines of images.txt: pose and observations. A line of observations may be empty."""
    lines = colmap_text.records(pathlib.Path(path))
    return list(zip(lines[0::2], lines[1::2]))


def centres_of(model):
    """Camera centres by image name."""
    return colmap_text.centres(pathlib.Path(model))


def points_of(model):
    return {int(words[0]): tuple(float(w) for w in words[1:4]) for words in
            (line.split(" ") for line in records(os.path.join(model, "points3D.txt")))}


def shown_scene(page):
    """The description of the scene in a page of ViewScene, data/scene.js."""
    text = read(os.path.join(page, "data", "scene.js")).decode()
    return json.loads(re.fullmatch(r"axialData\.scene\((.*)\);\n", text, re.S)[1])
