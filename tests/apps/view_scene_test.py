# SPDX-License-Identifier: GPL-3.0-or-later
"""ViewScene on the wall of tiny_scene.py: the folder, and its page in Chromium."""

import math
import os
import pathlib
import re
import shutil
import unittest

from browser import CHROMIUM, Browser
from programs import BIN, contents, files_below, main, read, write
from readers import shown_scene
from tiny_scene import CENTRES, CX, CY, FOCAL, TinyScene
from worlds import cloud, flat, housing, ply, wall

PAGE = os.path.join(BIN, "..", "share", "axialmvs", "view", "viewer.js")
DISTANCE, THICKNESS, N_GLASS, N_WATER = 0.02, 0.014, 1.52, 1.333
PORT = flat(distance_m=DISTANCE, thickness_m=THICKNESS, n_glass=N_GLASS, n_water=N_WATER)


def points():
    """A coarse grid, so that a click cannot hit a wrong point, and the views of its points."""
    return [((0.08 * i - 0.24, 0.08 * j - 0.16, 1 + 0.02 * ((i + j) % 3)),
             [0, 1, 2] if i % 2 else [0, 2]) for i in range(7) for j in range(5)]


def pixel(centre, place):
    """The pixel of a point behind the port, by bisection on Snell's law."""
    x, y, z = (a - b for a, b in zip(place, centre))
    radius = math.hypot(x, y)

    def reached(tangent):
        sine = tangent / math.hypot(1, tangent)
        tan_of = lambda n: (sine / n) / math.sqrt(1 - (sine / n) ** 2)
        return (DISTANCE * tangent + THICKNESS * tan_of(N_GLASS) +
                (z - DISTANCE - THICKNESS) * tan_of(N_WATER))

    low, high = 0.0, 10.0
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if reached(middle) < radius else (low, middle)
    return (CX - 0.5 + FOCAL * low * x / radius, CY - 0.5 + FOCAL * low * y / radius)


class ViewCase(TinyScene):
    def setUp(self):
        super().setUp()
        self.cloud, self.port = self.path("work", "cloud.ply"), self.path("work", "port.json")
        self.report = self.path("work", "report")
        write(self.cloud, cloud(points()))
        write(self.port, housing(PORT))

    def view(self, *arguments):
        return self.command("ViewScene", "-p", self.cloud, "--housing", self.port, "--report", self.report, *arguments)

    def shown(self):
        return shown_scene(self.report)

    def put(self, name, vertices, faces=()):
        write(self.path("work", name), ply(vertices, faces))

    def opened(self, *arguments, **window):
        """The page of a new run of ViewScene, when everything is loaded."""
        self.succeeds(*self.view(*arguments))
        browser = self.reopened("globalThis.axial && axial.ready", **window)
        self.addCleanup(browser.close)
        return browser

    def reopened(self, ready, **window):
        """The page in self.report, when the expression `ready` is true."""
        browser = Browser(pathlib.Path(self.report, "index.html").as_uri(), **window)
        try:
            browser.wait_for(ready)
        except BaseException:
            browser.close()
            raise
        return browser

    def place_of(self, browser, place):
        """Where the page shows a point. The page's camera is the one thing that is believed."""
        x, y = browser.value(f"axial.view.screenOf({list(place)})")
        self.assertTrue(0 < x < 900 and 0 < y < 700)
        return x, y


