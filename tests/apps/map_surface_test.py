# SPDX-License-Identifier: GPL-3.0-or-later
"""MapSurface on the wall of tiny_scene.py: names of files, heights, colours, coordinates, wrong
input."""

import json
import os
import re

from geotiff import read_geotiff
from programs import contents, files_below, main, read, run, write
from texture_mesh_test import mesh_ply, wall
from tiny_scene import DISTANCE, TinyScene, texture

MAPS = {"scene_map.dem.tif", "scene_map.ortho.tif", "scene_map.views.tif", "scene_map.sigma.tif", "scene_map.jpg"}


class MapTest(TinyScene):
    def setUp(self):
        super().setUp()
        self.mesh = self.path("work", "scene.ply")
        write(self.mesh, mesh_ply(*wall()))

    def map(self, *arguments):
        return ("MapSurface", "-i", self.scene, "-w", self.work, *arguments)

    def read_map(self, name):
        return read_geotiff(read(self.path("work", name)))


class Files(MapTest):
    def test_names(self):
        before = files_below(self.work)
        self.succeeds(*self.map())
        self.assertEqual(files_below(self.work) - before, MAPS)
        self.succeeds(*self.map("-o", "new/a.v2", "--hillshade", "--contours", "0.1"))
        self.assertLess({"new/a.v2." + end for end in
                         ("dem.tif", "ortho.tif", "views.tif", "sigma.tif", "hillshade.tif", "contours.geojson", "jpg")},
                        files_below(self.work))

    def test_without_image_noise_there_are_no_expected_errors(self):
        before = files_below(self.work)
        self.succeeds(*self.map("--image-noise", "0"))
        self.assertEqual(files_below(self.work) - before, MAPS - {"scene_map.sigma.tif"})

    def test_any_number_of_threads_gives_the_same_bytes(self):
        found = []
        for threads in (1, 2):
            self.succeeds(*self.map("--max-threads", threads, "--hillshade", "--contours", "0.1"))
            found.append(contents(self.work))
        self.assertEqual(found[0], found[1])

    def test_a_textured_mesh_gives_the_same_maps(self):
        self.succeeds(*self.map())
        plain = {name: read(self.path("work", name)) for name in MAPS}
        self.succeeds("TextureMesh", "-i", self.scene, "-w", self.work, "-o", "textured")
        self.succeeds(*self.map("-m", "textured.ply"))
        for name in ("scene_map.dem.tif", "scene_map.views.tif", "scene_map.sigma.tif"):
            self.assertEqual(read(self.path("work", name)), plain[name], name)
        one = read_geotiff(plain["scene_map.ortho.tif"]).rows
        two = self.read_map("scene_map.ortho.tif").rows
        self.assertLessEqual(max(abs(a - b) for r, s in zip(one, two) for p, q in zip(r, s)
                                 for a, b in zip(p, q)), 1)


