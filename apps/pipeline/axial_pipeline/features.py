# SPDX-License-Identifier: GPL-3.0-or-later
"""Features of photographs under water: haze and sand have little contrast, and divers blur photographs."""

import statistics

from . import colmap, database, files
from .photographs import few
from .running import logged

ENOUGH = 1000        # features of a photograph; with fewer, COLMAP's detector takes weaker ones, too
WEAK = 0.001         # the threshold of weak features; COLMAP's own is 0.0067
SCARCE = 300         # features that are few even so
BLURRED = 2          # times the finest features of the other photographs, at least
LEAST_BLUR = 1.8     # finest features of a blurred photograph [px]; sharp ones have 0.93
JUDGED = 20          # features that tell blur; a photograph with fewer counts as sharp
MOST_BLURRED = 0.5   # if more of the photographs are blurred, none counts as blurred
LOW = "weak_features.db"


def take_weak_features(features, command_of, out):
    """Adds weak features to the photographs that have few, except blurred ones: their weak features are noise
    and traces of JPEG, which are as fine as the features of sharp photographs and would hide the blur.
    `features`: COLMAP's database. `command_of`: the detector's command by database, file with names of
    photographs, and threshold."""
    found = database.features(features)
    if found is None:
        return
    names_of_blurred, _ = blurred(found)
    wanted = [name for name, one in found.items() if one.count < ENOUGH and name not in names_of_blurred]
    if not wanted:
        return
    low, names = out / LOW, out / "weak_features.txt"
    for path in colmap.database_files(low):
        files.clear(path)
    print(f"    {len(wanted)} of {len(found)} photographs have few features, as in haze or over sand: weaker "
          "ones are taken, too", flush=True)
    for number, size in enumerate(sorted({found[name].size for name in wanted}), 1):  # COLMAP skips other sizes
        files.write(names, "".join(f"{name}\n" for name in wanted if found[name].size == size))
        end = f"-{number}" if number > 1 else ""
        logged(command_of(low, names, WEAK), out / "logs" / f"weak-features{end}.log", "features")
    if database.names(low) is not None:
        database.take_features(features, low, set(wanted))
    for path in (*colmap.database_files(low), names):
        files.clear(path)


def blurred(found):
    """The names of photographs that are clearly blurred beside the others, with the scale [px] of their
    finest features, and the scale of the others."""
    judged = {name: one.fine for name, one in found.items() if one.count >= JUDGED}
    if not judged:
        return {}, 0
    usual = statistics.median(judged.values())
    names = {name: fine for name, fine in judged.items() if fine > max(LEAST_BLUR, BLURRED * usual)}
    return (names if len(names) <= MOST_BLURRED * len(found) else {}), usual


def lines_about(features):
    """Lines about number and spread of the features, and warnings."""
    found = database.features(features)
    if not found:
        return
    counts = [one.count for one in found.values()]
    spread = statistics.median(one.spread for one in found.values())
    yield (f"{statistics.median_low(counts)} features in a photograph (median; {min(counts)} to {max(counts)}), in "
           f"{spread:.0%} of its area")
    scarce = [name for name, one in found.items() if one.count < SCARCE]
    if scarce:
        yield (f"warning: {few(scarce)}: fewer than {SCARCE} features; the photographs are dark or blurred, or show "
               "little but haze")
    names, usual = blurred(found)
    if names:
        yield (f"warning: {few(list(names))}: blurred (finest features {min(names.values()):.1f} px or more, "
               f"{usual:.1f} px in the others)")


def leave_out_blurred(file):
    """Removes blurred photographs from COLMAP's database. Prints their names."""
    names, _ = blurred(database.features(file) or {})
    if names:
        database.leave_out(file, names)
        print(f"    {len(names)} blurred photographs are left out (--keep-all keeps them): {few(list(names))}",
              flush=True)
