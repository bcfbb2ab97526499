# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions of apps/pipeline/axial_pipeline, without the programs and with a stand-in for
COLMAP."""

import argparse
import contextlib
import io
import json
import math
import random

from pipeline_folder import PIPELINE, ColmapModelCase, InFolder, options_of
from programs import main

from axial_pipeline import colmap, files, position_rows, positions, run_file, running, start_lens, steps, truth
from axial_pipeline.failure import Failure
from axial_pipeline.programs import Programs, default_folder


class ColmapCommands(InFolder):
    def words(self, help_text, function, *arguments):
        """The words of a command where `colmap ... --help` prints `help_text`."""
        self.put_script("colmap", f"echo '{help_text}'")
        self.put_on_path()
        return " ".join(map(str, function(*arguments)))

    def test_every_version_is_kept_off_the_graphics_card(self):
        for family in colmap.EXTRACTION:
            said = f"--{family}.use_gpu arg (=1)"
            self.assertEqual(self.words(said, colmap.features, "db", "images", "OPENCV", "1,2"),
                             "colmap feature_extractor --database_path db --image_path images "
                             "--ImageReader.single_camera 1 --ImageReader.camera_model OPENCV "
                             f"--ImageReader.camera_params 1,2 --{family}.use_gpu 0")
        for family in colmap.MATCHING:
            said = f"--{family}.use_gpu arg (=1)"
            self.assertEqual(self.words(said, colmap.matches, "db", "sequential", -1),
                             "colmap sequential_matcher --database_path db "
                             f"--{family}.use_gpu 0 --{family}.num_threads -1")
        self.assertEqual(self.words("--other arg", colmap.matches, "db", "exhaustive"),
                         "colmap exhaustive_matcher --database_path db")

    def test_the_mapper_refines_what_is_said(self):
        start = "colmap mapper --database_path db --image_path images --output_path models"
        for arguments, more in (((), ""), ((True,), " --Mapper.ba_refine_focal_length 1 "
                                           "--Mapper.ba_refine_principal_point 0 "
                                           "--Mapper.ba_refine_extra_params 1"),
                                ((False, 2), " --Mapper.num_threads 2 "
                                 "--Mapper.ba_refine_focal_length 0 "
                                 "--Mapper.ba_refine_principal_point 0 "
                                 "--Mapper.ba_refine_extra_params 0")):
            words = colmap.mapper("db", "images", "models", *arguments)
            self.assertEqual(" ".join(map(str, words)), start + more)


class ColmapModels(InFolder):
    def test_images_of_binary_and_text_models_are_counted(self):
        self.model(0, 7)
        self.assertEqual(colmap.registered(self.folder / "models" / "0"), 7)
        text = "# a\n1 1 0 0 0 0 0 0 1 a.jpg\n10 20 -1\n2 1 0 0 0 0 0 0 1 b.jpg\n\n"
        self.write("models/1/images.txt", text)
        self.assertEqual(colmap.registered(self.folder / "models" / "1"), 2)

    def test_the_largest_model_is_the_first(self):
        for number, images in enumerate((3, 9, 2)):
            self.model(number, images)
        (self.folder / "models" / "unfinished").mkdir()
        found = colmap.best_first([self.folder / "models"])
        self.assertEqual([(model.name, size) for model, size in found],
                         [("1", 9), ("0", 3), ("2", 2)])


# A stand-in for COLMAP that writes its commands to the file `commands`. The mapper finds two models.
COLMAP = """[ "$2" = --help ] && { echo "--SiftExtraction.use_gpu --SiftMatching.use_gpu "; exit; }
echo "$*" >> commands
[ "$1" = mapper ] || exit 0
for number in 0 1; do
  mkdir out/models/$number
  printf "\\\\$((number + 2))\\\\0\\\\0\\\\0\\\\0\\\\0\\\\0\\\\0" > out/models/$number/images.bin
