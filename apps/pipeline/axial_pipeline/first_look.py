# SPDX-License-Identifier: GPL-3.0-or-later
"""A look at the photographs for --check: contrast, blur and overlap, from features that COLMAP finds in photographs
that are made smaller, in a folder that exists only meanwhile.

If all photographs would take too long, pairs of neighbours by name are looked at, evenly spread over the dive."""

import array
import dataclasses
import os
import pathlib
import sqlite3
import statistics
import tempfile

from . import colmap, database, estimates, features, left_out
from .failure import Failure
from .first_checks import PREFIX
from .files import few
from .running import logged

SIDE = 640            # the longer side of the photographs that are looked at [px]
SECONDS = 20          # for the features, about; weak features take as long again, or twice
READ_SECONDS = 0.03   # CPU time of a megapixel of a photograph, to read it
FIND_SECONDS = 2.3    # CPU time of a megapixel of the smaller photograph, to find features in it
UNKNOWN_SIZE = (4000, 3000)
SCARCE = 300          # features of a smaller photograph with little contrast
MATCHED = 800         # features of a photograph, the coarsest, that are matched


@dataclasses.dataclass
class Look:
    """What was seen. Features by name: with COLMAP's threshold, and with weak ones where there are few."""
    plain: dict
    found: dict
    wrong: dict     # as left_out.found_in()
    overlaps: dict  # the part of two photographs that overlaps, by pair of names


def most_photographs(sizes):
    """How many photographs of these sizes can be looked at within SECONDS."""
    pixels = statistics.mean(size[0] * size[1] for size in sizes)
    small = statistics.mean(estimates.shrunk(size, SIDE) for size in sizes)
    cores = len(os.sched_getaffinity(0))
    return max(2, int(SECONDS * cores * 1e6 / (READ_SECONDS * pixels + FIND_SECONDS * small)))


