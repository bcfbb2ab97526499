# SPDX-License-Identifier: GPL-3.0-or-later
"""Features of photographs under water: haze and sand have little contrast, and divers blur photographs."""

import statistics

from . import colmap, database, files
from .files import few
from .running import logged, tell

ENOUGH = 1000        # features of a photograph; with fewer, COLMAP's detector takes weaker ones, too
WEAK = 0.001         # the threshold of weak features; COLMAP's own is 0.0067
RUNGS = (0.004, 0.002)  # thresholds in between, for photographs with too few features to tell blur
SCARCE = 300         # features that are few even so
BLURRED = 2          # times the finest features of the other photographs, at least
LEAST_BLUR = 1.8     # finest features of a blurred photograph [px]; sharp ones have 0.93
JUDGED = 10          # features that tell blur; a photograph with fewer counts as sharp
DARK = 30            # features, weak ones among them; with fewer matches, COLMAP's mapper finds no pose
MOST_WRONG = 0.5     # if more of the photographs are blurred or dark, none is
LOW = "weak_features.db"


def lacking(found, threshold):
    """The photographs that need weaker features: to tell blur, or more features unless they are blurred. Weak
    features of blurred photographs are noise and traces of JPEG, which are as fine as the features of sharp
    photographs and would hide the blur."""
    if threshold in RUNGS:
        return [name for name, one in found.items() if one.count < JUDGED]
    names_of_blurred, _ = blurred(found)
    return [name for name, one in found.items() if one.count < ENOUGH and name not in names_of_blurred]


def take_weak_features(features, command_of, out, tell=tell):
    """Adds weak features to the photographs that have few, except blurred ones. Where there are too few to tell
    blur, thresholds in between come first, because noise is weaker than what is left of the scene.
    `features`: COLMAP's database. `command_of`: the detector's command by database, file with names of
    photographs, and threshold. `tell`: gets a line for the user."""
    found = database.features(features)
    if found is None:
        return
    wanted = lacking(found, WEAK)
    if wanted:
        tell(f"{len(wanted)} of {len(found)} photographs have few features, as in haze or over sand: weaker "
             "ones are taken, too")
    for threshold in (*RUNGS, WEAK):
        sizes = {name: found[name].size for name in lacking(found, threshold)}
        if sizes:
            take(features, sizes, command_of, threshold, out)
            found = database.features(features)


def take(features, sizes, command_of, threshold, out):
    """Replaces the features of photographs by those with this threshold. `sizes`: of the photographs, by name. The
    rest as for take_weak_features()."""
    low, names = out / LOW, out / "weak_features.txt"
    for path in colmap.database_files(low):
        files.clear(path)
    detect(sizes, names, lambda listed: command_of(low, listed, threshold), out / "logs" / "weak-features.log")
    if database.names(low) is not None:
        database.take_features(features, low, sizes)
    for path in (*colmap.database_files(low), names):
        files.clear(path)


def detect(sizes, listed, command_of, log):
    """Runs COLMAP's detector for the photographs of each size by themselves, because COLMAP skips other sizes than
    the first one. `sizes`: by name. `listed`: the file for their names. `command_of`: the detector by this file. `log`:
    of the first size."""
    for number, size in enumerate(sorted(set(sizes.values()), key=lambda one: one or (0, 0)), 1):
        files.write_names(listed, [name for name in sizes if sizes[name] == size])
        logged(command_of(listed), log.with_stem(f"{log.stem}-{number}") if number > 1 else log, "features")


def blurred(found):
    """The names of photographs that are clearly blurred beside the others, with the scale [px] of their
    finest features, and the scale of the others."""
    judged = {name: one.fine for name, one in found.items() if one.count >= JUDGED}
    if not judged:
        return {}, 0
    usual = statistics.median(judged.values())
    names = {name: fine for name, fine in judged.items() if fine > max(LEAST_BLUR, BLURRED * usual)}
    return (names if len(names) <= MOST_WRONG * len(found) else {}), usual


def dark(found):
    """The Features of the photographs that have too few for a pose, by name."""
    few_features = {name: one for name, one in found.items() if one.count < DARK}
    return few_features if len(few_features) <= MOST_WRONG * len(found) else {}


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
        yield (f"warning: {few(names)}: blurred (finest features {min(names.values()):.1f} px or more, "
               f"{usual:.1f} px in the others)")
