# SPDX-License-Identifier: GPL-3.0-or-later
"""A survey of 100 photographs in rows, as divers swim it, from raw photographs to the cloud.

    python3 tests/acceptance/lawnmower.py [--base DIR] [--views N] [--until poses|cloud] SEED

measures one survey and prints the result."""

import argparse
import math
import pathlib
import resource
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import dive_runs  # noqa: E402
from dive_runs import as_measured  # noqa: E402
from points import BASE, point  # noqa: E402
from refined import centre, images_of  # noqa: E402
from support import runs  # noqa: E402
from support.runs import PROGRAMS, measured  # noqa: E402

SEEDS, VIEWS = (61, 62, 63), 100
HEIGHT = 2000    # the largest error of a height: the length of the survey divided by this
CPU_MINUTES = 60  # to the cloud
SIZE = ("--medium", "water", "--truth", 0, "--width", 640, "--height", 480, "--coarseness", 2, "--samples", 2,
        "--port-distance", 0.05, "--relief", 0.2)


def cpu_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def height_errors(data, out):
    """The errors of the heights of the camera centres after the best similarity [m], and the length of the
    survey [m]."""
    measured(out / "align.log", *PROGRAMS.align(out / "refined" / "sparse", data / "sparse", out / "aligned"))
    truth = {name: centre(pose) for name, pose in images_of(data / "sparse").items()}
    found = {name: centre(pose) for name, pose in images_of(out / "aligned").items()}
    length = max(math.dist(a, b) for a in truth.values() for b in truth.values())
    return [found[name][2] - truth[name][2] for name in found], length


def measure(seed, base, views, until):
    """What was found, and whether it is good enough."""
    data = runs.simulated(f"lawnmower-{seed}-{views}", base, "--preset", "survey", "--seed", seed, "--views", views,
                          *SIZE).data
    folder = base / "lawnmower" / f"{seed}-{views}"
    brought, begin = as_measured(data, folder), cpu_seconds()
    outcome = dive_runs.run(brought, data, folder / "out", until)
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
    results = [measure(seed, BASE, VIEWS, "cloud") for seed in SEEDS]
    return "; ".join(text for text, _ in results), all(good for _, good in results)


def main():
    parser = argparse.ArgumentParser(description="Measures a survey in rows.")
    parser.add_argument("--base", type=pathlib.Path, default=BASE)
    parser.add_argument("--views", type=int, default=VIEWS)
    parser.add_argument("--until", choices=("poses", "cloud"), default="cloud")
    parser.add_argument("seed", type=int)
    given = parser.parse_args()
    print(measure(given.seed, given.base, given.views, given.until)[0])


if __name__ == "__main__":
    main()
