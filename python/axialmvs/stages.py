# SPDX-License-Identifier: GPL-3.0-or-later
"""The stages from photographs to results."""

import pathlib
from dataclasses import dataclass, field

from . import _axialmvs
from .files import read_cloud, read_scene, scene_values
from .records import ChangedRegion, Comparison, DepthMap, Mesh, PointCloud, Scene, SurfaceMap, TexturedMesh


@dataclass(eq=False)
class Densified:
    """The result of densify()."""

    cloud_file: pathlib.Path | None  # None: the files of a scene in memory were removed
    points: int  # of the cloud
    depth_maps: int  # that were made or used
    only_pinholes: bool  # no camera has a port or a distorted lens
    _cloud: PointCloud | None = field(default=None, repr=False)

    @property
    def cloud(self) -> PointCloud:
        """The cloud, which is read from its file when it is first asked for."""
        if self._cloud is None:
            self._cloud = read_cloud(self.cloud_file)
        return self._cloud


def _by_index(images, name):
    """A function of the index of an image from a function or from a sequence of arrays."""
    if images is None or callable(images):
        return images
    if not hasattr(images, "__getitem__"):
        raise TypeError(f"{name}: must be a function of the index of an image, or a sequence of arrays")
    return images.__getitem__


def _survey(scene, photographs, masks):
    """The arguments of the module for a survey in files or in memory."""
    if isinstance(scene, Scene):
        if photographs is None:
            raise TypeError("photographs: a scene in memory needs them")
        scene = scene_values(scene)
    elif photographs is not None or masks is not None:
        raise TypeError("photographs and masks are for a scene in memory; a scene in a file names their files")
    return scene, _by_index(photographs, "photographs"), _by_index(masks, "masks")


def densify(scene, *, photographs=None, masks=None, take_map=None, **options) -> Densified:
    """Makes depth maps and a dense cloud.

    scene: the path of a scene (.mvs), or a Scene in memory with its `photographs`: a function of the index of an image,
    or a sequence, that gives (height, width, 3) uint8 red, green, blue; and its `masks`, if any: (height, width) uint8,
    0 where a pixel is left out. Such a function is called by several threads and must always give the same.

    take_map: gets the index of an image and its final DepthMap, before the maps are fused.

    Keywords that all stages have: progress, a function of the title of the work, the number of items done and of all
    items, which stops the stage if it returns False or raises an exception; max_memory [MB], 0 for 70 % of the free
    memory; max_threads, 0 for as many as cores.

    Other keywords: output, the scene to write (by default <scene>_dense.mvs, with the cloud beside it);
    working_folder, of the depth maps (by default the folder of the scene; for a scene in memory a temporary folder);
    and the options of the stage, which docs/python.md lists.

    Raises Error for wrong values and files, TypeError for an unknown keyword, Stopped after a stop by `progress`.
    """

    def take(image, fields):
        take_map(image, DepthMap(**fields))

    result = _axialmvs.densify(*_survey(scene, photographs, masks), take_map and take, options)
    cloud = result.pop("cloud", None)
    return Densified(**result, _cloud=cloud and PointCloud(**cloud))


def reconstruct_mesh(cloud, scene, **options) -> Mesh:
    """Makes a mesh from a dense cloud with views, as ReconstructMesh.

    cloud: a PointCloud or the path of one (.ply). scene: the Scene whose images saw the cloud, or its path (.mvs). The
    mesh has the origin of the scene. Keywords: those that all stages have (see densify), and the options of the stage,
    which docs/python.md lists.
    """
    cloud = cloud if isinstance(cloud, PointCloud) else read_cloud(cloud)
    scene = scene if isinstance(scene, Scene) else read_scene(scene)
    return Mesh(**_axialmvs.reconstruct_mesh(vars(cloud), scene_values(scene), options))


def clean_mesh(mesh: Mesh, **options) -> Mesh:
    """A copy of the mesh that is manifold and free of intersections, and simplified, smoothed or remeshed.

    Keywords: the options of the stage, which docs/python.md lists.
    """
    return Mesh(**_axialmvs.clean_mesh(vars(mesh), options))


def refine_mesh(mesh: Mesh, scene, *, photographs=None, masks=None, **options) -> Mesh:
    """Moves the vertices of a mesh until its photographs agree with each other, and cleans it.

    scene, photographs, masks: as for densify. The mesh has the origin of the scene, no colours, and no marks of unseen
    faces. Keywords: those that all stages have (see densify), and the options of the stage, which docs/python.md lists.
    """
    return Mesh(**_axialmvs.refine_mesh(vars(mesh), *_survey(scene, photographs, masks), options))


def texture_mesh(mesh: Mesh, scene, *, photographs=None, masks=None, **options) -> TexturedMesh:
    """Gives a mesh textures from photographs, as TextureMesh.

    scene, photographs, masks: as for densify. The mesh has the origin of the scene. Faces that are too large for linear
    texture coordinates are split. Keywords: those that all stages have (see densify), and the options of the stage,
    which docs/python.md lists.
    """
    return TexturedMesh(**_axialmvs.texture_mesh(vars(mesh), *_survey(scene, photographs, masks), options))


def map_surface(mesh: Mesh, *, pixel, up=None, **options) -> SurfaceMap:
    """The heights of a mesh and, if it is a TexturedMesh, its orthomosaic.

    pixel: width of a pixel [m]. up: the direction of the heights in the world, (3,); by default z. Faces that are
    marked as unseen are left out. Keywords: those that all stages have (see densify).
    """
    return SurfaceMap(**_axialmvs.map_surface(vars(mesh), options | {"pixel": pixel, "up": up}))


def compare_surveys(before: Mesh, after: Mesh, *, scene_before=None, scene_after=None, **options) -> Comparison:
    """What changed from the mesh of a survey to that of a later one, as CompareSurveys.

    scene_before, scene_after: the Scenes of the surveys or their paths, so that places which too few photographs see
    are not compared. Keywords: those that all stages have (see densify), and the options of the stage, which
    docs/python.md lists.
    """

    def values(scene):
        if scene is None:
            return None
        return scene_values(scene if isinstance(scene, Scene) else read_scene(scene))

    found = _axialmvs.compare_surveys(vars(before), vars(after), values(scene_before), values(scene_after), options)
    found["regions"] = [ChangedRegion(**region) for region in found["regions"]]
    return Comparison(**found)
