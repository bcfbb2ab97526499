# SPDX-License-Identifier: GPL-3.0-or-later
"""The pairs that `reconstruct --matcher` lets COLMAP match: options, GPS positions of photographs, and
the positions in COLMAP's database."""

import itertools
import pathlib
import shutil
import struct
import subprocess
import unittest
import unittest.mock

from colmap_databases import make_tables
from pipeline_folder import InFolder, options_of, simulate
from programs import main, new_folder, png

from axial_pipeline import colmap, matching, photographs
from axial_pipeline.database import opened, rows_of
from axial_pipeline.exif import exif_in
from axial_pipeline.failure import Failure

ALL = (2, 4, 6)  # tags of latitude, longitude and altitude


def exif(tags=ALL, order="<", seconds=3):
    """Exif data in which the GPS table has these tags. Latitude and longitude are 1 degree, 2 minutes
    and `seconds`; the altitude is 1 m."""
    entries = [(tag, 5, 1 if tag == 6 else 3) for tag in tags]
    values = 26 + 2 + 12 * len(entries) + 4
    tables = struct.pack(f"{order}HHHIII", 1, 0x8825, 4, 1, 26, 0)
    tables += struct.pack(f"{order}H", len(entries))
    for number, entry in enumerate(entries):
        tables += struct.pack(f"{order}HHII", *entry, values + 24 * number)
    tables += bytes(4) + struct.pack(f"{order}6I", 1, 1, 2, 1, seconds, 1) * len(entries)
    return {"<": b"II*\0\x08\0\0\0", ">": b"MM\0*\0\0\0\x08"}[order] + tables


FRAME = b"\xff\xd8\xff\xc0" + struct.pack(">HBHHB", 8, 8, 3, 4, 1) + b"\xff\xd9"


def jpeg(photograph=FRAME, **options):
    """A JPEG file with Exif data before the rest of `photograph`."""
    segment = b"Exif\0\0" + exif(**options)
    return (photograph[:2] + b"\xff\xe1" + struct.pack(">H", len(segment) + 2) + segment
            + photograph[2:])


def check(given):
    matching.check(given, photographs.found_in(given.images).images)


