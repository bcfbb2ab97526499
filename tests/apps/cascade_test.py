# SPDX-License-Identifier: GPL-3.0-or-later
"""`reconstruct --matcher cascade`: few features for pairs that look alike, all features where they overlap, and what
is missing. A stand-in for COLMAP finds the matches."""

import array
import contextlib
import fnmatch
import functools
import os
import random
import shutil
import subprocess
import sys
import unittest
import unittest.mock

from colmap_databases import add_photograph, make_tables
from pipeline_folder import InFolder, options_of, simulate
from programs import main
from stand_ins import StandIns, photograph

from axial_pipeline import cascade, colmap, database, matching, overview, similar, step_kinds, steps
from axial_pipeline.failure import Failure

SIZE, FEATURES = (80, 80), 400  # of a photograph
# Matches equal descriptors. Writes a line for each pair that it matches into the file `matched`, and its options
# into the file `called`. Fails in the middle of a list for the real database while there is a file `fail`.
COLMAP = """#!{python}
import array, os, sqlite3, sys
words = sys.argv[1:]
if "--help" in words:
    print("--SiftMatching.use_gpu --SiftMatching.min_num_inliers ")
    sys.exit()
value = lambda option, default=None: words[words.index(option) + 1] if option in words else default
file = value("--database_path")
print(os.path.basename(file), *words[5:], file=open("called", "a"))
connection = sqlite3.connect(file)
ids = dict(connection.execute("SELECT name, image_id FROM images"))
data = {{image: data or b"" for image, data in connection.execute("SELECT image_id, data FROM descriptors")}}
features = {{image: {{data[image][k:k + 128]: k // 128 for k in range(0, len(data[image]), 128)}} for image in data}}
done = {{pair for pair, in connection.execute("SELECT pair_id FROM two_view_geometries")}}
for number, line in enumerate(open(value("--match_list_path"))):
    one, other = sorted(ids[name] for name in line.split())
    pair = 2147483647 * one + other
    if pair in done:
        continue
    if number == 5 and file.endswith("database.db") and os.path.exists("fail"):
        connection.commit()
        sys.exit("no memory")
    both = [(features[one][key], features[other][key]) for key in features[one] if key in features[other]]
    both = both if len(both) >= int(value("--SiftMatching.min_num_inliers", 15)) else []
    numbers = array.array("I", [number for match in both for number in match])
    connection.execute("INSERT INTO two_view_geometries VALUES (?, ?, 2, ?)",
                       (pair, len(both), numbers.tobytes() or None))
    print(os.path.basename(file), one, other, file=open("matched", "a"))
connection.commit()
"""


@functools.cache
def descriptor(number):
    return random.Random(number).randbytes(database.DESCRIPTOR)


class WithStandIn(InFolder):
    """A track along which each photograph moves by a quarter of its width. Photographs see points of the seabed,
    of which every fourth has a large feature."""

    def setUp(self):
        super().setUp()
        self.write("colmap", COLMAP.format(python=sys.executable)).chmod(0o755)
        self.put_on_path()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder)
        self.features, self.full = self.folder / "features.db", self.folder / "database.db"

    def photograph(self, connection, image, points, name=None, is_large=lambda point: point % 4 == 0):
        """Adds a photograph that sees `points`, the numbers of columns of ten points each."""
        numbers = [10 * column + k for column in points for k in range(10)]
        keypoints = array.array("f")
        for place, column in enumerate(points):
            for k in range(10):
                keypoints.extend((SIZE[0] * place / len(points), 8 * k + 1,
                                  9 if is_large(10 * column + k) else 2, 0))
        add_photograph(connection, image, name or f"dive 1/{image:03}.jpg", 4, keypoints.tobytes(),
                       b"".join(map(descriptor, numbers)))

    def track(self, count=36, **more):
        self.features.unlink(missing_ok=True)
        with database.opened(self.features) as connection:
            make_tables(connection, SIZE)
            for image in range(1, count + 1):
                self.photograph(connection, image, range(4 * image, 4 * image + 16), **more)

    def given(self, **more):
        return options_of(**{"matcher": "cascade", "images": str(self.folder), **more})

    def step(self, prepare=lambda: None, **more):
        return matching.step(self.given(**more), self.features, self.full, prepare)

    def matched(self, step=None):
        """What a run of the step prints."""
        with unittest.mock.patch.object(similar, "MOST_SHARE", 1), unittest.mock.patch.object(overview, "ALL", 9):
            return self.said_by(steps.run_all, [step or self.step()], self.folder)

    def pairs_of(self, file):
        """The pairs that COLMAP matched in this database, in order."""
        lines = [line.split() for line in (self.folder / "matched").read_text().splitlines()]
        return [(int(one), int(other)) for name, one, other in lines if name == file]

    def geometries(self):
        return database.matches_of_pairs(self.full)

    def beside(self):
        return sorted(path.name for path in cascade.files_beside(self.full) if path.exists())


