# SPDX-License-Identifier: GPL-3.0-or-later
"""A strip of photographs that bends, with and without control points at its ends.

    python3 tests/acceptance/control_strip.py [--seeds 83] [--views 60] [--base DIR]

COLMAP runs once. RefinePoses runs with a known length, and with the plates at the ends of the strip as control points
of 10 mm besides: with the right numbers of lens and port, and with numbers of a ruler. The heights of the camera
centres are compared after the best similarity, in sixths of the strip."""

import argparse
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from control_draws import SIGMA, control_json, drawn_numbers, found_plates, posed, refined  # noqa: E402
from dive_runs import as_measured, line_of  # noqa: E402
from points import BASE, point  # noqa: E402
from support import runs  # noqa: E402
from support.colmap_text import centres  # noqa: E402
from support.runs import PROGRAMS, measured  # noqa: E402

FRESH_SEEDS = (83, 84)   # not used while building
VIEWS, PARTS = 60, 6
OVERLAP = 0.6            # of successive photographs
END = 0.12               # the part of the strip that is an end
SHARE = 1 / 3            # of the bend, with control


def strip(base, seed, views):
    """The dive, and the result of COLMAP with the targets."""
    data = runs.simulated(f"strip-{seed}-{views}", base, "--preset", "transect", "--seed", seed, "--views", views,
                          "--overlap", OVERLAP, "--targets", 30, "--target-side", 0.2, "--medium", "water", "--truth",
                          0, "--width", 640, "--height", 480, "--coarseness", 2, "--samples", 2).data
    return data, posed(data)


def along_strip(data):
    """A function from a place to its part of the strip, from 0 to 1."""
    places = list(centres(data / "sparse").values())
    first, along = line_of(places)
    distance = lambda place: sum(a * (p - f) for a, p, f in zip(along, place, first))
    length = max(map(distance, places))
    return lambda place: distance(place) / length


def bend(model, data, folder):
    """The largest mean error of the heights in a part of the strip [m]."""
    measured(folder / "align.log", *PROGRAMS.align(model, data / "sparse", folder / "aligned"))
    truth, found, part = centres(data / "sparse"), centres(folder / "aligned"), along_strip(data)
    errors = [[] for _ in range(PARTS)]
    for name, place in found.items():
        errors[min(PARTS - 1, max(0, int(PARTS * part(truth[name]))))].append(place[2] - truth[name][2])
    return max(abs(sum(some) / len(some)) for some in errors if some)


def end_plates(data, out):
    """The true places of the plates that photographs show near the ends of the strip."""
    part = along_strip(data)
    return {label: place for label, place in found_plates(data, out).items() if not END < part(place) < 1 - END}


NUMBERS = {
    "right": lambda data, folder, seed: as_measured(data, folder),
    "of a ruler": lambda data, folder, seed: drawn_numbers(data, folder, random.Random(f"strip {seed}")),
}


def bends(seed, data, out, numbers):
    """The bend without and with control."""
    for name in ("free", "control"):
        folder = data.parent / f"{data.name}-{name}-{numbers.replace(' ', '-')}"
        folder.mkdir(exist_ok=True)
        brought = NUMBERS[numbers](data, folder, seed)
        options = ["--scale-from", brought.scale_from]
        if name == "control":
            (folder / "control.json").write_text(control_json(end_plates(data, out), {}, random.Random(seed)))
            options += ["--control", folder / "control.json"]
        _, model = refined(brought, out, folder, *options)
        yield bend(model, data, folder)


def measure(seed, numbers, views=VIEWS, base=BASE):
    """A row of the table, and whether control helps enough."""
    data, out = strip(base, seed, views)
    without, with_control = bends(seed, data, out, numbers)
    return (f"| {seed} | {numbers} | {views} | {len(end_plates(data, out))} | {1e3 * without:.1f} mm | "
            f"{1e3 * with_control:.1f} mm | {with_control / without:.2f} |"), with_control <= SHARE * without


HEAD = ("| seed | numbers of lens and port | photographs | plates at the ends | bend without control | with control | "
        "ratio |\n|---|---|---|---|---|---|---|")


@point(f"a strip of {VIEWS} photographs, lens and port measured with a ruler: with control points of {1e3 * SIGMA:.0f} "
       "mm at both ends, the bend of the heights is at most a third")
def control_strip(work):
    found = [measure(seed, numbers, VIEWS, work) + (numbers,) for seed in FRESH_SEEDS for numbers in NUMBERS]
    return ("\n".join([HEAD, *(row for row, _, _ in found)]),
            all(good for _, good, numbers in found if numbers == "of a ruler"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[73])
    parser.add_argument("--views", type=int, default=VIEWS)
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    for seed in given.seeds:
        for numbers in NUMBERS:
            row, good = measure(seed, numbers, given.views, given.base)
            print(row, "" if good else "missed", flush=True)


if __name__ == "__main__":
    main()
