# SPDX-License-Identifier: GPL-3.0-or-later
"""Six photographs of flat ground, through a flat port, as a scene in memory and as files."""

import pathlib
import sys

import numpy as np

import axialmvs

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "apps"))
from programs import png  # noqa: E402

GROUND = 1.5  # z [m]
CELL = 0.03  # of the texture [m]
WIDTH, HEIGHT = 160, 120
CAMERA = axialmvs.Camera(axialmvs.Lens(160, 160, 79.5, 59.5), width=WIDTH, height=HEIGHT,
                         port=axialmvs.FlatPort(distance=0.02, thickness=0.014, n_glass=1.52, n_water=1.333))


def grey(x, y):
    """The grey levels of the ground, which are interpolated between random cells."""
    levels = np.random.default_rng(7).uniform(40, 210, (64, 64))
    u, v = np.asarray(x) / CELL, np.asarray(y) / CELL
    i, j = np.floor(u).astype(int), np.floor(v).astype(int)
    a, b = u - i, v - j
    at = lambda p, q: levels[q % 64, p % 64]
    return (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) + b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1))


def photograph(image, camera=CAMERA):
    rows, columns = np.mgrid[:camera.height, :camera.width]
    origins, directions = camera.unproject(np.column_stack([columns.ravel(), rows.ravel()]))
    at = image.centre + origins + directions * ((GROUND - origins[:, 2]) / directions[:, 2])[:, None]
    levels = grey(at[:, 0], at[:, 1]).astype(np.uint8).reshape(rows.shape)
    return np.repeat(levels[:, :, None], 3, axis=2)


def scene(camera=CAMERA):
    """The cameras, and the points of a grid on the ground."""
    images = [axialmvs.Image(f"{i}.png", camera, centre=np.array([0.2 * (i % 3), 0.2 * (i // 3), 0]), id=i)
              for i in range(6)]
    grid = np.array([[0.05 * i - 0.5, 0.05 * k - 0.5, GROUND] for i in range(30) for k in range(30)])
    seen = np.array([inside(camera, grid - image.centre) for image in images]).T
    grid, seen = grid[seen.sum(axis=1) > 1], seen[seen.sum(axis=1) > 1]
    begin = np.concatenate([[0], np.cumsum(seen.sum(axis=1))]).astype(np.uint64)
    return axialmvs.Scene(images, grid.astype(np.float32), begin, np.nonzero(seen)[1].astype(np.uint32),
                          np.zeros(seen.sum(), np.float32))


def photographs():
    return [photograph(image) for image in scene().images]


def inside(camera, points):
    pixels, valid = camera.project(points)
    return valid & (pixels >= 0).all(axis=1) & (pixels <= (camera.width - 1, camera.height - 1)).all(axis=1)


def write_files(folder):
    """Writes the scene with its photographs. Returns the path of the scene."""
    dive = scene()
    for image in dive.images:
        rows = photograph(image).reshape(HEIGHT, -1)
        image.path = str(folder / image.path)
        pathlib.Path(image.path).write_bytes(png([row.tobytes() for row in rows], 2))
    axialmvs.write_scene(folder / "scene.mvs", dive)
    return folder / "scene.mvs"
