# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of depth maps, clouds, meshes and scenes as records."""

from . import _axialmvs
from .records import DepthMap, Image, Mesh, PointCloud, Region, Scene, TexturedMesh


def read_depth_map(path) -> DepthMap:
    """Reads a depth map (.dmap) with its side file, which describes the camera and its port."""
    return DepthMap(**_axialmvs.read_depth_map(path))


def write_depth_map(path, depth_map: DepthMap) -> None:
    """Writes a depth map and its side file."""
    _axialmvs.write_depth_map(path, vars(depth_map))


def read_cloud(path) -> PointCloud:
    """Reads a cloud (.ply)."""
    return PointCloud(**_axialmvs.read_cloud(path))


def write_cloud(path, cloud: PointCloud, *, double_precision=False) -> None:
    """Writes a cloud (.ply). double_precision: positions of the world as float64, without origin."""
    _axialmvs.write_cloud(path, vars(cloud), double_precision)


def read_mesh(path) -> Mesh:
    """Reads a mesh (.ply)."""
    return Mesh(**_axialmvs.read_mesh(path))


def write_mesh(path, mesh: Mesh, *, double_precision=False) -> None:
    """Writes a mesh (.ply). double_precision: positions of the world as float64, without origin."""
    _axialmvs.write_mesh(path, vars(mesh), double_precision)


def read_textured_mesh(path) -> TexturedMesh:
    """Reads a mesh with its textures (.ply, .obj, .glb, .gltf)."""
    return TexturedMesh(**_axialmvs.read_textured_mesh(path))


def write_textured_mesh(path, mesh: TexturedMesh) -> None:
    """Writes a mesh with its textures, in the format of the extension: .ply, .obj, .glb or .gltf."""
    _axialmvs.write_textured_mesh(path, vars(mesh))


def scene_record(values) -> Scene:
    """The record of a scene from the dictionary of the module."""
    images = [Image(**image) for image in values.pop("images")]
    region = values.pop("region")
    return Scene(images=images, region=region and Region(**region), **values)


def scene_values(scene: Scene) -> dict:
    """The dictionary of the module from the record of a scene."""
    return vars(scene) | {"images": [vars(image) for image in scene.images],
                          "region": scene.region and vars(scene.region)}


def read_scene(path, *, working_folder=None, housing=None, ports="automatic", allow_missing=False) -> Scene:
    """Reads a scene (.mvs) with the files beside it: lenses, housing and origin.

    working_folder: where relative paths of photographs start; by default the folder of the scene. housing: the housing
    file, if it is not the one beside the scene. ports: 'automatic', 'ignored', 'required' or 'flat'. allow_missing: a
    housing may give no image a port.
    """
    return scene_record(_axialmvs.read_scene(path, working_folder, housing, ports, allow_missing))


def write_scene(path, scene: Scene, *, working_folder=None) -> None:
    """Writes a scene (.mvs) with the files beside it. Paths below working_folder become relative to it."""
    _axialmvs.write_scene(path, scene_values(scene), working_folder)
