# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a photograph says where it was taken, and with which focal length. Only the first bytes and short
tables of a file are read, so that thousands of photographs are checked in seconds."""

import mmap
import struct

# What stands before the Exif data in a JPEG file and in a PNG file, near the beginning of the file.
MARKS = (b"Exif\0\0", b"eXIf")
SEARCHED = 1 << 17  # bytes
GPS_TABLE = 0x8825  # tag of the offset of the GPS table
EXIF_TABLE, FOCAL_LENGTH = 0x8769, 0x920A  # tags of the offset of the Exif table, and in it
POSITION = {2, 4, 6}  # tags of latitude, longitude and altitude; COLMAP 3.8 uses only all three


def table(data, begin, offset, order):
    """The values of a table of Exif data, by tag. Exif data begin at `begin`, and `offset` counts
    from there. `order`: of bytes, "<" or ">"."""
    at = begin + offset
    count, = struct.unpack_from(f"{order}H", data, at)
    entries = (struct.unpack_from(f"{order}HHII", data, at + 2 + 12 * i) for i in range(count))
    return {tag: value for tag, _, _, value in entries}


def begin_of_exif(data):
    """Where Exif data begin; None if there are none. A TIFF file has their form itself."""
    if data[:4] in (b"II*\0", b"MM\0*"):
        return 0
    found = ((data.find(mark, 0, SEARCHED), mark) for mark in MARKS)
    return next((at + len(mark) for at, mark in found if at >= 0), None)


def first_table(data):
    """The first table of the Exif data, where the data begin, and the order of bytes; None if there are none."""
    begin = begin_of_exif(data)
    if begin is None:
        return None
    order = ">" if data[begin:begin + 2] == b"MM" else "<"
    return table(data, begin, *struct.unpack_from(f"{order}I", data, begin + 4), order), begin, order


def focal_length(photograph):
    """The focal length in the Exif data of the file [mm]; None if there is none."""
    try:
        with open(photograph, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            first, begin, order = first_table(data) or ({}, 0, "<")
            if EXIF_TABLE not in first:
                return None
            at = begin + table(data, begin, first[EXIF_TABLE], order)[FOCAL_LENGTH]
            above, below = struct.unpack_from(f"{order}II", data, at)
            return above / below if above and below else None
    except (OSError, ValueError, LookupError, struct.error):  # an empty, unreadable or broken file
        return None


def has_gps(photograph):
    """Whether the Exif data of the file have latitude, longitude and altitude."""
    try:
        with open(photograph, "rb") as file, \
                mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            first, begin, order = first_table(data) or ({}, 0, "<")
            return GPS_TABLE in first and POSITION <= table(data, begin, first[GPS_TABLE],
                                                            order).keys()
    except (OSError, ValueError, struct.error):  # an empty, unreadable or broken file
        return False
