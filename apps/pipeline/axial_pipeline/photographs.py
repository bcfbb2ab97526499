# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of the photographs, checked before hours of work: what COLMAP would do with each file.

Measured with COLMAP 3.8: it takes every file of the folder and of its subfolders, also of hidden
ones, for a photograph if the contents are an image, whatever the name. It enters no links to folders,
skips files that are no images, and aborts at a link that leads to itself. If all photographs share a
camera, it skips the photographs whose size differs from that of the first one it reads."""

import collections
import dataclasses
import errno
import mmap
import os
import pathlib
import struct

from . import exif as exif_data
from .failure import Failure
from .files import few

LEAST = 2
# Beginnings of other images that COLMAP reads. Their sizes are not read here.
OTHER_IMAGES = (b"BM", b"GIF8", b"8BPS", b"\0\0\0\x0cjP  ", b"\xff\x4f\xff\x51")
SEARCHED_END = 1 << 20  # bytes: some programs add data after the end of the image


def is_webp(data):
    return data[:4] == b"RIFF" and data[8:12] == b"WEBP"


def size_of_jpeg(data):
    at = 2
    while data[at] == 0xFF:
        kind = data[at + 1]
        if kind == 0xFF or kind == 0x01 or 0xD0 <= kind <= 0xD7:  # a fill byte, or a marker alone
            at += 1 if kind == 0xFF else 2
            continue
        length, = struct.unpack_from(">H", data, at + 2)
        if 0xC0 <= kind <= 0xCF and kind not in (0xC4, 0xC8, 0xCC):
            height, width = struct.unpack_from(">HH", data, at + 5)
            return width, height
        at += 2 + length
    return None


def size_of_tiff(data):
    first = exif_data.first_table(data)
    size = first.value(256), first.value(257)
    return size if all(isinstance(side, int) for side in size) else None


@dataclasses.dataclass(frozen=True)
class Image:
    """What the beginning and the end of an image file tell."""
    size: tuple = None  # (width, height) [px]; None: not known
    is_whole: bool = True  # whether the end of the image is there
    exif: exif_data.Exif = exif_data.Exif()


def ends_with(data, mark):
    return data.rfind(mark, max(0, len(data) - SEARCHED_END)) >= 0


def image_in(data):
    """The Image in the bytes of a file; None if they are none that COLMAP reads."""
    if data[:3] == b"\xff\xd8\xff":
        return Image(size_of_jpeg(data), ends_with(data, b"\xff\xd9"), exif_data.exif_in(data))
    if data[:8] == b"\x89PNG\r\n\x1a\n":
        return Image(struct.unpack_from(">II", data, 16), ends_with(data, b"IEND"), exif_data.exif_in(data))
    if data[:4] in (b"II*\0", b"MM\0*"):
        return Image(size_of_tiff(data), exif=exif_data.exif_in(data))
    return Image() if is_webp(data) or data[:8].startswith(OTHER_IMAGES) else None


def image_of(path):
    """As image_in(), of a file. A file that cannot be read is none, and neither is a pipe, which could
    not be opened before another process writes to it."""
    if not path.is_file():
        return None
    try:
        with open(path, "rb") as file, \
                mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            return image_in(data)
    except (OSError, ValueError, LookupError, struct.error):  # also an empty or damaged file
        return None


def printable(name):
    """`name` as text that can be printed, if it is not UTF-8, too."""
    return name.encode(errors="surrogateescape").decode(errors="backslashreplace")


def require_utf8(option, path):
    """Fails if the text of `path`, the value of `option`, is not UTF-8: files in between are."""
    if printable(str(path)) != str(path):
        raise Failure(f"{option} {printable(str(path))}: the name is not UTF-8; rename it")


def leads_to_itself(path):
    try:
        os.stat(path)
    except OSError as error:
        return error.errno == errno.ELOOP
    return False


@dataclasses.dataclass
class Found:
    """The files of a folder: names relative to it."""
    images: dict = dataclasses.field(default_factory=dict)  # Image by name, sorted
    others: list = dataclasses.field(default_factory=list)  # files that are no images
    links: list = dataclasses.field(default_factory=list)  # to folders


def found_in(folder):
    """The Found of a folder. Fails at a name that is not UTF-8, and at a link that leads to itself."""
    found = Found()
    for root, folders, names in os.walk(folder):
        folders.sort()
        for name in sorted([*folders, *names]):
            path = pathlib.Path(root) / name
            require_utf8("--images", path)
            relative = str(path.relative_to(folder))
            if leads_to_itself(path):
                raise Failure(f"--images {path}: is a link that leads to itself; remove it, because "
                              "COLMAP stops there")
            if path.is_dir():
                found.links += [relative] if path.is_symlink() else []
                continue
            image = image_of(path)
            if image:
                found.images[relative] = image
            else:
                found.others.append(relative)
    return found


def names_of_masks(name):
    """The names that a mask of the image `name` has beside it (libs/io/images/masks.h)."""
    path = pathlib.PurePath(name)
    return [f"{path.with_suffix('')}.mask.png", f"{name}.png", f"{path.with_suffix('')}_mask.png"]


def refuse_masks(folder, names):
    masks = [(mask, name) for name in names for mask in names_of_masks(name) if mask in names]
    if masks:
        mask, name = masks[0]
        raise Failure(f"--images {folder}: {mask} is the mask of {name}, and COLMAP would take it for "
                      f"a photograph: move the masks ({len(masks)}) to another folder and give it "
                      "with --masks")


def refuse_other_sizes(folder, images):
    by_size = collections.defaultdict(list)
    for name, image in images.items():
        if image.size:
            by_size[image.size].append(name)
    if len(by_size) < 2:
        return
    most = max(map(len, by_size.values()))
    words = [f"{len(names)} of {width} x {height} pixels "
             f"({few(names) if len(names) < most or not names[1:] else names[0] + ' first'})"
             for (width, height), names in sorted(by_size.items(), key=lambda one: -len(one[1]))]
    raise Failure(f"--images {folder}: the photographs have different sizes: {few(words)}; all must be "
                  "of one camera and setting: move the others to another folder")


def say(folder, found):
    """Tells what becomes of files that are not photographs in the folder itself."""
    lines = []
    if found.others:
        lines.append(f"{few(found.others)}: not an image, not used")
    if found.links:
        lines.append(f"{few(found.links)}: a link to a folder, which COLMAP does not enter: not used")
    inside = [name for name in found.images if "/" in name]
    if inside:
        lines.append(f"{len(inside)} of {len(found.images)} photographs are in subfolders, and are used, "
                     f"too: {few(inside)}")
    cut = [name for name, image in found.images.items() if not image.is_whole]
    if cut:
        lines.append(f"warning: {few(cut)}: the end of the image is missing; copy it again")
    for line in lines:
        print(f"{folder}: {line}", flush=True)


def check(folder, one_size=True):
    """Fails if COLMAP cannot work with the photographs of a folder, or would use another file for a
    photograph. Prints what COLMAP does with unusual files. Returns the photographs, Image by name.
    `one_size`: whether several sizes are refused."""
    folder = pathlib.Path(folder)
    if not folder.is_dir():
        raise Failure(f"--images {folder}: is not a folder")
    found = found_in(folder)
    if len(found.images) < LEAST:
        only = next(iter(found.images), None)
        no = f" ({few(found.others)}: not an image)" if found.others else ""
        raise Failure(f"--images {folder}: has {'one photograph, ' + only if only else 'no photographs'}"
                      f"{no}; at least {LEAST} are needed")
    refuse_masks(folder, found.images)
    if one_size:
        refuse_other_sizes(folder, found.images)
    say(folder, found)
    return found.images
