# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of `reconstruct`: their commands, what they make, and what they read."""

import pathlib

from . import colmap, lens, matching, positions
from .programs import Programs
from .reconstruct_options import wanted_steps, words_of
from .run_file import write_run
from .steps import Files, Step, Tiles


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
    """The files and folders that `words` of a command name, also as --option=path."""
    paths = [word.partition("=")[2] if word.startswith("--") else word for word in words]
    return [path for path in paths if path and pathlib.Path(path).exists()]


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


def mesh_steps(given, out):
    """The steps from the cloud to the mesh and its textures."""
    programs, scene, refractive = Programs(given.programs), out / "scene_dense.mvs", ("--refractive", 1)
    mesh, refined, textured = meshes(out)
    options = {name: words_of(name, given) for name in ("mesh", "refine-mesh", "texture")}
    reads = {name: existing_files(words) for name, words in options.items()}
    wanted = wanted_steps(given)
    if "mesh" in wanted:
        yield Step("mesh", programs.reconstruct_mesh(scene, mesh, *refractive,
                                                     *tile_options("--tiles", given),
                                                     *options["mesh"]),
                   makes=mesh, reads=reads["mesh"])
    if "refine-mesh" in wanted:
        yield Step("refine-mesh", programs.refine_mesh(scene, mesh, refined, *refractive,
                                                       *options["refine-mesh"]),
                   makes=refined, reads=reads["refine-mesh"])
    if "texture" in wanted:
        yield Step("texture", programs.texture_mesh(scene, best_mesh(given, out), textured,
                                                    "--export-type", "glb,ply", *refractive,
                                                    *tile_options("--tiles", given),
                                                    *options["texture"]),
                   makes=Tiles(out, f"scene_textured.tile*-{given.tiles}.glb") if given.tiles > 1
                   else Files(textured.with_suffix(".glb"), textured.with_suffix(".ply")),
                   reads=reads["texture"])


RUN_FILE = "run.json"


def words_about_results(given, out):
    """The options of ViewScene for the results of earlier steps, except those that the user gave."""
    again = {word.partition("=")[0] for word in words_of("page", given)}
    kept_maps = not any(word.startswith("--remove-d") for word in words_of("densify", given))
    wanted = wanted_steps(given)
    words = {"--run": out / RUN_FILE, "--sfm-model": out / "refined",
             **({"--truth": given.truth} if given.truth else {}),
             **({"--map": out / "scene_map"} if "map" in wanted else {}),
             **({"--change": out / "scene_change"} if "compare" in wanted else {}),
             **({"--depth-maps": out} if kept_maps else {})}
    return [word for option, value in words.items() if option not in again for word in (option, value)]


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
    again = {word.partition("=")[0] for word in words}
    earlier = earlier_scene(given, scene)
    known = [("--align", "icp")]
    if earlier.exists() and not again & {"--scene", "--other-scene"}:
        known += [("--scene", earlier), ("--other-scene", scene)]
    return [word for option in known if option[0] not in again for word in option]


def survey_steps(given, out):
    """The steps from the mesh to maps, to the comparison with an earlier survey, and to the page."""
    programs, scene, refractive = Programs(given.programs), out / "scene_dense.mvs", ("--refractive", 1)
    options = {name: words_of(name, given) for name in ("texture", "map", "compare", "page")}
    reads = {name: existing_files(words) for name, words in options.items()}
    wanted, whole = wanted_steps(given), whole_mesh(given, out)
    if "map" in wanted:
        yield Step("map", programs.map_surface(scene, whole, out / "scene_map", *refractive,
                                               *mask_words(options["texture"], options["map"]),
                                               *options["map"]),
                   makes=Files(*(out / f"scene_map.{kind}.tif" for kind in ("dem", "ortho", "views"))),
                   reads=reads["map"] + reads["texture"],
                   anew=[out / "scene_map.sigma.tif"])  # not every command writes it again
    if "compare" in wanted:
        yield Step("compare", programs.compare_surveys(
                       given.earlier, best_mesh(given, out), out / "scene_change",
                       *words_about_surveys(given, scene, options["compare"]), *options["compare"]),
                   makes=out / "scene_change.json",
                   reads=[given.earlier, earlier_scene(given, scene), *reads["compare"]])
    if "page" in wanted:
        yield Step("page", programs.view_scene(scene, out / "scene_dense.ply", whole, out / "page",
                                               *refractive, *words_about_results(given, out),
                                               *options["page"]),
                   makes=out / "page" / "index.html",
                   reads=[*reads["page"], *([given.truth] if given.truth else [])],
                   before=lambda: write_run_before("page", given, out))


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
    yield from survey_steps(given, out)
    if given.truth:
        yield Step("evaluate", programs.evaluate(cloud, given.truth, "--json",
                                                 out / "evaluation.json", "--align", "icp"),
                   makes=out / "evaluation.json", reads=[given.truth])
