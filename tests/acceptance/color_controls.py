# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs from which no or wrong colours would follow: a program must refuse them or warn.

    python3 tests/acceptance/color_controls.py [--seeds 5] [--base DIR]

One line for each control, with CIEDE2000 before and after (color_check), and what the import and RestoreColors said.
The controls: all photographs from one distance, a distance of the port that is 5 cm wrong, photographs by lamps that
are taken for daylight, and photographs in daylight that are taken for those by lamps. The last ones are
reported only."""

import argparse
import json
import pathlib
import re
import sys

sys.path[:0] = map(str, pathlib.Path(__file__).resolve().parents[:2])
from colors import checked, restore  # noqa: E402
from points import BASE, point  # noqa: E402
from support import runs  # noqa: E402

FRESH_SEEDS = (162,)  # not used while building
PRESETS = ("reef", "closeup")
SIZE = ("--width", 512, "--height", 384, "--coarseness", 2, "--samples", 2)
WRONG = 0.05  # of the port's distance [m]
# Even ground, seen straight down from 0.29 m through a long lens: ways differ by some millimetres. Ways from 2.84 to
# 2.93 m would be enough to determine the loss.
EVEN = ("--relief", 0.01, "--scale", 0.1, "--fov-degrees", 30, "--overlap", 0.8)
HEAD = "| control | scene | seed | CIEDE2000 | | import | RestoreColors |\n|---|---|---|---|---|---|---|"


def photographed(base, preset, seed, light, *options):
    """A scene with light in water of type IB."""
    return runs.simulated(f"color-controls-{preset}-{seed}-{light}", base, "--preset", preset, "--seed", seed,
                          "--views", 10, *SIZE, "--medium", "water", "--water", "IB", "--light", light, *options)


def with_wrong_port(scene, folder):
    """The housing file of the scene with another distance of the port."""
    housing = json.loads((scene.data / "housing.json").read_text())
    for port in housing["ports"].values():
        port["distance_m"] += WRONG
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / "wrong.json"
    file.write_text(json.dumps(housing))
    return file


def said_in(log):
    """The warnings and errors in the log of a program, without folders."""
    lines = log.read_text().splitlines() if log.exists() else []
    return [re.sub(r"(?<= )/\S*/", "", line) for line in lines
            if "warning" in line.lower() or line.startswith(("InterfaceCOLMAP:", "RestoreColors:"))]


def measure(base, control, preset, seed, light, options=(), *, must=True, wrong_port=False, even=False):
    """A row of the table, and whether a program refused or warned, or need not."""
    scene = photographed(base, preset, seed, light, *(EVEN if even else ()))
    folder = scene.data.parent / f"{scene.data.name}-{control.replace(' ', '-')}"
    for log in folder.glob("*.log"):
        log.unlink()
    try:
        restore(scene, folder, *options, housing=with_wrong_port(scene, folder) if wrong_port else None)
        truth = scene.data / "water"
        colors = " to ".join(f"{checked(truth, one)['delta_e']:.1f}" for one in (truth, folder / "restored"))
    except RuntimeError:  # refused
        colors = "-"
    said = [said_in(folder / name) for name in ("import.log", "restore.log")]
    verdict = "refused" if colors == "-" else "warned" if any(said) else "silent"
    words = " | ".join(" ".join(lines).replace("|", "/") or "-" for lines in said)
    return f"| {control} | {preset} | {seed} | {colors} | {verdict} | {words} |", verdict != "silent" or not must


def controls(base, seeds):
    """The rows, and whether they are good, one by one."""
    for seed in seeds:
        yield measure(base, "one distance", "transect", seed, "sun", ("--light", "sun"), even=True)
        for preset in PRESETS:
            yield measure(base, "wrong port", preset, seed, "sun", wrong_port=True)
            yield measure(base, "lamps taken for daylight", preset, seed, "lamp", ("--light", "sun"))
            yield measure(base, "daylight taken for lamps", preset, seed, "sun", ("--light", "lamp"), must=False)


@point(f"photographs from one distance, with a port that is {100 * WRONG:.0f} cm wrong, or by lamps that are taken for "
       f"daylight: a program refuses or warns")
def color_controls(work):
    rows, good = zip(*controls(work, FRESH_SEEDS))
    return "\n".join([HEAD, *rows]), all(good)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[5])
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    for row, _ in controls(given.base, given.seeds):
        print(row, flush=True)


if __name__ == "__main__":
    main()
