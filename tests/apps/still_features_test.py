# SPDX-License-Identifier: GPL-3.0-or-later
"""Features that stand still in all photographs are found in COLMAP's database, and a mask is offered."""

import array
import json
import random
import zlib

from colmap_databases import add_photograph, make_tables
from pipeline_folder import InFolder
from programs import main
from stand_ins import StandIns

from axial_pipeline import still_features
from axial_pipeline.database import opened

WIDTH, HEIGHT, PHOTOGRAPHS, MOVING = 640, 480, 10, 800


def descriptor(rng):
    """Like those of SIFT: few of the 128 numbers are large, and the length is 512."""
    numbers = [rng.expovariate(1) ** 1.5 for _ in range(128)]
    length = sum(number * number for number in numbers) ** 0.5
    return [min(255, round(512 * number / length)) for number in numbers]


def noisy(numbers, rng):
    noise = rng.choices(range(-6, 7), k=len(numbers))
    return [min(255, max(0, number + more)) for number, more in zip(numbers, noise)]


def place(rng):
    return rng.uniform(0, WIDTH), rng.uniform(0, HEIGHT)


def write_database(path, still, share=1.0, columns=6):
    """A database in which features at the places `still` are at rest in this share of the photographs,
    among others that are elsewhere in each photograph."""
    rng = random.Random(5)
    scene = [descriptor(rng) for _ in range(MOVING)]
    at_rest = [(x, y, descriptor(rng)) for x, y in still]
    with opened(path) as connection:
        make_tables(connection, (WIDTH, HEIGHT))
        for image in range(PHOTOGRAPHS):
            features = [(*place(rng), noisy(one, rng)) for one in scene]
            if image < share * PHOTOGRAPHS:
                features += [(x + rng.uniform(-0.4, 0.4), y + rng.uniform(-0.4, 0.4), noisy(one, rng))
                             for x, y, one in at_rest]
            shape = {2: [], 4: [2, 0], 6: [2, 0, 0, 2]}[columns]
            numbers = array.array("f", [v for x, y, _ in features for v in (x, y, *shape)])
            add_photograph(connection, image, f"{image}.png", columns, numbers.tobytes(),
                           b"".join(bytes(one) for *_, one in features))
    return path


def pixels_of(png):
    """The rows of a PNG of still_features.grey_png()."""
    data = zlib.decompress(png[png.index(b"IDAT") + 4:])
    return [data[row * (WIDTH + 1) + 1:(row + 1) * (WIDTH + 1)] for row in range(HEIGHT)]


ARM = [(500 + 8 * k, 400 + 3 * k) for k in range(10)]
MARK = [(20 + 5 * k, 30) for k in range(6)]


class StillFeatures(InFolder):
    def database(self, still, **more):
        path = self.folder / "features.db"
        path.unlink(missing_ok=True)
        return write_database(path, still, **more)

    def test_they_are_found_with_their_places(self):
        for columns in (2, 4, 6):
            width, height, found = still_features.find(self.database(ARM + MARK, columns=columns))
            self.assertEqual((width, height, len(found)), (WIDTH, HEIGHT, 16))
            regions = still_features.regions_of(found, width)
            self.assertEqual([len(region) for region in regions], [10, 6])
            words = still_features.region_in_words(regions[0], width, height)
            self.assertEqual(words["share"], 1)
            left, right, top, bottom = words["pixels"]
            for low, high, value in ((left, right, [x for x, _ in ARM]), (top, bottom, [y for _, y in ARM])):
                self.assertTrue(low <= min(value) and max(value) <= high)
                self.assertTrue(low >= min(value) - 20 and max(value) >= high - 20)

    def test_they_must_be_at_rest_in_most_photographs(self):
        self.assertAlmostEqual(max(share for *_, share in still_features.find(
            self.database(ARM, share=0.7))[2]), 0.7)
        self.assertIsNone(still_features.find(self.database(ARM, share=0.4)))

    def test_what_moves_is_not_found(self):
        self.assertIsNone(still_features.find(self.database([])))
        self.assertIsNone(still_features.find(self.database(MARK)), "six features change no pose")

    def test_another_file_has_none(self):
        self.assertIsNone(still_features.find(self.write("other", "text" * 100)))
        self.assertIsNone(still_features.find(self.write("empty", "")))

    def test_a_damaged_database_has_none(self):
        whole = self.database(ARM).read_bytes()
        for change in ("data = x'0102'", "data = NULL", "data = x''", "cols = 1", "data = 'text'"):
            path = self.write("damaged.db", whole)
            with opened(path) as connection:
                connection.execute(f"UPDATE keypoints SET {change}")
            self.assertIsNone(still_features.find(path), change)

    def test_damaged_findings_are_not_told(self):
        region = {"pixels": [1, 2, 3, 4], "features": 9, "share": 0.5}
        for change in ({}, {"pixels": [1]}, {"pixels": 1}, {"share": "x"}, {"features": None}):
            self.write(still_features.FOUND, json.dumps(
                {"features": 9, "remedy": "a mask", "regions": [{**region, **change}]}))
            told = still_features.lines_about(self.folder)
            self.assertEqual(len(told), 3 if not change or "features" in change else 0, change)

    def test_the_mask_is_black_around_them(self):
        _, _, found = still_features.find(self.database(ARM))
        rows = pixels_of(still_features.mask_of(found, WIDTH, HEIGHT))
        self.assertEqual({rows[y][x] for x, y in ARM}, {0})
        self.assertEqual({value for row in rows for value in row}, {0, 255})
        black = sum(row.count(0) for row in rows)
        self.assertLess(black, 0.03 * WIDTH * HEIGHT)
        self.assertEqual(rows[100].count(255), WIDTH)


class InARun(StandIns):
    """COLMAP's stand-in makes a database with features at rest."""

    def setUp(self):
        super().setUp()
        write_database(self.folder / "still.db", ARM)
        self.add_to("colmap", '[ "$1" != feature_extractor ] || cp still.db out/features.db\n')

    def test_they_are_told_before_matching_and_a_mask_is_offered(self):
        out = self.folder / "out"
        mask, said = out / "still_features.png", self.succeeds("--until", "cloud")
        said = said[:said.index("] matches")]
        self.assertIn("warning: 10 features stand still in the photographs", said)
        self.assertRegex(said, r"x 4\d\d to 5\d\d, y 3\d\d to 4\d\d px: 10 features at rest in 100% of the")
        self.assertIn(f"give --masks {mask}", said)
        self.assertIn("features stand still", (out / "report.md").read_text())
        self.assertIn("[reconstruct] warning: 10 features", (out / "logs" / "features.log").read_text())
        again = self.ended("--until", "cloud", "--masks", str(mask))
        self.assertIn("The masks of --masks do not cover them", again.stdout)  # the stand-in ignores masks
        self.assertTrue(mask.exists())
        self.assertEqual(self.done_before("--until", "cloud", "--masks", str(mask)), 8)

    def test_the_mask_of_an_earlier_run_goes_when_nothing_is_at_rest(self):
        self.ended("--until", "cloud")
        write_database(self.folder / "moving.db", [])
        (self.folder / "moving.db").rename(self.folder / "still.db")
        (self.folder / "images" / "3.png").write_bytes((self.folder / "images" / "0.png").read_bytes())
        ended = self.ended("--until", "cloud")
        self.assertNotIn("stand still", ended.stdout)
        self.assertEqual(list((self.folder / "out").glob("still_features*")), [])
        self.assertNotIn("stand still", (self.folder / "out" / "report.md").read_text())


if __name__ == "__main__":
    main()
