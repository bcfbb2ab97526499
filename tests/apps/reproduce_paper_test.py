# SPDX-License-Identifier: GPL-3.0-or-later
"""ReproducePaper as users run it: all experiments with --quick, judged by their numbers."""

import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import unittest.mock

from programs import BIN, ProgramTest, contents, main, must, new_folder, read, read_json, run, slow, write

PROGRAM = "ReproducePaper"
STRIP = "completeness_transect_water_true"
DOCUMENTS = pathlib.Path(__file__).resolve().parents[2] / "docs" / "paper" / "documents.py"


def make_documents(python, *arguments):
    return subprocess.run([python, "-B", DOCUMENTS, *arguments], check=True, capture_output=True, text=True).stdout


def python_with_matplotlib():
    """This interpreter, or Debian's, whose packages may include python3-matplotlib."""
    known = lambda python: subprocess.run([python, "-c", "import matplotlib"],
                                          capture_output=True).returncode == 0
    return next(filter(known, (sys.executable, "/usr/bin/python3")))


class Measurements(unittest.TestCase):
    """All cases check the results of one run of the experiments that reconstruct nothing."""
    experiments = ("figure2", "runtime", "figure3", "figure4")
    bounds = {"figure2": 2, "runtime": 3, "figure4": 5}

    @classmethod
    def setUpClass(cls):
        cls.output = new_folder(cls.addClassCleanup)
        cls.folder = os.path.join(cls.output, "quick")
        cls.said = "".join(must(PROGRAM, experiment, "-o", cls.output, "--quick", timeout=1500)
                           for experiment in cls.experiments)
        make_documents(sys.executable, cls.folder, "--tables")

    def results(self, experiment):
        content = read_json(self.folder, experiment + ".json")
        self.assertTrue(content["quick"])
        return {name: part["result"] for name, part in content["parts"].items()}

    def test_projection_errors(self):
        parts = self.results("figure2")
        self.assertEqual(len(parts), 12)
        for name, part in parts.items():
            self.assertGreater(part["line_search"]["mean"], 0.24, name)
            self.assertLess(part["line_search"]["mean"], 0.29, name)
            self.assertLess(part["exact"]["largest"], 1e-3, name)
            for method in part.values():
                self.assertGreater(method["count"], 300_000)
                self.assertEqual(sum(method["bins"]) + method["beyond_bins"], method["count"])

    def test_run_times_stand_beside_errors(self):
        """Only the order of the times is checked, because other programs may run on the machine."""
        parts = self.results("runtime")
        self.assertEqual(len(parts), 2 * 2)
        for name, part in parts.items():
            times = {method: time["nanoseconds"] for method, time in part.items()
                     if method != "processor"}
            self.assertLess(2 * times["exact"], times["line_search_compact"], name)
            self.assertLess(2 * times["line_search_compact"], times["analytic"], name)
            self.assertLess(part["exact"]["mean_error"], 1e-3)
            self.assertGreater(part["line_search_compact"]["mean_error"], 0.2)

    def test_patch_errors(self):
        parts = self.results("figure4")
        self.assertEqual(len(parts), 2 * (15 + 5))
        for name, part in parts.items():
            warps = {warp: values["mean"] for warp, values in part["warps"].items()}
            self.assertGreater(part["centres"], 100, name)
            self.assertLess(warps["per_texel"], 1e-3, name)
            self.assertLess(warps["first_order"], warps["exact_centre"], name)
            if name.endswith("2048px") and "fov" not in name:
                self.assertLessEqual(warps["first_order"], 0.005, name)
        for name, papers in (("setup1_default", 0.475), ("setup1_fov_degrees_100", 0.706),
                             ("setup1_distance_mm_100", 0.462), ("setup1_tilt_degrees_6", 0.502),
                             ("setup1_plane_degrees_40", 0.487), ("setup2_default", 0.254)):
            mean = parts[name + "_2048px"]["warps"]["rounded"]["mean"]
            self.assertAlmostEqual(mean, papers, delta=0.1 * papers, msg=name)

    def test_exploded_patches(self):
        for name, part in self.results("figure3").items():
            self.assertGreater(max(part["errors"]["papers"]), 0.5, name)
            for warp, errors in part["errors"].items():
                self.assertEqual(len(errors), 50 * 50, name)
                self.assertGreater(sum(error >= 0 for error in errors), 80 * 25, warp)
            middles = [part["errors"]["first_order"][50 * row + column]
                       for row in range(2, 50, 5) for column in range(2, 50, 5)]
            self.assertLess(max(middles), 1e-9)

    def test_every_bound_has_its_verdict(self):
        """Times and poses may miss their bounds: other programs may run, and COLMAP varies."""
        for experiment, asked in self.bounds.items():
            rows = read(os.path.join(self.folder, experiment + "_verdicts.md")).decode().splitlines()
            self.assertEqual(len(rows), 2 + asked, experiment)
            for row in rows[2:]:
                self.assertRegex(row, r"\| (yes|no) \|$")
            if experiment in ("figure2", "figure4"):
                self.assertTrue(rows[2].endswith("| yes |"), rows[2])


