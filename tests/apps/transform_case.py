# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the tests of TransformScene: the scene, its files, and readers of the outputs."""

import json
import re
import struct

import tiny_scene
from programs import read, write

TURN = ((0.36, 0.48, -0.8), (-0.8, 0.60, 0.0), (0.48, 0.64, 0.60))  # a rotation in exact decimals
SHIFT = (1.5, -2.25, 0.75)
UTM = (512345.25, 5412345.5, 105.75)
PORT = {"type": "flat", "normal": [0, 0, 1], "distance_m": 0.02, "thickness_m": 0.005,
        "n_glass": 1.49, "n_water": 1.333}


def times(matrix, x):
    return tuple(sum(a * b for a, b in zip(row, x)) for row in matrix)


def moved(x, scale=1, shift=SHIFT):
    return tuple(scale * a + b for a, b in zip(times(TURN, x), shift))


def matrix_text(scale=1, shift=SHIFT, turn=TURN):
    return "".join(" ".join(repr(scale * a) for a in row) + f" {b!r}\n"
                   for row, b in zip(turn, shift))


def inverse_text(scale=1, shift=SHIFT):
    back = tuple(zip(*TURN))
    return matrix_text(1 / scale, tuple(-a / scale for a in times(back, shift)), back)


class Mvs:
    """The cameras, poses and points of a .mvs with one camera on each platform, field by field."""

    def __init__(self, data):
        self.data, self.at = data, 12
        self.k, self.poses, self.images = [], [], []
        for _ in range(self.count()):
            self.string()
            assert self.count() == 1
            self.string(), self.string()
            size = self.take("<II")
            k = self.take("<9d")
            self.take("<12d")
            poses = [(self.take("<9d"), self.take("<3d")) for _ in range(self.count())]
            self.k.append((size, k, poses))
        for _ in range(self.count()):
            name = self.string()
            self.string()
            platform, _, pose, _ = self.take("<4I")
            self.take("<3f")
            for _ in range(self.count()):
                self.take("<II4f")
            size, k, poses = self.k[platform]
            self.images.append(name)
            self.poses.append((size, k, *poses[pose]))
        self.points = []
        for _ in range(self.count()):
            self.points.append(self.take("<3f"))
            for _ in range(self.count()):
                self.take("<If")

    def take(self, kind):
        values = struct.unpack_from(kind, self.data, self.at)
        self.at += struct.calcsize(kind)
        return values

    def count(self):
        return self.take("<Q")[0]

    def string(self):
        length = self.count()
        self.at += length
        return self.data[self.at - length:self.at].decode()

    def pixel(self, image, x):
        _, k, r, c = self.poses[image]
        d = [a - b for a, b in zip(x, c)]
        p = [sum(r[3 * i + j] * d[j] for j in range(3)) for i in range(3)]
        return k[0] * p[0] / p[2] + k[2], k[4] * p[1] / p[2] + k[5]


def ply_points(data):
    """The positions of an ascii or binary little-endian PLY whose vertices come first, and its
    offset."""
    head, body = data.split(b"end_header\n", 1)
    head = head.decode()
    count = int(re.search(r"element vertex (\d+)", head)[1])
    vertex = head.split("element vertex")[1].split("element")[0]
    kinds = {"float": "f", "float32": "f", "double": "d", "float64": "d", "uchar": "B",
             "uint8": "B"}
    row = "<" + "".join(kinds[kind] for kind in re.findall(r"property (\w+) \w+\n", vertex))
    offset = re.search(r"comment geo_offset (\S+) (\S+) (\S+)", head)
    if "format ascii" in head:
        rows = [tuple(map(float, line.split())) for line in body.decode().splitlines()[:count]]
    else:
        rows = [struct.unpack_from(row, body, i * struct.calcsize(row)) for i in range(count)]
    return rows, tuple(map(float, offset.groups())) if offset else None


def ascii_ply(kind, vertices, faces=(), more_vertex="", more_face="", comments=""):
    return (f"ply\nformat ascii 1.0\n{comments}element vertex {len(vertices)}\n"
            + "".join(f"property {kind} {axis}\n" for axis in "xyz") + more_vertex
            + (f"element face {len(faces)}\nproperty list uchar int vertex_indices\n{more_face}"
               if faces else "") + "end_header\n"
            + "".join(" ".join(map(repr, row)) + "\n" for row in vertices)
            + "".join(" ".join(map(str, row)) + "\n" for row in faces))


CUBE = [(x, y, z) for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
CUBE_FACES = [(3, 0, 2, 1), (3, 1, 2, 3), (3, 4, 5, 6), (3, 5, 7, 6), (3, 0, 1, 4), (3, 1, 5, 4),
              (3, 2, 6, 3), (3, 3, 6, 7), (3, 0, 4, 2), (3, 2, 4, 6), (3, 1, 3, 5), (3, 3, 7, 5)]


class Transform(tiny_scene.TinyScene):
    def setUp(self):
        super().setUp()
        self.cloud, self.mesh = self.path("work", "cloud.ply"), self.path("work", "mesh.ply")
        points = [x for x, _ in tiny_scene.sparse_points()]
        write(self.cloud, ascii_ply("float", [(*x, 0.0, 0.0, -1.0) for x in points],
                                    more_vertex="".join(f"property float n{a}\n" for a in "xyz")))
        write(self.mesh, ascii_ply("float", points, [(3, 0, 1, 2), (3, 2, 1, 3)]))
        write(self.path("t.txt"), matrix_text(2.5))

    def transform(self, *arguments, scene="scene.mvs", output="moved.mvs"):
        return self.succeeds("TransformScene", "-i", scene, "-w", self.work, "-o", output,
                             *arguments)

    def refused(self, expected, *arguments):
        self.refuses(expected, "TransformScene", "-i", "scene.mvs", "-w", self.work, "-o",
                     "moved.mvs", *arguments)

    def at(self, name):
        return read(self.path("work", name))

    def near(self, found, expected, within):
        for a, b in zip(found, expected, strict=True):
            self.assertLess(abs(a - b), within)

    def port(self, port):
        write(self.path("work", "scene.housing.json"), json.dumps(
            {"version": 1, "ports": {"main": port}, "default": "main"}))
