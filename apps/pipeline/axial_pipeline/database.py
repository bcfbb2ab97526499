# SPDX-License-Identifier: GPL-3.0-or-later
"""COLMAP's database: photographs, cameras, features and verified matches."""

import array
import contextlib
import dataclasses
import heapq
import math
import sqlite3
import struct

from . import lenses
from .failure import Failure

PAIR = 2147483647  # pair_id = PAIR * smaller image id + larger image id
DESCRIPTOR = 128   # bytes: 4 x 4 cells of 8 directions
DAMAGE = (sqlite3.Error, LookupError, TypeError, ValueError)  # of reading what is no database, or is damaged
CELLS = 4          # along each side of a photograph, for the spread of features


@contextlib.contextmanager
def opened(file):
    """An open database, whose changes are kept if no error is raised."""
    with contextlib.closing(sqlite3.connect(file)) as connection, connection:
        yield connection


def rows_of(file, query):
    """The rows of a query; None if the file is no database of COLMAP."""
    try:
        with opened(file) as connection:
            return connection.execute(query).fetchall()
    except sqlite3.Error:
        return None


def by_camera(connection):
    """The size (width, height) [px] of each camera, and its photographs by name: pairs of id and name."""
    for camera, *size in connection.execute("SELECT camera_id, width, height FROM cameras").fetchall():
        yield tuple(size), connection.execute("SELECT image_id, name FROM images WHERE camera_id = ? ORDER BY name",
                                              (camera,)).fetchall()


def names(file):
    """The photographs by id; None if the file is no database of COLMAP."""
    rows = rows_of(file, "SELECT image_id, name FROM images")
    return None if rows is None else dict(rows)


def columns_in(data, count):
    """The `count` columns of numbers in COLMAP's keypoints: x, y [px] with pixel centres at 0.5, and often scale and
    orientation, or an affine shape."""
    numbers = array.array("f")
    numbers.frombytes(data or b"")
    return [numbers[k::count] for k in range(count)]


def scales_in(columns):
    """The scales of features [px]; 0 if the columns do not tell them."""
    if len(columns) == 6:
        return [math.sqrt(abs(a * d - b * c)) for a, b, c, d in zip(*columns[2:])]
    return list(columns[2]) if len(columns) > 2 else [0.0] * len(columns[0])


def coarsest(scales, count):
    """The numbers of the `count` features with the largest scales, the largest first."""
    return heapq.nsmallest(count, range(len(scales)), key=lambda number: (-scales[number], number))


def cells_of(places, size):
    """The cells of a photograph of `size` (width, height) that hold any of the `places` (x, y) [px]."""
    return {(int(CELLS * x / size[0]), int(CELLS * y / size[1])) for x, y in places}


