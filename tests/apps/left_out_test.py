# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs that do no good are found and left out: blurred, dark and doubled ones."""

import random
import shutil
import struct
import unittest.mock

from colmap_databases import BLURRED, SHARP, Databases
from pipeline_folder import InFolder
from programs import main
from stand_ins import PHOTOGRAPHS, StandIns

from axial_pipeline import database, doubles, left_out
from axial_pipeline.failure import Failure


class Copies(InFolder):
    """Files with the same bytes."""

    def setUp(self):
        super().setUp()
        for name, content in (("a.jpg", "one"), ("b.jpg", "two"), ("c.jpg", "two"), ("dive/b.jpg", "two"),
                              ("d.jpg", "three")):
            self.write(name, content)
        self.names = ["a.jpg", "b.jpg", "c.jpg", "d.jpg", "dive/b.jpg"]

    def test_the_first_one_is_kept(self):
        self.assertEqual(doubles.identical(self.folder, self.names), {"c.jpg": "b.jpg", "dive/b.jpg": "b.jpg"})
        self.assertEqual(doubles.identical(self.folder, ["a.jpg", "b.jpg", "d.jpg"]), {})

    def test_the_one_that_is_needed_is_kept(self):
        self.assertEqual(doubles.identical(self.folder, self.names, {"c.jpg"}),
                         {"b.jpg": "c.jpg", "dive/b.jpg": "c.jpg"})

    def test_large_files_are_read_to_their_end(self):
        with unittest.mock.patch.object(doubles, "CHUNK", 2):
            self.write("e.jpg", "twO")
            self.assertNotIn("e.jpg", doubles.identical(self.folder, [*self.names, "e.jpg"]))

    def test_nothing_but_copies_is_refused(self):
        with self.assertRaisesRegex(Failure, "--images .*: all 3 photographs have the same contents"):
            doubles.identical(self.folder, ["b.jpg", "c.jpg", "dive/b.jpg"])

    def test_a_file_that_is_gone_is_named(self):
        with self.assertRaisesRegex(Failure, "--images .*/x.jpg: cannot be read: No such file"):
            doubles.identical(self.folder, ["a.jpg", "x.jpg"])


class Views(Databases):
    """Photographs without motion between them."""
    COUNT, LENGTH = 120, 128

    def scene(self, seed):
        """Features of a photograph: x, y, scale and descriptor."""
        draw = random.Random(seed)
        return [(draw.uniform(0, 480), draw.uniform(0, 360), draw.uniform(2, 9),
                 bytes(draw.choices(range(120), k=self.LENGTH))) for _ in range(self.COUNT)]

    def changed(self, scene, still=1.0, move=0.0, seed=1):
        """The same view again: a share of the features is there again, moved by some pixels."""
        others, kept = self.scene(seed), round(still * len(scene))
        return [(x + move, y, scale, look) for x, y, scale, look in scene[:kept]] + others[kept:]

    def views(self, scenes):
        """A database of photographs with these features, by name."""
        file = self.database({name: (1, SHARP) for name in scenes})
        with database.opened(file) as connection:
            for number, scene in enumerate(scenes.values(), 1):
                rows = [value for x, y, scale, _ in scene for value in (x, y, scale, 0, 0, scale)]
                connection.execute("UPDATE keypoints SET rows = ?, data = ? WHERE image_id = ?",
                                   (len(scene), struct.pack(f"<{len(rows)}f", *rows), number))
                connection.execute("UPDATE descriptors SET rows = ?, data = ? WHERE image_id = ?",
                                   (len(scene), b"".join(look for *_, look in scene), number))
        return file

    def dive(self, **more):
        """A dive of six views, and more photographs."""
        return self.views({**{f"{i}.jpg": self.scene(i) for i in range(6)}, **more})

    def test_a_view_without_motion_is_found(self):
        first = self.scene(3)
        file = self.dive(**{"3b.jpg": self.changed(first, move=0.6), "3c.jpg": self.changed(first, still=0.5, seed=8)})
        self.assertEqual(doubles.alike(file), {"3b.jpg": "3.jpg", "3c.jpg": "3.jpg"})
        self.assertEqual(doubles.alike(file, left_out=["3.jpg"]), {"3c.jpg": "3b.jpg"})

    def test_moved_and_other_views_are_kept(self):
        first = self.scene(3)
        self.assertEqual(doubles.alike(self.dive(**{"3b.jpg": self.changed(first, move=1.5),
                                                    "3c.jpg": self.changed(first, still=0.3, seed=8)})), {})

    def test_an_arm_of_a_strobe_makes_no_double(self):
        arm = [(430 + x % 40, 310 + x % 30, scale, look) for x, _, scale, look in self.scene(50)[:70]]
        scenes = {f"{i}.jpg": [*(arm if i < 2 else self.scene(60 + i)[:70]), *self.scene(i)[:50]] for i in range(6)}
        self.assertEqual(doubles.alike(self.views(scenes)), {})

    def test_features_at_rest_in_most_photographs_make_no_doubles(self):
        dirt = self.scene(50)
        scenes = {f"{i}.jpg": self.changed(dirt, 0.6, seed=i) for i in range(6)}
        self.assertEqual(doubles.alike(self.views(scenes)), {})

    def test_copies_in_other_folders_are_compared(self):
        with unittest.mock.patch.object(doubles, "WINDOW", 1):
            file = self.dive(**{"dive/3.jpg": self.changed(self.scene(3))})
            self.assertEqual(doubles.alike(file), {"dive/3.jpg": "3.jpg"})

    def test_no_database_has_none(self):
        self.assertEqual(doubles.alike(self.write("empty.db", "")), {})