done"""


class ColmapModelCommand(ColmapModelCase):
    """The command colmap-model, with a stand-in for COLMAP."""

    def setUp(self):
        super().setUp()
        self.put_script("bin/colmap", COLMAP)

    def test_it_keeps_the_largest_model(self):
        ended = self.run_it("--max-threads", "3")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        self.assertEqual(colmap.registered(self.folder / "out" / "model"), 3)
        self.assertEqual((self.folder / "commands").read_text().splitlines(), [
            "feature_extractor --database_path out/database.db --image_path images "
            "--ImageReader.single_camera 1 --ImageReader.camera_model PINHOLE "
            "--ImageReader.camera_params 1,2,3,4 --SiftExtraction.use_gpu 0 "
            "--SiftExtraction.num_threads 3",
            "exhaustive_matcher --database_path out/database.db --SiftMatching.use_gpu 0 "
            "--SiftMatching.num_threads 3",
            "mapper --database_path out/database.db --image_path images --output_path out/models "
            "--Mapper.num_threads 3 --Mapper.ba_refine_focal_length 0 "
            "--Mapper.ba_refine_principal_point 0 --Mapper.ba_refine_extra_params 0"])
        self.assertIn("kept from an earlier run", self.run_it().stdout)
        self.assertEqual(len((self.folder / "commands").read_text().splitlines()), 3)

    def test_masks_reach_colmap(self):
        self.put_script("programs/InterfaceCOLMAP", 'echo "masks $*" >> commands')
        mask = self.write("mask.png", "")
        ended = self.run_it("--masks", "mask.png", "--ignore-mask-label", "3", "--programs", "programs")
        self.assertEqual(ended.returncode, 0, ended.stderr)
        commands = (self.folder / "commands").read_text().splitlines()
        self.assertEqual(commands[0], f"masks -i images --mask-path {mask.resolve()} --ignore-mask-label 3 -o "
                                      "out/colmap_masks")
        self.assertIn("--ImageReader.mask_path out/colmap_masks", commands[1])

    def test_that_colmap_finds_no_poses_is_told_apart_from_a_broken_colmap(self):
        for script, said in ((f"echo '{colmap.NO_MODEL}'; exit 1", "COLMAP found no poses"),
                             (f"echo '{colmap.NO_MODEL}'; exit 3", "colmap: exit code 3, its output "
                              "is in out/mapper.log"),
                             ("kill -9 $$", "colmap: signal 9"),
                             ("exit 1", "colmap: exit code 1")):
            self.put_script("bin/colmap", f"[ $1 = mapper ] || exit 0; {script}")
            ended = self.run_it()
            self.assertEqual(ended.returncode, 1)
            self.assertIn(f"colmap-model: {said}", ended.stderr.splitlines()[-1])

    def test_wrong_options_are_refused(self):
        for options, said in ((("--images", "none"), "--images none: is not a folder"),
                              (("--max-threads", "-2"), "--max-threads -2: must not be negative")):
            ended = self.run_it(*options)
            self.assertEqual((ended.returncode, ended.stderr), (1, f"colmap-model: {said}\n"))
        self.assertFalse((self.folder / "out").exists())


class Lenses(InFolder):
    def test_the_start_is_the_lens_in_air_times_the_waters_index(self):
        one = b"# a comment\n\n1 SIMPLE_RADIAL 640 480 1000 320 240 -0.1\n"
        two = b"1 OPENCV 640 480 1000 2000 320 240 1 2 3 4\n"
        calibmar = (b"model: OPENCV\nwidth: 640\nheight: 480\nparameters: [1000, 2000, 320,\n  240, 1, 2, 3, 4]\n")
        for text, model, expected in [(one, "OPENCV", [[1333, 1333, 320, 240, 0, 0, 0, 0]]),
                                      (one, "RADIAL", [[1333, 320, 240, 0, 0]]),
                                      (two, "PINHOLE", [[1333, 2666, 320, 240]]),
                                      (two, "SIMPLE_RADIAL", [[1999.5, 320, 240, 0]]),
                                      (calibmar, "OPENCV", [[1333, 2666, 320, 240, 0, 0, 0, 0]]),
                                      (one, "FOV", [None]), (b"\x01\xff\0", "OPENCV", []), (b"", "OPENCV", []),
                                      (b"1 OPENCV 640 480 a\n", "OPENCV", [])]:
            file = self.write("lens.yaml" if text is calibmar else "lens.txt", text)
            given = options_of(lens=str(file), lens_model=model)
            self.assertEqual(start_lens.starts_of(given), expected)

    def test_parameters_of_a_pinhole_are_those_of_the_file(self):
        self.write("sparse/cameras.txt", "# PINHOLE x\n1 PINHOLE 640 480 1000.50 1e3 320 240\n")
        self.assertEqual(truth.pinhole_parameters(self.folder), "1000.5,1000.0,320.0,240.0")
        self.write("sparse/cameras.txt", "1 OPENCV 640 480 1 1 1 1 0 0 0 0\n")
        with self.assertRaisesRegex(Failure, "cameras.txt: has no PINHOLE camera"):
            truth.pinhole_parameters(self.folder)


class Positions(InFolder):
    def test_names_are_read_as_refine_poses_reads_them(self):
        """The same lines as in tests/io/position_file_test.cpp."""
        images = {"a.jpg", "dive 1/a b.jpg", "#5 of 7.jpg", '"q" 1.jpg'}
        for line, name in (("a.jpg 1 2 3", "a.jpg"), ("dive 1/a b.jpg 1 2 3\r", "dive 1/a b.jpg"),
                           ("#5 of 7.jpg 1 2 3", "#5 of 7.jpg"), ("#a.jpg 1 2 3", None),
                           ("# name x y z", None), ("", None), ("a.jpg 1 2 3 # 4 5 6", "a.jpg"),
                           ('"#lost.jpg" 1 2 3', "#lost.jpg"), ('"q" 1.jpg 1 2 3', '"q" 1.jpg'),
                           ('"q ""r""" 1 2 3 # x', 'q "r"'), ("lost 2.jpg 1 2 3", "lost 2.jpg")):
            entry = position_rows.entry_in(line, images.__contains__)
            self.assertEqual(entry, name and (name, (1, 2, 3)), line)

    def test_positions_are_those_of_the_known_names(self):
        file = self.write("positions.txt", "\ufeffa.jpg 1 -2.5 3e2\n# b.jpg 1 1 1\n"
                          'lost.jpg 1 2 3\n"c d.jpg" 4 5 6 # 7 8 9\n')
        self.assertEqual(positions.read(file, ["a.jpg", "b.jpg", "c d.jpg"]),
                         {"a.jpg": (1, -2.5, 300), "c d.jpg": (4, 5, 6)})
        for line in ("b.jpg", "b.jpg 1 2", "b.jpg 1 2 nan", '"b.jpg" 1 2', '"b.jpg" 1 2 3 4'):
            self.write("positions.txt", f"a.jpg 1 2 3\n{line}\n")
            with self.assertRaisesRegex(Failure, "positions.txt:2: must be NAME X Y Z"):
                positions.read(file, ["a.jpg", "b.jpg"])

    def test_files_of_other_programs(self):
        """The same files as in tests/io/position_file_test.cpp and image_positions_test.cpp."""
        names = ["dive1/IMG_1.JPG", "dive1/IMG_2.JPG", "c d.tif"]
        expected = {names[0]: (1.5, 2, -3), names[1]: (4, 5, 6)}
        for text in ("IMG_1,1.5,2,-3\nimg_2.jpg,4,5,6\n", "sep=;\nIMG_1;1,5;2;-3\n\"IMG_2\";4;5;6\n",
                     "C:\\x\\dive1\\IMG_1.JPG\t1,5\t2\t-3\rdive1/IMG_2.DNG\t4\t5\t6\r",
                     "WGS84 UTM 33N\nIMG_1.JPG 1.5 2 -3 0 0 0 .1 .2 x\nIMG_2.JPG 4 5 6\n",
                     "#Label,Y/Northing,X/Easting,Z/Altitude,Accuracy_(m),Error_(m)\n"
                     "IMG_1,2,1.5,-3,0.1,9\nIMG_2,5,4,6,,\nc d,,,,,\n# Total,,,,0.1,\n",
                     "name x y z\nIMG_1 1.5 2 -3\nIMG_2 4 5 6\n",
                     "dive1//IMG_1.JPG 1.5 2 -3\ndive1/x/../IMG_2 4 5 6 # a\u2028comment\n"):
            file = self.write("positions.csv", text)
            self.assertEqual(positions.read(file, names), expected, text)
        file = self.write("degrees.csv", "name,latitude,longitude,altitude\nIMG_1,54.25,16.5,-3\n"
                          "IMG_2,54.2501,16.5,-3\nc d.tif,54.25,16.5001,-3\n")
        found = positions.read(file, names)
        for name, metres in ((names[1], 11.13), (names[2], 6.52)):  # of the ellipsoid WGS 84
            self.assertAlmostEqual(math.dist(found[names[0]], found[name]), metres, delta=0.05)
        degrees = found
        rows = "IMG_1,16.5,54.25,-3\nIMG_2,16.5,54.2501,-3\nc d.tif,16.5001,54.25,-3\n"
        for header in ("name,x (deg),y (deg),z", "name,GPS_Longitude,GPS_Latitude [°],z",
                       "# CoordinateSystem: GEOGCS[]", "EPSG:4326"):
            self.write("degrees.csv", f"{header}\n{rows}")
            self.assertEqual(positions.read(file, names), degrees)
        self.write("degrees.csv", rows)
        said = self.said_by(lambda: self.assertEqual(positions.read(file, names), degrees))
        self.assertIn("degrees.csv: no line states whether the positions are metres or degrees; they are taken as "
                      "degrees to find neighbours", said)
        self.write("degrees.csv", f"label,x (m),y (m),z (m)\n{rows}")
        self.assertEqual(positions.read(file, names)[names[1]], (16.5, 54.2501, -3))
        with self.assertRaisesRegex(Failure, "positions.csv:1: 'IMG_1' can be a/IMG_1.JPG or b/IMG_1.JPG"):
            positions.read(self.write("positions.csv", "IMG_1 1 2 3\n"), ["a/IMG_1.JPG", "b/IMG_1.JPG"])

    def test_the_latitude_is_first_where_only_this_is_possible(self):
        names = ["a.jpg", "b.jpg", "c.jpg"]
        for header, rows, first, guess in (
                ("", ((-60, -90.3), (-60.0001, -90.3), (-60, -90.3001)), True, True),
                ("label,x (deg),y (deg),z", ((60, 123), (60.0001, 123), (60, 123.0001)), True, False),
                ("label,x (deg),y (deg),z", ((123, 60), (123, 60.0001), (123.0001, 60)), False, False),
                ("label,x (deg),y (deg),z", ((16, 60), (16, 60.0001), (16.0001, 60)), False, False),
                ("label,longitude,latitude,z", ((123, 60), (123, 60.0001), (123.0001, 60)), False, False),
                ("EPSG:4326", ((123, 60), (123, 60.0001), (123.0001, 60)), False, False)):
            lines = [f"{name},{x},{y},-3\n" for name, (x, y) in zip(names, rows)]
            file = self.write("degrees.csv", "".join([f"{header}\n" if header else "", *lines]))
            found = {}
            said = self.said_by(lambda: found.update(positions.read(file, names)))
            for name, metres in zip(names[1:], (11.1, 5.57)):  # to the north or south, to the east or west
                self.assertAlmostEqual(math.dist(found[names[0]], found[name]), metres, delta=0.05, msg=lines)
            self.assertEqual(("taken as degrees to find neighbours, the latitude first." in said,
                              "degrees: the first is taken as the latitude to find neighbours" in said),
                             (first and guess, first and not guess), said)
            self.assertEqual(said.count("\n"), int(first or guess))
        self.write("degrees.csv", "label,longitude,latitude,z\na,10,85,0\nb,10,85.0001,0\n")
        found = positions.read(file, names)
        self.assertAlmostEqual(math.dist(*found.values()), 11.1, delta=0.05)

    def test_degrees_become_metres_in_the_zone_that_maps_state(self):
        names = ["a.jpg", "b.jpg", "c.jpg"]
        for header, x, y, zone in (("EPSG:4326", -81.5, 24.5, 32617), ("EPSG:4326", 147.5, -18.5, 32755),
                                   ("EPSG:4326", 5.9999, 60, 32631), ("EPSG:4326", 6.0001, 60, 32632),
                                   ("label,latitude,longitude,z", 24.5, -81.5, 32617),
                                   ("EPSG:4326", 179.99, 1, 32660), ("EPSG:4326", -180, 1, 32601)):
            rows = "".join(f"{name},{x},{y},{-number}\n" for number, name in enumerate(names))
            file = self.write("degrees.csv", f"{header}\n{rows}")
            for harmless in (0, zone):
                positions.check_system(file, names, harmless)
            for wrong in (zone - 1, zone + 1):
                with self.assertRaisesRegex(Failure, f"--epsg {wrong}: .*degrees.csv .*give --epsg {zone}, or"):
                    positions.check_system(file, names, wrong)
        self.write("degrees.csv", "a,16.5,54.25,-3\nb,16.5,54.2501,-3\nc,16.5001,54.25,-3\n")
        with self.assertRaisesRegex(Failure, "degrees.csv: no line states .* which --epsg needs"):
            positions.check_system(file, names, 32633)
        positions.check_system(file, names, 0)
        self.write("degrees.csv", "a 534000 3378500 -3\nb 534001 3378500 -3\nc 534000 3378501 -3\n")
        positions.check_system(file, names, 32617)

    def read_as(self, places, reading):
        """The positions that are read of a file without a header, in the order of `places`. Checks what is
        said."""
        names = [f"{number}.jpg" for number in range(len(places))]
        file = self.write("positions.txt", "".join(f"{name} {x:.7f} {y:.7f} {z:.3f}\n"
                                                   for name, (x, y, z) in zip(names, places)))
        found = {}
        said = self.said_by(lambda: found.update(positions.read(file, names)))
        self.assertIn(f"whether the positions are metres or degrees; they are taken as {reading} to find", said)
        self.assertEqual(said.count("\n"), 1)
        return [found[name] for name in names]

    def test_a_survey_in_degrees_of_no_stated_unit_has_its_neighbours(self):
        """Tracks to and fro, with heights that vary at random, or along a slope across the tracks, in the
        order of the tracks and in none."""
        chance = random.Random(1)
        for step in (1e-5, 1e-4):
            cells = [(row, column if row % 2 else 9 - column) for row in range(10) for column in range(10)]
            for slope, noise in ((0, 2), (1, 0.2), (0, 0)):
                tracks = [(16 + column * step, 54 + row * step, slope * row + chance.uniform(-noise, noise))
                          for row, column in cells]
                for places in (tracks, chance.sample(tracks, len(tracks))):
                    found = self.read_as(places, "degrees")
                    first, second = (found[places.index(tracks[number])] for number in (0, 99))
                    self.assertAlmostEqual(math.dist(first[:2], second[:2]), step * 9 * 110950, delta=step * 1e4)

    def test_a_vertical_scan_in_metres_of_no_stated_unit_has_its_neighbours(self):
        chance = random.Random(1)
        jitter = lambda: chance.uniform(-0.0025, 0.0025)
        for count in (10, 40, 400):
            down = [(10 + jitter(), 20 + jitter(), -0.5 * number) for number in range(count)]
            up = [(10 + jitter(), 20 + jitter(), z + 0.2) for _, _, z in reversed(down)]
            for places in (down, [*down, *up]):
                for place, found in zip(places, self.read_as(places, "metres"), strict=True):
                    self.assertLess(math.dist(place, found), 1e-3)

    def test_names_of_no_photograph_are_told(self):
        file = self.write("positions.txt",
                          "a.jpg 0 0 0\nb.jpg 1 0 0\n# d.jpg\nc.jpg 0 1 0\nC.jpg 0 1 0\n")
        said = self.said_by(positions.check, file, "images", ["a.jpg", "b.jpg", "c.jpg"])
        self.assertIn("1 of 4 names are not photographs", said)
        self.assertIn("C.jpg first", said)

    def test_only_the_form_with_positions_names_a_file(self):
        self.assertEqual(positions.file_of("positions:a/b.txt"), "a/b.txt")
        self.assertIsNone(positions.file_of("images:a,b,1"))
        self.assertIsNone(positions.file_of(""))


