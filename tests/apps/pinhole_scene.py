# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the tests of --pinhole-export: a scene under water that is densified and exported, and
.mvs scenes read field by field."""

import os
import shutil
import struct
import tempfile

from programs import ProgramTest, run

VIEWS = 5
QUICK = ("--resolution-level", "1", "--min-resolution", "100", "--iters", "1",
         "--number-views-fuse", "2")


class Reader:
    """Reads a .mvs scene of version 7 field by field (docs/formats.md)."""

    def __init__(self, data):
        assert data[:8] == b"MVSI" + struct.pack("<I", 7)
        self.data, self.at = data, 12
        self.platforms = [self.platform() for _ in range(self.number("Q"))]
        self.images = [self.image() for _ in range(self.number("Q"))]
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
        platform, camera, pose, _ = self.images[image][2]
        if pose == 0xFFFFFFFF:
            return None
        cameras, poses = self.platforms[platform]
        return *cameras[camera], *poses[pose]


def image_size(scene, image):
    return scene.camera(image)[0]


def project(camera, point):
    """The pixel (x, y) and the z-depth of a point."""
    _, k, r, c = camera
    x, y, z = (sum(r[3 * i + j] * (point[j] - c[j]) for j in range(3)) for i in range(3))
    return k[0] * x / z + k[2], k[4] * y / z + k[5], z


class Exports(ProgramTest):
    """The close-up scene under water, densified and exported once."""

    @classmethod
    def setUpClass(cls):
        if cls is Exports:
            return
        cls.shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.truth = cls.at("closeup")
        cls.must("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views", VIEWS,
                 "--width", 320, "--height", 240, "--medium", "water", "--samples", 2, "--truth", 0,
                 "-o", cls.truth)
        cls.make_scene(cls.at("work"))
        cls.must(*cls.command(cls.at("work"), "--pinhole-export", "pinholes"))

    @classmethod
    def at(cls, *names):
        return os.path.join(cls.shared.name, *names)

    @classmethod
    def must(cls, *command):
        result = run(*command)
        assert result.returncode == 0, result.stderr
        return result.stdout

    @classmethod
    def make_scene(cls, folder):
        cls.must("InterfaceCOLMAP", "-i", cls.truth, "--image-folder",
                 os.path.join(cls.truth, "water"), "-o", os.path.join(folder, "scene.mvs"),
                 "--housing", os.path.join(cls.truth, "housing.json"))

    @staticmethod
    def command(folder, *arguments):
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *QUICK, *arguments)

    def copy(self, *names, leave_out=()):
        """A copy of a shared folder for one test. It lies beside the shared folder, because maps
        hold relative image paths."""
        target = self.at(f"copy_{self._testMethodName}")
        self.addCleanup(shutil.rmtree, target, True)
        shutil.copytree(self.at(*names), target,
                        ignore=shutil.ignore_patterns("pinholes", *leave_out))
        self.folder = target
        return target

    def export(self, folder, *arguments):
        self.succeeds(*self.command(folder, "--pinhole-export", "pinholes", *arguments))
        return os.path.join(folder, "pinholes")
