# SPDX-License-Identifier: GPL-3.0-or-later
"""The options --masks and --ignore-mask-label: masks of photographs, for COLMAP and for the programs.

COLMAP wants the mask of images/dive/a.jpg as FOLDER/dive/a.jpg.png, in the size of the photograph, and
takes no features where it is black. The programs find masks of this name, too, and leave out the
label 0. So one folder serves all: InterfaceCOLMAP writes it from the user's masks, which may have any
name and label that the programs accept (docs/formats.md, Masks)."""

import pathlib

from .failure import Failure
from .files import existing, resolved
from .option_files import has_option

FOLDER = "colmap_masks"  # below the output folder
LABELS = range(1 << 16)


def add_options(parser):
    parser.add_argument("--masks", default="",
                        help="folder with a mask for every photograph, as for --mask-path of the "
                        "programs (docs/formats.md), or one PNG file for all photographs. COLMAP takes "
                        "no features from masked pixels")
    parser.add_argument("--ignore-mask-label", default="", metavar="LABEL",
                        help="label of the masked pixels in --masks, from 0 to 65535 (default: 0, which "
                        "is black)")


def check(given):
    """Checks the options, and makes --masks absolute."""
    label = given.ignore_mask_label
    if label and not given.masks:
        raise Failure(f"--ignore-mask-label {label}: is only for --masks")
    if label and not (label.isascii() and label.isdigit() and int(label) in LABELS):
        raise Failure(f"--ignore-mask-label {label}: must be a number from 0 to 65535")
    if given.masks:
        given.masks = existing("--masks", given.masks)
        if pathlib.Path(given.masks).is_relative_to(resolved("--output", given.output) / FOLDER):
            raise Failure(f"--masks {given.masks}: lies in the folder that this run writes; move it")


def command(programs, given, folder):
    """Writes the masks of the photographs for COLMAP into `folder`."""
    return programs.colmap_masks(given.images, given.masks, folder, given.ignore_mask_label or 0)


def words(given, folder, already):
    """The options for a program that takes masks, if the words `already` have none."""
    named = has_option(already, "--mask-path")
    return ["--mask-path", str(folder)] if given.masks and not named else []
