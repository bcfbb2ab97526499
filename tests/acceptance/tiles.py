# SPDX-License-Identifier: GPL-3.0-or-later
"""The point on fusion by tiles, on a survey of 400 views with 0.3 megapixels each."""

import json
import subprocess

from points import BASE, point
from support import runs
from support.runs import BIN, PROGRAMS, measured

VIEWS, TILES, CAP = 400, 8, 512
STRIP = 0.01  # [m]


def survey_with_maps(work):
    """Simulates the survey and makes its depth maps. Maps that exist already are used again."""
    truth = runs.simulated(f"survey-{VIEWS}", BASE, "--preset", "survey", "--views", VIEWS,
                           "--width", 640, "--height", 480, "--samples", 1, "--truth", 0,
                           "--medium", "air")
    folder = work / f"survey-{VIEWS}"
    runs.import_scene(folder, truth.data / "sparse", truth.data / "air")
    fused(folder, "maps", "--fusion-mode", 1)
    return truth, folder


def fused(folder, name, *options):
    return measured(folder / f"{name}.log", *PROGRAMS.densify(
        "scene.mvs", folder, *runs.ONE_SWEEP, "--max-memory", CAP, *options))


def in_one_piece(folder, truth):
    cost = fused(folder, "whole")
    result = runs.evaluate(folder, truth, "air")
    (folder / "scene_dense.ply").rename(folder / "whole.ply")
    return cost, result


def in_tiles(folder, truth):
    """One run for each tile, and one that joins them. Returns the costs, the side files of the
    tiles, and the evaluation."""
    costs, sides = [], []
    for tile in range(1, TILES + 1):
        costs.append(fused(folder, f"tile{tile}", "--tile", f"{tile}/{TILES}"))
        sides.append(folder / f"tile{tile}.json")
        written = folder / f"scene_dense.tile{tile}-{TILES}.ply.json"
        sides[-1].write_text(written.read_text())
    costs.append(fused(folder, "joined", "--tiles", TILES))
    return costs, sides, runs.evaluate(folder, truth, "air")


def seams(folder, truth, sides):
    """The largest deviations, in a strip along the borders, of the cloud in tiles from the cloud in
    one piece: of the number of points, and of the mean distance to the truth."""
    said = subprocess.run([BIN / "seam_check", folder / "whole.ply", folder / "scene_dense.ply",
                           truth.mesh, str(STRIP), *sides], check=True, capture_output=True,
                          text=True).stdout
    (folder / "seams.json").write_text(said)
    strips = json.loads(said)["strips"]
    return (max(abs(tiled / whole - 1) for whole, tiled, _, _ in strips),
            max(abs(tiled / whole - 1) for _, _, whole, tiled in strips), strips)


@point(f"{VIEWS} views of 0.3 MP in {TILES} tiles with --max-memory {CAP}: at most 10 % above the "
       "cap; beside one piece: points within 0.1 %, the same three digits of the mean distance, and "
       "in each strip of 1 cm along the borders points within 0.2 % and mean distance within 0.5 %")
def fusion_tiles(work):
    truth, folder = survey_with_maps(work)
    whole_cost, whole = in_one_piece(folder, truth)
    costs, sides, tiled = in_tiles(folder, truth)
    density, distance, strips = seams(folder, truth, sides)
    peak = max(cost["memory"] for cost in costs) / 1e6
    points = tiled["points"] / whole["points"] - 1
    digits = [f"{result['mean'] * 1e3:.2e}" for result in (whole, tiled)]
    seen = (f"one piece: {whole_cost['memory'] / 1e6:.0f} MB, {whole_cost['cpu']:.0f} CPU-s, "
            f"{whole['points']:,} points, mean {whole['mean'] * 1e3:.5f} mm; tiles: {peak:.0f} MB, "
            f"{sum(cost['cpu'] for cost in costs):.0f} CPU-s, {tiled['points']:,} points "
            f"({100 * points:+.4f} %), mean {tiled['mean'] * 1e3:.5f} mm; strips along the "
            f"borders: points within {100 * density:.3f} %, mean distance within "
            f"{100 * distance:.3f} %, {strips[0][1]:,} points in the first and "
            f"{strips[-1][1]:,} in the last")
    good = peak <= 1.1 * CAP and abs(points) <= 0.001 and digits[0] == digits[1]
    return seen, good and density <= 0.002 and distance <= 0.005
