# SPDX-License-Identifier: GPL-3.0-or-later
"""texture_mesh(), map_surface(), compare_surveys() and textured meshes of the Python package."""

import pathlib
import tempfile
import unittest

import numpy as np
import small_dive
from densify_test import QUICK, InFolder

import axialmvs

from programs import must  # small_dive has the folder in sys.path

TOWARDS_CAMERAS = (0, 0, -1)


def sheet(heights, step):
    """The mesh of heights at the places (row * step, column * step), facing up."""
    rows, columns = heights.shape
    points = np.stack(np.broadcast_arrays(step * np.arange(columns), step * np.arange(rows)[:, None], heights), axis=-1)
    corners = np.arange(rows * columns).reshape(rows, columns)[:-1, :-1].reshape(-1, 1)
    faces = np.concatenate([corners + [0, 1, columns], corners + [1, columns + 1, columns]])
    return axialmvs.Mesh(points.reshape(-1, 3).astype(np.float32), faces.astype(np.uint32))


def ground(rows=121, columns=161, step=0.02):
    """Relief with waves in both directions, so that a motion is determined."""
    x, y = step * np.arange(columns), step * np.arange(rows)[:, None]
    return 0.05 * np.sin(5 * x + 1) * np.cos(4 * y) + 0.03 * np.sin(9 * y + 3 * x)


class Textures(InFolder):
    def test_writes_the_bytes_of_the_program(self):
        scene = small_dive.write_files(self.folder)
        mesh = axialmvs.reconstruct_mesh(axialmvs.densify(scene, **QUICK).cloud, scene)
        axialmvs.write_mesh(self.folder / "mesh.ply", mesh)
        must("TextureMesh", "-i", scene, "-m", self.folder / "mesh.ply", "-w", self.folder, "-o",
             self.folder / "textured.ply", "--max-texture-size", 256)
        (self.folder / "own").mkdir()
        textured = axialmvs.texture_mesh(mesh, scene, max_size=256)
        axialmvs.write_textured_mesh(self.folder / "own" / "textured.ply", textured)
        written = sorted((self.folder / "own").iterdir())
        self.assertGreater(len(written), 1)
        for file in written:
            self.assertEqual(file.read_bytes(), (self.folder / file.name).read_bytes(), file.name)

    def test_a_map_has_the_colours_and_heights_of_the_ground(self):
        dive = small_dive.scene()
        flat = sheet(np.zeros((31, 51)), 0.02)
        flat.vertices += np.float32([-0.3, -0.2, small_dive.GROUND])
        flat.faces = flat.faces[:, ::-1]  # towards the cameras
        textured = axialmvs.texture_mesh(flat, dive, photographs=small_dive.photographs())
        found = axialmvs.map_surface(textured, pixel=0.01, up=TOWARDS_CAMERAS)
        self.assertEqual(found.heights.shape, (60, 100))
        np.testing.assert_allclose(found.heights, -small_dive.GROUND, atol=1e-6)
        np.testing.assert_array_equal(found.axes, np.diag([1, -1, -1]))
        rows, columns = np.mgrid[:60, :100]
        x, y = np.moveaxis(found.places(rows, columns), -1, 0)
        known = found.colors[..., 3] == 255
        self.assertGreater(known.mean(), 0.9)
        # A photograph's pixel is 9 mm wide and shows a mean of the ground, which changes by a few levels in this width.
        difference = found.colors[..., 0].astype(float) - small_dive.grey(x, -y)
        self.assertLess(np.median(np.abs(difference[known])), 6)
        self.assertLess(abs(np.mean(difference[known])), 2)

    def test_files_keep_textures(self):
        dive = small_dive.scene()
        flat = sheet(np.zeros((4, 4)), 0.1)
        flat.vertices += np.float32([0, 0, small_dive.GROUND])
        flat.faces, flat.origin = flat.faces[:, ::-1], np.array([0.0, 0, 0])
        textured = axialmvs.texture_mesh(flat, dive, photographs=small_dive.photographs(), empty_color=(1, 2, 3))
        for name in ("mesh.ply", "mesh.obj", "mesh.glb"):
            axialmvs.write_textured_mesh(self.folder / name, textured)
            again = axialmvs.read_textured_mesh(self.folder / name)
            self.assertEqual(len(again.faces), len(textured.faces))
            np.testing.assert_array_equal(again.textures[0], textured.textures[0])
            np.testing.assert_allclose(again.uv, textured.uv, atol=1e-3)  # pixels; files have six digits or floats
            np.testing.assert_allclose(again.vertices[again.faces], textured.vertices[textured.faces], atol=1e-6)
        with self.assertRaisesRegex(axialmvs.Error, "extension"):
            axialmvs.write_textured_mesh(self.folder / "mesh.stl", textured)


