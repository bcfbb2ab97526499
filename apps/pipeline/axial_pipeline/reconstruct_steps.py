# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of `reconstruct`: their commands, what they make, and what they read."""

import pathlib

from . import (boundary, cameras, colmap, control, database, exposures, features, left_out, lenses, map_places, masks,
               matching, poses, positions, start_lens, still_features, turns, video)
from .option_files import find_option, has_option, read_by, without_options
from .programs import Programs, words_of
from .reconstruct_options import keeps_depth_maps, wanted_steps
from .run_file import write_run
from .running import logged, tell, told
from .step_kinds import KINDS, writes_of
from .steps import Files, Report, Step, Tiles

RUN_FILE = "run.json"
RESTORED = "restored"  # the folder of the photographs without water
REFRACTIVE = ("--refractive", 1)


def meshes(out):
    """The files of the mesh and of the refined mesh, and the begin of those of the textured mesh."""
    return (out / "scene_dense_mesh.ply", out / "scene_dense_refined.ply", out / "scene_textured")


def first_mesh(given, out):
    """The mesh of the first cloud, refined unless this is left out."""
    return meshes(out)["refine-mesh" in wanted_steps(given)]


def final_cloud(given, out):
    """The cloud that is evaluated: with --match-restored, that of the photographs without water."""
    return out / ("scene_restored.ply" if "restored-mesh" in wanted_steps(given) else "scene_dense.ply")


def shown_cloud(given, out):
    """The cloud that users look at: with --restore-colors, the one with these colours."""
    return out / ("scene_restored.ply" if "restored-cloud" in wanted_steps(given) else "scene_dense.ply")


def las_of(given, out):
    return shown_cloud(given, out).with_suffix(".las")


def restored_meshes(out):
    """The files of the mesh and of the refined mesh of --match-restored."""
    return out / "scene_restored_mesh.ply", out / "scene_restored_refined.ply"


def best_mesh(given, out):
    """The mesh that textures, maps, comparison and page use."""
    wanted = wanted_steps(given)
    return (restored_meshes(out)["restored-refine-mesh" in wanted] if "restored-mesh" in wanted
            else first_mesh(given, out))


class Run:
    """What the steps of a run with the options `given` in the folder `out` share."""

    def __init__(self, given, out):
        self.given, self.out, self.programs = given, out, Programs(given.programs)
        self.scene, self.refined = out / "scene_dense.mvs", out / "refined"
        # COLMAP's masks
        self.masks = pathlib.Path(given.joint or out) / masks.FOLDER if given.masks else None
        self.lens_files = [lenses.given_as(text).file for text in given.lenses]

    def own(self, name):
        """The words of the option for the program of the step `name`."""
        return words_of(KINDS[name].option or name, self.given) if KINDS[name].program else []

    def words(self, name):
        """As own(), with --masks for the programs that take masks."""
        own = self.own(name)
        return [*(masks.words(self.given, self.masks, own) if KINDS[name].takes_masks else []), *own]

    def tiles(self):
        """The option of a program for the tiles."""
        return ("--tiles", self.given.tiles) if self.given.tiles > 1 else ()

    def system(self, words=()):
        """The option of a program for the coordinate reference system, unless the `words` of the user state it."""
        if boundary.states_system(words):
            return []
        return not_given_again([("--epsg", self.given.epsg)] if self.given.epsg else [], words)

    def step(self, name, command, makes, reads=(), also=(), **more):
        """The step of a program. It reads what the words of its option name, too, but not the masks of this run: the
        step "masks" has read those of the user. `reads`, `also`: files, before and after those."""
        return Step(name, command, makes, reads=[*reads, *read_by(command, self.own(name)), *also], **more)

    def write_cameras(self):
        if self.given.cameras:
            cameras.write(self.given, self.out)

    def made_before(self, name):
        """Looks, when the step `name` begins, for the files that an earlier run of it made."""
        for pattern in writes_of(name):
            yield from list(self.out.glob(pattern))


def features_command(run):
    """COLMAP's detector by database and further options. Its lens is set before photographs are matched."""
    model = run.given.lens_model or "OPENCV"
    return lambda file, *more: colmap.features(file, run.given.images, model, masks=run.masks,
                                               more=[*run.own("features"), *more])


def features_of_camera(number, command, file, out):
    """COLMAP's detector for the photographs of one of several cameras."""
    return command(file, "--image_list_path", cameras.list_of(out, number))