class Running(InFolder):
    def failure_of(self, script, **options):
        log = self.folder / "log"
        with contextlib.redirect_stderr(io.StringIO()) as said:
            with self.assertRaises(Failure) as caught:
                running.logged(["sh", "-c", script], log, **options)
        return str(caught.exception).replace(str(log), "LOG"), said.getvalue()

    def test_a_failure_says_how_the_command_ended(self):
        self.assertEqual(self.failure_of("echo a; echo b; exit 3"),
                         ("sh: exit code 3, its output is in LOG", "a\nb\n"))
        self.assertEqual(self.failure_of("kill -9 $$", name="step")[0],
                         "step: signal 9, its output is in LOG")
        self.assertEqual(running.ending(255), "exit code 255")

    def test_a_command_that_cannot_be_started_is_named(self):
        log = self.folder / "log"
        self.assertEqual(running.exit_code_of([self.folder / "none"], log), 127)
        self.assertIn("none: cannot be started: No such file", log.read_text())

    def test_an_excuse_counts_with_exit_code_1_alone(self):
        log = self.folder / "log"
        command = ["sh", "-c", "echo nothing found; exit 1"]
        self.assertFalse(running.logged(command, log, excuse="nothing"))
        self.assertTrue(running.logged(["true"], log, excuse="nothing"))
        self.failure_of("echo nothing found; exit 2", excuse="nothing")
        self.failure_of("echo other; exit 1", excuse="nothing")


