# SPDX-License-Identifier: GPL-3.0-or-later
"""Surface where the cameras saw nothing: the meshes of three scenes with overhangs and handles, with
and without this surface."""

import json
import statistics
import subprocess

from meshes import judged
from points import BASE, meshed, point
from support import runs
from support.runs import BIN, PROGRAMS, measured

SEEDS = (42, 43, 44)  # the rule of mesh/unseen.h was tuned on seed 41
# Small images and a coarse truth, so that the point takes about ten minutes of processor time.
SIMULATED = ("--preset", "amphora", "--width", 640, "--height", 480, "--samples", 2,
             "--coarseness", 2, "--truth", 0)
UNSEEN, LESS_RECALL, ROUNDING = 0.02, 0.005, 0.0005


def made(work, seed, medium):
    """The folder of a scene's meshes: refined.ply, and closed-refined.ply with marks."""
    truth = runs.simulated(f"amphora-{seed}", BASE, *SIMULATED, "--seed", seed)
    folder = work / f"amphora-{seed}-{medium}-unseen"
    refractive, scene, mesh = meshed(folder, truth, medium, 0)
    closed = folder / "closed-mesh.ply"
    if not closed.exists():
        measured(folder / "closed-mesh.log",
                 *PROGRAMS.reconstruct_mesh(scene, closed, *refractive, "--close-unseen", 1))
    for unrefined, refined in ((mesh, folder / "refined.ply"), (closed, folder / "closed-refined.ply")):
        if not refined.exists():
            measured(refined.with_suffix(".log"),
                     *PROGRAMS.refine_mesh(scene, unrefined, refined, *refractive))
    return folder, truth


def against_itself(mesh, truth, medium):
    """The shares of the mesh that no camera and one camera sees past the mesh itself."""
    housing = truth.housing(medium)
    command = [BIN / "unseen_check", mesh, truth.data / "sparse", *([housing] if housing else [])]
    text = subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True)
    return json.loads(text.stdout)


def result(work, seed, medium):
    """For both meshes: scores at the places that two views see, the shares of the area at places that
    no view and one view sees, and the share that no view sees past the mesh ("hidden")."""
    folder, truth = made(work, seed, medium)
    found = {}
    for name in ("refined", "closed-refined"):
        report = judged(folder, name, truth, medium)
        score = report["seen"]["scores"][0]
        found[name] = {"no_view": report["unseen"]["no_view"], "recall": score["recall"],
                       "few": report["unseen"]["few_views"], "f": score["f_score"],
                       "hidden": against_itself(folder / f"{name}.ply", truth, medium)["no_view"]}
    return found


@point("surface of the preset amphora where no camera sees the truth, and surface that no camera "
       f"sees past the mesh: at most {UNSEEN:.0%} each of the refined mesh, medians of three seeds; "
       f"recall of places that two views see at most {100 * LESS_RECALL} points below that with "
       f"--close-unseen, F no lower up to {ROUNDING}")
def unseen_surface(work):
    seen, good = [], True
    for medium in ("air", "water"):
        results = [result(work, seed, medium) for seed in SEEDS]
        value = {(name, key): statistics.median(r[name][key] for r in results)
                 for name in results[0] for key in results[0][name]}
        lost = statistics.median(r["closed-refined"]["recall"] - r["refined"]["recall"]
                                 for r in results)
        texts = [f"{name}: no view {value[name, 'no_view']:.2%}, one view {value[name, 'few']:.2%}, "
                 f"hidden {value[name, 'hidden']:.2%}, recall {value[name, 'recall']:.4f}, "
                 f"F {value[name, 'f']:.4f}" for name in ("closed-refined", "refined")]
        seen.append(f"{medium}: {'; '.join(texts)}; recall lost {lost:.4f}")
        good &= (value["refined", "no_view"] <= UNSEEN and value["refined", "hidden"] <= UNSEEN
                 and lost <= LESS_RECALL
                 and value["refined", "f"] >= value["closed-refined", "f"] - ROUNDING)
    return "; ".join(seen), good
