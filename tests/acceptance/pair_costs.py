# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pairs of a survey cost: --matcher cascade beside --matcher exhaustive, up to COLMAP's poses."""

import argparse
import shutil

from axial_pipeline import colmap, reconstruct_steps
from axial_pipeline.steps import run_all
from dive_runs import SMALL, as_measured, cpu_seconds
from points import BASE, point
from support import runs
from support.runs import BIN

VIEWS, SEED = 60, 71
SHARE = 1 / 3  # of the CPU time of all pairs, at most


def options(brought, matcher):
    """The options of `reconstruct` that the steps up to COLMAP's poses read."""
    lens = str(brought.lens)
    return argparse.Namespace(
        images=str(brought.images), lens=lens, lenses=[lens], housing=str(brought.housing), matcher=matcher,
        cameras=[], doubled={}, programs=str(BIN), keep_all=False, scale_from="", masks="", vocabulary="",
        lens_model="", features="", matches="", poses="")


def matched(brought, matcher, out):
    """CPU time of the matches [s], and the names of the photographs with a pose."""
    shutil.rmtree(out, ignore_errors=True)
    todo = list(reconstruct_steps.colmap_steps(options(brought, matcher), out))
    number = [step.name for step in todo].index("matches")
    run_all(todo[:number], out)
    begin = cpu_seconds()
    run_all(todo[:number + 1], out)
    seconds = cpu_seconds() - begin
    run_all(todo, out)
    return seconds, set(colmap.images_in(out / "colmap" / "best"))


@point(f"a survey of {VIEWS} photographs in rows, 480 pixels wide: --matcher cascade takes at most a third of the CPU "
       "time of all pairs, and the same photographs have poses")
def cascade(work):
    data = runs.simulated(f"cascade-{SEED}", BASE, "--preset", "survey", "--seed", SEED, "--views", VIEWS, *SMALL).data
    brought = as_measured(data, work / "cascade")
    all_seconds, all_names = matched(brought, "exhaustive", work / "cascade" / "exhaustive")
    seconds, names = matched(brought, "cascade", work / "cascade" / "cascade")
    return (f"{seconds:.0f} CPU s for {all_seconds:.0f} ({seconds / all_seconds:.2f}), {len(names)} photographs with "
            f"poses for {len(all_names)}", seconds <= SHARE * all_seconds and names >= all_names)