def look_at_features(run, features_file, command):
    """Finds the features of further cameras, adds weak features where there are few, and says how many there
    are, and which are at rest."""
    out = run.out
    for number in range(2, len(run.given.cameras) + 1):
        logged(told(features_of_camera(number, command, features_file, out)), out / "logs" / f"features-{number}.log",
               "features")
    if not any("peak_threshold" in word for word in run.own("features")):
        features.take_weak_features(features_file, lambda file, names, threshold: command(
            file, *colmap.weak_features(names, threshold)), out)
    for line in features.lines_about(features_file):
        tell(line)
    still_features.look(features_file, out, out / "logs" / "features.log", is_masked=bool(run.masks))


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
    run, command, more = Run(given, out), features_command(Run(given, out)), words_of("poses", given)
    found, file, models = out / "features.db", out / "database.db", out / "colmap"
    if run.masks:
        yield Step("masks", masks.command(run.programs, given, run.masks), makes=run.masks,
                   reads=[given.masks, given.images], anew=[run.masks])
    yield Step("features", features_of_camera(1, command, found, out) if given.cameras else command(found),
               makes=found, reads=[given.images, *(run.lens_files if given.cameras else [])],
               settings=given.lenses if given.cameras else [],  # which lens belongs to which photographs
               # COLMAP would make a further camera for the photographs that a killed command left.
               before=run.write_cameras, anew=colmap.database_files(found) if given.cameras else [],
               changed=[*colmap.database_files(found), out / still_features.FOUND],
               after=lambda: look_at_features(run, found, command))
    if not given.lens_model:
        yield Step("lens", run.programs.effective_lens(
            cameras.lens_file(given, out), cameras.housing_file(given, out), out / start_lens.FILE),
                   makes=out / start_lens.FILE, reads=[*run.lens_files, given.housing], before=run.write_cameras)
    yield matching.step(given, found, file, lambda: prepare_matches(given, found, file, out),
                        reads=run.lens_files if given.lens_model else [out / start_lens.FILE],
                        settings=["--keep-all"] if given.keep_all else list(given.doubled))
    refine = None if given.lens_model else False
    yield Step("poses", colmap.mapper(file, given.images, models, refine, more=more), makes=models / "best",
               anew=[models], before=models.mkdir, excuse=colmap.NO_MODEL,
               after=lambda: poses.take_best(file, given, out, more))


def targets_step(run):
    file = run.out / control.FOUND
    return run.step("targets", run.programs.find_targets(run.given.images, file, *run.own("targets")), file,
                    reads=[run.given.images], after=lambda: control.require_found(file, run.given.images))


def refine_step(run):
    given, out, known_positions = run.given, run.out, positions.file_of(run.given.scale_from)
    known = ["--scale-from", given.scale_from] if given.scale_from else []
    refine = ["--refine", given.refine] if given.refine else []
    refine_into = lambda folder: run.programs.refine_poses(
        out / "colmap" / "best", cameras.lens_file(given, out), cameras.housing_file(given, out), folder,
        "--database", out / "database.db", *known, *control.words(given, out), *(run.system() if given.control else []),
        *refine, *run.own("refine"))
    return run.step("refine", refine_into(run.refined), Report(run.refined / "report.json"),
                    reads=[*run.lens_files, given.housing, *([known_positions] if known_positions else []),
                           *control.files_of(given, out)],
                    before=lambda: prepare_refining(given, out, refine_into), after=lambda: poses.print_changes(out))


def cloud_steps(run):
    scene = run.out / "scene.mvs"
    yield run.step("import", run.programs.import_scene(run.refined, run.given.images, scene,
                                                       run.refined / "housing.json"), scene)
    yield run.step("densify", run.programs.densify(scene, run.out, *REFRACTIVE, *run.tiles(),
                                                   *run.words("densify")), run.out / "scene_dense.ply")


def colors(run, wanted, words):
    """The option of a program that takes the colours of --restore-colors, unless it is among the `words` of the
    user."""
    return not_given_again([("--colors", run.out / RESTORED)] if "colors" in wanted else [], words)


def color_steps(run, wanted):
    """The photographs without water, and a cloud that has their colours."""
    out = run.out
    if "colors" in wanted:
        found, file = run.given.exposures, out / exposures.FILE
        command = run.programs.restore_colors(run.scene, first_mesh(run.given, out), out / RESTORED, *REFRACTIVE,
                                              *(["--exposures", file] if found else []), *run.words("colors"))
        yield run.step("colors", command, Report(out / RESTORED / "colors.json"), anew=[out / RESTORED],
                       before=lambda: exposures.write(file, found) if found else None,
                       settings=[f"{name} {exposure}" for name, exposure in found.items()])
    if "restored-cloud" in wanted:
        # The same command as that of the step "densify", so that it takes the depth maps of this step, or with
        # --match-restored replaces them.
        words = without_options(run.words("densify"), ["--pinhole-export", "--report-file"])
        match = ["--match-restored", "1"] if run.given.match_restored else []
        command = run.programs.densify(out / "scene.mvs", out, *REFRACTIVE, *run.tiles(), *words,
                                       *colors(run, wanted, words), *match, "-o", out / "scene_restored.mvs")
        yield run.step("restored-cloud", command, out / "scene_restored.ply",
                       also=read_by(command, run.own("densify")))
    yield from rematched_mesh_steps(run, wanted)


