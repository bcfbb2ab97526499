# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated dives: what a diver brings up, `reconstruct` up to the poses, and the errors of its result.

A dive is a folder of photographs with the true model. What the diver states about lens and housing may
differ from the truth. The errors are those of the refined sparse points, placed by the true camera centres
only. Centres on a line do not determine the turn about this line: it comes from the true view directions."""

import dataclasses
import itertools
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
from support.colmap_text import baseline, centres, images_of  # noqa: E402
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


def points_of(model):
    """The places of the points of a COLMAP text model."""
    with open(model / "points3D.txt") as lines:
        return [tuple(map(float, line.split()[1:4])) for line in lines if not line.startswith("#")]


def write_points(points, file):
    """Writes points as a PLY file."""
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    file.write_text(f"ply\nformat ascii 1.0\nelement vertex {len(points)}\n{axes}end_header\n"
                    + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points))


def line_of(places):
    """A point and the direction of the line on which places lie: between the two that are farthest apart. None if
    they are not on a line: their distances from it are above 1/100 of its length (root mean square)."""
    first, last = max(itertools.combinations(places, 2), key=lambda pair: math.dist(*pair))
    length = math.dist(first, last)
    along = tuple((b - a) / length for a, b in zip(first, last))
    off = sum(math.dist(place, first)**2 - sum(a * (p - f) for a, p, f in zip(along, place, first))**2
              for place in places) / len(places)
    return None if off > (length / 100)**2 else (first, along)


def turn_about(along, aligned, truth):
    """The mean angle [rad] by which the photographs of an aligned model are turned about a direction."""
    angles, true_poses = [], images_of(truth)
    for name, pose in images_of(aligned).items():
        # The product of the inverse of the aligned rotation and the true one, as quaternions.
        w, x, y, z = map(float, pose[:4])
        a, b, c, d = map(float, true_poses[name][:4])
        real = w * a + x * b + y * c + z * d
        vector = (w * b - x * a - y * d + z * c, w * c + x * d - y * a - z * b, w * d - x * c + y * b - z * a)
        angles.append(2 * math.atan2(sum(u * v for u, v in zip(along, vector)), real))
    return sum(math.remainder(angle, 2 * math.pi) for angle in angles) / len(angles)


def turned(point, origin, along, angle):
    """A point after a turn about a line (Rodrigues' formula)."""
    v = [p - o for p, o in zip(point, origin)]
    cross = (along[1] * v[2] - along[2] * v[1], along[2] * v[0] - along[0] * v[2], along[0] * v[1] - along[1] * v[0])
    dot = sum(a * b for a, b in zip(along, v)) * (1 - math.cos(angle))
    return tuple(o + a * math.cos(angle) + c * math.sin(angle) + u * dot
                 for o, a, c, u in zip(origin, v, cross, along))


def place(model, data, out):
    """Writes the points of a model, placed by the true camera centres. Returns their file and the scale of the
    model."""
    aligned, log = out / "aligned", out / "align.log"
    measured(log, *PROGRAMS.align(model, data / "sparse", aligned))
    points = points_of(aligned)
    if line := line_of(list(centres(data / "sparse").values())):
        angle = turn_about(line[1], aligned, data / "sparse")
        points = [turned(point, *line, -angle) for point in points]
    write_points(points, out / "points.ply")
    return out / "points.ply", 1 / float(re.search(r"scale ([\d.eE+-]+)", log.read_text())[1])


def measure(outcome, data, out):
    """Adds the errors of the result in the folder `out`."""
    model, file = out / "refined" / "sparse", out / "errors.json"
    outcome.report = json.loads((out / "refined" / "report.json").read_text())
    outcome.registered = sum(image["observations"] > 0 for image in outcome.report["images"])
    if outcome.registered < 3:
        return
    points, outcome.scale = place(model, data, out)
    measured(out / "errors.log", *PROGRAMS.evaluate(
        points, data / "mesh.ply", "--cameras", data / "sparse", "--housing", data / "housing.json", "--framed-only",
        "--json", file))
    outcome.median = 1e3 * json.loads(file.read_text())["accuracy"]["median"]
