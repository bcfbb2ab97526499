# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on features that stand still in all photographs, such as those of a strobe arm."""

import math

from axial_pipeline import colmap, masks, still_features
from axial_pipeline import truth as pipeline_truth
from axial_pipeline.colmap_model import colmap_model
from points import BASE, point, truth_of
from support import runs
from support.colmap_text import centres
from support.runs import BIN, PROGRAMS, measured

MASKED = 3.0  # largest error of a camera centre with the mask that was offered, at most [mm]
ORDINARY = ("outcrop", "sand", "transect", "thicket", "survey")


def with_arm(work, data):
    """The photographs of a scene with an arm drawn over each, and their true model."""
    images, truth = work / "images", work / "truth"
    for photograph in sorted((data / "water").iterdir()):
        target = images / f"{photograph.stem}.png"
        if not target.exists():
            images.mkdir(parents=True, exist_ok=True)
            measured(images.parent / "overlay.log", BIN / "dive_photograph", "arm", 0, photograph, target)
    truth.mkdir(parents=True, exist_ok=True)
    for name in ("cameras.txt", "points3D.txt", "images.txt"):
        (truth / name).write_text((data / "sparse" / name).read_text().replace(".jpg", ".png"))
    return images, truth


def errors(work, truth):
    """The errors of the camera centres [mm], sorted, and the number of photographs without a pose."""
    measured(work / "align.log", *PROGRAMS.align(work / "model", truth, work / "aligned"))
    found, wanted = centres(work / "aligned"), centres(truth)
    return (sorted(1e3 * math.dist(centre, wanted[name]) for name, centre in found.items()),
            len(wanted) - len(found))


@point(f"an arm in every photograph of a ring of 0.45 m: it is noticed before matching, and with the mask that "
       f"is offered all camera centres are within {MASKED} mm")
def strobe_arm(work):
    data = runs.simulated("closeup-arm", BASE, "--preset", "closeup", "--medium", "water", "--truth", 0, "--width",
                          640, "--height", 480, "--coarseness", 2, "--samples", 2).data
    work = work / "strobe-arm"
    images, truth = with_arm(work, data)
    lens, plain, masked = pipeline_truth.self_calibrated_lens(data), work / "plain", work / "masked"
    colmap_model(images, plain, lens)
    lines = still_features.lines_about(plain)
    mask = plain / still_features.MASK
    if not mask.exists():
        return "the arm was not noticed", False
    colmap_model(images, masked, lens,
                 mask_command=PROGRAMS.colmap_masks(images, mask, masked / masks.FOLDER, 0))
    without, lost = errors(plain, truth)
    with_mask, lost_masked = errors(masked, truth)
    return (f"without masks median {without[len(without) // 2]:.3g} mm, largest {without[-1]:.3g} mm, {lost} "
            f"photographs lost; with the mask {with_mask[len(with_mask) // 2]:.3g} mm, largest "
            f"{with_mask[-1]:.3g} mm; {'; '.join(lines[1:-1])}",
            with_mask[-1] <= MASKED and lost_masked == 0)


def databases(work):
    """The name of each ordinary scene, and COLMAP's features of its photographs."""
    scenes = {f"{scene}-{medium}": truth_of(scene).data / medium for scene in ("closeup", "reef")
              for medium in ("air", "water")}
    for name in ORDINARY:
        scenes[name] = runs.simulated(f"{name}-still", BASE, "--preset", name, "--medium", "water", "--truth", 0,
                                      "--width", 640, "--height", 480).data / "water"
    fountain = runs.SHARED / "fountain-P11" / "images"
    if fountain.exists():
        scenes["fountain"] = fountain
    for name, images in scenes.items():
        database = work / f"{name}.db"
        if not database.exists():
            database.parent.mkdir(parents=True, exist_ok=True)
            measured(work / f"{name}.log", *colmap.features(database, images, "OPENCV"))
        yield name, database


@point("no features at rest on any scene without an arm")
def no_features_at_rest(work):
    found = {name: still_features.find(database) for name, database in databases(work / "features-at-rest")}
    alarms = [f"{name}: {len(one[2])} features" for name, one in found.items() if one]
    return "; ".join(alarms) or f"none on {len(found)} scenes", not alarms
