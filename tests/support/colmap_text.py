# SPDX-License-Identifier: GPL-3.0-or-later
"""COLMAP's text models: poses, camera centres, and copies without some images or points."""

import math


def records(file):
    """The lines of a file of a model, without comments."""
    return [line for line in file.read_text().split("\n") if not line.startswith("#")]


def images_of(model):
    """The poses by image name, each as seven numbers (QW .. TZ) in text form."""
    return {line.split(maxsplit=9)[9]: line.split()[1:8] for line in records(model / "images.txt")[0::2] if line}


def centre(pose):
    """The camera centre -R^T t of a pose. The rows are those of R^T."""
    w, x, y, z, *t = map(float, pose)
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)),
            (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)),
            (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))
    return [-sum(a * b for a, b in zip(row, t)) for row in rows]


def centres(model):
    return {name: centre(pose) for name, pose in images_of(model).items()}


def positions(model):
    """The text of a position file with the camera centres."""
    return "".join(f"{name} {x} {y} {z}\n" for name, (x, y, z) in sorted(centres(model).items()))


def baseline(model):
    """The argument of --scale-from: the true distance between the first image and the image farthest
    from it."""
    places = centres(model)
    first = min(places)
    far = max(places, key=lambda name: math.dist(places[first], places[name]))
    return f"images:{first},{far},{math.dist(places[first], places[far]):.9f}"


def triples(observations):
    """(x, y, point) of each observation in a line of images.txt."""
    words = observations.split()
    return [words[i:i + 3] for i in range(0, len(words), 3)]


def copy(source, target, keeps_point=lambda number: True, without=()):
    """Copies a model without the images named in `without`, and without the points for which
    keeps_point(number) is false or which are then observed in fewer than two images. KeyError if there
    is no such image. The positions of points and the places of the kept observations stay the same."""
    target.mkdir(parents=True, exist_ok=True)
    (target / "cameras.txt").write_text((source / "cameras.txt").read_text())
    numbers = {line.split(maxsplit=9)[9]: line.split()[0] for line in records(source / "images.txt")[0::2] if line}
    dropped = {numbers[name] for name in without}
    kept = {}
    for words in map(str.split, records(source / "points3D.txt")):
        track = [pair for pair in zip(words[8::2], words[9::2]) if pair[0] not in dropped]
        if words and keeps_point(int(words[0])) and len({image for image, _ in track}) >= 2:
            kept[words[0]] = " ".join(words[:8] + [value for pair in track for value in pair])
    (target / "points3D.txt").write_text("".join(line + "\n" for line in kept.values()))
    lines = records(source / "images.txt")
    with open(target / "images.txt", "w") as out:
        for header, observations in zip(lines[0::2], lines[1::2]):
            if header.split()[0] not in dropped:
                places = (f"{x} {y} {point if point in kept else -1}" for x, y, point in triples(observations))
                out.write(f"{header}\n{' '.join(places)}\n")
