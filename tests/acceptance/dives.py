# SPDX-License-Identifier: GPL-3.0-or-later
"""What `reconstruct` makes of what divers really bring up: wrong numbers, haze, blur, mixed folders.

    python3 tests/acceptance/dives.py [--seed N] [--base DIR] [ROW...]

measures rows one by one and prints them. The acceptance point `dives` measures all rows with five seeds."""

import argparse
import dataclasses
import math
import pathlib
import random
import re
import struct
import sys
import typing

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import dive_runs  # noqa: E402
from dive_runs import as_measured, change_focal_length, change_photographs, change_port, dive  # noqa: E402
from points import BASE, point  # noqa: E402
from support.colmap_text import centres  # noqa: E402

FRESH_SEEDS = (1101, 1102, 1103, 1104, 1105)  # not used while building
TOLERATED = 1.15        # times the error with the right numbers
TOLERATED_PICTURES = 1.3  # the same, for photographs of low quality
# When all numbers are wrong, all must be estimated: then the error is compared with that of estimating all of
# them from the right values.
ALL_NUMBERS = "normal,distance,index,focal"
NOISE = 0.05            # of the error: what two runs of COLMAP differ by [mm]


@dataclasses.dataclass(frozen=True)
class Row:
    """A dive, what is wrong with it, and what is right."""
    name: str
    data: typing.Callable     # (base, seed) -> the folder of the dive
    wrong: typing.Callable    # (brought, folder, data): changes what the diver brings
    factor: float = TOLERATED
    says: str = ""            # a regular expression that the output must have
    lost: int = 0             # photographs that may be left out
    right: typing.Callable | None = None  # the dive with which errors are compared; default: `data`
    right_refine: str = "none"  # the numbers that are estimated with the right files, of the same dive


def reef(*options, views=10, preset="reef"):
    return lambda base, seed: dive(base, preset, seed, *options, views=views)


def closeup(*options):
    return reef(*options, preset="closeup")


def nothing(brought, folder, data):
    pass


def focal(factor):
    return lambda brought, folder, data: change_focal_length(brought, factor)


def port(**values):
    return lambda brought, folder, data: change_port(brought, **values)


def several(*changes):
    def change(brought, folder, data):
        for one in changes:
            one(brought, folder, data)
    return change


def options(*words):
    def change(brought, folder, data):
        brought.options += words
    return change


def no_length(brought, folder, data):
    brought.scale_from = ""


def write_positions(brought, folder, data, sigma, wrong=()):
    """`wrong`: the displacement [m] of one position."""
    noise = random.Random(1)
    lines = []
    for number, (name, true) in enumerate(sorted(centres(data / "sparse").items())):
        place = [value + noise.gauss(0, sigma) for value in true]
        if wrong and number == 4:
            place = [value + shift for value, shift in zip(place, wrong)]
        lines.append(f"{name} {place[0]:.6f} {place[1]:.6f} {place[2]:.6f}\n")
    (folder / "positions.txt").write_text("".join(lines))
    brought.scale_from = f"positions:{folder / 'positions.txt'}"


def positions(sigma, wrong=()):
    return lambda brought, folder, data: write_positions(brought, folder, data, sigma, wrong)


def pictures(change, value, which):
    """Changes the photographs whose numbers are in `which`."""
    def change_some(brought, folder, data):
        names = sorted(path.name for path in brought.images.iterdir())
        change_photographs(brought, folder / "images", {names[i]: (change, value) for i in which})
    return change_some


def with_focal_length(jpeg, millimetres):
    """A JPEG file with this focal length in its Exif data."""
    first = struct.pack("<HHHIII", 1, 0x8769, 4, 1, 26, 0)
    table = struct.pack("<HHHIII", 1, 0x920A, 5, 1, 44, 0) + struct.pack("<II", round(10 * millimetres), 10)
    body = b"Exif\0\0II*\0\x08\0\0\0" + first + table
    return jpeg[:2] + b"\xff\xe1" + struct.pack(">H", len(body) + 2) + body + jpeg[2:]


WIDE, ZOOMED = 80, 60       # fields of view [degrees]
MILLIMETRES = 18            # the focal length for the wide one


def zoom_in_half(brought, folder, data):
    """Half of the photographs are from the same dive at another focal length, which the Exif data state."""
    seed = int(data.name.split("-")[2])
    zoomed = dive(data.parents[1], "reef", seed, "--fov-degrees", ZOOMED)
    ratio = math.tan(math.radians(WIDE / 2)) / math.tan(math.radians(ZOOMED / 2))
    images = folder / "images"
    images.mkdir(exist_ok=True)
    for number, photograph in enumerate(sorted(brought.images.iterdir())):
        source = zoomed / "water" / photograph.name if number % 2 else photograph
        (images / photograph.name).write_bytes(with_focal_length(
            source.read_bytes(), MILLIMETRES * (ratio if number % 2 else 1)))
    brought.images = images


def another_housing(content):
    def change(brought, folder, data):
        brought.housing.write_text(content)
    return change


def kind(word):
    def change(brought, folder, data):
        brought.housing = word
    return change


DOME = ('{"version": 1, "default": "d", "ports": {"d": {"type": "dome", "center_m": [0, 0, 0], '
        '"inner_radius_m": 0.06, "thickness_m": 0.008, "n_air": 1, "n_glass": 1.52, "n_water": 1.333}}}')

