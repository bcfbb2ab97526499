# SPDX-License-Identifier: GPL-3.0-or-later
"""Ports calibrated from drawn photographs of a checkerboard that is partly hidden in every second
one."""

import json
import shutil
import subprocess

from points import kept, point
from support.runs import BIN, measured

DRAWS, SIGMAS, KNOWN = 40, 3, 0.95
# The numbers of drawn_boards' answer in the order of CalibrateHousing's report.
NUMBERS = ("right", "down", "distance")


def draw(folder, seed):
    """The result of one draw: how many photographs hold a piece and are used, and the errors of the
    port in standard deviations."""
    folder.mkdir(parents=True, exist_ok=True)
    truth = json.loads(subprocess.run([BIN / "drawn_boards", str(seed), folder], check=True,
                                      capture_output=True, text=True).stdout)
    measured(folder / "calibrate.log", BIN / "CalibrateHousing", "-i", folder / "photos",
             "--board", "checkerboard:8x7:0.03", "--lens", folder / "lens.txt",
             "--housing", folder / "start.json", "-o", folder / "housing.json",
             "--report", folder / "report.json", "--max-distance-sigma", 0.005,
             "--max-normal-sigma", 0.5)
    report = json.loads((folder / "report.json").read_text())
    errors = [(found["value"] - truth[name]) / found["sigma"]
              for name, found in zip(NUMBERS, report["free"], strict=True)]
    found = {"hold": truth["photographs"], "used": len(report["photographs"]),
             "pieces": report["pieces"], "errors": errors, "distance_mm": report["free"][2]["sigma"]}
    shutil.rmtree(folder)
    return found


@point("drawn boards, half of them cut by the border or covered by a disc, "
       f"{DRAWS} draws: no fewer photographs used than hold a piece of 3 x 4 corners; the port within "
       f"{SIGMAS} sigma in {KNOWN:.0%} of the draws")
def pieces_of_boards(work):
    folder = work / "boards"
    draws = [kept(folder / f"{seed}.json", lambda seed=seed: draw(folder / str(seed), seed))
             for seed in range(1, DRAWS + 1)]
    fewer = sum(one["used"] < one["hold"] for one in draws)
    known = sum(max(map(abs, one["errors"])) <= SIGMAS for one in draws) / len(draws)
    total = {key: sum(one[key] for one in draws) for key in ("hold", "used", "pieces")}
    sigma = sorted(one["distance_mm"] for one in draws)[len(draws) // 2]
    return (f"{total['hold']} photographs hold a piece, {total['used']} are used, {total['pieces']} of "
            f"them as a piece; fewer in {fewer} draws; port known in {known:.1%} of the draws, "
            f"distance to +- {sigma:.2f} mm (median)", fewer == 0 and known >= KNOWN)