class Steps(InFolder):
    def steps(self, word):
        first, second, read = (self.folder / name for name in ("first", "second", "read"))
        if not read.exists():
            read.touch()
        return [steps.Step("first", ["sh", "-c", f"echo {word} >> {first}"], first, reads=[read],
                           changed=[first]),
                steps.Step("second", ["cp", first, second], second)]

    def run_all(self, word):
        """Returns which steps were not repeated."""
        said = self.said_by(steps.run_all, self.steps(word), self.folder)
        return [line.split()[1].rstrip(":") for line in said.splitlines() if "done before" in line]

    def test_steps_are_repeated_from_the_first_that_differs(self):
        self.assertEqual(self.run_all("a"), [])
        self.assertEqual(self.run_all("a"), ["first", "second"])
        (self.folder / "second").unlink()
        self.assertEqual(self.run_all("a"), ["first"])
        self.assertEqual(self.run_all("b"), [])
        self.assertEqual((self.folder / "second").read_text(), "b\n")
        self.write("read", "changed")
        self.assertEqual(self.run_all("b"), [])

    def test_records_do_not_grow_with_the_inputs(self):
        for number in range(1000):
            self.write(f"read/{number}", "")
        self.run_all("a")
        for name in ("first.begun", "first.done", "second.begun", "second.done"):
            self.assertLess((self.folder / "steps" / f"{name}.json").stat().st_size, 200)

    def test_a_step_that_failed_is_repeated(self):
        broken = [self.steps("a")[0],
                  steps.Step("second", ["sh", "-c", "exit 1"], self.folder / "second")]
        with self.assertRaisesRegex(Failure, "second: exit code 1"):
            self.said_by(steps.run_all, broken, self.folder)
        self.assertEqual(self.run_all("a"), ["first"])


