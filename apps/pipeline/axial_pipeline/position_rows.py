# SPDX-License-Identifier: GPL-3.0-or-later
"""The lines of a file of positions as other programs write them. The same rules as in
libs/io/cameras/position_file.h, whose tests say more; RefinePoses names the mistakes of a file."""

import dataclasses
import math
import re
import statistics

from .failure import Failure

LABELS = {"label", "name", "image", "image name", "imagename", "filename", "file name", "file", "photo",
          "photo name", "camera", "camera label", "picture", "sourcefile"}
LONGITUDE = {"longitude", "lon", "long", "lng", "gps longitude", "gpslongitude"}
LATITUDE = {"latitude", "lat", "gps latitude", "gpslatitude"}
AXES = {**dict.fromkeys({"x", "easting", "east", "e", "geo x", "pos x", "coordinate1", *LONGITUDE}, "x"),
        **dict.fromkeys({"y", "northing", "north", "n", "geo y", "pos y", "coordinate2", *LATITUDE}, "y"),
        **dict.fromkeys({"z", "altitude", "alt", "height", "elevation", "h", "up", "geo z", "pos z",
                         "rl", "gps altitude", "gpsaltitude"}, "z"), "depth": "depth"}
DEGREES = ("deg", "decimal deg", "°")
METRES = {"m", "metre", "metres", "meter", "meters"}
WIDEST, FAR_FROM_ZERO = 0.1, 1  # of coordinates that can be degrees
MOST_LATITUDE = 84  # of UTM
LONGEST_STEP = 50  # m, usually, between photographs of a survey that follow each other


@dataclasses.dataclass
class Layout:
    delimiter: str = ""  # "": blanks, or not stated
    columns: tuple = ()
    degrees: bool = None  # None: not stated
    longitude_first: bool = False  # whether a line says that x is the longitude if the unit is degrees


def number(field):
    """A number, in which the decimal mark may be a comma; None if it is none."""
    try:
        if "_" not in field:
            return float(field)
    except ValueError:
        if field.count(",") == 1 and "." not in field:
            return number(field.replace(",", "."))
    return None


def split_fields(text, delimiter):
    """The fields between delimiters, which may be in double quotes."""
    fields, field, quoted, i = [], "", False, 0
    while i <= len(text):
        sign = text[i:i + 1]
        if sign == "" or (sign == delimiter and not quoted):
            fields.append(field.strip())
            field = ""
        elif sign != '"' or (not quoted and field.strip()):
            field += sign
        elif quoted and text[i + 1:i + 2] == '"':
            field += sign
            i += 1
        else:
            quoted = not quoted
        i += 1
    return [] if quoted else fields


def words_of(field):
    """The name of a column in plain words, without its unit in brackets."""
    words = re.sub(r"[(\[][^)\]]*[)\]]?", "", field.lower())
    return " ".join(re.sub(r'[_\-."#]', " ", words).split())


def column_of(field):
    words = words_of(field)
    if words in LABELS:
        return "label"
    if re.search("accuracy|sigma|std|acc ", words):
        return ""
    return next((AXES[part.strip()] for part in words.split("/") if part.strip() in AXES), "")


def header_of(line, layout):
    """The delimiter and the columns that a line names; None if it is no header."""
    text = line.lstrip("#/ \t")
    for delimiter in [layout.delimiter] if layout.delimiter else [";", "\t", ",", ""]:
        fields = split_fields(text, delimiter) if delimiter else text.split()
        if any(number(field) is not None for field in fields):
            continue
        columns = []
        for field in fields:
            column = column_of(field)
            again = column in columns or (column in ("z", "depth") and {"z", "depth"} & {*columns})
            columns.append("" if again else column)
        if columns and "label" not in columns and not columns[0]:
            columns[0] = "label"
        if {"label", "x", "y"} <= {*columns} and {"z", "depth"} & {*columns}:
            return delimiter, tuple(columns), fields
    return None


def read_layout_line(line, layout):
    """Whether the line names the delimiter, the columns or the coordinate system."""
    small = line.lower()
    if re.fullmatch("sep=.", small):
        layout.delimiter = line[4]
    elif small.startswith("#") and "coordinatesystem:" in small:
        layout.degrees = "geogcs" in small and "projcs" not in small
    elif re.fullmatch(r"epsg:\s*\d+", small):
        layout.degrees = re.fullmatch(r"epsg:\s*4\d{3}", small) is not None
    elif small.startswith("+proj="):
        layout.degrees = small.startswith(("+proj=longlat", "+proj=latlong"))
    elif re.fullmatch(r"wgs ?84( utm .*)?", small):
        layout.degrees = "utm" not in small
    else:
        return read_header(line, layout)
    layout.longitude_first = layout.longitude_first or bool(layout.degrees)
    return True


def read_header(line, layout):
    """Whether the line names the columns."""
    header = header_of(line, layout)
    if header is None:
        return False
    layout.delimiter, layout.columns, fields = header
    names = {words_of(field) for field, column in zip(fields, layout.columns) if column in ("x", "y")}
    names_degrees = bool(names & (LONGITUDE | LATITUDE))
    layout.longitude_first = layout.longitude_first or names_degrees
    layout.degrees = names_degrees or degrees_by_units(fields, layout)
    return True


