# SPDX-License-Identifier: GPL-3.0-or-later
"""CompareSurveys on two meshes of a small plot: names of files, maps, numbers, coordinates, wrong
input."""

import json
import math
import os
import random

from boundary_test import is_inside, places
from geotiff import read_geotiff
from measure_surface_test import polygons
from programs import ProgramTest, contents, files_below, main, png, read, write
from tiny_scene import mvs
from worlds import Wall, grid, ply, turned

OUTPUTS = {f"work/reef.change.{end}" for end in ("difference.tif", "significant.tif", "sigma.tif", "json", "jpg")}
CELLS, SPACING = (80, 60), 0.02
OFFSET = "comment geo_offset 500000 4500000 30\n"


def block(x, y, left, low):
    """A block of 0.2 m x 0.2 m and a height of 0.1 m."""
    return 0.1 if left < x < left + 0.2 and low < y < low + 0.2 else 0


def ground(x, y):
    return 0.05 * math.sin(9 * x) + 0.04 * math.cos(8 * y + 3 * x)


def volume_of_block(left, low):
    """The volume of the block in the mesh: each vertex stands for one cell."""
    columns, rows = CELLS
    return SPACING ** 2 * sum(block(i * SPACING, j * SPACING, left, low)
                              for i in range(columns + 1) for j in range(rows + 1))


def before(x, y):
    return ground(x, y) + block(x, y, 0.3, 0.3)


def after(x, y):
    return ground(x, y) + block(x, y, 1.1, 0.7)


def survey(height, seed, shift=(0, 0, 0)):
    """The vertices and faces of a mesh with a noise of 1 mm."""
    noise = random.Random(seed)

    def place(i, j):
        x, y = i * SPACING, j * SPACING
        return x + shift[0], y + shift[1], height(x, y) + noise.gauss(0, 0.001) + shift[2]

    vertices, faces = grid(*CELLS, place)
    return vertices, turned(faces)


def obj(vertices, faces):
    """With a texture, as the reader wants one."""
    return "".join(["mtllib grey.mtl\nvt 0 0\nusemtl grey\n"] +
                   [f"v {x} {y} {z}\n" for x, y, z in vertices] +
                   [f"f {a + 1}/1 {b + 1}/1 {c + 1}/1\n" for a, b, c in faces])


class CompareTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.before, self.after = self.path("work", "a.ply"), self.path("work", "b.ply")
        write(self.before, ply(*survey(before, 1)))
        write(self.after, ply(*survey(after, 2, (0.013, -0.008, 0.02))))

    def compare(self, *arguments):
        return ("CompareSurveys", "-w", self.path("work"), "-i", self.before, "--other", self.after,
                *(() if "-o" in arguments else ("-o", "reef")), *arguments)

    def report(self):
        return json.loads(read(self.path("work", "reef.change.json")))

    def map(self, name):
        return read_geotiff(read(self.path("work", f"reef.change.{name}.tif")))

    def above(self, name, height, low, high, y=0.6):
        """A scene of three cameras above the plot."""
        path = self.path("work", name)
        write(path, mvs(["a.png", "b.png", "c.png"], rotation=(1, 0, 0, 0, -1, 0, 0, 0, -1),
                        centres=[(x, y, height) for x in (low, (low + high) / 2, high)], points=[]))
        return path

    def check_volumes(self, report):
        for change, volume in (("came", volume_of_block(1.1, 0.7)), ("gone", volume_of_block(0.3, 0.3))):
            self.assertAlmostEqual(report[change]["volume"], volume, delta=0.05 * volume)