class Steps(WithStandIn):
    def test_overlapping_photographs_are_matched(self):
        self.track()
        said = self.matched()
        pairs = self.pairs_of("database.db")
        self.assertEqual(len(pairs), len(set(pairs)))
        self.assertIn(f"    matched {len(pairs)} of 630 pairs\n", said)
        self.assertEqual(set(self.geometries()), {(one, other) for one in range(1, 37)
                                                  for other in range(one + 1, min(one + 4, 37))})
        self.assertLess(len(pairs), 630 / 4)
        self.assertEqual(database.names(self.full), database.names(self.features))
        self.assertEqual(self.beside(), [])
        self.assertIn("matches: done before", self.matched())

    def test_every_run_matches_the_same(self):
        self.track()
        self.matched()
        first = (self.folder / "matched").read_text()
        (self.folder / "matched").unlink()
        shutil.rmtree(self.folder / "steps")
        self.matched()
        self.assertEqual((self.folder / "matched").read_text(), first)

    def test_what_the_largest_features_do_not_show_is_found(self):
        """Both halves of the track see the same points only in photographs 17 to 20, and there only small features.
        Photographs 18 and 19 follow each other; photographs 17 and 19 see the same part of 18."""
        with database.opened(self.features) as connection:
            make_tables(connection, SIZE)
            for image in range(1, 37):
                first = 4 * image if image < 19 else 1000 + 4 * image
                points = [*range(first, first + 16), *(range(500, 504) if image in (17, 18, 19, 20) else ())]
                self.photograph(connection, image, points, is_large=lambda point: point % 4 == 0 and not
                                5000 <= point < 5040)
        with unittest.mock.patch.object(overview, "FEATURES", 40), unittest.mock.patch.object(overview, "BY_NAME", 1):
            said = self.matched()
        found = set(self.geometries())
        self.assertTrue({(one, other) for one in (17, 18) for other in (19, 20)} <= found)
        self.assertIn(" more pairs with all features\n", said)

    def test_a_killed_run_goes_on(self):
        self.track()
        self.matched()
        whole, pairs = self.geometries(), self.pairs_of("database.db")
        for path in (self.full, self.folder / "matched"):
            path.unlink()
        shutil.rmtree(self.folder / "steps")
        self.write("fail", "")
        with self.assertRaisesRegex(Failure, "matches: exit code 1, its output is in .*/logs/matches-1.log"), \
                contextlib.redirect_stderr(None):
            self.matched()
        self.assertEqual(len(self.pairs_of("database.db")), 5)
        (self.folder / "fail").unlink()
        prepared = []
        self.matched(self.step(lambda: prepared.append(database.names(self.full))))
        self.assertEqual(prepared, [database.names(self.features)])
        self.assertEqual(self.pairs_of("database.db"), pairs)
        self.assertEqual(len(self.pairs_of("overview.db")), len(set(self.pairs_of("overview.db"))))
        self.assertEqual(self.geometries(), whole)
        self.assertEqual((database.names(self.full), self.beside()), (database.names(self.features), []))

    def test_another_matcher_removes_what_a_killed_run_left(self):
        self.track()
        self.write("fail", "")
        with self.assertRaises(Failure), contextlib.redirect_stderr(None):
            self.matched()
        self.assertEqual(self.beside(), ["match_pairs.txt", "overview.db", "overview_pairs.txt"])
        step = self.step(matcher="exhaustive")
        self.assertTrue({self.full, *cascade.files_beside(self.full)} <= set(step.changed))

    def test_all_files_belong_to_the_step(self):
        patterns = step_kinds.KINDS["matches"].writes
        for path in [self.full, *cascade.files_beside(self.full)]:
            self.assertTrue(any(fnmatch.fnmatchcase(path.name, one) for one in patterns), path)

    def test_nothing_alike_is_tried_with_neighbours_by_name(self):
        with database.opened(self.features) as connection:
            make_tables(connection, SIZE)
            for image in range(1, 6):
                self.photograph(connection, image, range(100 * image, 100 * image + 16))
        with unittest.mock.patch.object(overview, "BY_NAME", 1), unittest.mock.patch.object(cascade, "FURTHER", 0):
            self.assertIn("    matched 4 of 10 pairs\n", self.matched())
        self.assertEqual(self.pairs_of("database.db"), [(1, 2), (2, 3), (3, 4), (4, 5)])

    def test_an_overview_that_a_kill_left_half_written_is_replaced(self):
        self.track(10)
        self.write("overview.db.tmp", "half" * 5000)
        self.assertIn(" of 45 pairs\n", self.matched())
        self.assertEqual(self.beside(), [])

    def test_removed_photographs_are_not_matched(self):
        self.track()
        gone = "dive 1/007.jpg"
        self.matched(self.step(lambda: database.leave_out(self.full, {gone: "blurred"})))
        self.assertEqual(len(database.names(self.full)), 35)
        self.assertFalse([pair for file in ("overview.db", "database.db") for pair in self.pairs_of(file) if 7 in pair])

    def test_a_photograph_without_features_is_no_obstacle(self):
        self.track(31)
        with database.opened(self.features) as connection:
            self.photograph(connection, 32, [])
            connection.execute("INSERT INTO images (image_id, name, camera_id) VALUES (33, 'none.jpg', 1)")
        with database.opened(self.features) as connection:
            connection.execute("INSERT INTO descriptors VALUES (33, 0, 128, NULL)")
        self.assertIn(" of 528 pairs\n", self.matched())

    def test_further_options_reach_colmap(self):
        self.track()
        step = self.step(matches="--SiftMatching.min_num_inliers 20 --SiftMatching.max_ratio=0.9")
        self.assertNotEqual(step.fingerprint(), self.step().fingerprint())
        self.matched(step)
        few, full, *_ = (self.folder / "called").read_text().splitlines()
        self.assertEqual(few, "overview.db --SiftMatching.min_num_inliers 6 --SiftMatching.max_ratio=0.9 "
                         "--SiftMatching.use_gpu 0")
        self.assertEqual(full, "database.db --SiftMatching.min_num_inliers 20 --SiftMatching.max_ratio=0.9 "
                         "--SiftMatching.use_gpu 0")
        self.assertEqual(cascade.without_least_matches(["--SiftMatching.min_num_inliers=20", "--a", "1"]), ["--a", "1"])

    def test_a_damaged_database_is_named(self):
        self.write("features.db", "no database" * 100)
        with self.assertRaisesRegex(Failure, "features.db: is not a database of COLMAP, or is damaged"):
            self.step().before()


