# SPDX-License-Identifier: GPL-3.0-or-later
"""Databases and models of COLMAP that are written by hand."""

import contextlib
import random
import sqlite3
import struct

from pipeline_folder import InFolder

SHARP, BLURRED = 0.93, 3.4  # scales of the finest features [px]


def keypoints(count, finest, seed=1):
    """COLMAP's features: x, y and the affine shape, here a scale."""
    draw = random.Random(seed)
    rows = []
    for _ in range(count):
        scale = finest * draw.uniform(0.95, 3)
        rows += [draw.uniform(0, 480), draw.uniform(0, 360), scale, 0, 0, scale]
    return struct.pack(f"<{len(rows)}f", *rows)


class Databases(InFolder):
    def database(self, photographs, name="features.db"):
        """`photographs`: the number of features and their finest scale, by name."""
        file = self.folder / name
        with contextlib.closing(sqlite3.connect(file)) as connection, connection:
            connection.executescript(
                "CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY, model INTEGER, width INTEGER, height INTEGER,"
                " params BLOB, prior_focal_length INTEGER);"
                "CREATE TABLE images (image_id INTEGER PRIMARY KEY, name TEXT, camera_id INTEGER);"
                "CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
                "CREATE TABLE descriptors (image_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER, data BLOB);"
                "CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY, rows INTEGER, cols INTEGER,"
                " data BLOB);")
            connection.execute("INSERT INTO cameras VALUES (1, 4, 480, 360, ?, 0)",
                               (struct.pack("<8d", 400, 400, 240, 180, 0, 0, 0, 0),))
            for number, (photograph, (count, finest)) in enumerate(photographs.items(), 1):
                connection.execute("INSERT INTO images VALUES (?, ?, 1)", (number, photograph))
                connection.execute("INSERT INTO keypoints VALUES (?, ?, 6, ?)",
                                   (number, count, keypoints(count, finest, number)))
                connection.execute("INSERT INTO descriptors VALUES (?, ?, 128, ?)", (number, count, bytes(128 * count)))
        return file

    def model(self, folder, names, focal=400):
        """A binary model of COLMAP with images without observations."""
        folder.mkdir(parents=True)
        images = [struct.pack("<i7di", number, 1, 0, 0, 0, 0, 0, 0, 1) + name.encode() + b"\0" + struct.pack("<Q", 0)
                  for number, name in enumerate(names, 1)]
        (folder / "images.bin").write_bytes(struct.pack("<Q", len(images)) + b"".join(images))
        (folder / "cameras.bin").write_bytes(struct.pack("<QiiQQ8d", 1, 1, 4, 480, 360, focal, focal, 240, 180,
                                                         0, 0, 0, 0))
        return folder