class LeftOut(Databases):
    def setUp(self):
        super().setUp()
        photographs = {f"{i}.jpg": (2000, SHARP) for i in range(7)}
        self.found = self.database({**photographs, "blurred.jpg": (1500, BLURRED), "dark.jpg": (3, SHARP)})
        self.file = self.folder / "database.db"
        shutil.copyfile(self.found, self.file)

    def leave_out(self, **more):
        return self.said_by(lambda: left_out.leave_out(self.found, self.file, {"6.jpg": "2.jpg"}, **more))

    def test_each_kind_is_named_and_remembered(self):
        said = self.leave_out()
        named = (("blurred", "blurred.jpg"), ("dark", "dark.jpg"), ("doubled", "6.jpg"))
        self.assertEqual(said.splitlines(), [f"    1 {kind} photographs are left out (--keep-all keeps them): {name}"
                                             for kind, name in named])
        self.assertEqual(sorted(database.names(self.file).values()), [f"{i}.jpg" for i in range(6)])
        self.assertEqual(database.left_out(self.file), {
            "6.jpg": "the same file as 2.jpg", "blurred.jpg": "blurred",
            "dark.jpg": "dark or without contrast, with 3 features"})
        self.assertEqual(database.left_out(self.found), {})

    def test_a_repeated_step_leaves_out_the_same(self):
        said = self.leave_out()
        self.assertEqual(self.leave_out(), said)
        self.assertEqual(len(database.names(self.file)), 6)

    def test_a_photograph_that_has_the_known_length_is_refused(self):
        text = "images:0.jpg,dark.jpg,2"
        said = (f"--scale-from {text}: dark.jpg is left out, because it is dark or without contrast, with 3 features; "
                "name another photograph, or give --keep-all")
        with self.assertRaisesRegex(Failure, said):
            self.leave_out(needed={"0.jpg", "dark.jpg", "2"}, scale_from=text)
        self.assertEqual(len(database.names(self.file)), 9)

    def test_no_database_is_left_alone(self):
        empty = self.write("empty.db", "")
        self.assertEqual(self.said_by(left_out.leave_out, empty, empty, {"a.jpg": "b.jpg"}), "")


class InARun(StandIns):
    def setUp(self):
        super().setUp()
        self.write("images/copy.png", PHOTOGRAPHS[1])
        self.options = ["--until", "poses"]

    def test_copies_are_named_before_anything_runs(self):
        ended = self.ended(*self.options)
        said = ended.stdout[:ended.stdout.index("[1/")]
        self.assertIn("images: 1 photographs are copies of others, and are left out (--keep-all keeps them): copy.png "
                      "is 1.png", said)

    def test_they_can_be_kept(self):
        self.assertNotIn("copies", self.ended(*self.options, "--keep-all").stdout)

    def test_a_photograph_that_was_left_out_has_no_known_length(self):
        """In a run, and in one that continues after the matches."""
        Databases.database(self, {**{f"{i}.png": (2000, SHARP) for i in range(3)}, "copy.png": (3, SHARP)}, "found.db")
        self.add_to("colmap", '[ "$1" != feature_extractor ] || cp found.db out/features.db\n')
        self.write("images/copy.png", PHOTOGRAPHS[1] + b"other")
        scale = ["--scale-from", "images:0.png,copy.png,2"]
        said = ("reconstruct: --scale-from images:0.png,copy.png,2: copy.png is left out, because it is dark or "
                "without contrast, with 3 features; name another photograph, or give --keep-all\n")
        self.assertEqual(self.ended(*self.options, *scale).stderr, said)
        self.assertEqual(self.ended(*self.options).stderr, "")
        again = self.ended(*self.options, *scale)
        self.assertEqual((again.stderr, again.stdout.count("done before")), (said, 4))
        self.assertEqual(self.ended(*self.options, *scale, "--keep-all").stderr, "")

    def test_another_choice_repeats_the_matches(self):
        self.ended(*self.options)
        again = self.ended(*self.options, "--scale-from", "images:0.png,copy.png,2")
        self.assertIn("1.png is copy.png", again.stdout)
        self.assertNotIn("matches: done before", again.stdout)


if __name__ == "__main__":
    main()
