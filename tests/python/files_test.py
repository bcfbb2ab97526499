# SPDX-License-Identifier: GPL-3.0-or-later
"""Records that are written and read again, and files that are wrong."""

import pathlib
import tempfile
import unittest

import numpy as np
import small_dive

import axialmvs


class InFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "file"
        self.random = np.random.default_rng(1)

    def equal(self, found, expected, within=0.0):
        """Fields that are arrays are equal, with their types."""
        for name, value in vars(expected).items():
            if isinstance(value, np.ndarray):
                self.assertEqual(getattr(found, name).dtype, value.dtype, name)
                np.testing.assert_allclose(getattr(found, name), value, rtol=0, atol=within, err_msg=name)
            elif value is None:
                self.assertIsNone(getattr(found, name), name)


class DepthMaps(InFolder):
    def a_map(self):
        depth = self.random.uniform(1, 2, (120, 160)).astype(np.float32)
        depth[:5] = 0
        normal = np.broadcast_to(np.float32([0, 0, -1]), (120, 160, 3))
        confidence = self.random.uniform(0, 1, (120, 160)).astype(np.float32)
        return axialmvs.DepthMap(depth, small_dive.CAMERA, np.eye(3)[[1, 2, 0]], np.array([1.0, 2, 3]), normal,
                                 confidence, [3, 1, 2], str(self.path.parent / "a.png"), 1, 2, "me")

    def test_round_trip(self):
        written = self.a_map()
        axialmvs.write_depth_map(self.path, written)
        found = axialmvs.read_depth_map(self.path)
        # The file has z-depths: two conversions in float.
        self.equal(found, written, within=1e-6)
        self.assertEqual((found.ids, found.made_from, found.camera.port), ([3, 1, 2], "me", small_dive.CAMERA.port))
        self.assertEqual(found.image_path, written.image_path)

    def test_points_have_the_depths_along_their_rays(self):
        depth_map = self.a_map()
        points = (depth_map.points() - depth_map.centre) @ depth_map.rotation.T
        pixels, valid = depth_map.camera.project(points)
        self.assertTrue(valid.all())
        rows, columns = np.nonzero(depth_map.depth)
        np.testing.assert_allclose(pixels, np.column_stack([columns, rows]), rtol=0, atol=1e-9)
        origins, _ = depth_map.camera.unproject(pixels)
        np.testing.assert_allclose(np.linalg.norm(points - origins, axis=1), depth_map.depth[rows, columns], atol=1e-9)

    def test_wrong_arrays_are_named(self):
        for name, value, error, said in (("depth", np.ones(3), ValueError, r"depth: has the shape \(3,\)"),
                                         ("normal", np.ones((120, 160)), ValueError, "normal: has the shape"),
                                         ("depth", np.ones((2, 2), complex), TypeError, "depth: has the dtype"),
                                         ("depth", np.ones((9, 9)), axialmvs.Error, "file")):
            depth_map = self.a_map()
            setattr(depth_map, name, value)
            with self.assertRaisesRegex(error, said):
                axialmvs.write_depth_map(self.path, depth_map)
            self.assertFalse(self.path.exists())


class Clouds(InFolder):
    def a_cloud(self):
        random = self.random
        return axialmvs.PointCloud(
            random.normal(size=(4, 3)).astype(np.float32), random.normal(size=(4, 3)).astype(np.float32),
            random.integers(0, 256, (4, 3)).astype(np.uint8), np.array([0, 2, 2, 3, 5], np.uint64),
            np.array([0, 1, 4, 2, 3], np.uint32), random.uniform(0, 1, 5).astype(np.float32),
            origin=np.array([500000.0, 4000000, 0]))

    def test_round_trip_with_views_and_origin(self):
        written = self.a_cloud()
        axialmvs.write_cloud(self.path, written)
        self.equal(axialmvs.read_cloud(self.path), written)

    def test_doubles_in_the_world_keep_their_precision(self):
        written = self.a_cloud()
        axialmvs.write_cloud(self.path, written, double_precision=True)
        found = axialmvs.read_cloud(self.path)
        # A double of 4e6 is exact to 1e-9, a float of 10 to 1e-6.
        np.testing.assert_allclose(found.positions + found.origin, written.positions + written.origin, rtol=0,
                                   atol=2e-6)

    def test_only_positions(self):
        axialmvs.write_cloud(self.path, axialmvs.PointCloud([[1, 2, 3]]))
        found = axialmvs.read_cloud(self.path)
        self.equal(found, axialmvs.PointCloud(np.array([[1, 2, 3]], np.float32)))

    def test_wrong_views_are_refused(self):
        for begin in ([0, 2, 2, 3], [0, 2, 1, 3, 5], [0, 2, 2, 3, 9], [1, 2, 2, 3, 5]):
            cloud = self.a_cloud()
            cloud.view_begin = np.array(begin, np.uint64)
            with self.assertRaisesRegex(ValueError, "view_begin"):
                axialmvs.write_cloud(self.path, cloud)

    def test_errors_of_files_name_the_file(self):
        self.path.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 2\n")
        for read in (axialmvs.read_cloud, axialmvs.read_mesh, axialmvs.read_depth_map, axialmvs.read_scene,
                     axialmvs.read_photograph, axialmvs.read_housing):
            with self.assertRaises(axialmvs.Error) as raised:
                read(self.path)
            self.assertIn(str(self.path), raised.exception.file)


class Meshes(InFolder):
    def test_round_trip(self):
        written = axialmvs.Mesh(self.random.normal(size=(3, 3)).astype(np.float32), np.array([[0, 1, 2]], np.uint32),
                                np.array([[1, 2, 3]] * 3, np.uint8), np.array([1], np.uint8), np.array([0.0, 5000, 0]))
        axialmvs.write_mesh(self.path, written)
        self.equal(axialmvs.read_mesh(self.path), written)


class Scenes(InFolder):
    def test_round_trip(self):
        scene = small_dive.write_files(self.path.parent)
        found, expected = axialmvs.read_scene(scene), small_dive.scene()
        self.equal(found, expected)
        for image, written in zip(found.images, expected.images, strict=True):
            self.equal(image, written)
            self.assertEqual((image.id, image.camera.port), (written.id, written.camera.port))
            self.assertEqual(image.path, str(self.path.parent / written.path))
        np.testing.assert_array_equal(axialmvs.read_photograph(found.images[2].path),
                                      small_dive.photograph(expected.images[2]))

    def test_ports_can_be_ignored(self):
        scene = small_dive.write_files(self.path.parent)
        self.assertIsNone(axialmvs.read_scene(scene, ports="ignored").images[0].camera.port)
        with self.assertRaises(axialmvs.Error) as raised:
            axialmvs.read_scene(scene, ports="dry")
        self.assertEqual(raised.exception.setting, "ports")

    def test_lenses_and_regions_are_kept(self):
        lens = axialmvs.Lens(160, 161, 80, 60, above=(1, -0.1, 0, 0, 0))
        scene = small_dive.scene(axialmvs.Camera(lens, width=160, height=120))
        scene.region = axialmvs.Region(np.eye(3), np.array([1.0, 2, 3]), np.array([3.0, 2, 1]))
        axialmvs.write_scene(self.path.with_suffix(".mvs"), scene, working_folder=self.path.parent)
        found = axialmvs.read_scene(self.path.with_suffix(".mvs"))
        self.assertEqual(found.images[0].camera.lens.above, lens.above)
        self.equal(found.region, scene.region)


if __name__ == "__main__":
    unittest.main(verbosity=2)
