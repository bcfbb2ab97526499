# SPDX-License-Identifier: GPL-3.0-or-later
"""By which quarter photographs were turned that have their sides in exchange: to the right or to the left. Lens
and port tell if they are not the same after half a turn. RefinePoses runs with both turns."""

import json
import math

from . import cameras, files
from .running import exit_code_of, tell, told

TURNS = {1: "right", 3: "left"}  # in quarters, clockwise
CLEAR = 0.002  # relative difference of the RMS errors that tells


def are_alike(given):
    """Whether lens and port are the same for both turns."""
    texts = [(cameras.lens_lines(given.cameras, quarters),
              json.dumps(cameras.housing_of(given.housing, given.cameras, quarters))) for quarters in TURNS]
    return texts[0] == texts[1]


def error_of(command, folder, log):
    """The RMS error of a run of RefinePoses into `folder` [px]; infinite if it fails."""
    files.clear(folder)
    exit_code_of(told(command), log)
    error = files.read_object(folder / "report.json").get("rms_after_px")
    files.clear(folder)
    return error if isinstance(error, (int, float)) and math.isfinite(error) else math.inf


def choose(given, out, command_into):
    """Writes the lenses and the housing for the turn with the smaller error. `command_into`: RefinePoses by
    its output folder."""
    cameras.write(given, out)
    if not any(one.quarters for one in given.cameras) or are_alike(given):
        return
    errors = {}
    for quarters, side in TURNS.items():
        cameras.write(given, out, quarters)
        folder = out / cameras.FOLDER / f"turned-{side}"
        errors[quarters] = error_of(command_into(folder), folder, out / "logs" / f"turned-{side}.log")
    best = min(errors, key=errors.get)
    cameras.write(given, out, best)
    least, most = errors[best], max(errors.values())
    if math.isfinite(least):
        tell(f"turned photographs: turned to the {TURNS[best]} (RMS error {least:.4g} px, otherwise {most:.4g} px"
             f"{'; both fit' if most < (1 + CLEAR) * least else ''})")
