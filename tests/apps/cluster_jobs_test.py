# SPDX-License-Identifier: GPL-3.0-or-later
"""What `reconstruct --cluster` asks Slurm for, with stand-ins for Slurm's commands."""

import argparse
import json

from pipeline_folder import InFolder, options_of
from programs import main

from axial_pipeline import cluster, jobs, one_step, reconstruct_options, reconstruct_steps, step_kinds, steps
from axial_pipeline.failure import Failure


class SlurmCommands(InFolder):
    def setUp(self):
        super().setUp()
        self.put_on_path()

    def test_jobs_of_this_run_are_cancelled(self):
        mine, other = jobs.code_of("/out"), jobs.code_of("/other")
        self.put_script("squeue", f"echo 3 depth-photometric-1of2-{mine}; echo 4 mesh-{other}; "
                        f"echo 5 a name; echo 16 plan-{mine}")
        self.put_script("scancel", f"echo $* >> {self.folder / 'cancelled'}")
        cluster.cancel_jobs("/out")
        self.assertEqual((self.folder / "cancelled").read_text(), "3 16\n")
        self.put_script("squeue", f"echo 4 mesh-{other}")
        cluster.cancel_jobs("/out")
        self.assertEqual((self.folder / "cancelled").read_text(), "3 16\n")
        self.put_script("squeue", "echo no controller >&2; exit 1")
        self.assertIn("squeue: no controller: ", self.said_by(cluster.cancel_jobs, "/out"))

    def test_the_largest_node_is_one_node(self):
        given = argparse.Namespace(cluster="slurm")
        for listed, cpus, memory in (("128 256000+\n8 2000000", 128, 256000),
                                     ("16 64000\n64 32000+", 16, 64000),
                                     ("4 16000\n8+ 8000", 8, 8000)):
            self.put_script("sinfo", f"echo '{listed}'")
            self.assertEqual(cluster.largest_node(given), {"cpus": cpus, "memory_mb": memory})


