# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on whole programs: damaged input, the demo, and refined poses."""

import shutil
import sys

import refined
from points import BASE, POINTS, point
from support.runs import BIN, ROOT, measured


@point("1,000 damaged inputs of each program: exit code 0 or 1, one line that names the file or the option, "
       "no half-written output, no hang, at most 1 GiB")
def mutations(work):
    log = work / "mutations.log"
    try:
        cost = measured(log, sys.executable, "-B", ROOT / "tests/acceptance/mutations.py", "--work",
                        work / "mutations", "--bin", BIN)
    except RuntimeError as error:
        return f"{log.read_text().strip().splitlines()[-1]}: {error}", False
    return f"{log.read_text().strip().splitlines()[-1]} ({cost['wall'] / 60:.1f} minutes)", True


@point("the demo, at most 20 minutes (here with packages and build already there)")
def demo(work):
    shutil.rmtree(ROOT / "build" / "demo", ignore_errors=True)
    cost = measured(work / "demo.log", "bash", ROOT / "apps/pipeline/demo.sh")
    table = (work / "demo.log").read_text().strip().splitlines()[-3:]
    return f"{cost['wall'] / 60:.1f} minutes: " + "; ".join(" ".join(t.split()) for t in table), \
        cost["wall"] <= 1200


# Poses from raw photographs: one point for the poses of each scene, and one for its cloud.

for scene in refined.SCENES:
    POINTS[f"refined-{scene}"] = (
        lambda work, scene=scene: refined.poses(scene, BASE, work / f"refined-{scene}"),
        refined.WANTED)
    POINTS[f"refined-cloud-{scene}"] = (
        lambda work, scene=scene: refined.cloud(scene, BASE, work / f"refined-{scene}"),
        refined.WANTED_CLOUD)
