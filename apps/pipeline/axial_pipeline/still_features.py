# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that stand still: at the same pixels, with the same look, in most photographs of a camera.
They belong to what moves with the camera, such as a strobe arm, the skid of a vehicle or a watermark.
COLMAP matches them best of all, and then computes wrong poses. Looked for in COLMAP's database after
the features were found.

Measured on the scenes reef and closeup (10 and 12 photographs, 13,000 features in each) and on the
photographs fountain-P11: no feature has the same pixel within LARGEST_MOVE and a descriptor within
LEAST_COSINE in 20 % of the photographs, as many as in photographs that were moved against each other
(chance). At a cosine of 0.8, 1 in 200 features has them in 20 %, and none in 50 %."""

import collections
import contextlib
import json
import math
import operator
import pathlib
import struct
import time
import zlib

from . import files
from .database import DAMAGE, by_camera, keypoints_of, opened

FOUND, MASK = "still_features.json", "still_features.png"  # below the output folder
SAMPLE, REFERENCES = 16, 4  # photographs that are compared, and those that all are compared with
LEAST_PHOTOGRAPHS = 4
LARGEST_MOVE = 1.0  # [px] in a photograph that is COLMAP_WIDTH wide or narrower
COLMAP_WIDTH = 3200  # COLMAP looks for features in photographs of at most this size [px]
LEAST_COSINE = 0.9  # of the angle between two descriptors
LEAST_SHARE = 0.5  # of the other photographs
LEAST_FEATURES = 8  # fewer change no pose
NEAR = 0.05  # part of the width: the size of cells, and features in cells that touch are one region
MARGIN, OF_SCALE = 0.01, 6  # around a feature: part of the width, and size of its descriptor


def sample_of(items, count):
    """At most `count` of the `items`, evenly spread."""
    step = max(1.0, len(items) / count)
    return [items[int(number * step)] for number in range(min(count, len(items)))]


def cosine(a, b):
    product = sum(map(operator.mul, a, b))
    return product / math.sqrt(sum(map(operator.mul, a, a)) * sum(map(operator.mul, b, b))) if product else 0


def cells_of(features, size):
    """The numbers of the features by cell. A feature is in its own cell and in the three nearest ones, so
    that every feature nearer than half a cell is among those of a place's cell."""
    cells = collections.defaultdict(list)
    for number, (x, y) in enumerate(zip(features.xs, features.ys)):
        column, row = cell_of(x, y, size)
        columns = (column, column + (1 if x / size - column >= 0.5 else -1))
        rows = (row, row + (1 if y / size - row >= 0.5 else -1))
        for cell in ((a, b) for a in columns for b in rows):
            cells[cell].append(number)
    return cells


def counts_of_rest(reference, others, largest_move):
    """In how many of the photographs `others` each feature of `reference` is at rest. `others`: their
    Keypoints and cells_of()."""
    counts = [0] * len(reference.xs)
    size = 2 * largest_move
    for other, cells in others:
        for number, (x, y) in enumerate(zip(reference.xs, reference.ys)):
            near = (one for one in cells.get(cell_of(x, y, size), ())
                    if abs(other.xs[one] - x) <= largest_move and abs(other.ys[one] - y) <= largest_move)
            counts[number] += any(cosine(reference.descriptor(number), other.descriptor(one)) >=
                                  LEAST_COSINE for one in near)
    return counts


def cell_of(x, y, size):
    return math.floor(x / size), math.floor(y / size)


def around(cell):
    """The cell and those that touch it."""
    return [(cell[0] + a, cell[1] + b) for a in (-1, 0, 1) for b in (-1, 0, 1)]


def each_once(features, distance):
    """The `features` without those that are nearer than `distance` to an earlier one in x and in y."""
    kept = collections.defaultdict(list)
    for x, y, *rest in features:
        cell = cell_of(x, y, distance)
        near = (one for other in around(cell) for one in kept.get(other, ()))
        if not any(abs(one[0] - x) < distance and abs(one[1] - y) < distance for one in near):
            kept[cell].append((x, y, *rest))
    return [one for cell in kept.values() for one in cell]


def move_of(width):
    """By how many pixels features at rest may move in photographs of this width."""
    return LARGEST_MOVE * max(1, width / COLMAP_WIDTH)


def at_rest(photographs, width):
    """(x, y, scale, share of photographs) of the features at rest. `photographs`: Keypoints."""
    largest_move = move_of(width)
    sample = [(one, cells_of(one, 2 * largest_move)) for one in photographs]
    found = []
    for reference, _ in sample_of(sample, REFERENCES):
        others = [one for one in sample if one[0] is not reference]
        counts = counts_of_rest(reference, others, largest_move)
        for number, count in enumerate(counts):
            if count >= max(2, LEAST_SHARE * len(others)):
                found.append((reference.xs[number], reference.ys[number], reference.scales[number],
                              (count + 1) / len(sample)))
    return each_once(found, 2 * largest_move)


