# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of `--scale-from positions:FILE`, in which each line gives an image name and its camera
position. Names are read as RefinePoses reads them."""

import math
import pathlib
import re

from .failure import Failure

PREFIX = "positions:"
LEAST_NAMES = 3  # fewer positions determine no scale and orientation


def file_of(scale_from):
    """The file that --scale-from names; None if it names none."""
    return scale_from[len(PREFIX):] if scale_from.startswith(PREFIX) else None


def entry_before_end(text):
    """NAME and (X, Y, Z) of `NAME X Y Z`; None if the text has another form."""
    numbers = []
    for _ in range(3):
        words = text.rsplit(None, 1)
        try:
            numbers.insert(0, float(words[-1]))
        except (IndexError, ValueError):
            return None
        text = words[0].rstrip() if len(words) == 2 else ""
    return (text, tuple(numbers)) if text else None


def entry_in(line, known):
    """The image name in a line and its position; None if the line is a comment or empty. Three
    numbers follow the name; without them, the position is None. A comment begins at a `#` at the
    beginning or after a space, unless the name with this `#` is `known`. A name may be in quotes."""
    line = line.strip()
    ends = [len(line), *(i for i in reversed(range(len(line)))
                         if line[i] == "#" and (i == 0 or line[i - 1].isspace()))]
    entries = [entry for entry in (entry_before_end(line[:end]) for end in ends) if entry]
    found = next((entry for entry in entries if known(entry[0])), None)
    if found or not line or line[0] == "#":
        return found
    quoted = re.match(r'"((?:[^"]|"")*)"(\s.*)', line)
    if quoted:
        rest = entry_before_end("n" + quoted[2].split("#")[0])
        return quoted[1].replace('""', '"'), rest[1] if rest and rest[0] == "n" else None
    return entries[-1] if entries else (line, None)


def entries_of(file, known):
    """The number of each line with an image name, and entry_in() of this line."""
    lines = pathlib.Path(file).read_text(encoding="utf-8-sig", errors="replace").splitlines()
    entries = ((number, entry_in(line, known)) for number, line in enumerate(lines, 1))
    return [(number, *entry) for number, entry in entries if entry]


def read(file, known):
    """The positions of the `known` images, by name. Fails at a line without a position."""
    entries = entries_of(file, known)
    for number, _, position in entries:
        if position is None or not all(map(math.isfinite, position)):
            raise Failure(f"{file}:{number}: must be NAME X Y Z with finite numbers")
    return {name: position for _, name, position in entries if known(name)}


def check(file, images):
    """Fails if the file names fewer than three photographs of the folder `images`. Prints how many
    names are no photographs: RefinePoses would skip a misspelt name like that of a photograph
    without a pose."""
    names = [name for _, name, _ in entries_of(file, lambda name: (images / name).is_file())]
    missing = [name for name in names if not (images / name).is_file()]
    if len(names) - len(missing) < LEAST_NAMES:
        raise Failure(f"{file}: {len(names) - len(missing)} of its names are photographs in "
                      f"{images}, at least {LEAST_NAMES} are needed")
    if missing:
        print(f"{file}: {len(missing)} of {len(names)} names are not photographs in {images} and "
              f"are ignored, {missing[0]} first", flush=True)