@slow
class Quick(Measurements):
    """The same, and the experiments that reconstruct."""
    experiments = ("all",)
    bounds = {**Measurements.bounds, "reconstruction": 5}

    def test_reconstruction(self):
        parts = self.results("reconstruction")
        self.assertEqual(set(parts), {"seed1_colmap_poses", "seed1_true_poses"})
        colmap, true = parts["seed1_colmap_poses"], parts["seed1_true_poses"]
        self.assertEqual(colmap["images"], 4)
        self.assertEqual(len(colmap["clouds"]), 5)
        self.assertLess(colmap["centre_rms"], 0.1)
        self.assertEqual(set(colmap["photographs"]), {"air", "water"})
        self.assertEqual({name for name, cloud in colmap["clouds"].items() if "complete" in cloud},
                         {"air", "ours", "papers"})
        for name, cloud in colmap["clouds"].items():
            # ICP minimises the errors of a subset of points, so the mean of all may grow a little.
            self.assertLess(cloud["moved"]["mean"], 1.05 * cloud["mean"], name)
            self.assertGreater(cloud["points"], 10_000, name)
            # One pixel is 1 cm wide on the scene.
            self.assertLess(cloud["mean"], 0.02, name)
            if "complete" in cloud:
                self.assertEqual(set(cloud["complete"]), {"2", "3", "4"}, name)
                self.assertLess(cloud["complete"]["2"], cloud["complete"]["4"], name)
            # COLMAP's poses differ in each run and may move a whole cloud; then the median may
            # exceed the mean. In any distribution they differ by at most one standard deviation.
            self.assertLessEqual(abs(cloud["median"] - cloud["mean"]),
                                 math.sqrt(cloud["variance"]), name)
        # Water magnifies and narrows the view. In images this small, the loss of the paper's method
        # is hidden by other errors.
        self.assertLess(true["clouds"]["ours"]["mean"], 1.1 * true["clouds"]["air"]["mean"])
        self.assertLess(true["clouds"]["ours"]["median"], 0.004)
        self.assertGreater(true["scene_distance"], 2)
        maps_in_order = ("air", "ours", "papers")
        self.assertEqual(set(true["maps"]), set(maps_in_order))
        for name, maps in true["maps"].items():
            self.assertEqual(maps["pixels"], sum(ring["count"] for ring in maps["rings"]), name)
            self.assertLess(maps["median"], maps["mean"], name)
            self.assertAlmostEqual(maps["gross"] * maps["pixels"],
                                   sum(place["gross"] for place in maps["places"]), 3, name)
            self.assertTrue(0 < maps["within"] < 1 and 0 < maps["completeness"] < 1, name)
            self.assertEqual(maps["pixels"], sum(place["pixels"] for place in maps["places"]), name)
            *_, open_ground = maps["places"]
            self.assertLess(open_ground["mean"], maps["mean"], name)
            self.assertEqual(len(maps["phases"]), 8)
            self.assertGreater(sum(phase["count"] for phase in maps["phases"]), 10_000, name)
            for phase in maps["phases"]:
                # The largest shift measured is 0.01 px. Pixels off by over 0.5 px are left out.
                self.assertLess(abs(phase["shift"]), 0.05, name)
            self.assertEqual(len(maps["rings"]), 8)
        rings = [ring for ring in zip(*(true["maps"][name]["rings"] for name in maps_in_order))
                 if min(of["count"] for of in ring) >= 5000]
        self.assertGreater(len(rings), 5)
        for air, *refracted in rings:
            # If the port is ignored, depths change by a quarter.
            for ring in (air, *refracted):
                self.assertLess(abs(ring["median"]), 2e-3)
            for ring in refracted:
                self.assertLess(abs(ring["median"] - air["median"]), 1e-3)

    def test_times_are_kept_beside_the_parts_and_told(self):
        for experiment in ("figure3", "need"):
            folder = os.path.join(self.folder, "parts", experiment)
            parts = [name for name in os.listdir(folder) if name.endswith(".json")]
            seconds = [float(read(os.path.join(folder, name[:-5] + ".seconds"))) for name in parts]
            told = re.search(rf"{experiment} +(\d+) +([\d.]+) ", self.said)
            self.assertEqual(int(told[1]), len(parts))
            self.assertAlmostEqual(float(told[2]), sum(seconds), delta=0.1)

    def test_full_results_are_left_alone(self):
        self.assertEqual(os.listdir(self.output), ["quick"])

    def test_sensitivity(self):
        parts = self.results("sensitivity")
        self.assertEqual(set(parts), {"near_none", "near_distance_20mm", "near_tilt_2"})
        for name, part in parts.items():
            self.assertAlmostEqual(part["scene_distance"], 1, delta=0.2, msg=name)
            # ICP minimises the errors of a subset of points, so the mean of all may grow a little.
            self.assertLess(part["moved"]["mean"], 1.05 * part["as_it_lies"]["mean"], name)
        right = parts["near_none"]
        for name in ("near_distance_20mm", "near_tilt_2"):
            self.assertGreater(parts[name]["as_it_lies"]["mean"],
                               1.05 * right["as_it_lies"]["mean"], name)
        self.assertGreater(parts["near_tilt_2"]["moved"]["mean"], 1.5 * right["moved"]["mean"])

    def test_need(self):
        parts = self.results("need")
        self.assertEqual(set(parts), {"usual", "tilt_degrees_6", "second_survey_0.5"})
        for name, part in parts.items():
            self.assertGreater(part["range_ratio"], 1.2, name)
            self.assertEqual(part["port_distance"], 0.02)
            self.assertLess(part["ours"]["mean"], 0.01 * part["scene_distance"], name)
            self.assertAlmostEqual(part["tilt_degrees"], 6 if name == "tilt_degrees_6" else 0)
            self.assertEqual(part["fov_degrees"], 80)
            today = part["today"]
            self.assertEqual(today["images"] == 0, today["centre_rms"] is None, name)
            if today["images"] == 0:
                self.assertIsNone(today["moved"], name)
        # No lens model can absorb a port that is tilted by 6 degrees.
        tilted = parts["tilt_degrees_6"]
        self.assertGreater(tilted["today"]["moved"]["mean"], 1.2 * tilted["ours"]["mean"])
        self.assertAlmostEqual(parts["second_survey_0.5"]["scene_distance"],
                               0.5 * parts["usual"]["scene_distance"], delta=0.15)

    def test_nothing_is_left_of_the_intermediate_files(self):
        self.assertEqual(os.listdir(os.path.join(self.folder, "work")), [])

    def test_figures_are_drawn(self):
        folder = new_folder(self.addCleanup)
        for name in os.listdir(self.folder):
            if name.endswith(".json"):
                shutil.copy(os.path.join(self.folder, name), folder)
        make_documents(python_with_matplotlib(), folder)
        figures = {name: data for name, data in contents(folder).items() if name.endswith((".png", ".jpg"))}
        self.assertEqual(len(figures), 1 + 1 + 2 + 5 + 3 + 1)
        for name, content in figures.items():
            self.assertTrue(content.startswith((b"\x89PNG", b"\xff\xd8\xff")), name)
            self.assertGreater(len(content), 10_000, name)

    def test_tables_hold_the_numbers_of_the_json(self):
        table = read(os.path.join(self.folder, "figure2.md")).decode()
        for part in self.results("figure2").values():
            self.assertIn(f"| {part['line_search']['mean']:.3f} |", table)
        table = read(os.path.join(self.folder, "sensitivity.md")).decode()
        for part in self.results("sensitivity").values():
            self.assertIn(f" | {part['as_it_lies']['points']} | ", table)

    def test_nothing_finished_is_computed_again(self):
        """Measured times never repeat, so equal files show that nothing was measured again."""
        before = contents(self.folder)
        must(PROGRAM, "all", "-o", self.output, "--quick")
        self.assertEqual(contents(self.folder), before)


