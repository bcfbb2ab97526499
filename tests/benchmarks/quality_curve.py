#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""F-score against CPU time for each option of matching, with one option changed at a time.

    quality_curve.py [--scene SCENE] [--medium air|water] [--only OPTION...] -o DIR

Writes DIR/table.json, DIR/table.md and DIR/curve.png. Needs matplotlib. Poses are true. A setting that the same
binaries ran in DIR before is not run again. Scenes: `closeup` and `reef`; `closeup-hazy` and
`reef-hazy`, the same in haze that leaves a seventh of the contrast, in air and in water; `small`,
six views like `closeup` at 480 x 360, for experiments.
"""

import argparse
import hashlib
import json
import pathlib
import sys

import matplotlib.figure

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from benchmarks.end_to_end import markdown  # noqa: E402
from support import runs  # noqa: E402

# For each option the default and the other values. The default level is 0, because the default of
# --min-resolution forbids halving images of the synthetic scenes.
OPTIONS = {
    "iters": (2, (1, 3, 4)),
    "sub-resolution-levels": (1, (0, 2, 3)),
    "geometric-iters": (2, (0, 1, 3)),
    "number-views": (0, (2, 3, 5, 8)),
    "resolution-level": (0, (1,)),
}


SCENES = ("closeup", "reef", "closeup-hazy", "reef-hazy", "small")


def scene(name, base):
    if name == "small":
        return runs.simulated("small", base, "--preset", "closeup", "--views", 6, "--width", 480,
                              "--height", 360, "--samples", 2, tolerance=0.004)
    preset, *hazy = name.split("-")
    if not hazy:
        return runs.synthetic(name, base)
    return runs.simulated(name, base, "--preset", name, "--truth", 0,
                          tolerance=runs.TOLERANCES[preset])


def arguments_of(option, value):
    allow = ["--min-resolution", 16] if option == "resolution-level" else []
    return [f"--{option}", value, *allow]


def content_of_programs():
    """A short hash of all binaries that make images and clouds and evaluate them."""
    content = hashlib.sha1()
    for program in ("SimulateUnderwater", "InterfaceCOLMAP", "DensifyPointCloud",
                    "EvaluateReconstruction"):
        content.update((runs.BIN / program).read_bytes())
    return content.hexdigest()[:12]


def measured(work, truth, medium, name, arguments):
    """Cost and quality of one setting. A kept result is not measured again."""
    folder = work / content_of_programs() / f"{truth.name}-{medium}-{name}"
    kept = folder / "result.json"
    if kept.exists():
        return json.loads(kept.read_text())
    runs.import_scene(folder, truth.data / "sparse", truth.data / medium, truth.housing(medium))
    refractive = ["--refractive"] if medium == "water" else []
    cost = runs.densify(folder, *refractive, *arguments)
    quality = runs.evaluate(folder, truth, medium)
    result = {"setting": name, **cost, **quality}
    kept.write_text(json.dumps(result))
    print(f"  {name}: {result['cpu']:.1f} CPU-s, F {result['f']:.4f}", file=sys.stderr, flush=True)
    return result


def all_settings(work, truth, medium, options):
    """Returns {option: {value: result}} and the result of the defaults."""
    default = measured(work, truth, medium, "default", [])
    curves = {}
    for option in options:
        initial, others = OPTIONS[option]
        curves[option] = {value: default if value == initial else
                          measured(work, truth, medium, f"{option}-{value}",
                                   arguments_of(option, value))
                          for value in sorted((initial, *others))}
    return curves, default


def table(curves, default):
    head = ("setting", "CPU-s", "of the default", "F", "mean mm", "median mm", "points", "peak MiB")
    def row(name, r):
        return (name, f"{r['cpu']:.1f}", f"{r['cpu'] / default['cpu']:.2f}", f"{r['f']:.4f}",
                f"{r['mean'] * 1e3:.4f}", f"{r['median'] * 1e3:.4f}", f"{r['points']:,}",
                f"{r['memory'] / 2**20:.0f}")
    rows = [row("default", default)]
    rows += [row(f"--{option} {value}", result) for option, curve in curves.items()
             for value, result in curve.items() if result is not default]
    return markdown(head, rows) + "\n"


def figure(curves, default, title):
    """A curve for each option, with the values of the option beside its points."""
    drawing = matplotlib.figure.Figure(figsize=(8, 5), layout="constrained")
    panel = drawing.subplots()
    for option, curve in curves.items():
        line, = panel.plot([r["cpu"] for r in curve.values()], [r["f"] for r in curve.values()],
                           marker=".", label=f"--{option}")
        for value, r in curve.items():
            if r is not default:
                panel.annotate(value, (r["cpu"], r["f"]), (4, 4), textcoords="offset points", color=line.get_color())
    panel.plot(default["cpu"], default["f"], "ko", fillstyle="none", markersize=9, label="default")
    panel.set(title=title, xlabel="CPU time [s]", ylabel="F-score", xscale="log")
    panel.grid(True, which="both", color="#e3e3e3")
    panel.legend()
    return drawing


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", choices=SCENES, default="closeup")
    parser.add_argument("--medium", choices=("air", "water"), default="water")
    parser.add_argument("--only", nargs="+", choices=OPTIONS, default=list(OPTIONS))
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    output = arguments.output.resolve()
    truth = scene(arguments.scene, output)
    curves, default = all_settings(output, truth, arguments.medium, arguments.only)
    (output / "table.json").write_text(json.dumps(curves, indent=1))
    (output / "table.md").write_text(table(curves, default))
    title = f"{arguments.scene}, {arguments.medium}: one option changed at a time"
    figure(curves, default, title).savefig(output / "curve.png", dpi=80)
    print(table(curves, default))


if __name__ == "__main__":
    main()