def degrees_by_units(fields, layout):
    """Whether the units of the columns say that x and y are degrees: True or False. If they do not say,
    what `layout` says."""
    units = [re.sub(r"^[^(\[]*[(\[]?|[)\]].*", "", field).strip().lower()
             for field, column in zip(fields, layout.columns) if column in ("x", "y")]
    if any(unit.startswith(DEGREES) for unit in units):
        return True
    return False if {*units} & METRES else layout.degrees


def ends_of(line):
    """Where a comment may begin; the end of the line first, then from right to left."""
    return [len(line), *(i for i in reversed(range(len(line)))
                         if line[i] == "#" and (i == 0 or line[i - 1].isspace()))]


def entry_before_end(text):
    """NAME and (X, Y, Z) of `NAME X Y Z`; None if the text has another form."""
    words = text.rsplit(None, 3)
    numbers = [number(word) if "," not in word else None for word in words[1:]]
    return (words[0], tuple(numbers)) if len(words) == 4 and None not in numbers else None


def are_numbers(fields):
    """Whether the fields are at least three numbers, and nothing else up to the eighth."""
    count = next((i for i, field in enumerate(fields) if number(field) is None), len(fields))
    return count >= 8 or 3 <= count == len(fields)


def position_of(fields):
    """None if the number of fields does not tell what they are."""
    return None if len(fields) in (4, 7) else tuple(number(field) for field in fields[:3])


def entry_from_start(line, known):
    """The longest known name at the beginning, and the numbers behind it."""
    text = line[:ends_of(line)[-1]]
    for blank in reversed([match.start() for match in re.finditer(r"\s+", text)][:64]):
        if are_numbers(text[blank:].split()) and known(text[:blank]):
            return text[:blank], position_of(text[blank:].split())
    return None


def delimited_entry(line, layout, known):
    """NAME;X;Y;Z between any delimiters. The position is () if its fields are empty."""
    entries = []
    for end in ends_of(line):
        for delimiter in [layout.delimiter] if layout.delimiter else [";", "\t", ","]:
            name, *fields = split_fields(line[:end].strip(), delimiter) or [""]
            while len(fields) > 3 and not fields[-1]:
                fields.pop()
            if name and len(fields) >= 3 and not any(fields):
                entries.append((name, ()))
            elif name and are_numbers(fields):
                entries.append((name, position_of(fields)))
    return next((entry for entry in entries if known(entry[0])), entries[0] if entries else None)


def words_by_header(line, columns, known):
    """The words of a line as its columns; the label may have blanks. Prefers a comment with which the
    name is known, otherwise the longest comment."""
    found, label = [], columns.index("label")
    for end in ends_of(line):
        fields = line[:end].split()
        more = len(fields) - len(columns)
        if more < 0:
            continue
        fields[label:label + more + 1] = [" ".join(fields[label:label + more + 1])]
        found = fields
        if known(found[label]):
            break
    return found


def entry_by_header(line, layout, known):
    """The name and the position in the columns of the header; the position is () if its fields are
    empty. None if the line has another form."""
    fields = (split_fields(line, layout.delimiter) if layout.delimiter else
              words_by_header(line, layout.columns, known))
    values = dict(zip(layout.columns, fields))
    third = "depth" if "depth" in layout.columns else "z"
    place = [values.get(axis, "") for axis in ("x", "y", third)]
    if not values.get("label") or not any(place):
        return (values["label"], ()) if values.get("label") else None
    numbers = tuple(map(number, place))
    return None if None in numbers else (values["label"], numbers)


def entry_in(line, known, layout=None):
    """The image name in a line and its position; None if the line is a comment or empty. The position
    is None if the line has another form, and () if it has empty fields for it. A comment begins at a
    `#` at the beginning or after a space, unless the name with this `#` is `known`."""
    layout, line = layout or Layout(), line.strip()
    if layout.columns and line and line[0] != "#":
        entry = entry_by_header(line, layout, known)
        if entry or layout.delimiter:
            return entry or (line, None)
    entries = [entry for entry in (entry_before_end(line[:end]) for end in ends_of(line)) if entry]
    found = next((entry for entry in entries if known(entry[0])), None)
    if found or not line or line[0] == "#":
        return found
    quoted = re.match(r'"((?:[^"]|"")*)"(\s.*)', line)
    if quoted:
        fields = quoted[2].split("#")[0].split()
        return quoted[1].replace('""', '"'), position_of(fields) if are_numbers(fields) else None
    found, fields = entry_from_start(line, known), delimited_entry(line, layout, known)
    if not found and fields and (not entries or known(fields[0])):
        return fields
    return found or (entries[-1] if entries else (line, None))