class Outputs(CompareTest):
    def test_names(self):
        old = files_below(self.folder)
        self.succeeds(*self.compare())
        self.assertEqual(files_below(self.folder) - old, OUTPUTS)
        self.succeeds("CompareSurveys", self.before, "--other", self.after)
        self.assertIn("work/a.change.json", files_below(self.folder))

    def test_a_moved_block(self):
        self.succeeds(*self.compare("--align", "icp", "--up", "0,0,1"))
        report = self.report()
        self.check_volumes(report)
        self.assertEqual([report[change]["regions"] for change in ("came", "gone")], [1, 1])
        centre = report["registration"]["centre"]
        self.assertEqual(report["registration"]["determined_directions"], 6)
        rows = report["registration"]["matrix"]
        moved = [sum(m * c for m, c in zip(row, (*centre, 1))) for row in rows]
        for k, shift in enumerate((0.013, -0.008, 0.02)):
            self.assertAlmostEqual(moved[k] - centre[k], -shift, delta=0.001)
        difference, classes, sigma = (self.map(name) for name in ("difference", "significant", "sigma"))
        self.assertEqual((difference.nodata, classes.nodata, sigma.nodata), ("-9999", "255", "-9999"))
        at = lambda found, x, y: found.rows[int((found.top - y) / found.pixel)][
            int((x - found.left) / found.pixel)]
        self.assertEqual([at(classes, *place) for place in ((1.2, 0.8), (0.4, 0.4), (0.8, 0.6))],
                         [2, 1, 0])
        self.assertAlmostEqual(at(difference, 1.2, 0.8), 0.1, delta=0.006)
        self.assertAlmostEqual(at(difference, 0.4, 0.4), -0.1, delta=0.006)
        for d, c, s in zip(difference.rows, classes.rows, sigma.rows):
            for value, kind, deviation in zip(d, c, s):
                self.assertEqual(value == -9999, kind == 255)
                self.assertEqual(value == -9999, deviation == -9999)

    def test_known_positions(self):
        write(self.after, ply(*survey(after, 2, (0, 0, 0.02))))
        self.succeeds(*self.compare())
        report = self.report()
        self.assertIsNone(report["registration"])
        # All of the ground rose by 2 cm.
        self.assertGreater(report["came"]["area"], 0.9 * report["area_compared"])

    def test_changes_of_most_of_the_map_are_told(self):
        told = lambda *arguments: self.succeeds(*self.compare("--up", "0,0,1", *arguments)).stdout
        write(self.after, ply(*survey(after, 2)))
        self.assertNotIn("more than half", told())
        write(self.after, ply(*survey(lambda x, y: before(x, y) + 0.1 * math.sin(4 * x + y), 2)))
        self.assertIn("changes count as noise", told())
        self.assertIn("more than half of the map changed", told("--sigma-before", "0.001",
                                                                "--sigma-after", "0.001"))

    def test_places_that_too_few_photographs_see_are_not_compared(self):
        # Three cameras at a height of 1.2 m see x up to 1.1 m, with the place of the block that
        # went, and without that of the block that came.
        scene = self.above("scene.mvs", 1.2, 0.35, 0.45, y=0.4)
        write(self.after, ply(*survey(after, 2)))
        for option in ("--scene", "--other-scene"):
            self.succeeds(*self.compare("--up", "0,0,1", option, scene))
            report, classes = self.report(), self.map("significant")
            volume = volume_of_block(0.3, 0.3)
            self.assertAlmostEqual(report["gone"]["volume"], volume, delta=0.05 * volume)
            self.assertEqual(report["came"]["regions"], 0)
            seen = sum(kind != 255 for row in classes.rows for kind in row) * classes.pixel ** 2
            self.assertAlmostEqual(report["area_compared"], seen, 6)
            self.assertLess(seen, 0.8 * 1.6 * 1.2)
        self.refuses_and_keeps("--min-views 4: no place of both surveys is seen", *self.compare(
            "--up", "0,0,1", "--scene", scene, "--min-views", "4"))

    def test_little_common_ground_is_told(self):
        # All three cameras see a strip of 0.4 m, of a ground of 1.6 m.
        scene = self.above("scene.mvs", 1.2, 0.3, 1.3)
        write(self.after, ply(*survey(after, 2)))
        for views, warns in (("1", False), ("3", True)):
            said = self.succeeds(*self.compare("--up", "0,0,1", "--scene", scene, "--min-views", views))
            self.assertEqual("--min-views: less than half of the common ground was compared, because "
                             "fewer photographs of a survey than this number see the rest" in
                             said.stdout + said.stderr, warns, views)

    def test_utm(self):
        place = (500000, 4500000, 30)
        for path, mesh in ((self.before, survey(before, 1)), (self.after, survey(after, 2))):
            write(path, ply(*mesh, comments=OFFSET))
        command = ("--epsg", "32631", "--gsd", "0.02", "--align", "icp")
        self.succeeds(*self.compare(*command))
        found = self.map("difference")
        self.assertAlmostEqual(found.left, place[0], delta=0.021)
        self.assertIn(32631, found.keys)
        regions = self.report()["regions"]
        self.assertEqual(sorted(region["change"] for region in regions), ["came", "gone"])
        for region in regions:
            x, y = (1.2, 0.8) if region["change"] == "came" else (0.4, 0.4)
            self.assertAlmostEqual(region["x"], place[0] + x, delta=0.02)
            self.assertAlmostEqual(region["y"], place[1] + y, delta=0.02)
        expected = self.report()

        def same_volumes():
            self.succeeds(*self.compare(*command))
            for kind in ("came", "gone"):
                self.assertAlmostEqual(self.report()[kind]["volume"], expected[kind]["volume"], delta=1e-5)

        # The same meshes as OBJ.
        write(self.path("work", "grey.mtl"), "newmtl grey\nmap_Kd grey.png\n")
        write(self.path("work", "grey.png"), png([bytes(4)] * 4))
        for name, mesh in (("a.obj", survey(before, 1)), ("b.obj", survey(after, 2))):
            write(self.path("work", name), "# geo_offset 500000 4500000 30\n" + obj(*mesh))
        self.before, self.after = self.path("work", "a.obj"), self.path("work", "b.obj")
        same_volumes()
        # Textures are not needed: files that are missing, and OBJ without texture coordinates.
        os.remove(self.path("work", "grey.png"))
        for name in ("a.obj", "b.obj"):
            lines = read(self.path("work", name)).decode().replace("/1", "").splitlines(True)
            write(self.path("work", name), "".join(line for line in lines if line[0] in "#vf"
                                                   and not line.startswith("vt")))
        same_volumes()


