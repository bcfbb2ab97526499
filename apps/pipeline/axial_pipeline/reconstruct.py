# SPDX-License-Identifier: GPL-3.0-or-later
"""From photographs taken under water to a dense cloud, a textured mesh, maps and a page to look at
them, in one command:

    reconstruct --images DIR --lens cameras.txt --housing housing.json -o OUT

COLMAP computes poses with a lens that it calibrates itself. RefinePoses turns them into refractive
poses. DensifyPointCloud computes the cloud. ReconstructMesh, RefineMesh and TextureMesh turn the
cloud into a textured mesh, and MapSurface maps it. ViewScene writes a page for the browser that shows
cloud, mesh and photographs. The command of every step is printed and can be typed by hand. A killed
run that is started again with the same options continues with the step that was killed; with other
options, it continues with the first step that differs. A second run in the same folder is refused
until the first run ends. With --cluster, a workflow of Snakemake runs the same commands, and several
nodes of a cluster compute the depth maps (docs/cluster.md).
"""

import argparse
import fcntl
import json
import os
import pathlib
import shlex

from . import cluster, colmap, files, lens, matching, positions
from .failure import Failure, run_main
from .programs import Programs, default_folder
from .steps import Files, Step, Tiles, run_all


PROGRAMS = ("RefinePoses", "InterfaceCOLMAP", "DensifyPointCloud", "ReconstructMesh", "RefineMesh",
            "TextureMesh", "MapSurface", "ViewScene")
# Options whose values are options for a program, and this program.
MORE_OPTIONS = {"refine-poses": "RefinePoses", "densify": "DensifyPointCloud",
                "mesh": "ReconstructMesh", "refine-mesh": "RefineMesh", "texture": "TextureMesh",
                "map": "MapSurface", "page": "ViewScene"}
RESULTS = ("cloud", "mesh", "texture", "map", "page")
MOST_TILES = 1000  # as in the programs


def options(script_folder):
    programs = os.environ.get("AXIAL_BIN", str(default_folder(script_folder)))
    parser = argparse.ArgumentParser(description=__doc__.split(":\n\n")[0] + ".")
    parser.add_argument("--images", required=True, help="folder of the raw underwater photographs")
    parser.add_argument("--lens", required=True,
                        help="the lens as calibrated in air: a COLMAP cameras.txt, or Calibmar's "
                        "calibration.yaml")
    parser.add_argument("--housing", required=True, help="the port (docs/formats.md), or Calibmar's "
                        "calibration.yaml")
    parser.add_argument("-o", "--output", required=True, help="folder for all output files")
    parser.add_argument("--scale-from", default="",
                        help="known lengths or positions [m], as for RefinePoses")
    parser.add_argument("--refine", default="",
                        help="further unknowns, as for RefinePoses")
    parser.add_argument("--matcher", choices=matching.MATCHERS, default="exhaustive",
                        help="pairs of images that COLMAP matches: all, neighbours in time, neighbours "
                        "in space, or images that look alike (default: %(default)s)")
    parser.add_argument("--vocabulary", default="",
                        help="vocabulary tree for COLMAP, for --matcher vocabulary")
    parser.add_argument("--lens-model", default="OPENCV",
                        help="lens model that COLMAP calibrates; it absorbs the refraction "
                        "(default: %(default)s)")
    for name, program in MORE_OPTIONS.items():
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
    return parser.parse_args()


def words_of(name, given):
    """The words in the value of the option --`name`, which are options for a program."""
    value = getattr(given, name.replace("-", "_"))
    try:
        return shlex.split(value)
    except ValueError as error:
        raise Failure(f"--{name} {value}: {error}") from None


