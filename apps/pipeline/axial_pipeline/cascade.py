# SPDX-License-Identifier: GPL-3.0-or-later
"""`reconstruct --matcher cascade`: pairs of photographs at a bounded cost. Pairs that look alike are matched with
the largest features only. Where these overlap, photographs are matched with all features. Then follow pairs that
see the same part of a third photograph, until nothing is added."""

from . import colmap, database, files, overview, pair_choice, positions
from .option_files import find_option
from .programs import words_of
from .running import logged, tell, told
from .steps import Step

OVERVIEW, CANDIDATES, PAIRS = "overview.db", "overview_pairs.txt", "match_pairs.txt"
LEAST_MATCHES = 6  # verified, of the largest features
FURTHER = 10       # most similar photographs of one that pairs do not join with most others


def files_beside(full):
    """All files that exist only during the step, beside the database `full`."""
    small = full.with_name(OVERVIEW)
    return [*colmap.database_files(small), small.with_name(small.name + ".tmp"), full.with_name(CANDIDATES),
            full.with_name(PAIRS)]


def without_least_matches(words):
    """The words of --matches without the least number of verified matches, for the few features."""
    kept, is_value = [], False
    for word in words:
        is_least = find_option(word, [f"--{family}.min_num_inliers" for family in colmap.VERIFICATION])
        if not is_least and not is_value:
            kept.append(word)
        is_value = is_least and "=" not in word
    return kept


class Cascade:
    """The files of the step and what it does with them. `words`: further options for COLMAP. `of_positions`: a
    file of positions, or None."""

    def __init__(self, features, full, words, of_positions):
        self.features, self.full, self.words, self.of_positions = features, full, words, of_positions
        self.small, self.candidates, self.pairs = (full.with_name(name) for name in (OVERVIEW, CANDIDATES, PAIRS))
        self.alike = {}  # overview.most_similar(), from prepare() on

    def overview_command(self):
        return colmap.matches(self.small, "cascade", more=[
            *colmap.listed_pairs(self.candidates), *colmap.least_matches(LEAST_MATCHES),
            *without_least_matches(self.words)])

    def prepare(self, prepare):
        """Makes the databases and the list of candidates. Can be repeated, as after a kill."""
        files.copy_once(self.features, self.full)
        with database.named_if_damaged(self.features):
            database.take_names(self.full, self.features)
            prepare()
            overview.write(self.small, self.full)
            self.alike = overview.most_similar(self.small)
            known = overview.known_positions(self.full, self.of_positions)
            colmap.write_pairs(self.candidates, overview.candidates(database.names(self.full), self.alike, known))

    def match(self, pairs, number):
        """Matches pairs with all features. COLMAP skips those that it has matched before. `number`: of the
        round."""
        colmap.write_pairs(self.pairs, pairs)
        tell(f"{len(pairs)} {'more ' if number > 1 else ''}pairs with all features")
        command = colmap.matches(self.full, "cascade", more=[*colmap.listed_pairs(self.pairs), *self.words])
        logged(told(command), self.full.parent / "logs" / f"matches-{number}.log", "matches")

    def further(self, named, pairs, matched):
        """Pairs, not in `matched`, that could join parts which `pairs` leave apart: photographs outside the
        largest part with those that look most like them, and with their neighbours by name."""
        parts = pair_choice.parts_of(named, pairs)
        outside = set(pair_choice.outside(parts))
        look_alike = [(image, other) for image in outside for other in self.alike[image][:FURTHER]]
        return [(one, other) for one, other in overview.ordered([*look_alike, *overview.following(named)])
                if parts[one] != parts[other] and (one, other) not in matched]

    def complete(self):
        """Matches with all features what the overview found, and then what is missing. Each round depends on
        the pairs of the rounds before only, so that a killed run goes on with the same pairs."""
        seen = database.matches_of_pairs(self.small)
        named = database.names(self.full)
        cells = {image: pair_choice.cell_numbers(xs, ys, size)
                 for image, xs, ys, size in database.places_of_features(self.full)}
        wanted, matched, number = pair_choice.choose(seen), set(), 0
        wanted = overview.ordered([*wanted, *self.further(named, wanted, matched)])
        database.name_by_ids(self.full)
        while wanted:
            number += 1
            self.match(wanted, number)
            matched.update(wanted)
            found = {pair: one for pair, one in database.matches_of_pairs(self.full).items() if pair in matched}
            wanted = overview.ordered([*pair_choice.missing(found, cells, matched | set(seen)),
                                       *self.further(named, found, matched)])
        database.take_names(self.full, self.features)
        tell(f"matched {len(matched)} of {len(named) * (len(named) - 1) // 2} pairs")
        for path in files_beside(self.full):
            files.clear(path)


def step(given, features, full, prepare, reads, settings):
    """As matching.step()."""
    words, file = words_of("matches", given), positions.file_of(given.scale_from)
    cascade = Cascade(features, full, words, file)
    return Step("matches", cascade.overview_command(), makes=full, reads=[path for path in (file, *reads) if path],
                changed=[*colmap.database_files(full), *files_beside(full)], before=lambda: cascade.prepare(prepare),
                after=cascade.complete, settings=[*settings, *words])
