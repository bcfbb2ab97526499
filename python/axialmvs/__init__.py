# SPDX-License-Identifier: GPL-3.0-or-later
"""AxialMVS: dense 3D reconstruction for cameras behind flat or dome ports under water.

Points and lengths are in metres, pixels have their centres at whole numbers, angles are in radians. The camera frame
has x to the right, y down and z forward. docs/python.md has examples.
"""

from ._axialmvs import (Camera, DomePort, Error, FlatPort, Housing, Lens, Stopped, WaterSurface, read_cameras,
                        read_housing, read_photograph, write_housing)
from .files import (read_cloud, read_depth_map, read_mesh, read_scene, read_textured_mesh, write_cloud, write_depth_map,
                    write_mesh, write_scene, write_textured_mesh)
from .records import (ChangedRegion, Comparison, DepthMap, Image, Mesh, PointCloud, Region, Scene, SurfaceMap,
                      TexturedMesh)
from .stages import (Densified, clean_mesh, compare_surveys, densify, map_surface, reconstruct_mesh, refine_mesh,
                     texture_mesh)

__all__ = ["Camera", "ChangedRegion", "Comparison", "Densified", "DepthMap", "DomePort", "Error", "FlatPort",
           "Housing", "Image", "Lens", "Mesh", "PointCloud", "Region", "Scene", "Stopped", "SurfaceMap",
           "TexturedMesh", "WaterSurface", "clean_mesh", "compare_surveys", "densify", "map_surface", "read_cameras",
           "read_cloud", "read_depth_map", "read_housing", "read_mesh", "read_photograph", "read_scene",
           "read_textured_mesh", "reconstruct_mesh", "refine_mesh", "texture_mesh", "write_cloud", "write_depth_map",
           "write_housing", "write_mesh", "write_scene", "write_textured_mesh"]
