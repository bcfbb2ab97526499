# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of `--scale-from positions:FILE`, in which each line gives an image name and its camera
position. Names are read as RefinePoses reads them."""

import re

from .failure import Failure

PREFIX = "positions:"
LEAST_NAMES = 3  # fewer positions determine no scale and orientation


def file_of(scale_from):
    """The file that --scale-from names; None if it names none."""
    return scale_from[len(PREFIX):] if scale_from.startswith(PREFIX) else None


def without_last_number(text):
    """The text without its last word, if this word is a number; otherwise None."""
    words = text.rsplit(None, 1)
    try:
        float(words[-1])
    except (IndexError, ValueError):
        return None
    return words[0].rstrip() if len(words) == 2 else ""


def name_before_numbers(text):
    """NAME of `NAME X Y Z`; None if the text has another form."""
    for _ in range(3):
        if text is not None:
            text = without_last_number(text)
    return text or None


def name_in(line, known):
    """The image name in a line; None if the line is a comment or empty. Three numbers follow the
    name. A comment begins at a `#` at the beginning or after a space, unless the name with this `#`
    is `known`. A name may be in quotes."""
    line = line.strip()
    ends = [len(line), *(i for i in reversed(range(len(line)))
                         if line[i] == "#" and (i == 0 or line[i - 1].isspace()))]
    names = [name for name in (name_before_numbers(line[:end]) for end in ends) if name]
    found = next(filter(known, names), None)
    if found or not line or line[0] == "#":
        return found
    quoted = re.match(r'"((?:[^"]|"")*)"\s', line)
    return quoted[1].replace('""', '"') if quoted else names[-1] if names else line


def check(file, images):
    """Fails if the file names fewer than three photographs of the folder `images`. Prints how many
    names are no photographs: RefinePoses would skip a misspelt name like that of a photograph
    without a pose."""
    names = [name_in(line, lambda name: (images / name).is_file())
             for line in file.read_text(encoding="utf-8-sig", errors="replace").splitlines()]
    names = [name for name in names if name]
    missing = [name for name in names if not (images / name).is_file()]
    if len(names) - len(missing) < LEAST_NAMES:
        raise Failure(f"{file}: {len(names) - len(missing)} of its names are photographs in "
                      f"{images}, at least {LEAST_NAMES} are needed")
    if missing:
        print(f"{file}: {len(missing)} of {len(names)} names are not photographs in {images} and "
              f"are ignored, {missing[0]} first", flush=True)
