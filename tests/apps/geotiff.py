# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the GeoTIFF files of MapSurface, by the descriptions of TIFF and GeoTIFF and without GDAL."""

import dataclasses
import struct
import zlib


@dataclasses.dataclass
class Map:
    left: float  # x of the left edge of the map
    top: float
    pixel: float
    rows: list  # of rows of pixels: numbers, or tuples of channels
    keys: tuple  # GeoKeyDirectory
    nodata: str


def tags_of(data):
    """The tags of the first image: lists of numbers or bytes, by number of the tag."""
    order, magic, place = struct.unpack_from("<2sHI", data)
    assert (order, magic) == (b"II", 42)
    sizes = {1: "B", 2: "c", 3: "H", 4: "I", 12: "d"}
    tags = {}
    for i in range(struct.unpack_from("<H", data, place)[0]):
        entry = place + 2 + 12 * i
        tag, kind, count = struct.unpack_from("<HHI", data, entry)
        if kind not in sizes:
            continue
        form = f"<{count}{sizes[kind]}"
        at = entry + 8 if struct.calcsize(form) <= 4 else struct.unpack_from("<I", data, entry + 8)[0]
        tags[tag] = struct.unpack_from(form, data, at)
    return tags


def undone(row, width, channels, bits, predictor):
    """The samples of a row of a tile."""
    if predictor == 3:  # differences of the bytes of the numbers, the highest bytes first
        total, plain = 0, bytearray()
        for byte in row:
            total = (total + byte) & 255
            plain.append(total)
        return struct.unpack(f">{width}f", bytes(plain[p * width + i] for i in range(width)
                                                 for p in range(4)))
    values = list(struct.unpack(f"<{width * channels}{'BH'[bits // 16]}", row))
    if predictor == 2:
        for i in range(channels, len(values)):
            values[i] = (values[i] + values[i - channels]) & (2 ** bits - 1)
    return values


def read_geotiff(data):
    tags = tags_of(data)
    (width,), (height,), (tile_width,), (tile_height,) = (tags[t] for t in (256, 257, 322, 323))
    channels, bits, predictor = tags[277][0], tags[258][0], tags.get(317, (1,))[0]
    assert tags[259][0] == 8  # DEFLATE
    rows = [[None] * width for _ in range(height)]
    across = -(-width // tile_width)
    for k, (at, size) in enumerate(zip(tags[324], tags[325])):
        assert size > 0
        tile = zlib.decompress(data[at:at + size])
        step = len(tile) // tile_height
        for j in range(min(tile_height, height - k // across * tile_height)):
            values = undone(tile[j * step:(j + 1) * step], tile_width, channels, bits, predictor)
            if channels > 1:
                values = list(zip(*[iter(values)] * channels))
            x = k % across * tile_width
            row = rows[k // across * tile_height + j]
            row[x:x + tile_width] = values[:width - x]
    scale, tie = tags[33550], tags[33922]
    assert tie[:3] == (0, 0, 0) and scale[0] == scale[1]
    nodata = b"".join(tags.get(42113, ())).rstrip(b"\0").decode()
    return Map(tie[3], tie[4], scale[0], rows, tags.get(34735, ()), nodata)
