# SPDX-License-Identifier: GPL-3.0-or-later
"""--boundary of MapSurface, TextureMesh and ReconstructMesh on the wall of tiny_scene.py: what is inside, extents,
targets, coordinates, wrong input."""

import csv
import io
import json

from geotiff import read_geotiff
from measure_surface_test import box, polygons
from programs import files_below, main, write
from readers import Ply
from tiny_scene import DISTANCE
from worlds import Wall, geo_offset, wall

NO_HEIGHT = -9999
# In the coordinates of the map: its x and y are the world's x and -y. It is concave, and no corner is on a vertex.
PLOT = [[-0.21, -0.13], [0.17, -0.19], [0.03, 0.02], [0.19, 0.22], [-0.15, 0.11]]


def area(ring):
    return abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(ring, ring[1:] + ring[:1]))) / 2


def is_inside(ring, x, y):
    """By the sides that a ray to the right crosses."""
    crossed = [a for a, b in zip(ring, (*ring[1:], ring[0]))
               if (a[1] > y) != (b[1] > y) and x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])]
    return len(crossed) % 2 == 1


def distance(ring, x, y):
    """From the border."""
    def of_side(a, b):
        along = (b[0] - a[0], b[1] - a[1])
        at = ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2)
        at = min(max(at, 0), 1)
        return ((a[0] + at * along[0] - x) ** 2 + (a[1] + at * along[1] - y) ** 2) ** 0.5
    return min(of_side(a, b) for a, b in zip(ring, ring[1:] + ring[:1]))


def places(**targets):
    """The text of target_places.json for targets with the coordinates x, y, z."""
    count = 3 * len(targets)
    return json.dumps({"targets": [{"label": f"target {name[1:]}", "x": x, "y": y, "z": z, "photographs": 3}
                                   for name, (x, y, z) in targets.items()],
                       "covariance_m2": [[1e-6 * (i == j) for j in range(count)] for i in range(count)]})


class BoundaryTest(Wall):
    def setUp(self):
        super().setUp()
        write(self.path("work", "plot.geojson"), polygons(plot=PLOT))

    def map(self, *more):
        return self.succeeds(*self.command("MapSurface", *more)).stdout

    def read_map(self, name, begin="scene_map"):
        return read_geotiff(self.at(f"{begin}.{name}.tif"))