class RunFile(InFolder):
    def test_a_step_has_the_times_and_warnings_of_its_jobs(self):
        todo = [steps.Step("import", ["InterfaceCOLMAP"], self.folder),
                steps.Step("densify", ["DensifyPointCloud", "-i", "a b"], self.folder)]
        chain = steps.digest(steps.chain_to("densify", todo))
        for name, of, seconds in (("import", "", 2), ("densify", chain, 5), ("depth-first-1of2", chain, 7),
                                  ("depth-first-2of2", chain, 8), ("depth-first-3of3", "an older run", 100)):
            self.write(f"steps/{name}.done.json", json.dumps({"chain": of, "seconds": seconds}))
            self.write(f"logs/{name}.log", "12:00:00 [DensifyPointCloud] a warning: no\n"
                       f"12:00:00 [DensifyPointCloud] warning: both\n12:00:00 [X] warning: {name}\n")
        (self.folder / "logs" / "import.log").unlink()
        given = argparse.Namespace(images="photographs", lens_model="OPENCV", truth="", tiles=1)
        run_file.write_run(self.folder / "run.json", given, todo, self.folder)
        written = json.loads((self.folder / "run.json").read_text())
        self.assertEqual(written["command"],
                         ["reconstruct", "--images=photographs", "--lens-model=OPENCV", "--tiles=1"])
        imported, densified = written["steps"]
        self.assertEqual((imported["seconds"], imported["warnings"], imported["version"]), (2, [], None))
        self.assertEqual(densified["seconds"], 20)
        self.assertEqual(densified["command"], ["DensifyPointCloud", "-i", "a b"])
        self.assertEqual({warning["text"]: warning["times"] for warning in densified["warnings"]},
                         {"both": 3, "depth-first-1of2": 1, "depth-first-2of2": 1, "densify": 1})


