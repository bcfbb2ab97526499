# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs in simulated water that follows the model of RestoreColors in daylight, I = J exp(-a d) +
B (1 - exp(-b d)) in each channel: the a and B that it finds, against the true ones.

    python3 tests/acceptance/own_water.py [--draws 1 2 3] [--base DIR]

One line for each draw, with the errors of a and B of R, G and B in percent and in stated standard deviations. The
table at the end has the share within 8 % and the share within three standard deviations, of the channels that are
determined. A channel in photographs that were taken for those of lamps is not determined."""

import argparse
import dataclasses
import math
import pathlib
import random
import sys

sys.path[:0] = map(str, pathlib.Path(__file__).resolve().parents[:2])
from colors import restore  # noqa: E402
from points import BASE, point  # noqa: E402
from support import runs  # noqa: E402

FRESH_DRAWS = range(301, 321)  # not used while building
CHANNELS, PRESETS = ("red", "green", "blue"), ("reef", "closeup")
ERROR, SIGMAS, SHARE = 0.08, 3, 0.9
HEAD = "| draw | scene | true a | a: error % (sigmas) | true B | B: error % (sigmas) |\n|---|---|---|---|---|---|"


@dataclasses.dataclass(frozen=True)
class Water:
    a: list  # of R G B [1/m]
    b: list  # [1/m]
    veil: list


def water_of(draw):
    """The water of the draw with this number. a is drawn evenly in its logarithm."""
    chance = random.Random(draw)
    a = [round(math.exp(chance.uniform(math.log(0.1), 0)), 3) for _ in CHANNELS]
    return Water(a, [round(loss * chance.uniform(0.8, 1.2), 3) for loss in a],
                 [round(chance.uniform(0.05, 0.3), 3) for _ in CHANNELS])


def errors(true, estimate):
    """The relative error and the error in stated standard deviations."""
    error = estimate["value"] - true
    return error / true, error / estimate["sigma"]


def measure(base, draw):
    """The errors() of a and B of each channel, None where it is not determined, and a row of the table."""
    water, preset = water_of(draw), PRESETS[draw % 2]
    numbers = ",".join(map(str, water.a + water.b + water.veil))
    scene = runs.simulated(f"own-water-{draw}", base, "--preset", preset, "--seed", draw, "--views", 10, "--width",
                           512, "--height", 384, "--coarseness", 2, "--samples", 2, "--medium", "water", "--water",
                           numbers)
    channels = restore(scene, scene.data.parent / f"{scene.data.name}-restored")["channels"]
    known = [channels[name] if "a_per_m" in channels[name] and channels[name]["determined"] else None
             for name in CHANNELS]
    found = {quantity: [errors(true, channel[key]) if channel else None for true, channel in zip(truth, known)]
             for quantity, key, truth in (("a", "a_per_m", water.a), ("B", "veil", water.veil))}
    said = {quantity: ", ".join(f"{100 * one[0]:+.0f} ({one[1]:+.1f})" if one else "-" for one in of_channels)
            for quantity, of_channels in found.items()}
    true = [", ".join(map(str, numbers)) for numbers in (water.a, water.veil)]
    return found, f"| {draw} | {preset} | {true[0]} | {said['a']} | {true[1]} | {said['B']} |"


def shares(found):
    """The table of the shares, and whether each is large enough. `found`: of the draws, as measure() gives it."""
    lines = [f"| | channels determined | within {100 * ERROR:.0f} % | within {SIGMAS} stated standard deviations |",
             "|---|---|---|---|"]
    good = True
    for quantity in ("a", "B"):
        for k, name in enumerate(CHANNELS):
            known = [draw[quantity][k] for draw in found if draw[quantity][k]]
            near = sum(abs(relative) <= ERROR for relative, _ in known)
            stated = sum(abs(sigmas) <= SIGMAS for _, sigmas in known)
            lines.append(f"| {quantity}, {name} | {len(known)} of {len(found)} | {near} | {stated} |")
            good = good and bool(known) and min(near, stated) >= SHARE * len(known)
    return "\n".join(lines), good


@point(f"water of the model of RestoreColors in {len(FRESH_DRAWS)} draws: a and B of each channel that is determined "
       f"within {100 * ERROR:.0f} %, and within {SIGMAS} stated standard deviations, in {100 * SHARE:.0f} % of draws")
def own_water(work):
    found, rows = zip(*(measure(work, draw) for draw in FRESH_DRAWS))
    table, good = shares(found)
    return "\n".join([HEAD, *rows, "", table]), good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draws", type=int, nargs="+", default=list(range(1, 11)))
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    found = []
    for draw in given.draws:
        one, row = measure(given.base, draw)
        found.append(one)
        print(row, flush=True)
    print("\n" + shares(found)[0])


if __name__ == "__main__":
    main()
