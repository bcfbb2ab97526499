# SPDX-License-Identifier: GPL-3.0-or-later
"""MapSurface on the wall of tiny_scene.py: names of files, heights, colours, coordinates, wrong
input."""

import os
import re
from xml.etree import ElementTree

from geotiff import read_geotiff
from programs import contents, files_below, main, read, write
from tiny_scene import DISTANCE, texture
from worlds import Wall, geo_offset, turned, wall

MAPS = {"scene_map.dem.tif", "scene_map.ortho.tif", "scene_map.views.tif", "scene_map.sigma.tif", "scene_map.jpg"}


class MapTest(Wall):
    def map(self, *arguments):
        return self.command("MapSurface", *arguments)

    def read_map(self, name):
        return read_geotiff(self.at(f"scene_map.{name}.tif"))

    def maps(self):
        return {name: self.at(name) for name in MAPS}

    def nearly_equal(self, rows, others):
        """Colours differ by at most 1: textures are cut out of the photographs at other places."""
        self.assertLessEqual(max(abs(a - b) for r, s in zip(rows, others) for p, q in zip(r, s)
                                 for a, b in zip(p, q)), 1)


class Files(MapTest):
    def test_names(self):
        self.assertEqual(self.makes(*self.map())[0], MAPS)
        self.succeeds(*self.map("-o", "new/a.v2", "--hillshade", "--contours", "0.1"))
        ends = ("dem.tif", "ortho.tif", "views.tif", "sigma.tif", "hillshade.tif", "contours.geojson", "contours.gpkg",
                "contours.dxf", "jpg")
        self.assertLess({"new/a.v2." + end for end in ends}, files_below(self.work))

    def test_without_image_noise_there_are_no_expected_errors(self):
        self.assertEqual(self.makes(*self.map("--image-noise", "0"))[0], MAPS - {"scene_map.sigma.tif"})

    def test_a_textured_mesh_gives_the_same_maps(self):
        self.succeeds(*self.map())
        plain = self.maps()
        self.succeeds(*self.command("TextureMesh", "-o", "textured"))
        self.succeeds(*self.map("-m", "textured.ply"))
        for name in ("scene_map.dem.tif", "scene_map.views.tif", "scene_map.sigma.tif"):
            self.assertEqual(self.at(name), plain[name], name)
        self.nearly_equal(read_geotiff(plain["scene_map.ortho.tif"]).rows, self.read_map("ortho").rows)

    def test_colours_of_another_folder(self):
        self.put_restored()
        self.succeeds(*self.map())
        heights = self.at("scene_map.dem.tif")
        told = "--colors: without effect on a mesh that has textures"
        self.assertNotIn(told, self.succeeds(*self.map("--colors", "restored")).stdout)
        self.assertEqual(self.at("scene_map.dem.tif"), heights)
        shown = {pixel[:3] for row in self.read_map("ortho").rows for pixel in row if pixel[3]}
        self.assertGreater(len(shown), 50)
        self.assertEqual({color[1:] for color in shown}, {(0, 0)})
        self.succeeds(*self.command("TextureMesh", "-o", "textured"))
        self.assertIn(told, self.succeeds(*self.map("-m", "textured.ply", "--colors", "none")).stdout)


