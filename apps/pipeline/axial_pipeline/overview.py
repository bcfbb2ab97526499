# SPDX-License-Identifier: GPL-3.0-or-later
"""A small copy of COLMAP's database with the largest features of each photograph, and the pairs of photographs
that are worth matching with them."""

import contextlib
import heapq
import itertools
import math
import sqlite3

from . import database, files, positions, similar
from .failure import Failure
from .running import tell

FEATURES = 200  # of a photograph
# Photographs with which each one is matched: the most similar ones, the next ones by name, and the nearest.
SIMILAR, BY_NAME, NEAREST = 30, 3, 10
ALL = 45  # photographs, up to which all pairs are as few
DEGREE = 111000  # m, of latitude
OF_FEATURES, OF_PAIRS = ("keypoints", "descriptors"), ("matches", "two_view_geometries")


def copy_tables(connection):
    """Copies the database "full", which is attached, without features and matches."""
    tables = connection.execute("SELECT type, name, sql FROM full.sqlite_master WHERE name NOT LIKE 'sqlite%' AND "
                                "sql IS NOT NULL ORDER BY type DESC, name").fetchall()
    for kind, name, sql in tables:
        connection.execute(sql)
        if kind == "table" and name not in OF_FEATURES + OF_PAIRS:
            connection.execute(f"INSERT INTO main.{name} SELECT * FROM full.{name}")


def copy_largest(connection):
    """Copies the largest features of the database "full", which is attached."""
    for image, in connection.execute("SELECT image_id FROM full.images").fetchall():
        kept = None
        for table in OF_FEATURES:
            connection.execute(f"INSERT INTO main.{table} SELECT * FROM full.{table} WHERE image_id = ?", (image,))
            row = connection.execute(f"SELECT rows, cols, data FROM main.{table} WHERE image_id = ?",
                                     (image,)).fetchone()
            rows, columns, data = row or (0, 0, b"")
            if not rows:
                continue
            if kept is None:
                kept = database.coarsest(database.scales_in(database.columns_in(data, columns)), FEATURES)
            size = len(data) // rows
            data = b"".join(data[size * number:size * (number + 1)] for number in kept)
            connection.execute(f"UPDATE main.{table} SET rows = ?, data = ? WHERE image_id = ?",
                               (len(kept), data, image))


def write(file, full):
    """Writes the copy `file` of the database `full`, with photographs named by their ids. COLMAP takes the focal
    length as unknown, because verification is faster so. Does nothing if `file` exists."""
    if file.exists():
        return
    temporary = file.with_name(file.name + ".tmp")
    files.clear(temporary)
    with contextlib.closing(sqlite3.connect(temporary)) as connection:
        connection.execute("ATTACH ? AS full", (str(full),))
        connection.execute("PRAGMA main.journal_mode = OFF")  # a killed run leaves one file only, which is removed
        version, = connection.execute("PRAGMA full.user_version").fetchone()
        connection.execute(f"PRAGMA main.user_version = {version}")
        with connection:
            copy_tables(connection)
            copy_largest(connection)
            connection.execute("UPDATE main.cameras SET prior_focal_length = 0")
            connection.execute("UPDATE main.images SET name = image_id")
    temporary.rename(file)


def descriptors(file):
    """The descriptors of each photograph, by id."""
    with database.opened(file) as connection:
        return {image: data or b"" for image, data in connection.execute(
            "SELECT image_id, data FROM images LEFT JOIN descriptors USING (image_id)")}


def gps_positions(file):
    """Positions [m] from the latitudes and longitudes in COLMAP's database, by id. Their height is ignored, as
    COLMAP does. Empty in newer versions of COLMAP, which have another table."""
    rows = database.rows_of(file, "SELECT image_id, prior_tx, prior_ty FROM images WHERE prior_tx IS NOT NULL AND "
                            "prior_ty IS NOT NULL AND (prior_tx != 0 OR prior_ty != 0)") or []
    return {image: (DEGREE * latitude, DEGREE * math.cos(math.radians(latitude)) * longitude)
            for image, latitude, longitude in rows}


def known_positions(file, of_positions):
    """The positions of photographs [m], by id, as far as they are known: from the file `of_positions`, or the
    GPS positions in COLMAP's database `file`. They are a hint only: a file that cannot be read gives none."""
    if not of_positions:
        return gps_positions(file)
    named = database.names(file) or {}
    try:
        known = positions.read(of_positions, list(named.values()), tell=False)
    except Failure as failure:
        tell(f"pairs are chosen without positions: {failure}")
        return {}
    return {image: known[name] for image, name in named.items() if name in known}


def nearest(known):
    """The pairs of each photograph with the NEAREST others. `known`: positions by id."""
    for image, place in sorted(known.items()):
        others = ((math.dist(place, known[other]), other) for other in known if other != image)
        yield from ((image, other) for _, other in heapq.nsmallest(NEAREST, others))


def ordered(pairs):
    """Pairs of ids without repetitions, the smaller id first."""
    return sorted({(min(pair), max(pair)) for pair in pairs})


def following(named):
    """The pairs of each photograph with the next ones by name. `named`: names by id."""
    by_name = sorted(named, key=named.get)
    return ordered(pair for step in range(1, BY_NAME + 1) for pair in zip(by_name, by_name[step:]))


def candidates(named, alike, known):
    """The pairs that are matched with few features. `named`: names by id. `alike`: similar.most_similar() of
    the photographs. `known`: positions by id."""
    if len(named) <= ALL:
        return ordered(itertools.combinations(named, 2))
    look_alike = [(image, other) for image, others in alike.items() for other in others]
    return ordered([*following(named), *look_alike, *nearest(known)])


def most_similar(file):
    """similar.most_similar() of the photographs of the overview `file`."""
    return similar.most_similar(descriptors(file), SIMILAR)
