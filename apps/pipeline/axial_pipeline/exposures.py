# SPDX-License-Identifier: GPL-3.0-or-later
"""Exposures of photographs by their Exif data, for the step "colors" (RestoreColors --exposures)."""

from . import files
from .option_files import has_option
from .programs import words_of

FILE = "exposures.csv"
LEAST_RATIO = 1.05  # of the longest to the shortest; less is no difference
REPLACED_BY = ("--exposures", "--exposure")  # options of the user


def of(given, images, names):
    """The exposures of the photographs `names`, by name, for --restore-colors. Empty if they hardly differ, if one of
    them is not known, if the photographs are of several cameras, whose sensitivities may differ, or if the user says
    what the exposures are. `images`: Image by name (photographs.py)."""
    known = {name: images[name].exif.exposure for name in names}
    several = len({images[name].exif.camera for name in names}) > 1
    words = words_of("colors", given)
    if (not given.restore_colors or several or None in known.values()
            or any(has_option(words, option) for option in REPLACED_BY)):
        return {}
    return known if max(known.values()) > LEAST_RATIO * min(known.values()) else {}


def lines_about(exposures):
    if not exposures:
        return []
    return [f"exposures (Exif): the longest is {max(exposures.values()) / min(exposures.values()):.1f} times the "
            "shortest"]


def write(file, exposures):
    rows = [f"{name},{exposure:.6g}" for name, exposure in exposures.items()]
    files.write(file, "\n".join(["name,exposure", *rows, ""]))
