# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files of an output folder earlier runs of `reconstruct` made. A run replaces and removes no
other files.

The record of a step (steps.Records) is written before the step begins, and names what the step makes.
Records of older versions name nothing: their steps made what the same steps make now."""

import fnmatch
import os
import re

from . import files
from .failure import Failure

TEXTURED = (".glb", ".ply", ".obj", ".mtl", ".gltf", ".bin", "[0-9].png", "[0-9][0-9].png",
            "[0-9][0-9][0-9].png", "_material_[0-9]_map_Kd.png", "_material_[0-9][0-9]_map_Kd.png",
            "_material_[0-9][0-9][0-9]_map_Kd.png", "_gltf[0-9].png", "_gltf[0-9][0-9].png",
            "_gltf[0-9][0-9][0-9].png")
TILE = ".tile[0-9]*-[0-9]*"
MAPS = ("dem.tif", "ortho.tif", "views.tif", "sigma.tif", "hillshade.tif", "contours.geojson", "jpg")
CHANGES = ("difference.tif", "sigma.tif", "significant.tif", "json", "jpg")

# What each step may write or remove in the output folder, with any options, in the order of the
# steps. A name that is a folder stands for everything in the folder. Steps that remove files name each
# kind of file, because users put their own beside them, such as scene_map.qgz of QGIS.
WRITES = {
    "frames": ["frames", "frames.json"],
    "masks": ["colmap_masks"],
    "features": ["features.db", "features.db-*", "still_features.json", "still_features.png",
                 "weak_features.*", "cameras"],
    "lens": ["start_lens.txt"],
    "matches": ["database.db", "database.db-*", "database.db.tmp", "overview.db", "overview.db-*",
                "overview.db.tmp", "overview_pairs.txt", "overview_pairs.txt.tmp", "match_pairs.txt",
                "match_pairs.txt.tmp"],
    "poses": ["colmap"],
    "refine": ["refined"],
    "import": ["scene.mvs", "scene.housing.json", "scene.lenses.json", "scene.geo.json", "undistorted"],
    "densify": ["scene_dense.*", "depth[0-9]*.*", "depth_inputs.json", "depth_maps.lock",
                "steps/plan.json"],
    "mesh": ["scene_dense_mesh.*"],
    "refine-mesh": ["scene_dense_refined.*"],
    "texture": [f"scene_textured{tile}{end}" for tile in ("", TILE) for end in TEXTURED],
    "map": [f"scene_map.{kind}" for kind in MAPS],
    "compare": [f"{name}.{kind}" for name in ("scene.change", "scene_change")  # the last: of older versions
                for kind in CHANGES],
    "page": ["page", "run.json", "run.json.tmp"],
    "evaluate": ["evaluation.json"]}
ORDER = list(WRITES)
JOBS = re.compile(r"(plan|depth)(?:-|$)|(\w+)-tile-")  # records of the jobs of --cluster
REPORT, REPORT_BEGINS = "report.md", b"# Reconstruction\n"
MOST_NAMED = 10


def step_of(name):
    """The step of which a record of this name tells a part or the whole."""
    job = JOBS.match(name)
    return name if not job else "densify" if job[1] else job[2]


def own_files(name):
    """The log and the records of a step or job."""
    return [f"logs/{name}.log", f"steps/{name}.begun.json*", f"steps/{name}.done.json*"]


def is_record(record):
    """Whether a JSON object is a record of any version."""
    return isinstance(record.get("chain"), (str, list))


def made_by(name, record):
    """What an earlier run made in the step or job `name`, which has this record."""
    makes = record.get("makes", WRITES.get(step_of(name), []))
    texts = [text for text in makes if isinstance(text, str)] if isinstance(makes, list) else []
    return [*texts, *own_files(name)]


def owned(out):
    """What earlier runs in the folder `out` made, as patterns. Nothing if `out` has no record. A damaged
    record counts if another record shows that the folder is that of a run."""
    found = {}
    for path in (out / "steps").glob("*.json"):
        name, _, state = path.name.removesuffix(".json").rpartition(".")
        if state in ("begun", "done"):
            record = files.read_object(path)
            found.setdefault(name, {})
            if is_record(record):
                found[name] = {**record, **found[name]}
    if not any(map(is_record, found.values())):
        return []
    return ["steps/options.json*", "steps/plan.json*",
            *(pattern for name, record in found.items() for pattern in made_by(name, record))]


def has_content(path):
    """Whether something would be lost without the file or folder `path`."""
    if path.is_dir() and not path.is_symlink():
        with os.scandir(path) as entries:
            return any(entries)
    return os.path.lexists(path)


def existing(out, pattern):
    """The names below `out` that match, and the folder of `pattern` if it cannot be entered."""
    folder, _, name = pattern.rpartition("/")
    try:
        names = os.listdir(out / folder)
    except OSError:
        return [folder] if folder and os.path.lexists(out / folder) else []
    matching = [f"{folder}/{one}" if folder else one for one in fnmatch.filter(names, name)]
    return [one for one in matching if has_content(out / one)]


def is_report(path):
    try:
        with open(path, "rb") as file:
            return file.read(len(REPORT_BEGINS)) == REPORT_BEGINS
    except OSError:
        return False


def other_files(out):
    """Names that every run writes, if `out` has files of these names that no run made."""
    lock = out / "lock"
    is_own_lock = lock.is_file() and not lock.is_symlink() and lock.stat().st_size == 0
    return [*(["lock"] if os.path.lexists(lock) and not is_own_lock else []),
            *([REPORT] if os.path.lexists(out / REPORT) and not is_report(out / REPORT) else [])]


def in_words(names):
    shown = ", ".join(names[:MOST_NAMED])
    more = len(names) - MOST_NAMED
    return f"{shown} and {more} more" if more > 0 else shown


# What --cluster writes besides. With depth maps and tiles, the names hold any numbers.
OF_CLUSTER = ["steps/options.json*", *(file for name in ("plan", "depth-*", "densify-tile-*", "mesh-tile-*")
                                       for file in own_files(name))]


def check(out, steps, is_cluster=False):
    """Fails, and names the files, if the `steps` of this run, given by name, would write or remove files
    in the folder `out` that no record of an earlier run names."""
    if os.path.lexists(out) and not out.is_dir():
        raise Failure(f"--output {out}: is not a folder")
    known = owned(out)
    written = [pattern for name in steps for pattern in (*WRITES[name], *own_files(name))]
    written += OF_CLUSTER if is_cluster else []
    foreign = {name for pattern in written for name in existing(out, pattern)
               if not any(fnmatch.fnmatchcase(name, one) for one in known)}
    refuse(out, sorted(foreign | set(other_files(out))))


def left_over(out, steps):
    """The files in the folder `out` that earlier runs made in steps that are not among `steps`, and that
    no longer belong to the results of the other steps."""
    records = out / "steps"
    stale = [name for name in ORDER if name not in steps and not (records / f"{name}.done.json").exists()
             and (records / f"{name}.begun.json").exists()]
    return [one for name in stale for pattern in WRITES[name] for one in existing(out, pattern)]


def refuse(out, names):
    """Fails if there are `names`, which are files of somebody else in the folder `out`."""
    if names:
        raise Failure(f"--output {out}: {in_words(names)}: no record of an earlier run names "
                      f"{'this file' if len(names) == 1 else 'these files'}, which this run would "
                      f"replace; move {'it' if len(names) == 1 else 'them'}, or give another --output")
