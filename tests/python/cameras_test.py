# SPDX-License-Identifier: GPL-3.0-or-later
"""Cameras of the Python package against Snell's law, which snell.py writes in numpy."""

import pathlib
import tempfile
import unittest

import numpy as np
import snell

import axialmvs

LENS = axialmvs.Lens(700, 710, 510, 385)
SIZE = {"width": 1024, "height": 768}
POINTS = 2000
ROUNDING = 1e-9  # [px], the bound of the C++ tests


def tilted(random):
    """A normal up to 10 degrees from the optical axis."""
    tilt, azimuth = random.uniform(0, np.radians(10)), random.uniform(0, 2 * np.pi)
    return np.array([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])


def ports(random):
    """Ports of both kinds, in the ranges of housings of the C++ tests."""
    glass = {"n_air": 1.00028, "n_glass": random.uniform(1.45, 1.78), "n_water": random.uniform(1.325, 1.36)}
    for _ in range(5):
        yield axialmvs.FlatPort(distance=random.uniform(0, 0.03), thickness=random.uniform(0, 0.02),
                                normal=tilted(random), **glass)
        radius = random.uniform(0.03, 0.12)
        centre = random.normal(size=3)
        centre *= random.uniform(0, 0.4) * radius / np.linalg.norm(centre)
        yield axialmvs.DomePort(inner_radius=radius, thickness=random.uniform(0, 0.02), centre=centre, **glass)


def pixels_in(random):
    return random.uniform((0, 0), (SIZE["width"] - 1, SIZE["height"] - 1), (POINTS, 2))


def distorted():
    return axialmvs.Lens(700, 710, 510, 385, above=(1, -0.02, 0, 0, 0), below=(0.05, 0, 0), p1=1e-3, prism=(0, -1e-3))


