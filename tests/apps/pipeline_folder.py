# SPDX-License-Identifier: GPL-3.0-or-later
"""A test in a folder of its own, for tests of apps/pipeline/axial_pipeline, which it makes
importable."""

import contextlib
import io
import pathlib
import struct
import sys
import tempfile
import unittest

PIPELINE = pathlib.Path(__file__).resolve().parents[2] / "apps" / "pipeline"
sys.path.insert(0, str(PIPELINE))


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="axial_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def put_script(self, name, script):
        self.write(name, f"#!/bin/sh\n{script}\n").chmod(0o755)

    def model(self, number, images):
        self.write(f"models/{number}/images.bin", struct.pack("<Q", images))

    def said_by(self, function, *arguments):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            function(*arguments)
        return said.getvalue()
