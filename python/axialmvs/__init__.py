# SPDX-License-Identifier: GPL-3.0-or-later
"""AxialMVS: dense 3D reconstruction for cameras behind flat or dome ports under water.

Points and lengths are in metres, pixels have their centres at whole numbers, angles are in radians. The camera frame
has x to the right, y down and z forward. docs/python.md has examples.
"""

from ._axialmvs import (Camera, DomePort, Error, FlatPort, Housing, Lens, Stopped, WaterSurface, read_cameras,
                        read_housing, read_photograph, write_housing)
from .files import (read_cloud, read_depth_map, read_mesh, read_scene, write_cloud, write_depth_map, write_mesh,
                    write_scene)
from .records import DepthMap, Image, Mesh, PointCloud, Region, Scene
from .stages import Densified, clean_mesh, densify, reconstruct_mesh, refine_mesh

__all__ = ["Camera", "Densified", "DepthMap", "DomePort", "Error", "FlatPort", "Housing", "Image", "Lens", "Mesh",
           "PointCloud", "Region", "Scene", "Stopped", "WaterSurface", "clean_mesh", "densify", "read_cameras",
           "read_cloud", "read_depth_map", "read_housing", "read_mesh", "read_photograph", "read_scene",
           "reconstruct_mesh", "refine_mesh", "write_cloud", "write_depth_map", "write_housing", "write_mesh",
           "write_scene"]