@slow
class WithoutPoses(ProgramTest):
    """If COLMAP's mapper finds no poses, that is a result. If the mapper breaks, the run fails."""

    def put_script(self, script, *names):
        write(self.path(*names), f"#!/bin/sh\n{script}\n")
        os.chmod(self.path(*names), 0o755)

    def need(self, mapper, program=PROGRAM):
        self.put_script(f"if [ $1 = mapper ]; then {mapper}; fi", "bin", "colmap")
        folders = self.path("bin") + os.pathsep + os.environ["PATH"]
        with unittest.mock.patch.dict(os.environ, PATH=folders):
            return run(program, "need", "--quick", "--part", "usual", "-o", self.path("a"))

    def parts(self):
        """The files of the parts that are done."""
        folder = self.path("a", "quick", "parts", "need")
        return sorted(os.path.join(folder, name) for name in os.listdir(folder) if name.endswith(".json"))

    def test_only_what_colmap_did_not_find_is_kept_for_the_programs_that_made_it(self):
        said = "echo ERROR: failed to create sparse model"
        for mapper, how in (("kill -9 $$", "signal 9"), ("exit 1", "exit code 1"),
                            (said + "; exit 3", "exit code 3")):
            result = self.need(mapper)
            self.assertEqual(result.returncode, 1, mapper)
            self.assertIn("colmap: " + how, result.stderr)
        self.assertEqual(os.listdir(self.path("a", "quick", "parts", "need")), [])
        for program, count in ((PROGRAM, 1), (PROGRAM, 1), (self.other_programs(AlignModel="exit 1"), 2)):
            self.assertEqual(self.need(said + "; exit 1", program).returncode, 0)
            self.assertEqual(len(self.parts()), count)
        for part in self.parts():
            self.assertEqual(read_json(part)["result"]["today"],
                             {"images": 0, "centre_rms": None, "as_it_lies": None, "moved": None})

    def other_programs(self, **scripts):
        """A copy of ReproducePaper beside which `scripts` replace the programs of these names.
        Returns its path."""
        os.makedirs(self.path("other"))
        for name in os.listdir(BIN):
            os.symlink(os.path.join(BIN, name), self.path("other", name))
        os.remove(self.path("other", PROGRAM))
        shutil.copy(os.path.join(BIN, PROGRAM), self.path("other"))
        for name, script in scripts.items():
            os.remove(self.path("other", name))
            self.put_script(script, "other", name)
        return self.path("other", PROGRAM)

    def test_another_program_repeats_its_own_step_and_not_colmaps(self):
        """COLMAP's poses are not reproducible; they are kept as long as they are valid."""
        count = "echo >> " + self.path("aligned") + "; exec " + os.path.join(BIN, "AlignModel")
        import_one = "exec " + os.path.join(BIN, "InterfaceCOLMAP") + ' "$@"'
        other = self.other_programs(
            AlignModel=count + ' "$@"',
            InterfaceCOLMAP='case "$*" in *today-dense*) exit 1;; esac; ' + import_one)
        finds_the_truth = ("echo >> " + self.path("mapped") + '; while [ "$1" != --output_path ]; '
                           'do shift; done; cp -r "$2/../../sparse" "$2/0"')

        def runs(exit_code):
            self.assertEqual(self.need(finds_the_truth, other).returncode, exit_code)
            return [len(read(self.path(name))) for name in ("mapped", "aligned")]

        self.assertEqual(runs(1), [1, 1])
        self.assertEqual(runs(1), [1, 1])
        self.put_script(count + ' "$@" # new', "other", "AlignModel")
        self.assertEqual(runs(1), [1, 2])
        self.put_script(import_one, "other", "InterfaceCOLMAP")
        self.assertEqual(runs(0), [1, 2])