def regions_of(features, width):
    """Lists of features that are near each other, the largest first: those in cells that touch."""
    cells, size = collections.defaultdict(list), NEAR * width
    for feature in features:
        cells[cell_of(*feature[:2], size)].append(feature)
    regions = []
    while cells:
        region, todo = [], [next(iter(cells))]
        while todo:
            cell = todo.pop()
            region += cells.pop(cell, [])
            todo += [other for other in around(cell) if other in cells]
        regions.append(region)
    return sorted(regions, key=len, reverse=True)


def margin_of(scale, width):
    return MARGIN * width + OF_SCALE * scale


def squares_of(features, width, height):
    """The pixels around each feature: (first x, first y, last x, last y)."""
    for x, y, scale, _ in features:
        margin = margin_of(scale, width)
        yield (max(0, math.floor(x - margin)), max(0, math.floor(y - margin)),
               min(width - 1, math.ceil(x + margin)), min(height - 1, math.ceil(y + margin)))


def grey_png(width, rows):
    """The bytes of a PNG. `rows`: of 8-bit grey values."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data +
                struct.pack(">I", zlib.crc32(kind + data)))

    packer = zlib.compressobj()
    pixels = b"".join(packer.compress(b"\0" + row) for row in rows) + packer.flush()
    header = struct.pack(">IIBBBBB", width, len(rows), 8, 0, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b""))


def mask_of(features, width, height):
    """The bytes of a mask: black around the features, else white."""
    rows = [bytearray(b"\xff" * width) for _ in range(height)]
    for left, top, right, bottom in squares_of(features, width, height):
        for row in rows[top:bottom + 1]:
            row[left:right + 1] = bytes(right + 1 - left)
    return grey_png(width, rows)


def find(database):
    """(width, height, features at rest) of the camera with the most of them. Nothing if there are too
    few, or if `database` is not one of COLMAP or is damaged."""
    found = []
    with contextlib.suppress(*DAMAGE), opened(database) as connection:
        for size, images in by_camera(connection):
            if len(images) >= LEAST_PHOTOGRAPHS:
                sample = [keypoints_of(connection, image) for image, _ in sample_of(images, SAMPLE)]
                found.append((*size, at_rest(sample, size[0])))
    return max((one for one in found if len(one[2]) >= LEAST_FEATURES),
               key=lambda one: len(one[2]), default=None)


def lines_about(out):
    """What look() found for the run in the folder `out`, as lines for the user."""
    found = files.read_object(pathlib.Path(out) / FOUND)
    with contextlib.suppress(LookupError, TypeError, ValueError):
        lines = ["{} features stand still in the photographs, like a strobe arm or a watermark. Poses may "
                 "follow them instead of the scene.".format(found["features"])]
        for region in found["regions"]:
            lines.append("x {} to {}, y {} to {} px: {} features at rest in {:.0%} of the photographs".format(
                *region["pixels"], region["features"], region["share"]))
        return [*lines, found["remedy"]]
    return []


def tell(lines, log):
    """Prints the lines, and adds them to the file `log`, from which the page takes warnings."""
    now = time.strftime("%H:%M:%S")
    with open(log, "a") as log:
        for line in lines:
            print(f"    warning: {line}", flush=True)
            log.write(f"{now} [reconstruct] warning: {line}\n")


def look(database, out, log, is_masked):
    """Looks for features that stand still in a database of COLMAP. If there are some, tells where, also
    in the file `log`, and writes FOUND into the folder `out`, and a mask unless the run has masks
    (`is_masked`)."""
    found = find(database)
    if not found:
        files.clear(out / FOUND)
        if not is_masked:
            files.clear(out / MASK)
        return
    width, height, features = found
    remedy = f"A mask leaves them out: look at {out / MASK}, then give --masks {out / MASK}"
    if is_masked:
        remedy = "The masks of --masks do not cover them"
    else:
        files.write(out / MASK, mask_of(features, width, height))
    files.write(out / FOUND, json.dumps({"features": len(features), "remedy": remedy, "regions": [
        region_in_words(region, width, height) for region in regions_of(features, width)]}))
    tell(lines_about(out), log)


def region_in_words(region, width, height):
    squares = list(zip(*squares_of(region, width, height)))
    shares = sorted(share for *_, share in region)
    return {"pixels": [min(squares[0]), max(squares[2]), min(squares[1]), max(squares[3])],
            "features": len(region), "share": shares[len(shares) // 2]}
