# SPDX-License-Identifier: GPL-3.0-or-later
"""Lenses in air: the files that hold them, and the lenses of photographs that were made smaller, turned or
zoomed. The programs check lens files (first_checks.py); here a file that they accept is read."""

import dataclasses
import pathlib
import re
import struct
import typing

from .failure import Failure

TANGENTIAL = ("OPENCV", "FULL_OPENCV", "THIN_PRISM_FISHEYE")  # p1 and p2 are the third and fourth distortion
ASPECT_PIXELS = 1.5  # rounded sides change the ratio of the sides by this over the shortest side
ZOOM_SIGMA = 0.03    # relative: cameras round the focal length in the Exif data
# COLMAP's camera models in the order of their numbers: how many parameters of distortion follow focal lengths and
# principal point.
MODELS = {"SIMPLE_PINHOLE": 0, "PINHOLE": 0, "SIMPLE_RADIAL": 1, "RADIAL": 2, "OPENCV": 4, "OPENCV_FISHEYE": 4,
          "FULL_OPENCV": 8, "FOV": 1, "SIMPLE_RADIAL_FISHEYE": 1, "RADIAL_FISHEYE": 2, "THIN_PRISM_FISHEYE": 8}


def has_one_focal_length(model):
    return model.startswith(("SIMPLE_", "RADIAL"))


@dataclasses.dataclass(frozen=True)
class Lens:
    """A camera of COLMAP's cameras.txt."""
    number: int  # the camera's id
    model: str
    size: tuple  # (width, height) [px]
    parameters: tuple  # fx, fy, cx, cy and the distortion; fx = fy if the model has one focal length
    focal_sigma: float | None = None  # standard deviation of the focal lengths, relative
    file: str = ""
    stated_focal: float | None = None  # the Exif focal length for which the user gave it [mm]
    prefix: str = ""  # of the names of the photographs for which the user gave it

    def in_words(self):
        return f"{self.file}, camera {self.number}"

    def colmap_parameters(self):
        """The parameters in COLMAP's order."""
        fx, fy, *rest = self.parameters
        return [(fx + fy) / 2, *rest] if has_one_focal_length(self.model) else [fx, fy, *rest]


def made(number, model, width, height, numbers, file, sigma=None):
    numbers = [float(one) for one in numbers]
    if has_one_focal_length(model):
        numbers.insert(0, numbers[0])
    if len(numbers) != 4 + MODELS[model]:
        raise ValueError
    return Lens(int(number), model, (int(width), int(height)), tuple(numbers), sigma, str(file))


def in_text(file):
    lines = [line.split() for line in file.read_text(encoding="utf-8-sig").splitlines()]
    sigmas = {int(words[2]): float(words[3]) for words in lines if words[:2] == ["#", "focal_sigma"]}
    cameras = [words for words in lines if words and not words[0].startswith("#")]
    return [made(number, model, width, height, numbers, file, sigmas.get(int(number)))
            for number, model, width, height, *numbers in cameras]


def in_binary(file):
    data, at, found, models = file.read_bytes(), 8, [], list(MODELS)
    for _ in range(struct.unpack_from("<Q", data)[0]):
        number, kind, width, height = struct.unpack_from("<iiQQ", data, at)
        count = 4 + MODELS[models[kind]] - has_one_focal_length(models[kind])
        found.append(made(number, models[kind], width, height, struct.unpack_from(f"<{count}d", data, at + 24), file))
        at += 24 + 8 * count
    return found


def in_calibmar(file):
    """The lens of Calibmar's calibration.yaml."""
    text = re.sub(r"(^|\s)#.*", "", file.read_text(encoding="utf-8-sig"))

    def words(key):
        found = re.search(rf"^{key}:[ \t]*(\[[^\]]*\]|(?:\n\s*-[^\n]*)+|[^\n]*)", text, re.MULTILINE)
        return re.findall(r"[\w.+-]*\w[\w.+-]*", found[1])

    return [made(1, *words("model"), *words("width"), *words("height"), words("parameters"), file)]


def in_file(path):
    """The lenses in a file, as the programs read it. Empty if they cannot be read here."""
    path = pathlib.Path(path)
    if path.is_dir():
        path = next((one for one in (path / "cameras.txt", path / "cameras.bin") if one.exists()), path)
    read = in_calibmar if path.suffix.lower() in (".yaml", ".yml") else in_binary if path.suffix == ".bin" else in_text
    try:
        return read(path)
    except (OSError, ValueError, LookupError, TypeError, struct.error):
        return []


