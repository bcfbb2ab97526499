# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of COLMAP's text models."""


def records(file):
    """The lines of a file of a model, without comments."""
    return [line for line in file.read_text().split("\n") if not line.startswith("#")]


def triples(observations):
    """(x, y, point) of each observation in a line of images.txt."""
    words = observations.split()
    return [words[i:i + 3] for i in range(0, len(words), 3)]


def image_numbers(model):
    """The ids of the images by their names."""
    return {line.split(maxsplit=9)[9]: line.split()[0] for line in records(model / "images.txt")[0::2] if line}


def copy(source, target, keeps_point=lambda number: True, without=()):
    """Copies a model without the images named in `without`, and without the points for which
    keeps_point(number) is false or which are then observed in fewer than two images. KeyError if there
    is no such image. The positions of points and the places of the kept observations stay the same."""
    target.mkdir(parents=True, exist_ok=True)
    (target / "cameras.txt").write_text((source / "cameras.txt").read_text())
    numbers = image_numbers(source)
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
