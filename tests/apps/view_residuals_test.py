# SPDX-License-Identifier: GPL-3.0-or-later
"""What the page of ViewScene says about the quality of a reconstruction: residuals, coverage,
distances to a true mesh, rugosity, and damaged files."""

import json
import math
import os
import random
import shutil
import unittest

from browser import CHROMIUM
from programs import main, read, write
from readers import rotated
from tiny_scene import FOCAL, HEIGHT, WIDTH
from view_scene_test import PAGE, PORT, ViewCase, pixel, points
from worlds import grid, housing, wall

NOISE = 0.05  # [px]
TILT = 4  # degrees


NAMES = [f"view{i}.png" for i in range(9)]


def turn(axis, angle):
    """The quaternion (w, x, y, z) of a rotation about a unit axis."""
    return (math.cos(angle / 2), *(math.sin(angle / 2) * value for value in axis))


def product(a, b):
    return (a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0])


def poses():
    """(quaternion, centre) of cameras in three rows, tilted towards the middle, with rolls."""
    found = []
    for i in range(len(NAMES)):
        x, y = 0.35 * (i % 3 - 1), 0.3 * (i // 3 - 1)
        tilt = product(turn((1, 0, 0), -0.7 * y), turn((0, 1, 0), 0.7 * x))
        found.append((product(turn((0, 0, 1), 2.3 * i), tilt), (x, y, 0.1 * (i % 2))))
    return found


def observations():
    """Points in front of the cameras, and their pixels with noise: [(point, {image: pixel})]."""
    rng, found = random.Random(3), []
    while len(found) < 350:
        place = (rng.uniform(-0.8, 0.8), rng.uniform(-0.7, 0.7), rng.uniform(0.8, 1.5))
        track = {}
        for image, (q, centre) in enumerate(poses()):
            inside = rotated(q, [a - b for a, b in zip(place, centre)])
            x, y = (value + rng.gauss(0, NOISE) for value in pixel((0, 0, 0), inside))
            if -0.5 < x < WIDTH - 0.5 and -0.5 < y < HEIGHT - 0.5:
                track[image] = (x + 0.5, y + 0.5)  # pixel centres at 0.5
        if len(track) > 1:
            found.append((place, track))
    return found


OBSERVATIONS = observations()
COUNT = sum(len(track) for _, track in OBSERVATIONS)


def write_model(folder, shift=0.0, image_names=NAMES, points=None):
    """A COLMAP model of the observations. `shift`: of the first camera [m]. `points`: the number of
    points (all)."""
    rows, tracks = [[] for _ in NAMES], []
    for number, (place, track) in enumerate(OBSERVATIONS[:points], 1):
        seen = []
        for image, (x, y) in track.items():
            seen.append(f"{image + 1} {len(rows[image])}")
            rows[image].append(f"{x} {y} {number}")
        tracks.append(f"{number} {place[0]} {place[1]} {place[2]} 9 9 9 0.1 {' '.join(seen)}")
    lines = []
    for i, ((q, centre), name) in enumerate(zip(poses(), image_names)):
        t = [-value for value in rotated(q, centre)]
        t[0] += shift if i == 0 else 0
        lines.append(f"{i + 1} {' '.join(map(str, (*q, *t)))} 1 {name}\n{' '.join(rows[i])}\n")
    write(os.path.join(folder, "cameras.txt"),
          f"1 PINHOLE {WIDTH} {HEIGHT} {FOCAL} {FOCAL} {WIDTH / 2} {HEIGHT / 2}\n")
    write(os.path.join(folder, "images.txt"), "".join(lines))
    write(os.path.join(folder, "points3D.txt"), "\n".join(tracks) + "\n")


def teeth():
    """A mesh at z = 1.1 whose teeth along x rise by 45 degrees: its rugosity is sqrt(2)."""
    step = 0.03
    return grid(24, 1, lambda i, j: (step * i - 0.36, 0.8 * j - 0.4, 1.1 + step * (i % 2)))


@unittest.skipUnless(os.path.exists(PAGE), "the page of ViewScene was not built")
class QualityCase(ViewCase):
    def setUp(self):
        super().setUp()
        self.model = self.path("model")
        write_model(self.model)

    def use_model(self):
        """Replaces the scene by one of the model."""
        for name in NAMES:
            shutil.copy(self.images[0], os.path.join(self.model, name))
        self.succeeds("InterfaceCOLMAP", "-i", self.model, "--image-folder", self.model,
                      "--housing", self.port, "-o", self.scene)


class Residuals(QualityCase):
    def residuals(self, *arguments):
        self.use_model()
        self.succeeds(*self.view("--sfm-model", self.model, *arguments))
        return self.shown()["residuals"]

    def test_they_are_the_noise_of_the_observations(self):
        found = self.residuals()
        self.assertEqual((found["observations"], found["unseen"]), (COUNT, 0))
        self.assertAlmostEqual(found["rms"], NOISE * math.sqrt(2), delta=0.003)
        camera, = found["cameras"]
        self.assertTrue(camera["tells"] and not camera["found"])
        self.assertEqual(sum(cell[0] for cell in camera["grid"]["cells"]), COUNT)
        self.assertEqual([photo["number"] for photo in found["photographs"]], list(range(len(NAMES))))
        self.assertEqual(sum(photo["observations"] for photo in found["photographs"]), COUNT)

    def test_photographs_with_few_observations_keep_their_poses(self):
        write_model(self.model, points=8)
        found = self.residuals()
        self.assertGreater(found["rms"], 0)
        self.assertEqual(found["rms_freed"], found["rms"])

    def test_a_name_in_a_folder_is_not_the_name_outside(self):
        os.makedirs(os.path.join(self.model, "sub"))
        shutil.copy(self.images[0], os.path.join(self.model, "sub", NAMES[1]))
        write_model(self.model, image_names=[f"sub/{NAMES[1]}", *NAMES[1:]])
        self.assertEqual(self.residuals()["observations"], COUNT)

    def test_a_wrong_model_is_refused(self):
        self.use_model()
        write_model(self.path("moved"), shift=0.05)
        write_model(self.path("foreign"), image_names=[name.upper() for name in NAMES])
        os.makedirs(self.path("nothing"))
        for expected, folder in (("moved: image view0.png: its pose differs", "moved"),
                                 ("foreign: has no image of the scene", "foreign"),
                                 ("nothing", "nothing"), ("missing", "missing")):
            self.refuses_and_keeps(expected, *self.view("--sfm-model", self.path(folder)))
        self.refuses_and_keeps("missing.ply", *self.view("--truth", "missing.ply"))


@unittest.skipUnless(CHROMIUM, "Chromium is not installed")
class QualityPage(QualityCase):
    def text(self, page, selector):
        return page.value(f"document.querySelector({json.dumps(selector)}).innerText")

    def test_residuals_are_drawn_and_judged(self):
        self.use_model()
        page = self.opened("--sfm-model", self.model)
        page.click_on("[data-tab=residuals]")
        self.assertIn("No systematic pattern", self.text(page, "#residuals .verdict"))
        self.assertIn(f"{COUNT:,}",
                      self.text(page, "#residuals"))
        cells = page.value("document.querySelectorAll('.arrows rect').length")
        grid = page.value("axial.scene.residuals.cameras[0].grid")
        self.assertEqual(cells, grid["columns"] * grid["rows"])
        self.assertGreater(page.value("document.querySelectorAll('.arrows polygon').length"), cells / 2)
        page.value("(() => { const choice = document.getElementById('residual-choice');"
                   "choice.value = 'photograph 1'; choice.onchange?.();"
                   "choice.dispatchEvent(new Event('change')); })()")
        self.assertIn("photographs/", page.value("document.querySelector('.arrows image')"
                                                 ".getAttribute('href')"))
        self.assertNotIn("poses do not fit", self.text(page, "#residuals"))
        self.assertEqual(page.errors, [])

    def test_a_wrong_port_is_named(self):
        self.use_model()
        angle = math.radians(TILT)
        write(self.port, housing({**PORT, "normal": [math.sin(angle), 0, math.cos(angle)]}))
        page = self.opened("--sfm-model", self.model, width=390, height=844)
        page.click_on("[data-tab=residuals]")
        self.assertIn("A systematic pattern in camera 1 (flat port main)",
                      self.text(page, "#residuals .verdict"))
        self.assertIn("Likely cause: normal of the port", self.text(page, "#residuals .cause"))
        cause = page.value("axial.scene.residuals.causes[0]")
        self.assertAlmostEqual(cause["numbers"][0]["stated"], TILT, delta=1e-6)
        self.assertAlmostEqual(cause["numbers"][0]["change"], -TILT, delta=0.25 * TILT)
        self.assertLessEqual(page.value("document.documentElement.scrollWidth"), 390)
        self.assertEqual(page.errors, [])

    def test_points_are_coloured_by_views_height_and_error(self):
        self.put("truth.ply", *wall(z=1.0))
        page = self.opened("--truth", "truth.ply")
        page.value("document.querySelectorAll('[aria-pressed=true]')[1].click()")  # no cameras
        colours = lambda: page.value("[...axial.view.cloud.chunks[0].object.geometry"
                                     ".getAttribute('color').array]")
        before, seen = colours(), []
        for mode, low, high in (("views", "0", "3"), ("height", "", ""),
                                ("errors", "0.00 mm", "40.0 mm")):
            page.value(f"axial.colours.choose('{mode}')")
            legend = self.text(page, "#legend")
            self.assertTrue(low in legend and high in legend, legend)
            seen.append(colours())
        self.assertEqual(len({tuple(colour) for colour in (before, *seen)}), 4)
        # The point of a place, by its colour: errors are 0, 20 and 40 mm, so there are 3 colours.
        triples = {tuple(seen[2][k:k + 3]) for k in range(0, len(seen[2]), 3)}
        self.assertEqual(len(triples), 3)
        # A way to colour that is chosen before the first points are loaded.
        page.value("(() => { const { cloud } = axial.view, { chunks, points } = cloud;"
                   "Object.assign(cloud, { chunks: [], points: 0 }); axial.colours.choose('height');"
                   "Object.assign(cloud, { chunks, points }); axial.colours.paint(chunks[0]); })()")
        self.assertEqual(colours(), seen[1])
        page.value("axial.colours.choose('photographs')")
        self.assertEqual(colours(), before)
        for (place, views), error in ((points()[0], 0), (points()[1], 20), (points()[2], 40)):
            page.click(*self.place_of(page, place))
            rows = self.text(page, "#point")
            self.assertIn(f"Views\t{len(views)}", rows)
            found = float(rows.split("Distance to the truth\t")[1].split()[0])
            self.assertAlmostEqual(found, error, delta=0.03)  # positions are rounded to 16 bits
        self.assertEqual(page.errors, [])

    def test_rugosity_of_a_known_mesh(self):
        self.put("teeth.ply", *teeth())
        page = self.opened("-m", "teeth.ply")
        page.click_on("[data-tab=measure]")
        # A triangle, and a path with a corner that points inwards.
        for corners in ([(-0.2, -0.17, 1), (0.23, 0.1, 1), (-0.11, 0.21, 1)],
                        [(-0.2, -0.2, 1), (0.2, -0.2, 1), (0.2, 0.2, 1), (0.013, -0.07, 1)]):
            page.click_on("#clear")
            page.value(f"{json.dumps(corners)}.forEach(corner => axial.paths.add(corner))")
            page.click_on(".volume")
            found = page.value("axial.paths.all[0].volumes")
            area = abs(sum(a[0] * b[1] - a[1] * b[0]
                           for a, b in zip(corners, corners[1:] + corners[:1]))) / 2
            self.assertAlmostEqual(found["rugosity"], math.sqrt(2), delta=1e-4)
            self.assertAlmostEqual(found["surface"], area * math.sqrt(2), delta=1e-5)
            self.assertIn("1.414", self.text(page, "#paths"))
        self.assertIn("1.41421", page.value("axial.paths.csv()").splitlines()[-1].split(",")[-1])
        self.assertEqual(page.errors, [])

    def test_a_damaged_file_is_reported_once_and_the_rest_is_shown(self):
        self.put("teeth.ply", *teeth())
        self.succeeds(*self.view("-m", "teeth.ply"))
        file = self.path("work", "report", "data", "mesh-0000.js")
        whole = read(file)
        for damaged in (whole[:len(whole) // 2], whole.replace(b'"mesh",0', b'"mesh",9')):
            write(file, damaged)
            page = self.reopened("document.getElementById('status')?.className == 'error'")
            self.assertIn("data/mesh-0000.js is damaged", self.text(page, "#status"))
            page.wait_for("axial.view.complete")
            page.click_on("[data-tab=measure]")
            page.value("[[0, 0, 1], [0.1, 0, 1], [0, 0.1, 1]].forEach(x => axial.paths.add(x))")
            self.assertTrue(page.value("document.querySelector('.volume').disabled"))
            page.close()


if __name__ == "__main__":
    main()