ROWS = [
    Row("right", reef(), nothing),
    Row("right-closeup", closeup(), nothing),
    Row("focal", reef(), focal(1.01)),
    Row("focal-closeup", closeup(), focal(1.01)),
    Row("index", reef("--n-water", 1.341), port(n_water=1.333)),
    Row("index-closeup", closeup("--n-water", 1.341), port(n_water=1.333)),
    Row("tilt", reef("--tilt-degrees", 3), port(normal=[0, 0, 1])),
    Row("tilt-closeup", closeup("--tilt-degrees", 3), port(normal=[0, 0, 1])),
    Row("all-at-once", reef("--tilt-degrees", 3, "--n-water", 1.339),
        several(port(normal=[0, 0, 1], n_water=1.333, distance_m=0.025), focal(1.005)), right_refine=ALL_NUMBERS),
    Row("all-at-once-closeup", closeup("--tilt-degrees", 3, "--n-water", 1.339),
        several(port(normal=[0, 0, 1], n_water=1.333, distance_m=0.025), focal(1.005)), right_refine=ALL_NUMBERS),
    Row("dome-centre", reef("--dome-radius", 0.06, "--dome-x", 0.003, "--dome-z", 0.005),
        port(center_m=[0, 0, 0])),
    Row("positions-5-cm", reef(), positions(0.05)),
    Row("position-wrong", reef(), positions(0.001, (0.7, 0.7, 0.7)), says="0004"),
    Row("no-length", reef(), no_length),
    Row("no-length-distance", reef(), several(no_length, port(distance_m=0.025))),
    Row("no-length-tilt", reef("--tilt-degrees", 3), several(no_length, port(normal=[0, 0, 1]))),
    Row("hazy", reef(preset="reef-hazy"), nothing, TOLERATED_PICTURES, right=reef()),
    Row("sand", reef(preset="sand"), nothing, TOLERATED_PICTURES),
    Row("two-sizes", reef(), pictures("size", 0.75, range(5))),
    Row("turned", reef(), pictures("turn", 1, (2, 5, 7))),
    Row("zoom", reef(), zoom_in_half, says="mm instead of"),
    Row("blurred", reef(), pictures("blur", 3.5, (1, 4, 8)), TOLERATED_PICTURES, says="blur", lost=3),
    Row("no-housing", reef("--port-distance", 0.05), kind("flat"), factor=1.3),
    Row("dome-for-flat", reef(), another_housing(DOME), says="flat"),
    Row("lawnmower", reef("--port-distance", 0.05, "--relief", 0.1, preset="survey", views=21), nothing),
]


def baseline_of(data, work, refine="none"):
    """The error [mm] with the right numbers, of which those in the list `refine` are estimated."""
    file = work / "right" / (data.name + ("" if refine == "none" else "_" + refine) + ".txt")
    if not file.exists():
        folder = file.with_suffix("")
        brought = as_measured(data, folder)
        brought.options = ("--refine", refine)
        file.write_text(f"{dive_runs.run(brought, data, folder / 'out').median}")
    return float(file.read_text())


def measure(row, seed, base, work):
    """The outcome, the error with the right numbers, and what is wrong about the outcome."""
    folder = work / f"{row.name}-{seed}"
    data = row.data(base, seed)
    brought = as_measured(data, folder)
    row.wrong(brought, folder, data)
    outcome = dive_runs.run(brought, data, folder / "out")
    right = baseline_of((row.right or row.data)(base, seed), work, row.right_refine)
    faults = []
    if outcome.code != 0:
        faults.append(f"exit code {outcome.code}")
    if outcome.registered < outcome.photographs - row.lost:
        faults.append(f"{outcome.registered} of {outcome.photographs} photographs")
    if not outcome.median <= row.factor * right + NOISE:
        faults.append(f"error {outcome.median / right:.2f} times the right one")
    if row.says and not re.search(row.says, "\n".join(outcome.warnings)):
        faults.append(f"no warning names '{row.says}'")
    return outcome, right, faults


def line_about(row, seed, outcome, right, faults):
    sigma = outcome.report.get("scale_sigma")
    stated = "unknown" if sigma is None else f"{100 * sigma:.2g} %"
    off = "" if math.isnan(outcome.scale) else f"{100 * (outcome.scale - 1):+.3f} %"
    return (f"| {row.name} | {seed} | {outcome.registered} of {outcome.photographs} | {outcome.median:.2f} | "
            f"{right:.2f} | {off} | {stated} | {len(outcome.warnings)} | {'; '.join(faults) or 'good'} |")


HEAD = ("| dive | seed | photographs | error [mm] | right [mm] | scale off by | stated | warnings | |\n"
        "|---|---|---|---|---|---|---|---|---|")


@point(f"dives with wrong numbers, haze, blur and mixed folders, five seeds: errors at most {TOLERATED} times those "
       f"with the right numbers ({TOLERATED_PICTURES} times for photographs of low quality), all photographs have "
       "poses, and what is wrong is named")
def dives(work):
    lines, bad = [HEAD], 0
    for seed in FRESH_SEEDS:
        for row in ROWS:
            outcome, right, faults = measure(row, seed, BASE, work / "dives")
            lines.append(line_about(row, seed, outcome, right, faults))
            bad += bool(faults)
            (work / "dives" / "table.md").write_text("\n".join(lines) + "\n")
    return f"{bad} of {len(lines) - 1} dives fall short: {work / 'dives' / 'table.md'}", bad == 0


def main():
    parser = argparse.ArgumentParser(description="Measures dives.")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    parser.add_argument("rows", nargs="*", metavar="ROW", help=", ".join(row.name for row in ROWS))
    given = parser.parse_args()
    unknown = set(given.rows) - {row.name for row in ROWS}
    if unknown:
        parser.error(f"{', '.join(sorted(unknown))}: no such row")
    print(HEAD)
    for row in ROWS:
        if not given.rows or row.name in given.rows:
            print(line_about(row, given.seed, *measure(row, given.seed, given.base, given.base / "dives")), flush=True)


if __name__ == "__main__":
    main()
