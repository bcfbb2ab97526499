# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of `reconstruct`: their commands, what they make, and what they read."""

import pathlib

from . import (cameras, colmap, database, features, left_out, lenses, masks, matching, poses, positions, start_lens,
               still_features, turns, video)
from .option_files import find_option, has_option, read_by
from .programs import Programs, words_of
from .running import logged, tell, told
from .reconstruct_options import wanted_steps
from .run_file import write_run
from .step_kinds import KINDS, writes_of
from .steps import Files, Report, Step, Tiles


def masks_of(given, out):
    """The folder of COLMAP's masks; None without --masks."""
    return out / masks.FOLDER if given.masks else None


def features_command(given, out):
    """COLMAP's detector by database and further options. Its lens is set before photographs are matched."""
    model = given.lens_model or "OPENCV"
    return lambda file, *more: colmap.features(file, given.images, model, masks=masks_of(given, out),
                                               more=[*words_of("features", given), *more])


def features_of_camera(number, command, file, out):
    """COLMAP's detector for the photographs of one of several cameras."""
    return command(file, "--image_list_path", cameras.list_of(out, number))


def look_at_features(given, features_file, command, out):
    """Finds the features of further cameras, adds weak features where there are few, and says how many there
    are, and which are at rest."""
    for number in range(2, len(given.cameras) + 1):
        logged(told(features_of_camera(number, command, features_file, out)), out / "logs" / f"features-{number}.log",
               "features")
    if not any("peak_threshold" in word for word in words_of("features", given)):
        features.take_weak_features(features_file, lambda file, names, threshold: command(
            file, *colmap.weak_features(names, threshold)), out)
    for line in features.lines_about(features_file):
        tell(line)
    still_features.look(features_file, out, out / "logs" / "features.log", is_masked=bool(given.masks))


def lens_files(given):
    return [lenses.given_as(text)[1] for text in given.lenses]


def write_cameras(given, out):
    if given.cameras:
        cameras.write(given, out)


def prepare_matches(given, found, file, out):
    """Leaves out photographs that do no good, and sets the lens for COLMAP. `found`: the database with the
    features of all photographs."""
    if not given.keep_all:
        left_out.leave_out(found, file, given.doubled, poses.scale_names(given), given.scale_from)
    start_lens.set_in(file, given, out)


def prepare_refining(given, out, refine_into):
    """Refuses a length between photographs that were left out, and turns the lenses of turned photographs.
    `refine_into`: the command of RefinePoses by its output folder."""
    left_out.refuse_needed(database.left_out(out / "database.db"), poses.scale_names(given), given.scale_from)
    if given.cameras:
        turns.choose(given, out, refine_into)


def colmap_steps(given, out):
    found, file, models = out / "features.db", out / "database.db", out / "colmap"
    folder, command, more = masks_of(given, out), features_command(given, out), words_of("poses", given)
    if folder:
        yield Step("masks", masks.command(Programs(given.programs), given, folder), makes=folder,
                   reads=[given.masks, given.images], anew=[folder])
    yield Step("features", features_of_camera(1, command, found, out) if given.cameras else command(found),
               makes=found, reads=[given.images, *(lens_files(given) if given.cameras else [])],
               # COLMAP would make a further camera for the photographs that a killed command left.
               before=lambda: write_cameras(given, out), anew=colmap.database_files(found) if given.cameras else [],
               changed=[*colmap.database_files(found), out / still_features.FOUND],
               after=lambda: look_at_features(given, found, command, out))
    if not given.lens_model:
        yield Step("lens", Programs(given.programs).effective_lens(
            cameras.lens_file(given, out), cameras.housing_file(given, out), out / start_lens.FILE),
                   makes=out / start_lens.FILE, reads=[*lens_files(given), given.housing],
                   before=lambda: write_cameras(given, out))
    yield matching.step(given, found, file, lambda: prepare_matches(given, found, file, out),
                        reads=lens_files(given) if given.lens_model else [out / start_lens.FILE],
                        settings=["--keep-all"] if given.keep_all else list(given.doubled))
    refine = None if given.lens_model else False
    yield Step("poses", colmap.mapper(file, given.images, models, refine, more=more), makes=models / "best",
               anew=[models], before=models.mkdir, excuse=colmap.NO_MODEL,
               after=lambda: poses.take_best(file, given, out, more))


