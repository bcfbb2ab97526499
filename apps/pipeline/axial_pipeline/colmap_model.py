# SPDX-License-Identifier: GPL-3.0-or-later
"""Poses and sparse points from photographs of one camera, by COLMAP."""

import argparse
import dataclasses
import pathlib

from . import colmap, files
from .failure import Failure, run_main
from .running import logged


@dataclasses.dataclass(frozen=True)
class Calibration:
    """The camera that all photographs share."""
    model: str  # of COLMAP
    parameters: str  # "fx,fy,cx,cy,..."
    refine: bool  # whether COLMAP refines the parameters; otherwise they are fixed


def colmap_model(images, work, calibration, threads=None):
    """Writes the model with the most images to `work`/model, and COLMAP's output to
    `work`/features.log, matches.log and mapper.log. Does nothing if `work`/model exists, because
    COLMAP gives a different model in each run. `threads`: of COLMAP, -1 for one on each core."""
    model, models, database = work / "model", work / "models", work / "database.db"
    if colmap.is_model(model):
        print(f"  (kept from an earlier run: {model})", flush=True)
        return
    colmap.check_installed()
    for path in (model, models, *colmap.database_files(database)):
        files.clear(path)  # COLMAP would add to the results of a killed run
    models.mkdir(parents=True)
    print("  features", flush=True)
    logged(colmap.features(database, images, calibration.model, calibration.parameters, threads),
           work / "features.log")
    print("  matches of all pairs", flush=True)
    logged(colmap.matches(database, "exhaustive", threads), work / "matches.log")
    print("  poses", flush=True)
    logged(colmap.mapper(database, images, models, calibration.refine, threads),
           work / "mapper.log", excuse=colmap.NO_MODEL)
    best, count = colmap.largest(models, work / "mapper.log")
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
    parser.add_argument("--refine", action="store_true",
                        help="COLMAP refines focal lengths and distortion (default: they are fixed)")
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path,
                        help="folder of the model, COLMAP's database and logs")
    parser.add_argument("--max-threads", type=int, default=0,
                        help="threads of COLMAP (default: 0, one on each core)")
    return parser.parse_args()


def run(given):
    if not given.images.is_dir():
        raise Failure(f"--images {given.images}: is not a folder")
    if given.max_threads < 0:
        raise Failure(f"--max-threads {given.max_threads}: must not be negative")
    calibration = Calibration(given.camera_model, given.camera_parameters, given.refine)
    colmap_model(given.images, given.output, calibration, threads=given.max_threads or -1)


def main():
    run_main("colmap-model", lambda: run(options()), "stopped")