class Copies(MapTest):
    """Copies of the wall's map, which has 55 columns of 0.011 m, and profiles."""
    LINE = ('{"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {"name": "a"}, "geometry": '
            '{"type": "LineString", "coordinates": [[-0.2, 0], [0.2, 0.1]]}}]}')

    def copies(self, *arguments):
        """The files of a run besides those of a run without options."""
        self.succeeds(*self.map(*arguments))
        return {name.removeprefix("scene_map.") for name in set(contents(self.work)) - self.before - MAPS}

    def setUp(self):
        super().setUp()
        self.before = set(contents(self.work))

    def test_copies_of_an_earlier_run_are_removed_and_no_other_file(self):
        self.assertEqual(self.copies("--preset", "taglab", "--widths", "40,20"),
                         {f"taglab.{name}{width}.tif" for name in ("dem", "ortho") for width in ("", "_40", "_20")})
        copy = self.at("scene_map.taglab.dem.tif")
        archive = {f"archive.{name}.{end}" for name in ("dem", "ortho", "views", "sigma") for end in ("tif", "tfw")}
        self.assertEqual(self.copies("--preset", "archive"), archive | {"archive.xml"})
        self.assertEqual(self.copies("--widths", "40"), {"dem_40.tif", "ortho_40.tif"})
        # A copy of another map, and a map of another program.
        write(self.path("work", "other.taglab.dem.tif"), copy)
        write(self.path("work", "scene_map.taglab.old.tif"), self.at("scene_map.dem.tif"))
        self.assertEqual(self.copies(), {"other.taglab.dem.tif", "taglab.old.tif"})

    def test_copies_of_a_map_whose_name_goes_on_are_kept(self):
        self.succeeds(*self.map("-o", "scene_map.v2", "--preset", "taglab"))
        self.assertLessEqual({"v2.taglab.dem.tif", "v2.taglab.ortho.tif"}, self.copies())

    def test_other_widths(self):
        self.succeeds(*self.map("--widths", "11"))
        whole, copy = self.read_map("dem"), self.read_map("dem_11")
        self.assertEqual(len(copy.rows[0]), 11)
        self.assertAlmostEqual(copy.pixel * 11, whole.pixel * len(whole.rows[0]))
        self.assertAlmostEqual(copy.rows[5][5], -DISTANCE, 6)

    def test_the_description_of_an_archive(self):
        self.succeeds(*self.map("--preset", "archive"))
        root = ElementTree.fromstring(self.at("scene_map.archive.xml"))
        self.assertEqual(root.findtext("title"), "scene")
        self.assertEqual(root.findtext("spatialResolution"), "0.011")
        self.assertEqual([one.text for one in root.iter("source")], ["scene.mvs", "scene.ply"])
        self.assertLess(0, float(root.findtext("expectedHeightError/rms")))
        for name in root.iter("file"):
            self.at(name.text)

    def test_profiles(self):
        write(self.path("work", "lines.geojson"), self.LINE)
        self.assertEqual(self.copies("--profiles", self.path("work", "lines.geojson")),
                         {"lines.geojson", "profiles.csv", "profiles.gpkg", "profiles.dxf"})
        head, *rows = self.at("scene_map.profiles.csv").decode().splitlines()
        self.assertEqual(head, "profile,distance_m,x,y,height_m")
        self.assertEqual(len(rows), 39)  # 0.4123 m / 0.011 m, and both ends
        self.assertEqual(rows[-1], f"a,0.4123,0.2000,0.1000,{-DISTANCE:.4f}")
        self.assertEqual(self.copies(), {"lines.geojson"})

    def test_profiles_and_widths_that_do_not_fit(self):
        lines = self.path("work", "lines.geojson")
        write(lines, self.LINE.replace("0.2, 0.1", "20, 0.1"))
        write(self.path("work", "text.geojson"), "no lines")
        self.refuses_each(
                self.map(),
                ("lines.geojson: line 'a' is not on the map at (20.000, 0.100)", "--profiles", lines),
                ("text.geojson: cannot be read", "--profiles", self.path("work", "text.geojson")),
                ("none.geojson: cannot be read: it does not exist", "--profiles", "none.geojson"),
                ("--widths 5600: the map has ", "--widths", "40,5600"),
                ("--widths 40,x: must be numbers of pixels", "--widths", "40,x"),
                ("--widths 40,40: has 40 twice", "--widths", "40,40"),
                ("--preset geo: must be one of gis, taglab, archive", "--preset", "geo"))


class Pixels(MapTest):
    """The cameras look along z, so that the map's plane has the upward direction -z, and the map's
    axes are x and -y of the world."""

    def test_heights_and_colours_are_those_of_the_wall(self):
        said = self.succeeds(*self.map()).stdout
        self.assertIn("map's x: 1.0000 0.0000 0.0000, y: 0.0000 -1.0000 0.0000, up: 0.0000 0.0000 -1.0000",
                      re.sub(r"-(0\.0000)", r"\1", said))
        dem, ortho, views = (self.read_map(name) for name in ("dem", "ortho", "views"))
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

    def test_the_length_of_up_has_no_effect(self):
        found = set()
        for up in ("0,0,-1", "0,0,-1e300", "0,0,-1e-300"):
            self.succeeds(*self.map("--up", up))
            found.add(self.at("scene_map.dem.tif"))
        self.assertEqual(len(found), 1)

    def test_utm(self):
        write(self.path("work", "scene.geo.json"), geo_offset(500000, 4500000, 30))
        self.put(*wall(), comments="comment geo_offset 500000 4500000 30\n")
        self.succeeds(*self.map("--gsd", "0.0125", "--epsg", "32631"))
        for name in ("dem", "ortho", "views"):
            found = self.read_map(name)
            self.assertAlmostEqual(found.left, 499999.7, 6)
            self.assertAlmostEqual(found.top, 4500000.3, 6)
            self.assertEqual((len(found.rows), len(found.rows[0])), (48, 48))
            self.assertIn(32631, found.keys)
        self.assertEqual(self.read_map("dem").rows[20][20], 30 + DISTANCE)


def face_at(x, y, z, first, side=0.2):
    """The vertices of a face, and the face as the vertices from number `first` on."""
    return ([(x, y, z), (x, y + side, z), (x + side, y, z)], (first, first + 1, first + 2))


