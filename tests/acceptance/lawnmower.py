# SPDX-License-Identifier: GPL-3.0-or-later
"""Surveys of 100 photographs in rows, as divers swim them, from raw photographs to the cloud."""

import math

import dive_runs
from dive_runs import as_measured, cpu_seconds
from points import BASE, point
from support import runs
from support.colmap_text import centres
from support.runs import PROGRAMS, measured

SEEDS, VIEWS = (61, 62, 63), 100
HEIGHT = 2000    # the largest error of a height: the length of the survey divided by this
CPU_MINUTES = 60  # to the cloud
SIZE = ("--medium", "water", "--truth", 0, "--width", 640, "--height", 480, "--coarseness", 2, "--samples", 2,
        "--port-distance", 0.05, "--relief", 0.2)


def height_errors(data, out):
    """The errors of the heights of the camera centres after the best similarity [m], and the length of the
    survey [m]."""
    measured(out / "align.log", *PROGRAMS.align(out / "refined" / "sparse", data / "sparse", out / "aligned"))
    truth, found = centres(data / "sparse"), centres(out / "aligned")
    length = max(math.dist(a, b) for a in truth.values() for b in truth.values())
    return [found[name][2] - truth[name][2] for name in found], length


def measure(seed):
    """What was found, and whether it is good enough."""
    name = f"{seed}-{VIEWS}"
    data = runs.simulated(f"lawnmower-{name}", BASE, "--preset", "survey", "--seed", seed, "--views", VIEWS,
                          *SIZE).data
    folder = BASE / "lawnmower" / name
    brought, begin = as_measured(data, folder), cpu_seconds()
    outcome = dive_runs.run(brought, data, folder / "out", "cloud")
    minutes = (cpu_seconds() - begin) / 60
    if outcome.code != 0:
        return f"seed {seed}: exit code {outcome.code}", False
    errors, length = height_errors(data, folder / "out")
    worst = max(map(abs, errors))
    good = outcome.registered == outcome.photographs and worst <= length / HEIGHT and minutes <= CPU_MINUTES
    return (f"seed {seed}: {outcome.registered} of {outcome.photographs} photographs, heights of cameras within "
            f"{1e3 * worst:.2f} mm over {length:.1f} m (1/{length / worst:.0f}), sparse points "
            f"{outcome.median:.2f} mm, {minutes:.1f} CPU minutes", good)


@point(f"three surveys of {VIEWS} photographs in rows, 640 pixels wide, one known length: all photographs have poses, "
       f"heights of cameras within 1/{HEIGHT} of the length, at most {CPU_MINUTES} CPU minutes to the cloud")
def lawnmower(work):
    results = [measure(seed) for seed in SEEDS]
    return "; ".join(text for text, _ in results), all(good for _, good in results)
