# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the quality of clouds of the two synthetic scenes."""

from points import cloud, millimetres, point, poses, truth_of
from support import runs

GSD = {"closeup": 0.00125, "reef": 0.00459}  # [m], median depth / f


def both_media(work, scene, model, name):
    housing = truth_of(scene).housing("water")
    air = cloud(work, scene, "air", model, f"{name}-air")
    water = cloud(work, scene, "water", model, f"{name}-water", housing=housing)
    return air, water


def shared_poses(work, scene):
    pairs = [both_media(work, scene, poses(scene, "air", i), f"colmap{i}") for i in (1, 2, 3)]
    pairs.sort(key=lambda pair: pair[1]["mean"] / pair[0]["mean"])
    air, water = pairs[1]
    ratios = ", ".join(f"{w['mean'] / a['mean']:.3f}" for a, w in pairs)
    seen = f"ratios {ratios}; median run: air {millimetres(air)}; refractive {millimetres(water)}"
    return seen, water["mean"] <= 1.1 * air["mean"] and water["f"] >= air["f"] - 0.02


SHARED_WANTED = "3 COLMAP runs, median: refractive mean at most 1.1 x in air, F no lower than -0.02"


@point(SHARED_WANTED)
def closeup_colmap_poses(work):
    return shared_poses(work, "closeup")


@point(SHARED_WANTED)
def reef_colmap_poses(work):
    return shared_poses(work, "reef")


def true_poses(work, scene):
    air, water = both_media(work, scene, truth_of(scene).data / "sparse", "true")
    return f"air {millimetres(air)}; refractive {millimetres(water)}", None


@point("report both, on true poses")
def closeup_true_poses(work):
    return true_poses(work, "closeup")


@point("report both, on true poses")
def reef_true_poses(work):
    return true_poses(work, "reef")


def self_calibrated(work, scene):
    result = cloud(work, scene, "water", poses(scene, "water", 1), "selfcalibrated")
    moved = runs.evaluate(work / f"{scene}-selfcalibrated", truth_of(scene), "water", "icp")
    return f"{millimetres(result)}; moved onto the truth by ICP: {millimetres(moved)}", None


@point("report (OpenMVS: 2.4 mm mean, in air 0.65)")
def closeup_self_calibrated(work):
    return self_calibrated(work, "closeup")


@point("report (OpenMVS: 2.0 mm mean, in air 2.1)")
def reef_self_calibrated(work):
    return self_calibrated(work, "reef")


def in_gsd(work, scene):
    air = cloud(work, scene, "air", truth_of(scene).data / "sparse", "true-air")
    gsd = GSD[scene]
    return (f"mean {air['mean'] / gsd:.2f} GSD, median {air['median'] / gsd:.2f} GSD, "
            f"F {air['f']:.3f}, {air['points']:,} points"), None


@point("report beside OpenMVS: mean 0.52, median 0.36, F 0.715, 1.31 million points")
def closeup_gsd(work):
    return in_gsd(work, "closeup")


@point("report beside OpenMVS: mean 0.45, median 0.37, F 0.776, 1.07 million points")
def reef_gsd(work):
    return in_gsd(work, "reef")