class Figure3(ProgramTest):
    """Parts and threads, tested with the smallest experiment."""

    def all_bytes(self, folder):
        """The contents of all files except the measured times."""
        return {name: data for name, data in contents(self.path(folder)).items() if not name.endswith(".seconds")}

    def test_same_bytes_for_any_number_of_threads(self):
        for folder, threads in (("a", 1), ("b", 3)):
            self.succeeds(PROGRAM, "figure3", "-o", self.path(folder), "--max-threads", threads)
        self.assertEqual(self.all_bytes("a"), self.all_bytes("b"))

    def test_parts_one_by_one_are_the_whole(self):
        self.succeeds(PROGRAM, "figure3", "-o", self.path("a"))
        self.succeeds(PROGRAM, "figure3", "-o", self.path("b"), "--part", "setup2")
        self.assertEqual(os.listdir(self.path("b")), ["parts"])
        self.succeeds(PROGRAM, "figure3", "-o", self.path("b"), "--part", "setup1")
        self.assertEqual(self.all_bytes("a"), self.all_bytes("b"))

    def test_wrong_input(self):
        write(self.path("file"), "")
        here = ("-o", self.path("a"))
        self.refuses_each(
            (PROGRAM,), ("'figure9' is not an experiment", "figure9", *here), ("no output folder", "figure3"),
            ("'figure4' belongs to no option", "figure3", "figure4", *here),
            ("cannot be created", "figure3", "-o", "/proc/none"),
            ("cannot be created", "figure3", "-o", self.path("file")),
            ("no part has a name that begins", "figure3", *here, "--part", "setup3"),
            ("not for all", "all", *here, "--part", "setup1"))

    def test_help_without_an_experiment(self):
        result = run(PROGRAM)
        self.assertEqual(result.returncode, 1)
        self.assertIn("sensitivity, need, all or completeness", result.stdout)


