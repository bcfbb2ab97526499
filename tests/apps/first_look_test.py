# SPDX-License-Identifier: GPL-3.0-or-later
"""The look at the photographs for `reconstruct --check`, with a stand-in for COLMAP."""

import argparse
import array
import os
import pathlib
import unittest
import unittest.mock

from colmap_databases import BLURRED, SHARP, Databases
from programs import main

from axial_pipeline import database, first_look
from axial_pipeline.failure import Failure

SIZE = (480, 360)
# COLMAP's stand-in copies the database that is meant for the threshold, and notes what it was asked for.
COLMAP = """case "$*" in *--help*) echo "--SiftExtraction.use_gpu --SiftExtraction.max_image_size \
--SiftExtraction.peak_threshold --SiftMatching.use_gpu "; exit ;; esac
echo "$*" >> {folder}/commands
case "$*" in
  *peak_threshold*) cp {folder}/weak.db "$3" ;;
  matches_importer*) cp "$3" {folder}/matched.db; cp "$5" {folder}/pairs.txt ;;
  feature_extractor*) [ -f "$3" ] || cp {folder}/plain.db "$3" ;;
esac
"""


def add_matches(file, pair, matches):
    """Verified matches of a pair of photographs: pairs of features."""
    with database.opened(file) as connection:
        data = array.array("I", [number for match in matches for number in match])
        connection.execute("INSERT INTO two_view_geometries VALUES (?, ?, 2, ?)",
                           (database.PAIR * pair[0] + pair[1], len(matches), data.tobytes()))


def same(count):
    """Matches of features with the same number in both photographs."""
    return [(number, number) for number in range(count)]


class Samples(unittest.TestCase):
    NAMES = [f"{number:03}" for number in range(100)]

    def test_all_photographs_of_a_small_dive(self):
        self.assertEqual(first_look.sample_of(self.NAMES[:7], 7), self.NAMES[:7])

    def test_pairs_of_neighbours_of_a_large_one(self):
        for most in (2, 9, 10, 99):
            chosen = first_look.sample_of(self.NAMES, most)
            self.assertLessEqual(len(chosen), most)
            pairs = first_look.neighbours_in(self.NAMES, chosen)
            self.assertEqual({name for pair in pairs for name in pair}, set(chosen))
        self.assertEqual(first_look.sample_of(self.NAMES, 5), ["000", "001", "049", "050"])
        self.assertEqual(first_look.neighbours_in(self.NAMES, ["000", "001", "049", "050"]),
                         [("000", "001"), ("049", "050")])

    def test_the_time_is_limited(self):
        with unittest.mock.patch.object(os, "sched_getaffinity", return_value={0, 1}):
            small, large = (first_look.most_photographs([size] * 9) for size in ((480, 360), (4000, 3000)))
            self.assertEqual(first_look.most_photographs([(10**6, 10**6)]), 2)
        self.assertGreater(small, 90)
        self.assertTrue(30 < large < 40, large)


