# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by several test scripts: reads where COLMAP text models and clouds are in the world, and
moves models and meshes far from its origin."""

import math
import os
import struct

from programs import cloud_size, read, write

FAR = (534000.0, 3378500.0, 30.0)  # multiples of 10, as a geo_offset is
FAR_AND_ODD = (534012.34567, 3378487.65432, 30.0)


def added(x, shift):
    return tuple(a + b for a, b in zip(x, shift))


def rotated(q, v):
    """R(q) v for a unit quaternion q = (w, x, y, z)."""
    w, x, y, z = q
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
    return tuple(math.fsum(a * b for a, b in zip(row, v)) for row in rows)


def records(path):
    return [line for line in read(path).decode().split("\n")
            if line and not line.startswith("#")]


def image_lines(path):
    """Pairs of lines of images.txt: pose and observations. A line of observations may be empty."""
    lines = [line for line in read(path).decode().split("\n") if not line.startswith("#")]
    return [(lines[i], lines[i + 1]) for i in range(0, len(lines) - 1, 2)]


def move_model(source, target, shift):
    """Writes a COLMAP text model with all centres and points shifted. T = -R C."""
    write(os.path.join(target, "cameras.txt"), read(os.path.join(source, "cameras.txt")))
    out = []
    for pose, observations in image_lines(os.path.join(source, "images.txt")):
        words = pose.split(" ")
        q, t = [float(w) for w in words[1:5]], [float(w) for w in words[5:8]]
        moved = [a - b for a, b in zip(t, rotated(q, shift))]
        out += [" ".join(words[:5] + [repr(m) for m in moved] + words[8:]), observations]
    write(os.path.join(target, "images.txt"), "\n".join(out) + "\n")
    out = []
    for line in records(os.path.join(source, "points3D.txt")):
        words = line.split(" ")
        out.append(" ".join(words[:1] + [repr(m) for m in added(map(float, words[1:4]), shift)] +
                            words[4:]))
    write(os.path.join(target, "points3D.txt"), "\n".join(out) + "\n")


def centres_of(model):
    """Camera centres C = -R^T T by image name."""
    result = {}
    for pose, _ in image_lines(os.path.join(model, "images.txt")):
        words = pose.split(" ")
        w, x, y, z, *t = [float(v) for v in words[1:8]]
        result[words[9]] = tuple(-v for v in rotated((w, -x, -y, -z), t))
    return result


def thin(source, target, step):
    """Copies a text model with every `step`-th point only, so that refining it is fast."""
    kept = records(os.path.join(source, "points3D.txt"))[::step]
    ids = {line.split(" ")[0] for line in kept}
    lines = []
    for pose, observations in image_lines(os.path.join(source, "images.txt")):
        words = observations.split(" ")
        words[2::3] = [word if word in ids else "-1" for word in words[2::3]]
        lines += [pose, " ".join(words)]
    write(os.path.join(target, "cameras.txt"), read(os.path.join(source, "cameras.txt")))
    write(os.path.join(target, "images.txt"), "\n".join(lines) + "\n")
    write(os.path.join(target, "points3D.txt"), "\n".join(kept) + "\n")


def points_of(model):
    return {int(words[0]): tuple(float(w) for w in words[1:4]) for words in
            (line.split(" ") for line in records(os.path.join(model, "points3D.txt")))}


def split_ply(data):
    """Header lines without comments, the geo_offset or None, and the body."""
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode().split("\n")
    offset = [tuple(map(float, line.split()[2:])) for line in lines
              if line.startswith("comment geo_offset ")]
    return ([line for line in lines if not line.startswith("comment")],
            offset[0] if offset else None, data[end:])


def positions(data):
    """World positions of a cloud with colours, normals, views and weights, as DensifyPointCloud
    writes it."""
    header, offset, body = split_ply(data)
    kind = "d" if "property float64 x" in header else "f"
    fixed, at, result = struct.Struct("<3" + kind), 0, []
    for _ in range(cloud_size(data)):
        result.append(added(fixed.unpack_from(body, at), offset or (0, 0, 0)))
        at += fixed.size + 3 + 12
        at += 1 + 4 * body[at]
        at += 1 + 4 * body[at]
    assert at == len(body)
    return result


def move_mesh(source, target, shift):
    """Writes the simulator's mesh (float32 positions and triangles) shifted, in float64."""
    data = read(source)
    end = data.index(b"end_header\n") + len(b"end_header\n")
    count = cloud_size(data)
    vertices = struct.unpack_from(f"<{3 * count}f", data, end)
    moved = [v + shift[i % 3] for i, v in enumerate(vertices)]
    write(target, data[:end].replace(b"property float32", b"property float64") +
          struct.pack(f"<{3 * count}d", *moved) + data[end + 12 * count:])
