# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Exif data of a photograph say. Only the first bytes and short tables of a file are read, so that
thousands of photographs are read in seconds."""

import dataclasses
import datetime
import struct

# What stands before the Exif data in a JPEG file and in a PNG file, near the beginning of the file.
MARKS = (b"Exif\0\0", b"eXIf")
SEARCHED = 1 << 17  # bytes
MAKER, MODEL, ORIENTATION, EXIF_TABLE, TAKEN, FOCAL_LENGTH, GPS_TABLE = 271, 272, 274, 0x8769, 0x9003, 0x920A, 0x8825
EXPOSURE_TIME, F_NUMBER, SENSITIVITY = 0x829A, 0x829D, 0x8827
POSITION = {2, 4, 6}  # tags of latitude, longitude and altitude in the GPS table
TEXT, SHORT, RATIONAL = 2, 3, 5  # kinds of values
BYTES = {1: 1, TEXT: 1, SHORT: 2, 4: 4, RATIONAL: 8, 6: 1, 7: 1, 8: 2, 9: 4, 10: 8, 11: 4, 12: 8}  # by kind
LONGEST_TEXT = 200


@dataclasses.dataclass(frozen=True)
class Exif:
    """What is not stated has the default."""
    camera: str = ""            # maker and model
    focal: float | None = None  # focal length [mm]
    orientation: int = 1        # 1: to be shown as stored; 3, 6, 8: turned; others: mirrored, too
    date: str = ""              # the day on which it was taken, as 2024-05-31
    exposure: float | None = None  # exposure time [s] by sensitivity (ISO) over the square of the f-number
    has_position: bool = False  # whether latitude, longitude and altitude are there; COLMAP 3.8 uses only all three


class Table:
    """A table of values by tag."""

    def __init__(self, data, begin, offset, order):
        """Exif data begin at `begin`, and `offset` counts from there. `order`: of bytes, "<" or ">"."""
        self.data, self.begin, self.order = data, begin, order
        at = begin + offset
        count, = struct.unpack_from(f"{order}H", data, at)
        self.entries = {}
        for entry in range(at + 2, at + 2 + 12 * count, 12):
            tag, kind, number = struct.unpack_from(f"{order}HHI4x", data, entry)
            self.entries[tag] = kind, number, entry + 8

    def __contains__(self, tag):
        return tag in self.entries

    def table(self, tag):
        """The table to which the entry `tag` leads."""
        offset, = struct.unpack_from(f"{self.order}I", self.data, self.entries[tag][2])
        return Table(self.data, self.begin, offset, self.order)

    def value(self, tag):
        """The text, or the first number. None if there is none, or if it is of another kind."""
        if tag not in self.entries:
            return None
        kind, number, at = self.entries[tag]
        if BYTES.get(kind, 1) * number > 4:  # the entry says where the value stands
            at = self.begin + struct.unpack_from(f"{self.order}I", self.data, at)[0]
        if kind == TEXT:
            text = self.data[at:at + min(number, LONGEST_TEXT)].partition(b"\0")[0]
            return " ".join(text.decode(errors="replace").split())
        if kind == RATIONAL:
            above, below = struct.unpack_from(f"{self.order}II", self.data, at)
            return above / below if below else None
        return struct.unpack_from(f"{self.order}{'H' if kind == SHORT else 'I'}", self.data, at)[0]


def first_table(data):
    """The first Table in the bytes of a file; None if there are no Exif data. A TIFF file has their form
    itself."""
    begin = 0 if data[:4] in (b"II*\0", b"MM\0*") else None
    if begin is None:
        found = ((data.find(mark, 0, SEARCHED), mark) for mark in MARKS)
        begin = next((at + len(mark) for at, mark in found if at >= 0), None)
    if begin is None:
        return None
    order = ">" if data[begin:begin + 2] == b"MM" else "<"
    return Table(data, begin, struct.unpack_from(f"{order}I", data, begin + 4)[0], order)


def camera_of(maker, model):
    """The maker's name is left out if the model repeats it."""
    maker, model = (text if isinstance(text, str) else "" for text in (maker, model))
    repeats = maker and model.lower().startswith(maker.lower().split()[0])
    return model if repeats else f"{maker} {model}".strip()


def day_of(taken):
    """The day of a time such as 2024:05:31 10:20:30, or nothing. A clock that was never set states zeros."""
    try:
        return datetime.date.fromisoformat(taken[:10].replace(":", "-")).isoformat()
    except (TypeError, ValueError):
        return ""


def has_position(first):
    try:
        return GPS_TABLE in first and POSITION <= first.table(GPS_TABLE).entries.keys()
    except (ValueError, struct.error):
        return False


def exposure_in(own):
    """The exposure by the table `own`; None if time or sensitivity is not stated. A lens without contacts states no
    f-number: it is taken for 1."""
    time, number, sensitivity = (own.value(tag) for tag in (EXPOSURE_TIME, F_NUMBER, SENSITIVITY))
    if not all(isinstance(value, (int, float)) and value > 0 for value in (time, sensitivity)):
        return None
    return time * sensitivity / (number * number if isinstance(number, (int, float)) and number > 0 else 1)


def exif_in(data):
    """The Exif in the bytes of a file; the defaults if there is none, or if it is damaged."""
    try:
        first = first_table(data)
        if first is None:
            return Exif()
        own = first.table(EXIF_TABLE) if EXIF_TABLE in first else None
        focal = own.value(FOCAL_LENGTH) if own else None
        orientation = first.value(ORIENTATION)
        return Exif(camera_of(first.value(MAKER), first.value(MODEL)),
                    focal if isinstance(focal, (int, float)) and focal > 0 else None,
                    orientation if orientation in range(1, 9) else 1, day_of(own.value(TAKEN) if own else None),
                    exposure_in(own) if own else None, has_position(first))
    except (ValueError, struct.error):
        return Exif()
