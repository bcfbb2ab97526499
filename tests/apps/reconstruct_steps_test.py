# SPDX-License-Identifier: GPL-3.0-or-later
"""apps/pipeline/reconstruct with stand-ins for the programs: its commands, its steps, and what happens
when it is stopped."""

import json
import os
import pathlib
import shlex
import shutil
import signal

from pipeline_folder import options_of, reconstruct_command
from programs import main, without_streams
from reconstruct_test import STEPS
from stand_ins import StandIns

from axial_pipeline import exif, exposures, photographs, reconstruct_steps
from axial_pipeline.run_file import write_run


class WithStandIns(StandIns):
    """The whole script, with stand-in programs that end at once or sleep."""

    def test_takes_its_command_along_when_killed_alone(self):
        process, pipe = self.held_at("DensifyPointCloud")
        process.kill()
        self.assertEqual(self.next_of(pipe), b"")
        (self.folder / "pipe-DensifyPointCloud").unlink()
        self.assertEqual(self.done_before(), 6)

    def test_takes_a_wrappers_child_along_however_it_ends(self):
        """Tried with the first program, a middle one and the last one."""
        for program in ("colmap", "RefinePoses", "MapSurface"):
            for end in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
                process, pipe = self.held_at(program, "child-pipe")
                process.send_signal(end)
                self.assertEqual(self.next_of(pipe), b"", (program, end))
                process.wait(timeout=30)
                (self.folder / f"child-pipe-{program}").unlink()
        self.assertNotIn("ended", self.commands())
        self.succeeds()

    def test_prints_nothing_into_files_where_output_is_closed(self):
        ended = without_streams((0, 1, 2), *reconstruct_command(programs="."), cwd=self.folder)
        self.assertEqual(ended.returncode, 0)
        self.assertEqual((self.folder / "out" / "lock").read_bytes(), b"")
        self.assertTrue((self.folder / "out" / "report.md").read_text().startswith("# Recon"))

    def test_refuses_a_second_run_in_the_same_folder(self):
        self.held_at("DensifyPointCloud")
        second = self.ended()
        self.assertEqual(second.returncode, 1)
        self.assertEqual(second.stdout, "")
        self.assertEqual(second.stderr, f"reconstruct: --output {self.folder / 'out'}: "
                                        "another run uses this folder\n")

    def test_prints_the_commands_that_it_runs(self):
        said = self.ended().stdout.splitlines()
        printed = [said[said.index(f"[{number}/11] {step}") + 1].removeprefix(" " * 4)
                   for number, step in enumerate(STEPS[:11], 1)]
        run_were = self.commands()
        self.assertEqual([" ".join([pathlib.Path(program).name, *arguments]) for program, *arguments
                          in map(shlex.split, printed)], run_were)

    def test_records_say_which_version_made_a_step(self):
        self.succeeds()
        records = self.folder / "out" / "steps"
        for step, program in (("features", "colmap"), ("map", "MapSurface")):
            record = json.loads((records / f"{step}.done.json").read_text())
            self.assertEqual(record["version"], f"{program} 7.8")

    def test_the_page_shows_the_run_and_is_made_once(self):
        programs = self.folder / "prefix" / "bin"
        programs.mkdir(parents=True)
        self.write("prefix/share/axialmvs/view/viewer.js", "")
        for program in self.folder.glob("[A-Z]*"):
            shutil.copy(program, programs)
        self.add_to(programs / "ViewScene",
                    "mkdir -p out/page; touch out/page/index.html; cp out/run.json shown.json\n")
        self.add_to(programs / "DensifyPointCloud", "echo '12:34:56 [DensifyPointCloud] warning: far away'\n" * 2 +
                    "echo '12:34:56 [DensifyPointCloud] no warning: a result'\n")
        self.add_to("colmap", '[ "$1" != mapper ] || echo "W20240131 01:02:03.456789  12 ba.cc:7] no convergence"\n')
        again = ["--programs", str(programs), "--densify=--iters 3", "--truth", "lens"]
        shutil.copy(self.folder / "MapSurface", programs / "EvaluateReconstruction")
        self.add_to(programs / "EvaluateReconstruction",
                    "echo '{\"accuracy\": {\"mean\": 0, \"median\": 0, \"count\": 1}}' > out/evaluation.json\n")
        self.write("out/page/index.html")
        self.assertIn("page: no record of an earlier run names this file", self.refused(*again))
        shutil.rmtree(self.folder / "out")

        self.succeeds(*again)
        shown = json.loads((self.folder / "shown.json").read_text())
        self.assertEqual([step["name"] for step in shown["steps"]], STEPS[:11])
        steps = {step["name"]: step for step in shown["steps"]}
        self.assertEqual(steps["densify"]["warnings"], [{"text": "far away", "times": 2}])
        self.assertEqual(steps["poses"]["warnings"], [{"text": "ba.cc:7] no convergence", "times": 1}])
        self.assertEqual(steps["refine"]["warnings"], [])
        self.assertEqual(steps["densify"]["version"], "DensifyPointCloud 7.8")
        self.assertEqual(steps["densify"]["command"][-2:], ["--iters", "3"])
        self.assertGreaterEqual(steps["mesh"]["seconds"], 0)
        self.assertIn("--densify=--iters 3", shown["command"])
        command = shlex.split(self.command_of("ViewScene"))
        out = str(self.folder / "out")
        for option, value in (("--map", f"{out}/scene_map"), ("--run", f"{out}/run.json"),
                              ("--depth-maps", out)):
            self.assertEqual(command[command.index(option) + 1], value)

        self.assertEqual(self.done_before(*again), 13)
        self.assertEqual(self.done_before(*again, "--page=--map other"), 11)
        self.assertEqual("\n".join(self.commands()).count("--map "), 2)

    def test_the_page_and_the_report_have_bars_and_control_points(self):
        number = lambda residual, sigma: {"residual": residual, "expected_sigma": sigma}
        control = {"targets": 4, "observations": 20, "rms_px": 0.05, "left_out": ["a line"],
                   "bars": [{"name": "bar 1-2", "use": "check", "photographs": 5, "length_m": number(-0.00025, 0.001)}],
                   "points": [{"name": "target 7", "use": "used", "photographs": 3, "x_m": number(0.0015, 0.003),
                               "y_m": None, "z_m": number(None, None)}]}
        self.write("control.json", json.dumps(control))
        self.add_to("RefinePoses", 'case "$*" in *" --database "*) (printf %s "$(cat out/refined/report.json | '
                                   'sed \'s/}$/, "control": /\')"; cat control.json; echo "}") > report.new; '
                                   "mv report.new out/refined/report.json ;; esac\n")
        self.succeeds("--targets", self.write("targets.json", "{}"))
        write_run(self.folder / "run.json", options_of(), [], self.folder / "out")
        rows = json.loads((self.folder / "run.json").read_text())["control"]
        self.assertEqual(rows[1], {"name": "target 7", "use": "used", "photographs": 3,
                                   "residual_mm": [1.5, None, None], "expected_sigma_mm": [3.0, None, None]})
        report = (self.folder / "out" / "report.md").read_text()
        for line in ("| bar 1-2 | check | 5 | -0.25 | 1.00 |", "| target 7 | used | 3 | 1.50, -, - | 3.00, -, - |",
                     "- warning: a line"):
            self.assertIn(line, report)

    def test_other_options_redo_the_steps_after_them(self):
        names = [f"{number}.png" for number in range(3)]
        positions = self.write("positions.txt", "".join(f"{name} {len(name)} 0 {name[0]}\n" for name in names))
        options = ["--scale-from", f"positions:{positions}"]
        self.assertEqual(self.done_before(*options), 0)
        self.assertEqual(self.done_before(*options), 11)
        for option, kept in [("--map=--hillshade", 10), ("--texture=--outlier-threshold 0.1", 9),
                             ("--refine-mesh=--scales 1", 8), ("--mesh=--smooth 1", 7),
                             ("--densify=--resolution-level 1", 6)]:
            options.append(option)
            self.assertEqual(self.done_before(*options), kept, option)
        positions.write_text(positions.read_text() + "\n")
        self.assertEqual(self.done_before(*options), 4)
        options.append("--keep-all")
        self.assertEqual(self.done_before(*options), 2)
        options += ["--matcher", "spatial"]
        self.assertEqual(self.done_before(*options), 2)
        command = self.commands()[-9]
        self.assertIn(f"colmap spatial_matcher --database_path {self.folder}/out/database.db "
                      "--SpatialMatching.is_gps 0", command)
        positions.write_text(positions.read_text() + "\n")
        self.assertEqual(self.done_before(*options), 2)
        options += ["--matcher", "vocabulary", "--vocabulary", "lens"]
        self.assertEqual(self.done_before(*options), 2)
        self.assertEqual(self.done_before(*options), 11)

    def test_colours_without_water(self):
        self.add_to("RestoreColors", 'mkdir -p out/restored; echo \'{"light": "sun", "spread_before": 0.5, '
                                     '"spread_after": 0.25}\' > out/restored/colors.json\n')
        self.add_to("DensifyPointCloud", 'case "$*" in *scene_restored.mvs*) touch out/scene_restored.ply ;; esac\n')
        self.add_to("MapSurface", 'case "$*" in *scene_map_raw*) for k in dem ortho views; do '
                                  "touch out/scene_map_raw.$k.tif; done ;; esac\n")
        self.assertEqual(self.done_before("--without", "page"), 0)
        without = {step: json.loads((self.folder / f"out/steps/{step}.done.json").read_text()) for step in STEPS[:11]}
        restore = ["--without", "page", "--restore-colors"]
        self.assertEqual(self.done_before(*restore), 9)
        out, commands = self.folder / "out", self.commands()[-5:]
        mesh, scene = f"-m {out}/scene_dense_refined.ply", f"-i {out}/scene_dense.mvs"
        self.assertEqual(commands, [
            f"RestoreColors {scene} {mesh} -o {out}/restored --refractive 1",
            f"DensifyPointCloud -i {out}/scene.mvs -w {out} --refractive 1 --colors {out}/restored "
            f"-o {out}/scene_restored.mvs",
            f"TextureMesh {scene} {mesh} -o {out}/scene_textured --export-type glb,ply --refractive 1 --colors "
            f"{out}/restored",
            f"MapSurface {scene} -m {out}/scene_textured.ply -o {out}/scene_map --refractive 1",
            f"MapSurface {scene} {mesh} -o {out}/scene_map_raw --refractive 1 --image-noise 0"])
        self.assertIn("- colours: daylight; the light of a point differs between photographs by 25.0 %, by 50.0 % "
                      "before", (out / "report.md").read_text())
        self.assertEqual(self.done_before(*restore), 14)
        self.assertEqual(self.done_before(*restore, "--colors=--light sun"), 9)
        (out / "restored" / "colors.json").unlink()
        self.assertEqual(self.done_before(*restore, "--colors=--light sun"), 9)
        said = self.succeeds("--without", "page")
        self.assertEqual(said.count("done before"), 9)
        self.assertIn("Of an earlier run, not of this one: scene_map_raw.dem.tif, scene_map_raw.ortho.tif", said)
        again = {step: json.loads((self.folder / f"out/steps/{step}.done.json").read_text()) for step in STEPS[:11]}
        self.assertEqual([one["chain"] for one in again.values()], [one["chain"] for one in without.values()])

    def test_exposures_by_exif(self):
        taken = lambda camera, *exposures: {f"{number}.jpg": photographs.Image(exif=exif.Exif(camera, exposure=exposure))
                                            for number, exposure in enumerate(exposures)}
        of = lambda images, **changes: exposures.of(options_of(**{"restore_colors": True, **changes}), images, images)
        found = of(taken("a", 1 / 64, 0.25, 0.5))
        self.assertEqual(found, {"0.jpg": 1 / 64, "1.jpg": 0.25, "2.jpg": 0.5})
        self.assertEqual(exposures.lines_about(found),
                         ["exposures (Exif): the longest is 32.0 times the shortest"])
        for images in (taken("a", 1, None), taken("a", 1, 1.04), {**taken("b", 2, 1), **taken("a", 1)}):
            self.assertEqual(of(images), {})
        for changes in ({"restore_colors": False}, {"colors": "--exposure each"}, {"colors": "--exposures=my.csv"}):
            self.assertEqual(of(taken("a", 1, 2), **changes), {})
        step = lambda found: {step.name: step for step in reconstruct_steps.steps(options_of(
            restore_colors=True, until="texture", exposures=found), self.folder / "out")}["colors"]
        file = self.folder / "out" / "exposures.csv"
        self.assertIn(f"--exposures {file}", " ".join(step(found).command))
        self.assertNotIn("--exposures", step({}).command)
        self.assertNotEqual(step(found).fingerprint(), step({**found, "1.jpg": 0.3}).fingerprint())
        file.parent.mkdir()
        step(found).before()
        self.assertEqual(file.read_text(), "name,exposure\n0.jpg,0.015625\n1.jpg,0.25\n2.jpg,0.5\n")

    def test_colours_without_water_and_other_options(self):
        self.assertIn("--colors --light sun: is only for --restore-colors", self.refused("--colors=--light sun"))
        for until in ("poses", "cloud", "mesh"):
            self.assertIn(f"--restore-colors: is for textures, maps and the page, which --until {until} does not make",
                          self.refused("--restore-colors", "--until", until))
        steps = lambda **changes: [step.name for step in reconstruct_steps.steps(
            options_of(restore_colors=True, **{"until": "page", **changes}), self.folder / "out")][7:]
        every = ["mesh", "refine-mesh", "colors", "restored-cloud", "texture", "map", "raw-map", "page"]
        self.assertEqual(steps(), every)
        self.assertEqual(steps(densify="--remove-dmaps 1"), [name for name in every if name != "restored-cloud"])
        self.assertEqual(steps(without="map"), [name for name in every if name not in ("map", "raw-map")])
        self.assertEqual(steps(until="texture", tiles=3), every[:5])
        of_date = [step.name for step in reconstruct_steps.steps(options_of(
            restore_colors=True, until="page", dates="exif", date="2024-05-31", joint="joint"), self.folder / "out")]
        self.assertEqual(of_date, ["import", "densify", *every])
        commands = {step.name: " ".join(step.command) for step in reconstruct_steps.steps(options_of(
            restore_colors=True, until="page", without="texture",
            densify="--iters 1 --pinhole-export=e --report r.json"), self.folder / "out")}
        restored = f"--colors {self.folder}/out/restored"
        for name in ("restored-cloud", "map", "page"):
            self.assertIn(restored, commands[name], name)
        self.assertIn(f"-p {self.folder}/out/scene_restored.ply", commands["page"])
        self.assertIn("--iters 1 --colors", commands["restored-cloud"])
        self.assertNotIn(restored, commands["raw-map"])
        masked = {step.name: " ".join(step.command) for step in reconstruct_steps.steps(options_of(
            restore_colors=True, until="page", masks="masks", colors="--light lamp"), self.folder / "out")}
        masks = f"--mask-path {self.folder}/out/colmap_masks"
        self.assertTrue(masked["colors"].endswith(f"{masks} --light lamp"), masked["colors"])
        for name in ("restored-cloud", "texture", "map", "raw-map"):
            self.assertIn(masks, masked[name])

    def test_photographs_without_water_are_matched_again(self):
        for words, expected in ((["--match-restored"], "is only for --restore-colors"),
                                (["--restore-colors", "--match-restored", "--densify=--match-restored 1"],
                                 "--densify: --match-restored contradicts"),
                                (["--restore-colors", "--match-restored", "--mesh=-p a.ply"], "--mesh: -p contradicts"),
                                (["--restore-colors", "--match-restored", "--cluster", "local"], "--cluster")):
            self.assertIn(expected, self.refused(*words))
        every = {step.name: " ".join(step.command) for step in reconstruct_steps.steps(options_of(
            restore_colors=True, match_restored=True, until="page", truth="truth.ply", earlier="old/mesh.ply"),
            self.folder / "out")}
        self.assertEqual(list(every)[7:], ["mesh", "refine-mesh", "colors", "restored-cloud", "restored-mesh",
                                           "restored-refine-mesh", "texture", "compare", "map", "raw-map", "page",
                                           "evaluate"])
        out = self.folder / "out"
        self.assertIn(f"-m {out}/scene_dense_refined.ply", every["colors"])
        self.assertIn(f"--colors {out}/restored --match-restored 1 -o {out}/scene_restored.mvs",
                      every["restored-cloud"])
        self.assertIn(f"-i {out}/scene_restored.mvs -o {out}/scene_restored_mesh.ply", every["restored-mesh"])
        self.assertIn(f"-m {out}/scene_restored_mesh.ply -o {out}/scene_restored_refined.ply "
                      f"--refractive 1 --colors {out}/restored", every["restored-refine-mesh"])
        self.assertIn(f"--other {out}/scene_restored_refined.ply", every["compare"])
        self.assertIn(f"-p {out}/scene_restored.ply", every["page"])
        self.assertIn(f"-i {out}/scene_restored.ply", every["evaluate"])
        for name in ("texture", "raw-map"):
            self.assertIn(f"-m {out}/scene_restored_refined.ply", every[name])
        names = [step.name for step in reconstruct_steps.steps(options_of(
            restore_colors=True, match_restored=True, until="texture", without="refine-mesh"), out)]
        self.assertNotIn("restored-refine-mesh", names)
        self.assertIn("restored-mesh", names)

    def test_the_cloud_becomes_las(self):
        out = self.folder / "out"
        self.succeeds("--without", "page")
        said = self.succeeds("--without", "page", "--las")  # a run that is done makes nothing else
        self.assertEqual(said.count("done before"), 11)
        self.assertEqual(self.commands()[-1], f"TransformScene -i {out}/scene_dense.ply -o {out}/scene_dense.las")
        self.assertIn(f"Cloud: {out}/scene_dense.ply   LAS: {out}/scene_dense.las   Mesh:", said)
        self.assertIn("Of an earlier run, not of this one: scene_dense.las",
                      self.succeeds("--without", "page", "--densify=--iters 2"))
        self.assertEqual(self.done_before("--until", "cloud", "--las", "--densify=--iters 2"), 7)
        restored = list(reconstruct_steps.steps(options_of(restore_colors=True, until="page", las=True), out))[-1]
        self.assertEqual(restored.command[1:], ["-i", f"{out}/scene_restored.ply", "-o", f"{out}/scene_restored.las"])
        self.assertEqual(self.refused("--until", "poses", "--las"),
                         "--las: is for the cloud, which --until poses does not make")
        (self.folder / "TransformScene").unlink()
        self.assertIn("TransformScene not found", self.refused("--las"))

    def test_maps_and_las_state_the_reference_system(self):
        given = {"las": True, "epsg": 32617, "until": "page", "earlier": "old/mesh.ply"}
        commands = {step.name: " ".join(step.command) for step in reconstruct_steps.steps(
            options_of(**given), self.folder / "out")}
        for name in ("map", "compare", "las"):
            self.assertIn("--epsg 32617", commands[name])
            self.assertNotIn("--like", commands[name])
        own = {step.name: " ".join(step.command) for step in reconstruct_steps.steps(
            options_of(**given, map="--epsg 1"), self.folder / "out")}
        self.assertTrue(own["map"].endswith("--epsg 1") and "32617" not in own["map"], own["map"])
        self.assertIn("neither --control nor --scale-from positions:", self.refused("--epsg", "32617"))
        self.write("known.txt", "0.png 1 2 3\n")
        known = ["--scale-from", "positions:known.txt"]
        self.assertIn("must be from 0 to", self.refused("--epsg", "-1", *known))
        for until in ("poses", "cloud"):
            self.assertEqual("--epsg 32617: is for maps, LAS and --control, which this run does not have",
                             self.refused("--epsg", "32617", *known, "--until", until))
        self.put_script("TransformScene", "echo \"TransformScene: $5 $6: is wrong\" >&2; exit 1")
        self.assertEqual("--epsg 32617: is wrong", self.refused("--epsg", "32617", *known))

    def test_control_points_are_transformed_to_the_reference_system(self):
        command = lambda **changes: " ".join(next(step.command for step in reconstruct_steps.steps(
            options_of(until="page", targets="targets.json", **changes), self.folder / "out")
            if step.name == "refine"))
        self.assertIn("--control gcp.csv --epsg 32617", command(control="gcp.csv", epsg=32617))
        self.assertNotIn("--epsg", command(control="gcp.csv"))
        self.assertNotIn("--epsg", command(scale_from="positions:known.txt", epsg=32617))
        self.write("targets.json", "{}")
        self.write("gcp.csv", "")
        given = ["--epsg", "32617", "--targets", "targets.json", "--control", "gcp.csv"]
        self.succeeds(*given, "--until", "poses")  # the code names the frame of the poses
        self.assertIn("--refine-poses --epsg 32618: contradicts --epsg 32617",
                      self.refused(*given, "--refine-poses=--epsg 32618"))

    def test_maps_are_cut_at_a_boundary(self):
        plot, out = self.write("plot.geojson", "{}"), self.folder / "out"
        self.succeeds("--boundary", "plot.geojson")
        self.assertIn(f" --boundary {plot}", self.command_of("MapSurface"))
        self.assertEqual("\n".join(self.commands()).count("--boundary"), 1)
        plot.write_text("other")
        self.assertEqual(self.done_before("--boundary", "plot.geojson"), 10)
        targets = ["--targets", self.write("targets.json", "{}"), "--boundary-targets", "1,target 2,3"]
        self.succeeds(*targets)
        self.assertIn(f" --boundary-targets 1,target 2,3 --target-places {out}/refined/target_places.json",
                      self.command_of("MapSurface"))
        self.succeeds(*targets, "--map=--boundary-targets 4,5,6")
        self.assertEqual(self.command_of("MapSurface").count("--boundary-targets"), 1)

    def test_a_boundary_for_one_program_replaces_that_of_all(self):
        def map_command(**given):
            return next(" ".join(step.command) for step in reconstruct_steps.steps(
                options_of(until="page", **given), self.folder / "out") if step.name == "map")
        by_targets, by_file = map_command(boundary_targets="1,2,3"), map_command(boundary="all.geojson")
        self.assertIn("--target-places", by_targets)
        own = map_command(boundary_targets="1,2,3", map="--boundary own.geojson")
        self.assertEqual(own, by_file.replace("all.geojson", "own.geojson"))
        own = map_command(boundary="all.geojson", map="--boundary-targets 4,5,6")
        self.assertTrue(own.endswith("--boundary-targets 4,5,6") and "all.geojson" not in own, own)
        # The map states the system.
        self.assertNotIn("--epsg", map_command(epsg=32617, boundary="all.geojson", map="--boundary-map a.dem.tif"))

    def test_a_comparison_is_cut_by_targets_of_the_earlier_survey(self):
        self.write("before/scene_dense_mesh.ply", "")
        plot, targets = self.write("plot.geojson", "{}"), self.write("targets.json", "{}")
        options = ["--earlier", "before", "--without", "page", "--targets", targets]
        self.assertNotIn("--boundary", self.compared(*options, "--boundary", plot))
        by_targets = [*options, "--boundary-targets", "1,2,3"]
        self.assertNotIn("--boundary", self.compared(*by_targets))
        places = self.write("before/refined/target_places.json", "{}")
        self.assertIn(f" --boundary-targets 1,2,3 --target-places {places}", self.compared(*by_targets))
        self.assertTrue(self.compared(*options, "--boundary", plot, f"--compare=--boundary {plot}").endswith(
            f" --boundary {plot}"))

    def test_a_wrong_boundary_is_refused(self):
        self.write("plot.geojson", "{}")
        targets = ["--targets", self.write("targets.json", "{}")]
        for told, *options in (
                ("--boundary none: file not found", "--boundary", "none"),
                ("--boundary-targets contradicts --boundary", *targets, "--boundary", "plot.geojson",
                 "--boundary-targets", "1,2,3"),
                ("--boundary-targets 1,2,3: needs --targets", "--boundary-targets", "1,2,3"),
                ("--boundary-targets 1,2,: must be three or more labels", *targets, "--boundary-targets", "1,2,"),
                ("--boundary-targets 1,,2,3: has an empty label", *targets, "--boundary-targets", "1,,2,3"),
                (f"--boundary {self.folder}/plot.geojson: is for the maps, which this run does not make",
                 "--boundary", "plot.geojson", "--without", "map")):
            self.assertIn(told, self.refused(*options))

    def test_an_earlier_survey_is_compared(self):
        self.write("before/scene_dense_mesh.ply", "")
        said = self.succeeds("--earlier", "before", "--without", "refine-mesh,texture,map,page")
        out, commands = self.folder / "out", self.commands()
        self.assertEqual(commands[-1], f"CompareSurveys -i {self.folder}/before/scene_dense_mesh.ply "
                         f"--other {out}/scene_dense_mesh.ply -o {out}/scene --align icp")
        self.assertEqual([line for line in commands for name in ("RefineMesh", "TextureMesh", "MapS")
                          if line.startswith(name)], [])
        self.assertIn(f"Mesh: {out}/scene_dense_mesh.ply   Changes: {out}/scene.change.*   Report:", said)
        self.write("before/scene_dense_refined.ply", "")
        self.write("before/scene_dense.mvs", "")
        self.ended("--earlier", "before", "--without", "map,page", "--compare=--align none")
        commands = self.commands()
        self.assertEqual(commands[-1], f"CompareSurveys -i {self.folder}/before/scene_dense_refined.ply "
                         f"--other {out}/scene_dense_refined.ply -o {out}/scene --scene "
                         f"{self.folder}/before/scene_dense.mvs --other-scene {out}/scene_dense.mvs "
                         "--align none")

    def test_an_earlier_survey_with_the_same_targets_is_aligned_by_them(self):
        self.write("before/scene_dense_mesh.ply", "")
        targets, options = self.write("targets.json", "{}"), ["--earlier", "before", "--without", "map,page"]
        by_ground = lambda *more: self.assertIn("--align icp", self.compared(*options, *more))
        by_ground("--targets", targets)
        places = self.write("before/refined/target_places.json", "{}")
        by_ground()
        files = f"--targets {places} --other-targets {self.folder}/out/refined/target_places.json"
        self.assertIn(f"--align auto {files}", self.compared(*options, "--targets", targets))
        told = self.compared(*options, "--targets", targets, "--compare=--align none")
        self.assertTrue(told.endswith(f"-o {self.folder}/out/scene --align none"), told)
        self.assertEqual(self.done_before(*options, "--targets", targets), 10)
        self.assertEqual(self.done_before(*options, "--targets", targets), 11)
        places.write_text("other")
        self.assertEqual(self.done_before(*options, "--targets", targets), 10)

    def compared(self, *options):
        """The command of CompareSurveys."""
        self.succeeds(*options)
        return self.command_of("CompareSurveys")

    def test_maps_lie_in_the_coordinates_of_the_earlier_survey(self):
        mesh = self.write("before/scene_dense_mesh.ply", "")
        heights, ortho = (self.folder / "before" / f"scene_map.{kind}.tif" for kind in ("dem", "ortho"))
        out, options = self.folder / "out", ["--earlier", "before"]
        self.succeeds(*options)
        self.assertIn(f" --like {out}/scene.change.json", self.command_of("MapSurface"))
        self.assertNotIn("--like", self.command_of("CompareSurveys"))
        page = lambda **given: next(" ".join(step.command) for step in reconstruct_steps.steps(options_of(
            until="page", earlier=str(mesh), **given), out) if step.name == "page")
        self.assertNotIn("--earlier-map", page())
        heights.write_text("")
        ortho.write_text("")
        self.succeeds(*options)
        self.assertIn(f" --like {heights}", self.command_of("CompareSurveys"))
        for given in ({}, {"epsg": 32617}, {"compare": "--boundary plot.geojson"}):
            self.assertIn(f" --earlier-map {self.folder}/before/scene_map", page(**given))
        self.assertNotIn("--earlier-map", page(compare="--up 0,0,1"))
        heights.write_text("other")
        self.assertEqual(self.done_before(*options), 10)
        self.succeeds(*options, "--map=--up 0,0,1", "--compare=--up 0,0,1")
        for program in ("CompareSurveys", "MapSurface"):
            self.assertNotIn("--like", self.command_of(program))
        os.utime(mesh, (heights.stat().st_mtime + 9,) * 2)  # of another run than the map
        self.assertNotIn("--earlier-map", page())

    def test_another_scene_of_the_earlier_survey_is_compared_again(self):
        self.write("before/scene_dense_mesh.ply", "")
        scene = self.write("before/scene_dense.mvs", "")
        options = ["--earlier", "before", "--without", "map,page"]
        self.assertEqual([self.done_before(*options) for _ in range(2)], [0, 11])
        scene.write_text("other")
        self.assertEqual(self.done_before(*options), 10)

    def test_its_own_mesh_is_no_earlier_survey(self):
        self.succeeds("--without", "map,page")
        for earlier in ("out", "out/scene_dense_mesh.ply"):
            self.assertIn("this run replaces this mesh; give another --output",
                          self.refused("--earlier", earlier, "--without", "map,page"))
        # A copy beside it that no step writes is an earlier survey.
        self.write("out/scene_dense_backup.ply", "")
        self.succeeds("--earlier", "out/scene_dense_backup.ply", "--without", "map,page")


if __name__ == "__main__":
    main()
