# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs of several sizes, turned photographs and photographs at several focal lengths: a camera of
COLMAP for each group, and its lens and port.

The lens in air belongs to the group with its size, of these to the largest one. Photographs of another size
were made smaller or larger, or turned by a quarter; photographs with another focal length in their Exif
data were zoomed."""

import collections
import dataclasses
import json
import pathlib

from . import files, gps
from .failure import Failure
from .lens import DISTORTIONS, has_one_focal_length, sized_lens
from .photographs import few, refuse_other_sizes

FOLDER = "cameras"
LENSES, HOUSING = "lenses.txt", "housing.json"
ASPECT = 0.003  # largest relative difference of the ratio of the sides
TANGENTIAL = {"OPENCV", "FULL_OPENCV"}  # p1 and p2 are the third and fourth distortion
UNTURNABLE = {"THIN_PRISM_FISHEYE"}


@dataclasses.dataclass(frozen=True)
class Group:
    """Photographs of one camera."""
    size: tuple          # (width, height) [px]
    focal: float | None  # of the Exif data [mm]
    names: tuple


def groups_of(folder, images):
    """The Groups of photographs, the largest first. `images`: Image by name (photographs.py)."""
    found = collections.defaultdict(list)
    for name, image in images.items():
        found[(image.size, gps.focal_length(pathlib.Path(folder) / name))].append(name)
    return [Group(*key, tuple(names)) for key, names in
            sorted(found.items(), key=lambda one: (-len(one[1]), one[1]))]


@dataclasses.dataclass(frozen=True)
class Lens:
    model: str
    size: tuple
    numbers: tuple  # fx, fy, cx, cy and the distortion


def scaled(lens, factor, size):
    """The lens of photographs that were made larger by `factor`."""
    return Lens(lens.model, size, (*(factor * number for number in lens.numbers[:4]), *lens.numbers[4:]))


def turned(lens):
    """The lens of photographs that were turned by a quarter, clockwise: the pixel (x, y) of a photograph of
    height h becomes (h - y, x)."""
    (width, height), (fx, fy, cx, cy, *rest) = lens.size, lens.numbers
    if lens.model in TANGENTIAL:
        rest[2:4] = rest[3], -rest[2]
    return Lens(lens.model, (height, width), (fy, fx, height - cy, cx, *rest))


def zoomed(lens, factor):
    fx, fy, *rest = lens.numbers
    return Lens(lens.model, lens.size, (factor * fx, factor * fy, *rest))


def lens_of(group, lens, focal):
    """The lens of a group, and what was done to `lens` in words; None if no lens follows from it. `focal`: of
    the Exif data of the photographs of `lens` [mm]."""
    words, ratio = [], (group.size[0] / group.size[1]) / (lens.size[0] / lens.size[1])
    if abs(ratio - 1) > ASPECT:
        if lens.model in UNTURNABLE or abs(ratio * (lens.size[0] / lens.size[1]) ** 2 - 1) > ASPECT:
            return None
        lens, words = turned(lens), ["turned by a quarter"]
    if group.size != lens.size:
        lens = scaled(lens, group.size[0] / lens.size[0], group.size)
        words.append("of another size")
    if group.focal and focal and group.focal != focal:
        lens = zoomed(lens, group.focal / focal)
        words.append(f"at {group.focal:g} mm instead of {focal:g} mm: calibrate a lens for this focal length")
    return lens, " and ".join(words)


def of(given, images):
    """The groups of the photographs of --images with their lenses: (Group, Lens, words). Empty if there is one
    group, or if the size of a photograph is not known. Fails if there is no lens for a group."""
    groups = groups_of(given.images, images)
    if len(groups) < 2 or not all(group.size for group in groups):
        return []
    base = read_lens(given)
    own = next((group for group in groups if base and group.size == base.size), groups[0])
    found = [(group, *(base and lens_of(group, base, own.focal) or (None, ""))) for group in groups]
    if any(lens is None for _, lens, _ in found):
        refuse_other_sizes(given.images, images)
        raise Failure(f"--lens {given.lens}: has no lens for photographs of several focal lengths")
    return found


def read_lens(given):
    """The only lens of --lens. None if it cannot be read here, or if there are several."""
    try:
        model, size, numbers = sized_lens(pathlib.Path(given.lens))
        if has_one_focal_length(model):
            numbers.insert(0, numbers[0])
        if len(numbers) != 4 + DISTORTIONS[model]:
            return None
        return Lens(model, size, tuple(numbers))
    except (OSError, ValueError, LookupError, StopIteration):
        return None


def lines_about(cameras):
    """Lines about groups that differ from the lens."""
    for group, _, words in cameras:
        if words:
            is_zoomed = " mm" in words
            yield (f"{'warning: ' if is_zoomed else ''}{len(group.names)} photographs are {words} "
                   f"({few(list(group.names))})")


def line_of(number, lens):
    model, numbers = lens.model, list(lens.numbers)
    if has_one_focal_length(model):
        numbers[:2] = [(numbers[0] + numbers[1]) / 2]
    return " ".join(map(str, (number, model, *lens.size, *(repr(number) for number in numbers))))


def turned_port(port):
    """A port in the frame of a photograph that was turned by a quarter, clockwise."""
    changed = dict(port)
    for key in ("normal", "center_m"):
        if key in port:
            x, y, z = port[key]
            changed[key] = [-y, x, z]
    return changed


def housing_of(given, cameras):
    """The housing file with entries for turned cameras. None if the file stays as it is."""
    width, height = read_lens(given).size
    is_turned = [(group.size[0] < group.size[1]) != (width < height) for group, _, _ in cameras]
    housing = files.read_object(pathlib.Path(given.housing))
    name = housing.get("default")
    if not any(is_turned) or name not in housing.get("ports", {}) or housing.get("cameras") or housing.get("images"):
        return None
    housing["ports"][f"{name} turned"] = turned_port(housing["ports"][name])
    housing["cameras"] = {str(number): f"{name} turned" for number, turn in enumerate(is_turned, 1) if turn}
    return housing


def write(given, cameras, out):
    """Writes the lenses, the housing if it differs, and the lists of photographs into `out`/cameras."""
    folder = out / FOLDER
    folder.mkdir(exist_ok=True)
    files.write(folder / LENSES, "".join(f"{line_of(number, lens)}\n"
                                         for number, (_, lens, _) in enumerate(cameras, 1)))
    housing = housing_of(given, cameras)
    if housing:
        files.write(folder / HOUSING, json.dumps(housing, indent=1))
    for number, (group, _, _) in enumerate(cameras, 1):
        files.write(list_of(out, number), "".join(f"{name}\n" for name in group.names))


def list_of(out, number):
    """The file that lists the photographs of a camera."""
    return out / FOLDER / f"{number}.txt"


def lens_file(given, out):
    return out / FOLDER / LENSES if given.cameras else given.lens


def housing_file(given, out):
    return out / FOLDER / HOUSING if given.cameras and housing_of(given, given.cameras) else given.housing
