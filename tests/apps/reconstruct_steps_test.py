# SPDX-License-Identifier: GPL-3.0-or-later
"""apps/pipeline/reconstruct with stand-ins for the programs: its commands, its steps, and what happens
when it is stopped."""

import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import sys
import unittest

from programs import main
from reconstruct_test import STEPS
from stand_ins import SCRIPT, StandIns


class WithStandIns(StandIns):
    """The whole script, with stand-in programs that end at once or sleep."""

    def test_takes_its_command_along_when_killed_alone(self):
        process, pipe = self.held_at("DensifyPointCloud")
        process.kill()
        self.assertEqual(self.next_of(pipe), b"")
        (self.folder / "pipe-DensifyPointCloud").unlink()
        again = self.ended()
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(again.stdout.count("done before"), 6, again.stdout)

    def test_takes_a_wrappers_child_along_however_it_ends(self):
        """Tried with the first program, a middle one and the last one."""
        for program in ("colmap", "RefinePoses", "MapSurface"):
            for end in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
                process, pipe = self.held_at(program, "child-pipe")
                process.send_signal(end)
                self.assertEqual(self.next_of(pipe), b"", (program, end))
                process.wait(timeout=30)
                (self.folder / f"child-pipe-{program}").unlink()
        self.assertNotIn("ended", (self.folder / "commands").read_text().splitlines())
        again = self.ended()
        self.assertEqual(again.returncode, 0, again.stderr)

    def test_prints_nothing_into_files_where_output_is_closed(self):
        command = [sys.executable, str(SCRIPT), "--images", "images", "--lens", "lens",
                   "--housing", "housing", "-o", "out", "--programs", "."]
        ended = subprocess.run(["bash", "-c", 'exec "$@" 0>&- 1>&- 2>&-', "bash", *command],
                               cwd=self.folder, timeout=60,
                               env={**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"})
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
        run_were = (self.folder / "commands").read_text().splitlines()
        self.assertEqual([" ".join([pathlib.Path(program).name, *arguments]) for program, *arguments
                          in map(shlex.split, printed)], run_were)

    def test_records_say_which_version_made_a_step(self):
        self.assertEqual(self.ended().returncode, 0)
        records = self.folder / "out" / "steps"
        for step, program in (("features", "colmap"), ("map", "MapSurface")):
            record = json.loads((records / f"{step}.done.json").read_text())
            self.assertEqual(record["version"], f"{program} 7.8")

    def test_the_page_shows_the_run_and_is_made_once(self):
        programs = self.folder / "prefix" / "bin"
        programs.mkdir(parents=True)
        page = self.folder / "prefix" / "share" / "axialmvs" / "view" / "viewer.js"
        page.parent.mkdir(parents=True)
        page.touch()
        for program in self.folder.glob("[A-Z]*"):
            shutil.copy(program, programs)
        with (programs / "ViewScene").open("a") as script:
            script.write("mkdir -p out/page; touch out/page/index.html; cp out/run.json shown.json\n")
        with (programs / "DensifyPointCloud").open("a") as script:
            script.write("echo '12:34:56 [DensifyPointCloud] warning: far away'\n" * 2 +
                         "echo '12:34:56 [DensifyPointCloud] no warning: a result'\n")
        with (self.folder / "colmap").open("a") as script:
            script.write('[ "$1" != mapper ] || echo "W20240131 01:02:03.456789  12 ba.cc:7] no convergence"\n')
        again = ["--programs", str(programs), "--densify=--iters 3", "--truth", "lens"]
        shutil.copy(self.folder / "MapSurface", programs / "EvaluateReconstruction")
        with (programs / "EvaluateReconstruction").open("a") as script:
            script.write("echo '{\"accuracy\": {\"mean\": 0, \"median\": 0, \"count\": 1}}' > "
                         "out/evaluation.json\n")
        mine = self.folder / "out" / "page" / "index.html"
        mine.parent.mkdir(parents=True)
        mine.write_text("mine")
        refused = self.ended(*again)
        self.assertEqual((refused.returncode, mine.read_text()), (1, "mine"))
        self.assertIn("page: no record of an earlier run names this file", refused.stderr)
        self.assertFalse((self.folder / "commands").exists())
        shutil.rmtree(self.folder / "out")

        first = self.ended(*again)
        self.assertEqual(first.returncode, 0, first.stderr)
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
        command = next(shlex.split(line) for line in (self.folder / "commands").read_text().splitlines()
                       if line.startswith("ViewScene "))
        out = str(self.folder / "out")
        for option, value in (("--map", f"{out}/scene_map"), ("--run", f"{out}/run.json"),
                              ("--depth-maps", out)):
            self.assertEqual(command[command.index(option) + 1], value)

        second = self.ended(*again)
        self.assertEqual(second.stdout.count("done before"), 13, second.stdout)
        third = self.ended(*again, "--page=--map other")
        self.assertEqual(third.stdout.count("done before"), 11, third.stdout)
        self.assertEqual((self.folder / "commands").read_text().count("--map "), 2)

    def test_other_options_redo_the_steps_after_them(self):
        names = [f"{number}.png" for number in range(3)]
        positions = self.folder / "positions.txt"
        positions.write_text("".join(f"{name} {len(name)} 0 {name[0]}\n" for name in names))
        options = ["--scale-from", f"positions:{positions}"]

        def done_before():
            ended = self.ended(*options)
            self.assertEqual(ended.returncode, 0, ended.stderr)
            return ended.stdout.count("done before")

        self.assertEqual(done_before(), 0)
        self.assertEqual(done_before(), 11)
        for option, kept in [("--map=--hillshade", 10), ("--texture=--outlier-threshold 0.1", 9),
                             ("--refine-mesh=--scales 1", 8), ("--mesh=--smooth 1", 7),
                             ("--densify=--resolution-level 1", 6)]:
            options.append(option)
            self.assertEqual(done_before(), kept, option)
        positions.write_text(positions.read_text() + "\n")
        self.assertEqual(done_before(), 4)
        options.append("--keep-all")
        self.assertEqual(done_before(), 2)
        options += ["--matcher", "spatial"]
        self.assertEqual(done_before(), 2)
        command = (self.folder / "commands").read_text().splitlines()[-9]
        self.assertIn(f"colmap spatial_matcher --database_path {self.folder}/out/database.db "
                      "--SpatialMatching.is_gps 0", command)
        positions.write_text(positions.read_text() + "\n")
        self.assertEqual(done_before(), 2)
        options += ["--matcher", "vocabulary", "--vocabulary", "lens"]
        self.assertEqual(done_before(), 2)
        self.assertEqual(done_before(), 11)

    def test_an_earlier_survey_is_compared(self):
        (self.folder / "before").mkdir()
        (self.folder / "before" / "scene_dense_mesh.ply").touch()
        said = self.ended("--earlier", "before", "--without", "refine-mesh,texture,map,page")
        self.assertEqual(said.returncode, 0, said.stderr)
        out, commands = self.folder / "out", (self.folder / "commands").read_text().splitlines()
        self.assertEqual(commands[-1], f"CompareSurveys -i {self.folder}/before/scene_dense_mesh.ply "
                         f"--other {out}/scene_dense_mesh.ply -o {out}/scene --align icp")
        self.assertEqual([line for line in commands for name in ("RefineMesh", "TextureMesh", "MapS")
                          if line.startswith(name)], [])
        self.assertIn(f"Mesh: {out}/scene_dense_mesh.ply   Changes: {out}/scene.change.*   Report:",
                      said.stdout)
        (self.folder / "before" / "scene_dense_refined.ply").touch()
        (self.folder / "before" / "scene_dense.mvs").touch()
        self.ended("--earlier", "before", "--without", "map,page", "--compare=--align none")
        commands = (self.folder / "commands").read_text().splitlines()
        self.assertEqual(commands[-1], f"CompareSurveys -i {self.folder}/before/scene_dense_refined.ply "
                         f"--other {out}/scene_dense_refined.ply -o {out}/scene --scene "
                         f"{self.folder}/before/scene_dense.mvs --other-scene {out}/scene_dense.mvs "
                         "--align none")

    def test_another_scene_of_the_earlier_survey_is_compared_again(self):
        (self.folder / "before").mkdir()
        (self.folder / "before" / "scene_dense_mesh.ply").touch()
        scene = self.folder / "before" / "scene_dense.mvs"
        options = ["--earlier", "before", "--without", "map,page"]
        scene.touch()
        self.assertEqual(self.ended(*options).stdout.count("done before"), 0)
        self.assertEqual(self.ended(*options).stdout.count("done before"), 11)
        scene.write_text("other")
        self.assertEqual(self.ended(*options).stdout.count("done before"), 10)

    def test_its_own_mesh_is_no_earlier_survey(self):
        self.assertEqual(self.ended("--without", "map,page").returncode, 0)
        for earlier in ("out", "out/scene_dense_mesh.ply"):
            said = self.ended("--earlier", earlier, "--without", "map,page")
            self.assertEqual(said.returncode, 1)
            self.assertIn("this run replaces this mesh; give another --output", said.stderr)
        # A copy beside it that no step writes is an earlier survey.
        (self.folder / "out" / "scene_dense_backup.ply").touch()
        said = self.ended("--earlier", "out/scene_dense_backup.ply", "--without", "map,page")
        self.assertEqual((said.returncode, said.stderr), (0, ""))

    def test_maps_of_other_options_do_not_keep_old_errors(self):
        self.assertEqual(self.ended().returncode, 0)
        errors = self.folder / "out" / "scene_map.sigma.tif"
        errors.touch()
        self.assertEqual(self.ended("--map=--image-noise 0").returncode, 0)
        self.assertFalse(errors.exists())

    def test_a_matcher_without_its_input_is_refused_at_once(self):
        for options, said in (
                (["spatial"], "--matcher spatial: none of the photographs in "
                 f"{self.folder / 'images'} have a GPS position (latitude, longitude and altitude); "
                 "give --scale-from positions:FILE or choose another --matcher"),
                (["vocabulary"], "--matcher vocabulary: needs --vocabulary FILE, a vocabulary tree "
                 "for COLMAP (docs/photographs.md)"),
                (["sequential", "--vocabulary", "lens"],
                 "--vocabulary lens: is only for --matcher vocabulary")):
            ended = self.ended("--matcher", *options)
            self.assertEqual((ended.returncode, ended.stdout, ended.stderr),
                             (1, "", f"reconstruct: {said}\n"))
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    main()
