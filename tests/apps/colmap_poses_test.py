# SPDX-License-Identifier: GPL-3.0-or-later
"""Features and poses of COLMAP in `reconstruct`: databases written by hand, and stand-ins for COLMAP."""

import json
import shutil
import struct
import unittest.mock

from colmap_databases import BLURRED, SHARP, Databases
from pipeline_folder import options_of
from programs import main

from axial_pipeline import colmap, database, features, left_out, lenses, poses, start_lens
from axial_pipeline.failure import Failure


class Features(Databases):
    def test_number_scale_and_spread_are_those_of_the_file(self):
        found = database.features(self.database({"a.jpg": (2000, SHARP), "b.jpg": (0, SHARP)}))
        self.assertEqual([found[name].count for name in ("a.jpg", "b.jpg")], [2000, 0])
        self.assertAlmostEqual(found["a.jpg"].fine, SHARP * (0.95 + 0.1 * 2.05), delta=0.05)
        self.assertEqual((found["a.jpg"].spread, found["b.jpg"].spread), (1, 0))
        self.assertIsNone(database.features(self.folder / "none.db"))

    def test_blurred_photographs_are_found(self):
        photographs = {f"{i}.jpg": (2000, SHARP) for i in range(7)} | {f"{i}.jpg": (1500, BLURRED) for i in (7, 8)}
        file = self.database(photographs)
        self.assertEqual(sorted(features.blurred(database.features(file))[0]), ["7.jpg", "8.jpg"])
        self.assertIn("blurred", "\n".join(features.lines_about(file)))

    def test_a_dive_without_sharp_photographs_is_kept(self):
        file = self.database({f"{i}.jpg": (900, BLURRED + 0.1 * i) for i in range(6)})
        self.assertEqual(features.blurred(database.features(file))[0], {})

    def test_weak_features_are_added_where_there_are_few(self):
        file = self.database({"clear.jpg": (3000, SHARP), "hazy.jpg": (20, SHARP)})
        low = self.folder / "low.db"
        (self.folder / "logs").mkdir()

        def detector(to, names, threshold):
            self.assertEqual((names.read_text(), threshold), ("hazy.jpg\n", features.WEAK))
            self.database({"hazy.jpg": (2500, SHARP)}, low.name)
            return ["mv", str(low), str(to)]

        said = self.said_by(features.take_weak_features, file, detector, self.folder)
        self.assertIn("1 of 2 photographs have few features", said)
        self.assertEqual({name: one.count for name, one in database.features(file).items()},
                         {"clear.jpg": 3000, "hazy.jpg": 2500})
        self.assertEqual(list(self.folder.glob("weak_features*")), [])

    def test_no_weak_features_are_added_to_many_or_to_blurred_ones(self):
        """Noise and traces of JPEG make fine features, but only weak ones, which would hide blur."""
        for photographs, blurred in (({"clear.jpg": (3000, SHARP)}, []),
                                     ({f"{i}.jpg": (3000, SHARP) for i in range(4)} | {"blurred.jpg": (25, BLURRED)},
                                      ["blurred.jpg"])):
            with self.subTest(photographs):
                file = self.database(photographs, f"{len(photographs)}.db")
                self.assertEqual(self.said_by(features.take_weak_features, file, None, self.folder), "")
                self.assertEqual(list(features.blurred(database.features(file))[0]), blurred)

    def detector(self, strengths):
        """A detector. `strengths`: by name, the threshold at which a photograph has features, with their scale."""
        def command(to, names, threshold):
            low = {}
            for name in names.read_text().splitlines():
                fitting = [features for limit, features in strengths[name].items() if threshold <= limit]
                low[name] = fitting[-1] if fitting else (0, SHARP)
            self.asked.append((threshold, sorted(low)))
            self.database(low, "low.db")
            return ["mv", str(self.folder / "low.db"), str(to)]
        self.asked = []
        (self.folder / "logs").mkdir()
        return command

    def test_blur_is_found_in_haze(self):
        # Simulated haze: what is left of a blurred photograph is stronger than its noise.
        sharp = {"strong.jpg": {}, **{f"{i}.jpg": {0.004: (700, SHARP), 0.001: (4000, SHARP)} for i in range(3)}}
        blurred = {"b.jpg": {0.004: (15, BLURRED), 0.001: (700, 1.09)},
                   "c.jpg": {0.002: (46, BLURRED), 0.001: (300, SHARP)}}
        file = self.database({"strong.jpg": (3000, SHARP), **{name: (2, SHARP) for name in sharp | blurred
                                                             if name != "strong.jpg"}})
        self.said_by(features.take_weak_features, file, self.detector(sharp | blurred), self.folder)
        found = database.features(file)
        self.assertEqual(sorted(features.blurred(found)[0]), ["b.jpg", "c.jpg"])
        self.assertEqual([found[name].count for name in ("0.jpg", "b.jpg", "c.jpg")], [4000, 15, 46])
        self.assertEqual([threshold for threshold, _ in self.asked], [0.004, 0.002, 0.001])
        self.assertEqual(self.asked[1:], [(0.002, ["c.jpg"]), (0.001, ["0.jpg", "1.jpg", "2.jpg"])])

    def test_dark_photographs_have_hardly_any_feature(self):
        file = self.database({"a.jpg": (3000, SHARP), "b.jpg": (29, SHARP), "c.jpg": (30, SHARP)})
        self.assertEqual(list(features.dark(database.features(file))), ["b.jpg"])
        file.unlink()
        file = self.database({"a.jpg": (3000, SHARP), "b.jpg": (29, SHARP), "c.jpg": (0, SHARP)})
        self.assertEqual(features.dark(database.features(file)), {})

    def test_a_handful_of_features_tells_no_blur(self):
        file = self.database({f"{i}.jpg": (3000, SHARP) for i in range(4)} | {"hazy.jpg": (5, BLURRED)})
        self.assertEqual(features.blurred(database.features(file))[0], {})


