# SPDX-License-Identifier: GPL-3.0-or-later
"""Two cameras on one bar, each behind its own port, from raw photographs: the scale, without any other length, and a
camera that is late.

    python3 tests/acceptance/rig_surveys.py [--seeds 91] [--base DIR]"""

import argparse
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import dive_runs  # noqa: E402
from control_draws import scale_of  # noqa: E402
from dive_runs import SMALL, as_measured  # noqa: E402
from points import BASE, point  # noqa: E402
from support import runs  # noqa: E402
from support.colmap_text import centres  # noqa: E402

FRESH_SEEDS = (91, 92, 93)  # not used while building
RIG_BASE, SCALE = 0.2, 0.001  # [m], relative
SPEED, DELAY = 0.3, 0.04      # [m/s], [s]
VIEWS = 12                    # of each camera


def interval_of(data):
    """The mean time between photographs [s]."""
    places = [place for name, place in sorted(centres(data / "sparse").items()) if name.startswith("left/")]
    return sum(map(math.dist, places, places[1:])) / (len(places) - 1) / SPEED


def rig_dive(base, seed, *options):
    name = f"rig-{seed}" + ("-late" if options else "")
    return runs.simulated(name, base, "--preset", "reef", "--seed", seed, "--views", VIEWS, *SMALL, "--rig-base",
                          RIG_BASE, "--rig-port-distance", 0.03, *options).data


def brought_by(data, folder, interval):
    """What the diver gives: a lens for each camera, the housing and the stated rig; no length."""
    brought = as_measured(data, folder)
    lines = [line for line in brought.lens.read_text().splitlines() if not line.startswith("#")]
    for line, side in zip(lines, ("left", "right")):
        (folder / f"{side}.txt").write_text(line + "\n")
    (folder / "rig_config.json").write_text(json.dumps([{"cameras": [
        {"image_prefix": "left/", "ref_sensor": True},
        {"image_prefix": "right/", "cam_from_rig_rotation": [1, 0, 0, 0],
         "cam_from_rig_translation": [-RIG_BASE, 0, 0]}]}]))
    brought.scale_from = ""
    brought.lens = f"left/:{folder / 'left.txt'}"
    brought.options = ("--lens", f"right/:{folder / 'right.txt'}", "--rig", folder / "rig_config.json",
                       f"--refine-poses=--rig-interval {interval}")
    return brought


def measure(seed, late, base=BASE):
    """A row of the table, and whether it is good enough."""
    at_once = rig_dive(base, seed)
    interval = interval_of(at_once)
    data = rig_dive(base, seed, "--rig-delay", f"{DELAY / interval:.6f}") if late else at_once
    folder = base / "rigs" / data.name
    outcome = dive_runs.run(brought_by(data, folder, interval), data, folder / "out")
    if outcome.code:
        return f"| {seed} | {late} | exit code {outcome.code}: {outcome.said[-300:]} |", False
    error = scale_of(folder / "out" / "refined" / "sparse", data / "sparse") - 1
    timing = outcome.report["rigs"][0]["cameras"][0].get("timing") or {}
    told = any("later than" in line for line in outcome.warnings)
    good = abs(error) <= SCALE and told == late
    return (f"| {seed} | {1e3 * DELAY * late:.0f} ms | {outcome.registered} of {outcome.photographs} | "
            f"{100 * error:+.3f} % | {100 * outcome.report['scale_sigma']:.3f} % | "
            f"{timing.get('delay_ms', math.nan):.1f} +- {timing.get('sigma_ms', math.nan):.1f} ms | "
            f"{'warned' if told else 'no warning'} |"), good


HEAD = ("| seed | delay | photographs | scale off by | stated | delay found | |\n|---|---|---|---|---|---|---|")


@point(f"two cameras {RIG_BASE} m apart, each behind its own port, no other length, three seeds: scale within "
       f"{100 * SCALE} %; a delay of {1e3 * DELAY:.0f} ms at {SPEED} m/s is a warning")
def rig_surveys(work):
    found = [measure(seed, late, work) for seed in FRESH_SEEDS for late in (False, True)]
    return "\n".join([HEAD, *(row for row, _ in found)]), all(good for _, good in found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[75])
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    for seed in given.seeds:
        for late in (False, True):
            row, good = measure(seed, late, given.base)
            print(row, "" if good else "missed", flush=True)


if __name__ == "__main__":
    main()
