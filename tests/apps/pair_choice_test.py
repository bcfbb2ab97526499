# SPDX-License-Identifier: GPL-3.0-or-later
"""Photographs that look alike, and the pairs of photographs that are worth matching with all features."""

import random
import unittest

import pipeline_folder  # noqa: F401  makes axial_pipeline importable
from programs import main

from axial_pipeline import database, pair_choice, similar

SIZE, FEATURES = (80, 80), 400


def descriptor(number, noise=None):
    """The descriptor of a point of the seabed. `noise`: a random.Random of the photograph that sees it."""
    chance = random.Random(number)
    values = [chance.randrange(120) for _ in range(database.DESCRIPTOR)]
    return bytes(min(255, max(0, value + (noise.randint(-3, 3) if noise else 0))) for value in values)


def descriptors(first, last, photograph=0):
    """The descriptors of a photograph that sees these points of a long seabed."""
    noise = random.Random(f"photograph {photograph}")
    return b"".join(descriptor(number, noise) for number in range(first, last))


class Similar(unittest.TestCase):
    def test_photographs_of_the_same_points_are_alike(self):
        photographs = {image: descriptors(20 * image, 20 * image + 60, image) for image in range(1, 31)}
        best = similar.most_similar(photographs, 4)
        for image in range(3, 29):
            self.assertEqual(sorted(best[image]), [image - 2, image - 1, image + 1, image + 2])
            self.assertEqual(set(best[image][:2]), {image - 1, image + 1})
        self.assertEqual(best, similar.most_similar(dict(reversed(photographs.items())), 4))

    def test_what_most_photographs_see_makes_none_alike(self):
        """Such as a watermark: 20 features in all photographs."""
        same = descriptors(0, 20)
        photographs = {image: same + descriptors(1000 + 20 * (image // 2), 1020 + 20 * (image // 2), image)
                       for image in range(20)}
        best = similar.most_similar(photographs, 3)
        self.assertEqual({image: others[:1] for image, others in best.items()},
                         {image: [image ^ 1] for image in range(20)})
        self.assertLess(similar.common_words(photographs)[0, 10], 20)  # the watermark alone has 160

    def test_photographs_without_features_are_like_none(self):
        self.assertEqual(similar.most_similar({1: b"", 2: b"", 3: descriptors(0, 5)}, 2), {1: [], 2: [], 3: []})
        self.assertEqual(similar.most_similar({}, 2), {})


def matches_of(photographs):
    """The matches of photographs, given as the places (column, row) of the seabed that each sees. A feature
    has the number of its place."""
    seen = {image: {column + 1000 * row for column, row in places} for image, places in photographs.items()}
    return {(one, other): [(place, place) for place in sorted(seen[one] & seen[other])]
            for one in seen for other in seen if one < other and seen[one] & seen[other]}


def line(number, step, length=20):
    """Photographs along a line, each with `length` places, `step` after those before it."""
    return matches_of({image: [(place, 0) for place in range(step * image, step * image + length)]
                       for image in range(number)})


class Choice(unittest.TestCase):
    def test_the_pairs_grow_with_the_photographs(self):
        """Of many photographs that all see the same, each has a limited number of pairs."""
        for number in (20, 40, 80):
            same = {image: [(place, 0) for place in range(30)] for image in range(number)}
            chosen = pair_choice.choose(matches_of(same))
            self.assertLessEqual(len(chosen), pair_choice.PARTNERS * number)
            self.assertEqual(pair_choice.outside(pair_choice.parts_of(range(number), chosen)), [])

    def test_a_weak_pair_that_joins_two_parts_is_chosen(self):
        """Two dense groups of photographs: one pair of the weakest matches joins them."""
        matches = {(a, b): [(place, place) for place in range(50)] for a in range(12) for b in range(a + 1, 12)}
        matches |= {(a + 12, b + 12): found for (a, b), found in list(matches.items())}
        weak = [(place, place) for place in range(pair_choice.NEW)]
        chosen = pair_choice.choose({**matches, (0, 12): weak, (1, 13): weak})
        self.assertIn((0, 12), chosen)
        self.assertNotIn((1, 13), chosen)  # joins the same tracks
        self.assertLess(len(chosen), len(matches))
        self.assertEqual(pair_choice.outside(pair_choice.parts_of(range(24), chosen)), [])

    def test_the_order_of_the_pairs_does_not_matter(self):
        matches = line(30, 2)
        self.assertEqual(pair_choice.choose(matches), pair_choice.choose(dict(reversed(matches.items()))))


class Closure(unittest.TestCase):
    """Two rows of a survey, in which each photograph sees 16 x 16 places, 4 after those of the one before. The
    rows overlap by half."""

    def setUp(self):
        self.row = 12
        corners = {image: (4 * (image % self.row), 8 * (image // self.row)) for image in range(2 * self.row)}
        self.all = matches_of({image: [(column + a, row + b) for a in range(16) for b in range(16)]
                               for image, (column, row) in corners.items()})
        self.cells = {}
        for image, (column, row) in corners.items():
            cells = pair_choice.cell_numbers([5 * a for a in range(16)] * 16,
                                             [5 * b for b in range(16) for _ in range(16)], SIZE)
            places = [column + a + 1000 * (row + b) for b in range(16) for a in range(16)]
            self.cells[image] = dict(zip(places, cells))

    def across(self, pairs):
        return [pair for pair in pairs if pair[0] // self.row != pair[1] // self.row]

    def closed(self, matches):
        """Matches what is missing, until nothing is added. The matches, and the number of rounds."""
        tried, rounds = set(matches), 0
        while missing := pair_choice.missing(matches, self.cells, tried):
            tried.update(missing)
            matches = {**matches, **{pair: self.all[pair] for pair in missing if pair in self.all}}
            rounds += 1
        return matches, rounds

    def test_rows_that_one_pair_joins_are_joined_along_their_length(self):
        few = {pair: found for pair, found in self.all.items() if pair not in self.across(self.all)}
        few[0, self.row] = self.all[0, self.row]
        closed, rounds = self.closed(few)
        self.assertGreater(rounds, 2)
        joined = {image for pair in self.across(closed) for image in pair}
        self.assertEqual(joined, set(range(2 * self.row)))

    def test_nothing_is_missing_where_all_pairs_are_matched(self):
        self.assertEqual(pair_choice.missing(self.all, self.cells, set(self.all)), [])

    def test_photographs_that_see_other_parts_of_a_third_one_are_not_tried(self):
        ends = {(0, 3): self.all[0, 3], (3, 6): self.all[3, 6]}  # 0 and 6 see the left and the right quarter of 3
        self.assertEqual(pair_choice.missing(ends, self.cells, set(ends)), [])

    def test_photographs_outside_the_largest_part_are_named(self):
        self.assertEqual(pair_choice.outside(pair_choice.parts_of(range(7), [(0, 1), (1, 2), (4, 5)])), [3, 4, 5, 6])
        self.assertEqual(pair_choice.outside(pair_choice.parts_of([], [])), [])


if __name__ == "__main__":
    main()
