# SPDX-License-Identifier: GPL-3.0-or-later
"""Two surveys of a reef with the same plates, from raw photographs: the registration by the plates, and the volume of
a boulder that moved.

    python3 tests/acceptance/target_surveys.py [--seeds 44] [--base DIR]"""

import argparse
import json
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import dive_runs  # noqa: E402
from dive_runs import as_measured  # noqa: E402
from points import BASE, point  # noqa: E402
from support import runs  # noqa: E402
from support.runs import BIN, measured  # noqa: E402

SEEDS = (44, 45)       # of surveys.py
VIEWS = 24             # so that several photographs of both surveys show each plate
LARGEST, VOLUME = 0.002, 5  # [m], [%]
BAR = 0.5


def dive(base, seed, *options):
    return runs.simulated(f"plates-survey-{seed}" + ("-changed" if options else ""), base, "--preset", "reef", "--seed",
                          seed, "--views", VIEWS, "--targets", 4, "--bars", BAR, "--target-side", 0.15, "--medium",
                          "water", "--truth", 0, *options).data


def survey(data, out, earlier=None):
    """Runs `reconstruct` up to the mesh. The plates place the first survey in the frame of the truth; the second has
    only the bar, and a frame of its own."""
    brought = as_measured(data, out.parent / f"{out.name}-brought")
    brought.scale_from = ""
    bars, points = (out.parent / f"{out.name}-brought" / name for name in ("bars.csv", "plates.csv"))
    bars.write_text(f"target 5,target 6,{BAR},0.0001\n")
    plates = json.loads((data / "true_targets.json").read_text())["plates"]
    points.write_text("label,x,y,z,accuracy\n" + "".join(
        f"{plate['label']},{','.join(map(str, plate['centre']))},0.0005\n" for plate in plates))
    brought.options = ("--targets", "find", "--find-targets=--families circular12", "--bars", bars, "--without",
                       "texture,map,page", *(["--earlier", earlier] if earlier else ["--control", points]))
    outcome = dive_runs.run(brought, data, out, "mesh")
    if outcome.code:
        raise RuntimeError(outcome.said[-500:])


def moved(matrix, place):
    return [sum(a * x for a, x in zip(row, [*place, 1])) for row in matrix[:3]]


def places(out):
    """The plates of a survey by their labels."""
    content = json.loads((out / "refined" / "target_places.json").read_text())
    return {one["label"]: [one[axis] for axis in "xyz"] for one in content["targets"]}


def measure(seed, base=BASE):
    """A row of the table, and whether it is good enough."""
    before_data, after_data = dive(base, seed), dive(base, seed, "--changed")
    before, after = base / f"target-survey-{seed}", base / f"target-survey-{seed}-changed"
    if not (after / "scene.change.json").exists():
        survey(before_data, before)
        survey(after_data, after, before)
    report = json.loads((after / "scene.change.json").read_text())
    truth = {plate["label"]: plate["centre"]
             for plate in json.loads((before_data / "true_targets.json").read_text())["plates"]}
    second = places(after)
    off = [math.dist(truth[label], moved(report["registration"]["matrix"], second[label]))
           for label in truth if label in second]
    measured(after / "check.log", BIN / "change_check", seed, after / "scene")
    came, gone = (float(v) for v in re.search(r"volumes: came (\S+) gone (\S+)",
                                              (after / "check.log").read_text()).groups())
    volumes = [100 * (report["came"]["volume"] / came - 1), 100 * (report["gone"]["volume"] / gone - 1)]
    good = max(off) <= LARGEST and max(map(abs, volumes)) <= VOLUME
    return (f"| {seed} | {len(off)} | {1e3 * max(off):.2f} mm | {volumes[0]:+.1f} % | {volumes[1]:+.1f} % |"), good


HEAD = "| seed | common plates | registration off by | volume that came | volume that went |\n|---|---|---|---|---|"


@point(f"two surveys with the same plates, from raw photographs: registration within {1e3 * LARGEST:.0f} mm, volumes "
       f"of what changed within {VOLUME} %")
def target_surveys(work):
    found = [measure(seed, work) for seed in SEEDS]
    return "\n".join([HEAD, *(row for row, _ in found)]), all(good for _, good in found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[44])
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    for seed in given.seeds:
        row, good = measure(seed, given.base)
        print(row, "" if good else "missed", flush=True)


if __name__ == "__main__":
    main()