class Maps(BoundaryTest):
    def test_pixels_outside_are_empty_and_those_inside_stay(self):
        self.map("-o", "whole")
        said = self.map("--boundary", "plot.geojson")
        self.assertRegex(said, r"plot.geojson: \d+ faces are inside and \d+ are left out")
        near = 0
        for name, none in (("dem", NO_HEIGHT), ("views", 65535), ("sigma", NO_HEIGHT), ("ortho", None)):
            cut, whole = self.read_map(name), self.read_map(name, "whole")
            right, shift = round((cut.left - whole.left) / cut.pixel), round((whole.top - cut.top) / cut.pixel)
            for row, values in enumerate(cut.rows):
                for column, value in enumerate(values):
                    x, y = cut.left + (column + 0.5) * cut.pixel, cut.top - (row + 0.5) * cut.pixel
                    # Vertices are float; colours are means over pixels.
                    if distance(PLOT, x, y) < (1e-6 if none is not None else cut.pixel):
                        near += 1
                    elif not is_inside(PLOT, x, y):
                        self.assertEqual(value, none if none is not None else (0, 0, 0, 0), (name, x, y))
                    elif name != "ortho":
                        # Another face of the plane is there: the same height, and the error of another middle.
                        self.assertAlmostEqual(value, whole.rows[row + shift][column + right],
                                               4 if name == "sigma" else 6, (name, x, y))
                    else:
                        self.assertEqual(value[3], 255)
        self.assertLess(near, 400)  # pixels of the border of the orthomosaic: about 1.5 m / 0.011 m * 2

    def test_the_extent_is_that_of_the_boundary(self):
        self.map("--boundary", "plot.geojson", "--gsd", "0.01")
        dem = self.read_map("dem")
        self.assertAlmostEqual(dem.left, -0.21, 9)
        self.assertAlmostEqual(dem.top, 0.22, 9)
        self.assertEqual((len(dem.rows[0]), len(dem.rows)), (40, 41))
        # Beyond the surface, too.
        write(self.path("work", "large.geojson"), polygons(a=box(-0.5, -0.4, 0.5, 0.6), b=box(0.1, 0.7, 0.2, 0.8)))
        self.map("--boundary", "large.geojson", "--gsd", "0.01")
        dem = self.read_map("dem")
        self.assertEqual((len(dem.rows[0]), len(dem.rows)), (100, 120))
        filled = sum(height != NO_HEIGHT for row in dem.rows for height in row)
        self.assertEqual(filled, 60 * 60)  # the wall has a side of 0.6 m

    def test_a_textured_mesh_gives_the_same_maps(self):
        self.succeeds(*self.command("TextureMesh", "-o", "textured"))
        self.map("--boundary", "plot.geojson")
        plain = {name: self.read_map(name) for name in ("dem", "views", "ortho")}
        self.map("--boundary", "plot.geojson", "-m", "textured.ply")
        for name in ("dem", "views"):
            self.assertEqual(self.read_map(name).rows, plain[name].rows, name)
        pixels = [(p, q) for r, s in zip(self.read_map("ortho").rows, plain["ortho"].rows) for p, q in zip(r, s)]
        self.assertGreater(sum(p[3] == 255 for p, _ in pixels), 500)
        # Textures are cut out of the photographs at other places.
        self.assertLessEqual(max(abs(a - b) for pixel in pixels for a, b in zip(*pixel)), 1)

    def test_the_same_input_gives_the_same_bytes(self):
        found = set()
        for threads in ("1", "3"):
            self.map("--boundary", "plot.geojson", "--max-threads", threads)
            found.add(tuple(self.at(f"scene_map.{name}") for name in ("dem.tif", "ortho.tif", "views.tif", "jpg")))
        self.assertEqual(len(found), 1)

    def test_utm(self):
        """The corners lie on edges of the mesh and of pixels."""
        write(self.path("work", "scene.geo.json"), geo_offset(500000, 4500000, 30))
        self.put(*wall(), comments="comment geo_offset 500000 4500000 30\n")
        inside = box(500000.1, 4499999.8, 500000.2, 4500000.1)
        write(self.path("work", "utm.geojson"), polygons(a=inside))
        self.map("--gsd", "0.0125", "--boundary", "utm.geojson")
        dem = self.read_map("dem")
        self.assertAlmostEqual(dem.left, 500000.1, 6)
        self.assertAlmostEqual(dem.top, 4500000.1, 6)
        self.assertEqual([set(row) for row in dem.rows], [{30 + DISTANCE}] * 24)
        self.assertEqual(len(dem.rows[0]), 8)

    def test_targets_at_the_corners(self):
        corners = {f"t{number}": (x, -y, DISTANCE) for number, (x, y) in enumerate(PLOT, 1)}
        write(self.path("work", "refined", "target_places.json"), places(**corners))
        self.map("--boundary", "plot.geojson")
        by_file = self.read_map("dem")
        self.map("--boundary-targets", "1, target 2,Target_03,4,5")
        self.assertEqual(self.read_map("dem").rows, by_file.rows)
        write(self.path("work", "plates.csv"), "label,x,y,z\n" + "".join(
            f"{name[1:]},{x},{y},{z}\n" for name, (x, y, z) in corners.items()))
        self.map("--boundary-targets", "1,2,3,4,5", "--target-places", "plates.csv")
        self.assertEqual(self.read_map("dem").rows, by_file.rows)


