# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the quality of clouds of the two synthetic scenes."""

from points import cloud, millimetres, point_of_each_scene, poses, truth_of
from support import runs


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


@point_of_each_scene({"closeup": "report (OpenMVS: 2.4 mm mean, in air 0.65)",
                      "reef": "report (OpenMVS: 2.0 mm mean, in air 2.1)"})
def self_calibrated(work, scene):
    result = cloud(work, scene, "water", poses(scene, "water", 1), "selfcalibrated")
    moved = runs.evaluate(work / f"{scene}-selfcalibrated", truth_of(scene), "water", "icp")
    return f"{millimetres(result)}; moved onto the truth by ICP: {millimetres(moved)}", None
