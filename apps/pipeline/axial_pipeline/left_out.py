# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs that do no good: blurred, dark, and doubled ones. `reconstruct` leaves them out before COLMAP
matches, unless the user gives --keep-all.

There is no rule here for photographs above water or of other things than the seabed: nothing in one photograph
tells them for certain. They match no photograph of the seabed, and poses.py names them with that reason."""

from . import database, doubles, features
from .failure import Failure
from .files import few
from .running import tell

BLURRED, DARK, DOUBLED = "blurred", "dark", "doubled"


def found_in(file, doubled):
    """What is wrong with photographs, by name: pairs of a kind and words. `file`: COLMAP's database with features.
    `doubled`: as doubles.identical()."""
    found = database.features(file) or {}
    wrong = {name: (DOUBLED, f"the same file as {twin}") for name, twin in doubled.items() if name in found}
    wrong |= {name: (BLURRED, BLURRED) for name in features.blurred(found)[0] if name not in wrong}
    wrong |= {name: (DARK, f"dark or without contrast, with {one.count} features")
              for name, one in features.dark(found).items() if name not in wrong}
    alike = doubles.alike(file, left_out=wrong) if found else {}
    return wrong | {name: (DOUBLED, f"the same view as {twin}") for name, twin in alike.items()}


def refuse_needed(reasons, needed, scale_from):
    """Fails if a photograph that is left out has an end of the length in --scale-from. `reasons`: words by name, as
    in database.left_out()."""
    name = next((name for name in sorted(needed) if name in reasons), None)
    if name:
        raise Failure(f"--scale-from {scale_from}: {name} is left out, because it is {reasons[name]}; name another "
                      "photograph, or give --keep-all")


def leave_out(found, file, doubled, needed=(), scale_from=""):
    """Removes photographs that do no good from COLMAP's database `file`, which keeps their reasons. Prints their
    names. `found`: the database with the features of all photographs. `doubled`: as doubles.identical(). Fails, and
    changes nothing, if one of them is among `needed`, the photographs that `scale_from` names."""
    wrong = found_in(found, doubled)
    reasons = {name: words for name, (_, words) in wrong.items()}
    refuse_needed(reasons, needed, scale_from)
    if reasons:
        database.leave_out(file, reasons)
    for kind in (BLURRED, DARK, DOUBLED):
        names = sorted(name for name, one in wrong.items() if one[0] == kind)
        if names:
            tell(f"{len(names)} {kind} photographs are left out (--keep-all keeps them): {few(names)}")
