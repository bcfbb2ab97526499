# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the quality of clouds of the two synthetic scenes."""

from points import cloud, millimetres, point_of_each_scene, poses, truth_of
from support import runs

GSD = {"closeup": 0.00125, "reef": 0.00459}  # [m], median depth / f


def both_media(work, scene, model, name):
    housing = truth_of(scene).housing("water")
    air = cloud(work, scene, "air", model, f"{name}-air")
    water = cloud(work, scene, "water", model, f"{name}-water", housing=housing)
    return air, water


@point_of_each_scene("3 COLMAP runs, median: refractive mean at most 1.1 x in air, F no lower than -0.02")
def colmap_poses(work, scene):
    pairs = [both_media(work, scene, poses(scene, "air", i), f"colmap{i}") for i in (1, 2, 3)]
    pairs.sort(key=lambda pair: pair[1]["mean"] / pair[0]["mean"])
    air, water = pairs[1]
    ratios = ", ".join(f"{w['mean'] / a['mean']:.3f}" for a, w in pairs)
    seen = f"ratios {ratios}; median run: air {millimetres(air)}; refractive {millimetres(water)}"
    return seen, water["mean"] <= 1.1 * air["mean"] and water["f"] >= air["f"] - 0.02


@point_of_each_scene("report both, on true poses")
def true_poses(work, scene):
    air, water = both_media(work, scene, truth_of(scene).data / "sparse", "true")
    return f"air {millimetres(air)}; refractive {millimetres(water)}", None


@point_of_each_scene({"closeup": "report (OpenMVS: 2.4 mm mean, in air 0.65)",
                      "reef": "report (OpenMVS: 2.0 mm mean, in air 2.1)"})
def self_calibrated(work, scene):
    result = cloud(work, scene, "water", poses(scene, "water", 1), "selfcalibrated")
    moved = runs.evaluate(work / f"{scene}-selfcalibrated", truth_of(scene), "water", "icp")
    return f"{millimetres(result)}; moved onto the truth by ICP: {millimetres(moved)}", None


@point_of_each_scene({
    "closeup": "report beside OpenMVS: mean 0.52, median 0.36, F 0.715, 1.31 million points",
    "reef": "report beside OpenMVS: mean 0.45, median 0.37, F 0.776, 1.07 million points"})
def gsd(work, scene):
    air = cloud(work, scene, "air", truth_of(scene).data / "sparse", "true-air")
    size = GSD[scene]
    return (f"mean {air['mean'] / size:.2f} GSD, median {air['median'] / size:.2f} GSD, "
            f"F {air['f']:.3f}, {air['points']:,} points"), None
