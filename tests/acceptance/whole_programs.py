# SPDX-License-Identifier: GPL-3.0-or-later
"""Points on whole programs: wrong input, killed runs, the demo, and the way from raw photographs to
a cloud."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time

import refined
from points import BASE, POINTS, densified, millimetres, point, truth_of
from support import runs
from support.runs import BIN, ROOT, measured


@point("one clear line, exit 1, no crash, no partial output")
def wrong_input(work):
    return program_test(work, "wrong_input_test")


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


@point("same bytes after kill -9 and for 1 and 2 threads; finished maps not recomputed")
def kill_and_threads(work):
    return program_test(work, "end_to_end_test")


def program_test(work, name):
    os.environ["AXIAL_BIN"] = str(BIN)
    log = work / f"{name}.log"
    try:
        measured(log, sys.executable, "-B", ROOT / "tests" / "apps" / f"{name}.py")
    except RuntimeError as error:
        return str(error), False
    return re.search(r"Ran \d+ tests", log.read_text())[0] + ", all pass", True


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


# From raw photographs to the cloud in one command.

def pipeline(truth, out):
    """The command line of apps/pipeline/reconstruct for the photographs under water. Of the poses,
    it gets only the true camera centres."""
    positions = out.with_name(f"{out.name}-positions.txt")
    poses = refined.images_of(truth.data / "sparse")
    positions.parent.mkdir(parents=True, exist_ok=True)
    positions.write_text("".join(" ".join([name, *map(str, refined.centre(pose))]) + "\n"
                                 for name, pose in sorted(poses.items())))
    return [sys.executable, ROOT / "apps/pipeline/reconstruct", "--images", truth.data / "water",
            "--lens", truth.data / "sparse" / "cameras.txt", "--housing", truth.housing("water"),
            "--scale-from", f"positions:{positions}", "--truth", truth.mesh, "--programs", BIN,
            "-o", out]


def killed_in_densify(log, out, command):
    """Kills the script, without its children, when about half of the reef's ten views have a depth
    map. Returns the seconds until then."""
    begin = time.monotonic()
    with open(log, "w") as said:
        process = subprocess.Popen(command, stdout=said, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL)
    while process.poll() is None and len(list(out.glob("depth*.dmap"))) < 5:
        time.sleep(0.1)
    process.kill()
    if process.wait() != -signal.SIGKILL:
        raise RuntimeError(f"reconstruct ended before it could be killed, see {log}")
    return time.monotonic() - begin


@point("raw photographs to the cloud in one command, killed while it matches and run again: goes on "
       f"there to exit 0, mean at most {refined.LIKE_TRUE_POSES} times that on true poses")
def pipeline_reef(work):
    truth, log = truth_of("reef"), work / "pipeline-reef.log"
    out, on_truth = work / "pipeline-reef", work / "reef-defaults-water"
    shutil.rmtree(out, ignore_errors=True)
    command = pipeline(truth, out)
    seconds = killed_in_densify(log, out, command) + measured(log, *command)["wall"]
    kept = log.read_text().count("done before")
    densified(on_truth, truth.data / "sparse", truth.data / "water", truth.housing("water"))
    ours, true = (runs.evaluate(folder, truth, "water") for folder in (out, on_truth))
    own = json.loads((out / "evaluation.json").read_text())["accuracy"]
    ratio = ours["mean"] / true["mean"]
    return (f"{seconds / 60:.1f} minutes, {kept} of 7 steps done before the kill; {millimetres(ours)}; "
            f"moved onto the truth by ICP: mean {own['mean'] * 1e3:.3f} mm, median "
            f"{own['median'] * 1e3:.3f} mm; true poses: {millimetres(true)}; ratio {ratio:.3f}",
            kept == 5 and ratio <= refined.LIKE_TRUE_POSES)
