# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of `reconstruct`, and the checks that are made before hours of work."""

import argparse
import fnmatch
import itertools
import os
import pathlib

from . import (boundary, cameras, cluster, colmap, control, dates, doubles, estimates, exposures, files, first_checks,
               first_look, lenses, masks, matching, photographs, poses, positions, video)
from .failure import Failure
from .option_files import find_option, has_option
from .ownership import is_record
from .programs import NAMES, Programs, default_folder, require, words_of
from .step_kinds import KINDS, OF_REMATCHING, OF_RESTORING, OPTIONS, ORDER, RESULTS
from .steps import record_file

SKIPPED = [name for name, kind in KINDS.items() if kind.can_be_left_out]
MOST_TILES, MOST_EPSG = 1000, 1 << 20  # as in the programs
OPTIONAL = ("frames", "masks", "targets", "refine-mesh", *OF_RESTORING, "las")  # steps that many runs do not have


def options(script_folder, description, words=None):
    """The options of a command line: `words`, or those of this process."""
    programs = os.environ.get("AXIAL_BIN", str(default_folder(script_folder)))
    parser = argparse.ArgumentParser(description=description)
    source = parser.add_mutually_exclusive_group()
    source.add_argument("--images", default="", help="folder of the raw underwater photographs; this option or "
                        "--video is required")
    source.add_argument("--video", action="append", default=[], dest="videos", metavar="CLIP",
                        help="in place of --images: a video, of which sharp frames with enough motion between them "
                        "become the photographs; may be given several times (docs/photographs.md)")
    parser.add_argument("--lens", required=True, action="append", dest="lenses", metavar="LENS",
                        help="the lens as calibrated in air: a COLMAP cameras.txt, or Calibmar's "
                        "calibration.yaml. Photographs of several cameras, sizes or focal lengths: several lenses in a "
                        "file, or this option several times, also as 18mm:FILE for photographs whose Exif data state "
                        "this focal length, or left/:FILE for photographs whose names begin so (docs/photographs.md)")
    parser.add_argument("--housing", required=True, help="the port (docs/formats.md), or Calibmar's "
                        "calibration.yaml; or flat, dome or unknown: usual numbers, which the photographs correct")
    parser.add_argument("-o", "--output", required=True, help="folder for all output files")
    parser.add_argument("--scale-from", default="",
                        help="known lengths or positions [m], as for RefinePoses")
    control.add_options(parser)
    dates.add_options(parser)
    boundary.add_options(parser)
    masks.add_options(parser)
    parser.add_argument("--refine", default="",
                        help="values of lens and port to estimate, as for RefinePoses (default: auto)")
    parser.add_argument("--matcher", choices=matching.MATCHERS, default="auto",
                        help="pairs of images that COLMAP matches: all, those that overlap, neighbours in time, "
                        "neighbours in space, or images that look alike; auto: all pairs of fewer than "
                        f"{matching.FROM_CASCADE} images, otherwise cascade (default: %(default)s)")
    parser.add_argument("--vocabulary", default="",
                        help="vocabulary tree for COLMAP, for --matcher vocabulary")
    parser.add_argument("--lens-model", default="", choices=("", *lenses.MODELS), metavar="MODEL",
                        help="lens model that COLMAP calibrates, so that it absorbs the refraction (default: COLMAP "
                        "keeps the lens that lens and port give; if photographs have no pose then, it calibrates "
                        "this lens)")
    parser.add_argument("--check", action="store_true", help="check all inputs, look at the photographs, print "
                        "what was found and how much time, memory and disk space the run needs, and end")
    parser.add_argument("--keep-all", action="store_true", help="use blurred, dark and doubled photographs, too")
    parser.add_argument("--restore-colors", action="store_true", help="give cloud, textures, maps and page the colours "
                        "that the photographs have without water (docs/colors.md)")
    parser.add_argument("--match-restored", action="store_true", help="with --restore-colors: match the photographs "
                        "without water again, and make the final cloud and mesh from them, for hazy water")
    parser.add_argument("--las", action="store_true", help="write the cloud as LAS 1.4, too (docs/formats.md)")
    parser.add_argument("--epsg", type=int, default=0, metavar="CODE",
                        help="EPSG code of the coordinate reference system of the scene, a projected one in metres, "
                        "which maps and LAS then state: --control is transformed to it, and --scale-from positions: "
                        "must be in it, or be longitudes and latitudes in this UTM zone of WGS 84")
    for name, program in OPTIONS.items():
        parser.add_argument(f"--{name}", default="",
                            help=f"more options for {program}, in one word" +
                            (": --refine-poses='--scale-sigma 0.1'" if name == "refine-poses" else ""))
    parser.add_argument("--tiles", type=int, default=1,
                        help="make cloud, mesh and textures in this many tiles, so that less memory is "
                        "needed; RefineMesh still works on the whole mesh; with --cluster, cloud and "
                        "mesh in as many jobs (default: %(default)s)")
    parser.add_argument("--until", choices=RESULTS, default="",
                        help="last result to make (default: page, or map if the build has no page; "
                        "with --tiles: texture, because MapSurface and ViewScene need the whole mesh)")
    parser.add_argument("--without", default="", metavar="STEPS",
                        help=f"steps to leave out, separated by commas: {', '.join(SKIPPED)}")
    parser.add_argument("--earlier", default="",
                        help="mesh of an earlier survey of the same place, or the output folder of its "
                        "reconstruction: find what changed. The positions of both surveys must agree "
                        "to some decimetres, unless both show three or more of the same coded targets "
                        "(docs/compare.md)")
    parser.add_argument("--truth", default="", help="a true mesh, in the frame that --scale-from "
                        "positions: gives: the cloud is measured against it, and the page shows "
                        "the distances")
    parser.add_argument("--cluster", choices=["slurm", "local"], default="",
                        help="run the steps as a workflow of Snakemake, with the depth maps in several "
                        "jobs: on a cluster with Slurm, or on this machine (docs/cluster.md)")
    parser.add_argument("--snakemake", default="", help="more options for snakemake with --cluster, "
                        "in one word")
    parser.add_argument("--programs", default=programs,
                        help="folder of the programs (default: %(default)s)")
    return parser.parse_args(words)


