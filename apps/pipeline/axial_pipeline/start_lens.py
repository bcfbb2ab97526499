# SPDX-License-Identifier: GPL-3.0-or-later
"""The lens with which COLMAP starts under water: the lens in air behind its port, as one lens."""

from . import database, lenses

FILE = "start_lens.txt"
WATER = 1.333  # index of refraction; a start does not need a better one


def lens_for(found, camera, width, height):
    """The model's name and the parameters of a camera of COLMAP: of the lens with its id, or of the only lens. None
    if no lens has its size."""
    return next(((lens.model, lens.colmap_parameters()) for lens in found
                 if (len(found) == 1 or lens.number == camera) and lens.size == (width, height)), None)


def start_of(lens, model):
    """The parameters of the camera model `model` that COLMAP starts with: the lens in air, with its focal lengths
    times the water's index, without distortion. If COLMAP has no start, it guesses a focal length and may find no
    poses. None for FOV, whose distortion must not be 0."""
    if model == "FOV":
        return None
    fx, fy, cx, cy = lens.parameters[:4]
    focal = [(fx + fy) / 2] if lenses.has_one_focal_length(model) else [fx, fy]
    return [*(WATER * f for f in focal), cx, cy, *[0] * lenses.MODELS[model]]


def starts_of(given):
    """start_of() each camera of COLMAP. The start of a lens that is the only one has nine digits."""
    if given.cameras:
        return [start_of(one.lens, given.lens_model) for one in given.cameras]
    start = [start_of(lens, given.lens_model) for lens in lenses.in_file(given.lens)[:1]]
    return [one and [float(f"{number:.9g}") for number in one] for one in start]


def set_in(file, given, out):
    """Gives the cameras of COLMAP's database `file` their lens: the lens behind the port, which the step
    "lens" wrote. With --lens-model, it is the lens in air with its focal length times the water's index,
    which COLMAP then calibrates."""
    if database.names(file) is None:
        return
    if not given.lens_model:
        found = lenses.in_file(out / FILE)
        return database.set_lenses(file, lambda *camera: lens_for(found, *camera))
    starts = starts_of(given)
    if all(starts) and starts:
        database.set_lenses(file, lambda number, *_: (given.lens_model,
                                                      starts[number - 1 if given.cameras else 0]))