# Options of programs that contradict tiles, which `reconstruct` asks for.
NOT_WITH_TILES = {"densify": ("--fusion-tiles", "--tile", "--estimate-normals", "--estimate-colors"),
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
            option = word.split("=")[0]
            always = option == "--tile" or name == "texture"
            if option in refused and (given.tiles > 1 or always):
                raise Failure(f"--{name}: {option} contradicts --tiles {given.tiles}")


def check(given):
    """Checks everything that can be known before hours of work, and makes all paths absolute,
    because the programs look up relative paths in different folders."""
    for name in ("images", "lens", "housing", "truth", "programs"):
        path = getattr(given, name)
        if path and not pathlib.Path(path).exists():
            raise Failure(f"--{name} {path}: not found")
        if path:
            setattr(given, name, str(pathlib.Path(path).resolve()))
    file = positions.file_of(given.scale_from)
    if file is not None:
        if not pathlib.Path(file).is_file():
            raise Failure(f"--scale-from {given.scale_from}: file not found")
        given.scale_from = positions.PREFIX + str(pathlib.Path(file).resolve())
        positions.check(pathlib.Path(file), pathlib.Path(given.images))
    for program in PROGRAMS:
        if not (pathlib.Path(given.programs) / program).is_file():
            raise Failure(f"--programs {given.programs}: {program} not found; build the programs first")
    for name in (*MORE_OPTIONS, "snakemake"):
        words_of(name, given)
    if not 1 <= given.tiles <= MOST_TILES:
        raise Failure(f"--tiles {given.tiles}: must be from 1 to {MOST_TILES}")
    check_tiles(given)
    given.until = last_result(given)
    if given.snakemake and not given.cluster:
        raise Failure(f"--snakemake {given.snakemake}: is only for --cluster")
    colmap.check_installed()
    matching.check(given)
    given.output = str(pathlib.Path(given.output).resolve())
    if pathlib.Path(given.output).is_relative_to(given.images):
        raise Failure(f"--output {given.output}: lies in the folder of the images")
    if given.cluster:
        cluster.check(given)


def take_largest(models):
    """Renames the model with the most images to models/best."""
    best, count = colmap.largest(models, models.parent / "logs" / "poses.log")
    others = [str(size) for _, size in colmap.by_size(models)[1:]]
    print(f"    {count} images have poses", flush=True)
    if others:
        print(f"    COLMAP could not join all images: {len(others)} more models, of "
              f"{', '.join(others)} images, remain in {models}", flush=True)
    best.rename(models / "best")


def colmap_steps(given, out):
    features, database, models = out / "features.db", out / "database.db", out / "colmap"
    start = lens.start_under_water(given.lens, given.lens_model)
    yield Step("features", colmap.features(features, given.images, given.lens_model, start),
               makes=features, reads=[given.images], changed=colmap.database_files(features))
    yield matching.step(given, features, database)
    yield Step("poses", colmap.mapper(database, given.images, models), makes=models / "best",
               anew=[models], before=models.mkdir, after=lambda: take_largest(models))


def existing_files(words):
    return [word for word in words if pathlib.Path(word).exists()]


def refine_options(given):
    known = ["--scale-from", given.scale_from] if given.scale_from else []
    refine = ["--refine", given.refine] if given.refine else []
    return [*known, *refine, *words_of("refine-poses", given)]


def mask_words(words, given_again):
    """The options of TextureMesh for masks among `words`, which MapSurface has, too. Options that are
    among `given_again` are left out."""
    kept, again = [], {word.partition("=")[0] for word in given_again}
    for word, value in zip(words, [*words[1:], ""]):
        option, equals, _ = word.partition("=")
        if option in ("--mask-path", "--ignore-mask-label") and option not in again:
            kept += [word] if equals else [word, value]
    return kept


def tile_options(option, given):
    """The option of a program for the tiles."""
    return (option, given.tiles) if given.tiles > 1 else ()


def mesh_steps(given, out):
    programs, scene, refractive = Programs(given.programs), out / "scene_dense.mvs", ("--refractive", 1)
    mesh, refined = out / "scene_dense_mesh.ply", out / "scene_dense_refined.ply"
    textured = out / "scene_textured"
    options = {name: words_of(name, given) for name in ("mesh", "refine-mesh", "texture", "map", "page")}
    reads = {name: existing_files(words) for name, words in options.items()}
    wanted = RESULTS[:RESULTS.index(given.until) + 1]
    if "mesh" not in wanted:
        return
    yield Step("mesh", programs.reconstruct_mesh(scene, mesh, *refractive,
                                                 *tile_options("--tiles", given), *options["mesh"]),
               makes=mesh, reads=reads["mesh"])
    yield Step("refine-mesh", programs.refine_mesh(scene, mesh, refined, *refractive,
                                                   *options["refine-mesh"]),
               makes=refined, reads=reads["refine-mesh"])
    if "texture" in wanted:
        yield Step("texture", programs.texture_mesh(scene, refined, textured, "--export-type",
                                                    "glb,ply", *refractive,
                                                    *tile_options("--tiles", given),
                                                    *options["texture"]),
                   makes=Tiles(out, f"scene_textured.tile*-{given.tiles}.glb") if given.tiles > 1
                   else Files(textured.with_suffix(".glb"), textured.with_suffix(".ply")),
                   reads=reads["texture"])
    # MapSurface gives the mesh textures itself if they are in several files.
    whole = refined if given.tiles > 1 else textured.with_suffix(".ply")
    if "map" in wanted:
        yield Step("map", programs.map_surface(scene, whole, out / "scene_map", *refractive,
                                               *mask_words(options["texture"], options["map"]),
                                               *options["map"]),
                   makes=Files(*(out / f"scene_map.{kind}.tif" for kind in ("dem", "ortho", "views"))),
                   reads=reads["map"] + reads["texture"])
    if "page" in wanted:
        truth = [given.truth] if given.truth else []
        yield Step("page", programs.view_scene(scene, out / "scene_dense.ply", whole, out / "page",
                                               *refractive, "--sfm-model", out / "refined",
                                               *(("--truth", *truth) if truth else ()),
                                               *options["page"]),
                   makes=out / "page" / "index.html", reads=reads["page"] + truth)


def steps(given, out):
    programs, densify = Programs(given.programs), words_of("densify", given)
    refined, scene, cloud = out / "refined", out / "scene.mvs", out / "scene_dense.ply"
    known_positions = positions.file_of(given.scale_from)
    yield from colmap_steps(given, out)
    yield Step("refine", programs.refine_poses(out / "colmap" / "best", given.lens, given.housing,
                                               refined, *refine_options(given)),
               makes=refined / "report.json",
               reads=[given.lens, given.housing, *([known_positions] if known_positions else []),
                      *existing_files(words_of("refine-poses", given))])
    yield Step("import", programs.import_scene(refined, given.images, scene,
                                               refined / "housing.json"), makes=scene)
    yield Step("densify", programs.densify(scene, out, "--refractive", 1,
                                           *tile_options("--fusion-tiles", given), *densify),
               makes=cloud, reads=existing_files(densify))
    yield from mesh_steps(given, out)
    if given.truth:
        yield Step("evaluate", programs.evaluate(cloud, given.truth, "--json",
                                                 out / "evaluation.json", "--align", "icp"),
                   makes=out / "evaluation.json", reads=[given.truth])


def lines_of_poses(refined):
    """The lines of the report about the result of RefinePoses, `refined`."""
    yield (f"- reprojection error: {refined['rms_before_px']:.3f} px before, "
           f"{refined['rms_after_px']:.3f} px after refining")
    yield (f"- {refined['observations_after']} observations of {refined['points_after']} points "
           f"in {sum(i['observations'] > 0 for i in refined['images'])} images")
    sigma = refined["scale_sigma"]
    if sigma is None:
        yield "- the scale is not known"
    elif sigma != 0:  # 0: the poses were known
        yield f"- the scale is known to {100 * sigma:.2g} % (one standard deviation)"
    for camera in refined["cameras"]:
        for value in camera["free"]:
            sigma = "not known" if value["sigma"] is None else f"+- {value['sigma']:.2g}"
            yield (f"- camera {camera['id']}, {value['name']}: {value['value']:.6g} "
                   f"{value['unit']}, {sigma}")


def report(out, seconds):
    """The text of report.md. `seconds`: the time of each step."""
    refined = json.loads((out / "refined" / "report.json").read_text())
    lines = ["# Reconstruction", "", *lines_of_poses(refined)]
    if "evaluate" in seconds:
        accuracy = json.loads((out / "evaluation.json").read_text())["accuracy"]
        lines.append(f"- mean distance to the truth {1e3 * accuracy['mean']:.3f} mm, median "
                     f"{1e3 * accuracy['median']:.3f} mm, {accuracy['count']} points")
    lines += ["", "| step | seconds |", "|---|---|"]
    lines += [f"| {name} | {time} |" for name, time in seconds.items()]
    return "\n".join(lines) + "\n"


def only_run_in(out):
    """Refuses other runs in the folder `out` until the returned file is closed. The commands of steps
    do not inherit the file, so that the refusal ends with this process. With --cluster, snakemake
    inherits the file, so that the refusal ends when both processes have ended."""
    lock = open(out / "lock", "w")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise Failure(f"--output {out}: another run uses this folder") from None
    except OSError as error:
        print(f"--output {out}: cannot be locked ({error.strerror}): make sure that no other run "
              "uses this folder", flush=True)
    return lock


def mesh_of(given, out):
    textured = f"scene_textured.tile*-{given.tiles}.glb" if given.tiles > 1 else "scene_textured.glb"
    name = {"cloud": "", "mesh": "scene_dense_refined.ply"}.get(given.until, textured)
    maps = f"Maps: {out / 'scene_map.*'}   " if given.until in ("map", "page") else ""
    page = f"Page: {out / 'page' / 'index.html'}   " if given.until == "page" else ""
    return f"Mesh: {out / name}   {maps}{page}" if name else ""


def reconstruct(given):
    check(given)
    out = pathlib.Path(given.output)
    out.mkdir(parents=True, exist_ok=True)
    with only_run_in(out) as lock:
        todo = list(steps(given, out))
        seconds = (cluster.run_all(todo, given, out, lock) if given.cluster
                   else run_all(todo, out))
        files.write(out / "report.md", report(out, seconds))
    print(f"Cloud: {out / 'scene_dense.ply'}   {mesh_of(given, out)}Report: {out / 'report.md'}")


def main(script_folder):
    """`script_folder`: the folder of the command that the user typed."""
    run_main("reconstruct", lambda: reconstruct(options(script_folder)),
             "stopped; the same command continues from here")