class Pixels(MapTest):
    """The cameras look along z, so that the map's plane has the upward direction -z, and the map's
    axes are x and -y of the world."""

    def test_heights_and_colours_are_those_of_the_wall(self):
        said = self.succeeds(*self.map()).stdout
        self.assertIn("map's x: 1.0000 0.0000 0.0000, y: 0.0000 -1.0000 0.0000, up: 0.0000 0.0000 -1.0000",
                      re.sub(r"-(0\.0000)", r"\1", said))
        dem, ortho, views = (self.read_map(f"scene_map.{name}.tif")
                             for name in ("dem", "ortho", "views"))
        self.assertEqual(dem.pixel, 0.011)  # 1 m / 90 px
        value, errors, most = texture(), [], 0
        for row, heights in enumerate(dem.rows):
            for column, height in enumerate(heights):
                x = dem.left + (column + 0.5) * dem.pixel
                y = -(dem.top - (row + 0.5) * dem.pixel)
                if max(abs(x), abs(y)) > 0.3 - 1e-6:
                    continue
                self.assertAlmostEqual(height, -DISTANCE, 6)
                most = max(most, views.rows[row][column])
                red, _, _, alpha = ortho.rows[row][column]
                if alpha and max(abs(x), abs(y)) < 0.28:
                    errors.append(red - 255 * value(x, y))
        self.assertEqual(most, 3)
        self.assertGreater(len(errors), 2000)
        # The photographs show the wall without averaging, in pixels as large as those of the map.
        # A displacement of half a pixel would give an RMS of 12 grey levels.
        self.assertLess((sum(e * e for e in errors) / len(errors)) ** 0.5, 8)

    def test_expected_errors(self):
        # They are unknown where fewer than two photographs see the place, and otherwise at least a
        # third of a photograph's pixel, of 1 m / 90.
        self.succeeds(*self.map("--image-noise", "0.2"))
        dem, views, sigma = (self.read_map(f"scene_map.{name}.tif")
                             for name in ("dem", "views", "sigma"))
        known = 0
        for a, b, c in zip(dem.rows, views.rows, sigma.rows):
            for height, count, error in zip(a, b, c):
                self.assertEqual(error == -9999, height == -9999 or count < 2)
                if error != -9999:
                    known += 1
                    self.assertGreater(error, 0.33 * 0.9 / 90)
                    self.assertLess(error, 0.1)
        self.assertGreater(known, 1000)

    def test_the_length_of_up_has_no_effect(self):
        found = set()
        for up in ("0,0,-1", "0,0,-1e300", "0,0,-1e-300"):
            self.succeeds(*self.map("--up", up))
            found.add(read(self.path("work", "scene_map.dem.tif")))
        self.assertEqual(len(found), 1)

    def test_utm(self):
        write(self.path("work", "scene.geo.json"),
              json.dumps({"version": 1, "geo_offset": [500000, 4500000, 30]}))
        header = "format ascii 1.0\ncomment geo_offset 500000 4500000 30"
        write(self.mesh, read(self.mesh).decode().replace("format ascii 1.0", header))
        self.succeeds(*self.map("--gsd", "0.0125", "--epsg", "32631"))
        for name in ("dem", "ortho", "views"):
            found = self.read_map(f"scene_map.{name}.tif")
            self.assertAlmostEqual(found.left, 499999.7, 6)
            self.assertAlmostEqual(found.top, 4500000.3, 6)
            self.assertEqual((len(found.rows), len(found.rows[0])), (48, 48))
            self.assertIn(32631, found.keys)
        self.assertEqual(self.read_map("scene_map.dem.tif").rows[20][20], 30 + DISTANCE)

    def test_holes(self):
        vertices, faces = wall()
        write(self.mesh, mesh_ply(vertices, faces[:100] + faces[140:]))
        self.succeeds(*self.map("--up", "0,0,-1", "--gsd", "0.0125"))
        dem, ortho, views = (self.read_map(f"scene_map.{name}.tif")
                             for name in ("dem", "ortho", "views"))
        self.assertEqual((dem.nodata, views.nodata), ("-9999", "65535"))
        holes = 0
        for a, b, c in zip(dem.rows, ortho.rows, views.rows):
            for height, color, count in zip(a, b, c):
                self.assertEqual(height == -9999, count == 65535)
                if height == -9999:
                    holes += 1
                    self.assertEqual(color, (0, 0, 0, 0))
        self.assertEqual(holes, 40 * 16 // 2)


class WrongInput(MapTest):
    def test_one_line_that_names_the_fault(self):
        for expected, *arguments in (
                ("--ground-sample-distance -1: must be from 0", "--ground-sample-distance", "-1"),
                ("--ground-sample-distance nan", "--gsd", "nan"),
                ("--ground-sample-distance 1e-08: the map would have", "--gsd", "1e-8"),
                ("--gsd: is the same as --ground-sample-distance", "--gsd", "0.1",
                 "--ground-sample-distance", "0.1"),
                ("--image-noise -1: must be from 0", "--image-noise", "-1"),
                ("--image-noise 1e-200: must be from 1e-06", "--image-noise", "1e-200"),
                ("--up 0,0: must be three numbers X,Y,Z", "--up", "0,0"),
                ("--up 0,0,x: must be three numbers X,Y,Z", "--up", "0,0,x"),
                ("--up 0,0,0: is no direction", "--up", "0,0,0"),
                ("--up 0,0,-1: must be 0,0,1 with --epsg", "--up", "0,0,-1", "--epsg", "32631"),
                ("--epsg 4326: is no projected", "--epsg", "4326"),
                ("--epsg 99: is no coordinate reference system", "--epsg", "99"),
                ("--contours -1: must be from 0", "--contours", "-1"),
                ("--max-memory", "--max-memory", "20"),
                ("--output-file .: must be the name of a file", "-o", "."),
                ("none.ply: ", "-m", "none.ply"),
                ("housing", "--refractive")):
            self.refuses_and_keeps(expected, *self.map(*arguments))

    def test_wrong_meshes(self):
        vertices, faces = wall(cells=2)
        for expected, mesh in (("scene.ply: the mesh has no faces", (vertices, [])),
                               ("scene.ply: no photograph shows the mesh", wall(z=-DISTANCE)),
                               ("scene.ply: the mesh has no area", ([(0, 0, 1)] * 3, [(0, 1, 2)]))):
            write(self.mesh, mesh_ply(*mesh))
            self.refuses_and_keeps(expected, *self.map())

    def test_an_input_is_not_overwritten(self):
        write(self.path("work", "mesh.dem.tif"), read(self.mesh))
        self.refuses_and_keeps("--output-file", *self.map("-m", "mesh.dem.tif", "-o", "mesh"))

    def test_a_texture_of_an_obj_is_not_overwritten(self):
        self.succeeds("TextureMesh", "-i", self.scene, "-w", self.work, "-o", "textured",
                      "--export-type", "obj")
        os.rename(self.path("work", "textured0.png"), self.path("work", "scene_map.jpg"))
        mtl = self.path("work", "textured.mtl")
        write(mtl, read(mtl).decode().replace("textured0.png", "scene_map.jpg"))
        self.refuses_and_keeps("--output-file", *self.map("-m", "textured.obj"))

    def test_a_full_disk_leaves_the_old_maps(self):
        self.succeeds(*self.map())
        self.refuses_and_keeps("scene_map.", *self.map("--gsd", "0.001"), file_size_limit=100_000)

    def test_help(self):
        self.assertEqual(run("MapSurface").returncode, 1)
        self.assertEqual(run("MapSurface", "--help").returncode, 0)


if __name__ == "__main__":
    main()
