# SPDX-License-Identifier: GPL-3.0-or-later
"""The file of `--scale-from positions:FILE`, in which each line gives an image name and its camera
position. Lines and names are read as RefinePoses reads them."""

import math
import pathlib
import posixpath

from . import position_rows
from .failure import Failure

PREFIX = "positions:"
LEAST_NAMES = 3  # fewer positions determine no scale and orientation
PHOTOGRAPHS = {".jpg", ".jpeg", ".png", ".tif", ".tiff", ".bmp", ".webp", ".heic", ".dng", ".arw", ".cr2",
               ".cr3", ".nef", ".orf", ".raf", ".rw2", ".gpr", ".raw"}


def file_of(scale_from):
    """The file that --scale-from names; None if it names none."""
    return scale_from[len(PREFIX):] if scale_from.startswith(PREFIX) else None


def without_extension(path, any_extension):
    suffix = pathlib.PurePosixPath(path).suffix
    return path[:-len(suffix)] if suffix and (any_extension or suffix.lower() in PHOTOGRAPHS) else path


def path_ends(path):
    """The ends of a path in whole folder and file names, the longest first."""
    parts = path.split("/")
    return ["/".join(parts[i:]) for i in range(len(parts)) if parts[i]]


class Labels:
    """Finds images by the labels that other programs give them: ImageLabels in
    libs/io/cameras/image_positions.h."""

    def __init__(self, names):
        self.tables = []
        for key in self.variants(True):
            whole, ends = {}, {}
            for name in names:
                whole.setdefault(key(name), []).append(name)
                for end in path_ends(key(name)):
                    ends.setdefault(end, []).append(name)
            self.tables.append((whole, ends))

    @staticmethod
    def variants(is_image):
        short = lambda path: without_extension(path, is_image)
        return (lambda path: path, str.lower, short, lambda path: short(path).lower())

    def find(self, label):
        """The images of the first rule that gives any, and the rank of this rule."""
        slashes = label[2:] if label[1:3] in (":\\", ":/") else label
        rank = 0
        for (whole, ends), key in zip(self.tables, self.variants(False)):
            for path in (label, slashes.replace("\\", "/")):
                path = key(posixpath.normpath(path)) if path else ""
                longest = lambda table: next((table[end] for end in path_ends(path) if end in table),
                                             None)
                for found in (whole.get(path), ends.get(path), longest(whole),
                              longest(ends) if path.startswith(("/", "\\")) else None):
                    if found:
                        return found, rank
                    rank += 1
        return [], rank


def found_in(file, names):
    """(line number, label, position, image) of each line; the image is None if no image has the
    label. Fails if a label can be two images."""
    labels = Labels(names)
    entries, layout = position_rows.entries_of(pathlib.Path(file), lambda label: labels.find(label)[0])
    found, ranks = [], {}
    for line, label, position in entries:
        images, rank = labels.find(label)
        if len(images) > 1:
            raise Failure(f"{file}:{line}: '{label}' can be {images[0]} or {images[1]}; give more of its "
                          "path")
        if images:
            ranks[images[0]] = min(rank, ranks.get(images[0], rank))
        found.append((line, label, position, images[0] if images else None, rank))
    return [(line, label, position, image if image and rank == ranks[image] else None)
            for line, label, position, image, rank in found], layout


def read(file, names, tell=True):
    """The positions of the images `names` [m], by name. Fails at a line without a position. `tell`: prints
    a line if the file does not state the unit or the order of the coordinates."""
    found, layout = found_in(file, names)
    for line, _, position, _ in found:
        if position is None or not all(map(math.isfinite, position)):
            raise Failure(f"{file}:{line}: must be NAME X Y Z with finite numbers")
    known = {image: position for _, _, position, image in found if image}
    return position_rows.in_metres(known, layout, file, tell)


def check_system(file, names, epsg):
    """Fails if positions in degrees do not become metres in the system `epsg`, which maps and LAS would state
    (0: none)."""
    if not epsg:
        return
    found, layout = found_in(file, names)
    zone = position_rows.zone_of([place for _, _, place, image in found if image and place], layout, file)
    if zone and zone != epsg:
        raise Failure(f"--epsg {epsg}: the longitudes and latitudes of {file} become metres in the UTM zone of their "
                      f"mean: give --epsg {zone}, or positions in metres")


def check(file, images, names):
    """Fails if the file names fewer than three of the photographs `names` of the folder `images`. Prints how many
    names are no photographs: RefinePoses would skip a misspelt name like that of a photograph
    without a pose."""
    found, _ = found_in(file, names)
    missing = [label for _, label, _, image in found if image is None]
    if len(found) - len(missing) < LEAST_NAMES:
        raise Failure(f"{file}: {len(found) - len(missing)} of its names are photographs in "
                      f"{images}, at least {LEAST_NAMES} are needed")
    if missing:
        print(f"{file}: {len(missing)} of {len(found)} names are not photographs in {images} and "
              f"are ignored, {missing[0]} first", flush=True)
