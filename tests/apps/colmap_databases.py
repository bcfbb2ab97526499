# SPDX-License-Identifier: GPL-3.0-or-later
"""Databases and models of COLMAP that are written by hand."""

import random
import struct

from pipeline_folder import InFolder

from axial_pipeline.database import DESCRIPTOR, opened

# The tables of COLMAP 3.8 that are read.
TABLES = """PRAGMA user_version = 3800;
CREATE TABLE cameras (camera_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, model INTEGER NOT NULL,
    width INTEGER NOT NULL, height INTEGER NOT NULL, params BLOB, prior_focal_length INTEGER NOT NULL);
CREATE TABLE images (image_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, name TEXT NOT NULL UNIQUE,
    camera_id INTEGER NOT NULL, prior_tx REAL, prior_ty REAL, prior_tz REAL);
CREATE UNIQUE INDEX index_name ON images(name);
CREATE TABLE keypoints (image_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER, cols INTEGER, data BLOB);
CREATE TABLE descriptors (image_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER, cols INTEGER, data BLOB);
CREATE TABLE matches (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER, cols INTEGER, data BLOB);
CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER, cols INTEGER, data BLOB);"""
SHARP, BLURRED = 0.93, 3.4  # scales of the finest features [px]


def keypoints(count, finest, seed=1):
    """COLMAP's features: x, y and the affine shape, here a scale."""
    draw = random.Random(seed)
    rows = []
    for _ in range(count):
        scale = finest * draw.uniform(0.95, 3)
        rows += [draw.uniform(0, 480), draw.uniform(0, 360), scale, 0, 0, scale]
    return struct.pack(f"<{len(rows)}f", *rows)


def make_tables(connection, size, parameters=None):
    """The tables of a new database, with a camera of this size (width, height) [px]."""
    connection.executescript(TABLES)
    connection.execute("INSERT INTO cameras VALUES (1, 4, ?, ?, ?, 1)", (*size, parameters))


def add_photograph(connection, image, name, columns, keypoints, descriptors):
    """Adds a photograph with its features. `columns`: numbers of a feature in `keypoints`."""
    connection.execute("INSERT INTO images (image_id, name, camera_id) VALUES (?, ?, 1)", (image, name))
    for table, width, data in (("keypoints", columns, keypoints), ("descriptors", DESCRIPTOR, descriptors)):
        connection.execute(f"INSERT INTO {table} VALUES (?, ?, ?, ?)",
                           (image, len(descriptors) // DESCRIPTOR, width, data))


class Databases(InFolder):
    def database(self, photographs, name="features.db"):
        """`photographs`: the number of features and their finest scale, by name."""
        file = self.folder / name
        with opened(file) as connection:
            make_tables(connection, (480, 360), struct.pack("<8d", 400, 400, 240, 180, 0, 0, 0, 0))
            for number, (photograph, (count, finest)) in enumerate(photographs.items(), 1):
                add_photograph(connection, number, photograph, 6, keypoints(count, finest, number),
                               bytes(DESCRIPTOR * count))
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
