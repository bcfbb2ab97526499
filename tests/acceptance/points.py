# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the acceptance points: their list, their scenes, and runs that are kept."""

import functools
import json
import shutil

from support import runs
from support.runs import PROGRAMS, ROOT, measured

BASE = ROOT / "build" / "acceptance"

POINTS = {}  # by name: the function that measures the point, and the text of what is wanted


def point(wanted):
    def register(function):
        POINTS[function.__name__.replace("_", "-")] = (function, wanted)
        return function
    return register


def point_of_each_scene(wanted):
    """Registers the function, which gets a folder and a scene, as one point for each scene."""
    def register(function):
        for scene in ("closeup", "reef"):
            name = f"{scene}-{function.__name__.replace('_', '-')}"
            POINTS[name] = (functools.partial(function, scene=scene), wanted)
        return function
    return register


def truth_of(scene):
    return runs.synthetic(scene, BASE)


def kept(file, make):
    """The JSON value in `file`. If there is none yet, that of make(), which is kept there."""
    if not file.exists():
        value = make()
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(value))
    return json.loads(file.read_text())


def densified(folder, model, images, housing, *options):
    """Runs InterfaceCOLMAP and DensifyPointCloud. Returns the cost of DensifyPointCloud. If
    `folder` holds a cost already, nothing is run."""
    def run():
        shutil.rmtree(folder, ignore_errors=True)
        runs.import_scene(folder, model, images, housing)
        return runs.densify(folder, *(["--refractive"] if housing else []), *options)
    return kept(folder / "cost.json", run)


def meshed(folder, truth, medium, level):
    """densified() on true poses, and ReconstructMesh. Returns the options of a port, and the folder's
    scene and mesh. If `folder` holds a mesh already, nothing is run."""
    housing = truth.housing(medium)
    refractive = ["--refractive"] if housing else []
    densified(folder, truth.data / "sparse", truth.data / medium, housing, "--resolution-level", level)
    scene, mesh = folder / "scene_dense.mvs", folder / "mesh.ply"
    if not mesh.exists():
        measured(folder / "mesh.log", *PROGRAMS.reconstruct_mesh(scene, mesh, *refractive))
    return refractive, scene, mesh


def millimetres(result):
    return (f"mean {result['mean'] * 1e3:.3f} mm, median {result['median'] * 1e3:.3f} mm, "
            f"F {result['f']:.3f}, {result['points']:,} points")