class AgainstSnell(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(1)

    def test_points_on_traced_rays_have_their_pixels(self):
        for port in ports(self.random):
            camera = axialmvs.Camera(LENS, port=port, **SIZE)
            pixels = pixels_in(self.random)
            entries, directions = snell.through(port, snell.bearings(LENS, pixels))
            lengths = np.exp(self.random.uniform(np.log(0.2), np.log(10), POINTS))
            points = entries + lengths[:, None] * directions
            found, valid = camera.project(points)
            self.assertTrue(valid.all(), port)
            np.testing.assert_allclose(found, pixels, rtol=0, atol=ROUNDING, err_msg=repr(port))
            # A path is the difference of positions of up to 10 m: 1e-9 m are 50,000 roundings.
            np.testing.assert_allclose(camera.path_lengths(points), lengths, rtol=0, atol=1e-9)

    def test_rays_are_the_traced_rays(self):
        for port in ports(self.random):
            camera = axialmvs.Camera(LENS, port=port, **SIZE)
            pixels = pixels_in(self.random)
            entries, directions = snell.through(port, snell.bearings(LENS, pixels))
            origins, found = camera.unproject(pixels)
            np.testing.assert_allclose(found, directions, rtol=0, atol=1e-12)
            np.testing.assert_allclose(camera.exit_points(pixels), entries, rtol=0, atol=1e-12)
            off_the_ray = np.cross(entries - origins, directions)
            np.testing.assert_allclose(off_the_ray, 0, atol=1e-12)

    def test_without_a_port_the_camera_is_a_pinhole(self):
        camera = axialmvs.Camera(LENS, **SIZE)
        points = np.array([[0.1, -0.2, 1.5]])
        pixels, valid = camera.project(points)
        np.testing.assert_allclose(pixels, [[510 + 70 / 1.5, 385 - 142 / 1.5]], atol=1e-12)
        self.assertTrue(valid[0])
        np.testing.assert_allclose(camera.path_lengths(points), np.linalg.norm(points), atol=1e-12)
        origins, directions = camera.unproject(pixels)
        np.testing.assert_allclose(directions, points / np.linalg.norm(points), atol=1e-12)
        np.testing.assert_array_equal(origins, [[0, 0, 0]])


class OfEveryKind(unittest.TestCase):
    """Properties of cameras with and without port and distortion."""

    def cameras(self):
        random = np.random.default_rng(2)
        flat, dome = list(ports(random))[:2]
        for lens in (LENS, distorted()):
            for port in (None, flat, dome):
                yield axialmvs.Camera(lens, port=port, **SIZE), pixels_in(random), random

    def points(self, camera, pixels, random):
        _, directions = camera.unproject(pixels)
        return camera.exit_points(pixels) + random.uniform(0.2, 10, (POINTS, 1)) * directions

    def test_unproject_and_project_are_inverse(self):
        for camera, pixels, random in self.cameras():
            found, valid = camera.project(self.points(camera, pixels, random))
            self.assertTrue(valid.all(), camera)
            np.testing.assert_allclose(found, pixels, rtol=0, atol=ROUNDING, err_msg=repr(camera))

    def test_jacobian_is_that_of_central_differences(self):
        step = 1e-5
        for camera, pixels, random in self.cameras():
            points = self.points(camera, pixels, random)
            expected = np.stack([(camera.project(points + d)[0] - camera.project(points - d)[0]) / (2 * step)
                                 for d in step * np.eye(3)], axis=2)
            found = camera.jacobian(points)
            self.assertEqual(found.shape, (POINTS, 2, 3))
            # The second derivatives of near points give 1e-6 of the largest derivative.
            largest = np.abs(expected).max(axis=(1, 2), keepdims=True)
            self.assertLess((np.abs(found - expected) / largest).max(), 1e-6, camera)

    def test_virtual_cameras_image_rays_at_their_pixels(self):
        for camera, pixels, random in self.cameras():
            centres, rotation, principal = camera.virtual_cameras(pixels)
            seen = (self.points(camera, pixels, random) - centres) @ rotation.T
            found = seen[:, :2] / seen[:, 2:] * (camera.lens.fx, camera.lens.fy) + principal
            # The points are up to 10 m away, with 11 digits behind the point.
            np.testing.assert_allclose(found, pixels, rtol=0, atol=1e-8)

    def test_points_that_are_not_seen_are_not_valid(self):
        for camera, _, _ in self.cameras():
            points = np.array([[0, 0, -1.0], [0, 0, np.nan]])
            pixels, valid = camera.project(points)
            self.assertFalse(valid.any())
            for array in (pixels, camera.path_lengths(points), camera.jacobian(points)):
                self.assertTrue(np.isnan(array).all())

    def test_resized_cameras_see_the_same_directions(self):
        for camera, pixels, _ in self.cameras():
            half = camera.resized(512, 384)
            np.testing.assert_allclose(half.unproject((pixels + 0.5) / 2 - 0.5)[1], camera.unproject(pixels)[1], rtol=0,
                                       atol=1e-12)


class Arguments(unittest.TestCase):
    CAMERA = axialmvs.Camera(LENS, port=axialmvs.FlatPort(distance=0.02, thickness=0.01, n_glass=1.5, n_water=1.34),
                             **SIZE)

    def test_arrays_of_other_numbers_are_taken(self):
        points = np.random.default_rng(3).integers(1, 5, (6, 3))
        expected = self.CAMERA.project(points.astype(float))[0]
        for same in (points, points.astype(np.float32), points.tolist(), np.asfortranarray(points, float),
                     np.repeat(points, 2, axis=0)[::2], points.astype(">f8")):
            np.testing.assert_array_equal(self.CAMERA.project(same)[0], expected)
        self.assertEqual(self.CAMERA.project(np.zeros((0, 3)))[0].shape, (0, 2))

    def test_wrong_shapes_and_dtypes_are_named(self):
        one = np.ones
        for error, said, call in (
                (ValueError, "points: has the shape (3,), but must have (N, 3)", lambda c: c.project(one(3))),
                (ValueError, "points: has the shape (4, 2), but must have (N, 3)", lambda c: c.jacobian(one((4, 2)))),
                (ValueError, "pixels: has the shape (4, 3), but must have (N, 2)", lambda c: c.unproject(one((4, 3)))),
                (ValueError, "points: has the shape (1, 2, 3)", lambda c: c.path_lengths(one((1, 2, 3)))),
                (TypeError, "points: has the dtype complex128", lambda c: c.project(one((1, 3), complex))),
                (TypeError, "pixels: has the dtype bool", lambda c: c.virtual_cameras(one((1, 2), bool))),
                (TypeError, "points: has the dtype <U1", lambda c: c.project([["1", "2", "3"]])),
                (TypeError, "pixels: has the dtype object", lambda c: c.exit_points([[None, 1]]))):
            with self.assertRaises(error) as raised:
                call(self.CAMERA)
            self.assertIn(said, str(raised.exception))

    def test_numbers_that_are_not_possible_are_named(self):
        flat = {"distance": 0.02, "thickness": 0.01, "n_glass": 1.5, "n_water": 1.34}
        for said, call in (
                ("FlatPort.distance_m", lambda: axialmvs.FlatPort(**flat | {"distance": -1})),
                ("FlatPort.normal", lambda: axialmvs.FlatPort(**flat, normal=(0, 0, 0))),
                ("FlatPort.n_water", lambda: axialmvs.FlatPort(**flat | {"n_water": 0.5})),
                ("DomePort.center_m", lambda: axialmvs.DomePort(inner_radius=0.1, thickness=0.01, n_glass=1.5,
                                                               n_water=1.34, centre=(0, 0, 0.1))),
                ("Camera.width 0", lambda: axialmvs.Camera(LENS, width=0, height=1)),
                ("Camera.lens.fx nan", lambda: axialmvs.Camera(axialmvs.Lens(np.nan, 1, 0, 0), width=1, height=1)),
                ("Camera.lens: the distortion mirrors",
                 lambda: axialmvs.Camera(axialmvs.Lens(9, 9, 0, 0, above=(-1, 0, 0, 0, 0)), width=9, height=9))):
            with self.assertRaises(axialmvs.Error) as raised:
                call()
            self.assertIn(said, str(raised.exception))
            self.assertIsInstance(raised.exception, RuntimeError)


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_housings_are_written_and_read(self):
        flat, dome = list(ports(np.random.default_rng(4)))[:2]
        housing = axialmvs.Housing({"main": flat, "side": dome}, "main", images={"b.jpg": "side", "c.jpg": "none"})
        axialmvs.write_housing(self.folder / "h.json", housing)
        found = axialmvs.read_housing(self.folder / "h.json")
        self.assertEqual(found.ports["side"], dome)
        self.assertNotEqual(found.ports["main"], dome)
        self.assertNotEqual(dome, None)
        np.testing.assert_allclose(found.ports["main"].normal, flat.normal, rtol=0, atol=1e-15)
        self.assertEqual([found.port_of(name) for name in ("a.jpg", "x/b.jpg", "c.jpg")], ["main", "side", "none"])
        self.assertEqual(found.carried_port("side"), dome)
        self.assertIsNone(found.carried_port("none"))

    def test_warnings_go_to_the_logger(self):
        path = self.folder / "h.json"
        path.write_text('{"version": 1, "default": "a", "ports": {"a": {"type": "flat", "distance_m": 0.02,'
                        '"thickness_m": 0.01, "n_glass": 1.5, "n_water": 1.34, "normal": [0, 0, 2]}}}')
        with self.assertLogs("axialmvs", "WARNING") as logged:
            axialmvs.read_housing(path)
        self.assertEqual(len(logged.output), 1)
        self.assertIn("has length 2: normalised", logged.output[0])
        with self.assertLogs("axialmvs", "WARNING"), self.assertRaises(axialmvs.Error):
            path.write_text(path.read_text().replace('"default": "a"', '"default": "b"'))
            axialmvs.read_housing(path)

    def test_cameras_of_colmap(self):
        (self.folder / "cameras.txt").write_text("1 OPENCV 100 80 90 91 50.5 40.5 0.1 0.02 0.003 0.004\n"
                                                 "4 PINHOLE 10 8 9 9 5 4\n")
        found = axialmvs.read_cameras(self.folder / "cameras.txt")
        self.assertEqual(sorted(found), [1, 4])
        x, y, s = 0.1, 0.2, 0.05
        scale = 1 + 0.1 * s + 0.02 * s * s
        expected = (90 * (x * scale + 2 * 0.003 * x * y + 0.004 * (s + 2 * x * x)) + 50,
                    91 * (y * scale + 0.003 * (s + 2 * y * y) + 2 * 0.004 * x * y) + 40)
        np.testing.assert_allclose(found[1].project([[0.1, 0.2, 1]])[0], [expected], rtol=0, atol=1e-9)
        self.assertEqual((found[4].lens.cx, found[4].width, found[4].port), (4.5, 10, None))

    def test_cameras_of_calibmar_have_their_ports(self):
        (self.folder / "calibration.yaml").write_text(
            "model: PINHOLE\nwidth: 100\nheight: 80\nparameters: [90, 90, 50, 40]\n"
            "non_svp_model: FLATPORT\nnon_svp_parameters: [0, 0, 1, 0.03, 0.01, 1.0, 1.5, 1.34]\n")
        camera = axialmvs.read_cameras(self.folder / "calibration.yaml")[1]
        self.assertEqual((camera.port.n_glass, camera.lens.cx), (1.5, 49.5))

    def test_errors_name_file_and_place(self):
        path = self.folder / "h.json"
        path.write_text('{"version": 1, "ports": {"a": {"type": "cube"}}, "default": "a"}')
        with self.assertRaises(axialmvs.Error) as raised:
            axialmvs.read_housing(path)
        self.assertTrue(raised.exception.text.startswith(str(path)))
        self.assertEqual(raised.exception.setting, "")
        self.assertEqual(raised.exception.text, str(raised.exception))
        self.assertIn("cube", raised.exception.text)
        with self.assertRaises(axialmvs.Error) as raised:
            axialmvs.read_cameras(self.folder / "missing.txt")
        self.assertIn("missing.txt", raised.exception.file)


class Memory(unittest.TestCase):
    def test_calls_keep_nothing(self):
        camera, points = Arguments.CAMERA, np.random.default_rng(5).uniform(1, 2, (500, 3))

        def work():
            pixels, _ = camera.project(points)
            for call in (camera.unproject, camera.exit_points, camera.virtual_cameras):
                call(pixels)
            camera.jacobian(points), camera.path_lengths(points)
            with self.assertRaises(ValueError):
                camera.project(pixels)

        for _ in range(50):
            work()
        before = resident()
        for _ in range(1000):
            work()
        # A kept array of pixels for each call would be 8 MB.
        self.assertLess(resident() - before, 4e6)


def resident():
    """The memory of this process [bytes]."""
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * 4096


if __name__ == "__main__":
    unittest.main(verbosity=2)
