# SPDX-License-Identifier: GPL-3.0-or-later
"""ViewScene with maps, changes, depth maps and a run, at UTM coordinates: the folder, and its page in
Chromium."""

import base64
import json
import os
import re
import shutil
import unittest

from browser import CHROMIUM
from programs import contents, files_below, main, read, write
from readers import png_rows
from tiny_scene import DENSIFY
from view_scene_test import PAGE, ViewCase, points
from worlds import cloud, geo_offset, ply, turned, wall

EAST, NORTH, UP = 500000, 4500000, 30
BLOCK = 0.05  # half of the side of the block that came, in the middle of the wall [m]
PIXEL = 0.0125
SURVEY = ("--map", "map", "--change", "survey", "--run", "run.json")
CAME, UNCHANGED = (66, 130, 190), (110, 116, 124)
RUN = {"command": ["reconstruct", "--images=my photographs"], "steps": [
    {"name": "poses", "command": ["colmap", "mapper"], "seconds": 3.25, "version": None, "warnings": []},
    {"name": "densify", "command": ["DensifyPointCloud", "-i", "a scene.mvs"], "seconds": 3724,
     "version": "DensifyPointCloud 1.2.3", "warnings": [
         {"text": "image 7 has <no> neighbours", "times": 1}, {"text": "low contrast", "times": 4}]}],
    "control": [{"name": "bar target 1-target 2", "use": "check", "photographs": 5, "residual_mm": [-0.125],
                 "expected_sigma_mm": [0.25]},
                {"name": "target 7", "use": "used", "photographs": 3, "residual_mm": [1.5, -2.25, None],
                 "expected_sigma_mm": [3, 3, None]}]}


def height(x):
    """The surface of the survey, in the frame of the scene."""
    return 1 + 0.2 * x


UTM = f"comment geo_offset {EAST} {NORTH} {UP}\n"  # of a PLY with coordinates in the frame of the scene


def pixels(png):
    """The pixels (R, G, B) of a PNG, row by row."""
    rows, channels = png_rows(png)
    return [tuple(row[i:i + 3]) for row in rows for i in range(0, len(row), channels)]


@unittest.skipUnless(os.path.exists(PAGE), "the page of ViewScene was not built")
class SurveyCase(ViewCase):
    @classmethod
    def setUpClass(cls):
        """Maps, changes and depth maps, made once: work/{map,survey}.* and work/depth*.dmap. The
        cameras look along z, which is up: so MapSurface maps the lower side of the wall, and says so.
        CompareSurveys takes meshes whose faces are turned up."""
        made = cls("setUp")
        made.setUp()
        cls.addClassCleanup(made.doCleanups)
        vertices, faces = wall(cells=24)
        tilted = [(x, y, height(x)) for x, y, _ in vertices]
        raised = [(x, y, z + 0.03 * (max(abs(x), abs(y)) < BLOCK - 0.01)) for x, y, z in tilted]
        for name, corners in (("before", tilted), ("after", raised)):
            write(made.path("work", name + ".ply"), ply(corners, turned(faces), comments=UTM))
        write(made.path("work", "seen.ply"), ply(tilted, faces, comments=UTM))
        made.succeeds(*DENSIFY, "-i", made.scene, "-w", made.work)
        made.place_in_utm()
        made.succeeds("MapSurface", "-i", made.scene, "-w", made.work, "-m", "seen.ply", "-o", "map",
                      "--gsd", PIXEL, "--housing", made.port)
        made.succeeds("CompareSurveys", "-i", "before.ply", "-w", made.work, "--other", "after.ply", "-o",
                      "survey", "--gsd", PIXEL, "--sigma-before", 0.001, "--sigma-after", 0.001)
        cls.made = made

    def place_in_utm(self):
        write(self.path("work", "scene.geo.json"), geo_offset(EAST, NORTH, UP))
        write(self.cloud, cloud(points(), comments=UTM))

    def setUp(self):
        super().setUp()
        if not hasattr(type(self), "made"):
            return
        self.place_in_utm()
        for name in os.listdir(self.made.work):
            if re.match(r"map\.|survey\.|depth", name):
                shutil.copy(os.path.join(self.made.work, name), self.work)
        write(self.path("work", "run.json"), json.dumps(RUN))

    def put_colors(self, **changes):
        """Restored photographs, and what RestoreColors found. Returns this."""
        self.put_restored()
        number = {"value": 0.25, "sigma": 0.0125}
        channel = {"a_per_m": number, "b_per_m": number, "veil": number, "determined": True}
        found = {"light": "sun", "white": "grey seabed", "spread_before": 0.125, "spread_after": 0.0625,
                 "channels": {"red": {"determined": False}, "green": channel,
                              "blue": {**channel, "determined": False, "assumed": True, "daylight_per_m": number}},
                 "water_type": "jerlov-IB",
                 "brightness_by_way": [{"way_m": way, "before": [1 / way, 1, 2 / way], "after": [1, 1, 1]}
                                       for way in (1, 2, 3)], **changes}
        write(self.path("work", "restored", "colors.json"), json.dumps(found))
        return found

    def survey(self, *more):
        return self.view(*SURVEY, *more)


