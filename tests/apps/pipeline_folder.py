# SPDX-License-Identifier: GPL-3.0-or-later
"""A test in a folder of its own, for tests of apps/pipeline/axial_pipeline, which it makes
importable, and the commands of the pipeline."""

import argparse
import contextlib
import io
import os
import pathlib
import struct
import subprocess
import sys
import unittest
import unittest.mock

from programs import BIN, must, new_folder, png

PIPELINE = pathlib.Path(__file__).resolve().parents[2] / "apps" / "pipeline"
sys.path.insert(0, str(PIPELINE))

# Imports what the commands import, so that CTest keeps all of it compiled (PYTHONPYCACHEPREFIX).
from axial_pipeline import colmap_model, reconstruct  # noqa: E402, F401
from axial_pipeline.reconstruct_options import options  # noqa: E402


def options_of(**changes):
    """The options of `reconstruct` with their defaults and these changes, as its checks leave them."""
    given = options(PIPELINE, "", ["--images", "images", "--lens", "lens", "--housing", "housing", "-o", "out"])
    return argparse.Namespace(**{**vars(given), "lens": "lens", "cameras": [], "doubled": {}, "lines": [],
                                 "exposures": {}, **changes})


def reconstruct_command(*options, source=("--images", "images"), lens="lens", housing="housing", out="out",
                        programs=BIN):
    """The words of a command `reconstruct`."""
    return [sys.executable, str(PIPELINE / "reconstruct"), *map(str, source), "--lens", str(lens), "--housing",
            str(housing), "-o", str(out), "--programs", str(programs), *map(str, options)]


def simulate(folder, preset, views, size, *more):
    """Writes photographs under water of a scene into `folder`. `size`: (width, height) [px]."""
    must("SimulateUnderwater", "--preset", preset, "--views", views, "--width", size[0], "--height", size[1],
         "--coarseness", 4, "--samples", 1, "--truth", 0, "--medium", "water", *more, "-o", folder)


class InFolder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(new_folder(self.addCleanup))

    def write(self, name, content="mine"):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def put_script(self, name, script):
        self.write(name, f"#!/bin/sh\n{script}\n").chmod(0o755)

    def put_on_path(self, folder="."):
        """Programs in `folder` come before the installed ones until the test ends."""
        path = unittest.mock.patch.dict(os.environ, PATH=f"{self.folder / folder}:{os.environ['PATH']}")
        path.start()
        self.addCleanup(path.stop)

    def model(self, number, images):
        self.write(f"models/{number}/images.bin", struct.pack("<Q", images))

    def said_by(self, function, *arguments):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            function(*arguments)
        return said.getvalue()


class ColmapModelCase(InFolder):
    """The command colmap-model with two photographs. A stand-in for COLMAP may lie in the folder `bin`."""

    def setUp(self):
        super().setUp()
        self.put_on_path("bin")
        for number in range(2):
            self.write(f"images/{number}.png", png([bytes(4)] * 3))

    def run_it(self, *more):
        command = [sys.executable, str(PIPELINE / "colmap-model"), "--images", "images",
                   "--camera-model", "PINHOLE", "--camera-parameters", "1,2,3,4", "-o", "out", *more]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=60)
