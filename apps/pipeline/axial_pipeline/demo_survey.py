# SPDX-License-Identifier: GPL-3.0-or-later
"""The surveys of the demo: maps of the textured meshes, a comparison of the two surveys, and a page
for the browser."""

import html
import json

from . import files
from .running import shown

UP = ("--up", "0,0,1")  # in the simulated world
CHANGE = "surveys"  # begin of the names of the files of the comparison


def refractive(housing):
    return ["--refractive"] if housing else []


def make_map(demo, run, results, housing=None):
    """Makes the maps of the mesh of `run` in the folder `results`."""
    folder = demo.work / run
    shown(demo.programs.map_surface(folder / "scene_dense.mvs", folder / "textured.ply",
                                    results / f"{run}_map", *refractive(housing), *UP))


def compare(demo, before, after, results):
    """Compares the meshes of two runs, whose ground is the same. Writes the comparison to the folder
    `results`."""
    meshes = (demo.work / run / "mesh_refined.ply" for run in (before, after))
    shown(demo.programs.compare_surveys(*meshes, results / CHANGE, *UP))


def make_page(demo, run, results, housing=None):
    """Writes the page of `run`, with the maps and the comparison in the folder `results`, to a folder
    in `results`."""
    work, page = demo.work / run, results / f"{run}_page"
    files.clear(page)
    shown(demo.programs.view_scene(work / "scene_dense.mvs", work / "scene_dense.ply",
                                   work / "textured.glb", page, "--map", results / f"{run}_map",
                                   "--change", results / CHANGE, "--truth", demo.truth / "mesh.ply",
                                   *refractive(housing)))


def falsely_changed(results):
    """The share of the compared area that the comparison calls changed."""
    change = json.loads((results / f"{CHANGE}.change.json").read_text())
    return change["area_changed"] / change["area_compared"]


def section(run, results):
    """The part of the demo's page about the survey of `run`: links to its files in `results`, the
    folder of the page."""
    link = lambda name, text: f'<a href="{name}">{html.escape(text)}</a>'
    parts = [f'{link(f"{run}_map.ortho.tif", "Orthomosaic")}, {link(f"{run}_map.dem.tif", "heights")} '
             f'and {link(f"{run}_map.views.tif", "numbers of views")} are GeoTIFFs. The surveys (a) and '
             f'(b) have the same ground; CompareSurveys calls {100 * falsely_changed(results):.2f} % of '
             f'the area changed.']
    if (results / f"{run}_page").exists():
        parts.insert(0, f'{link(f"{run}_page/index.html", "The page of the survey")} shows the cloud '
                        f'and its errors, the mesh, the photographs, the depth maps, the maps and the '
                        f'changes, and measures distances, areas and volumes.')
    return f"<p>{' '.join(parts)}</p>"