def rematched_mesh_steps(run, wanted):
    """The mesh of the cloud of --match-restored."""
    scene, (mesh, refined) = run.out / "scene_restored.mvs", restored_meshes(run.out)
    if "restored-mesh" in wanted:
        command = run.programs.reconstruct_mesh(scene, mesh, *REFRACTIVE, *run.tiles(), *run.words("mesh"))
        yield run.step("restored-mesh", command, mesh, also=read_by(command, run.own("mesh")))
    if "restored-refine-mesh" in wanted:
        words = run.words("refine-mesh")
        command = run.programs.refine_mesh(scene, mesh, refined, *REFRACTIVE, *colors(run, wanted, words), *words)
        yield run.step("restored-refine-mesh", command, refined, also=read_by(command, run.own("refine-mesh")))


def mesh_steps(run, wanted):
    """The steps from the cloud to the mesh and its textures."""
    given, out, programs = run.given, run.out, run.programs
    mesh, refined, textured = meshes(out)
    if "mesh" in wanted:
        yield run.step("mesh", programs.reconstruct_mesh(run.scene, mesh, *REFRACTIVE, *run.tiles(),
                                                         *run.words("mesh")), mesh)
    if "refine-mesh" in wanted:
        yield run.step("refine-mesh", programs.refine_mesh(run.scene, mesh, refined, *REFRACTIVE,
                                                           *run.words("refine-mesh")), refined)
    yield from color_steps(run, wanted)
    if "texture" in wanted:
        words = run.words("texture")
        command = programs.texture_mesh(run.scene, best_mesh(given, out), textured, "--export-type", "glb,ply",
                                        *REFRACTIVE, *run.tiles(), *colors(run, wanted, words), *words)
        yield run.step("texture", command, Tiles(out, f"scene_textured.tile*-{given.tiles}.glb") if given.tiles > 1
                       else Files(textured.with_suffix(".glb"), textured.with_suffix(".ply")),
                       anew=run.made_before("texture"))


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


def not_given_again(options, words):
    """The words of the options, each a tuple of name and value, that are not among the `words` of the user."""
    return [word for option in options if not has_option(words, option[0]) for word in option]


def words_about_registration(run, words):
    """The options of CompareSurveys for the registration, and the files that it then reads: none between dates
    whose poses are joint; by targets if both surveys have some; otherwise by the ground. `words`: of the user."""
    if run.given.joint and not has_option(words, "--align"):
        return [("--align", "none")], []  # the poses of all dates are in one frame
    places = [folder / "refined" / control.PLACES for folder in (pathlib.Path(run.given.earlier).parent, run.out)]
    if not run.given.targets or not places[0].exists() or has_option(words, "--align"):
        return [("--align", "icp")], []
    return [("--align", "auto"), *zip(("--targets", "--other-targets"), places)], places


def words_about_surveys(words, known, earlier, scene):
    """The options of CompareSurveys that the user did not give among `words`: those that are `known`, and the
    scenes of both surveys if the earlier one has one beside its mesh."""
    known = list(known)
    if earlier.exists() and not any(has_option(words, option) for option in ("--scene", "--other-scene")):
        known += [("--scene", earlier), ("--other-scene", scene)]
    return not_given_again(known, words)


def words_about_results(run, wanted):
    """The options of ViewScene for the results of earlier steps, except those that the user gave."""
    out, kept_maps = run.out, keeps_depth_maps(run.given)
    return not_given_again([("--run", out / RUN_FILE), ("--sfm-model", run.refined),
                            *([("--truth", run.given.truth)] if run.given.truth else []),
                            *([("--map", out / "scene_map")] if "map" in wanted else []),
                            *([("--raw-map", out / "scene_map_raw")] if "raw-map" in wanted else []),
                            *([("--change", out / "scene")] if "compare" in wanted else []),
                            *map_places.of_page(run.given, out, run.words("compare"))[0],
                            *([("--depth-maps", out)] if kept_maps else []),
                            *([("--colors", out / RESTORED)] if "colors" in wanted else [])], run.own("page"))


def write_run_before(name, given, out):
    """Writes the file of the run about the steps before the step `name`."""
    todo = list(steps(given, out))
    number = [step.name for step in todo].index(name)
    write_run(out / RUN_FILE, given, todo[:number], out)