class Looks(Databases):
    def setUp(self):
        super().setUp()
        self.put_script("colmap", COLMAP.format(folder=self.folder))
        self.put_on_path()
        self.given = argparse.Namespace(images="images")

    def rows(self, photographs, sizes=None):
        sizes = sizes or dict.fromkeys(photographs, SIZE)
        found = {}
        for word, text in first_look.rows(self.given, sizes):
            found.setdefault(word, []).append(text)
        return found

    def commands(self):
        return (self.folder / "commands").read_text().splitlines()

    def test_a_sound_dive(self):
        photographs = {f"{i}.jpg": (1000 + i, SHARP) for i in range(4)}
        self.database(photographs, "plain.db")
        for pair in ((1, 2), (2, 3), (3, 4)):
            add_matches(self.folder / "plain.db", pair, same(800))
        self.assertEqual(self.rows(photographs), {
            "looked at": ["4 of 4 photographs, made smaller to 640 pixels if they are larger"],
            "contrast": ["1001 features in a photograph (median; 1000 to 1003)"],
            "blur": ["no photograph is blurred by more than 2 pixels beside the others"],
            "overlap": ["about 100% between neighbours by name (median of 3 pairs; 100% to 100%)"]})
        self.assertIn("--SiftExtraction.max_image_size 640", self.commands()[0])
        self.assertEqual(len(self.commands()), 2)
        self.assertEqual({one.count for one in database.features(self.folder / "matched.db").values()}, {800})

    def test_names_may_have_blanks(self):
        """COLMAP splits the lines of its list of pairs at blanks."""
        photographs = dict.fromkeys(("dive 1/0.jpg", "dive 1/1.jpg"), (1000, SHARP))
        add_matches(self.database(photographs, "plain.db"), (1, 2), same(800))
        self.assertIn("about 100% between", self.rows(photographs)["overlap"][0])
        self.assertEqual((self.folder / "pairs.txt").read_text(), "1 2\n")
        self.assertEqual(database.names(self.folder / "matched.db"), {1: "1", 2: "2"})

    def test_photographs_that_do_no_good_have_no_part_in_the_overlap(self):
        photographs = {"0.jpg": (2000, SHARP), "1.jpg": (1500, BLURRED), "2.jpg": (2000, SHARP), "3.jpg": (2000, SHARP),
                       "4.jpg": (2, SHARP)}
        file = self.database(photographs, "plain.db")
        self.database({"4.jpg": (3, SHARP)}, "weak.db")
        add_matches(file, (1, 3), same(800))
        found = self.rows(photographs)
        probably = "which the run will probably leave out"
        self.assertEqual(found["blurred"], [f"1 of 5, {probably}: 1.jpg"])
        self.assertEqual(found["dark"], [f"1 of 5, {probably}: 4.jpg (dark or without contrast, with 3 features)"])
        self.assertEqual(found["contrast"][1], "little in 1 of 5, as in haze or over sand; weaker features are taken, "
                         "too: 4.jpg")
        self.assertIn("no other photograph is blurred", found["blur"][0])
        self.assertEqual(found["overlap"], ["about 100% between neighbours by name (median of 1 pairs; 100% to 100%)",
                                            "none found in 1 of 2 pairs of neighbours by name: 2.jpg and 3.jpg"])

    def test_haze_is_looked_at_with_weak_features(self):
        self.database({f"{i}.jpg": (15, SHARP) for i in range(3)}, "plain.db")
        weak = self.database({f"{i}.jpg": (900, SHARP) for i in range(3)}, "weak.db")
        add_matches(weak, (1, 2), same(9))
        found = self.rows([f"{i}.jpg" for i in range(3)])
        self.assertEqual(found["contrast"][0], "15 features in a photograph (median; 15 to 15)")
        self.assertNotIn("dark", found)

    def test_what_colmap_skips_is_named(self):
        self.database({"a.jpg": (2000, SHARP), "b.jpg": (2000, SHARP)}, "plain.db")
        found = self.rows(["a.jpg", "b.jpg", "c.jpg"])
        self.assertEqual(found["looked at"][0][:6], "2 of 3")
        self.assertEqual(found["unreadable"], ["COLMAP skips c.jpg"])
        (self.folder / "plain.db").write_bytes(b"")
        self.assertEqual(list(self.rows(["a.jpg", "b.jpg"])), ["looked at", "unreadable"])

    def test_each_size_is_given_to_colmap_by_itself(self):
        self.database({"a.jpg": (2000, SHARP), "b.jpg": (2000, SHARP)}, "plain.db")
        self.rows(["a.jpg", "b.jpg"], {"a.jpg": SIZE, "b.jpg": None})
        self.assertEqual(sum(line.startswith("feature_extractor") for line in self.commands()), 2)

    def test_a_failure_of_colmap_is_one_line(self):
        self.put_script("colmap", "exit 3")
        with self.assertRaisesRegex(Failure, r"^--images images: COLMAP could not find and match features of "
                                    r"photographs made smaller \(features: exit code 3\)$"):
            self.rows(["a.jpg", "b.jpg"])

    def test_nothing_is_left(self):
        self.database({"a.jpg": (2000, SHARP), "b.jpg": (2000, SHARP)}, "plain.db")
        self.rows(["a.jpg", "b.jpg"])
        folder = pathlib.Path(self.commands()[0].split()[2]).parent
        self.assertIn("axial_first_check_", folder.name)
        self.assertFalse(folder.exists())


class Overlaps(Databases):
    def test_only_coarse_features_are_matched(self):
        file = self.database({"a.jpg": (2000, SHARP), "b.jpg": (500, SHARP)})
        first_look.keep_coarse(file)
        rows = database.rows_of(file, "SELECT k.rows, k.cols, length(k.data), d.rows, length(d.data) FROM keypoints k "
                                "JOIN descriptors d USING (image_id) ORDER BY image_id")
        self.assertEqual(rows, [(800, 2, 6400, 800, 800 * 128), (500, 6, 12000, 500, 500 * 128)])

    def test_the_overlap_is_the_part_with_matches(self):
        file = self.database({"a.jpg": (700, SHARP), "b.jpg": (700, SHARP)})
        places = features_at(file)
        left = [number for number, x in enumerate(places["a.jpg"]) if x < 240]
        right = [number for number, x in enumerate(places["b.jpg"]) if x >= 120][:len(left)]
        add_matches(file, (1, 2), list(zip(left, right)))
        self.assertAlmostEqual(first_look.overlaps_in(file, [("b.jpg", "a.jpg")])["b.jpg", "a.jpg"], (0.5 + 0.75) / 2)


def features_at(file):
    """The x of the features of each photograph, by name."""
    found = {}
    for name, data in database.rows_of(file, "SELECT name, data FROM images JOIN keypoints USING (image_id)"):
        found[name] = database.columns_in(data, 6)[0]
    return found


if __name__ == "__main__":
    main()
