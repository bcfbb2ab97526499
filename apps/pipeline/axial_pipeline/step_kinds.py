# SPDX-License-Identifier: GPL-3.0-or-later
"""What is known of every step of `reconstruct` before it runs."""

import dataclasses
import re

TEXTURED = (".glb", ".ply", ".obj", ".mtl", ".gltf", ".bin", "[0-9].png", "[0-9][0-9].png",
            "[0-9][0-9][0-9].png", "_material_[0-9]_map_Kd.png", "_material_[0-9][0-9]_map_Kd.png",
            "_material_[0-9][0-9][0-9]_map_Kd.png", "_gltf[0-9].png", "_gltf[0-9][0-9].png",
            "_gltf[0-9][0-9][0-9].png")
TILE = ".tile[0-9]*-[0-9]*"
MAPS = ("dem.tif", "ortho.tif", "views.tif", "sigma.tif", "hillshade.tif", "contours.geojson", "contours.gpkg",
        "contours.dxf", "jpg", "dem_[0-9]*.tif", "ortho_[0-9]*.tif", "taglab.dem*.tif", "taglab.ortho*.tif",
        "archive.*.tif", "archive.*.tfw", "archive.xml", "profiles.csv", "profiles.gpkg", "profiles.dxf")
CHANGES = ("difference.tif", "sigma.tif", "significant.tif", "json", "jpg")


@dataclasses.dataclass(frozen=True)
class Kind:
    """A step. Users put files of their own beside those of a step, such as scene_map.qgz of QGIS. So the patterns of
    a step that removes files name each kind of file."""
    writes: list  # patterns of what it may write or remove in the output folder; a folder stands for all in it
    # What its job asks for at first: megabytes, megabytes an image, minutes, minutes an image. Its inputs do not exist
    # yet when the job is planned, so its program cannot be asked.
    needs: tuple
    program: str = ""  # gets the words of an option
    option: str = ""   # the name of this option, if it is not that of the step
    result: str = ""   # the first result of --until for which the step runs; it always runs if there is none
    can_be_left_out: bool = False  # by --without
    takes_masks: bool = False  # whether the program takes the masks of --masks
    has_limits: bool = False  # whether the program keeps to a number of threads and a memory
    parts: tuple = ()  # patterns of the names of the jobs of which --cluster makes the step