class Lens(Databases):
    def test_the_lens_behind_the_port_is_that_of_the_cameras(self):
        file = self.database({"a.jpg": (9, SHARP)})
        found = [lenses.Lens(1, "OPENCV_FISHEYE", (480, 360), (380, 381, 240, 180, 0.1, 0.2, 0.3, 0.4))]
        database.set_lenses(file, lambda *camera: start_lens.lens_for(found, *camera))
        rows = database.rows_of(file, "SELECT model, params, prior_focal_length FROM cameras")
        self.assertEqual(rows, [(5, struct.pack("<8d", 380, 381, 240, 180, 0.1, 0.2, 0.3, 0.4), 1)])

    def test_a_camera_of_another_size_keeps_its_lens(self):
        lens = lambda number, size: lenses.Lens(number, "OPENCV", size, (number,) * 8)
        self.assertIsNone(start_lens.lens_for([lens(1, (640, 480))], 1, 480, 360))
        two = [lens(1, (480, 360)), lens(2, (480, 360))]
        self.assertEqual(start_lens.lens_for(two, 2, 480, 360), ("OPENCV", [2] * 8))
        self.assertIsNone(start_lens.lens_for(two, 3, 480, 360))


class Poses(Databases):
    NAMES = ("a.jpg", "b.jpg", "c.jpg", "d.jpg")

    def best(self, given, free=None):
        """Takes the best model. `free`: makes the models of the second try in a folder."""
        (self.folder / "logs").mkdir(exist_ok=True)
        file = self.folder / "features.db"
        if not file.exists():
            self.database({name: (2000 if name != "d.jpg" else 12, SHARP) for name in self.NAMES})
        with unittest.mock.patch.object(poses, "logged", lambda *_, **__: free and free(
                self.folder / "colmap" / poses.FREE)):
            return self.said_by(poses.take_best, file, given, self.folder, [])

    def test_all_photographs_need_no_second_try(self):
        self.model(self.folder / "colmap" / "0", self.NAMES)
        said = self.best(options_of(), lambda folder: self.fail("tried again"))
        self.assertEqual(said, "    4 of 4 photographs have poses\n")
        self.assertEqual(poses.lines_about(self.folder), ["4 of 4 photographs have poses"])

    def test_the_try_with_more_photographs_is_kept(self):
        self.model(self.folder / "colmap" / "0", self.NAMES[:2])
        said = self.best(options_of(), lambda folder: self.model(folder / "0", self.NAMES[:3], 500))
        self.assertIn("3 of 4 photographs have poses", said)
        self.assertIn("d.jpg: 12 features", said)
        self.assertEqual(set(colmap.images_in(self.folder / "colmap" / "best")), set(self.NAMES[:3]))

    def test_photographs_that_were_left_out_are_counted_and_named(self):
        self.database({**dict.fromkeys(self.NAMES, (2000, SHARP)), "e.jpg": (2000, SHARP)})
        file = self.folder / "database.db"
        shutil.copyfile(self.folder / "features.db", file)
        self.said_by(left_out.leave_out, self.folder / "features.db", file, {"e.jpg": "a.jpg"})
        self.model(self.folder / "colmap" / "0", self.NAMES)
        said = self.said_by(poses.take_best, file, options_of(), self.folder, [])
        self.assertEqual(said.splitlines(), ["    4 of 5 photographs have poses",
                                             "    warning: 1 photographs have no pose",
                                             "    no pose: e.jpg: the same file as a.jpg, and left out"])

    def test_photographs_that_got_a_pose_later_count(self):
        self.model(self.folder / "colmap" / "0", self.NAMES[:2])
        self.best(options_of(lens_model="OPENCV"))
        self.assertEqual(poses.lines_about(self.folder)[0], "2 of 4 photographs have poses")
        self.said_by(poses.print_changes, self.folder)
        (self.folder / "refined").mkdir()
        (self.folder / "refined" / "report.json").write_text(json.dumps({"registered": {
            "photographs": ["c.jpg"], "left_out": [{"name": "d.jpg", "reason": "5 matches with points"}]}}))
        lines = ["3 of 4 photographs have poses", "warning: 1 photographs have no pose",
                 "no pose: d.jpg: 5 matches with points"]
        self.assertEqual(poses.lines_about(self.folder), lines)
        self.assertEqual(self.said_by(poses.print_changes, self.folder).splitlines(), [f"    {line}" for line in lines])

    def test_a_lens_that_ran_away_is_refused(self):
        self.model(self.folder / "colmap" / "0", self.NAMES[:2])
        said = self.best(options_of(), lambda folder: self.model(folder / "0", self.NAMES, 23))
        self.assertIn("its focal length ran from 400 to 23 px", said)
        self.assertIn("2 of 4 photographs have poses", said)

    def test_of_equal_models_the_fixed_lens_counts(self):
        self.model(self.folder / "colmap" / "0", self.NAMES[:2])
        self.best(options_of(), lambda folder: self.model(folder / "0", self.NAMES[2:]))
        self.assertEqual(set(colmap.images_in(self.folder / "colmap" / "best")), {"a.jpg", "b.jpg"})

    def test_of_equal_places_the_one_with_the_known_length_counts(self):
        for number, names in enumerate((self.NAMES[:2], self.NAMES[2:])):
            self.model(self.folder / "colmap" / str(number), names)
        said = self.best(options_of(lens_model="OPENCV", scale_from="images:c.jpg,d.jpg,0.5"))
        self.assertEqual(set(colmap.images_in(self.folder / "colmap" / "best")), {"c.jpg", "d.jpg"})
        self.assertIn("could not join all images: 1 more models, of 2 images", said)
        self.assertIn("a.jpg, b.jpg: in another model, of 2 photographs", said)

    def test_no_model_is_a_failure_that_names_the_log(self):
        (self.folder / "colmap").mkdir()
        with self.assertRaisesRegex(Failure, "COLMAP found no poses: see .*poses.log"):
            self.best(options_of())

    def test_a_damaged_model_has_no_names(self):
        model = self.model(self.folder / "colmap" / "0", self.NAMES)
        (model / "images.bin").write_bytes((model / "images.bin").read_bytes()[:-30])
        self.assertEqual(colmap.images_in(model), {})


if __name__ == "__main__":
    main()
