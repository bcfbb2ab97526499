# SPDX-License-Identifier: GPL-3.0-or-later
"""MeasureSurface on the wall of tiny_scene.py: tables, coordinates of maps, wrong input."""

import contextlib
import csv
import io
import json
import math
import os
import sqlite3

from programs import files_below, main, write
from worlds import Wall, grid, ply, turned, wall


def polygons(**rings):
    """A GeoJSON file of one polygon for each name."""
    return json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": name}, "geometry": {
            "type": "Polygon", "coordinates": [[*ring, ring[0]]]}} for name, ring in rings.items()]})


def box(left, low, right, high):
    return [[left, low], [right, low], [right, high], [left, high]]


class MeasureTest(Wall):
    def setUp(self):
        super().setUp()
        self.succeeds(*self.command("MapSurface", "--up", "0,0,-1"))
        write(self.path("work", "plots.geojson"), polygons(plot=box(-0.2, -0.1, 0.2, 0.2), far=box(50, 50, 51, 51)))

    def measure(self, *more, areas="plots.geojson", map_file="scene_map.dem.tif", output="measured"):
        return ("MeasureSurface", "-w", self.work, "-i", self.mesh, "--areas", areas, "--map", map_file, "-o", output,
                *more)

    def rows(self):
        return {row["name"]: row for row in csv.DictReader(io.StringIO(self.at("measured.csv").decode()))}


class Tables(MeasureTest):
    def test_a_flat_wall_is_as_large_as_the_polygon(self):
        said = self.succeeds(*self.measure("--length-sigma", "0.5")).stdout
        self.assertIn("polygon 'far': the mesh has no surface there", said)
        plot, far = self.rows()["plot"], self.rows()["far"]
        for name in ("polygon_m2", "planar_m2", "seen_m2", "surface_m2"):
            self.assertAlmostEqual(float(plot[name]), 0.12, places=5, msg=name)
        self.assertAlmostEqual(float(plot["sigma_surface_m2"]), 2 * 0.005 * 0.12, places=6)
        self.assertAlmostEqual(float(plot["rugosity"]), 1, places=4)
        self.assertEqual({name for name, value in far.items() if value and not name.startswith("sigma")},
                         {"name", "polygon_m2", "planar_m2", "seen_m2", "surface_m2", "rim_share"})
        with contextlib.closing(sqlite3.connect(self.path("work", "measured.gpkg"))) as table:
            found = table.execute("SELECT name, rugosity, planar_m2 FROM areas ORDER BY fid").fetchall()
        self.assertEqual([row[0] for row in found], ["plot", "far"])
        self.assertAlmostEqual(found[0][1], 1, places=4)
        self.assertIsNone(found[1][1])

    def test_the_same_input_gives_the_same_bytes(self):
        self.succeeds(*self.measure())
        first = self.at("measured.csv"), self.at("measured.gpkg")
        self.succeeds(*self.measure("--max-threads", "1"))
        self.assertEqual((self.at("measured.csv"), self.at("measured.gpkg")), first)

    def test_polygons_lie_on_the_map(self):
        """A slope in UTM coordinates, without a map."""
        east, north = 500000, 2500000
        slope = lambda x, y: 0.5 * x + 0.25 * y - 20
        corners = [(x, y) for y in (-1, 1) for x in (-1, 1)]
        self.put([(x, y, slope(x, y)) for x, y in corners], [(0, 1, 3), (0, 3, 2)],
                 comments=f"comment geo_offset {east} {north} 0\n")
        write(self.path("work", "utm.geojson"), polygons(a=box(east + 0.1, north + 0.2, east + 0.5, north + 0.8)))
        self.succeeds("MeasureSurface", "-w", self.work, "-i", self.mesh, "--areas", "utm.geojson", "-o",
                      "measured.csv")
        row = self.rows()["a"]
        self.assertAlmostEqual(float(row["planar_m2"]), 0.24, places=5)
        self.assertAlmostEqual(float(row["lowest_m"]), slope(0.1, 0.2), places=3)
        self.assertAlmostEqual(float(row["highest_m"]), slope(0.5, 0.8), places=3)
        self.assertAlmostEqual(float(row["mean_height_m"]), slope(0.3, 0.5), places=3)
        self.assertAlmostEqual(float(row["aspect_degrees"]), 180 + math.degrees(math.atan2(0.5, 0.25)), places=1)

    def test_a_second_layer_does_not_count(self):
        self.succeeds(*self.measure())
        right = self.rows()["plot"]
        vertices, faces = wall()
        self.put([*vertices, *((x, y, z + 0.02) for x, y, z in vertices)],
                 [*faces, *(tuple(corner + len(vertices) for corner in face) for face in faces)])
        self.succeeds(*self.measure())
        row = self.rows()["plot"]
        for name in ("planar_m2", "seen_m2", "rugosity", "highest_m", "lowest_m"):
            self.assertAlmostEqual(float(row[name]), float(right[name]), places=6, msg=name)
        self.assertAlmostEqual(float(row["surface_m2"]), 0.24, places=5)
        self.assertAlmostEqual(float(row["rugosity_whole"]), 2, places=4)

    def test_a_mesh_that_is_inside_out_is_turned(self):
        self.succeeds(*self.measure())
        right = self.rows()["plot"]
        vertices, faces = wall()
        self.put(vertices, turned(faces))
        self.assertIn("its faces are turned down", self.succeeds(*self.measure()).stdout)
        self.assertEqual(self.rows()["plot"], right)

    def test_the_map_states_the_axes(self):
        """The map's heights are the world's -z, so that its y is the world's -y."""
        self.put([(x, y, 1 + 0.5 * y) for y in (-1, 1) for x in (-1, 1)], [(0, 3, 1), (0, 2, 3)])
        write(self.path("work", "north.geojson"), polygons(north=box(-0.1, 0.2, 0.1, 0.6)))
        self.succeeds(*self.measure(areas="north.geojson"))
        row = self.rows()["north"]
        self.assertAlmostEqual(float(row["mean_height_m"]), -(1 - 0.5 * 0.4), places=4)


