# SPDX-License-Identifier: GPL-3.0-or-later
"""The lens with which COLMAP starts under water: the lens in air behind its port, as one lens."""

from . import database, lens

FILE = "start_lens.txt"


def read(file):
    """The lenses of a cameras.txt: (width, height, model, parameters) by camera id."""
    lenses = {}
    for line in file.read_text().splitlines():
        words = line.split()
        if words and not line.startswith("#"):
            lenses[int(words[0])] = (int(words[2]), int(words[3]), words[1], [float(word) for word in words[4:]])
    return lenses


def lens_for(lenses, camera, width, height):
    """The lens of a camera of COLMAP: with its id, or the only lens; with its size."""
    found = lenses.get(camera) if len(lenses) > 1 else next(iter(lenses.values()), None)
    return (found[2], found[3]) if found and found[:2] == (width, height) else None


def set_in(file, given, out):
    """Gives the cameras of COLMAP's database `file` their lens: the lens behind the port, which the step
    "lens" wrote. With --lens-model, it is the lens in air with its focal length times the water's index,
    which COLMAP then calibrates."""
    if database.names(file) is None:
        return
    if not given.lens_model:
        lenses = read(out / FILE)
        return database.set_lenses(file, lambda *camera: lens_for(lenses, *camera))
    if given.cameras:
        starts = [lens.start_of(one.lens.parameters, given.lens_model) for one in given.cameras]
        return database.set_lenses(file, lambda number, *_: (given.lens_model, starts[number - 1]))
    start = lens.start_under_water(given.lens, given.lens_model)
    if start:
        parameters = [float(number) for number in start.split(",")]
        database.set_lenses(file, lambda *camera: (given.lens_model, parameters))