class Overview(WithStandIn):
    def test_the_largest_features_are_copied(self):
        self.track(3)
        with unittest.mock.patch.object(overview, "FEATURES", 40):
            overview.write(self.folder / "overview.db", self.features)
        with database.opened(self.folder / "overview.db") as connection:
            self.assertEqual(connection.execute("PRAGMA user_version").fetchone(), (3800,))
            self.assertEqual(connection.execute("SELECT prior_focal_length FROM cameras").fetchall(), [(0,)])
            self.assertEqual(connection.execute("SELECT image_id, name FROM images").fetchall(),
                             [(1, "1"), (2, "2"), (3, "3")])
            rows, data = connection.execute("SELECT rows, data FROM descriptors WHERE image_id = 2").fetchone()
            self.assertEqual(connection.execute("SELECT rows, cols, length(data) FROM keypoints").fetchall(),
                             [(40, 4, 640)] * 3)
        large = [point for point in range(80, 240) if point % 4 == 0]
        self.assertEqual((rows, data), (40, b"".join(map(descriptor, large))))
        self.assertEqual(database.names(self.features)[1], "dive 1/001.jpg")

    def test_scales_are_those_of_all_forms_of_keypoints(self):
        for columns, numbers, coarsest in ((6, [0, 0, 1, 0, 0, 1, 0, 0, 3, 0, 0, -3, 0, 0, 0, 2, 2, 0], [1, 2]),
                                           (4, [0, 0, 1, 9, 0, 0, 2, 0, 0, 0, 2, 0], [1, 2]),
                                           (2, [0, 0, 1, 1], [0, 1])):
            scales = database.scales_in(database.columns_in(array.array("f", numbers).tobytes(), columns))
            self.assertEqual(database.coarsest(scales, 2), coarsest)

    def test_candidates_are_alike_near_or_follow_each_other(self):
        named = {5: "a", 4: "b", 3: "c", 2: "d", 1: "e"}
        self.assertEqual(len(overview.candidates(named, {}, {})), 10)
        with unittest.mock.patch.object(overview, "ALL", 4), \
                unittest.mock.patch.object(overview, "BY_NAME", 1), \
                unittest.mock.patch.object(overview, "NEAREST", 1):
            self.assertEqual(overview.candidates(named, {5: [3], 1: []}, {}), [(1, 2), (2, 3), (3, 4), (3, 5), (4, 5)])
            self.assertEqual(overview.candidates(named, {}, {1: (0, 0), 5: (1, 0), 3: (9, 0)}),
                             [(1, 2), (1, 5), (2, 3), (3, 4), (3, 5), (4, 5)])

    def test_positions_are_a_hint(self):
        self.track(4)
        names = database.names(self.features)
        file = self.write("positions.txt", "".join(f"{names[image]}\t{image}\t0\t0\n" for image in (1, 2, 3)))
        self.assertEqual(overview.known_positions(self.features, str(file)),
                         {image: (image, 0, 0) for image in (1, 2, 3)})
        file.write_text(f"{names[1]}\t1\t0\n")
        said = self.said_by(overview.known_positions, self.features, str(file))
        self.assertIn(f"    pairs are chosen without positions: {file}:1: must be NAME X Y Z", said)
        self.assertEqual(self.step(scale_from=f"positions:{file}").reads, [file])

    def test_gps_positions_are_in_metres(self):
        self.track(3)
        with database.opened(self.features) as connection:
            connection.execute("UPDATE images SET prior_tx = 60, prior_ty = 10, prior_tz = 5 WHERE image_id = 1")
            connection.execute("UPDATE images SET prior_tx = 0, prior_ty = 0, prior_tz = 0 WHERE image_id = 2")
        (place,) = overview.known_positions(self.features, None).values()
        self.assertAlmostEqual(place[0], 60 * 111000)
        self.assertAlmostEqual(place[1], 10 * 55500)


