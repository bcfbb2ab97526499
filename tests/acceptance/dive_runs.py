# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated dives: what a diver brings up, `reconstruct` up to the poses, and the errors of its result.

A dive is a folder of photographs with the true model. What the diver states about lens and housing may
differ from the truth. The errors are those of the refined sparse points, placed by the true camera centres
only."""

import dataclasses
import json
import math
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import runs  # noqa: E402
from support.colmap_text import baseline  # noqa: E402
from support.runs import BIN, PROGRAMS, ROOT, measured  # noqa: E402

SMALL = ("--medium", "water", "--truth", 0, "--width", 480, "--height", 360, "--coarseness", 2, "--samples", 2)
TIME_LIMIT = 3600  # of a run [s]


def cpu_seconds():
    """CPU time of this process and of its children that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime + time.process_time()


def dive(base, preset, seed, *options, views=10):
    """The folder of a dive, simulated once."""
    words = "_".join(str(word).strip("-") for word in options)
    name = f"dive-{preset}-{seed}-{views}" + (f"-{words}" if words else "")
    return runs.simulated(name, base, "--preset", preset, "--seed", seed, "--views", views, *SMALL, *options).data


@dataclasses.dataclass
class Brought:
    """What the diver gives to `reconstruct`."""
    images: pathlib.Path
    lens: pathlib.Path
    housing: pathlib.Path | str
    scale_from: str
    options: tuple = ()


def as_measured(data, folder):
    """Photographs, lens, housing and one length as they are in truth."""
    folder.mkdir(parents=True, exist_ok=True)
    for source, name in ((data / "sparse" / "cameras.txt", "lens.txt"), (data / "housing.json", "housing.json")):
        shutil.copyfile(source, folder / name)
    return Brought(data / "water", folder / "lens.txt", folder / "housing.json", baseline(data / "sparse"))


def change_focal_length(brought, factor):
    """Multiplies the focal lengths of a PINHOLE lens."""
    lines = []
    for line in brought.lens.read_text().splitlines():
        words = line.split()
        if words[1:2] == ["PINHOLE"]:
            words[4:6] = [repr(float(word) * factor) for word in words[4:6]]
        lines.append(" ".join(words))
    brought.lens.write_text("\n".join(lines) + "\n")


def change_port(brought, **values):
    """Replaces numbers of the only port."""
    housing = json.loads(brought.housing.read_text())
    housing["ports"]["main"].update(values)
    brought.housing.write_text(json.dumps(housing))


def change_photographs(brought, folder, changes):
    """Writes all photographs into `folder`. `changes`: by image name, the words of dive_photograph."""
    folder.mkdir(parents=True, exist_ok=True)
    for photograph in sorted(brought.images.iterdir()):
        target = folder / photograph.name
        if photograph.name not in changes:
            shutil.copyfile(photograph, target)
            continue
        measured(folder.with_suffix(".log"), BIN / "dive_photograph", *changes[photograph.name], photograph,
                 target.with_suffix(".tmp.png"))
        target.with_suffix(".tmp.png").rename(target)  # programs read the content, not the extension
    brought.images = folder


@dataclasses.dataclass
class Outcome:
    """What `reconstruct` said, and how large the errors of its result are."""
    code: int
    said: str
    photographs: int
    registered: int = 0
    median: float = math.inf  # distance of sparse points from the true surface [mm]
    scale: float = math.nan   # size of the result in true sizes
    report: dict = dataclasses.field(default_factory=dict)

    @property
    def warnings(self):
        return [line for line in self.said.splitlines() if "warning" in line.lower()]


def command(brought, out, until):
    scale = ["--scale-from", brought.scale_from] if brought.scale_from else []
    return [sys.executable, "-B", str(ROOT / "apps/pipeline/reconstruct"), "--images", str(brought.images), "--lens",
            str(brought.lens), "--housing", str(brought.housing), "-o", str(out), "--until", until, "--programs",
            str(BIN), *scale, *map(str, brought.options)]


def run(brought, data, out, until="poses"):
    """Runs `reconstruct` in the new folder `out`."""
    shutil.rmtree(out, ignore_errors=True)
    ended = subprocess.run(command(brought, out, until), capture_output=True, text=True, stdin=subprocess.DEVNULL,
                           cwd=out.parent, timeout=TIME_LIMIT)
    log = out / "logs" / "refine.log"
    said = ended.stdout + ended.stderr + (log.read_text() if log.exists() else "")
    outcome = Outcome(ended.returncode, said, len(list(brought.images.rglob("*.jpg"))))
    if (out / "refined" / "report.json").exists():
        measure(outcome, data, out)
    (out.parent / f"{out.name}.json").write_text(json.dumps(dataclasses.asdict(outcome)))
    return outcome


def write_points(model, file):
    """The points of a COLMAP text model as a PLY file."""
    with open(model / "points3D.txt") as lines:
        points = [" ".join(line.split()[1:4]) for line in lines if not line.startswith("#")]
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    file.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n{axes}end_header\n"
                    + "\n".join(points) + "\n")


def measure(outcome, data, out):
    """Adds the errors of the result in the folder `out`."""
    model, points, file = out / "refined" / "sparse", out / "points.ply", out / "errors.json"
    outcome.report = json.loads((out / "refined" / "report.json").read_text())
    outcome.registered = sum(image["observations"] > 0 for image in outcome.report["images"])
    if outcome.registered < 3:
        return
    write_points(model, points)
    measured(out / "errors.log", *PROGRAMS.evaluate(
        points, data / "mesh.ply", "--align", "centres", "--estimated", model, "--cameras", data / "sparse",
        "--housing", data / "housing.json", "--framed-only", "--json", file))
    result = json.loads(file.read_text())
    outcome.median = 1e3 * result["accuracy"]["median"]
    outcome.scale = 1 / float(re.search(r": scale ([\d.eE+-]+)", (out / "errors.log").read_text())[1])