def pairs(database):
    """The pairs of image names that COLMAP compared."""
    names = dict(rows_of(database, "SELECT image_id, name FROM images"))
    return {tuple(sorted((names[pair // 2147483647], names[pair % 2147483647])))
            for pair, in rows_of(database, "SELECT pair_id FROM two_view_geometries")}


class Matching(InFolder):
    """With a stand-in for COLMAP that knows all options."""

    def setUp(self):
        super().setUp()
        self.knows("--SiftMatching.use_gpu --SpatialMatching.is_gps ")
        self.put_on_path()
        for name in "abc":
            self.write(f"images/{name}.jpg", jpeg())
        self.positions = self.write("positions.txt", "a.jpg 5e5 0 0\nb.jpg 5e5 1 0\nc.jpg 5e5 3 -2\n")

    def knows(self, options):
        self.put_script("colmap", f"echo '{options}'")

    def given(self, matcher, scale_from="", vocabulary=""):
        return options_of(matcher=matcher, scale_from=scale_from, vocabulary=vocabulary,
                          images=str(self.folder / "images"))

    def with_positions(self):
        return self.given("spatial", f"positions:{self.positions}")

    def failure_of(self, given):
        with self.assertRaises(Failure) as caught:
            check(given)
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def database(self, names="abc", prior=None):
        path = self.folder / "features.db"
        path.unlink(missing_ok=True)
        with opened(path) as connection:
            make_tables(connection, (4, 3))
            connection.executemany("INSERT INTO images (name, camera_id, prior_tx, prior_ty, prior_tz) "
                                   "VALUES (?, 1, ?, ?, ?)", [(f"{name}.jpg", *(prior or [None] * 3))
                                                              for name in names])
        return path

    def step(self, given):
        return matching.step(given, self.folder / "features.db", self.folder / "database.db")

    def prepared(self, given):
        """What the step says before COLMAP matches, and the positions in the database by name."""
        said = self.said_by(self.step(given).before)
        found = rows_of(self.folder / "database.db", "SELECT name, prior_tx, prior_ty, prior_tz FROM images")
        return said, {name: position for name, *position in found}

    def test_every_matcher_has_its_command(self):
        tree = str(self.write("tree.bin", "tree"))
        neighbours = ["--SpatialMatching.max_num_neighbors", "31", "--SpatialMatching.max_distance",
                      "1000000"]
        for given, command, more, reads in (
                (self.given("exhaustive"), "exhaustive", [], []),
                (self.given("exhaustive", f"positions:{self.positions}"), "exhaustive", [], []),
                (self.given("sequential"), "sequential", [], []),
                (self.given("spatial"), "spatial", neighbours, []),
                (self.with_positions(), "spatial", ["--SpatialMatching.is_gps", "0",
                                                    "--SpatialMatching.ignore_z", "0", *neighbours],
                 [self.positions]),
                (self.given("vocabulary", vocabulary=tree), "vocab_tree",
                 ["--VocabTreeMatching.vocab_tree_path", tree], [pathlib.Path(tree)])):
            check(given)
            step = self.step(given)
            self.assertEqual(step.command, ["colmap", f"{command}_matcher", "--database_path",
                                            str(self.folder / "database.db"), *more,
                                            "--SiftMatching.use_gpu", "0"])
            self.assertEqual(step.reads, reads)

    def test_positions_are_written_with_their_differences(self):
        self.database("abcd", (1, 2, 3))
        for _ in range(2):  # as after a kill
            said, found = self.prepared(self.with_positions())
            self.assertEqual(found, {"a.jpg": [1, 1, 3], "b.jpg": [1, 2, 3], "c.jpg": [1, 4, 1],
                                     "d.jpg": [0, 0, 0]})
            self.assertEqual(said, "    1 of 4 photographs have no position and are not matched\n")

    def test_an_unknown_unit_is_told_once(self):
        self.database()
        for name in "abc":
            self.write(f"images/{name}.jpg", png([bytes(4)] * 3))
        self.positions.write_text("a.jpg 16 54 0\nb.jpg 16 54.0001 0\nc.jpg 16 54.0002 0\n")
        told = self.said_by(check, self.with_positions())
        self.assertIn("they are taken as degrees to find neighbours", told)
        said, found = self.prepared(self.with_positions())
        self.assertEqual(said, "")
        self.assertAlmostEqual(found["b.jpg"][1] - found["a.jpg"][1], 11.1, delta=0.05)

    def test_gps_positions_stay(self):
        self.database(prior=(54.5, 10, 0))
        self.assertEqual(self.prepared(self.given("spatial")),
                         ("", {f"{name}.jpg": [54.5, 10, 0] for name in "abc"}))

    def test_other_matchers_change_nothing(self):
        self.database()
        for matcher in ("exhaustive", "sequential", "vocabulary"):
            said, found = self.prepared(self.given(matcher, f"positions:{self.positions}"))
            self.assertEqual((said, found["a.jpg"]), ("", [None] * 3))

    def test_features_without_positions_are_a_failure(self):
        self.database()
        with self.assertRaisesRegex(Failure, "--matcher spatial: none of the photographs in .* have"):
            self.step(self.given("spatial")).before()
        self.database("xyz")
        (self.folder / "database.db").unlink()
        with self.assertRaisesRegex(Failure, "positions.txt names 0 photographs as in"):
            self.step(self.with_positions()).before()

    def test_a_damaged_database_is_named(self):
        self.write("features.db", "no database" * 100)
        with self.assertRaisesRegex(Failure, "features.db: is not a database of COLMAP, or is damaged"):
            self.step(self.given("spatial")).before()

    def test_a_newer_table_is_left_alone(self):
        with opened(self.folder / "features.db") as connection:
            connection.execute("CREATE TABLE images (image_id INTEGER, name TEXT)")
        self.assertEqual(self.said_by(self.step(self.given("spatial")).before), "")

    def test_photographs_without_gps_are_refused(self):
        images = self.folder / "images"
        for name in "ab":
            self.write(f"images/{name}.jpg", jpeg(tags=[2, 4]))
        end = ("a GPS position (latitude, longitude and altitude); give --scale-from positions:FILE or "
               "choose another --matcher")
        self.assertEqual(self.failure_of(self.given("spatial", "images:a.jpg,b.jpg,1")),
                         f"--matcher spatial: 1 of the photographs in {images} has {end}")
        (images / "c.jpg").unlink()
        self.assertEqual(self.failure_of(self.given("spatial")),
                         f"--matcher spatial: none of the photographs in {images} have {end}")
        self.write("images/dive 2/d.jpg", jpeg())
        self.write("images/dive 2/e.jpg", jpeg())
        check(self.given("spatial"))

    def test_wrong_options_are_refused(self):
        for given, said in (
                (self.given("vocabulary"), "--matcher vocabulary: needs --vocabulary FILE, a vocabulary "
                 "tree for COLMAP (docs/photographs.md)"),
                (self.given("vocabulary", vocabulary="none"), "--vocabulary none: file not found"),
                (self.given("vocabulary", vocabulary=str(self.folder)),
                 f"--vocabulary {self.folder}: file not found"),
                (self.given("spatial", vocabulary="none"),
                 "--vocabulary none: is only for --matcher vocabulary")):
            self.assertEqual(self.failure_of(given), said)
        self.knows("--SiftMatching.use_gpu ")
        self.assertIn("--matcher spatial: this version of COLMAP takes no positions",
                      self.failure_of(self.with_positions()))
        check(self.given("spatial"))
        self.write("positions.txt", "a.jpg 1 2 3\nb.jpg 1 2\n")
        self.assertEqual(self.failure_of(self.with_positions()),
                         f"{self.positions}:2: must be NAME X Y Z with finite numbers")


class Gps(unittest.TestCase):
    def test_only_a_whole_position_counts(self):
        for order in "<>":
            for count in range(4):
                for tags in itertools.combinations(ALL, count):
                    data = jpeg(tags=tags, order=order)
                    self.assertEqual(exif_in(data).has_position, tags == ALL, (order, tags))

    def test_forms_of_files(self):
        for content, expected in ((exif(), True), (exif(order=">"), True), (exif([2]), False),
                                  (b"\x89PNG\r\n\x1a\n" + b"\0\0\0\1eXIf" + exif(), True),
                                  (b"\x89PNG\r\n\x1a\n", False), (b"", False), (b"text", False)):
            self.assertEqual(exif_in(content).has_position, expected)

    def test_broken_data_have_no_position(self):
        """Every file that ends within the tables has none. Every file with one wrong byte is read
        without an error."""
        whole = jpeg()
        for end in range(len(whole) - len(FRAME) + 2 - 3 * 24 - 4):
            self.assertFalse(exif_in(whole[:end]).has_position, end)
        for at in range(len(whole)):
            exif_in(whole[:at] + b"\xff" + whole[at + 1:])


@unittest.skipUnless(shutil.which("colmap") and
                     colmap.has_option("spatial_matcher", "SpatialMatching.is_gps"),
                     "COLMAP is not installed or does not take positions as COLMAP 3.8 does")
class WithColmap(InFolder):
    """COLMAP pairs photographs by the positions that it is given."""

    @classmethod
    def setUpClass(cls):
        cls.scene = pathlib.Path(new_folder(cls.addClassCleanup)) / "scene"
        simulate(cls.scene, "transect", 8, (160, 120))

    def matched(self, images, scale_from=""):
        """The pairs that COLMAP compares with two neighbours of each photograph."""
        given = options_of(matcher="spatial", scale_from=scale_from, images=str(images))
        features, database = self.folder / "features.db", self.folder / "database.db"
        with unittest.mock.patch.object(matching, "NEIGHBOURS", 2):
            check(given)
            step = matching.step(given, features, database)
        self.called(colmap.features(features, images, "PINHOLE"))
        self.said = self.said_by(step.before)
        self.called(step.command)
        return pairs(database)

    def called(self, command):
        ended = subprocess.run(list(map(str, command)), capture_output=True, text=True)
        self.assertEqual(ended.returncode, 0, ended.stderr)

    def neighbours(self, places):
        """The pairs of each place on a line with its two nearest places."""
        return {tuple(sorted((name, other))) for name in places for other in sorted(
            (other for other in places if other != name),
            key=lambda other: abs(places[other] - places[name]))[:2]}

    def test_positions_of_a_file_choose_the_pairs(self):
        """The places, at uneven distances along the depth, differ from those of the views. One
        photograph has no place."""
        images = self.scene / "water"
        names = sorted(path.name for path in images.iterdir())
        places = {name: (3 * number % 7) ** 1.5 for number, name in enumerate(names[1:])}
        file = self.write("positions.txt", "".join(f"{name} 500000 5000000 {place}\n"
                                                   for name, place in places.items()))
        self.assertEqual(self.matched(images, f"positions:{file}"), self.neighbours(places))
        self.assertIn("1 of 8 photographs have no position", self.said)

    def test_gps_positions_choose_the_pairs(self):
        photographs = sorted((self.scene / "water").iterdir())
        places = {path.name: (3 * number % 7) ** 2 for number, path in enumerate(photographs[1:])}
        for path in photographs:
            self.write(f"images/{path.name}", jpeg(path.read_bytes(), seconds=places[path.name])
                       if path.name in places else path.read_bytes())
        self.assertEqual(self.matched(self.folder / "images"), self.neighbours(places))
        self.assertIn("1 of 8 photographs have no position", self.said)


if __name__ == "__main__":
    main()
