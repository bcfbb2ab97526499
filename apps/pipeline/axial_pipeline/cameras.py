# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs of several sizes, focal lengths or cameras, and turned photographs: a camera of COLMAP for each
group, with its lens and port.

A lens in air belongs to the photographs of its size, of these to the largest group. Photographs of another
size with the same ratio of the sides were made smaller or larger; photographs with the sides in exchange were
turned by a quarter; photographs with another focal length in their Exif data were zoomed. Photographs of
another camera need a lens of their own."""

import collections
import dataclasses
import json
import pathlib

from . import files, lenses
from .failure import Failure
from .files import few, write_names
from .lenses import Lens
from .photographs import refuse_other_sizes

FOLDER = "cameras"
LENSES, HOUSING = "lenses.txt", "housing.json"
SAME_FOCAL = 0.005  # focal lengths of the Exif data that differ by less are the same
MOST_LEFT_OUT = 0.5  # of the photographs


@dataclasses.dataclass(frozen=True)
class Group:
    """Photographs that are alike."""
    size: tuple          # (width, height) [px]
    camera: str          # of the Exif data
    focal: float | None  # of the Exif data [mm]
    prefix: str          # of --lens, with which the names begin
    names: tuple

    def is_told_less_than(self, other):
        """Whether these photographs may belong to the other group, and state less."""
        return (self.size == other.size and self.prefix == other.prefix and self.camera in ("", other.camera)
                and self.focal in (None, other.focal) and self != other)


@dataclasses.dataclass
class Camera:
    """A camera of COLMAP."""
    names: list  # of its photographs
    lens: Lens
    words: str = ""  # what was done to the lens in air
    quarters: int = 0  # by which photographs were turned, clockwise


def as_json(cameras):
    return [dataclasses.asdict(camera) for camera in cameras]


def from_json(found):
    return [Camera(**{**one, "lens": Lens(**one["lens"])}) for one in found]


def nominal(focals):
    """A common value for focal lengths that differ little."""
    found, last = {}, 0
    for focal in sorted(focals):
        last = focal if focal > last * (1 + SAME_FOCAL) else last
        found[focal] = last
    return {**found, None: None}


def groups_of(images, prefixes=()):
    """The Groups of photographs, the largest first. `images`: Image by name (photographs.py). Photographs of
    unknown size count as those of the usual size, and photographs that state less than others of their size
    belong to those if these are of one group. A name belongs to the longest of `prefixes` with which it begins."""
    usual = collections.Counter(image.size for image in images.values() if image.size).most_common(1)
    focals = nominal({image.exif.focal for image in images.values() if image.exif.focal})
    found = collections.defaultdict(list)
    for name, image in images.items():
        size = image.size or (usual[0][0] if usual else None)
        prefix = max((one for one in prefixes if name.startswith(one)), key=len, default="")
        found[size, image.exif.camera, focals[image.exif.focal], prefix].append(name)
    groups = [Group(*key, tuple(names)) for key, names in found.items()]
    joined = collections.defaultdict(list)
    for group in groups:
        others = [other for other in groups if group.is_told_less_than(other)]
        joined[others[0] if len(others) == 1 else group] += group.names
    groups = [dataclasses.replace(group, names=tuple(sorted(names))) for group, names in joined.items()]
    return sorted(groups, key=lambda group: (-len(group.names), group.names))


def same_focal(a, b):
    return abs(a - b) <= SAME_FOCAL * max(a, b)


def lens_of(group, groups, found):
    """The lens of `found` for a group; None if no lens has its size or ratio of sides. Fails if two have."""
    groups = [other for other in groups if other.prefix == group.prefix]
    fitting = [lens for lens in found if lens.prefix == group.prefix and lenses.difference(lens, group.size) is not None
               and (lens.stated_focal is None or group.focal and same_focal(lens.stated_focal, group.focal))]
    fitting = [lens for lens in fitting if lens.stated_focal] or fitting
    least = min((lenses.difference(lens, group.size) for lens in fitting), default=None)
    fitting = [lens for lens in fitting if lenses.difference(lens, group.size) == least]
    if len(fitting) < 2:
        return fitting[0] if fitting else None
    alike = [other for other in groups if (other.camera, other.focal) == (group.camera, group.focal)]
    own = [lens for lens in fitting if any(lenses.is_whole(lens, other.size) for other in alike)]
    if len(own) == 1:
        return own[0]
    focals = sorted({other.focal for other in groups if other.size == group.size and other.focal})
    if group.focal and len(focals) == len(fitting):
        return sorted(fitting, key=lambda lens: lens.parameters[0])[focals.index(group.focal)]
    raise Failure(f"--lens: {fitting[0].in_words()} and {fitting[1].in_words()} are both for photographs of "
                  f"{group.size[0]} x {group.size[1]} pixels; state the focal length for which each was calibrated, "
                  "as in --lens 18mm:lens.txt, or how the names of its photographs begin, as in --lens left/:lens.txt")


def owner_of(lens, groups):
    """The one of `groups` for which the lens was calibrated."""
    return min(groups, key=lambda group: (not lenses.is_whole(lens, group.size), -len(group.names)))


def camera_of(group, lens, owner):
    """The Camera of a group, and why there is none, in words. `owner`: the group of `lens`."""
    if lens is None:
        return None, f"of {group.size[0]} x {group.size[1]} pixels: no lens has this size or this ratio of the sides"
    if group.camera and owner.camera and group.camera != owner.camera:
        return None, f"of another camera, {group.camera}: its lens is missing"
    how, words = lenses.difference(lens, group.size), []
    quarters = 1 if how in (lenses.TURNED, lenses.SCALED_AND_TURNED) else 0
    words += ["turned by a quarter"] if quarters else []
    words += ["of another size"] if how in (lenses.SCALED, lenses.SCALED_AND_TURNED) else []
    fitted, focal = lenses.fitted(lens, group.size), lens.stated_focal or owner.focal
    if group.focal and focal and not same_focal(group.focal, focal):
        fitted = lenses.zoomed(fitted, group.focal / focal)
        words.append(f"at {group.focal:.4g} mm instead of {focal:.4g} mm: calibrate a lens for this focal length")
    return Camera(list(group.names), fitted, " and ".join(words), quarters), ""


def lenses_of(given):
    """The lenses in the files of --lens."""
    return [dataclasses.replace(lens, stated_focal=one.focal, prefix=one.prefix)
            for one in map(lenses.given_as, given.lenses) for lens in lenses.in_file(one.file)]


def of(given, images):
    """The Cameras of the photographs, and lines about those that are left out, because they have no lens. No
    Camera if all photographs have the only lens of --lens as it is."""
    if not any(image.size for image in images.values()):
        return [], []
    found = lenses_of(given)
    groups = groups_of(images, {lens.prefix for lens in found})
    if not found:
        if len(groups) > 1 or len(given.lenses) > 1:
            refuse_other_sizes(given.images, images)
            raise Failure(f"--lens {given.lens}: has no lens for photographs of several cameras or focal lengths")
        return [], []
    chosen = {group: lens_of(group, groups, found) for group in groups}
    cameras, left_out = [], []
    for group, lens in chosen.items():
        owner = owner_of(lens, [one for one in groups if chosen[one] is lens]) if lens else None
        camera, reason = camera_of(group, lens, owner)
        if camera:
            cameras.append(camera)
        else:
            left_out.append((group.names, reason))
    refuse_unused_prefix(found, groups)
    refuse_if_many(given, left_out, len(images))
    refuse_equal_numbers(given, [camera.lens for camera in cameras])
    if len(cameras) == len(found) == len(groups) == 1 and not cameras[0].words:
        return [], []
    return cameras, [*(f"warning: {len(names)} photographs are left out ({few(names)}): they are {reason}"
                       for names, reason in left_out),
                     *(f"warning: no photograph belongs to the lens of {lens.in_words()}"
                       for lens in found if lens not in chosen.values())]


def refuse_unused_prefix(found, groups):
    """Fails if no photograph has a name that begins as a value of --lens says."""
    for lens in found:
        if lens.prefix not in ("", *(group.prefix for group in groups)):
            raise Failure(f"--lens {lens.prefix}:{lens.file}: the name of no photograph begins with {lens.prefix}")


def refuse_equal_numbers(given, used):
    """Fails if the housing has ports by camera, and cameras of different files have one number."""
    is_file = given.housing and pathlib.Path(given.housing).is_file()
    by_camera = files.read_object(pathlib.Path(given.housing)).get("cameras") if is_file else None
    if not isinstance(by_camera, dict) or len(by_camera) < 2:
        return
    file_of = {}
    for lens in used:
        if lens.file != file_of.setdefault(lens.number, lens.file):
            raise Failure(f"--lens: camera {lens.number} is in {file_of[lens.number]} and in {lens.file}, and "
                          f"{given.housing} names ports by camera: give the cameras different numbers")


def refuse_if_many(given, left_out, count):
    """Fails if half of the photographs have no lens."""
    missing = sum(len(names) for names, _ in left_out)
    if missing >= MOST_LEFT_OUT * count:
        names, reason = left_out[0]
        raise Failure(f"--lens {', '.join(given.lenses)}: has no lens for {missing} of {count} photographs: "
                      f"{few(names)} {'is' if len(names) == 1 else 'are'} {reason}")


def lines_about(cameras):
    """Lines about photographs that differ from their lens."""
    for camera in cameras:
        if camera.words:
            is_zoomed = " mm" in camera.words
            yield (f"{'warning: ' if is_zoomed else ''}{len(camera.names)} photographs are {camera.words} "
                   f"({few(camera.names)})")


def lens_lines(cameras, quarters):
    """The text of a cameras.txt. `quarters`: by which turned photographs were turned."""
    return lenses.text_of([lenses.turned(one.lens, quarters - one.quarters) if one.quarters else one.lens
                           for one in cameras])


def turned_port(port, quarters=1):
    """A port in the frame of a photograph that was turned by quarters, clockwise."""
    changed = json.loads(json.dumps(port))
    sigma = changed.get("sigma", {})
    for _ in range(quarters % 4):
        for key in ("normal", "center_m"):
            if key in changed:
                x, y, z = changed[key]
                changed[key] = [-y, x, z]
        for key in ("normal_degrees", "center_m"):
            if isinstance(sigma.get(key), list):
                sigma[key][:2] = sigma[key][1::-1]
    return changed


def port_of(name, lens, housing):
    """The name of the port of a photograph, and the key of the entry that names the photograph, or None."""
    keys = [key for key in housing.get("images", {}) if name == key or name.endswith(f"/{key}")]
    key = max(keys, key=len, default=None)
    if key is not None:
        return housing["images"][key], key
    return housing.get("cameras", {}).get(str(lens.number), housing.get("default", "none")), None


def housing_of(file, cameras, quarters):
    """The housing `file` for these cameras, with turned ports for turned photographs. None if the file stays as
    it is, or if it is of another kind."""
    housing = files.read_object(pathlib.Path(file))
    ports = housing.get("ports")
    if not isinstance(ports, dict) or not any(one.quarters for one in cameras) and not housing.get("cameras"):
        return None
    try:
        by_camera, images = {}, dict(housing.get("images", {}))
        for number, camera in enumerate(cameras, 1):
            turn = quarters if camera.quarters else 0
            port = add_port(ports, port_of("", camera.lens, housing)[0], turn)
            by_camera.update({str(number): port} if port != housing.get("default") else {})
            for name in camera.names if turn else ():
                port, key = port_of(name, camera.lens, housing)
                if key is not None:
                    images[name] = add_port(ports, port, turn)
    except (LookupError, TypeError, ValueError):  # RefinePoses says what is wrong with the file
        return None
    return {**housing, "cameras": by_camera, **({"images": images} if images else {})}


def add_port(ports, name, quarters):
    """The name of the port `name`, turned by quarters, in `ports`, where it is added."""
    if not quarters or name == "none":
        return name
    ports[f"{name} turned"] = turned_port(ports[name], quarters)
    return f"{name} turned"


def write(given, out, quarters=1):
    """Writes the lenses, the housing if it differs, and the lists of photographs into `out`/cameras.
    `quarters`: by which turned photographs were turned, clockwise."""
    folder = out / FOLDER
    folder.mkdir(exist_ok=True)
    files.write(folder / LENSES, lens_lines(given.cameras, quarters))
    housing = housing_of(given.housing, given.cameras, quarters)
    if housing:
        files.write(folder / HOUSING, json.dumps(housing, indent=1))
    for number, camera in enumerate(given.cameras, 1):
        write_names(list_of(out, number), camera.names)


def list_of(out, number):
    """The file that lists the photographs of a camera."""
    return out / FOLDER / f"{number}.txt"


def lens_file(given, out):
    return out / FOLDER / LENSES if given.cameras else pathlib.Path(given.lens)


def housing_file(given, out):
    has_own = given.cameras and housing_of(given.housing, given.cameras, 1)
    return out / FOLDER / HOUSING if has_own else pathlib.Path(given.housing)
