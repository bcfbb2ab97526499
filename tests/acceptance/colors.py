# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs in simulated waters, restored by RestoreColors with true poses and the true surface, against the
surface's true colours (color_check).

    python3 tests/acceptance/colors.py [--seeds 21] [--width 1024] [--base DIR]

One line for each scene, water and light, with the numbers of the photographs as they are and restored: the median
CIEDE2000 and angle after white is known, the slope of log(light / true light) by distance as a share of the
photographs', the differences of brightness by the place in the image, and the differences of a point between
photographs, as a share of the photographs'. A second table has the same numbers of methods that restore each
photograph for itself (color_baselines)."""

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
METHODS = {"raw": "the photographs as they are", "grey-world": "grey world with red compensation, one by one",
           "one-by-one": "daylight's model with true distances, one by one", "restored": "RestoreColors"}
METHODS_HEAD = ("| scene | seed | water | light | method | CIEDE2000 | angle | slope | by place | between "
                "photographs |\n|---|---|---|---|---|---|---|---|---|---|")


def scene_of(base, preset, seed, water, light, width):
    name = f"colors-{preset}-{seed}-{water}-{light}-{width}"
    return runs.simulated(name, base, "--preset", preset, "--seed", seed, "--views", 12, "--width", width, "--height",
                          width * 3 // 4, "--coarseness", 2, "--samples", 2, "--medium", "water", "--water", water,
                          "--light", light)


def checked(truth, photographs):
    out = subprocess.run([BIN / "color_check", truth, photographs], check=True, capture_output=True, text=True).stdout
    return json.loads(out)


def restore(scene, folder, *options, images=None, housing=None):
    """The findings of RestoreColors about the photographs of the scene, or others of the same names in `images`."""
    data = scene.data
    runs.import_scene(folder, data / "sparse", images or data / "water", housing or data / "housing.json")
    measured(folder / "restore.log", BIN / "RestoreColors", "-i", folder / "scene.mvs", "-m", scene.mesh,
             "--refractive", *options, "-o", folder / "restored")
    return json.loads((folder / "restored" / "colors.json").read_text())


def before_and_after(scene, folder):
    """The numbers of a scene; only those of the photographs as they are if RestoreColors refuses them."""
    truth = scene.data / "water"
    result = {"raw": checked(truth, truth)}
    try:
        findings = restore(scene, folder, "--up", "0,0,1")
    except RuntimeError:
        return result
    return result | {"findings": findings, "restored": checked(truth, folder / "restored")}


def measure(base, preset, seed, water, light, width):
    """A row of the table, and whether it is good enough."""
    scene = scene_of(base, preset, seed, WATERS[water], light, width)
    folder = scene.data.parent / f"{scene.data.name}-restored"
    result = kept(folder / "result.json", lambda: before_and_after(scene, folder))
    if "restored" not in result:
        return f"| {preset} | {seed} | {water} | {light} | refused | | | | | | missed |", False
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


def restored_alone(scene, folder, method):
    """The numbers of the photographs of the scene that color_baselines restored, each for itself."""
    out, truth = folder / method, scene.data / "water"
    measured(folder / f"{method}.log", BIN / "color_baselines", method, truth, truth, out)
    # With a type of water, RestoreColors does not refuse photographs in which no loss by distance is left.
    findings = restore(scene, folder / f"{method}-spread", "--light", "sun", "--assume", "jerlov-IB", images=out)
    return {"checked": checked(truth, out), "spread": findings["spread_before"]}


def measure_methods(base, preset, seed, water, light, width):
    """The rows of the second table, after measure()."""
    scene = scene_of(base, preset, seed, WATERS[water], light, width)
    folder = scene.data.parent / f"{scene.data.name}-restored"
    result = json.loads((folder / "result.json").read_text())
    found = {name: {"checked": result[name], "spread": result.get("findings", {}).get(f"spread_{when}")}
             for name, when in (("raw", "before"), ("restored", "after")) if name in result}
    for method in ("grey-world", "one-by-one"):
        found[method] = kept(folder / f"{method}.json", lambda method=method: restored_alone(scene, folder, method))
    slopes = {method: max(map(abs, one["checked"]["slopes"])) for method, one in found.items()}

    def row(method, words):
        colors, spread = found[method]["checked"], found[method]["spread"]
        share = f"{spread / found['raw']['spread']:.2f}" if spread and found["raw"]["spread"] else "-"
        return (f"| {preset} | {seed} | {water} | {light} | {words} | {colors['delta_e']:.1f} | "
                f"{colors['angle_degrees']:.1f} | {slopes[method] / slopes['raw']:.2f} | "
                f"{100 * colors['position']:.1f} % | {share} |")
    return [row(*method) for method in METHODS.items() if method[0] in found]


def scenes(seeds):
    return [(preset, seed, water, light) for seed in seeds for preset in PRESETS for water in WATERS
            for light in LIGHTS]


@point(f"photographs restored in three waters, in daylight and by lamps: CIEDE2000 at most {DELTA_E}, angle at most "
       f"{ANGLE} degrees, slope by distance at most {SLOPE}, differences between photographs at most {SPREAD} of the "
       f"photographs', by lamps brightness by place within {100 * POSITION:.0f} %")
def colors(work):
    found = [measure(work, *scene, 1024) for scene in scenes(FRESH_SEEDS)]
    methods = [row for scene in scenes(FRESH_SEEDS) for row in measure_methods(work, *scene, 1024)]
    return "\n".join([HEAD, *(row for row, _ in found), "", METHODS_HEAD, *methods]), all(good for _, good in found)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=int, nargs="+", default=[21])
    parser.add_argument("--width", type=int, default=1024)
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    given = parser.parse_args()
    print(HEAD)
    for scene in scenes(given.seeds):
        print(measure(given.base, *scene, given.width)[0], flush=True)
    print("\n" + METHODS_HEAD)
    for scene in scenes(given.seeds):
        print("\n".join(measure_methods(given.base, *scene, given.width)), flush=True)


if __name__ == "__main__":
    main()