class Completeness(unittest.TestCase):
    """All cases check the results of one run on a small strip of images behind the port."""

    @classmethod
    def setUpClass(cls):
        folder = new_folder(cls.addClassCleanup)
        cls.work, cls.output = os.path.join(folder, "work"), os.path.join(folder, "results")
        cls.completeness()

    @classmethod
    def completeness(cls, *more):
        must(PROGRAM, "completeness", "--preset", "transect", "--scene-options", "--views 4 --width 256 --height 192 "
             "--coarseness 5 --samples 1", "--seeds", "11", "-o", cls.output, "--work", cls.work, *more)

    def results(self):
        return read_json(self.output, STRIP + ".json")["parts"]["seed11"]["result"]

    def test_the_table_is_printed_and_written(self):
        made = make_documents(sys.executable, self.output, "--tables")
        text = read(os.path.join(self.output, STRIP + ".md")).decode()
        self.assertEqual(text, made)
        for title in ("seen by 2 [%]", "by 3 [%]", "F", "mean [mm]", "gross [%]", "density", "CPU [s]"):
            self.assertIn(title, text)
        rows = [line for line in text.splitlines() if line.startswith("|")]
        self.assertEqual([row.split("|")[1].strip() for row in rows],
                         ["seed", "---", "11", "median"])

    def test_most_of_the_ground_is_seen_by_two(self):
        by_views = {one["least"]: one["places"] for one in self.results()["by_views"]}
        self.assertGreater(by_views[2], 2 * by_views[3])
        self.assertGreater(self.results()["cpu_seconds"], 0)
        self.assertTrue(self.results()["strip"]["pieces"])

    def test_scenes_stay_and_other_options_are_measured_anew(self):
        before = self.results()
        scene = [name for name in os.listdir(self.work) if name.startswith("transect-11-")]
        self.assertEqual(len(scene), 1)
        image = os.path.join(self.work, scene[0], "water", "0000.jpg")
        time = os.stat(image).st_mtime_ns
        self.completeness("--dense-options", "--number-views-fuse 2")
        self.assertEqual(os.stat(image).st_mtime_ns, time)
        two = self.results()["by_views"][0]["recall"][0]
        self.completeness("--dense-options", "--number-views-fuse 3")
        self.assertGreater(two, self.results()["by_views"][0]["recall"][0] + 0.2)
        self.completeness()
        self.assertEqual(self.results(), before)


class WrongCompleteness(ProgramTest):
    def test_is_refused(self):
        self.refuses_each((PROGRAM, "completeness", "-o", self.path("a")), ("--medium ice: must be", "--medium", "ice"),
                          ("--poses mine: must be", "--poses", "mine"), ("--seeds 1,x", "--seeds", "1,x"),
                          ("--seeds names 3 twice", "--seeds", "3,4,3"),
                          ("--tolerance -1: must be", "--tolerance", "-1"))

    def test_options_of_its_own_are_without_effect_elsewhere(self):
        self.assertIn("--medium: without effect", self.succeeds(
            PROGRAM, "figure3", "--quick", "--medium", "air", "-o", self.path("a")).stdout)


main()
