# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the maps of a run and of an earlier survey lie. Without a reference system, the comparison takes the axes of
the map of the earlier survey, and the maps of the run take those of the comparison, so that the maps of all dates lie
over each other. With --epsg, each survey has its own coordinates in this system."""

import pathlib

from .boundary import OF_PROGRAMS
from .option_files import find_option

CHANGE = "scene.change.json"
OF_PLACES = ("--up", "--epsg", "--like", "--boundary-map")


def states_place(words):
    """Whether the `words` of the user state the axes of a map."""
    return any(find_option(word, (*OF_PROGRAMS, *OF_PLACES)) in OF_PLACES for word in words)


def earlier_map(given, out):
    """The map of the survey of --earlier, without the ends of the names of its files. None without one, and for one
    that is older than the mesh: another run made it."""
    mesh = pathlib.Path(given.earlier)
    heights = mesh.parent / "scene_map.dem.tif"
    if not given.earlier or mesh.parent == pathlib.Path(out) or not (mesh.exists() and heights.exists()):
        return None
    return mesh.parent / "scene_map" if heights.stat().st_mtime >= mesh.stat().st_mtime else None


def of_comparison(given, out, words):
    """The option of CompareSurveys for its axes. `words`: those of the user for this program."""
    earlier = earlier_map(given, out)
    return ["--like", f"{earlier}.dem.tif"] if earlier and not given.epsg and not states_place(words) else []


def of_map(given, out, words):
    """The option of MapSurface for its axes, in a run with a comparison. `words`: those of the user for MapSurface."""
    return ["--like", out / CHANGE] if not given.epsg and not states_place(words) else []


def of_page(given, out, words):
    """The option of ViewScene for the map of the earlier survey, if it lies on the same plane, and the file that it
    then reads. `words`: those of the user for CompareSurveys."""
    earlier = earlier_map(given, out)
    file = earlier and earlier.with_name(f"{earlier.name}.ortho.tif")
    is_shown = file and file.exists() and (given.epsg or of_comparison(given, out, words))
    return ([("--earlier-map", earlier)], [file]) if is_shown else ([], [])