class InsideOfABoundary(CompareTest):
    """Of the two blocks, only the one that came is inside."""
    PLOT = ((0.9, 0.5), (1.5, 0.45), (1.45, 1.1), (0.95, 1.05))

    def setUp(self):
        super().setUp()
        write(self.path("work", "plot.geojson"), polygons(plot=[list(corner) for corner in self.PLOT]))

    def test_only_places_inside_are_compared(self):
        self.succeeds(*self.compare("--align", "icp", "--up", "0,0,1"))
        whole, registration = self.report(), self.report()["registration"]
        self.succeeds(*self.compare("--align", "icp", "--up", "0,0,1", "--boundary", "plot.geojson"))
        cut = self.report()
        self.assertEqual(cut["registration"], registration)
        self.assertEqual(cut["came"], whole["came"])
        self.assertEqual((cut["gone"]["regions"], cut["gone"]["volume"]), (0, 0))
        difference, classes = self.map("difference"), self.map("significant")
        inside = 0
        for row, values in enumerate(difference.rows):
            for column, value in enumerate(values):
                is_in = is_inside(self.PLOT, difference.left + (column + 0.5) * difference.pixel,
                                  difference.top - (row + 0.5) * difference.pixel)
                inside += is_in
                self.assertEqual((value != -9999, classes.rows[row][column] != 255), (is_in, is_in))
        self.assertAlmostEqual(cut["area_compared"], inside * difference.pixel ** 2, 9)

    def test_corners_are_targets_of_the_earlier_survey(self):
        self.succeeds(*self.compare("--align", "icp", "--up", "0,0,1", "--boundary", "plot.geojson"))
        by_file = self.map("difference").rows
        write(self.path("work", "target_places.json"), places(**{
            f"t{number}": (x, y, 0) for number, (x, y) in enumerate(self.PLOT, 1)}))
        self.succeeds(*self.compare("--align", "icp", "--up", "0,0,1", "--boundary-targets", "1,2,3,4"))
        self.assertEqual(self.map("difference").rows, by_file)

    def test_a_boundary_beside_the_surveys_is_refused(self):
        write(self.path("work", "away.geojson"), polygons(away=[[5, 5], [6, 5], [6, 6]]))
        self.refuses_each(
            self.compare("--align", "none"),
            ("b.ply: no place of both surveys is inside of the boundary: they have x from ", "--boundary",
             "away.geojson"),
            ("none.gpkg: ", "--boundary", "none.gpkg"),
            ("a.ply: no target_places.json in its folder", "--boundary-targets", "1,2,3"),
            ("--up contradicts --boundary-map", "--up", "0,0,1", "--boundary", "away.geojson", "--boundary-map",
             "a.tif"))