def graph(height, cells=100, shift=0):
    """The graph of a function on a square of width 2, with its outside to larger z."""
    at = lambda i: -1 + 2 * i / cells
    vertices, faces = grid(cells, cells, lambda i, j: (at(i) + shift, at(j), height(at(i), at(j))))
    return vertices, turned(faces)


def mound(x, y, high, radius):
    return lambda u, v: max(0, high * (1 - ((u - x) ** 2 + (v - y) ** 2) / radius ** 2))


class Earlier(MeasureTest):
    """A mound of 0.1 m came, and a pit of 0.05 m, on a wavy ground."""
    RADIUS, CAME, GONE = 0.3, 0.1, 0.05

    def setUp(self):
        super().setUp()
        ground = lambda x, y: 0.02 * math.sin(9 * x + 4 * y)
        came, gone = mound(-0.5, 0, self.CAME, self.RADIUS), mound(0.5, 0, self.GONE, self.RADIUS)
        write(self.path("work", "before.ply"), ply(*graph(ground)))
        write(self.path("work", "away.ply"), ply(*graph(ground, shift=30)))
        self.put(*graph(lambda x, y: ground(x, y) + came(x, y) - gone(x, y)))
        write(self.path("work", "areas.geojson"), polygons(
            came=box(-0.9, -0.4, -0.1, 0.4), gone=box(0.1, -0.4, 0.9, 0.4), still=box(-0.9, 0.5, 0.9, 0.9),
            far=box(5, 5, 6, 6)))

    def compared(self, earlier, *more):
        return ("MeasureSurface", "-w", self.work, "-i", self.mesh, "--areas", "areas.geojson", "--earlier", earlier,
                "-o", "measured", *more)

    def test_change_is_measured(self):
        said = self.succeeds(*self.compared("before.ply")).stdout
        self.assertIn("polygon 'far': only 0.0 % of it can be compared", said)
        rows = self.rows()
        volume = lambda high: math.pi / 2 * self.RADIUS ** 2 * high
        for name, column, other, true in (("came", "gain_m3", "loss_m3", self.CAME),
                                          ("gone", "loss_m3", "gain_m3", self.GONE)):
            row, sign = rows[name], 1 if name == "came" else -1
            # Vertices 2 cm apart cut (2 cm / 30 cm)^2 / 4 off a mound.
            for found in (float(row[column]), sign * float(row["net_m3"])):
                self.assertAlmostEqual(found, volume(true), delta=0.01 * volume(true))
            self.assertEqual(float(row[other]), 0)
            self.assertAlmostEqual(float(row["mean_change_m"]) * 0.64, sign * volume(true), delta=0.02 * volume(true))
            self.assertAlmostEqual(float(row["largest_change_m"]), sign * true, delta=0.01 * true)
            self.assertAlmostEqual(float(row["compared_m2"]), 0.64, delta=0.01)
            self.assertLess(float(row["sigma_" + column]), 0.05 * volume(true))
            self.assertGreater(float(row["surface_change_m2"]), 0)
        still = rows["still"]
        self.assertEqual([float(still[name]) for name in ("gain_m3", "loss_m3")], [0, 0])
        for name in ("net_m3", "mean_change_m", "largest_change_m", "surface_change_m2"):
            self.assertAlmostEqual(float(still[name]), 0, places=6, msg=name)
        self.assertEqual({rows["far"][name] for name in ("net_m3", "gain_m3", "largest_change_m")}, {""})

    def test_surveys_that_do_not_overlap_are_refused(self):
        self.refuses("the surveys do not overlap", *self.compared("away.ply"))
        self.refuses("none.ply: ", *self.compared("none.ply"))
        self.refuses("--allow-other-place is only for --earlier", *self.measure("--allow-other-place"))


class Errors(MeasureTest):
    def test_wrong_input_is_named_and_writes_nothing(self):
        before = files_below(self.work)
        for name, content, expected in (
                ("bow", polygons(bow=[[0, 0], [1, 1], [1, 0], [0, 1]]),
                 "polygon 'bow' crosses itself at (0.500, 0.500)"),
                ("away", polygons(away=box(50, 50, 51, 51)), "has no surface in any polygon"),
                ("empty", polygons(), "has no")):
            write(self.path("work", name + ".geojson"), content)
            self.refuses(expected, *self.measure(areas=name + ".geojson"))
        self.refuses("--areas is missing", "MeasureSurface", "-w", self.work, "-i", self.mesh)
        self.refuses("contradicts --map", *self.measure("--epsg", "32617"))
        os.mkfifo(self.path("work", "pipe"))
        self.refuses("pipe: is not a regular file", *self.measure(areas="pipe"))
        self.refuses("pipe: is not a regular file", *self.measure(map_file="pipe"))
        os.remove(self.path("work", "pipe"))
        self.refuses("none.tif: ", *self.measure(map_file="none.tif"))
        self.refuses("none.gpkg: ", *self.measure(areas="none.gpkg"))
        write(self.path("work", "clash.gpkg"), polygons(a=box(0, 0, 1, 1)))
        self.refuses("--output-file", *self.measure(output="clash", areas="clash.gpkg"))
        self.assertEqual(files_below(self.work) - before, {"bow.geojson", "away.geojson", "empty.geojson",
                                                          "clash.gpkg"})


if __name__ == "__main__":
    main()