class Meshes(BoundaryTest):
    def area_of(self, name):
        """Of a mesh in the plane of the wall: the sum of its faces."""
        mesh = Ply(self.at(name))
        points = mesh.points
        return sum(area([points[v] for v in face]) for face in mesh.triangles)

    def test_they_end_at_the_boundary(self):
        self.map()
        on_map = ("--boundary", "plot.geojson", "--boundary-map", "scene_map.dem.tif")
        self.succeeds(*self.command("TextureMesh", "-o", "cut", *on_map))
        self.assertAlmostEqual(self.area_of("cut.ply"), area(PLOT), 6)
        # Without a map, the axes are those that MapSurface would choose.
        self.succeeds(*self.command("TextureMesh", "-o", "other", *on_map[:2]))
        self.assertEqual(self.at("other.ply").replace(b"other0.png", b"cut0.png"), self.at("cut.ply"))
        clean = ("ReconstructMesh", "-i", "scene.mvs", "-w", self.work, "--mesh-file", self.mesh, "-o", "clean.ply",
                 "--remove-spurious", "0", "--smooth", "0", "--close-unseen", "1")
        self.succeeds(*clean, *on_map)
        self.assertAlmostEqual(self.area_of("clean.ply"), area(PLOT), 6)
        self.succeeds(*clean[:-2], *on_map[:2])
        self.assertAlmostEqual(self.area_of("clean.ply"), area(PLOT), 6)
        # MeasureSurface finds that the cut mesh fills the polygon.
        self.succeeds("MeasureSurface", "-w", self.work, "-i", "cut.ply", "--areas", "plot.geojson", "--map",
                      "scene_map.dem.tif", "-o", "measured")
        row, = csv.DictReader(io.StringIO(self.at("measured.csv").decode()))
        self.assertAlmostEqual(float(row["planar_m2"]), float(row["polygon_m2"]), 6)

    def test_tiles_end_at_the_boundary(self):
        said = self.succeeds(*self.command("TextureMesh", "-o", "cut", "--tiles", "2", "--boundary", "plot.geojson"))
        self.assertRegex(said.stdout, r"textures; 0 of \d+ faces are not seen")
        tiles = [name for name in files_below(self.work) if name.startswith("cut.tile") and name.endswith(".ply")]
        self.assertAlmostEqual(sum(map(self.area_of, tiles)), area(PLOT), 6)


class WrongInput(BoundaryTest):
    def test_one_line_that_names_the_fault(self):
        write(self.path("work", "empty.geojson"), polygons())
        write(self.path("work", "bow.geojson"), polygons(bow=[[0, 0], [.1, .1], [.1, 0], [0, .1]]))
        write(self.path("work", "away.geojson"), polygons(away=box(50, 60, 51, 62)))
        write(self.path("work", "target_places.json"), places(t1=(0, 0, 1), t2=(.1, .1, 1), t3=(.1, 0, 1),
                                                              t4=(0, .1, 1)))
        write(self.path("work", "large.geojson"), polygons(large=box(-200, -200, 200, 200)))
        write(self.path("work", "degrees.geojson"), polygons(far=box(200, 100, 201, 101)))
        away = ("away.geojson: lies outside of the surface: x from 50.00 to 51.00 and y from 60.00 to 62.00, but the "
                "surface has x from -0.30 to 0.30 and y from -0.30 to 0.30", "--boundary", "away.geojson")
        places_of = lambda labels: ("--boundary-targets", labels)
        faults = (
            ("empty.geojson: has no", "--boundary", "empty.geojson"),
            ("bow.geojson: polygon 'bow' crosses itself at (0.050, 0.050)", "--boundary", "bow.geojson"),
            ("none.gpkg: ", "--boundary", "none.gpkg"),
            away,
            ("--boundary-targets contradicts --boundary", "--boundary", "plot.geojson", *places_of("1,2,3")),
            ("--boundary-targets 1,2: must be three or more labels", *places_of("1,2")),
            ("--boundary-targets 1,,2: has an empty label", *places_of("1,,2")),
            ("target_places.json: has no target '7' of --boundary-targets", *places_of("1,2,7")),
            ("--boundary-targets 1,2,3,4: the outline crosses itself", *places_of("1,2,3,4")),
            ("--target-places ", "--target-places", "target_places.json"),
            ("none.csv: ", *places_of("1,2,3"), "--target-places", "none.csv"),
            ("--boundary-map ", "--boundary-map", "plot.geojson"),
            ("none.tif: ", "--boundary", "plot.geojson", "--boundary-map", "none.tif"))
        for program in ("MapSurface", "TextureMesh"):
            self.refuses_each(self.command(program), *faults)
        on_map = ("--boundary", "plot.geojson", "--boundary-map", "map.tif")
        self.refuses_each(
            self.command("MapSurface"),
            ("degrees.geojson: polygon 'far' cannot be converted", "--boundary", "degrees.geojson", "--epsg", "32631"),
            ("--up contradicts --boundary-map", *on_map, "--up", "0,0,1"),
            ("--epsg contradicts --boundary-map", *on_map, "--epsg", "32631"),
            ("large.geojson: the map would have 40000 x 40000 pixels", "--boundary", "large.geojson", "--gsd", "0.01"))
        self.refuses_each(("ReconstructMesh", "-i", "scene.mvs", "-w", self.work, "--mesh-file", self.mesh,
                           "--remove-spurious", "0"), *faults)


if __name__ == "__main__":
    main()
