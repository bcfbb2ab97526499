# SPDX-License-Identifier: GPL-3.0-or-later
"""Plates on simulated seabeds, found by FindTargets. One line a scene: plates of at least 24 pixels and at most 60
degrees that are found, false labels, errors of the centres, and errors in stated standard deviations.

    python3 tests/acceptance/target_detection.py --bin build/release/bin --work FOLDER [--seeds 31 32] [--haze 0.6]
"""

import argparse
import json
import math
import pathlib
import subprocess


def simulate(programs, folder, preset, family, seed, haze):
    side = 0.15 if preset == "reef" else 0.04
    subprocess.run([programs / "SimulateUnderwater", "--preset", preset, "--seed", str(seed), "-o", folder, "--targets",
                    "12", "--bars", str(4 * side), "--target-side", str(side), "--target-family", family, "--medium",
                    "water", "--truth", "0", "--haze", str(haze), "-v", "0"], check=True)


def find(programs, folder, family):
    output = folder / "targets.json"
    subprocess.run([programs / "FindTargets", folder / "water", "-o", output, "--families", family, "-v", "0"],
                   check=True)
    return json.loads(output.read_text())["targets"]


def judge(truth, found):
    """Numbers of plates seen, found and falsely found, and the squared errors of a coordinate [px] and in sigmas."""
    there = {(image, plate["label"]): plate for image, plates in truth["images"]["water"].items() for plate in plates}
    counted = {key: plate for key, plate in there.items() if plate["width"] >= 24 and plate["oblique_degrees"] <= 60}
    labels = {plate["label"] for plate in truth["plates"]}
    seen, false, errors, in_sigmas = set(), 0, [], []
    for target in found:
        plate = there.get((target["image"], target["label"]))
        if plate is None:
            false += target["label"] not in labels  # a plate that is partly hidden may be found
            continue
        error = math.hypot(target["x"] - plate["x"], target["y"] - plate["y"])
        false += error > plate["width"] / 4
        if (target["image"], target["label"]) in counted:
            seen.add((target["image"], target["label"]))
        errors.append(error ** 2 / 2)
        in_sigmas.append(error ** 2 / 2 / target["sigma"] ** 2)
    return len(counted), len(seen), false, errors, in_sigmas


def root_mean(squares):
    return math.sqrt(sum(squares) / len(squares)) if squares else math.nan


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--seeds", type=int, nargs="+", default=[31])
    parser.add_argument("--presets", nargs="+", default=["reef", "closeup"])
    parser.add_argument("--families", nargs="+", default=["circular12", "APRILTAG_36h11"])
    parser.add_argument("--haze", type=float, default=0)
    given = parser.parse_args()
    print("| scene | family | seed | plates | found | false | error [px] | in sigmas |\n|---|---|---|---|---|---|---|---|")
    for preset in given.presets:
        for family in given.families:
            for seed in given.seeds:
                folder = given.work / f"{preset}-{family}-{seed}-{given.haze}"
                if not (folder / "true_targets.json").exists():
                    simulate(given.bin, folder, preset, family, seed, given.haze)
                truth = json.loads((folder / "true_targets.json").read_text())
                plates, seen, false, errors, in_sigmas = judge(truth, find(given.bin, folder, family))
                print(f"| {preset} | {family} | {seed} | {plates} | {seen} | {false} | {root_mean(errors):.3f} | "
                      f"{root_mean(in_sigmas):.2f} |", flush=True)


if __name__ == "__main__":
    main()