# Options of programs that contradict tiles, which `reconstruct` asks for.
NOT_WITH_TILES = {"densify": ("--tiles", "--fusion-tiles", "--tile", "--estimate-normals", "--estimate-colors"),
                  "mesh": ("--tiles", "--tile", "--decimate", "--target-face-num", "--edge-length"),
                  "texture": ("--tiles",)}


def last_result(given):
    has_page = Programs(given.programs).has_page()
    if given.until == "page" and not has_page:
        raise Failure("--until page: the page was not built (docs/view.md)")
    return given.until or ("texture" if given.tiles > 1 else "page" if has_page else "map")


def check_tiles(given):
    """Refuses options of programs that contradict --tiles. The programs would refuse them after hours."""
    for name, refused in NOT_WITH_TILES.items():
        for word in words_of(name, given):
            option = find_option(word, refused)
            always = option == "--tile" or name == "texture"
            if option and (given.tiles > 1 or always):
                raise Failure(f"--{name}: {option} contradicts --tiles {given.tiles}")


def skipped(given):
    """The steps of --without."""
    names = given.without.split(",") if given.without else []
    for name in names:
        if name not in SKIPPED:
            raise Failure(f"--without {given.without}: {name or 'an empty name'} is not one of "
                          f"{', '.join(SKIPPED)}")
    return names


def keeps_depth_maps(given):
    return not has_option(words_of("densify", given), "--remove-dmaps")


def is_of_restoring(name, given, left_out):
    """Whether the step `name` of --restore-colors runs."""
    return (given.restore_colors
            and (name != "restored-cloud" or keeps_depth_maps(given) or given.match_restored)
            and (name not in OF_REMATCHING or given.match_restored)
            and (name != "restored-refine-mesh" or "refine-mesh" not in left_out)
            and (name != "raw-map" or "map" not in left_out))


