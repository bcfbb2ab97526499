# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by several test scripts: a small densified scene, and depth maps in OpenMVS's format and
clouds, read field by field."""

import os
import shutil
import struct
import tempfile

from programs import ProgramTest, cloud_size, files_below, read, run

QUICK = ("--resolution-level", "1", "--min-resolution", "100", "--iters", "1",
         "--number-views-fuse", "2")


class Dmap:
    """A .dmap field by field (docs/formats.md)."""

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

    def bytes(self, normals=True):
        content = self.content if normals else self.content & ~2
        return (b"DR" + struct.pack("<BBIIIIff", content, 0, *self.image, *self.size, *self.range)
                + struct.pack("<H", len(self.name)) + self.name
                + struct.pack(f"<I{len(self.ids)}I", len(self.ids), *self.ids)
                + struct.pack("<21d", *self.camera) + self.depths
                + (self.normals if normals else b"") + self.rest)


class Scene(ProgramTest):
    """Five small views of the close-up scene, in air and under water, densified once."""
    VIEWS = 5
    MEDIA = ("air", "water")
    SAMPLES = 2
    FUSE = ("--fusion-mode", "-1")

    @classmethod
    def setUpClass(cls):
        if cls is Scene:
            return
        cls.shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.truth = os.path.join(cls.shared.name, "closeup")
        cls.must("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views",
                 cls.VIEWS, "--width", 320, "--height", 240, "--truth", 0, "--samples", cls.SAMPLES,
                 "--medium", cls.MEDIA[0] if len(cls.MEDIA) == 1 else "both", "-o", cls.truth)
        for medium in cls.MEDIA:
            port = ["--housing", os.path.join(cls.truth, "housing.json")] if medium == "water" else []
            cls.must("InterfaceCOLMAP", "-i", cls.truth, "--image-folder",
                     os.path.join(cls.truth, medium), "-o", cls.densified(medium, "scene.mvs"), *port)
            cls.must("DensifyPointCloud", "-i", "scene.mvs", "-w", cls.densified(medium), *QUICK)

    @classmethod
    def must(cls, *command):
        result = run(*command)
        assert result.returncode == 0, result.stderr
        return result

    @classmethod
    def densified(cls, medium, *name):
        return os.path.join(cls.shared.name, medium, *name)

    def copy(self, medium, *leave_out):
        """A copy of the densified folder without files whose names end in one of `leave_out`."""
        self.folder = self.shared.name  # maps hold relative image paths
        folder = self.path("copy")
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.densified(medium), folder)
        for name in files_below(folder):
            if name.endswith(leave_out):
                os.remove(os.path.join(folder, name))
        return folder

    def command(self, folder, *arguments):
        quick = [word for i in range(0, len(QUICK), 2) if QUICK[i] not in arguments
                 for word in QUICK[i:i + 2]]
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *quick, *arguments)

    def maps(self, folder):
        return {name: (read(os.path.join(folder, name)),
                       os.stat(os.path.join(folder, name)).st_mtime_ns)
                for name in files_below(folder) if ".dmap" in name}

    def cloud(self, folder):
        return read(os.path.join(folder, "scene_dense.ply"))

    def fuse(self, folder, *arguments):
        """Fuses the existing maps, and checks that no map changes, appears or disappears. Returns
        the output."""
        before = self.maps(folder)
        said = self.succeeds(*self.command(folder, *self.FUSE, *arguments)).stdout
        self.assertEqual(self.maps(folder), before)
        return said


def dmap_names():
    return [f"depth{i:04}.dmap" for i in range(Scene.VIEWS)]


class Cloud:
    """The vertices of a PLY that our programs wrote, as dictionaries of tuples."""
    SIZES = {"float32": "f", "uint8": "B", "uint32": "I"}

    def __init__(self, data):
        header, body = data.split(b"end_header\n", 1)
        self.fields = [line.split()[1:] for line in header.decode().splitlines()
                       if line.startswith("property")]
        self.points, at = [], 0
        for _ in range(cloud_size(data)):
            point = {}
            for kind, *rest in self.fields:
                count, item = 1, kind
                if kind == "list":
                    count, item = body[at], rest[1]
                    at += 1
                point[rest[-1]] = struct.unpack_from(f"<{count}{self.SIZES[item]}", body, at)
                at += struct.calcsize(f"<{count}{self.SIZES[item]}")
            self.points.append(point)
        assert at == len(body)


def position(point):
    return tuple(point[axis][0] for axis in "xyz")


def ascii_ply(points, with_views=True):
    """An ASCII PLY. `points`: pairs of (x, y, z) and [image indices]."""
    lists = "property list uchar uint view_indices\n" if with_views else ""
    lines = [" ".join(map(str, (*xyz, *((len(views), *views) if with_views else ()))))
             for xyz, views in points]
    return (f"ply\nformat ascii 1.0\nelement vertex {len(points)}\nproperty float x\n"
            f"property float y\nproperty float z\n{lists}end_header\n" + "\n".join(lines) + "\n")
