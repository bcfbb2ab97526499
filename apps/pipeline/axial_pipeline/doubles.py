# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs that show the same from the same place: copies of a file, and frames of a burst without motion.

Measured on photographs of 480 x 360 pixels from the scenes reef, reef-hazy and sand, with further noise of 2 grey
levels: of the 200 coarsest features, 96, 75 and 43 % are at the same place, with the same look, in a photograph
with other noise; 2, 12 and 6 % after a move of 1.5 pixels; none in the next photograph of the dive."""

import collections
import contextlib
import hashlib
import pathlib

from . import still_features
from .database import DAMAGE, by_camera, cells_of, keypoints_of, opened
from .failure import Failure
from .photographs import LEAST

CHUNK = 1 << 20       # bytes of a file that are read at once
COARSE = 200          # features of a photograph that are looked for, the coarsest
AMONG = 2 * COARSE    # features of the other photograph among which they are looked for
LEAST_COARSE = 50     # a photograph with fewer features tells nothing
LEAST_SHARE = 0.4     # of the features, at the same place
LEAST_SPREAD = 0.75   # of the cells that the features cover: an arm of a strobe covers few
WINDOW = 10           # photographs before, by name, with which each photograph is compared
MOST_ALIKE = 0.5      # of the photographs; if more are alike, their features move with the camera


def digest_of(path):
    found = hashlib.sha256()
    with open(path, "rb") as file:
        while chunk := file.read(CHUNK):
            found.update(chunk)
    return found.digest()


def groups_by(key, names):
    """Lists of two and more names that have the same key."""
    groups = collections.defaultdict(list)
    for name in names:
        groups[key(name)].append(name)
    return [group for group in groups.values() if len(group) > 1]


def identical(folder, names, preferred=()):
    """Photographs with the same bytes as another one: the name of the one that is kept, by name. `names`: files in
    `folder`. `preferred`: names that are kept if possible. Fails if fewer than LEAST photographs differ, or if a
    file cannot be read."""
    folder, found = pathlib.Path(folder), {}
    try:
        for alike in groups_by(lambda name: (folder / name).stat().st_size, names):
            for group in groups_by(lambda name: digest_of(folder / name), alike):
                kept, *others = sorted(group, key=lambda name: (name not in preferred, name))
                found.update(dict.fromkeys(others, kept))
    except OSError as error:
        raise Failure(f"--images {error.filename}: cannot be read: {error.strerror}") from None
    if len(names) - len(found) < LEAST:
        raise Failure(f"--images {folder}: all {len(names)} photographs have the same contents")
    return dict(sorted(found.items()))


def is_alike(reference, other, size):
    """Whether features all over the photograph `reference` are at the same place in `other`."""
    move, numbers = still_features.move_of(size[0]), range(len(reference.xs))
    if min(len(reference.xs), len(other.xs)) < LEAST_COARSE:
        return False
    counts = still_features.counts_of_rest(reference, [(other, still_features.cells_of(other, 2 * move))], move)
    same = [k for k in numbers if counts[k]]
    return (len(same) >= LEAST_SHARE * len(numbers) and len(cells_of(reference.places(same), size)) >=
            LEAST_SPREAD * len(cells_of(reference.places(numbers), size)))


def alike_in(photographs, size):
    """As alike(), for the photographs of one camera: pairs of a name and Keypoints."""
    kept, found = [], {}
    for name, features in photographs:
        among = features.coarsest(AMONG)
        twin = next((other for other, reference in reversed(kept[-WINDOW:])
                     if is_alike(reference, among, size)), None)
        if twin:
            found[name] = twin
        else:
            kept.append((name, features.coarsest(COARSE)))
    return found


def alike(file, left_out=()):
    """Photographs without motion since another one: the name of the one that is kept, by name. `file`: COLMAP's
    database with features. `left_out`: names that do not count. Nothing if `file` is no such database."""
    found = {}
    with contextlib.suppress(*DAMAGE), opened(file) as connection:
        for size, images in by_camera(connection):
            images = sorted((one for one in images if one[1] not in left_out),  # in the order of the files' names
                            key=lambda one: (pathlib.PurePath(one[1]).name, one[1]))
            twins = alike_in(((name, keypoints_of(connection, image)) for image, name in images), size)
            sizes = collections.Counter(twins.values())
            found |= {name: twin for name, twin in twins.items() if sizes[twin] + 1 <= MOST_ALIKE * len(images)}
    return found