@unittest.skipUnless(os.path.exists(PAGE), "the page of ViewScene was not built")
class ViewFolder(ViewCase):
    def test_it_holds_the_page_the_photographs_and_the_data(self):
        made, _ = self.makes(*self.view())
        self.assertEqual({name.removeprefix("report/") for name in made},
                         {"index.html", "style.css", "viewer.js", "data/scene.js",
                          "data/cloud-0000.js", "data/files.json",
                          *(f"photographs/{i:05}.jpg" for i in range(3))})

    def test_the_first_view_of_a_mesh_is_that_of_its_faces(self):
        views = []
        vertices, faces = wall(z=1.1)
        for name, more in (("a.ply", []), ("b.ply", [(500 + i, 0, 0) for i in range(300)])):
            self.put(name, vertices + more, faces)
            self.succeeds(*self.command("ViewScene", "-m", name, "--report", name + "-page"))
            views.append(shown_scene(self.path("work", name + "-page"))["view"])
        self.assertEqual(views[0], views[1])

    def test_a_second_run_replaces_the_first_and_keeps_foreign_files(self):
        self.put("mesh.ply", *wall())
        self.succeeds(*self.view("-m", "mesh.ply"))
        self.assertTrue(os.path.exists(self.path("work", "report", "data", "mesh-0000.js")))
        write(self.path("work", "report", "notes.txt"), "Mine.")
        self.succeeds(*self.view())
        self.assertIn("notes.txt", files_below(self.report))
        self.assertNotIn("data/mesh-0000.js", files_below(self.report))

    def test_a_run_that_was_killed_is_repeated(self):
        os.makedirs(self.report)
        self.succeeds(*self.view())
        expected = contents(self.report)
        # Killed while it replaced the files: some are missing, and new ones are not yet there.
        for name in ("index.html", "viewer.js", "data/scene.js"):
            os.remove(os.path.join(self.report, name))
        self.succeeds(*self.view())
        self.assertEqual(contents(self.report), expected)

    def test_a_large_cloud_is_thinned_out(self):
        self.succeeds(*self.view("--max-points", 10))
        scene = self.shown()
        self.assertEqual(scene["all_points"], 35)
        self.assertLess(scene["points"], 25)
        self.assertEqual(sum(chunk["points"] for chunk in scene["chunks"]), scene["points"])

    def test_wrong_input_is_refused(self):
        write(self.path("work", "mine", "photo.jpg"), "Mine.")
        write(self.path("work", "theirs", "data", "files.json"), '{"index.html": "1"}')
        write(self.path("work", "empty.ply"), cloud([]))
        write(self.path("work", "foreign.ply"), cloud([((0, 0, 1), [7])]))
        self.put("flat.ply", wall()[0])
        for expected, *arguments in (
                ("--report " + self.path("work", "mine") + ": contains other files", "--report",
                 "mine"),
                ("--report " + self.path("work", "theirs") + ": contains other files", "--report",
                 "theirs"),
                ("--report " + self.cloud + ": is a file", "--report", self.cloud),
                ("missing.ply", "-p", "missing.ply"),
                ("empty.ply: the cloud has no points", "-p", "empty.ply"),
                ("foreign.ply: view_indices has image 7, but the scene has 3", "-p", "foreign.ply"),
                ("flat.ply: the mesh has no faces", "-m", "flat.ply"),
                ("--max-points 0: must be from 1", "--max-points", 0),
                ("--photograph-size 1: must be from 16", "--photograph-size", 1)):
            command = list(self.view())
            for name, value in zip(arguments[::2], arguments[1::2]):
                if name in command:
                    command[command.index(name) + 1] = value
                else:
                    command += [name, value]
            self.refuses_and_keeps(expected, *command)
        self.refuses_and_keeps("--report is missing", *self.view()[:-2])


class WithoutPage(ViewCase):
    def test_a_build_without_the_page_says_so(self):
        program = shutil.copy(os.path.join(BIN, "ViewScene"), self.path("ViewScene"))
        said = self.refuses("the viewer was not built", program, *self.view()[1:])
        self.assertIn("docs/view.md", said.stderr)