def check_restoring(given):
    if given.colors and not given.restore_colors:
        raise Failure(f"--colors {given.colors}: is only for --restore-colors")
    if given.match_restored and not given.restore_colors:
        raise Failure("--match-restored: is only for --restore-colors")
    if not given.restore_colors:
        return
    for option, refused in (("densify", ("--match-restored",)), ("mesh", ("--pointcloud-file", "-p"))):
        for word in words_of(option, given) if given.match_restored else ():
            if find_option(word, refused):
                raise Failure(f"--{option}: {word} contradicts --match-restored")
    if given.match_restored and given.cluster:
        raise Failure("--match-restored: contradicts --cluster")
    if RESULTS.index(given.until) < RESULTS.index(KINDS["colors"].result):
        raise Failure("--restore-colors: is for textures, maps and the page, which --until "
                      f"{given.until} does not make")
    if not keeps_depth_maps(given) and not given.match_restored:
        print(f"--densify {given.densify}: without depth maps, the cloud keeps the colours of the photographs",
              flush=True)


def wanted_steps(given):
    """The names of the steps after the poses that run."""
    last, left_out = RESULTS.index(given.until), skipped(given)
    return [name for name, kind in KINDS.items()
            if kind.result and RESULTS.index(kind.result) <= last and name not in left_out
            and (name != "compare" or given.earlier) and (name != "las" or given.las)
            and (name not in OF_RESTORING or is_of_restoring(name, given, left_out))]


def check_results(given):
    """Refuses options of programs that do not run."""
    left_out = skipped(given)
    for name in (name for name in KINDS if name in OPTIONS):
        value, result = getattr(given, name.replace("-", "_")), KINDS[name].result
        if value and name in left_out:
            raise Failure(f"--{name} {value}: contradicts --without {given.without}")
        if value and result and RESULTS.index(given.until) < RESULTS.index(result):
            raise Failure(f"--{name} {value}: {OPTIONS[name]} does not run with --until {given.until}")
    check_restoring(given)
    if given.las and given.until == "poses":
        raise Failure("--las: is for the cloud, which --until poses does not make")
    boundary.check_results(given, wanted_steps(given))
    if given.epsg and not given.control and not {"map", "compare", "las"} & {*wanted_steps(given)}:
        raise Failure(f"--epsg {given.epsg}: is for maps, LAS and --control, which this run does not have")
    if given.compare and not given.earlier:
        raise Failure(f"--compare {given.compare}: is only for --earlier")
    if given.earlier and given.until in ("poses", "cloud"):
        raise Failure(f"--earlier {given.earlier}: needs the mesh, which --until {given.until} does not make")
    if given.truth and given.until == "poses":
        raise Failure(f"--truth {given.truth}: is compared with the cloud, which --until poses does not make")
    if given.cluster and given.until == "poses":
        raise Failure(f"--cluster {given.cluster}: is for the steps after the poses, which --until poses does "
                      "not run")


def check_las(given):
    """Checks --las and --epsg."""
    if given.las or given.epsg:
        require(given.programs, ["TransformScene"])
    if given.epsg and not (given.control or positions.file_of(given.scale_from)):
        raise Failure(f"--epsg {given.epsg}: is for coordinates of this system, and neither --control nor "
                      "--scale-from positions: gives some")
    if not 0 <= given.epsg <= MOST_EPSG:
        raise Failure(f"--epsg {given.epsg}: must be from 0 to {MOST_EPSG}")
    if given.epsg and has_option(words_of("refine-poses", given), "--epsg"):
        raise Failure(f"--refine-poses {given.refine_poses}: contradicts --epsg {given.epsg}")


def check_mask_labels(given):
    """Refuses a label of masks for a program that gets the masks of --masks, which have labels of
    their own."""
    names = [name for name in KINDS if KINDS[name].takes_masks or name == "map"] if given.masks else []
    words = {name: words_of(name, given) for name in names}
    for name in names:
        own = words[name] + (words["texture"] if name == "map" else [])
        if has_option(words[name], "--ignore-mask-label") and not has_option(own, "--mask-path"):
            raise Failure(f"--{name} {getattr(given, name.replace('-', '_'))}: the label of --masks is "
                          "given by --ignore-mask-label of reconstruct")