def lines_of(file):
    data = file.read_bytes()
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise Failure(f"{file}: is UTF-16; save it as UTF-8")
    text = data.decode("utf-8-sig", errors="replace")
    return (text if "\n" in text else text.replace("\r", "\n")).split("\n")


def entries_of(file, known):
    """(line number, name, position) of all lines with a name, and the layout. Lines without
    coordinates are left out; the position of a line of another form is None."""
    layout, entries = Layout(), []
    for line_number, line in enumerate(lines_of(file), 1):
        if read_layout_line(line.strip(), layout):
            continue
        entry = entry_in(line, known, layout)
        if entry and entry[1] != ():
            entries.append((line_number, *entry))
    return entries, layout


def can_be_degrees(positions):
    """Whether positions of an unknown unit can be degrees: orders_without_unit() in
    libs/io/cameras/private/position_parts.h."""
    if len(positions) < 3:
        return False
    xs, ys = ([place[axis] for place in positions] for axis in (0, 1))
    extent = max(max(xs) - min(xs), max(ys) - min(ys))
    near, far = sorted(max(map(abs, values)) for values in (xs, ys))
    return 0 < extent <= WIDEST and FAR_FROM_ZERO < far <= 360 and near <= MOST_LATITUDE


def latitude_is_first(positions, layout):
    """Whether x can only be the latitude. Where both orders are possible, the longitude is first."""
    farthest = [max(abs(place[axis]) for place in positions) for axis in (0, 1)]
    return not layout.longitude_first and farthest[0] <= MOST_LATITUDE < farthest[1]


def metres_of_degrees(positions, latitude_first):
    """Longitude and latitude in degrees as metres, up to half a percent: enough to tell neighbours."""
    latitude = 0 if latitude_first else 1
    first = next(iter(positions.values()))[latitude]
    across = 111320 * math.cos(math.radians(first))
    return {name: (place[1 - latitude] * across, place[latitude] * 110950, place[2])
            for name, place in positions.items()}


def zone_of(positions, layout, file):
    """The EPSG code of the UTM zone in which positions in degrees become metres: utm_zone() in
    libs/io/cameras/degrees.cpp. None for positions in metres. Fails if they can be either."""
    if layout.degrees is None and can_be_degrees(positions):
        raise Failure(f"{file}: no line states whether the positions are metres or degrees, which --epsg needs: name "
                      "the columns in a first line such as label,x (m),y (m),z (m) or "
                      "label,longitude,latitude,altitude")
    if not positions or not layout.degrees:
        return None
    latitude = 0 if latitude_is_first(positions, layout) else 1
    mean = [statistics.fmean(place[axis] for place in positions) for axis in (1 - latitude, latitude)]
    number = math.floor((mean[0] + 180) % 360 / 6) + 1
    return (32700 if mean[1] < 0 else 32600) + number


def way_along(places):
    """The median step between positions that follow each other, and the sum of all steps as a part of the
    extent."""
    steps = [math.dist(one, other) for one, other in zip(places, places[1:])]
    low, high = ([limit(axis) for axis in zip(*places)] for limit in (min, max))
    return statistics.median(steps), sum(steps) / math.dist(low, high)


def is_vertical_scan(as_metres, as_degrees):
    """Whether positions, in the order of their file and in both readings, are those of a camera that moves
    up or down, in metres: as degrees, x and y jump to and fro over long ways. A survey in degrees has short
    steps in x and y, however its heights vary; without an order in the file, no reading has a short way."""
    step, way = way_along(as_degrees)
    return step > LONGEST_STEP and 2 * way_along(as_metres)[1] < way


def tell_guess(file, reading):
    print(f"{file}: no line states whether the positions are metres or degrees; they are taken as {reading}. "
          "To state it, name the columns in a first line such as label,x (m),y (m),z (m) or "
          "label,longitude,latitude,altitude", flush=True)


def guessed(positions, latitude_first):
    """The positions in metres, and the reading in words, if no line states the unit."""
    degrees = metres_of_degrees(positions, latitude_first)
    if is_vertical_scan([*positions.values()], [*degrees.values()]):
        return positions, "metres to find neighbours, because the camera moves up or down in them"
    return degrees, f"degrees to find neighbours{', the latitude first' if latitude_first else ''}"


def in_metres(positions, layout, file, tell=True):
    """The positions in metres, to tell neighbours. `positions`: by name, in the order of `file`. Positions
    that can be metres or degrees are taken as degrees, except those of a vertical scan: the cameras, by
    which RefinePoses decides, are not known yet. `tell`: prints a line about an unknown unit or order."""
    is_guess = layout.degrees is None and can_be_degrees(positions.values())
    if not positions or not (layout.degrees or is_guess):
        return positions
    latitude_first = latitude_is_first(positions.values(), layout)
    if is_guess:
        found, reading = guessed(positions, latitude_first)
        if tell:
            tell_guess(file, reading)
        return found
    if tell and latitude_first:
        print(f"{file}: the second coordinate is beyond {MOST_LATITUDE} degrees: the first is taken as the "
              "latitude to find neighbours", flush=True)
    return metres_of_degrees(positions, latitude_first)
