# SPDX-License-Identifier: GPL-3.0-or-later
"""The options --matcher and --vocabulary of `reconstruct`: which pairs of photographs COLMAP
matches."""

from . import cascade, colmap, files, positions
from .database import named_if_damaged, opened
from .failure import Failure
from .programs import words_of
from .running import tell
from .steps import Step

MATCHERS = ("auto", "exhaustive", "cascade", "sequential", "spatial", "vocabulary")
FROM_CASCADE = 30  # photographs, from which "auto" is "cascade" instead of "exhaustive"
# Photographs with which "spatial" matches each photograph. If photographs overlap by 80 % along a
# track and by 60 % across, the 30 nearest include those on the tracks to the left and to the right.
NEIGHBOURS = 30
# The number of neighbours limits the work already. A limit of their distance would only leave
# photographs without neighbours where a survey is sparse: this limit [m] is beyond every survey.
FARTHEST = 1000000
LEAST_POSITIONS = 2  # fewer give no pair


def chosen(matcher, count):
    """The matcher that `matcher` means for `count` photographs."""
    if matcher != "auto":
        return matcher
    return "cascade" if count >= FROM_CASCADE else "exhaustive"


def check(given, images):
    """Checks the two options before hours of work. The paths of `given` are absolute, except that
    of --vocabulary, which becomes absolute. `images`: the photographs, Image by name (photographs.py)."""
    if given.matcher == "vocabulary" and not given.vocabulary:
        raise Failure("--matcher vocabulary: needs --vocabulary FILE, a vocabulary tree for COLMAP "
                      "(docs/photographs.md)")
    if given.vocabulary and given.matcher != "vocabulary":
        raise Failure(f"--vocabulary {given.vocabulary}: is only for --matcher vocabulary")
    if given.vocabulary:
        given.vocabulary = files.existing("--vocabulary", given.vocabulary, is_file=True)
    if given.matcher == "spatial":
        check_positions(given, images)


def check_positions(given, images):
    file = positions.file_of(given.scale_from)
    if file is None:
        return fail_if_few(sum(image.exif.has_position for image in images.values()), given.images)
    positions.read(file, list(images))
    if not colmap.has_option("spatial_matcher", "SpatialMatching.is_gps"):
        raise Failure("--matcher spatial: this version of COLMAP takes no positions from --scale-from "
                      "positions:FILE (COLMAP 3.8 does); choose another --matcher")


def fail_if_few(count, images, file=None):
    """`count`: the photographs of `images` that have a position, in `file` or in themselves."""
    if count >= LEAST_POSITIONS:
        return
    if file:
        raise Failure(f"--matcher spatial: {file} names {count} photographs as in {images}")
    raise Failure(f"--matcher spatial: {count or 'none'} of the photographs in {images} "
                  f"{'has' if count else 'have'} a GPS position (latitude, longitude and altitude); "
                  "give --scale-from positions:FILE or choose another --matcher")


def more_options(given):
    """The options of COLMAP's matcher. COLMAP counts a photograph as one of its own neighbours. Its
    default takes positions as GPS positions and ignores their height."""
    if given.matcher == "vocabulary":
        return ["--VocabTreeMatching.vocab_tree_path", given.vocabulary]
    if given.matcher != "spatial":
        return []
    metric = ["--SpatialMatching.is_gps", 0, "--SpatialMatching.ignore_z", 0]
    return [*(metric if positions.file_of(given.scale_from) else []),
            "--SpatialMatching.max_num_neighbors", NEIGHBOURS + 1,
            "--SpatialMatching.max_distance", FARTHEST]


def step(given, features, database, prepare=lambda: None, reads=(), settings=()):
    """The step that copies the database `features` to `database` and adds matches. `prepare`: called before
    photographs are matched. `reads`: what it reads. `settings`: words that say what `prepare` does."""
    if given.matcher == "cascade":
        return cascade.step(given, features, database, prepare, reads, settings)
    file = positions.file_of(given.scale_from) if given.matcher == "spatial" else None
    reads = [path for path in (file, given.vocabulary, *reads) if path]

    def before():
        files.copy_once(features, database)
        prepare()
        if given.matcher == "spatial":
            with named_if_damaged(features):
                prepare_positions(database, file)

    return Step("matches", colmap.matches(database, given.matcher,
                                         more=[*more_options(given), *words_of("matches", given)]),
                makes=database, reads=reads,
                changed=[*colmap.database_files(database), *cascade.files_beside(database)], before=before,
                settings=settings)


def prepare_positions(database, file):
    """Makes COLMAP's spatial matcher use the positions of `file` [m], or the GPS positions that are
    in the database if `file` is None. Can be repeated. Prints how many photographs have no
    position; check_positions() tells how the file is read. Does nothing to the database of a newer
    COLMAP, which has its own table for GPS positions."""
    with opened(database) as connection:
        columns = {row[1] for row in connection.execute("PRAGMA table_info(images)")}
        if "prior_tx" not in columns:
            return
        names = [name for name, in connection.execute("SELECT name FROM images")]
        if file:
            write_positions(connection, positions.read(file, names, tell=False))
        # COLMAP takes a missing position for a place near all others, and skips three zeros.
        connection.execute("UPDATE images SET prior_tx = 0, prior_ty = 0, prior_tz = 0 WHERE "
                           "prior_tx IS NULL OR prior_ty IS NULL OR prior_tz IS NULL")
        count, = connection.execute("SELECT count(*) FROM images WHERE prior_tx != 0 OR "
                                    "prior_ty != 0 OR prior_tz != 0").fetchone()
    fail_if_few(count, database, file)
    if count < len(names):
        tell(f"{len(names) - count} of {len(names)} photographs have no position and are not matched")


def write_positions(connection, known):
    """Writes `known`, positions by image name, and removes all others. Moves them so that all
    coordinates are at least 1, because COLMAP skips a camera at the origin, and because its single
    precision would round UTM coordinates to half a metre."""
    lowest = [min(axis) for axis in zip(*known.values())]
    connection.execute("UPDATE images SET prior_tx = NULL, prior_ty = NULL, prior_tz = NULL")
    connection.executemany(
        "UPDATE images SET prior_tx = ?, prior_ty = ?, prior_tz = ? WHERE name = ?",
        [(*(1 + value - low for value, low in zip(position, lowest)), name)
         for name, position in known.items()])
