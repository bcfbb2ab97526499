# SPDX-License-Identifier: GPL-3.0-or-later
"""COLMAP's models and meshes moved far from the origin of the world."""

import os

from programs import read, write
from readers import Ply, added, image_lines, records, rotated
from worlds import binary_mesh

FAR = (534000.0, 3378500.0, 30.0)  # multiples of 10, as a geo_offset is
FAR_AND_ODD = (534012.34567, 3378487.65432, 30.0)


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
        out.append(" ".join(words[:1] + [repr(m) for m in added(map(float, words[1:4]), shift)] + words[4:]))
    write(os.path.join(target, "points3D.txt"), "\n".join(out) + "\n")


def move_mesh(source, target, shift, kind="double"):
    """Writes a mesh of triangles shifted, with coordinates of the kind `double` or `float`."""
    mesh = Ply(read(source))
    write(target, binary_mesh([added(x, shift) for x in mesh.points], mesh.triangles, kind))