# In the order of the steps.
KINDS = {
    "frames": Kind(["frames", "frames.json"], (4000, 0, 60, 0.1), "ExtractFrames"),
    "masks": Kind(["colmap_masks"], (2000, 0, 30, 0.05)),
    "features": Kind(["features.db", "features.db-*", "still_features.json", "still_features.png", "weak_features.*",
                      "cameras"], (8000, 0, 30, 0.1), "COLMAP's feature_extractor"),
    "lens": Kind(["start_lens.txt"], (2000, 0, 30, 0)),
    "matches": Kind(["database.db", "database.db-*", "database.db.tmp", "overview.db", "overview.db-*",
                     "overview.db.tmp", "overview_pairs.txt", "overview_pairs.txt.tmp", "match_pairs.txt",
                     "match_pairs.txt.tmp"], (8000, 2, 60, 1), "COLMAP's matcher"),
    "poses": Kind(["colmap"], (4000, 4, 60, 1), "COLMAP's mapper"),
    "targets": Kind(["targets.json"], (4000, 0, 30, 0.02), "FindTargets", option="find-targets", has_limits=True),
    "refine": Kind(["refined"], (2000, 4, 60, 0.2), "RefinePoses", option="refine-poses"),
    "import": Kind(["scene.mvs", "scene.housing.json", "scene.lenses.json", "scene.geo.json", "undistorted"],
                   (2000, 2, 30, 0.02)),
    # The plan of DensifyPointCloud replaces these needs.
    "densify": Kind(["scene_dense.*", "depth[0-9]*.*", "depth_inputs.json", "depth_maps.lock", "steps/plan.json"],
                    (4000, 0, 60, 0.2), "DensifyPointCloud", result="cloud", takes_masks=True, has_limits=True,
                    parts=("plan", "depth-*", "densify-tile-*")),
    "mesh": Kind(["scene_dense_mesh.*"], (8000, 4, 60, 0.5), "ReconstructMesh", result="mesh", has_limits=True,
                 parts=("mesh-tile-*",)),
    "refine-mesh": Kind(["scene_dense_refined.*"], (8000, 4, 60, 1), "RefineMesh", result="mesh", can_be_left_out=True,
                        takes_masks=True, has_limits=True),
    "colors": Kind(["restored", "exposures.csv"], (8000, 4, 60, 0.2), "RestoreColors", result="texture", takes_masks=True,
                   has_limits=True),
    "restored-cloud": Kind(["scene_restored.*"], (4000, 0, 60, 0.2), result="texture", has_limits=True),
    "restored-mesh": Kind(["scene_restored_mesh.*"], (8000, 4, 60, 0.5), result="texture", has_limits=True),
    "restored-refine-mesh": Kind(["scene_restored_refined.*"], (8000, 4, 60, 1), result="texture", has_limits=True),
    "texture": Kind([f"scene_textured{tile}{end}" for tile in ("", TILE) for end in TEXTURED], (8000, 4, 60, 0.5),
                    "TextureMesh", result="texture", can_be_left_out=True, takes_masks=True, has_limits=True),
    "compare": Kind([f"{name}.{kind}" for name in ("scene.change", "scene_change")  # the last: of older versions
                     for kind in CHANGES], (8000, 4, 30, 0.1), "CompareSurveys", result="mesh",
                    has_limits=True),
    "map": Kind([f"scene_map.{kind}" for kind in MAPS], (8000, 4, 60, 0.5), "MapSurface", result="map",
                can_be_left_out=True, has_limits=True),  # gets the masks of "texture"
    "raw-map": Kind([f"scene_map_raw.{kind}" for kind in MAPS], (8000, 4, 60, 0.5), result="map", has_limits=True),
    "page": Kind(["page", "run.json", "run.json.tmp"], (8000, 1, 30, 0.05), "ViewScene", result="page",
                 can_be_left_out=True),
    "evaluate": Kind(["evaluation.json"], (8000, 0, 60, 0)),
    # The last step with a command, so that a run that is done makes nothing again if --las is added.
    "las": Kind(["scene_dense.las", "scene_restored.las"], (500, 0, 30, 0.02), result="cloud"),
    # After all commands, as report.md (survey_report.py).
    "report": Kind(["report.html", "report.html.tmp", "report.pdf", "report.pdf.tmp"], (500, 0, 30, 0),
                   can_be_left_out=True)}
ORDER = list(KINDS)
NEEDS_OF_PLAN = (2000, 2, 30, 0.02)  # as needs, of the job "plan"
# Steps of --restore-colors, and those of them that only --match-restored has.
OF_RESTORING = ("colors", "restored-cloud", "restored-mesh", "restored-refine-mesh", "raw-map")
OF_REMATCHING = ("restored-mesh", "restored-refine-mesh")
# The options whose words are options for a program, and this program.
OPTIONS = {kind.option or name: kind.program for name, kind in KINDS.items() if kind.program}
RESULTS = ("poses", *dict.fromkeys(kind.result for kind in KINDS.values() if kind.result))  # of --until
JOBS = re.compile(r"(plan|depth)(?:-|$)|(\w+)-tile-")  # names of the jobs of --cluster


def step_of(name):
    """The step of which a step or job of this name makes a part or the whole."""
    job = JOBS.match(name)
    return name if not job else "densify" if job[1] else job[2]


def writes_of(name):
    """The patterns of what a step or job of this name may write or remove; none if there is no such step."""
    return KINDS[step_of(name)].writes if step_of(name) in KINDS else []