class Choice(StandIns):
    def test_the_number_of_photographs_decides(self):
        for matcher, count, chosen in (("auto", 29, "exhaustive"), ("auto", 30, "cascade"),
                                       ("exhaustive", 99, "exhaustive"), ("cascade", 2, "cascade")):
            self.assertEqual(matching.chosen(matcher, count), chosen)

    def test_thirty_photographs_are_matched_in_a_cascade(self):
        for number in range(3, 29):
            self.write(f"images/{number}.png", photograph(number))
        self.succeeds("--until", "poses")
        self.assertIn("colmap exhaustive_matcher ", "\n".join(self.commands()))
        self.write("images/29.png", photograph(29))
        ended = self.ended("--until", "poses")
        self.assertIn(f"colmap matches_importer --database_path {self.folder}/out/overview.db", ended.stdout)
        self.assertIn("out/features.db: is not a database of COLMAP", ended.stderr)  # of the stand-in
        self.assertEqual(ended.returncode, 1)


@unittest.skipUnless(shutil.which("colmap"), "COLMAP is not installed")
class WithColmap(InFolder):
    """COLMAP reads the overview and the lists."""

    def test_a_transect_is_matched(self):
        features, full = self.folder / "features.db", self.folder / "database.db"
        simulate(self.folder / "scene", "transect", 8, (160, 120))
        subprocess.run([str(word) for word in colmap.features(features, self.folder / "scene" / "water", "PINHOLE")],
                       check=True, capture_output=True)
        names = database.names(features)
        given = options_of(matcher="cascade")
        with unittest.mock.patch.object(overview, "ALL", 4):
            said = self.said_by(steps.run_all, [matching.step(given, features, full)], self.folder)
        self.assertIn(" of 28 pairs\n", said)
        self.assertEqual(database.names(full), names)
        found = database.verified_matches(full)
        self.assertGreaterEqual(min(found.values()), 15, found)


if __name__ == "__main__":
    main()
