# SPDX-License-Identifier: GPL-3.0-or-later
"""Which pairs of photographs are worth matching with all their features, after all pairs that look alike were
matched with few features. Matches are lists of (feature of the first photograph, feature of the second one), by
pair of ids (first < second)."""

import collections
import itertools

PARTNERS = 8          # pairs that each photograph may have whatever they add
NEW, NEW_SHARE = 3, 0.2  # matches that a further pair must add to the tracks, and their least share
CELLS = 8             # along each side of a photograph
LEAST_IN_CELL = 2     # matches in a cell that counts as seen by both photographs
OVERLAP = CELLS * CELLS // 8  # cells that two photographs must see of a third one
ENOUGH = 30           # tracks through both photographs, which join them well
WAYS = 3              # and the number of others through which they are joined


class Tracks:
    """Features that are one point, as matches say."""

    def __init__(self):
        self.parents = {}

    def track_of(self, feature):
        """The track of a feature (photograph, number): its first feature."""
        root = feature
        while self.parents.setdefault(root, root) != root:
            root = self.parents[root]
        while self.parents[feature] != root:
            self.parents[feature], feature = root, self.parents[feature]
        return root

    def add(self, pair, matches):
        for one, other in matches:
            roots = sorted((self.track_of((pair[0], one)), self.track_of((pair[1], other))))
            self.parents[roots[1]] = roots[0]

    def new(self, pair, matches):
        """How many of the matches join two tracks."""
        return sum(self.track_of((pair[0], one)) != self.track_of((pair[1], other)) for one, other in matches)

    def of_photographs(self):
        """The tracks that each photograph sees."""
        found = collections.defaultdict(set)
        for feature in list(self.parents):
            found[feature[0]].add(self.track_of(feature))
        return found


def choose(matches):
    """The pairs that are matched in full, of those with few features that have verified `matches`: the
    strongest ones of each photograph, and all that join tracks which stronger pairs left apart."""
    tracks, partners, chosen = Tracks(), collections.Counter(), []
    for pair, found in sorted(matches.items(), key=lambda one: (-len(one[1]), one[0])):
        is_strong = min(partners[image] for image in pair) < PARTNERS
        if not is_strong and tracks.new(pair, found) < max(NEW, NEW_SHARE * len(found)):
            continue
        chosen.append(pair)
        partners.update(pair)
        tracks.add(pair, found)
    return chosen


def cell_numbers(xs, ys, size):
    """The cell of each feature of a photograph of `size` (width, height). `xs`, `ys`: pixels."""
    width, height = size
    return [min(CELLS - 1, int(CELLS * x / width)) + CELLS * min(CELLS - 1, int(CELLS * y / height))
            for x, y in zip(xs, ys)]


def shared_cells(matches, cells):
    """For each photograph the sets of its cells that its partners see, by partner. `cells`:
    cell_numbers() of each photograph."""
    seen = collections.defaultdict(dict)
    for pair, found in matches.items():
        for side in (0, 1):
            own, partner = pair[side], pair[1 - side]
            counts = collections.Counter(cells[own][match[side]] for match in found)
            seen[own][partner] = {cell for cell, count in counts.items() if count >= LEAST_IN_CELL}
    return seen


def missing(matches, cells, tried):
    """The pairs not in `tried` that overlap, because they see the same part of a third photograph, and that
    are joined badly: by few tracks, or through few others. `matches`: of full matching, so far."""
    through = collections.Counter(
        pair for seen in shared_cells(matches, cells).values()
        for pair in itertools.combinations(sorted(seen), 2)
        if pair not in tried and len(seen[pair[0]] & seen[pair[1]]) >= OVERLAP)
    if not through:
        return []
    tracks = Tracks()
    for pair, found in matches.items():
        tracks.add(pair, found)
    seen_by = tracks.of_photographs()
    return sorted(pair for pair, others in through.items()
                  if others < WAYS or len(seen_by[pair[0]] & seen_by[pair[1]]) < ENOUGH)


def parts_of(images, pairs):
    """The part of each of the `images`. Images have the same part if `pairs` join them."""
    parts = Tracks()
    for pair in pairs:
        parts.add(pair, [(0, 0)])
    return {image: parts.track_of((image, 0)) for image in images}


def outside(parts):
    """The images that are not in the part with most images. `parts`: parts_of() the images."""
    by_part = collections.defaultdict(list)
    for image, part in parts.items():
        by_part[part].append(image)
    largest = max(by_part.values(), key=len, default=[])
    return sorted(set(parts) - set(largest))