class Folder(SurveyCase):
    def test_it_holds_the_pictures(self):
        self.succeeds(*self.survey())
        names = files_below(self.report)
        layers = ["ortho.jpg", "height.jpg", "views.jpg", "difference.jpg", "significant.png",
                  "difference-sigma.jpg", "sigma.jpg"]
        self.assertEqual({name for name in names if name.startswith("maps/")},
                         {"maps/" + name for name in layers})
        self.assertEqual({name for name in names if name.startswith("depth/")},
                         {f"depth/{i:05}.{kind}.jpg" for i in range(3) for kind in ("depth", "normal", "confidence")})
        for entry in self.shown()["depth_maps"]:
            # The wall is 1 m away. The line of sight to the corner of a photograph is 1.2 m long.
            self.assertAlmostEqual(entry["depth"]["low"], 1, delta=0.03)
            self.assertAlmostEqual(entry["depth"]["high"], 1.15, delta=0.05)

    def test_it_is_the_same_for_any_number_of_threads(self):
        self.succeeds(*self.survey("--max-threads", 1))
        one = contents(self.report)
        self.succeeds(*self.survey("--max-threads", 4))
        self.assertEqual(contents(self.report), one)

    def test_pictures_are_reduced(self):
        self.succeeds(*self.survey("--map-size", 20, "--depth-map-size", 32))
        scene = self.shown()
        for layer in scene["map"]["layers"]:
            self.assertEqual(max(layer["size"]), 20)
            self.assertAlmostEqual(layer["place"][2], 0.6, 6)
        self.succeeds(*self.view("--depth-map-size", 0))
        self.assertFalse({"map", "run", "depth_maps"} & set(self.shown()))
        self.assertFalse([name for name in files_below(self.report) if name.startswith(("maps/", "depth/"))])

    def test_errors_of_heights_are_shown_if_there_are_some(self):
        shown = lambda: [layer["id"] for layer in self.shown()["map"]["layers"]]
        self.succeeds(*self.view("--map", "map"))
        self.assertIn("sigma", shown())
        os.remove(self.path("work", "map.sigma.tif"))
        self.succeeds(*self.view("--map", "map"))
        self.assertNotIn("sigma", shown())

    def test_a_mesh_that_is_inside_out_is_told(self):
        seen, other = (self.made.path("work", name) for name in ("seen.ply", "before.ply"))
        self.assertNotIn("inside out", self.succeeds(*self.view("-m", seen)).stdout)
        self.assertIn(f"warning: {other}: the mesh is inside out", self.succeeds(*self.view("-m", other)).stdout)

    def test_orthomosaics_of_other_colours_and_of_the_earlier_survey_are_layers(self):
        for name in ("raw", "old"):
            shutil.copy(self.path("work", "map.ortho.tif"), self.path("work", f"{name}.ortho.tif"))
        self.succeeds(*self.survey("--raw-map", "raw", "--earlier-map", "old"))
        titles = {layer["id"]: layer["title"] for layer in self.shown()["map"]["layers"]}
        self.assertEqual([titles[name] for name in ("raw-ortho", "earlier-ortho")],
                         ["Orthomosaic with water", "Orthomosaic of the earlier survey"])
        self.refuses_and_keeps("none.ortho.tif", *self.survey("--earlier-map", "none"))

    def test_maps_and_changes_can_have_the_same_prefix(self):
        for name in os.listdir(self.work):
            if name.startswith("survey.change"):
                shutil.copy(self.path("work", name), self.path("work", name.replace("survey", "map")))
        self.succeeds(*self.view("--map", "map", "--change", "map"))
        self.assertEqual(len(self.shown()["map"]["layers"]), 7)

    def test_damaged_depth_maps_are_left_out_unless_they_are_asked_for(self):
        path = self.path("work", "depth0001.dmap")
        write(path, read(path)[:-100])
        said = self.succeeds(*self.view()).stdout
        self.assertRegex(said, r"(?m)^\d\d:\d\d:\d\d \[ViewScene\] warning: a depth map is left out: .*0001\.dmap")
        self.assertEqual([entry is None for entry in self.shown()["depth_maps"]], [False, True, False])
        self.refuses_and_keeps("depth0001.dmap", *self.view("--depth-maps", "."))
        shutil.copy(self.path("work", "depth0002.dmap"), path)
        shutil.copy(self.path("work", "depth0002.dmap.json"), path + ".json")
        self.refuses_and_keeps("depth0001.dmap: is the depth map of 0002.png, but image 1 of the scene is "
                               "0001.png", *self.view("--depth-maps", "."))
        os.mkdir(self.path("work", "empty"))
        self.refuses_and_keeps("has no depth map of the scene's photographs, such as depth0000.dmap",
                               *self.view("--depth-maps", "empty"))

    def test_restored_colours_are_shown_beside_the_photographs(self):
        self.put_colors()
        self.succeeds(*self.view("--colors", "restored"))
        colors = self.shown()["colors"]
        self.assertEqual([picture["name"] for picture in colors["pictures"]], ["0000.png", "0001.png", "0002.png"])
        names = files_below(self.report)
        for picture in colors["pictures"]:
            self.assertLess({picture["before"], picture["after"]}, names)
        self.assertEqual([len(channel["values"]) for channel in colors["channels"]], [0, 3, 4])
        self.assertEqual([row["way_m"] for row in colors["by_way"]], [1, 2, 3])
        os.remove(self.path("work", "restored", "colors.json"))
        self.assertIn("warning: ", self.succeeds(*self.view("--colors", "restored")).stdout)
        self.assertEqual(list(self.shown()["colors"]), ["pictures"])
        self.succeeds(*self.view())
        self.assertNotIn("colors", self.shown())

    def test_a_malformed_file_of_restored_colours_is_refused(self):
        found = self.put_colors()
        lamp = {**found, "light": "lamp"}
        row = found["brightness_by_way"][0]
        wrong = [("light is 7, expected a text", {**found, "light": 7}),
                 ('light is "moon", expected sun or lamp', {**found, "light": "moon"}),
                 ("spread_after is missing", {k: v for k, v in found.items() if k != "spread_after"}),
                 ("channels.green.loss_per_m is missing", lamp),
                 ('charts[0].ciede2000 is "3", expected a number',
                  {**found, "charts": [{"photograph": "a.jpg", "ciede2000": "3"}]}),
                 ("brightness_by_way[0].after is [1], expected 3 numbers",
                  {**found, "brightness_by_way": [{**row, "after": [1]}]})]
        self.refuses_contents(self.path("work", "restored", "colors.json"), self.view("--colors", "restored"),
                              ("colors.json: ", "{"),
                              *(("colors.json: " + expected, json.dumps(file)) for expected, file in wrong))

    def test_wrong_files_are_refused(self):
        change = json.loads(self.at("survey.change.json"))
        region = {**change["regions"][0], "x": "a"}
        step = {**RUN["steps"][0], "seconds": -1}
        for name, *cases in (
                ("map.dem.tif", (": has 4 bands of Byte, but a map of heights has 1 band of Float32",
                                 self.at("map.ortho.tif"))),
                ("survey.change.json", (": ", "{"),
                 (": came.volume is missing", json.dumps({**change, "came": {}})),
                 (': regions[0].x is "a", expected a number', json.dumps({**change, "regions": [region]}))),
                ("run.json", (": malformed JSON: more than 1000 ", "[" * 10**6 + "]" * 10**6),
                 *((": " + expected, json.dumps(run)) for expected, run in (
                     ("is [], expected an object", []), ("steps is missing", {"command": []}),
                     ("steps is 7, expected a list", {**RUN, "steps": 7}),
                     ("steps[0].seconds is -1, expected a number of at least 0", {**RUN, "steps": [step]}),
                     ("command[0] is 3, expected a text", {**RUN, "command": [3]}),
                     ("control[0].use is missing", {**RUN, "control": [{"name": "a"}]}))))):
            self.refuses_contents(self.path("work", name), self.survey(),
                                  *((name + expected, content) for expected, content in cases))
        self.refuses_and_keeps("none.dem.tif: ", *self.view("--map", "none"))
        self.refuses_and_keeps("none.change.json: ", *self.view("--change", "none"))
        self.refuses_and_keeps("none.json: ", *self.view("--run", "none.json"))
        self.refuses_and_keeps("--map-size 1: must be from 16", *self.view("--map-size", 1))

    def test_no_folder_of_the_user_is_in_the_page(self):
        home = "/home/somebody/dive 3"
        run = {"command": ["reconstruct", f"--images={home}/photographs", "--scale-sigma=1/2",
                           f"--scale-from=positions:{home}/a.csv"],
               "steps": [{**RUN["steps"][0], "command": ["/usr/local/bin/colmap", "-i", f"{home}/out/scene.mvs"],
                          "warnings": [{"text": "/home/somebody/out/a.jpg: is dark, like '/home/somebody/b.jpg'",
                                        "times": 1}]}]}
        write(self.path("work", "run.json"), json.dumps(run))
        self.succeeds(*self.survey())
        page = contents(self.report)
        self.assertEqual([name for name, data in page.items() if b"somebody" in data], [])
        shown = b"".join(page[name] for name in page if name.startswith("data"))
        for text in (b"--images=photographs", b"--scale-sigma=1/2", b"--scale-from=positions:a.csv",
                     b'"colmap"', b'"scene.mvs"', b"a.jpg: is dark, like 'b.jpg'"):
            self.assertIn(text, shown)

    def test_maps_of_other_planes_are_refused(self):
        self.succeeds("CompareSurveys", "-i", self.made.path("work", "before.ply"), "-w", self.work, "--other",
                      self.made.path("work", "after.ply"), "-o", "survey", "--up", "0,0.2,1", "--gsd", PIXEL)
        said = self.refuses("survey.change.difference.tif: has other axes than", *self.survey())
        self.assertIn("map.dem.tif; give MapSurface and CompareSurveys the same --up", said.stderr)


