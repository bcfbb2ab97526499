#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies a COLMAP text model without some of its images.

Usage: hold_out.py MODEL_DIR OUT_DIR IMAGE_NAME...

The positions of points stay the same. Observations in the held-out images are removed, and so are
points that are then observed in fewer than two images.
"""
import pathlib
import sys


def records(path):
    lines = path.read_text().split("\n")
    return [line for line in lines if not line.startswith("#")]


def main():
    source, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    names = set(sys.argv[3:])
    target.mkdir(parents=True, exist_ok=True)
    (target / "cameras.txt").write_text((source / "cameras.txt").read_text())

    lines = records(source / "images.txt")
    images, dropped, found = [], set(), set()
    for header, observations in zip(lines[0::2], lines[1::2]):
        fields = header.split(maxsplit=9)
        if fields[9] in names:
            dropped.add(fields[0])
            found.add(fields[9])
        else:
            images.append((header, observations))
    if found != names:
        sys.exit(f"hold_out.py: {source}: has no image {', '.join(sorted(names - found))}")

    kept_points, point_ids = [], set()
    for line in records(source / "points3D.txt"):
        fields = line.split()
        if not fields:
            continue
        track = [pair for pair in zip(fields[8::2], fields[9::2]) if pair[0] not in dropped]
        if len({image for image, _ in track}) < 2:
            continue
        point_ids.add(fields[0])
        kept_points.append(" ".join(fields[:8] + [value for pair in track for value in pair]))
    (target / "points3D.txt").write_text("\n".join(kept_points) + "\n")

    with open(target / "images.txt", "w") as out:
        for header, observations in images:
            fields = observations.split()
            for k in range(2, len(fields), 3):
                if fields[k] not in point_ids:
                    fields[k] = "-1"
            out.write(header + "\n" + " ".join(fields) + "\n")


if __name__ == "__main__":
    main()