def sample_of(names, most):
    """At most `most` of the sorted `names`: all, or pairs of neighbours that are evenly spread."""
    if len(names) <= most:
        return list(names)
    firsts = [number * (len(names) - 1) // (most // 2) for number in range(most // 2)]
    return [names[k] for k in sorted({k for first in firsts for k in (first, first + 1)})]


def neighbours_in(names, chosen):
    """The pairs of neighbours among the sorted `names` of which both were chosen."""
    wanted = set(chosen)
    return [pair for pair in zip(names, names[1:]) if wanted.issuperset(pair)]


def find_features(given, sizes, chosen, file):
    """Finds features in the photographs `chosen`. `file`: a new database. Returns the Features with COLMAP's
    threshold; the database gets weak features, too."""
    folder, listed = file.parent, file.with_name("photographs.txt")
    command = lambda to, *more: colmap.features(to, given.images, "OPENCV", more=[*colmap.smaller(SIDE), *more])
    features.detect({name: sizes[name] for name in chosen}, listed,
                    lambda names: command(file, "--image_list_path", names), folder / "logs" / "features.log")
    plain = database.features(file) or {}
    features.take_weak_features(file, lambda to, names, threshold: command(
        to, *colmap.weak_features(names, threshold)), folder, tell=lambda line: None)
    return plain


def keep_coarse(file):
    """Keeps the MATCHED coarsest features of each photograph in a database, so that COLMAP matches them soon."""
    with database.opened(file) as connection:
        for image, in connection.execute("SELECT image_id FROM keypoints WHERE rows > ?", (MATCHED,)).fetchall():
            kept = database.keypoints_of(connection, image).coarsest(MATCHED)
            places = array.array("f", [value for place in zip(kept.xs, kept.ys) for value in place])
            connection.execute("UPDATE keypoints SET rows = ?, cols = 2, data = ? WHERE image_id = ?",
                               (MATCHED, places.tobytes(), image))
            connection.execute("UPDATE descriptors SET rows = ?, data = ? WHERE image_id = ?",
                               (MATCHED, kept.descriptors, image))


def share_of_cells(keypoints, numbers, size):
    """The part of the cells with features that holds features of these numbers."""
    everywhere = database.cells_of(zip(keypoints.xs, keypoints.ys), size)
    return len(database.cells_of(keypoints.places(numbers), size)) / max(1, len(everywhere))


def overlaps_in(file, pairs):
    """The part of both photographs that verified matches cover, by pair of names. `file`: COLMAP's database with
    matches."""
    with database.opened(file) as connection:
        images = {name: (image, (width, height)) for name, image, width, height in connection.execute(
            "SELECT name, image_id, width, height FROM images JOIN cameras USING (camera_id)")}
        matches = {pair: data for pair, data in connection.execute("SELECT pair_id, data FROM two_view_geometries")}
        found = {}
        for pair in pairs:
            ends = sorted(images[name] for name in pair)
            numbers = array.array("I", matches.get(database.PAIR * ends[0][0] + ends[1][0]) or b"")
            found[pair] = statistics.mean(
                share_of_cells(database.keypoints_of(connection, image), numbers[k::2], size)
                for k, (image, size) in enumerate(ends))
    return found


def match(file, pairs):
    """Matches the pairs of photographs in the database `file`. Returns overlaps_in()."""
    keep_coarse(file)
    listed, named = file.with_name("pairs.txt"), database.names(file)
    ids = {name: image for image, name in named.items()}
    colmap.write_pairs(listed, [(ids[first], ids[second]) for first, second in pairs])
    database.name_by_ids(file)
    logged(colmap.matches(file, "cascade", more=colmap.listed_pairs(listed)), file.parent / "logs" / "matches.log",
           "matches")
    database.give_names(file, named)
    return overlaps_in(file, pairs)


def look(given, sizes, chosen):
    """The Look at the photographs `chosen`. `sizes`: of all photographs, by name. Fails if COLMAP fails."""
    with tempfile.TemporaryDirectory(prefix=PREFIX) as folder:
        file = pathlib.Path(folder) / "features.db"
        (file.parent / "logs").mkdir()
        try:
            plain = find_features(given, sizes, chosen, file)
            found, wrong = database.features(file) or {}, left_out.found_in(file, {})
            pairs = neighbours_in(sorted(sizes.keys() - wrong.keys()), found)
            return Look(plain, found, wrong, match(file, pairs) if pairs else {})
        except (Failure, sqlite3.Error) as error:
            reason, *_ = str(error).partition(", its output is in ")  # which is removed
            raise Failure(f"--images {given.images}: COLMAP could not find and match features of photographs made "
                          f"smaller ({reason})") from None


def contrast_in_words(look):
    counts = [one.count for one in look.plain.values()]
    yield f"{statistics.median_low(counts)} features in a photograph (median; {min(counts)} to {max(counts)})"
    scarce = [name for name, one in look.plain.items() if one.count < SCARCE]
    if scarce:
        yield (f"little in {len(scarce)} of {len(counts)}, as in haze or over sand; weaker features are taken, too: "
               f"{few(scarce)}")


def blur_in_words(look):
    _, usual = features.blurred(look.found)
    least = max(features.LEAST_BLUR, features.BLURRED * usual)
    no = "no other" if any(kind == left_out.BLURRED for kind, _ in look.wrong.values()) else "no"
    yield f"{no} photograph is blurred by more than {least:.0f} pixels beside the others"


def left_out_in_words(look):
    """A row for each kind of photographs that the run will leave out."""
    for kind in (left_out.BLURRED, left_out.DARK, left_out.DOUBLED):
        names = [f"{name} ({words})" if words != kind else name
                 for name, (is_kind, words) in sorted(look.wrong.items()) if is_kind == kind]
        if names:
            yield kind, f"{len(names)} of {len(look.found)}, which the run will probably leave out: {few(names)}"


def overlap_in_words(look):
    apart = [" and ".join(pair) for pair, share in look.overlaps.items() if not share]
    shares = [share for share in look.overlaps.values() if share]
    if shares:
        yield (f"about {statistics.median(shares):.0%} between neighbours by name (median of {len(shares)} pairs; "
               f"{min(shares):.0%} to {max(shares):.0%})")
    if apart:
        yield f"none found in {len(apart)} of {len(look.overlaps)} pairs of neighbours by name: {few(apart)}"


def rows(given, sizes):
    """What was seen, for --check: pairs of a word and a text. `sizes`: of the photographs, by name; None if it is
    not known."""
    names = sorted(sizes)
    chosen = sample_of(names, most_photographs([size or UNKNOWN_SIZE for size in sizes.values()]))
    seen = look(given, sizes, chosen)
    unread = [name for name in chosen if name not in seen.found]
    yield "looked at", (f"{len(seen.found)} of {len(names)} photographs, made smaller to {SIDE} pixels if they are "
                        "larger")
    if unread:
        yield "unreadable", f"COLMAP skips {few(unread)}"
    if not seen.found:
        return
    yield from (("contrast", line) for line in contrast_in_words(seen))
    yield from (("blur", line) for line in blur_in_words(seen))
    yield from left_out_in_words(seen)
    yield from (("overlap", line) for line in overlap_in_words(seen))
