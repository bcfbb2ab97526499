# SPDX-License-Identifier: GPL-3.0-or-later
"""The data of scenes and of results as records of arrays. An array that may be None is absent then.

Positions are float32 near the scene: position in the world = position + origin.
"""

from dataclasses import dataclass, field

import numpy as np

from ._axialmvs import Camera


def _zeros():
    return np.zeros(3)


@dataclass(eq=False)
class DepthMap:
    """For every pixel of a photograph its depth, a normal and a confidence.

    A depth is the distance along the ray of the pixel in the water, from the origin of the ray on the axis of the
    camera (Camera.unproject).
    """

    depth: np.ndarray  # (height, width) float32 [m]; 0: none
    camera: Camera  # of the size of the map
    rotation: np.ndarray  # (3, 3), from the world to the camera
    centre: np.ndarray  # (3,), of the camera in the world
    normal: np.ndarray | None = None  # (height, width, 3) float32, unit, in the camera frame, towards the camera
    confidence: np.ndarray | None = None  # (height, width) float32; higher is better
    ids: list[int] = field(default_factory=lambda: [0])  # of the image and of its source views
    image_path: str = ""
    min_depth: float = 0  # the range of depths that was searched [m]
    max_depth: float = 0
    made_from: str = ""  # a text of the program that made the map

    def points(self) -> np.ndarray:
        """The points of all pixels with a depth, row by row: (N, 3) in the world."""
        rows, columns = np.nonzero(self.depth)
        origins, directions = self.camera.unproject(np.column_stack([columns, rows]))
        in_camera = origins + self.depth[rows, columns, None].astype(float) * directions
        return in_camera @ self.rotation + self.centre


@dataclass(eq=False)
class PointCloud:
    """A dense cloud. The views of point i are view_images[view_begin[i]:view_begin[i + 1]]."""

    positions: np.ndarray  # (N, 3) float32
    normals: np.ndarray | None = None  # (N, 3) float32, unit
    colors: np.ndarray | None = None  # (N, 3) uint8: red, green, blue
    view_begin: np.ndarray | None = None  # (N + 1,) uint64
    view_images: np.ndarray | None = None  # (all views,) uint32: indices of images of the scene
    view_weights: np.ndarray | None = None  # (all views,) float32
    errors: np.ndarray | None = None  # (N,) float32: expected distance to the surface [m]
    confidences: np.ndarray | None = None  # (N,) float32
    origin: np.ndarray = field(default_factory=_zeros)  # (3,)


@dataclass(eq=False)
class Mesh:
    """A mesh of triangles. Seen from outside, the corners of a face are in counter-clockwise order."""

    vertices: np.ndarray  # (N, 3) float32
    faces: np.ndarray  # (M, 3) uint32
    colors: np.ndarray | None = None  # (N, 3) uint8: red, green, blue
    unseen: np.ndarray | None = None  # (M,) uint8; 1: the face closes a gap that cameras did not see
    origin: np.ndarray = field(default_factory=_zeros)  # (3,)


@dataclass(eq=False)
class Image:
    """A photograph of a scene: its file, its camera and its pose. in camera = rotation @ (position - centre)."""

    path: str
    camera: Camera
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))  # (3, 3)
    centre: np.ndarray = field(default_factory=_zeros)  # (3,) [m], relative to Scene.origin
    id: int | None = None  # the name of the depth map has this number
    mask_path: str = ""
    calibrated: bool = True  # False: camera and pose have no meaning
    # (index of an image, shared points, scale, angle [rad], area, score) of suitable source views, best first
    neighbours: list[tuple[int, int, float, float, float, float]] = field(default_factory=list)


@dataclass(eq=False)
class Region:
    """A box: the points with abs(rotation @ (position - centre)) <= half_extent."""

    rotation: np.ndarray  # (3, 3)
    centre: np.ndarray  # (3,)
    half_extent: np.ndarray  # (3,)


@dataclass(eq=False)
class Scene:
    """Photographs with cameras and poses, and sparse points. The views of a point are as those of a PointCloud."""

    images: list[Image]
    points: np.ndarray = field(default_factory=lambda: np.zeros((0, 3), np.float32))  # (N, 3) float32
    view_begin: np.ndarray = field(default_factory=lambda: np.zeros(1, np.uint64))  # (N + 1,) uint64
    view_images: np.ndarray = field(default_factory=lambda: np.zeros(0, np.uint32))  # uint32
    view_confidences: np.ndarray | None = None  # float32
    point_normals: np.ndarray | None = None  # (N, 3) float32
    point_colors: np.ndarray | None = None  # (N, 3) uint8
    region: Region | None = None
    origin: np.ndarray = field(default_factory=_zeros)  # (3,)
