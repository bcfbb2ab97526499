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
class TexturedMesh(Mesh):
    """A mesh whose faces show parts of textures. A coordinate (x, y) is in pixels of the texture of its face."""

    uv: np.ndarray = field(default_factory=lambda: np.zeros((0, 3, 2), np.float32))  # (M, 3, 2) float32, of the corners
    texture_of: np.ndarray = field(default_factory=lambda: np.zeros(0, np.uint32))  # (M,) uint32: index into `textures`
    textures: list[np.ndarray] = field(default_factory=list)  # (height, width, 3) uint8: red, green, blue


@dataclass(eq=False)
class MapPlace:
    """The place of a map: its axes, and its grid of pixels. in the map = axes @ position in the world + offset."""

    axes: np.ndarray  # (3, 3): rows are x (to the right), y (to the top) and z (height) of the map in the world
    offset: np.ndarray  # (3,) [m]
    left: float  # x and y of the upper left corner of the upper left pixel in the map [m]
    top: float
    pixel: float  # width of a pixel [m]

    def places(self, rows, columns) -> np.ndarray:
        """The centres of pixels in the map: (..., 2). Rows and columns are broadcast."""
        rows, columns = np.broadcast_arrays(rows, columns)
        return np.stack([self.left + (columns + 0.5) * self.pixel, self.top - (rows + 0.5) * self.pixel], axis=-1)


@dataclass(eq=False)
class SurfaceMap(MapPlace):
    """A map of a mesh, seen against the direction of its heights."""

    heights: np.ndarray  # (rows, columns) float32 [m]; NaN: no surface
    colors: np.ndarray | None  # (rows, columns, 4) uint8: red, green, blue, and 255 where the colour is known
    shades: np.ndarray  # (rows, columns) uint8: relief shading; 0: no surface


@dataclass(eq=False)
class ChangedRegion:
    """Adjacent pixels whose surface came or went."""

    came: bool
    volume: float  # [m^3], with its standard deviation
    sigma: float
    area: float  # [m^2]
    x: float  # the mean of the places of the pixels in the map
    y: float
    largest: float  # the largest absolute difference [m]


@dataclass(eq=False)
class Comparison(MapPlace):
    """What changed between two surveys. Arrays have a value for each pixel; NaN: not compared.

    later position in the frame of the earlier survey = rotation @ position + translation, both in the world.
    """

    before: np.ndarray  # (rows, columns) float32: height of the earlier survey [m]
    difference: np.ndarray  # the same: later minus earlier height [m]
    sigma: np.ndarray  # the same: standard deviation of the difference [m]
    classes: np.ndarray  # (rows, columns) uint8; 0: unchanged, 1: gone, 2: came, 255: not compared
    regions: list[ChangedRegion]  # the largest volume first
    came: tuple[float, float]  # volume and its standard deviation [m^3]
    gone: tuple[float, float]
    net: tuple[float, float]  # what came minus what went
    area_compared: float  # [m^2]
    area_unseen: float  # not compared because too few photographs see it [m^2]
    noise: float  # standard deviation of differences on level ground [m]
    rotation: np.ndarray  # (3, 3); the identity unless the later survey was aligned
    translation: np.ndarray  # (3,) [m]


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