def refine_options(given):
    known = ["--scale-from", given.scale_from] if given.scale_from else []
    refine = ["--refine", given.refine] if given.refine else []
    return [*known, *refine, *words_of("refine-poses", given)]


def mask_words(words, given_again):
    """The options of TextureMesh for masks among `words`, which MapSurface has, too, in their full form.
    Options that are among `given_again` are left out."""
    kept = []
    for word, value in zip(words, [*words[1:], ""]):
        option = find_option(word, ("--mask-path", "--ignore-mask-label"))
        if option and not has_option(given_again, option):
            _, equals, joined = word.partition("=")
            kept += [f"{option}={joined}"] if equals else [option, value]
    return kept


def options_for(names, given, out):
    """The words of the options --`name` for programs, with --masks for the programs that take masks."""
    words = {name: words_of(name, given) for name in names}
    return {name: [*(masks.words(given, masks_of(given, out), own) if KINDS[name].takes_masks else []), *own]
            for name, own in words.items()}


def reads_of(name, command, given):
    """The files and folders that the option --`name` lets a program read, which `command` runs. Not the
    masks of this run: the step "masks" has read those of the user."""
    return read_by(command, words_of(name, given))


def tile_options(option, given):
    """The option of a program for the tiles."""
    return (option, given.tiles) if given.tiles > 1 else ()


def meshes(out):
    """The files of the mesh and of the refined mesh, and the begin of those of the textured mesh."""
    return (out / "scene_dense_mesh.ply", out / "scene_dense_refined.ply", out / "scene_textured")


def best_mesh(given, out):
    return meshes(out)["refine-mesh" in wanted_steps(given)]


def whole_mesh(given, out):
    """The mesh for maps and page: textured if the textures are in one file."""
    if given.tiles > 1 or "texture" not in wanted_steps(given):
        return best_mesh(given, out)
    return meshes(out)[2].with_suffix(".ply")


def made_before(name, out):
    """Looks, when the step `name` begins, for the files that an earlier run of it made."""
    for pattern in writes_of(name):
        yield from list(out.glob(pattern))


def mesh_steps(given, out):
    """The steps from the cloud to the mesh and its textures."""
    programs, scene, refractive = Programs(given.programs), out / "scene_dense.mvs", ("--refractive", 1)
    mesh, refined, textured = meshes(out)
    options = options_for(("mesh", "refine-mesh", "texture"), given, out)
    wanted = wanted_steps(given)
    if "mesh" in wanted:
        command = programs.reconstruct_mesh(scene, mesh, *refractive, *tile_options("--tiles", given),
                                            *options["mesh"])
        yield Step("mesh", command, makes=mesh, reads=reads_of("mesh", command, given))
    if "refine-mesh" in wanted:
        command = programs.refine_mesh(scene, mesh, refined, *refractive, *options["refine-mesh"])
        yield Step("refine-mesh", command, makes=refined, reads=reads_of("refine-mesh", command, given))
    if "texture" in wanted:
        command = programs.texture_mesh(scene, best_mesh(given, out), textured, "--export-type", "glb,ply",
                                        *refractive, *tile_options("--tiles", given), *options["texture"])
        yield Step("texture", command,
                   makes=Tiles(out, f"scene_textured.tile*-{given.tiles}.glb") if given.tiles > 1
                   else Files(textured.with_suffix(".glb"), textured.with_suffix(".ply")),
                   reads=reads_of("texture", command, given), anew=made_before("texture", out))


RUN_FILE = "run.json"


def words_about_results(given, out):
    """The options of ViewScene for the results of earlier steps, except those that the user gave."""
    given_again = words_of("page", given)
    kept_maps = not has_option(words_of("densify", given), "--remove-dmaps")
    wanted = wanted_steps(given)
    words = {"--run": out / RUN_FILE, "--sfm-model": out / "refined",
             **({"--truth": given.truth} if given.truth else {}),
             **({"--map": out / "scene_map"} if "map" in wanted else {}),
             **({"--change": out / "scene"} if "compare" in wanted else {}),
             **({"--depth-maps": out} if kept_maps else {})}
    return [word for option, value in words.items() if not has_option(given_again, option)
            for word in (option, value)]