class ProgramCommands(InFolder):
    def test_commands(self):
        programs = Programs("bin")
        for command, words in (
                (programs.import_scene("m", "i", "s"), "InterfaceCOLMAP -i m --image-folder i -o s"),
                (programs.import_scene("m", "i", "s", "h"),
                 "InterfaceCOLMAP -i m --image-folder i --housing h -o s"),
                (programs.densify("s", "f", "--refractive", 1),
                 "DensifyPointCloud -i s -w f --refractive 1"),
                (programs.align("m", "r", "o"), "AlignModel -i m --reference r -o o")):
            self.assertEqual(" ".join(map(str, command)), f"bin/{words}")

    def test_programs_beside_the_script_come_first(self):
        self.assertEqual(default_folder(self.folder),
                         PIPELINE.parents[1] / "build" / "release" / "bin")
        self.write("DensifyPointCloud", "")
        self.assertEqual(default_folder(self.folder), self.folder)


class Files(InFolder):
    def test_a_copy_is_not_repeated(self):
        source, target = self.write("source", "new"), self.write("target", "old")
        files.copy_once(source, target)
        self.assertEqual(target.read_text(), "old")
        files.clear(target)
        files.copy_once(source, target)
        self.assertEqual(target.read_text(), "new")
        self.assertEqual({path.name for path in self.folder.iterdir()}, {"source", "target"})

    def test_files_in_subfolders_are_counted(self):
        for name in ("a", "one/b", "one/two/c", "one/two/d"):
            self.write(name, "")
        self.assertEqual(files.count(str(self.folder)), 4)

    def test_whatever_is_there_is_cleared(self):
        self.write("folder/file", "")
        for path in ("folder", "folder"):
            files.clear(self.folder / path)
        self.assertFalse((self.folder / "folder").exists())


if __name__ == "__main__":
    main()
