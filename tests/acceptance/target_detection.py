# SPDX-License-Identifier: GPL-3.0-or-later
"""Plates on simulated seabeds, found by FindTargets. One line a scene: plates of at least 24 pixels and at most 60
degrees that are found, false labels, root mean squares of the differences from the image of the centre, and of the
errors of what a photograph shows (the centre of the dot's ellipse, the corners of a square): in pixels and in stated
standard deviations.

    python3 tests/acceptance/target_detection.py [--seeds 31 32] [--haze 0.6] [--base DIR]
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys

sys.path[:0] = map(str, pathlib.Path(__file__).resolve().parents[:2])
from points import BASE, point  # noqa: E402
from support import runs  # noqa: E402
from support.runs import BIN  # noqa: E402

FRESH_SEEDS, FRESH_HAZY_SEEDS, HAZE = (56, 57, 58), (59, 60), 0.6  # not used while building
PRESETS, FAMILIES = ("reef", "closeup"), ("circular12", "APRILTAG_36h11")
FOUND = 0.98
CENTRE, HAZY_CENTRE = 0.10, 0.25  # [px]
SIGMA = 1.5                       # a factor


def simulated(base, preset, family, seed, haze):
    """The folder of the scene."""
    side = 0.15 if preset == "reef" else 0.04
    return runs.simulated(f"targets-{preset}-{family}-{seed}-{haze}", base, "--preset", preset, "--seed", seed,
                          "--targets", 12, "--bars", 4 * side, "--target-side", side, "--target-family", family,
                          "--medium", "water", "--truth", 0, "--haze", haze).data


def find(programs, folder, family):
    output = folder / "targets.json"
    subprocess.run([programs / "FindTargets", folder / "water", "-o", output, "--families", family, "-v", "0"],
                   check=True)
    return json.loads(output.read_text())["targets"]


def judge(truth, found):
    """Numbers of plates seen, found and falsely found; squares of a coordinate's difference from the image of the
    centre [px], of its error [px] and in sigmas."""
    there = {(image, plate["label"]): plate for image, plates in truth["images"]["water"].items() for plate in plates}
    counted = {key: plate for key, plate in there.items() if plate["width"] >= 24 and plate["oblique_degrees"] <= 60}
    labels = {plate["label"] for plate in truth["plates"]}
    seen, false, centres, errors, in_sigmas = set(), 0, [], [], []
    for target in found:
        plate = there.get((target["image"], target["label"]))
        if plate is None:
            false += target["label"] not in labels  # a plate that is partly hidden may be found
            continue
        centre = place_of(target)
        off = math.dist(centre, place_of(plate))
        false += off > plate["width"] / 4
        if (target["image"], target["label"]) in counted:
            seen.add((target["image"], target["label"]))
        centres.append(off ** 2 / 2)
        pairs = ([(corner[:2], true, corner[2]) for corner, true in zip(target["corners"], plate["corners"])]
                 if "corners" in plate else [(centre, plate["dot"], target["sigma"])])
        errors += [math.dist(found, true) ** 2 / 2 for found, true, _ in pairs]
        in_sigmas += [math.dist(found, true) ** 2 / 2 / sigma ** 2 for found, true, sigma in pairs]
    return len(counted), len(seen), false, centres, errors, in_sigmas


def place_of(one):
    return one["x"], one["y"]


def root_mean(squares):
    return math.sqrt(sum(squares) / len(squares)) if squares else math.nan


def measure(programs, base, preset, family, seed, haze):
    """Numbers of plates seen, found and falsely found; root mean squares of differences of centres, errors, and errors
    in sigmas."""
    folder = simulated(base, preset, family, seed, haze)
    truth = json.loads((folder / "true_targets.json").read_text())
    plates, seen, false, *squares = judge(truth, find(programs, folder, family))
    return plates, seen, false, *map(root_mean, squares)


def row_of(preset, family, seed, haze, measured):
    plates, seen, false, centre, error, in_sigmas = measured
    return (f"| {preset} | {family} | {seed} | {haze} | {plates} | {seen} | {false} | {centre:.3f} | {error:.3f} | "
            f"{in_sigmas:.2f} |")


HEAD = ("| scene | family | seed | haze | plates | found | false | centre [px] | error [px] | in sigmas |\n"
        "|---|---|---|---|---|---|---|---|---|---|")


def is_good(haze, measured):
    plates, seen, false, centre, _, in_sigmas = measured
    return (seen >= (0 if haze else FOUND * plates) and not false and centre <= (HAZY_CENTRE if haze else CENTRE)
            and 1 / SIGMA <= in_sigmas <= SIGMA)


@point(f"targets on simulated seabeds: {100 * FOUND:.0f} % of plates of 24 pixels and 60 degrees are found in clear "
       f"water, no label is false, centres are right to {CENTRE} px ({HAZY_CENTRE} px in haze), stated standard "
       f"deviations within a factor of {SIGMA}")
def target_detection(work):
    lines, good = [HEAD], True
    for haze, seeds in ((0, FRESH_SEEDS), (HAZE, FRESH_HAZY_SEEDS)):
        for preset in PRESETS:
            for family in FAMILIES:
                for seed in seeds:
                    measured = measure(BIN, work, preset, family, seed, haze)
                    lines.append(row_of(preset, family, seed, haze, measured))
                    good = good and is_good(haze, measured)
    return "\n".join(lines), good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=BIN)
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    parser.add_argument("--seeds", type=int, nargs="+", default=[31])
    parser.add_argument("--presets", nargs="+", default=PRESETS)
    parser.add_argument("--families", nargs="+", default=FAMILIES)
    parser.add_argument("--haze", type=float, default=0)
    given = parser.parse_args()
    print(HEAD)
    for preset in given.presets:
        for family in given.families:
            for seed in given.seeds:
                measured = measure(given.bin, given.base, preset, family, seed, given.haze)
                print(row_of(preset, family, seed, given.haze, measured),
                      "" if is_good(given.haze, measured) else "missed", flush=True)


if __name__ == "__main__":
    main()
