# SPDX-License-Identifier: GPL-3.0-or-later
"""Random dives: lens, port, errors of the files, haze and trajectory are drawn. What `reconstruct` says is
compared with the truth.

    python3 tests/acceptance/random_dives.py [--base DIR] FIRST LAST

measures the dives with these numbers and prints a table. The acceptance point `random-dives` measures 200."""

import argparse
import dataclasses
import math
import pathlib
import random
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import dive_runs  # noqa: E402
from dive_runs import as_measured, change_focal_length, change_port, dive  # noqa: E402
from dives import baseline_of  # noqa: E402
from points import BASE, kept, point  # noqa: E402

COUNT = 200
PRESETS = ("reef", "closeup", "outcrop", "survey", "transect", "amphora")
# The errors of a diver's ruler (standard deviations).
RULER = {"distance_m": 0.005, "n_water": 0.004, "tilt": 3, "focal": 0.005}
WRONG = 3        # times the error with the right numbers: a wrong model
WRONG_LEAST = 1  # and larger by this [mm]
LENGTHS = 3      # standard deviations of the scale: a wrong scale


@dataclasses.dataclass(frozen=True)
class Drawn:
    """A dive, and what the diver states. `stated` holds the factor of the focal length and the port."""
    preset: str
    options: tuple
    views: int
    focal: float
    port: dict
    with_length: bool


def drawn_flat(draw):
    distance, tilt = draw.choice((0.005, 0.02, 0.05, 0.1)), draw.choice((0, 0, draw.uniform(0, 5)))
    stated = {"distance_m": max(0.001, distance + draw.gauss(0, RULER["distance_m"])), "normal": [0, 0, 1]}
    return ("--port-distance", distance, "--tilt-degrees", round(tilt, 3)), stated


def drawn_dome(draw):
    shift = [round(draw.gauss(0, 0.003), 4) for _ in range(3)]
    options = ("--dome-radius", 0.06, "--dome-x", shift[0], "--dome-y", shift[1], "--dome-z", shift[2])
    return options, {"center_m": [0, 0, 0]}


def drawn(number):
    """The dive with this number."""
    draw = random.Random(number)
    options, port = (drawn_dome if draw.random() < 0.3 else drawn_flat)(draw)
    water = draw.choice((1.333, 1.337, 1.341))
    fov = draw.choice((65, 80, 95))
    haze = draw.choice((0, 0, 0.3, 0.6))
    options += ("--n-water", water, "--fov-degrees", fov, "--haze", haze)
    port["n_water"] = round(water + draw.gauss(0, RULER["n_water"]), 5)
    focal = 1 + draw.gauss(0, RULER["focal"]) if draw.random() < 0.8 else 1.02
    return Drawn(draw.choice(PRESETS), options, draw.randint(8, 14), focal, port, draw.random() < 0.8)


def stated_depth(outcome):
    """The error of depths that three stated standard deviations allow [mm]."""
    distance = re.search(r"median distance of ([\d.]+) m", outcome.said)
    return 1e3 * 3 * (outcome.report.get("depth_sigma") or 0) * (float(distance[1]) if distance else 0)


def judged(outcome, right):
    """What is wrong about the result without a word of `reconstruct`; empty if nothing is."""
    if outcome.code != 0 or outcome.warnings:
        return ""
    faults = []
    # Where even the right numbers give no model, no model may come without a word.
    most = max(WRONG * right, right + WRONG_LEAST, right + stated_depth(outcome))
    if math.isinf(right) or outcome.median > most:
        faults.append(f"error {outcome.median:.2f} mm instead of {right:.2f} mm")
    sigma = outcome.report.get("scale_sigma")
    if sigma is not None and abs(outcome.scale - 1) > LENGTHS * sigma + 0.002:
        faults.append(f"scale {100 * (outcome.scale - 1):+.2f} %, stated {100 * sigma:.2g} %")
    return ", ".join(faults)


def measure(number, base, work):
    one = drawn(number)
    data = dive(base, one.preset, number, *one.options, views=one.views)
    folder = work / str(number)
    brought = as_measured(data, folder)
    change_focal_length(brought, one.focal)
    change_port(brought, **one.port)
    if not one.with_length:
        brought.scale_from = ""
    outcome = dive_runs.run(brought, data, folder / "out")
    right = baseline_of(data, work)
    return one, outcome, right, judged(outcome, right)


HEAD = ("| number | dive | photographs | exit | error [mm] | right [mm] | scale off by | stated | warnings | "
        "silent fault |\n"
        "|---|---|---|---|---|---|---|---|---|---|")


def line_about(number, one, outcome, right, fault):
    sigma = outcome.report.get("scale_sigma")
    words = [word.split("] ")[-1][:70].replace("|", "/") for word in outcome.warnings]
    return (f"| {number} | {one.preset} {' '.join(map(str, one.options))} | {outcome.registered} of "
            f"{outcome.photographs} | {outcome.code} | {outcome.median:.2f} | {right:.2f} | "
            f"{100 * (outcome.scale - 1):+.2f} % | {'unknown' if sigma is None else f'{100 * sigma:.2g} %'} | "
            f"{'; '.join(words)} | {fault} |")


def line_of(number, work):
    *measured, fault = measure(number, BASE, work)
    return [line_about(number, *measured, fault), bool(fault)]


@point(f"{COUNT} random dives (lens, port, errors of the files, haze, trajectory): never a wrong model with exit code "
       "0 and no warning")
def random_dives(work):
    work, faults = work / "random-dives", 0
    work.mkdir(parents=True, exist_ok=True)
    lines = [HEAD]
    for number in range(1, COUNT + 1):
        line, bad = kept(work / f"{number}.line.json", lambda number=number: line_of(number, work))
        lines.append(line)
        faults += bad
        (work / "table.md").write_text("\n".join(lines) + "\n")
    return f"{faults} of {COUNT} dives gave a wrong model in silence: {work / 'table.md'}", faults == 0


def main():
    parser = argparse.ArgumentParser(description="Measures random dives.")
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    given = parser.parse_args()
    print(HEAD)
    for number in range(given.first, given.last + 1):
        print(line_about(number, *measure(number, given.base, given.base / "random")), flush=True)


if __name__ == "__main__":
    main()