def whole_mesh(run, wanted):
    """The mesh for maps and page: textured if the textures are in one file."""
    is_textured = "texture" in wanted and run.given.tiles == 1
    return meshes(run.out)[2].with_suffix(".ply") if is_textured else best_mesh(run.given, run.out)


def map_step(run, name, mesh, output, *options):
    """The step `name`, which makes the maps of a mesh. Their names begin with `output`."""
    words = run.words("map")
    if name == "raw-map":
        words = without_options(words, ("--colors",))
    has_comparison = "compare" in wanted_steps(run.given)
    like = map_places.of_map(run.given, run.out, words) if has_comparison else []
    command = run.programs.map_surface(run.scene, mesh, output, *REFRACTIVE,
                                       *mask_words(run.words("texture"), words), *options,
                                       *(like or run.system(words)),
                                       *boundary.not_given_again(boundary.options(run.given, run.out), words), *words)
    made = [output.with_name(f"{output.name}.{kind}.tif") for kind in ("dem", "ortho", "views")]
    also = [*read_by(command, run.own("texture")), *(read_by(command, run.own("map")) if name != "map" else []),
            *like[1:]]
    return run.step(name, command, Files(*made), also=[*also, *boundary.files_of(run.given, run.out)],
                    anew=run.made_before(name))  # not every command writes all of them again


def map_steps(run, wanted):
    """The maps and, with --restore-colors, maps with the colours of the photographs, too."""
    mesh, out, words = whole_mesh(run, wanted), run.out, run.words("map")
    if "map" in wanted:  # a textured mesh has its colours
        of_mesh = colors(run, wanted, words) if mesh == best_mesh(run.given, out) else []
        yield map_step(run, "map", mesh, out / "scene_map", *of_mesh)
    if "raw-map" in wanted:
        yield map_step(run, "raw-map", best_mesh(run.given, out), out / "scene_map_raw",
                       *not_given_again([("--image-noise", "0")], words))


def survey_steps(run, wanted):
    """The steps from the mesh to the comparison with an earlier survey, to maps, and to the page."""
    given, out, programs = run.given, run.out, run.programs
    if "compare" in wanted:
        earlier, words = pathlib.Path(given.earlier).with_name(run.scene.name), run.words("compare")
        registration, places = words_about_registration(run, words)
        like = map_places.of_comparison(given, out, words)
        of_earlier = earlier.parent / "refined" / control.PLACES
        limits = boundary.options_of_comparison(given, out, of_earlier)
        command = programs.compare_surveys(given.earlier, best_mesh(given, out), out / "scene",
                                           *words_about_surveys(words, registration, earlier, run.scene),
                                           *like, *run.system(words), *boundary.not_given_again(limits, words), *words)
        read = dict.fromkeys([*places[:1], *([of_earlier] if limits else []), *boundary.files_of(given, out)])
        yield run.step("compare", command, out / map_places.CHANGE, reads=[given.earlier, earlier, *like[1:], *read],
                       anew=run.made_before("compare"))
    yield from map_steps(run, wanted)
    if "page" in wanted:
        command = programs.view_scene(run.scene, shown_cloud(given, out), whole_mesh(run, wanted), out / "page",
                                      *REFRACTIVE, *words_about_results(run, wanted), *run.words("page"))
        also = [*([given.truth] if given.truth else []), *map_places.of_page(given, out, run.words("compare"))[1]]
        yield run.step("page", command, out / "page" / "index.html", also=also,
                       before=lambda: write_run_before("page", given, out))


def steps_to_poses(run):
    given, out = run.given, run.out
    if given.videos:
        yield video.step(given, out)
    yield from colmap_steps(given, out)
    if control.finds(given):  # after COLMAP, which other families of targets must not run again
        yield targets_step(run)
    yield refine_step(run)


def steps(given, out):
    """The steps of a run with the options `given` in the folder `out`, in order. With --dates, they are the steps to
    the poses of all dates, or those from the poses to the results of one date."""
    run, wanted = Run(given, out), wanted_steps(given)
    if not given.date:
        yield from steps_to_poses(run)
    if "densify" not in wanted or bool(given.dates) != bool(given.date):
        return
    yield from cloud_steps(run)
    yield from mesh_steps(run, wanted)
    yield from survey_steps(run, wanted)
    if given.truth:
        command = run.programs.evaluate(final_cloud(given, out), given.truth, "--json", out / "evaluation.json",
                                        "--align", "icp")
        yield run.step("evaluate", command, Report(out / "evaluation.json"), reads=[given.truth])
    if "las" in wanted:
        las = las_of(given, out)
        yield run.step("las", run.programs.write_as_las(shown_cloud(given, out), las, *run.system()), las)