@unittest.skipUnless(os.path.exists(PAGE), "the page of ViewScene was not built")
@unittest.skipUnless(CHROMIUM, "Chromium is not installed")
class ViewPage(ViewCase):
    def check_photographs(self, browser, place, views):
        """The photographs of the picked point, and its refracted pixels, rounded to 0.1 px."""
        shown = browser.value("[...document.querySelectorAll('#point figcaption')]"
                              ".map(caption => caption.innerText)")
        self.assertEqual([re.match(r"\d+", text)[0] for text in shown],
                         [f"{view:04}" for view in views])
        marks = browser.value("[...document.querySelectorAll('#point .mark')]"
                              ".map(mark => [mark.style.left, mark.style.top])")
        self.assertEqual(len(marks), len(views))
        for view, text, mark in zip(views, shown, marks):
            expected = pixel(CENTRES[view], place)
            found = [float(value) for value in re.findall(r"-?\d+\.\d", text)]
            shares = [float(value.rstrip("%")) / 100 for value in mark]
            for k, side in enumerate((2 * CX, 2 * CY)):
                self.assertAlmostEqual(found[k], expected[k], delta=0.051)
                # CSS rounds to four digits; the cloud is rounded to 16 bits.
                self.assertAlmostEqual(shares[k] * side - 0.5, expected[k], delta=0.01)

    def test_points_are_picked_and_measured_with_the_mouse(self):
        page = self.opened("-m", self.mesh(), downloads=self.folder)
        before = page.value("axial.view.drawnShare()")
        self.assertGreater(before, 0)
        for _ in range(4):
            page.click_on("#larger")
        # 35 points of 7 x 7 instead of 2 x 2 pixels.
        self.assertGreater(page.value("axial.view.drawnShare()"), 4 * before)
        self.assertLess(page.value("Math.max(...axial.scene.cameras.map(c => c.check.length))"), 4)
        self.assertIn("agree with AxialMVS to", page.value("document.getElementById('projection')"
                                                           ".textContent"))
        (first, seen), (second, _), (third, _) = points()[0], points()[17], points()[34]
        page.click(*self.place_of(page, first))
        self.check_photographs(page, first, seen)

        page.click_on("[data-tab=measure]")
        for place in (first, second, third):
            page.click(*self.place_of(page, place))
        rows = page.value("[...document.querySelectorAll('#paths td')].map(cell => cell.innerText)")
        for text, pair in zip(rows, ((first, second), (second, third))):
            self.assertAlmostEqual(float(text.split()[0]), math.dist(*pair), delta=0.001)
        self.check_csv(page, (first, second, third))

        page.click_on("#canvas")
        page.press("Backspace", 8)
        self.assertIn("3 points", page.value("document.getElementById('paths').innerText"))
        self.check_mesh(page)
        self.check_volume(page)
        self.check_long_values(page)
        self.assertEqual(page.errors, [])

    def check_csv(self, page, places):
        page.click_on("#export")
        file = self.path("measurements.csv")
        page.wait_for("true")
        for _ in range(100):
            if os.path.exists(file) and read(file).endswith(b"\n"):
                break
            page.wait_for("new Promise(resolve => setTimeout(() => resolve(true), 50))")
        header, *rows = read(file).decode().splitlines()
        self.assertEqual(header, "path,point,x,y,z,segment,length,area,volume_above,volume_below,"
                         "surface,rugosity")
        self.assertEqual(len(rows), len(places))
        length = 0
        for number, (row, place) in enumerate(zip(rows, places)):
            values = row.split(",")
            self.assertEqual(values[:2], ["1", str(number + 1)])
            for value, expected in zip(values[2:5], place):
                self.assertAlmostEqual(float(value), expected, delta=1e-5)
            length += math.dist(place, places[number - 1]) if number else 0
            self.assertAlmostEqual(float(values[6]), length, delta=0.001)
        a, b = ([p - q for p, q in zip(place, places[0])] for place in places[1:])
        normal = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
        self.assertAlmostEqual(float(values[7]), math.hypot(*normal) / 2, delta=1e-5)

    def mesh(self):
        self.put("mesh.ply", *wall(z=1.1))
        self.succeeds(*self.command("TextureMesh", "-m", "mesh.ply", "--housing", self.port, "-o", "textured.mvs"))
        return self.path("work", "textured.ply")

    def check_mesh(self, page):
        """A click on the mesh alone picks a point of the mesh."""
        page.click_on("#show-points")
        page.click_on("#show-mesh")
        self.check_picked(page)

    def check_picked(self, page):
        self.assertGreater(page.value("axial.view.drawnShare()"), 0.1)
        page.click_on("[data-tab=point]")
        page.click(*self.place_of(page, (0.05, 0.03, 1.1)))
        self.near(page.value("axial.state.picked"), (0.05, 0.03, 1.1), 0.003)  # a pixel is about 2 mm wide

    def check_volume(self, page):
        """The mesh is the plane z = 1.1. The path is a triangle in the plane z = 1."""
        page.click_on("#show-points")
        page.click_on("[data-tab=measure]")
        page.click_on("#clear")
        corners = [points()[k][0] for k in (0, 15, 3)]
        self.assertEqual([z for _, _, z in corners], [1, 1, 1])
        for place in corners:
            page.click(*self.place_of(page, place))
        page.click_on(".volume")
        volumes = page.value("axial.paths.all[0].volumes")
        self.assertEqual(volumes["above"], 0)
        self.assertAlmostEqual(volumes["below"], 0.24 * 0.24 / 2 * 0.1, delta=0.00288 * 0.005)
        self.assertEqual(volumes["covered"], 1)
        self.assertAlmostEqual(volumes["surface"], 0.24 * 0.24 / 2, delta=1e-6)
        self.assertAlmostEqual(volumes["rugosity"], 1, delta=1e-5)
        self.assertIn("0.00288", page.value("axial.paths.csv()"))

    def check_long_values(self, page):
        """No value is cut off at the right edge of the panel, which has a fixed width at 1280 px."""
        page.value("axial.paths.all[0].volumes = {above: 123456.789012, below: 123456.789012, surface: 123456.7, "
                   "covered: 0.5, rugosity: 12.345}; axial.paths.show()")
        self.assertIn("of the covered part", page.value("document.getElementById('paths').innerText"))
        self.assertEqual(page.value("document.getElementById('measure').scrollWidth"),
                         page.value("document.getElementById('measure').clientWidth"))

    def test_links_lead_to_a_view(self):
        page = self.opened()
        page.click_on("#canvas")
        page.press("ArrowLeft", 37)
        page.click_on("#show-cameras")
        page.click_on("[data-tab=measure]")
        eye = page.value("axial.view.camera.position.toArray()")
        page.click_on("#link")
        link = page.value("location.hash")
        page.value("axial.ready = false; location.reload()")
        page.wait_for("globalThis.axial && axial.ready")
        self.near(page.value("axial.view.camera.position.toArray()"), eye, 1e-6)
        self.assertFalse(page.value("axial.view.cameras.group.visible"))
        self.assertEqual(page.value("axial.state.tab"), "measure")
        message = "document.getElementById('link-message').textContent"
        self.assertEqual(page.value(message), "")
        for wrong, why in (("tab=measure", "tab=map is not in this page"), ("up=", "up=x is not 3 numbers"),
                           ("show=", "show=x is not in this page")):
            changed = {"tab=measure": "tab=map", "up=": "up=x&old=", "show=": "show=x&old="}[wrong]
            page.value(f"location.hash = {link.replace(wrong, changed)!r}")
            page.wait_for(f"{message}.includes({why!r})")
        self.near(page.value("axial.view.camera.position.toArray()"), eye, 1e-6)
        page.value(f"location.hash = {link.replace(',', '%2C')!r}")  # as mail programs write it
        page.wait_for(f"{message} === ''")
        self.assertEqual(page.errors, [])

    def test_without_a_cloud_the_mesh_is_shown_alone(self):
        self.put("mesh.ply", *wall(z=1.1))
        alone = self.command("ViewScene", "--report", self.report)
        self.refuses("scene.ply", *alone)  # nothing to show
        self.refuses("--truth", *alone, "-m", "mesh.ply", "--truth", "mesh.ply")
        self.succeeds(*alone, "-m", "mesh.ply")
        page = self.reopened("globalThis.axial && axial.ready")
        self.addCleanup(page.close)
        self.assertEqual(page.value("document.getElementById('status').textContent"), "288 faces")
        self.check_picked(page)
        self.assertEqual(page.errors, [])

    def test_a_narrow_page_works_with_touch_and_keyboard(self):
        page = self.opened(width=390, height=844, touch=True)
        self.assertLessEqual(page.value("document.documentElement.scrollWidth"), 390)
        place, seen = points()[17]
        page.tap(*self.place_of(page, place))
        self.check_photographs(page, place, seen)
        before = self.place_of(page, place)
        page.press("ArrowLeft", 37)
        self.assertNotEqual(self.place_of(page, place), before)
        page.press("R", 82, "R")
        self.assertEqual(self.place_of(page, place), before)
        page.press("4", 52, "4")
        self.assertIn("35 of 35", page.value("document.getElementById('about').innerText"))
        self.assertEqual(page.errors, [])


if __name__ == "__main__":
    main()