class Changes(unittest.TestCase):
    # A bump of 2 cm, whose volume is the integral of a Gaussian function.
    WIDTH, HEIGHT = 0.15, 0.02
    VOLUME = 2 * np.pi * WIDTH**2 * HEIGHT
    NOISE = 0.0003

    def surveys(self, shift=(0, 0, 0)):
        random = np.random.default_rng(5)
        before = ground()
        x, y = 0.02 * np.arange(161), 0.02 * np.arange(121)[:, None]
        bump = self.HEIGHT * np.exp(-((x - 1.6)**2 + (y - 1.2)**2) / (2 * self.WIDTH**2))
        noise = lambda: random.normal(0, self.NOISE, before.shape)
        later = sheet(before + bump + noise(), 0.02)
        later.vertices += np.float32(shift)
        return sheet(before + noise(), 0.02), later

    def test_finds_what_came(self):
        found = axialmvs.compare_surveys(*self.surveys(), up=(0, 0, 1))
        self.assertEqual([region.came for region in found.regions[:1]], [True])
        self.assertLess(np.hypot(found.regions[0].x - 1.6, found.regions[0].y - 1.2), 0.02)
        # Differences below 1.5 standard deviations are not in the region: 0.6 mm of 20 mm are cut off at its rim.
        self.assertLess(abs(found.came[0] / self.VOLUME - 1), 0.05)
        self.assertLess(abs(found.noise / (np.sqrt(2) * self.NOISE) - 1), 0.5)  # interpolation smooths noise
        self.assertTrue((found.classes[found.difference > 0.01] == 2).all())
        np.testing.assert_array_equal(found.rotation, np.eye(3))

    def test_aligns_the_later_survey(self):
        shift = np.array([0.004, -0.003, 0.006])
        found = axialmvs.compare_surveys(*self.surveys(shift), up=(0, 0, 1), align="icp")
        at = np.array([1.6, 1.2, 0]) + shift  # the middle of the ground
        np.testing.assert_allclose(found.rotation @ at + found.translation, at - shift, atol=0.0005)
        self.assertLess(abs(found.came[0] / self.VOLUME - 1), 0.06)

    def test_wrong_input_is_named(self):
        before, after = self.surveys()
        for keywords, setting in (({"sigma_before": 0.01}, "sigma_after"), ({"align": "best"}, "align"),
                                  ({"up": (0, 0, 0)}, "up"), ({"least_pixels": 0}, "least_pixels")):
            with self.assertRaises(axialmvs.Error) as raised:
                axialmvs.compare_surveys(before, after, **keywords)
            self.assertEqual(raised.exception.setting, setting)
        with self.assertRaises(axialmvs.Error) as raised:
            axialmvs.map_surface(before, pixel=0)
        self.assertEqual(raised.exception.setting, "pixel")
        with self.assertRaisesRegex(TypeError, "map_surface.* 'gsd'"):
            axialmvs.map_surface(before, pixel=0.1, gsd=1)
        with self.assertRaises(axialmvs.Error) as raised:
            axialmvs.compare_surveys(before, after, up=(0, 0, -1))  # what came would count as gone
        self.assertEqual(raised.exception.setting, "up")
        with self.assertRaisesRegex(axialmvs.Error, "scene_after: has no calibrated image"):
            axialmvs.compare_surveys(before, after, scene_after=axialmvs.Scene([]))
        after.unseen = np.ones(len(after.faces), np.uint8)
        with self.assertRaisesRegex(axialmvs.Error, "the later survey: .* marked as unseen"):
            axialmvs.compare_surveys(before, after)

    def test_wrong_textures_are_named(self):
        mesh, _ = self.surveys()
        count = len(mesh.faces)
        textured = lambda uv, texture_of, texture: axialmvs.TexturedMesh(
            **vars(mesh), uv=np.zeros(uv), texture_of=np.zeros(texture_of, int), textures=[np.zeros(texture, np.uint8)])
        good = (count, 3, 2), count, (4, 4, 3)
        axialmvs.map_surface(textured(*good), pixel=0.1)
        for k, wrong, message in ((0, (1, 2), "uv: "), (0, (count - 1, 3, 2), "uv: has"),
                                  (1, count - 1, "texture_of: has"), (2, (0, 0, 3), "textures: ")):
            given = good[:k] + (wrong,) + good[k + 1:]
            with self.assertRaisesRegex(ValueError, message):
                axialmvs.map_surface(textured(*given), pixel=0.1)
        mesh.unseen = np.zeros(3, np.uint8)
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(axialmvs.Error, "marks of unseen"):
            axialmvs.write_textured_mesh(pathlib.Path(folder, "mesh.ply"), textured(*good))


if __name__ == "__main__":
    unittest.main(verbosity=2)