class Features:
    """The features of a photograph of `size` (width, height) [px]: their number, the scale [px] below which a
    tenth of them lies, and the share of the photograph's cells that hold any."""

    def __init__(self, count, columns, data, size):
        self.count, self.size = count, size
        columns = columns_in(data, columns)
        scales = sorted(scales_in(columns)) if len(columns) == 6 else []
        self.fine = scales[len(scales) // 10] if scales else 0
        self.spread = len(cells_of(zip(*columns[:2]), size)) / CELLS ** 2


@dataclasses.dataclass
class Keypoints:
    """The features of a photograph, each with its place, scale and descriptor."""
    xs: array.array  # [px], pixel centres at 0.5
    ys: array.array
    scales: list  # [px]
    descriptors: bytes  # DESCRIPTOR each

    def descriptor(self, number):
        return self.descriptors[DESCRIPTOR * number:DESCRIPTOR * (number + 1)]

    def places(self, numbers):
        return ((self.xs[number], self.ys[number]) for number in numbers)

    def coarsest(self, count):
        """The `count` Keypoints with the largest scales."""
        kept = coarsest(self.scales, count)
        return Keypoints(*([column[k] for k in kept] for column in (self.xs, self.ys, self.scales)),
                         b"".join(map(self.descriptor, kept)))


def keypoints_of(connection, image):
    """The Keypoints of the photograph with the id `image` in an open database. Fails with a LookupError, TypeError or
    ValueError if they are damaged."""
    row = connection.execute("SELECT keypoints.rows, keypoints.cols, keypoints.data, descriptors.data FROM keypoints "
                             "JOIN descriptors USING (image_id) WHERE image_id = ?", (image,)).fetchone()
    if not row or not row[0]:
        return Keypoints(array.array("f"), array.array("f"), [], b"")
    columns = columns_in(row[2], row[1])
    return Keypoints(columns[0], columns[1], scales_in(columns), row[3])


def features(file):
    """The Features of all photographs, by name; None if the file is no database of COLMAP."""
    rows = rows_of(file, "SELECT name, rows, cols, data, width, height FROM images "
                   "JOIN cameras USING (camera_id) LEFT JOIN keypoints USING (image_id) ORDER BY name")
    if rows is None:
        return None
    return {name: Features(count or 0, columns or 0, data, (width, height))
            for name, count, columns, data, width, height in rows}


def take_features(file, source, wanted):
    """Replaces the features of the photographs `wanted` (names) by those in the database `source`."""
    with opened(file) as connection, contextlib.closing(sqlite3.connect(source)) as other:
        ids = dict(connection.execute("SELECT name, image_id FROM images"))
        for name, image in other.execute("SELECT name, image_id FROM images").fetchall():
            if name not in wanted or name not in ids:
                continue
            for table in ("keypoints", "descriptors"):
                row = other.execute(f"SELECT rows, cols, data FROM {table} WHERE image_id = ?", (image,)).fetchone()
                connection.execute(f"DELETE FROM {table} WHERE image_id = ?", (ids[name],))
                if row:
                    connection.execute(f"INSERT INTO {table} VALUES (?, ?, ?, ?)", (ids[name], *row))


def leave_out(file, reasons):
    """Removes photographs with their features. `reasons`: words by name, which left_out() returns later."""
    with opened(file) as connection:
        connection.execute("CREATE TABLE IF NOT EXISTS left_out (name TEXT PRIMARY KEY, reason TEXT)")
        for name, reason in reasons.items():
            connection.execute("INSERT OR REPLACE INTO left_out VALUES (?, ?)", (name, reason))
            for table in ("keypoints", "descriptors"):
                connection.execute(f"DELETE FROM {table} WHERE image_id IN "
                                   "(SELECT image_id FROM images WHERE name = ?)", (name,))
            connection.execute("DELETE FROM images WHERE name = ?", (name,))


def left_out(file):
    """Why photographs were left out, by name."""
    return dict(rows_of(file, "SELECT name, reason FROM left_out ORDER BY name") or [])


def set_lenses(file, lens_of):
    """Gives cameras their lenses. `lens_of(id, width, height)` is a model's name and its parameters, or
    None for a camera that stays as it is."""
    with opened(file) as connection:
        for camera, width, height in connection.execute("SELECT camera_id, width, height FROM cameras").fetchall():
            lens = lens_of(camera, width, height)
            if lens:
                model, parameters = lens
                connection.execute("UPDATE cameras SET model = ?, params = ?, prior_focal_length = 1 WHERE "
                                   "camera_id = ?", (list(lenses.MODELS).index(model),
                                                     struct.pack(f"<{len(parameters)}d", *parameters), camera))


@contextlib.contextmanager
def named_if_damaged(file):
    """Names the database in the Failure of a block that reads it or a copy of it."""
    try:
        yield
    except sqlite3.Error as error:
        raise Failure(f"{file}: is not a database of COLMAP, or is damaged ({error}); remove it, and the same "
                      "command makes it again") from None


def name_by_ids(file):
    """Names the photographs by their ids. give_names() gives them their names again."""
    with opened(file) as connection:
        connection.execute("UPDATE images SET name = image_id")


def give_names(file, named):
    """Names the photographs. `named`: names by id."""
    with opened(file) as connection:
        connection.executemany("UPDATE images SET name = ? WHERE image_id = ?",
                               [(name, image) for image, name in named.items()])


def take_names(file, source):
    """Gives the photographs the names that they have in the database `source`, of which `file` is a copy."""
    with opened(source) as connection:
        named = dict(connection.execute("SELECT image_id, name FROM images"))
    give_names(file, named)


def matches_of_pairs(file):
    """The verified matches of the pairs that have any, by pair of ids (first < second), as lists of (feature
    of the first photograph, feature of the second one)."""
    found = {}
    with opened(file) as connection:
        for pair, data in connection.execute("SELECT pair_id, data FROM two_view_geometries WHERE rows > 0 "
                                             "ORDER BY pair_id"):
            numbers = array.array("I")
            numbers.frombytes(data)
            found[divmod(pair, PAIR)] = list(zip(numbers[0::2], numbers[1::2]))
    return found


def places_of_features(file):
    """For each photograph with features (id) their coordinates [px], as two lists, and its size (width,
    height) [px]."""
    with opened(file) as connection:
        for image, columns, data, *size in connection.execute(
                "SELECT image_id, cols, data, width, height FROM keypoints JOIN images USING (image_id) "
                "JOIN cameras USING (camera_id) WHERE rows > 0"):
            yield image, *columns_in(data, columns)[:2], size


def verified_matches(file):
    """The largest number of verified matches that each photograph has with another one, by name."""
    named = names(file) or {}
    most = dict.fromkeys(named.values(), 0)
    for pair, count in rows_of(file, "SELECT pair_id, rows FROM two_view_geometries") or []:
        for image in divmod(pair, PAIR):
            if image in named:
                most[named[image]] = max(most[named[image]], count)
    return most
