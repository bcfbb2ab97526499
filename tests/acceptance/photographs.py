# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on the real photographs of the fountain."""

import re

from axial_pipeline.colmap import registered
from axial_pipeline.colmap_model import Calibration, colmap_model
from points import BASE, densified, point
from support import colmap_text, runs
from support.runs import BIN, measured


def fountain(part):
    return runs.shared("fountain-P11", part)


# View selection pairs no two views beyond this angle. There the check is reported but not judged.
WIDEST_ANGLE = 65  # [degrees]


def photo_check(work, cloud, a, b):
    """Of the points of `cloud` that the images a and b see: the fraction that looks the same in
    both, the number, and the median angle [degrees] between the two rays."""
    log = cloud / f"check-{a}-{b}.log"
    measured(log, BIN / "held_out_check", work / "fountain" / "scene.mvs",
             cloud / "scene_dense.ply", a, b, 2)
    numbers = re.search(r"seen (\d+) agree \d+ fraction ([\d.]+) angle (\d+)", log.read_text())
    return float(numbers[2]), int(numbers[1]), int(numbers[3])


def held_out_pair(work, a, b):
    folder = work / f"fountain-without-{a[:4]}-{b[:4]}"
    model = work / f"model-without-{a[:4]}-{b[:4]}"
    colmap_text.copy(fountain("sparse"), model, without=(a, b))
    densified(folder, model, fountain("images"), None, "--resolution-level", 2)
    share, count, angle = photo_check(work, folder, a, b)
    with_all, _, _ = photo_check(work, work / "fountain", a, b)
    seen = (f"{a[:4]} and {b[:4]}, {angle} degrees apart: {share:.1%} of {count:,} "
            f"(cloud of all images: {with_all:.1%})")
    return seen, share if angle <= WIDEST_ANGLE else None


@point("at least 90 % of the points that two held-out images see have ZNCC above 0.6 in them")
def fountain_held_out(work):
    densified(work / "fountain", fountain("sparse"), fountain("images"), None,
              "--resolution-level", 2)
    pairs = (("0004.jpg", "0005.jpg"), ("0003.jpg", "0007.jpg"), ("0002.jpg", "0008.jpg"))
    results = [held_out_pair(work, a, b) for a, b in pairs]
    judged = [share for _, share in results if share is not None]
    return "; ".join(seen for seen, _ in results), len(judged) >= 2 and min(judged) >= 0.9


@point("11 of 11 images registered by a COLMAP run of one's own")
def fountain_colmap(work):
    k = [float(x) for x in fountain("K.txt").read_text().split()]
    model = BASE / "colmap" / "fountain"
    lens = Calibration("PINHOLE", f"{k[0]},{k[4]},{k[2] + 0.5},{k[5] + 0.5}", refine=False)
    colmap_model(fountain("images"), model, lens)
    count = registered(model / "model")
    return f"{count} of 11", count == 11
