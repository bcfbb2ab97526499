# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the acceptance points and the benchmarks: running the project's programs on scenes, and
measuring cost and quality."""

import dataclasses
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "apps" / "pipeline"))
from axial_pipeline import truth as pipeline_truth  # noqa: E402
from axial_pipeline.programs import Programs  # noqa: E402
from support import colmap_text  # noqa: E402

BIN = ROOT / "build" / "release" / "bin"
PROGRAMS = Programs(BIN)
SHARED = ROOT.parent / "shared" / "data"


class Skipped(Exception):
    """The data is not on this machine."""


def shared(*parts):
    path = SHARED.joinpath(*parts)
    if not path.exists():
        raise Skipped(f"no {path}")
    return path


def measured(log, *command):
    """Runs a command with its output in `log`. Returns wall and CPU seconds and peak memory
    [bytes]. The peak is at least the memory of this process, because the kernel counts the child
    from the fork on. RuntimeError if the command fails."""
    log.parent.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    with open(log, "w") as out:
        process = subprocess.Popen([str(c) for c in command], stdout=out, stderr=subprocess.STDOUT,
                                   stdin=subprocess.DEVNULL, cwd=ROOT)
        _, status, usage = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status) != 0:
        raise RuntimeError(f"{pathlib.Path(command[0]).name} failed, see {log}")
    return {"wall": time.monotonic() - begin, "cpu": usage.ru_utime + usage.ru_stime,
            "memory": usage.ru_maxrss * 1024}


# Scenes with ground truth.

TOLERANCES = {"closeup": 0.002, "reef": 0.005}  # of F-scores [m]

@dataclasses.dataclass(frozen=True)
class Truth:
    name: str
    data: pathlib.Path  # holds sparse, housing.json, and images in air and water
    mesh: pathlib.Path
    tolerance: float  # [m]

    def housing(self, medium):
        return self.data / "housing.json" if medium == "water" else None


def synthetic(name, base):
    """The scene closeup or reef of data/synthetic. Its mesh is made under `base`."""
    data = ROOT / "data" / "synthetic" / name
    if not data.is_dir():
        raise Skipped(f"no {data}")
    pipeline_truth.make_truth(PROGRAMS, name, base / "truth" / name)
    return Truth(name, data, base / "truth" / name / "mesh.ply", TOLERANCES[name])


def simulated(name, base, *options, tolerance=0.002):
    """A scene that is not in git, simulated under `base`; again only if the simulator or the
    options changed."""
    folder = base / "simulated" / name
    made_by = hashlib.sha1((BIN / "SimulateUnderwater").read_bytes()).hexdigest() + f" {options}"
    mark = folder / "made-by"
    if not mark.exists() or mark.read_text() != made_by:
        shutil.rmtree(folder, ignore_errors=True)
        measured(folder / "simulate.log", *PROGRAMS.simulate(folder, *options))
        mark.write_text(made_by)
    return Truth(name, folder, folder / "mesh.ply", tolerance)


SURVEY_VIEWS = 200


def survey(views, base):
    """The model of the first `views` of 200 views of 640 x 480, and the folder of all images. The
    images do not depend on the number of views. They are rendered once under `base`."""
    folder = base / "survey"
    if not (folder / "rendered").exists():
        shutil.rmtree(folder, ignore_errors=True)
        measured(base / "survey.log", *PROGRAMS.simulate(
            folder, "--preset", "survey", "--views", SURVEY_VIEWS, "--width", 640, "--height", 480,
            "--samples", 1, "--truth", 0, "--medium", "air"))
        (folder / "rendered").touch()
    if views == SURVEY_VIEWS:
        return folder / "sparse", folder / "air"
    colmap_text.copy(folder / "sparse", folder / f"sparse-{views}",
                     without=[f"{i:04}.jpg" for i in range(views, SURVEY_VIEWS)])
    return folder / f"sparse-{views}", folder / "air"


# Reconstruction.

# One sweep of each kind instead of two, where the number of sweeps does not matter.
ONE_SWEEP = ("--iters", 1, "--geometric-iters", 1)


def import_scene(folder, model, images, housing=None):
    """Imports a COLMAP model to `folder`/scene.mvs."""
    measured(folder / "import.log",
             *PROGRAMS.import_scene(model, images, folder / "scene.mvs", housing))


def densify(folder, *options):
    """Densifies `folder`/scene.mvs from scratch. Returns the cost, the number of points and the
    megapixels of the depth maps."""
    for pattern in ("depth*.dmap*", "scene_dense.*"):
        for path in folder.glob(pattern):
            path.unlink()
    cost = measured(folder / "densify.log", *PROGRAMS.densify("scene.mvs", folder, *options))
    return cost | {"points": points_in(folder), "megapixels": megapixels(folder)}


def points_in(folder):
    with open(folder / "scene_dense.ply", "rb") as cloud:
        header = cloud.read(2000).decode("ascii", "replace")
    return int(re.search(r"element vertex (\d+)", header)[1])


def megapixels(folder):
    """The megapixels of all depth maps in a folder, from their headers."""
    total = 0
    for path in folder.glob("depth????.dmap"):
        width, height = (int.from_bytes(path.read_bytes()[i:i + 4], "little") for i in (12, 16))
        total += width * height
    return total / 1e6


def evaluate(folder, truth, medium):
    """Compares the dense cloud of `folder` with the true mesh. Lengths are in metres."""
    housing = truth.housing(medium)
    file = folder / "cloud-evaluation.json"
    measured(folder / "evaluate.log", *PROGRAMS.evaluate(
        folder / "scene_dense.ply", truth.mesh, "--cameras", truth.data / "sparse", "--tolerance",
        truth.tolerance, "--json", file,
        *(["--housing", housing] if housing else [])))
    result = json.loads(file.read_text())
    return {"mean": result["accuracy"]["mean"], "median": result["accuracy"]["median"],
            "points": result["accuracy"]["count"], "f": result["scores"][0]["f_score"]}
