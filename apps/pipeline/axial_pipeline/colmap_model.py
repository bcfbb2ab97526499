# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses and sparse points from photographs of one camera, by COLMAP."""

import argparse
import dataclasses
import json
import os
import pathlib
import sys

from . import colmap, files, masks, ownership, photographs, still_features
from .failure import Failure, run_main
from .programs import Programs, default_folder
from .running import logged

RECORD = "colmap-model.json"  # what a run makes, below the output folder
WRITES = ["model", "models", masks.FOLDER, "database.db", "database.db-*", "masks.log", "features.log",
          "matches.log", "mapper.log", still_features.FOUND, still_features.MASK]


@dataclasses.dataclass(frozen=True)
class Calibration:
    """The camera that all photographs share."""
    model: str  # of COLMAP
    parameters: str  # "fx,fy,cx,cy,..."
    refine: bool  # whether COLMAP refines the parameters; otherwise they are fixed


def words_of(mask_command):
    return [str(word) for word in mask_command or []]


def is_made(work, mask_command):
    """Whether an earlier run made `work`/model. Fails if that run had other masks."""
    model = work / "model"
    if not colmap.is_model(model):
        return False
    if files.read_object(work / RECORD).get("masks", []) != words_of(mask_command):
        raise Failure(f"{model}: was made with other masks, or without masks; remove it, or give another "
                      "--output")
    return True


def claim(work, mask_command):
    """Fails if `work` has files that a run would replace and no earlier run made. Otherwise writes the
    record of this run."""
    makes = files.read_object(work / RECORD).get("makes")
    makes = makes if isinstance(makes, list) else []
    ownership.refuse(work, sorted(
        {name for pattern in WRITES if pattern not in makes for name in ownership.existing(work, pattern)}
        | ({RECORD} if os.path.lexists(work / RECORD) and not makes else set())))
    work.mkdir(parents=True, exist_ok=True)
    files.write(work / RECORD, json.dumps({"makes": WRITES, "masks": words_of(mask_command)}))


def colmap_model(images, work, calibration, threads=None, mask_command=None):
    """Writes the model with the most images to `work`/model, and COLMAP's output to
    `work`/features.log, matches.log and mapper.log. Does nothing if `work`/model exists, because
    COLMAP gives a different model in each run. Fails if this model has other masks, and if `work` has
    files of others with the names of its results. `threads`: of COLMAP, -1 for one on each core.
    `mask_command`: writes COLMAP's masks into `work`/colmap_masks (masks.py)."""
    model, models, database = work / "model", work / "models", work / "database.db"
    if is_made(work, mask_command):
        print(f"  (kept from an earlier run: {model})", flush=True)
        return
    colmap.check_installed()
    claim(work, mask_command)
    for path in (model, models, work / masks.FOLDER, *colmap.database_files(database)):
        files.clear(path)  # COLMAP would add to the results of a killed run
    models.mkdir(parents=True)
    if mask_command:
        print("  masks", flush=True)
        logged(mask_command, work / "masks.log")
    print("  features", flush=True)
    logged(colmap.features(database, images, calibration.model, calibration.parameters, threads,
                           work / masks.FOLDER if mask_command else None), work / "features.log")
    still_features.look(database, work, work / "features.log", is_masked=bool(mask_command))
    print("  matches of all pairs", flush=True)
    logged(colmap.matches(database, "exhaustive", threads), work / "matches.log")
    print("  poses", flush=True)
    logged(colmap.mapper(database, images, models, calibration.refine, threads),
           work / "mapper.log", excuse=colmap.NO_MODEL)
    found = colmap.best_first([models])
    if not found:
        raise colmap.no_poses(work / "mapper.log")
    best, count = found[0]
    best.rename(model)
    print(f"  {count} images registered", flush=True)


def options():
    parser = argparse.ArgumentParser(
        description="Computes poses and sparse points from photographs of one camera with COLMAP: "
        "OUTPUT/model. A model of an earlier run is kept.")
    parser.add_argument("--images", required=True, type=pathlib.Path,
                        help="folder of the photographs")
    parser.add_argument("--camera-model", required=True, help="of COLMAP: PINHOLE, OPENCV, ...")
    parser.add_argument("--camera-parameters", required=True,
                        help="of the camera model, in COLMAP's order, separated by commas")
    masks.add_options(parser)
    parser.add_argument("--programs", default=os.environ.get("AXIAL_BIN", str(default_folder(
                            pathlib.Path(sys.argv[0]).resolve().parent))),
                        help="folder of the programs, for --masks (default: %(default)s)")
    parser.add_argument("--refine", action="store_true",
                        help="COLMAP refines focal lengths and distortion (default: they are fixed)")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path,
                        help="folder of the model, COLMAP's database and logs")
    parser.add_argument("--max-threads", type=int, default=0,
                        help="threads of COLMAP (default: 0, one on each core)")
    return parser.parse_args()


def run(given):
    for name, value in vars(given).items():
        photographs.require_utf8(f"--{name.replace('_', '-')}", value)
    if given.max_threads < 0:
        raise Failure(f"--max-threads {given.max_threads}: must not be negative")
    photographs.check(given.images)
    masks.check(given)
    mask_command = None
    if given.masks:
        mask_command = masks.command(Programs(given.programs), given, given.output / masks.FOLDER)
    calibration = Calibration(given.camera_model, given.camera_parameters, given.refine)
    colmap_model(given.images, given.output, calibration, given.max_threads or -1, mask_command)


def main():
    run_main("colmap-model", lambda: run(options()), "stopped")
