# SPDX-License-Identifier: GPL-3.0-or-later
"""COLMAP's text models: poses, camera centres, and copies without some images or points."""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "apps" / "pipeline"))
from axial_pipeline.model_text import copy, records, triples  # noqa: E402, F401


def images_of(model):
    """The poses by image name, each as seven numbers (QW .. TZ) in text form."""
    return {line.split(maxsplit=9)[9]: line.split()[1:8] for line in records(model / "images.txt")[0::2] if line}


def centre(pose):
    """The camera centre -R^T t of a pose. The rows are those of R^T."""
    w, x, y, z, *t = map(float, pose)
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))
    return [-sum(a * b for a, b in zip(row, t)) for row in rows]


def centres(model):
    return {name: centre(pose) for name, pose in images_of(model).items()}


def positions(model):
    """The text of a position file with the camera centres."""
    return "".join(f"{name} {x} {y} {z}\n" for name, (x, y, z) in sorted(centres(model).items()))


def baseline(model):
    """The argument of --scale-from: the true distance between the first image and the image farthest
    from it."""
    places = centres(model)
    first = min(places)
    far = max(places, key=lambda name: math.dist(places[first], places[name]))
    return f"images:{first},{far},{math.dist(places[first], places[far]):.9f}"
