# SPDX-License-Identifier: GPL-3.0-or-later
"""The lens that COLMAP starts with when it calibrates a lens under water."""

import pathlib
import re

from .failure import Failure

WATER = 1.333  # index of refraction; a start does not need a better one
# How many parameters of distortion follow focal lengths and principal point in COLMAP's camera
# models.
DISTORTIONS = {"SIMPLE_PINHOLE": 0, "PINHOLE": 0, "SIMPLE_RADIAL": 1, "RADIAL": 2, "OPENCV": 4,
               "FULL_OPENCV": 8, "OPENCV_FISHEYE": 4, "SIMPLE_RADIAL_FISHEYE": 1,
               "RADIAL_FISHEYE": 2, "THIN_PRISM_FISHEYE": 8}


def has_one_focal_length(model):
    return model.startswith(("SIMPLE_", "RADIAL"))


def lens_in_air(file):
    """The camera model's name and its parameters: of the first camera of COLMAP's cameras.txt, or
    of Calibmar's calibration.yaml."""
    text = file.read_text(encoding="utf-8-sig")
    calibmar = (re.search(r"^model: *(\w+)", text, re.MULTILINE),
                re.search(r"^parameters: *\[(.*?)\]", text, re.MULTILINE | re.DOTALL))
    if all(calibmar):
        return calibmar[0][1], [float(number) for number in calibmar[1][1].split(",")]
    _, model, _, _, *numbers = next(line.split() for line in text.splitlines()
                                    if line.strip() and line[0] != "#")
    return model, [float(number) for number in numbers]


def start_under_water(file, model):
    """The parameters of the camera model `model` that COLMAP starts with: the lens in air, with its
    focal lengths times the water's index, without distortion. If COLMAP has no start, it guesses a
    focal length and may find no poses. None if `file` is not readable as a lens, or if `model` is
    unknown here."""
    try:
        air, numbers = lens_in_air(pathlib.Path(file))
        if has_one_focal_length(air):
            numbers.insert(0, numbers[0])
        start = start_of(numbers, model)
    except (OSError, ValueError, LookupError, StopIteration):
        return None
    return ",".join(f"{number:.9g}" for number in start)


def start_of(numbers, model):
    """The parameters of the camera model `model` with the focal lengths times the water's index. `numbers`: fx,
    fy, cx, cy of a lens, and more."""
    fx, fy, cx, cy = numbers[:4]
    focal = [(fx + fy) / 2] if has_one_focal_length(model) else [fx, fy]
    return [*(WATER * f for f in focal), cx, cy, *[0] * DISTORTIONS[model]]


def pinhole_parameters(model):
    """"fx,fy,cx,cy" of the only PINHOLE camera of a COLMAP text model, as they stand in the file."""
    for line in (model / "cameras.txt").read_text().splitlines():
        fields = line.split()
        if fields[1:2] == ["PINHOLE"] and fields[0] != "#":
            return ",".join(fields[4:8])
    raise Failure(f"{model / 'cameras.txt'}: has no PINHOLE camera")
