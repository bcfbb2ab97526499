# SPDX-License-Identifier: GPL-3.0-or-later
"""The options --boundary and --boundary-targets: polygons, or targets at the corners of a plot, to which the maps and
the comparison with an earlier survey are cut. Cloud, mesh and textures stay whole: what stands around the plot hides
parts of it."""

import pathlib

from . import control, files
from .failure import Failure
from .option_files import find_option

LEAST = 3  # corners
# The options of MapSurface and CompareSurveys.
OF_PROGRAMS = ("--boundary", "--boundary-targets", "--target-places", "--boundary-map")


def add_options(parser):
    parser.add_argument("--boundary", default="", metavar="FILE", help="polygons (GeoJSON, GeoPackage or shape file) "
                        "to which the maps are cut, in the coordinates of the map (docs/maps.md)")
    parser.add_argument("--boundary-targets", default="", metavar="LABELS", help="in place of --boundary: labels of "
                        "three or more targets at the corners, in their order around the plot, separated by commas")


def check(given):
    """Checks the options, and makes --boundary absolute."""
    labels = given.boundary_targets
    if labels and given.boundary:
        raise Failure("--boundary-targets contradicts --boundary: give one of them")
    if labels and not given.targets:
        raise Failure(f"--boundary-targets {labels}: needs --targets")
    if labels and len([label for label in labels.split(",") if label.strip()]) < LEAST:
        raise Failure(f"--boundary-targets {labels}: must be three or more labels, separated by commas")
    if labels and not all(label.strip() for label in labels.split(",")):
        raise Failure(f"--boundary-targets {labels}: has an empty label")
    if given.boundary:
        given.boundary = files.existing("--boundary", given.boundary, is_file=True)


def check_results(given, wanted):
    """Refuses a boundary for a run without maps. `wanted`: the names of the steps."""
    for name in ("boundary", "boundary_targets"):
        value = getattr(given, name)
        if value and "map" not in wanted:
            raise Failure(f"--{name.replace('_', '-')} {value}: is for the maps, which this run does not make")


def options(given, out):
    """The options of MapSurface, each a tuple of name and value."""
    if given.boundary:
        return [("--boundary", given.boundary)]
    if not given.boundary_targets:
        return []
    return [("--boundary-targets", given.boundary_targets), ("--target-places", places_of(given, out))]


def not_given_again(options, words):
    """The words of the options, each a tuple of name and value, that the `words` of the user do not replace. A boundary
    of the user replaces one of the other kind, too."""
    again = {find_option(word, OF_PROGRAMS) for word in words}
    if "--boundary" in again:
        again |= {"--boundary-targets", "--target-places"}
    if "--boundary-targets" in again:
        again.add("--boundary")
    return [word for option in options if option[0] not in again for word in option]


def states_system(words):
    """Whether the `words` of the user name a map that states the coordinate reference system."""
    return any(find_option(word, (*OF_PROGRAMS, "--like")) in ("--boundary-map", "--like") for word in words)


def places_of(given, out):
    """The places of the targets, of RefinePoses."""
    return pathlib.Path(given.joint or out) / "refined" / control.PLACES


def options_of_comparison(given, out, places):
    """The same of CompareSurveys, where the boundary is meant in the frame of the earlier survey. `places`: of the
    targets of the earlier survey. None where the frames of the surveys may differ."""
    if given.joint:
        return options(given, out)
    return [("--boundary-targets", given.boundary_targets), ("--target-places", places)] if (
        given.boundary_targets and places.exists()) else []


def files_of(given, out):
    """The files that a step with a boundary reads and no step before it makes."""
    places = [places_of(given, out)] if given.boundary_targets and given.joint else []
    return [given.boundary] if given.boundary else places
