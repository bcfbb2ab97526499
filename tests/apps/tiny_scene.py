# SPDX-License-Identifier: GPL-3.0-or-later
"""A COLMAP model with images, small enough to be written by every test, and .mvs files. Both are
written field by field from the descriptions of the formats, not by the programs under test."""

import functools
import os
import random
import struct

from programs import ProgramTest, png, read, write

WIDTH, HEIGHT, FOCAL = 96, 72, 90.0
DISTANCE = 1.0  # from the cameras to the wall [m]
CENTRES = [(-0.12, 0.0, 0.0), (0.0, 0.02, 0.0), (0.12, 0.0, 0.0)]
CX, CY = WIDTH / 2, HEIGHT / 2  # pixel centres at 0.5


@functools.cache
def texture(seed=5, size=64):
    """A texture of blobs of two sizes: a function of (x, y) in metres with values in [0, 1]."""
    rng = random.Random(seed)
    layers = [(scale, [[rng.random() for _ in range(size)] for _ in range(size)])
              for scale in (25, 50)]

    def value(x, y):
        total = 0.0
        for scale, grid in layers:
            u, v = x * scale + 1000, y * scale + 1000
            i, j = int(u), int(v)
            a, b = u - i, v - j
            at = lambda p, q: grid[q % size][p % size]
            total += ((at(i, j) * (1 - a) + at(i + 1, j) * a) * (1 - b) +
                      (at(i, j + 1) * (1 - a) + at(i + 1, j + 1) * a) * b)
        return total / len(layers)

    return value


@functools.cache
def picture(centre, width=WIDTH, height=HEIGHT, only_red=False):
    """A PNG of the wall at z = DISTANCE, seen in air along +z from `centre`."""
    value = texture()
    focal = FOCAL * width / WIDTH
    rows = []
    for v in range(height):
        row = []
        for u in range(width):
            x = centre[0] + (u + 0.5 - width / 2) / focal * DISTANCE
            y = centre[1] + (v + 0.5 - height / 2) / focal * DISTANCE
            grey = int(255 * value(x, y))
            row += [grey, 0, 0] if only_red else [grey, 255 - grey, (grey * 3) % 256]
        rows.append(row)
    return png(rows, 2)


def sparse_points():
    """((x, y, z), [image indices]) of points on the wall that all images see."""
    rng = random.Random(11)
    return [((rng.uniform(-0.25, 0.25), rng.uniform(-0.25, 0.25), DISTANCE), [0, 1, 2])
            for _ in range(60)]


def names():
    return [f"{i:04d}.png" for i in range(len(CENTRES))]


def write_colmap(folder, camera=None):
    """Writes images and a text model (image ids 1, 2, 3, camera 1) to `folder`/{images,sparse}."""
    for centre, name in zip(CENTRES, names()):
        write(os.path.join(folder, "images", name), picture(centre))
    camera = camera or f"PINHOLE {WIDTH} {HEIGHT} {FOCAL} {FOCAL} {CX} {CY}"
    write(os.path.join(folder, "sparse", "cameras.txt"), f"1 {camera}\n")
    points = sparse_points()
    lines = []
    for i, (centre, name) in enumerate(zip(CENTRES, names())):
        t = [-c for c in centre]
        lines.append(f"{i + 1} 1 0 0 0 {t[0]} {t[1]} {t[2]} 1 {name}")
        observations = []
        for k, ((x, y, z), _) in enumerate(points):
            u = FOCAL * (x - centre[0]) / z + CX
            v = FOCAL * (y - centre[1]) / z + CY
            observations.append(f"{u} {v} {k + 1}")
        lines.append(" ".join(observations))
    write(os.path.join(folder, "sparse", "images.txt"), "\n".join(lines) + "\n")
    write(os.path.join(folder, "sparse", "points3D.txt"), "".join(
        f"{k + 1} {p[0]} {p[1]} {p[2]} 200 100 50 0.1 " +
        " ".join(f"{i + 1} {k}" for i in views) + "\n" for k, (p, views) in enumerate(points)))


IDENTITY = (1, 0, 0, 0, 1, 0, 0, 0, 1)


def mvs(image_paths, *, k=None, size=(WIDTH, HEIGHT), rotation=IDENTITY, centres=None, version=7,
        platform=0, camera=0, pose=None, view=None, points=None):
    """The bytes of a .mvs scene. Arguments may be wrong, to test how programs refuse them."""
    string = lambda s: struct.pack("<Q", len(s.encode())) + s.encode()
    count = lambda n: struct.pack("<Q", n)
    k = k or (FOCAL, 0, CX - 0.5, 0, FOCAL, CY - 0.5, 0, 0, 1)
    centres = centres or CENTRES
    points = sparse_points() if points is None else points
    out = b"MVSI" + struct.pack("<II", version, 0)
    out += count(1) + string("platform") + count(1) + string("camera") + string("")
    out += struct.pack("<II", *size) + struct.pack("<9d", *k)
    out += struct.pack("<9d", *IDENTITY) + struct.pack("<3d", 0, 0, 0)
    out += count(len(centres))
    for c in centres:
        out += struct.pack("<9d", *rotation) + struct.pack("<3d", *c)
    out += count(len(image_paths))
    for i, path in enumerate(image_paths):
        out += string(path) + string("")
        out += struct.pack("<IIII", platform, camera, i if pose is None else pose, i)
        out += struct.pack("<fff", 0, 0, 0) + count(0)
    out += count(len(points))
    for position, views in points:
        out += struct.pack("<3f", *position) + count(len(views))
        for i in views:
            out += struct.pack("<If", i if view is None else view, 0)
    out += count(0) * 2  # normals, colours
    out += count(0) * 3  # lines
    out += struct.pack("<16d", *(1.0 if i % 5 == 0 else 0.0 for i in range(16)))
    out += struct.pack("<9d", *IDENTITY) + struct.pack("<6d", *([0.0] * 6))
    return out


DENSIFY = ("DensifyPointCloud", "--max-threads", "1", "--resolution-level", "0", "--iters", "1",
           "--geometric-iters", "0", "--number-views-fuse", "2")


class TinyScene(ProgramTest):
    """Writes colmap/{images,sparse} and work/scene.mvs."""

    def setUp(self):
        super().setUp()
        write_colmap(self.path("colmap"))
        self.work, self.scene = self.path("work"), self.path("work", "scene.mvs")
        self.images = [self.path("colmap", "images", name) for name in names()]
        write(self.scene, mvs(self.images))

    def put_restored(self, **more):
        """Red pictures of the wall in work/restored, in the place of photographs without water."""
        for centre, name in zip(CENTRES, names()):
            write(self.path("work", "restored", name), picture(centre, only_red=True, **more))

    def densify(self, *arguments):
        return (*DENSIFY, "-i", self.scene, "-w", self.work, *arguments)

    def command(self, program, *arguments):
        return (program, "-i", self.scene, "-w", self.work, *arguments)

    def at(self, *name):
        return read(self.path("work", *name))

    def makes(self, *command):
        """The names of the files that a command adds to the folder of the scene, and its output."""
        made, said = self.new_files(self.work, *command)
        return set(made), said