class UpAndDown(MapTest):
    """The side that the cameras see is the upper one."""

    def test_a_mesh_that_is_inside_out_gives_the_same_map(self):
        said = self.succeeds(*self.map()).stdout
        self.assertNotIn("warning", said)
        plain = {name: self.read_map(name) for name in ("dem", "views", "sigma", "ortho")}
        vertices, faces = wall()
        self.put(vertices, turned(faces))
        said = self.succeeds(*self.map()).stdout
        self.assertIn("warning: " + self.mesh + ": the mesh is inside out: the cameras see 100 % of its faces from "
                      "behind; flip the faces in an editor", said)
        for name, expected in plain.items():
            found = self.read_map(name)
            if name != "ortho":
                self.assertEqual(found.rows, expected.rows, name)
            else:
                self.nearly_equal(found.rows, expected.rows)

    def test_a_textured_mesh_that_is_inside_out(self):
        self.succeeds(*self.command("TextureMesh", "-o", "textured"))
        self.succeeds(*self.map("-m", "textured.ply"))
        plain = self.maps()
        head, body = self.at("textured.ply").split(b"end_header\n")
        vertices = int(re.search(rb"element vertex (\d+)", head)[1])
        size = (len(body) - 12 * vertices) // int(re.search(rb"element face (\d+)", head)[1])
        flipped = body[:12 * vertices]
        for at in range(12 * vertices, len(body), size):  # count, 3 corners, count, 3 places in the texture
            face = body[at:at + size]
            flipped += (face[:1] + face[1:5] + face[9:13] + face[5:9] + face[13:14] + face[14:22] +
                        face[30:38] + face[22:30] + face[38:])
        write(self.path("work", "textured.ply"), head + b"end_header\n" + flipped)
        self.assertIn("the mesh is inside out", self.succeeds(*self.map("-m", "textured.ply")).stdout)
        self.assertEqual(self.maps(), plain)

    def test_up_that_points_away_from_the_cameras_is_refused(self):
        for arguments in ((), ("--gsd", "0.0125")):
            self.refuses_and_keeps("--up 0,0,1: points away from the cameras, so that the map would show the far "
                                   "side of the surface; give --up 0,0,-1", *self.map("--up", "0,0,1", *arguments))
        self.refuses_and_keeps("give --up -0.1,0,-1", *self.map("--up", "0.2,0,2"))
        # Along the wall, both sides are as good as each other.
        self.succeeds(*self.map("--up", "0,-1,0.1"))

    def test_cameras_below_the_surface_are_told(self):
        """As with depths in place of heights."""
        told = "warning: " + self.scene + ": the cameras are below the surface that they see"
        said = self.succeeds(*self.map("--epsg", "32631")).stdout
        self.assertIn(told, said)
        self.assertIn("depths, positive downwards, or do they state northing before easting?", said)
        self.assertNotIn(told, self.succeeds(*self.map()).stdout)


class FarFaces(MapTest):
    """Parts of the mesh far away, which an editor or another program has left."""

    def setUp(self):
        super().setUp()
        self.succeeds(*self.map())
        self.plain = self.maps()

    def check_same_maps(self, vertices, faces):
        self.put(vertices, faces)
        said = self.succeeds(*self.map()).stdout
        self.assertEqual(self.maps(), self.plain)
        return said

    def test_a_face_that_no_camera_sees(self):
        vertices, faces = wall()
        corners, face = face_at(1000, 0, 1, len(vertices))
        said = self.check_same_maps(vertices + corners, faces + [face])
        self.assertIn("warning: " + self.mesh + ": 1 of 289 faces are left out: no camera sees them", said)

    def test_a_face_far_away_that_cameras_see(self):
        """It does not tilt the map. A map of it, far larger than the photographs, is refused."""
        vertices, faces = wall()
        corners, face = face_at(80, 60, 200, len(vertices), side=0.05)
        self.put(vertices + corners, faces + [face])
        self.refuses_and_keeps(f"{self.mesh}: the map would have 7306 x 5488 pixels of 0.011 m", *self.map())
        said = self.succeeds(*self.map("--gsd", "0.1")).stdout
        self.assertIn("up: 0.0000 0.0000 -1.0000", re.sub(r"-(0\.0000)", r"\1", said))


class WrongInput(MapTest):
    def test_one_line_that_names_the_fault(self):
        self.refuses_each(
                self.map(),
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
                ("housing", "--refractive"))

    def test_a_mesh_without_area(self):
        self.put([(0, 0, 1)] * 3, [(0, 1, 2)])
        self.refuses_and_keeps("scene.ply: the mesh has no area", *self.map())

    def test_a_texture_of_an_obj_is_not_overwritten(self):
        self.succeeds(*self.command("TextureMesh", "-o", "textured", "--export-type", "obj"))
        os.rename(self.path("work", "textured_material_0_map_Kd.png"), self.path("work", "scene_map.jpg"))
        mtl = self.path("work", "textured.mtl")
        write(mtl, read(mtl).decode().replace("textured_material_0_map_Kd.png", "scene_map.jpg"))
        self.refuses_and_keeps("--output-file", *self.map("-m", "textured.obj"))

    def test_contours_on_a_full_disk(self):
        self.assertRegex(self.refuses("scene_map.", *self.map("--contours", "0.000002", "--up", "0,0.01,-1"),
                                      file_size_limit=100_000).stderr,
                         r"scene_map\.contours\.geojson: cannot be written: only a part of it was written: "
                         r"is the disk full\?\n$")


if __name__ == "__main__":
    main()
