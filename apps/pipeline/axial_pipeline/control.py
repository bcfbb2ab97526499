# SPDX-License-Identifier: GPL-3.0-or-later
"""Coded targets, bars, control points and rigs, which RefinePoses takes."""

from . import files
from .failure import Failure
from .programs import require, words_of

FIND = "find"            # the value of --targets for which FindTargets runs
FOUND = "targets.json"   # its result
PLACES = "target_places.json"  # of RefinePoses
FILES = ("targets", "bars", "control", "rig")


def add_options(parser):
    parser.add_argument("--targets", default="", help="coded targets in the photographs: find, or a file as for "
                        "RefinePoses (docs/targets.md)")
    parser.add_argument("--bars", default="", help="known distances between targets, as for RefinePoses")
    parser.add_argument("--control", default="", help="known coordinates of targets, as for RefinePoses")
    parser.add_argument("--rig", default="", help="cameras on one bar, in the form of rig_config.json "
                        "(docs/rigs.md)")
    parser.add_argument("--checks", default="", help="targets and bars that do not enter the adjustment, as for "
                        "RefinePoses")


def finds(given):
    """Whether the run looks for targets."""
    return given.targets == FIND


def check(given):
    """Checks the options and makes the paths of the files absolute."""
    for name in FILES:
        value = getattr(given, name)
        if value and not (name == "targets" and value == FIND):
            setattr(given, name, files.existing(f"--{name}", value, value, is_file=True))
    if given.rig and not given.rig.endswith(".json"):
        raise Failure(f"--rig {given.rig}: must be a file in the form of rig_config.json; COLMAP's rigs.txt and "
                      "rigs.bin name images by the numbers of another model")
    for name in ("bars", "control", "checks"):
        value = getattr(given, name)
        if value and not given.targets:
            raise Failure(f"--{name} {value}: is for targets, and --targets is missing")
    if words_of("find-targets", given) and not finds(given):
        raise Failure(f"--find-targets {given.find_targets}: is for --targets {FIND}")
    if finds(given):
        require(given.programs, ["FindTargets"])


def require_found(file, images):
    """Failure if FindTargets found no target."""
    if not files.read_object(file).get("targets"):
        raise Failure(f"--targets {FIND}: no photograph of {images} shows a target of the families that are looked for "
                      "(--find-targets=--families)")


def files_of(given, out):
    """The files that RefinePoses reads."""
    found = out / FOUND if finds(given) else given.targets
    return [file for file in (found, given.bars, given.control, given.rig) if file]


def lines_of(found):
    """The lines of the report about the object "control" of RefinePoses's report."""
    yield f"- {found['targets']} targets at {found['observations']} places, {found['rms_px']:.3f} px"
    yield from (f"- warning: {line}" for line in found["left_out"])
    rows = rows_of(found)
    if rows:
        yield from ("", "| bar or control point | use | photographs | found minus stated [mm] | expected sigma [mm] |",
                    "|---|---|---|---|---|")
    for row in rows:
        columns = [", ".join("-" if one is None else f"{one:.2f}" for one in row[key])
                   for key in ("residual_mm", "expected_sigma_mm")]
        yield f"| {row['name']} | {row['use']} | {row['photographs']} | {' | '.join(columns)} |"


def rows_of(found):
    """The rows of the table of bars and control points: name, use, number of photographs, and the numbers in mm, of
    a bar its length, of a point x, y and z; None: not known or not determined."""
    entries = [(bar, [bar["length_m"]]) for bar in found["bars"]]
    entries += [(point, [point[axis] for axis in ("x_m", "y_m", "z_m")]) for point in found["points"]]
    in_mm = lambda numbers, key: [None if one is None or one[key] is None else 1e3 * one[key] for one in numbers]
    return [{"name": entry["name"], "use": entry["use"], "photographs": entry["photographs"],
             "residual_mm": in_mm(numbers, "residual"), "expected_sigma_mm": in_mm(numbers, "expected_sigma")}
            for entry, numbers in entries]


def words(given, out):
    """The options of RefinePoses."""
    options = {"--targets": out / FOUND if finds(given) else given.targets, "--bars": given.bars,
               "--control": given.control, "--checks": given.checks, "--rig": given.rig}
    return [word for option, value in options.items() if value for word in (option, value)]
