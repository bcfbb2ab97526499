# SPDX-License-Identifier: GPL-3.0-or-later
"""The witness of the cameras: light is traced from the lens into the water by Snell's law alone."""

import numpy as np


def refracted(directions, normals, ratio):
    """Unit directions behind a surface. `ratio`: the index before the surface divided by the one behind it.
    `normals`: unit, along the light."""
    cosine = np.sum(directions * normals, axis=1, keepdims=True)
    across = ratio * (directions - cosine * normals)
    return across + np.sqrt(1 - np.sum(across ** 2, axis=1, keepdims=True)) * normals


def bearings(lens, pixels):
    """Unit directions in air of the pixels of a lens without distortion."""
    directions = np.column_stack([(pixels[:, 0] - lens.cx) / lens.fx, (pixels[:, 1] - lens.cy) / lens.fy,
                                  np.ones(len(pixels))])
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def through_flat_port(port, directions):
    """Where the light of `directions` in air leaves the glass, and its directions in the water."""
    normals = np.broadcast_to(port.normal, directions.shape)
    points = directions * (port.distance / (directions @ port.normal))[:, None]
    directions = refracted(directions, normals, port.n_air / port.n_glass)
    points = points + directions * (port.thickness / (directions @ port.normal))[:, None]
    return points, refracted(directions, normals, port.n_glass / port.n_water)


def onto_sphere(points, directions, centre, radius):
    """Where rays that start inside of a sphere meet it."""
    along = np.sum((points - centre) * directions, axis=1, keepdims=True)
    off = np.sum((points - centre) ** 2, axis=1, keepdims=True) - radius ** 2
    return points + directions * (np.sqrt(along ** 2 - off) - along)


def through_dome_port(port, directions):
    """The same for a dome."""
    points = np.zeros_like(directions)
    outer = port.inner_radius + port.thickness
    for radius, ratio in ((port.inner_radius, port.n_air / port.n_glass), (outer, port.n_glass / port.n_water)):
        points = onto_sphere(points, directions, port.centre, radius)
        directions = refracted(directions, (points - port.centre) / radius, ratio)
    return points, directions


def through(port, directions):
    """Where light leaves the port, and its directions in the water."""
    if hasattr(port, "inner_radius"):
        return through_dome_port(port, directions)
    return through_flat_port(port, directions)