@unittest.skipUnless(CHROMIUM, "Chromium is not installed")
class Page(SurveyCase):
    def opened(self, **window):
        browser = super().opened(*SURVEY, **window)
        browser.click_on("[data-tab=map]")
        browser.wait_for("axial.map.image && !axial.map.asked")
        return browser

    def choose(self, page, layer):
        page.value(f"document.querySelector('[data-layer={layer}]').click()")
        page.wait_for("axial.map.image && !axial.map.asked")

    def screen(self, x, y, width=900, height_=800):
        """Where the page, after its start, shows a place in the frame of the scene: the map of 0.6 m
        fills 94 % of the shorter side."""
        scale = 0.94 * min(width, height_) / 0.6
        return width / 2 + x * scale, height_ / 2 - y * scale

    def colors(self, page, x, y, side=16):
        """The colours of the page around (x, y)."""
        clip = {"x": x - side / 2, "y": y - side / 2, "width": side, "height": side, "scale": 1}
        return pixels(base64.b64decode(page.send("Page.captureScreenshot", clip=clip)["data"]))

    def test_the_map_shows_its_layers_and_coordinates(self):
        page = self.opened(downloads=self.folder)
        self.check_layers(page)
        self.check_slider(page)
        self.check_link(page)
        self.check_points(page)
        self.check_early_points(page)
        self.check_changes(page)
        self.check_depth(page)
        self.check_run(page)
        self.assertEqual(page.errors, [])

    def check_layers(self, page):
        focused = lambda name: page.value(f"document.getElementById('{name}').focus(), document.activeElement.id")
        self.assertEqual(focused("map-canvas"), "map-canvas")
        for covered in ("canvas", "show-points"):
            self.assertNotEqual(focused(covered), covered)
        seen = {}
        for layer in ("ortho", "height", "views", "difference"):
            self.choose(page, layer)
            seen[layer] = self.colors(page, *self.screen(-0.1, 0.05), side=60)
        self.assertEqual(len(set(map(tuple, seen.values()))), 4)
        self.assertGreater(len(set(seen["ortho"])), 9)  # of about 16 pixels of the map
        self.choose(page, "height")
        legend = page.value("document.querySelector('#map .legend').innerText")
        low, high = map(float, re.findall(r"-?\d+\.\d+", legend))
        self.assertAlmostEqual(low, UP + height(-0.3), delta=0.01)
        self.assertAlmostEqual(high, UP + height(0.3), delta=0.01)
        # The block lies where the coordinates say, and nothing beside it changed.
        self.choose(page, "significant")
        self.assertEqual(set(self.colors(page, *self.screen(0, 0))), {CAME})
        for x, y in ((0.15, 0.15), (-0.15, 0.15), (0.15, -0.15), (-0.15, -0.15)):
            self.assertEqual(set(self.colors(page, *self.screen(x, y))), {UNCHANGED})

    def check_slider(self, page):
        """On the right of the line is the second layer; the layers themselves are the oracle."""
        left, right = self.screen(-0.2, 0.05), self.screen(0.2, 0.05)
        seen = {}
        for layer in ("views", "height"):
            self.choose(page, layer)
            seen[layer] = [self.colors(page, *place) for place in (left, right)]
        page.value("(choice => { choice.value = 'views'; choice.onchange(); })(document.getElementById('map-compare'))")
        for cut, expected in ((50, ("height", "views")), (0, ("views", "views")), (100, ("height", "height"))):
            page.value("(slider => { slider.value = %d; slider.oninput(); })(document.getElementById('map-slider'))"
                       % cut)
            page.wait_for("!axial.map.asked")
            self.assertEqual([self.colors(page, *place) for place in (left, right)],
                             [seen[layer][k] for k, layer in enumerate(expected)], cut)
        page.value("(choice => { choice.value = ''; choice.onchange(); })(document.getElementById('map-compare'))")
        self.assertTrue(page.value("document.getElementById('map-slider').hidden"))
        self.choose(page, "significant")

    def check_link(self, page):
        """A link leads to the layer and the part of the map."""
        shown = "[axial.state.tab, axial.map.layer.id, ...axial.map.centre, axial.map.scale]"
        page.value("axial.map.zoom(2, 100, 100)")
        page.click_on("#link")
        linked, link = page.value(shown), page.value("location.hash")
        page.value("history.replaceState(null, '', '#')")
        self.choose(page, "ortho")
        page.value("axial.map.fit()")
        page.value(f"location.hash = {link!r}")
        page.wait_for("axial.map.layer.id === 'significant' && !axial.map.asked")
        self.assertEqual(page.value(shown)[:2], linked[:2])
        # The address has twelve significant digits.
        self.near(page.value(shown)[2:4], linked[2:4], 1e-4)
        self.assertAlmostEqual(page.value(shown)[4] / linked[4], 1, delta=1e-8)
        page.value("axial.map.fit()")
        page.value(f"location.hash = {link.replace('layer=significant', 'layer=none')!r}")
        page.wait_for("!document.getElementById('link-message').hidden")
        self.assertIn("layer=none is not in this page",
                      page.value("document.getElementById('link-message').textContent"))
        page.value("document.getElementById('link-message').hidden = true")

    def check_profile(self, page):
        """Along the path, the heights are those of the tilted plane, for which interpolation is exact."""
        self.assertGreater(page.value("document.querySelector('#profile polyline').points.length"), 20)
        page.value("document.getElementById('profile-save').click()")
        file = self.path("profile.csv")
        for _ in range(100):
            if os.path.exists(file) and read(file).endswith(b"\n"):
                break
            page.wait_for("new Promise(resolve => setTimeout(() => resolve(true), 50))")
        header, *rows = read(file).decode().splitlines()
        self.assertEqual(header, "along,x,y,height")
        rows = [tuple(map(float, row.split(","))) for row in rows]
        for along, x, y, found in rows:
            self.assertAlmostEqual(found, UP + height(x - EAST), delta=0.001)
        self.assertAlmostEqual(rows[-1][0], (0.4 ** 2 + 0.25 ** 2) ** 0.5, delta=0.002)

    def check_points(self, page):
        places = [(-0.2, 0.1), (0.2, -0.15)]
        for x, y in places:
            page.click(*self.screen(x, y))
        shown = page.value("[...document.querySelectorAll('#map .grid td')].map(cell => cell.innerText)")
        for number, (x, y) in enumerate(places):
            text = shown[4 * number:4 * number + 4]
            self.assertEqual(text[0], str(number + 1))
            self.assertTrue(all(re.fullmatch(r"\d+\.\d{3}", value) for value in text[1:]), text)
            for value, expected in zip(map(float, text[1:]), (EAST + x, NORTH + y, UP + height(x))):
                self.assertAlmostEqual(value, expected, delta=0.001)  # a pixel is 0.8 mm
        self.assertAlmostEqual(float(shown[9].split()[0]), (0.4 ** 2 + 0.25 ** 2) ** 0.5, delta=0.002)
        self.assertAlmostEqual(float(shown[10].split()[0]), 0.08, delta=0.002)
        self.check_profile(page)
        page.value("document.getElementById('map-show').click()")
        x, y = places[1]
        for value, expected in zip(page.value("axial.state.picked.map((v, k) => v + axial.scene.origin[k] - "
                                              f"[{EAST}, {NORTH}, {UP}][k])"), (x, y, height(x))):
            self.assertAlmostEqual(value, expected, delta=0.001)
        self.assertEqual(page.value("axial.state.tab"), "point")
        page.click_on("[data-tab=map]")
        page.click_on("#map-canvas")
        page.press("Backspace", 8)
        self.assertEqual(page.value("axial.map.path.length"), 2)
        before = page.value("axial.map.placeOf(0, 0)")
        page.press("ArrowLeft", 37)
        self.assertNotEqual(page.value("axial.map.placeOf(0, 0)"), before)
        page.press("R", 82, "R")
        self.assertAlmostEqual(page.value("axial.map.centre[0]"), EAST, 6)
        self.assertFalse(page.value("axial.map.canvas.dispatchEvent(new MouseEvent('contextmenu', "
                                    "{ cancelable: true }))"))

    def check_early_points(self, page):
        """A point that is added before the heights are loaded gets its height with them."""
        page.value("axial.map.heights = new axial.map.heights.constructor(null, null)")
        page.value(f"axial.map.picked([{EAST}, {NORTH}])")
        row = "[...document.querySelectorAll('#map .grid tr')].find(row => row.innerText[0] == '3').innerText"
        self.assertIn("none", page.value(row))
        page.value("axial.map.load()")
        self.assertIn(f"{UP + height(0):.3f}", page.value(row))

    def check_changes(self, page):
        text = page.value("document.getElementById('map').innerText")
        report = json.loads(read(self.path("work", "survey.change.json")))
        self.assertEqual(len(report["regions"]), 1)
        self.assertIn(f"{1e6 * report['came']['volume']:.1f} ± {1e6 * report['came']['volume_sigma']:.1f} cm³", text)
        page.value("document.querySelector('[data-region=\"0\"]').click()")
        centre = page.value("axial.map.placeOf(450, 400)")
        self.assertAlmostEqual(centre[0], EAST, delta=0.005)
        self.assertAlmostEqual(centre[1], NORTH, delta=0.005)

    def check_depth(self, page):
        page.click_on("[data-tab=photographs]")
        page.value("document.querySelectorAll('#photographs .list button')[1].click()")
        for kind in ("depth", "normal", "confidence", "photograph"):
            page.click_on(f"[data-depth={kind}]")
            self.assertTrue(page.value("document.querySelector('#photographs img').decode().then(() => true)"))
            source = page.value("document.querySelector('#photographs img').src")
            self.assertRegex(source, "photographs/00001.jpg$" if kind == "photograph" else f"depth/00001.{kind}.jpg$")
            legend = page.value("document.querySelector('#photographs .legend').innerText")
            self.assertEqual(len(re.findall(r"[01]\.\d{3} m", legend)), 2 if kind == "depth" else 0)

    def check_run(self, page):
        page.click_on("[data-tab=run]")
        text = page.value("document.getElementById('run').textContent")
        for part in ("2 steps in 1 h 2 min", "2 warnings", "poses", "3.3 s", "densify",
                     "DensifyPointCloud -i 'a scene.mvs'", "DensifyPointCloud 1.2.3", "Version not known",
                     "bar target 1-target 2", "target 7", "1.50, -2.25, –", "image 7 has <no> neighbours",
                     "low contrast (4 times)", "'--images=my photographs'"):
            self.assertIn(part, text)

    def test_the_tab_of_colours_shows_charts(self):
        self.put_colors(white="charts", charts=[{"photograph": "00001.jpg", "ciede2000": 3.25}])
        page = SurveyCase.opened(self, "--colors", "restored")
        page.click_on("[data-tab=restored]")
        self.assertIn("Chart in 00001.jpg\tCIEDE2000 3.3", page.value("document.getElementById('restored').innerText"))

    def test_the_tab_of_colours_compares_photographs(self):
        self.put_colors()
        page = SurveyCase.opened(self, "--colors", "restored")
        page.click_on("[data-tab=restored]")
        text = page.value("document.getElementById('restored').innerText")
        for part in ("daylight", "grey seabed", "12.5 %", "6.3 %", "red\tnot determined", "jerlov-IB",
                     "green, loss a\t0.250 ± 0.013 /m", "blue, loss of daylight by depth, assumed"):
            self.assertIn(part, text)
        self.assertEqual(page.value("document.querySelectorAll('#by-way polyline').length"), 6)
        self.assertEqual(page.value("document.querySelectorAll('#restored figure').length"), 3)
        loaded = "[...document.querySelectorAll('#restored img')].every(image => image.naturalWidth === 96)"
        page.wait_for(loaded)
        page.value("(slider => { slider.value = 20; slider.dispatchEvent(new Event('input')); })"
                   "(document.querySelector('#restored input'))")
        self.assertIn("80%", page.value("document.querySelector('#restored .over').style.clipPath"))
        self.assertEqual(page.errors, [])

    def test_a_narrow_page_works_with_touch(self):
        page = self.opened(width=390, height=844, touch=True)
        width, height_ = page.value("axial.map.size")
        page.tap(*self.screen(0.1, 0.1, width, height_))
        (x, y), z = page.value("[axial.map.path[0].place, axial.map.path[0].height]")
        for value, expected in zip((x, y, z), (EAST + 0.1, NORTH + 0.1, UP + height(0.1))):
            self.assertAlmostEqual(value, expected, delta=0.001)  # half a pixel
        self.assertGreater(len(set(self.colors(page, *self.screen(-0.1, 0, width, height_), 40))), 9)
        for tab in ("map", "run", "photographs"):
            page.click_on(f"[data-tab={tab}]")
            self.assertLessEqual(page.value("document.documentElement.scrollWidth"), 390)
        self.assertEqual(page.errors, [])


if __name__ == "__main__":
    main()