# Records of versions that stated no time have only the time of the file, which a copy changes a bit.
COPIED_WITHIN = 60  # seconds


def end_of(step, out):
    """When the step of this name ended in the folder `out`, and the uncertainty [s]. None if it is
    not done."""
    path = out / record_file(step)
    record = files.read_object(path)
    if not is_record(record):
        return None
    ended = record.get("ended")
    return (ended, 0) if isinstance(ended, (int, float)) else (path.stat().st_mtime, COPIED_WITHIN)


def is_current(step, out):
    """Whether the result of the step of this name was made from the present results of the steps
    before it."""
    needed = [name for name in ORDER[:ORDER.index(step) + 1] if name not in OPTIONAL]
    ends = [end_of(name, out) for name in dict.fromkeys([*needed, step])]
    return all(ends) and all(later + doubt >= earlier for (earlier, _), (later, doubt)
                             in zip(ends, ends[1:]))


def mesh_of_earlier_survey(path):
    """`path`: a mesh, or the output folder of `reconstruct`. Of the folder, the refined mesh is used
    unless it was made from another mesh than the one that is there now."""
    if not path.is_dir():
        return path
    refined, mesh = (path / f"scene_dense_{name}.ply" for name in ("refined", "mesh"))
    rematched = {"restored-refine-mesh": path / "scene_restored_refined.ply",
                 "restored-mesh": path / "scene_restored_mesh.ply"}
    for name, restored in rematched.items():  # of --match-restored
        if restored.exists() and is_current(name, path):
            return restored
    found = next(filter(pathlib.Path.exists, (refined, mesh)), None)
    if not found:
        raise Failure(f"--earlier {path}: has neither {refined.name} nor {mesh.name}")
    if not any(is_record(files.read_object(record)) for record in (path / "steps").glob("*.json")):
        return found
    if refined.exists() and is_current("refine-mesh", path):
        return refined
    if not mesh.exists() or not is_current("mesh", path):
        raise Failure(f"--earlier {path}: its mesh is older than its cloud, or was not completed: run "
                      "that reconstruction again, or name the file of a mesh")
    if refined.exists():
        print(f"--earlier {path}: {refined.name} was made from an older mesh; {mesh.name} is used",
              flush=True)
    return mesh


def is_own_mesh(mesh, out):
    """Whether a run in the folder `out` may write or remove the file `mesh`."""
    return mesh.parent == out and any(fnmatch.fnmatchcase(mesh.name, pattern)
                                      for kind in KINDS.values() for pattern in kind.writes)


def check_lens_files(given):
    """Makes the paths in --lens absolute. `given.lens` is the first file."""
    for number, text in enumerate(given.lenses):
        one = lenses.given_as(text)
        path = files.existing("--lens", text, one.file)
        given.lenses[number] = one.with_file(path)
        given.lens = given.lens if number else path


def check_paths(given):
    """Checks the files and folders that a run reads, and makes their paths absolute, because the
    programs look up relative paths in different folders."""
    for name, value in vars(given).items():
        photographs.require_utf8(f"--{name.replace('_', '-')}", value)
    check_lens_files(given)
    for name in ("images", "housing", "truth", "earlier", "programs"):
        path = getattr(given, name)
        if path and not (name == "housing" and path in first_checks.KINDS):
            setattr(given, name, files.existing(f"--{name}", path))
    masks.check(given)
    control.check(given)
    dates.check(given)
    boundary.check(given)
    file = positions.file_of(given.scale_from)
    if file is not None:
        given.scale_from = positions.PREFIX + files.existing("--scale-from", given.scale_from, file, is_file=True)