class Jobs(InFolder):
    def setUp(self):
        super().setUp()
        self.put_on_path()
        self.put_script("colmap", "exit 0")

    def survey(self, images=2, **more):
        """The jobs of a run with stand-ins for COLMAP and for the plan."""
        lens = self.write("cameras.txt", "1 PINHOLE 640 480 500 500 320 240\n")
        plan = {"parts": 3, "stages": ["photometric", "geometric1"], "threads": 16,
                "per_part": {stage: {"cpu_seconds": 9600, "memory_mb": 1000}
                             for stage in ("photometric", "geometric1")},
                "fusion": {"cpu_seconds": 9600, "memory_mb": 1000}}
        self.write(jobs.PLAN, json.dumps(plan))
        given = options_of(**{"output": str(self.folder), "lens": str(lens), "lenses": [str(lens)], "until": "cloud",
                              "matcher": "exhaustive", "lens_model": "OPENCV", "programs": "bin", **more})
        return jobs.Survey({"given": vars(given), "images": images,
                            "node": {"cpus": 64, "memory_mb": 10**6}}, reconstruct_steps.steps)

    def test_programs_that_plan_their_memory_keep_to_their_job(self):
        self.assertEqual(one_step.limits_of(["bin/CompareSurveys", "--max-threads=1"], 2, 1000),
                         ["--max-memory", "800"])
        self.assertEqual(one_step.limits_of(["bin/MapSurface", "--max-t", "1", "--max-mem=9"], 2, 1000), [])
        self.assertEqual(one_step.limits_of(["bin/ViewScene"], 2, 1000), [])

    def test_steps_of_restored_colours_are_jobs(self):
        survey = self.survey(until="texture", restore_colors=True, tiles=3)
        for name, before in (("colors", "refine-mesh"), ("restored-cloud", "colors"), ("texture", "restored-cloud")):
            self.assertEqual(survey.job(name).needs, [steps.record_file(before)])
        self.assertEqual(survey.asked("restored-cloud"), survey.asked("densify"))
        self.assertEqual(survey.tiles_of("restored-cloud"), [])
        self.assertEqual(one_step.limits_of(survey.step("colors")[0].command, 2, 1000),
                         ["--max-threads", "2", "--max-memory", "800"])

    def test_only_fusion_exports(self):
        for export in ("--pinhole-export export", "--pinhole-export=export", "--pinhole export"):
            survey = self.survey(densify=f"--iters 2 {export} --tiles 4")
            for name, more in (("plan", ["--plan", str(self.folder / jobs.PLAN)]),
                               ("depth-geometric1-2of3", ["--until", "geometric1", "--part", "2/3"])):
                words = survey.step(name)[0].command
                self.assertEqual(words[words.index("--iters"):],
                                 ["--iters", "2", "--tiles", "4", *more])
            self.assertIn(export, " ".join(survey.step("densify")[0].command))

    def test_tiles_are_jobs(self):
        survey = self.survey(tiles=3, until="mesh", mesh="-d 4", densify="--pinhole-export e")
        self.assertEqual(survey.tiled, ["densify", "mesh"])
        words = survey.step("mesh-tile-2of3")[0].command
        self.assertEqual(words[-6:], ["--tiles", "3", "-d", "4", "--tile", "2/3"])
        words = survey.step("densify-tile-1of3")[0].command
        self.assertEqual(words[-4:], ["--tiles", "3", "--tile", "1/3"])
        self.assertEqual(survey.before_tile_of_mesh("1of3"), [steps.record_file("densify")])
        self.assertEqual(survey.before_tile_of_mesh("3of3"), [steps.record_file("mesh-tile-1of3")])
        self.assertEqual(self.survey(until="mesh").tiled, [])
        self.assertEqual(self.survey(tiles=3).tiled, ["densify"])

    def test_options_that_contradict_tiles_are_refused(self):
        for tiles, name, words in ((2, "mesh", "-d 4 --decimate=0.5"), (2, "densify", "--tiles 3"),
                                   (2, "mesh", "--dec 0.5"), (2, "densify", "--fusion-t=3"),
                                   (1, "texture", "--tiles 4"), (1, "densify", "--tile 1/2")):
            given = argparse.Namespace(**{"densify": "", "mesh": "", "texture": "", name: words},
                                       tiles=tiles)
            with self.assertRaisesRegex(Failure, f"--{name}: --.* contradicts --tiles {tiles}"):
                reconstruct_options.check_tiles(given)
        reconstruct_options.check_tiles(argparse.Namespace(densify="--tiles 3", mesh="--tiles 4",
                                                   texture="", tiles=1))

    def test_the_result_of_tiles_is_any_of_their_files(self):
        tiles = steps.Tiles(self.folder, "scene_textured.tile*-12.glb")
        self.write("scene_textured.tile1-2.glb", "")
        self.assertFalse(tiles.exists())
        self.write("scene_textured.tile7-12.glb", "")
        self.assertTrue(tiles.exists())

    def minutes(self, name, **options):
        job = self.survey(**options).job(name)
        return [job.resources["runtime"](None, attempt) for attempt in (1, 2)]

    def test_a_damaged_plan_is_made_again(self):
        survey, plan = self.survey(), self.folder / jobs.PLAN
        whole, record = json.loads(plan.read_text()), self.folder / steps.record_file("plan")
        record.write_text("{}")
        self.assertEqual(self.said_by(cluster.forget_damaged_plan, self.folder), "")
        self.assertTrue(record.exists())
        for content in ("", "{", "[]", "{}", "\xff", json.dumps({**whole, "parts": 0}),
                        json.dumps({**whole, "fusion": {"memory_mb": "much"}}),
                        json.dumps({**whole, "per_part": {}}), None):
            record.write_text("{}")
            plan.unlink(missing_ok=True) if content is None else plan.write_text(content)
            wildcards = argparse.Namespace(stage="photometric", part="whole")
            with self.assertRaisesRegex(Failure, "steps/plan.json: is damaged"):
                survey.depth.resources["mem_mb"](wildcards, 1)
            self.assertEqual(self.said_by(cluster.forget_damaged_plan, self.folder),
                             f"{plan}: is damaged or missing, and is made again\n")
            self.assertFalse(plan.exists() or record.exists())
        self.assertEqual(self.said_by(cluster.forget_damaged_plan, self.folder), "")

    def test_a_job_matches_in_a_cascade(self):
        step, _ = self.survey(matcher="cascade").step("matches")
        self.assertEqual(step.command[:4], ["colmap", "matches_importer", "--database_path",
                                            str(self.folder / "overview.db")])
        self.assertEqual(step.writes, step_kinds.KINDS["matches"].writes)

    def test_time_of_matching_grows_with_the_pairs(self):
        # 499,500 pairs of 0.9 s on 16 processors, twice: 936.6 minutes
        self.assertEqual(self.minutes("matches", images=1000), [997, 1994])
        for matcher in ("sequential", "cascade"):
            self.assertEqual(self.minutes("matches", images=1000, matcher=matcher), [1060, 2120])

    def test_time_of_the_check_of_all_maps_grows_with_the_images(self):
        def minutes(part, images):
            wildcards = argparse.Namespace(stage="photometric", part=part)
            return self.survey(images).depth.resources["runtime"](wildcards, 1)

        # 10 minutes, and four times 9600 s on 16 processors
        self.assertEqual([minutes("1of3", images) for images in (300, 3000)], [50, 50])
        self.assertEqual([minutes("whole", images) for images in (300, 3000)], [51, 60])

    def test_records_of_other_depth_maps_are_removed(self):
        todo = self.survey().steps
        chain = {"chain": steps.digest(steps.chain_to("densify", todo)), "seconds": 1}
        records = {"plan": json.dumps(chain), "depth-photometric-1of3": json.dumps(chain),
                   "depth-photometric-2of3": '{"chain": ', "depth-photometric-3of3": "",
                   "depth-photometric-whole": json.dumps({**chain, "chain": "other"}),
                   "densify-tile-1of3": json.dumps(chain),
                   "densify-tile-2of3": json.dumps({**chain, "chain": "other"})}
        for name, record in records.items():
            self.write(steps.record_file(name), record)
        cluster.forget_what_changed(todo, self.folder)
        self.assertEqual({path.name for path in (self.folder / "steps").glob("*.done.json")},
                         {"plan.done.json", "depth-photometric-1of3.done.json",
                          "densify-tile-1of3.done.json"})


if __name__ == "__main__":
    main()
