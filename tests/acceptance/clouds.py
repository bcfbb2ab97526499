# SPDX-License-Identifier: GPL-3.0-or-later
"""The point on the quality of clouds of the two synthetic scenes."""

from axial_pipeline import truth as pipeline_truth
from axial_pipeline.colmap_model import colmap_model
from points import BASE, densified, millimetres, point_of_each_scene, truth_of
from support import runs
from support.runs import PROGRAMS


def poses(data, name):
    """The folder of COLMAP's poses of a run in air, aligned to the truth in metres. A run does not
    depend on this source and is never repeated."""
    work = BASE / "colmap" / name
    colmap_model(data / "air", work, pipeline_truth.true_lens(data))
    return pipeline_truth.align_to_truth(PROGRAMS, work, data)


def both_media(work, scene, number):
    """The clouds in air and in water on the poses of one COLMAP run."""
    truth, results = truth_of(scene), []
    for medium in ("air", "water"):
        folder = work / f"{scene}-colmap{number}-{medium}"
        densified(folder, poses(truth.data, f"{scene}-air-{number}"), truth.data / medium,
                  truth.housing(medium), "--resolution-level", 0)
        results.append(runs.evaluate(folder, truth, medium))
    return results


@point_of_each_scene("3 COLMAP runs, median: refractive mean at most 1.1 x in air, F no lower than -0.02")
def colmap_poses(work, scene):
    pairs = sorted((both_media(work, scene, number) for number in (1, 2, 3)),
                   key=lambda pair: pair[1]["mean"] / pair[0]["mean"])
    air, water = pairs[1]
    ratios = ", ".join(f"{w['mean'] / a['mean']:.3f}" for a, w in pairs)
    seen = f"ratios {ratios}; median run: air {millimetres(air)}; refractive {millimetres(water)}"
    return seen, water["mean"] <= 1.1 * air["mean"] and water["f"] >= air["f"] - 0.02
