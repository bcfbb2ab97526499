# SPDX-License-Identifier: GPL-3.0-or-later
"""reconstruct_mesh() and clean_mesh() of the Python package."""

import unittest

import numpy as np
import small_dive
from densify_test import QUICK, InFolder

import axialmvs

from programs import must  # small_dive has the folder in sys.path


class Meshes(InFolder):
    def test_writes_the_bytes_of_the_program(self):
        scene = small_dive.write_files(self.folder)
        cloud = axialmvs.densify(scene, **QUICK).cloud
        must("ReconstructMesh", "-i", self.folder / "scene_dense.mvs", "-w", self.folder, "-o",
             self.folder / "mesh.ply", "--smooth", 1)
        mesh = axialmvs.reconstruct_mesh(cloud, self.folder / "scene_dense.mvs", smooth=1)
        axialmvs.write_mesh(self.folder / "own.ply", mesh)
        self.assertEqual((self.folder / "own.ply").read_bytes(), (self.folder / "mesh.ply").read_bytes())
        # As the cloud.
        self.assertLess(np.abs(mesh.vertices[:, 2] - small_dive.GROUND).mean(), 0.005)
        fewer = axialmvs.clean_mesh(mesh, decimate=0.2)
        # The share is not exact, because cleaning removes and adds faces after the simplification.
        self.assertLess(len(fewer.faces), 0.3 * len(mesh.faces))
        self.assertGreater(len(fewer.faces), 0.1 * len(mesh.faces))

    def test_cloud_and_scene_may_have_other_origins(self):
        dive = small_dive.scene()
        cloud = axialmvs.densify(dive, photographs=small_dive.photographs(), **QUICK).cloud
        expected = axialmvs.reconstruct_mesh(cloud, dive)
        cloud.positions, cloud.origin = cloud.positions - np.float32([0, 0, 8]), np.array([0.0, 0, 8])
        found = axialmvs.reconstruct_mesh(cloud, dive)
        np.testing.assert_array_equal(found.origin, 0)
        # Positions of 8 m are rounded to 5e-7 m, which can change the triangles.
        self.assertLess(abs(len(found.faces) - len(expected.faces)), 0.02 * len(expected.faces))
        self.assertLess(np.abs(found.vertices[:, 2] - small_dive.GROUND).mean(), 0.005)

    def test_refining_brings_vertices_back(self):
        dive = small_dive.scene()
        points = np.array([[x, y, small_dive.GROUND]
                           for y in np.linspace(-0.2, 0.4, 31) for x in np.linspace(-0.3, 0.7, 51)])
        points[:, 2] += np.random.default_rng(2).normal(0, 0.01, len(points))
        corners = np.arange(30 * 51).reshape(30, 51)[:, :-1].reshape(-1, 1)
        faces = np.concatenate([corners + [0, 51, 1], corners + [1, 51, 52]])
        rough = axialmvs.Mesh(points, faces)
        mesh = axialmvs.refine_mesh(rough, dive, photographs=small_dive.photographs(), max_threads=2, scales=1)
        inside = (np.abs(mesh.vertices[:, :2] - [0.2, 0.1]) < [0.4, 0.2]).all(axis=1)
        self.assertGreater(inside.sum(), 500)
        # The vertices were 0.008 m away on average. A pixel is 9 mm wide.
        self.assertLess(np.abs(mesh.vertices[inside, 2] - small_dive.GROUND).mean(), 0.006)

    def test_wrong_input_is_named(self):
        with self.assertRaisesRegex(TypeError, "reconstruct_mesh.* 'size'"):
            axialmvs.reconstruct_mesh(axialmvs.PointCloud(np.zeros((1, 3))), small_dive.scene(), size=1)
        with self.assertRaises(axialmvs.Error) as raised:
            axialmvs.reconstruct_mesh(axialmvs.PointCloud(np.zeros((1, 3))), small_dive.scene(), decimate=2)
        self.assertEqual(raised.exception.setting, "decimate")
        with self.assertRaisesRegex(axialmvs.Error, "views"):
            axialmvs.reconstruct_mesh(axialmvs.PointCloud(np.zeros((1, 3))), small_dive.scene())
        with self.assertRaisesRegex(ValueError, "normals: has 1 items, but must have 2"):
            axialmvs.reconstruct_mesh(axialmvs.PointCloud(np.zeros((2, 3)), normals=np.zeros((1, 3))),
                                      small_dive.scene())
        with self.assertRaisesRegex(ValueError, "faces: has the number -1"):
            axialmvs.clean_mesh(axialmvs.Mesh(np.zeros((3, 3)), np.array([[0, 1, -1]])))
        with self.assertRaises(axialmvs.Error):
            axialmvs.clean_mesh(axialmvs.Mesh(np.zeros((1, 3)), np.array([[0, 1, 2]])))


if __name__ == "__main__":
    unittest.main(verbosity=2)
