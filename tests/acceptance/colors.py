# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs in simulated waters, restored by RestoreColors with true poses and the true surface, against the
surface's true colours (color_check).

    python3 tests/acceptance/colors.py [--seeds 21] [--width 1024] [--base DIR]

One line for each scene, water and light, with the numbers of the photographs as they are and restored: the median
CIEDE2000 and angle after white is known, the slope of log(light / true light) by distance as a share of the
photographs', the differences of brightness by the place in the image, and the differences of a point between
photographs, as a share of the photographs'."""

import argparse
import json
import pathlib
import subprocess
import sys

sys.path[:0] = map(str, pathlib.Path(__file__).resolve().parents[:2])
from points import BASE, kept, point  # noqa: E402
from support import runs  # noqa: E402
from support.runs import BIN, measured  # noqa: E402

FRESH_SEEDS = (151, 152)  # not used while building
PRESETS, LIGHTS = ("reef", "closeup"), ("sun", "lamp")
WATERS = {"clear ocean": "IB", "green coast": "3C", "turbid harbour": "7C"}
DELTA_E, ANGLE, SLOPE, POSITION, SPREAD = 4, 4, 0.03, 0.03, 0.35
HEAD = ("| scene | seed | water | light | taken for | CIEDE2000 | angle | slope | by place | between photographs | |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|")


def scene_of(base, preset, seed, water, light, width):
    name = f"colors-{preset}-{seed}-{water}-{light}-{width}"
    return runs.simulated(name, base, "--preset", preset, "--seed", seed, "--views", 12, "--width", width, "--height",
                          width * 3 // 4, "--coarseness", 2, "--samples", 2, "--medium", "water", "--water", water,
                          "--light", light)


def checked(truth, photographs):
    out = subprocess.run([BIN / "color_check", truth, photographs], check=True, capture_output=True, text=True).stdout
    return json.loads(out)


def restore(scene, folder):
    """The findings of RestoreColors."""
    data = scene.data
    runs.import_scene(folder, data / "sparse", data / "water", data / "housing.json")
    measured(folder / "restore.log", BIN / "RestoreColors", "-i", folder / "scene.mvs", "-m", scene.mesh,
             "--refractive", "-o", folder / "restored")
    return json.loads((folder / "restored" / "colors.json").read_text())


def measure(base, preset, seed, water, light, width):
    """A row of the table, and whether it is good enough."""
    scene = scene_of(base, preset, seed, WATERS[water], light, width)
    folder = scene.data.parent / f"{scene.data.name}-restored"

    def run():
        return {"findings": restore(scene, folder), "raw": checked(scene.data / "water", scene.data / "water"),
                "restored": checked(scene.data / "water", folder / "restored")}
    result = kept(folder / "result.json", run)
    raw, restored, findings = result["raw"], result["restored"], result["findings"]
    slope = max(abs(after) for after in restored["slopes"]) / max(abs(before) for before in raw["slopes"])
    spread = findings["spread_after"] / findings["spread_before"]
    good = (restored["delta_e"] <= DELTA_E and restored["angle_degrees"] <= ANGLE and slope <= SLOPE
            and spread <= SPREAD and (light == "sun" or restored["position"] <= POSITION))
    row = (f"| {preset} | {seed} | {water} | {light} | {findings['light']} | {raw['delta_e']:.1f} to "
           f"{restored['delta_e']:.1f} | {raw['angle_degrees']:.1f} to {restored['angle_degrees']:.1f} | {slope:.2f} | "
           f"{100 * raw['position']:.0f} to {100 * restored['position']:.1f} % | {spread:.2f} | "
           f"{'good' if good else 'missed'} |")
    return row, good


def scenes(seeds):
    return [(preset, seed, water, light) for seed in seeds for preset in PRESETS for water in WATERS
            for light in LIGHTS]


@point(f"photographs restored in three waters, in daylight and by lamps: CIEDE2000 at most {DELTA_E}, angle at most "
       f"{ANGLE} degrees, slope by distance at most {SLOPE}, differences between photographs at most {SPREAD} of the "
       f"photographs', by lamps brightness by place within {100 * POSITION:.0f} %")
def colors(work):
    found = [measure(work, *scene, 1024) for scene in scenes(FRESH_SEEDS)]
    return "\n".join([HEAD, *(row for row, _ in found)]), all(good for _, good in found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[21])
    parser.add_argument("--width", type=int, default=1024)
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    for scene in scenes(given.seeds):
        print(measure(given.base, *scene, given.width)[0], flush=True)


if __name__ == "__main__":
    main()