class Like(CompareTest):
    def test_maps_lie_on_the_plane_of_a_map(self):
        self.succeeds(*self.compare("--align", "icp", "--up", "0.1,-0.2,1"))
        by_up = {name: self.map(name).rows for name in ("difference", "significant", "sigma")}
        os.rename(self.path("work", "reef.change.difference.tif"), self.path("work", "plane.tif"))
        self.succeeds(*self.compare("--align", "icp", "--like", "plane.tif"))
        self.assertEqual({name: self.map(name).rows for name in by_up}, by_up)

    def test_a_comparison_that_states_no_plane_is_refused(self):
        self.succeeds(*self.compare("--align", "icp"))
        report = self.report()
        turned = [[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
        for told, changed in (
                ("map.axes is null, expected a list", {"map": {**report["map"], "axes": None}}),
                ("map.axes is [[1,0,0],[0,1,0]], expected 3 rows of 3 numbers",
                 {"map": {**report["map"], "axes": [[1, 0, 0], [0, 1, 0]]}}),
                ("registration.matrix is [[2,0,0,0]", {"registration": {"matrix": turned}}),
                ("map is missing: is it a comparison of CompareSurveys?", {"map": 1})):
            write(self.path("work", "other.json"), json.dumps({**report, **changed}))
            self.refuses(told, *self.compare("--like", "other.json"))
        for more in (("--up", "0,0,1"), ("--epsg", "32631")):
            self.refuses(f"{more[0]} contradicts --like, which states it", *self.compare("--like", "other.json", *more))


class UpAndDown(CompareTest):
    """What came and what went is never exchanged: the result is right, or it is refused."""

    def setUp(self):
        super().setUp()
        self.scene = self.above("scene.mvs", 2, 0.7, 0.9)
        self.scenes = ("--scene", self.scene, "--other-scene", self.scene)
        self.meshes = {self.before: survey(before, 1), self.after: survey(after, 2)}
        for path, mesh in self.meshes.items():
            write(path, ply(*mesh))

    def turn(self, *paths):
        for path in paths:
            vertices, faces = self.meshes[path]
            write(path, ply(vertices, turned(faces)))

    def check_right(self, *arguments):
        said = self.succeeds(*self.compare(*arguments)).stdout
        report = self.report()
        self.assertGreater(report["map"]["up"][2], 0.9)
        self.check_volumes(report)
        return said

    def test_cameras_show_what_is_up(self):
        for arguments in ((), ("--align", "icp"), ("--up", "0,0,1")):
            self.assertNotIn("warning", self.check_right(*self.scenes, *arguments))
        self.turn(self.before, self.after)
        for arguments in ((), ("--align", "icp"), ("--up", "0,0,1")):
            said = self.check_right(*self.scenes, *arguments)
            for mesh in (self.before, self.after):
                self.assertIn(f"warning: {mesh}: the mesh is inside out", said)

    def test_up_away_from_the_cameras_is_refused(self):
        self.refuses_and_keeps(f"--up 0,0,-1: points away from the cameras of {self.before}, so that what came would "
                               "count as gone; give --up 0,0,1\n", *self.compare(*self.scenes, "--up", "0,0,-1"))

    def test_without_cameras_faces_must_be_turned_up(self):
        self.refuses_and_keeps(f"--up 0,0,-1: points away from the side to which the faces are turned of {self.before}",
                               *self.compare("--up", "0,0,-1"))
        self.turn(self.after)
        wrong = "is turned to the other side than " + self.before + ": one of the meshes is inside out; if"
        self.refuses_and_keeps(f"{self.after}: {wrong}", *self.compare())
        self.refuses_and_keeps(f"{self.after}: {wrong}", *self.compare("--scene", self.scene))
        self.turn(self.before, self.after)
        self.refuses_and_keeps("--up 0,0,1: points away from the side", *self.compare("--up", "0,0,1"))
        write(self.after, ply(*self.meshes[self.after]))
        self.refuses_and_keeps(f"{self.after}: {wrong}", *self.compare())

    def test_depths_in_place_of_heights_are_refused(self):
        """Positions of surveys in a frame whose axes are north, east and down."""
        for path, (vertices, faces) in self.meshes.items():
            write(path, ply([(y, x, -z) for x, y, z in vertices], faces, comments=OFFSET))
        causes = "are the positions depths, positive downwards, or do they state northing before easting?"
        for arguments in ((), ("--epsg", "32631"), ("--align", "icp")):
            said = self.refuses_and_keeps(f"{self.before}: z points away from the side", *self.compare(*arguments))
            self.assertIn(causes, said.stderr)


class FarFaces(CompareTest):
    def far(self, mesh, place, is_used=True):
        vertices, faces = mesh
        corners = [place, (place[0] + 0.2, place[1], place[2]), (place[0], place[1] + 0.2, place[2])]
        n = len(vertices)
        return vertices + corners, faces + ([(n, n + 1, n + 2)] if is_used else [])

    def test_they_do_not_tilt_or_widen_the_map(self):
        self.succeeds(*self.compare())
        plain = self.report()
        for place, is_used in (((120, 120, 100), True), ((1000, 1000, 0), False), ((0, 0, 200), True)):
            write(self.before, ply(*self.far(survey(before, 1), place, is_used)))
            self.succeeds(*self.compare("--gsd", plain["map"]["pixel"]))
            found = self.report()
            self.assertEqual(found["map"], plain["map"])

    def test_they_do_not_count_on_the_way_to_a_small_map(self):
        write(self.before, ply(*self.far(survey(before, 1), (50_000, 0, 0))))
        self.succeeds(*self.compare("--up", "0,0,1", "--gsd", "0.02"))
        self.assertLess(self.report()["map"]["columns"], 100)


class MapsOfTheSamePrefix(Wall):
    """MapSurface and CompareSurveys with the same -o leave each other's files alone."""

    def test_neither_program_touches_the_files_of_the_other(self):
        map_it = self.command("MapSurface", "-o", "reef")
        compare = ("CompareSurveys", "-i", self.mesh, "-w", self.work, "--other", self.mesh, "-o", "reef")
        self.succeeds(*map_it, "--hillshade", "--contours", "0.1")
        maps = contents(self.work)
        self.assertLess({"reef.sigma.tif", "reef.jpg"}, set(maps))
        self.succeeds(*compare)
        both = contents(self.work)
        self.assertEqual({name: both[name] for name in maps}, maps)
        changes = {name: data for name, data in both.items() if name not in maps}
        self.assertEqual({f"work/{name}" for name in changes}, OUTPUTS)
        # Maps of an earlier run go, and nothing else.
        other = {name: changes["reef.change.sigma.tif"] for name in ("reef.sigma.tif", "reef.hillshade.tif")}
        self.succeeds(*map_it, "--image-noise", "0")
        self.assertEqual(set(contents(self.work)) & set(maps), set(maps) - {
            "reef.sigma.tif", "reef.hillshade.tif", "reef.contours.geojson", "reef.contours.gpkg", "reef.contours.dxf"})
        notes = {**other, "reef.contours.geojson": b'{"type": "FeatureCollection", "features": []}'}
        for name, data in notes.items():
            write(self.path("work", name), data)
        self.succeeds(*map_it, "--image-noise", "0")
        kept = contents(self.work)
        for name, data in {**changes, **notes}.items():
            self.assertEqual(kept[name], data, name)


class Targets(CompareTest):
    """The later survey in another frame, a quarter turn away and far from the origin."""
    PLATES = {"target 1": (0.1, 0.1, 0.2), "target 2": (1.5, 0.2, 0.1), "target 3": (1.4, 1.1, 0.3),
              "target 4": (0.2, 1.0, 0.1), "target 5": (0.9, 0.5, 0.2)}
    AT = (500000, 4500000, 30)

    def setUp(self):
        super().setUp()
        vertices, faces = survey(after, 2)
        write(self.after, ply([(-y, x, z) for x, y, z in vertices], faces, comments=OFFSET))
        later = {label: (self.AT[0] - y, self.AT[1] + x, self.AT[2] + z) for label, (x, y, z) in self.PLATES.items()}
        self.earlier_places = self.places("earlier.json", self.PLATES)
        self.later_places = self.places("later.json", later)
        self.files = ("--targets", self.earlier_places, "--other-targets", self.later_places)

    def places(self, name, plates, sigma=0.001):
        """The file of the places of plates with independent errors."""
        path, size = self.path("work", name), 3 * len(plates)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        write(path, json.dumps({
            "targets": [{"label": label, "x": x, "y": y, "z": z, "photographs": 3}
                        for label, (x, y, z) in plates.items()],
            "covariance_m2": [[sigma ** 2 if i == j else 0 for j in range(size)] for i in range(size)]}))
        return path

    def by_targets(self, *arguments):
        return self.succeeds(*self.compare("--align", "targets", "--up", "0,0,1", *arguments)).stdout

    def test_a_moved_block(self):
        said = self.by_targets(*self.files)
        self.assertNotIn("warning", said)
        self.assertIn("5 of 5 common targets used", said)
        report = self.report()
        self.check_volumes(report)
        registration = report["registration"]
        for row, place in zip(registration["matrix"], self.PLATES["target 2"]):
            later = (self.AT[0] - 0.2, self.AT[1] + 1.5, self.AT[2] + 0.1, 1)
            self.assertAlmostEqual(sum(m * c for m, c in zip(row, later)), place, delta=1e-6)
        self.assertEqual((registration["determined_directions"], registration["degrees_of_freedom"]), (6, 9))
        # Two surveys of five plates with 1 mm each.
        for sigma in registration["translation_sigma"]:
            self.assertAlmostEqual(sigma, 0.001 * math.sqrt(2 / 5), delta=2e-5)
        self.assertGreater(registration["height_sigma"], 0.0006)
        self.assertAlmostEqual(registration["scale"], 1, delta=1e-6)

    def test_scenes_are_moved_along(self):
        scene = self.above("scene.mvs", 2, 0.7, 0.9)
        said = self.succeeds(*self.compare("--align", "targets", *self.files, "--scene", scene)).stdout
        self.assertNotIn("warning", said)
        self.check_volumes(self.report())

    def test_a_plate_that_moved_is_named_and_left_out(self):
        moved = {**self.PLATES, "target 3": (1.4, 1.15, 0.28)}
        said = self.by_targets("--targets", self.places("moved.json", moved), *self.files[2:])
        self.assertIn("warning: target 3 moved by ", said)
        self.assertIn("4 of 5 common targets used", said)
        targets = self.report()["registration"]["targets"]
        self.assertEqual([one["label"] for one in targets if one["moved"]], ["target 3"])
        self.check_volumes(self.report())

    def test_scales_that_differ_are_told(self):
        larger = {label: tuple(1.02 * value for value in place) for label, place in self.PLATES.items()}
        said = self.by_targets("--targets", self.places("larger.json", larger), *self.files[2:])
        self.assertIn("lengths of the earlier survey are 2.000 +- ", said)
        self.assertIn("% larger than those of the later one", said)

    def test_files_beside_the_meshes_are_found(self):
        os.makedirs(self.path("work", "later"))
        os.rename(self.after, self.path("work", "later", "b.ply"))
        self.after = self.path("work", "later", "b.ply")
        missing = self.compare("--align", "targets")
        self.refuses_and_keeps(f"{self.before}: no target_places.json in its folder or in refined/ there; --targets "
                               "states the file\n", *missing)
        os.renames(self.earlier_places, self.path("work", "refined", "target_places.json"))
        self.refuses_and_keeps(f"{self.after}: no target_places.json in its folder", *missing)
        os.rename(self.later_places, self.path("work", "later", "target_places.json"))
        self.by_targets()
        self.check_volumes(self.report())
        write(self.path("work", "target_places.json"), "")
        self.refuses_and_keeps(f"{self.path('work', 'target_places.json')}: ", *missing)

    def test_auto_takes_the_ground_without_common_targets(self):
        write(self.after, ply(*survey(after, 2)))
        auto = self.compare("--align", "auto", "--up", "0,0,1")
        self.assertIn("by the ground, because a survey has no places of targets", self.succeeds(*auto).stdout)
        few = self.places("few.json", {label: self.PLATES[label] for label in ("target 1", "target 2")})
        said = self.succeeds(*auto, "--targets", few, *self.files[2:]).stdout
        self.assertIn("by the ground, because 2 targets are in both surveys", said)
        self.assertIn("% of the ground", said)
        self.assertNotIn("targets", self.report()["registration"])
        said = self.succeeds(*auto, "--targets", self.earlier_places, "--other-targets",
                             self.places("same.json", self.PLATES)).stdout
        self.assertIn("5 of 5 common targets used", said)

    def test_wrong_places_are_refused(self):
        line = self.places("line.json", {f"target {i}": (i, 0, 0) for i in (1, 2, 3)})
        few = self.places("few.json", {label: self.PLATES[label] for label in ("target 1", "target 2")})
        self.refuses_each(
            self.compare(),
            ("--targets needs --align targets or --align auto", "--targets", few),
            ("--other-targets needs --align", "--align", "icp", "--other-targets", few),
            (f"{self.later_places}: 2 targets are in both surveys, but a registration needs three or more",
             "--align", "targets", "--targets", few, *self.files[2:]),
            (f"{self.later_places}: the targets target 1, target 2, target 3 lie on a line",
             "--align", "targets", "--targets", line, *self.files[2:]),
            ("none.json", "--align", "targets", "--targets", "none.json", *self.files[2:]),
            (f"{self.before}: malformed", "--align", "targets", "--targets", self.before, *self.files[2:]))


class WrongInput(CompareTest):
    def test_one_line_that_names_the_fault(self):
        self.refuses_each(
                self.compare(),
                ("--align centres: must be one of none, icp", "--align", "centres"),
                ("--ground-sample-distance -1: must be from 0", "--gsd", "-1"),
                ("--ground-sample-distance 1e-08: the map would have", "--gsd", "1e-8"),
                ("--up 0,0: must be three numbers X,Y,Z", "--up", "0,0"),
                ("--up 0,0,0: is no direction", "--up", "0,0,0"),
                ("--up 1,0,0: must be 0,0,1 with --epsg", "--up", "1,0,0", "--epsg", "32631"),
                ("--epsg 4326: is no projected", "--epsg", "4326"),
                ("--sigma-after is missing", "--sigma-before", "0.01"),
                ("--sigma-before is missing", "--sigma-after", "0.01"),
                ("--sigma-before 0: must be from", "--sigma-before", "0", "--sigma-after", "0.01"),
                ("--sigma-after nan", "--sigma-before", "0.01", "--sigma-after", "nan"),
                ("--min-pixels 0: must be from 1", "--min-pixels", "0"),
                ("--min-views 0: must be from 1", "--min-views", "0", "--scene", "none.mvs"),
                ("--min-views needs --scene", "--min-views", "2"),
                ("none.mvs", "--scene", "none.mvs"),
                ("none.mvs", "--other-scene", "none.mvs"),
                ("--max-memory", "--max-memory", "20"))
        self.refuses_and_keeps("--output-file .: must be the name of a file", *self.compare("-o", "."))

    def test_missing_surveys(self):
        self.refuses_and_keeps("--other is missing", "CompareSurveys", "-i", self.before)
        self.refuses_and_keeps("none.ply: ", "CompareSurveys", "-i", self.before, "--other", "none.ply")
        self.refuses_and_keeps("none.ply: ", "CompareSurveys", "-i", "none.ply", "--other", self.after)

    def test_wrong_meshes(self):
        vertices, faces = survey(after, 2)
        far = [(x + 10, y, z) for x, y, z in vertices]
        for expected, mesh in (
                ("b.ply: the surveys do not overlap", (far, faces)),
                ("b.ply: the later survey has only 62 vertices", (vertices, faces[:60])),
                ("b.ply: the surveys have only", (vertices, faces[:160]))):
            write(self.after, ply(*mesh))
            self.refuses_and_keeps(expected, *self.compare("--align", "icp"))
        write(self.before, ply([(0, 0, 1)] * 3, [(0, 1, 2)]))
        self.refuses_and_keeps("a.ply: the mesh has no area", *self.compare())


if __name__ == "__main__":
    main()