def write_run_before(name, given, out):
    """Writes the file of the run about the steps before the step `name`."""
    todo = list(steps(given, out))
    number = [step.name for step in todo].index(name)
    write_run(out / RUN_FILE, given, todo[:number], out)


def earlier_scene(given, scene):
    """Where the scene of the earlier survey is, if there is one."""
    return pathlib.Path(given.earlier).with_name(scene.name)


def words_about_surveys(given, scene, words):
    """The options of CompareSurveys that the user did not give among `words`: registration, and the
    scenes of both surveys if the earlier one has one beside its mesh."""
    earlier = earlier_scene(given, scene)
    known = [("--align", "icp")]
    if earlier.exists() and not any(has_option(words, option) for option in ("--scene", "--other-scene")):
        known += [("--scene", earlier), ("--other-scene", scene)]
    return [word for option in known if not has_option(words, option[0]) for word in option]


def survey_steps(given, out):
    """The steps from the mesh to maps, to the comparison with an earlier survey, and to the page."""
    programs, scene, refractive = Programs(given.programs), out / "scene_dense.mvs", ("--refractive", 1)
    options = options_for(("texture", "map", "compare", "page"), given, out)
    wanted, whole = wanted_steps(given), whole_mesh(given, out)
    if "map" in wanted:
        command = programs.map_surface(scene, whole, out / "scene_map", *refractive,
                                       *mask_words(options["texture"], options["map"]), *options["map"])
        yield Step("map", command,
                   makes=Files(*(out / f"scene_map.{kind}.tif" for kind in ("dem", "ortho", "views"))),
                   reads=[*reads_of("map", command, given), *reads_of("texture", command, given)],
                   anew=made_before("map", out))  # not every command writes all of them again
    if "compare" in wanted:
        command = programs.compare_surveys(given.earlier, best_mesh(given, out), out / "scene",
                                           *words_about_surveys(given, scene, options["compare"]),
                                           *options["compare"])
        yield Step("compare", command, makes=out / "scene.change.json",
                   reads=[given.earlier, earlier_scene(given, scene), *reads_of("compare", command, given)],
                   anew=made_before("compare", out))
    if "page" in wanted:
        command = programs.view_scene(scene, out / "scene_dense.ply", whole, out / "page", *refractive,
                                      *words_about_results(given, out), *options["page"])
        yield Step("page", command, makes=out / "page" / "index.html",
                   reads=[*reads_of("page", command, given), *([given.truth] if given.truth else [])],
                   before=lambda: write_run_before("page", given, out))


def steps(given, out):
    """The steps of a run with the options `given` in the folder `out`, in order."""
    programs, densify = Programs(given.programs), options_for(["densify"], given, out)["densify"]
    refined, scene, cloud = out / "refined", out / "scene.mvs", out / "scene_dense.ply"
    known_positions = positions.file_of(given.scale_from)
    if given.videos:
        yield video.step(given, out)
    yield from colmap_steps(given, out)
    refine_into = lambda folder: programs.refine_poses(
        out / "colmap" / "best", cameras.lens_file(given, out), cameras.housing_file(given, out), folder,
        "--database", out / "database.db", *refine_options(given))
    command = refine_into(refined)
    yield Step("refine", command, makes=Report(refined / "report.json"),
               reads=[*lens_files(given), given.housing, *([known_positions] if known_positions else []),
                      *reads_of("refine-poses", command, given)],
               before=lambda: prepare_refining(given, out, refine_into), after=lambda: poses.print_changes(out))
    if "densify" not in wanted_steps(given):
        return
    command = programs.import_scene(refined, given.images, scene, refined / "housing.json")
    yield Step("import", command, makes=scene, reads=read_by(command, []))
    command = programs.densify(scene, out, "--refractive", 1, *tile_options("--fusion-tiles", given),
                               *densify)
    yield Step("densify", command, makes=cloud, reads=reads_of("densify", command, given))
    yield from mesh_steps(given, out)
    yield from survey_steps(given, out)
    if given.truth:
        command = programs.evaluate(cloud, given.truth, "--json", out / "evaluation.json", "--align", "icp")
        yield Step("evaluate", command, makes=Report(out / "evaluation.json"),
                   reads=[given.truth, *read_by(command, [])])