def scaled(lens, size):
    """The lens of photographs that were made smaller or larger."""
    (fx, fy, cx, cy, *rest), x, y = lens.parameters, size[0] / lens.size[0], size[1] / lens.size[1]
    if has_one_focal_length(lens.model):  # sides are rounded to whole pixels, so that x and y differ a little
        x = y = (x + y) / 2
    return dataclasses.replace(lens, size=tuple(size), parameters=(x * fx, y * fy, x * cx, y * cy, *rest))


def turned(lens, quarters=1):
    """The lens of photographs that were turned by quarters, clockwise: by one quarter, the pixel (x, y) of a
    photograph of height h becomes (h - y, x)."""
    for _ in range(quarters % 4):
        (width, height), (fx, fy, cx, cy, *rest) = lens.size, lens.parameters
        if lens.model in TANGENTIAL:
            rest[2:4] = rest[3], -rest[2]
        if lens.model == "THIN_PRISM_FISHEYE":
            rest[6:8] = -rest[7], rest[6]
        lens = dataclasses.replace(lens, size=(height, width), parameters=(fy, fx, height - cy, cx, *rest))
    return lens


def zoomed(lens, factor):
    fx, fy, *rest = lens.parameters
    return dataclasses.replace(lens, parameters=(factor * fx, factor * fy, *rest),
                               focal_sigma=max(ZOOM_SIGMA, lens.focal_sigma or 0))


def same_shape(a, b):
    """Whether the sides of two sizes have the same ratio, as scene/resolution.h says."""
    return abs(a[0] * b[1] / (a[1] * b[0]) - 1) <= ASPECT_PIXELS / min(*a, *b)


# How photographs can differ from their lens, the simplest first.
SAME, TURNED, SCALED, SCALED_AND_TURNED = range(4)


def difference(lens, size):
    """How photographs of this size differ from a lens; None if the lens is not theirs."""
    across = (size[1], size[0])
    if size == lens.size:
        return SAME
    if across == lens.size:
        return TURNED
    if same_shape(size, lens.size):
        return SCALED
    return SCALED_AND_TURNED if same_shape(across, lens.size) else None


def is_whole(lens, size):
    """Whether photographs of this size have all pixels of the lens."""
    return difference(lens, size) in (SAME, TURNED)


def fitted(lens, size, quarters=1):
    """The lens of photographs of this size. `quarters`: by which photographs were turned if their sides are in
    exchange."""
    how = difference(lens, size)
    if how in (TURNED, SCALED_AND_TURNED):
        lens = turned(lens, quarters)
    return lens if lens.size == size else scaled(lens, size)


def line_of(number, lens):
    """The line of a lens in cameras.txt."""
    return " ".join(map(str, (number, lens.model, *lens.size, *map(repr, lens.colmap_parameters()))))


def text_of(lenses):
    """The text of a cameras.txt with these lenses, which get the numbers 1, 2, ..."""
    sigmas = [f"# focal_sigma {number} {lens.focal_sigma!r}" for number, lens in enumerate(lenses, 1)
              if lens.focal_sigma]
    return "\n".join([*sigmas, *(line_of(number, lens) for number, lens in enumerate(lenses, 1)), ""])


class Given(typing.NamedTuple):
    """A value of --lens."""
    file: str
    focal: float | None = None  # the Exif focal length for which it is given [mm]
    prefix: str = ""            # of the names of the photographs for which it is given

    def with_file(self, file):
        """The value with another path."""
        return f"{self.focal:g}mm:{file}" if self.focal else f"{self.prefix}:{file}" if self.prefix else str(file)


def given_as(text):
    """The Given of a value of --lens: lens.txt, 18mm:lens.txt, or left/:lens.txt."""
    focal, prefix = re.fullmatch(r"(\d+(?:\.\d+)?)\s*mm:(.+)", text, re.DOTALL), re.fullmatch(r"([^:]+):(.+)", text)
    if pathlib.Path(text).exists() or not (focal or prefix):
        return Given(text)
    if focal and float(focal[1]) == 0:
        raise Failure(f"--lens {text}: the focal length must be positive")
    if focal:
        return Given(focal[2], focal=float(focal[1]))
    if given_as(prefix[2]) != Given(prefix[2]):
        raise Failure(f"--lens {text}: must be FILE, a focal length and a file as in 18mm:FILE, or the beginning of "
                      "names and a file as in left/:FILE")
    return Given(prefix[2], prefix=prefix[1])