def check_options(given):
    """Checks everything that can be known without the photographs, and makes all paths absolute. Returns lines
    about the lens behind the port."""
    check_paths(given)
    require(given.programs, NAMES)
    for name in (*OPTIONS, "snakemake"):
        words_of(name, given)
    check_mask_labels(given)
    if not 1 <= given.tiles <= MOST_TILES:
        raise Failure(f"--tiles {given.tiles}: must be from 1 to {MOST_TILES}")
    check_tiles(given)
    given.until = last_result(given)
    check_results(given)
    check_las(given)
    if given.earlier:
        given.earlier = str(mesh_of_earlier_survey(pathlib.Path(given.earlier)))
    if given.snakemake and not given.cluster:
        raise Failure(f"--snakemake {given.snakemake}: is only for --cluster")
    given.output = str(files.resolved("--output", given.output))
    video.check(given)
    if given.earlier and is_own_mesh(pathlib.Path(given.earlier), pathlib.Path(given.output)):
        raise Failure(f"--earlier {given.earlier}: this run replaces this mesh; give another --output")
    colmap.check_installed()
    first_checks.check_refine(given)
    first_checks.check_system(given)
    lens_lines = first_checks.check_lens_and_housing(given)
    first_checks.check_options_of_programs(given, {name: program for name, program in OPTIONS.items()
                                                   if name != "matches"})
    return lens_lines


def check_photographs(given, lens_lines):
    """Checks everything else that can be known before hours of work. `lens_lines`: of check_options(). Returns
    what was found, for --check: pairs of a word and a text."""
    images, file = photographs.check(given.images, one_size=False), positions.file_of(given.scale_from)
    if file is not None:
        positions.check(file, given.images, list(images))
        positions.check_system(file, list(images), given.epsg)
    given.cameras, left_out = cameras.of(given, images)
    given.lines = [*cameras.lines_about(given.cameras), *left_out]
    for line in given.lines:
        print(f"{given.images}: {line}", flush=True)
    given.lines += video.lines_about(pathlib.Path(given.output)) if given.videos else []
    given.dated = dates.assign(given, images, used(given, images))
    if given.dated:
        given.lines.append(f"dates: {dates.in_words(given.dated)}")
        print(f"{given.images}: {given.lines[-1]}", flush=True)
    given.exposures = exposures.of(given, images, used(given, images))
    for line in exposures.lines_about(given.exposures):
        print(f"{given.images}: {line}", flush=True)
        given.lines.append(line)
    given.doubled = doubled(given, images)
    given.matcher = matching.chosen(given.matcher, len(used(given, images)))
    first_checks.check_options_of_programs(given, {"matches": OPTIONS["matches"]})
    matching.check(given, images)
    if pathlib.Path(given.output).is_relative_to(given.images):
        raise Failure(f"--output {given.output}: lies in the folder of the images")
    if given.cluster:
        cluster.check(given)
    return found_in(given, images, lens_lines)


def used(given, images):
    """The names of the photographs that have a lens."""
    return [name for one in given.cameras for name in one.names] or list(images)


def doubled(given, images):
    """Finds photographs with the same bytes, as doubles.identical(), and says which are left out. None with
    --keep-all."""
    found = {} if given.keep_all else doubles.identical(given.images, used(given, images), poses.scale_names(given))
    if found:
        pairs = [f"{name} is {twin}" for name, twin in found.items()]
        print(f"{given.images}: {len(found)} photographs are copies of others, and are left out (--keep-all keeps "
              f"them): {files.few(pairs)}", flush=True)
    return found


def found_in(given, images, lens_lines):
    """Checks that need the photographs and the programs. Returns what was found, for --check. COLMAP looks at the
    photographs when its rows are read."""
    names = used(given, images)
    first_checks.check_scale(given, names)
    lens_lines = first_checks.check_cameras(given) if given.cameras else lens_lines
    sizes = [images[name].size for name in names if images[name].size]
    if not sizes:
        return []
    needs = estimates.needs_of(given, sizes)
    for line in estimates.warnings_about(needs, pathlib.Path(given.output)):
        print(f"warning: {line}", flush=True)
    found = first_checks.rows(given, images, lens_lines, needs)
    looked = {name: images[name].size for name in names if name not in given.doubled}
    return itertools.chain(found, first_look.rows(given, looked)) if given.check else []
