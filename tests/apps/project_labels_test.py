# SPDX-License-Identifier: GPL-3.0-or-later
"""ProjectLabels on the wall of tiny_scene.py, in air and behind a port: both directions, wrong input."""

import contextlib
import json
import os
import shutil
import sqlite3

from programs import files_below, main, write
from readers import png_rows, png_size
from tiny_scene import CENTRES, CX, CY, DISTANCE, FOCAL, HEIGHT, WIDTH, names
from worlds import Wall, housing

# The map's heights are the world's -z, so that its y is the world's -y.
PLOT = [(-0.1, -0.12), (0.08, -0.12), (0.08, 0.05), (-0.1, 0.05)]  # on the wall [world]


def shape(kind, coordinates, **properties):
    return {"type": "Feature", "properties": properties, "geometry": {"type": kind, "coordinates": coordinates}}


def features(*found):
    return json.dumps({"type": "FeatureCollection", "features": found})


def ring(corners):
    places = [[x, -y] for x, y in corners]
    return [[*places, places[0]]]


def pixel(x, y, centre):
    """In COCO's coordinates, in air."""
    return FOCAL * (x - centre[0]) / DISTANCE + CX, FOCAL * (y - centre[1]) / DISTANCE + CY


def coco(*, file_name="0001.png", width=WIDTH, height=HEIGHT, **annotation):
    return json.dumps({"images": [{"id": 7, "file_name": file_name, "width": width, "height": height}],
                       "categories": [{"id": 3, "name": "coral"}],
                       "annotations": [{"id": 1, "image_id": 7, "category_id": 3, **annotation}]})


class LabelsTest(Wall):
    def setUp(self):
        super().setUp()
        write(self.path("work", "plots.geojson"),
              features(shape("Polygon", ring(PLOT), name="plot", **{"class": "coral"}),
                       shape("Point", [0.02, 0.1], name="dot", **{"class": "alga"}),
                       shape("Polygon", ring([(5, 5), (6, 5), (6, 6)]), name="far", **{"class": "anemone"})))

    def project(self, direction, labels, *more, up=("--up", "0,0,-1")):
        return self.command("ProjectLabels", "--" + direction, labels, *up, "-o", "out", *more)

    def annotations(self, category):
        """The annotations of out.json with a category, by the name of the photograph."""
        found = json.loads(self.at("out.json"))
        images = {image["id"]: image["file_name"] for image in found["images"]}
        ids = {entry["name"]: entry["id"] for entry in found["categories"]}
        return {images[entry["image_id"]]: entry for entry in found["annotations"]
                if entry["category_id"] == ids[category]}

    def features(self):
        return json.loads(self.at("out.geojson"))["features"]


class ToPhotographs(LabelsTest):
    def test_labels_lie_where_the_photographs_show_them(self):
        made, said = self.makes(*self.project("from-map", "plots.geojson"))
        self.assertEqual(made, {"out.json"})
        self.assertIn("label 'far': the mesh has no surface there", said)
        self.assertIn("2 of 3 labels are in 3 of 3 photographs", said)
        self.assertEqual([(entry["id"], entry["name"]) for entry in json.loads(self.at("out.json"))["categories"]],
                         [(1, "alga"), (2, "anemone"), (3, "coral")])  # also the class that nobody sees
        polygons, points = self.annotations("coral"), self.annotations("alga")
        self.assertEqual(set(polygons), set(names()))
        for name, centre in zip(names(), CENTRES):
            entry, corners = polygons[name], [pixel(x, y, centre) for x, y in PLOT]
            left, top, width, height = entry["bbox"]
            # Sides are found up to 1/128 px, and straight lines leave out 1/50 px.
            for value, expected in ((left, corners[0][0]), (top, corners[0][1]), (left + width, corners[2][0]),
                                    (top + height, corners[2][1])):
                self.assertAlmostEqual(value, expected, delta=0.04)
            self.assertAlmostEqual(entry["area"], width * height, delta=1)
            self.assertEqual((entry["iscrowd"], entry["attributes"]), (0, {"name": "plot"}))
            x, y, visible = points[name]["keypoints"]
            self.assertEqual(visible, 2)
            for value, expected in zip((x, y), pixel(0.02, -0.1, centre)):
                self.assertAlmostEqual(value, expected, delta=0.011)

    def test_masks_have_the_ids_of_the_categories(self):
        self.succeeds(*self.project("from-map", "plots.geojson", "--masks", "masks"))
        self.assertEqual(files_below(self.path("work", "masks")), {name + ".png" for name in names()})
        ids = {entry["name"]: entry["id"] for entry in json.loads(self.at("out.json"))["categories"]}
        for name, centre in zip(names(), CENTRES):
            mask = self.at("masks", name + ".png")
            self.assertEqual(png_size(mask), (WIDTH, HEIGHT))
            low, high = pixel(*PLOT[0], centre), pixel(*PLOT[2], centre)
            for v, row in enumerate(png_rows(mask)[0]):
                for u, value in enumerate(row):
                    inside = low[0] < u + 0.5 < high[0] and low[1] < v + 0.5 < high[1]
                    self.assertEqual(value, ids["coral"] if inside else 0, (u, v))

    def test_the_same_input_gives_the_same_bytes(self):
        self.succeeds(*self.project("from-map", "plots.geojson"))
        first = self.at("out.json")
        self.succeeds(*self.project("from-map", "plots.geojson", "--max-threads", "1"))
        self.assertEqual(self.at("out.json"), first)

    def test_the_class_may_be_in_any_field(self):
        write(self.path("work", "a.geojson"), features(shape("Polygon", ring(PLOT), Taxon="Acropora", name="1")))
        self.succeeds(*self.project("from-map", "a.geojson", "--class-field", "taxon"))
        self.assertEqual(json.loads(self.at("out.json"))["categories"][0]["name"], "Acropora")
        self.refuses("has no field 'genus'", *self.project("from-map", "a.geojson", "--class-field", "genus"))


class ToMap(LabelsTest):
    def test_labels_come_back_to_the_map(self):
        for port in ("", housing()):
            with self.subTest(port=bool(port)):
                write(self.path("work", "port.json"), port)
                more = ("--housing", "port.json") if port else ()
                self.succeeds(*self.project("from-map", "plots.geojson", *more))
                shutil.move(self.path("work", "out.json"), self.path("work", "seen.json"))
                said = self.succeeds(*self.project("from-photographs", "seen.json", *more)).stdout
                self.assertIn("6 of 6 labels are on the map", said)
                self.expect_plots()

    def expect_plots(self):
        half = 0.5 * DISTANCE / FOCAL  # sides are found up to rounded pixels, twice
        polygons = [one for one in self.features() if one["geometry"]["type"] == "MultiPolygon"]
        self.assertEqual({one["properties"]["photograph"] for one in polygons}, set(names()))
        for one in polygons:
            self.assertEqual((one["properties"]["name"], one["properties"]["class"]), ("plot", "coral"))
            (corners,), = one["geometry"]["coordinates"]
            for axis, low, high in ((0, -0.1, 0.08), (1, -0.05, 0.12)):
                values = [corner[axis] for corner in corners]
                self.assertAlmostEqual(min(values), low, delta=half)
                self.assertAlmostEqual(max(values), high, delta=half)
            self.assertEqual({corner[2] for corner in corners}, {-DISTANCE})
        points = [one["geometry"]["coordinates"][0] for one in self.features() if one not in polygons]
        self.assertEqual(len(points), 3)
        for x, y, z in points:
            for value, expected in ((x, 0.02), (y, 0.1), (z, -DISTANCE)):
                self.assertAlmostEqual(value, expected, delta=0.01 * DISTANCE / FOCAL + 1e-4)  # rounded pixels

    def test_a_polygon_that_was_drawn_by_hand(self):
        corners = [pixel(x, y, CENTRES[1]) for x, y in PLOT]
        write(self.path("work", "drawn.json"), coco(segmentation=[[value for corner in corners for value in corner]]))
        self.succeeds(*self.command("MapSurface", "--up", "0,0,-1"))
        made, _ = self.makes(*self.project("from-photographs", "drawn.json", up=("--map", "scene_map.dem.tif")))
        self.assertEqual(made, {"out.geojson", "out.gpkg"})
        (one,) = self.features()
        self.assertEqual(one["properties"], {"name": "coral", "class": "coral", "photograph": "0001.png"})
        with contextlib.closing(sqlite3.connect(self.path("work", "out.gpkg"))) as table:
            self.assertEqual(table.execute("SELECT class, photograph FROM polygons").fetchall(),
                             [("coral", "0001.png")])
        for labels in ("out.geojson", "out.gpkg"):
            self.succeeds(*self.project("from-map", labels))
            left, top, width, height = self.annotations("coral")["0001.png"]["bbox"]
            for value, expected in ((left, corners[0][0]), (top, corners[0][1]), (left + width, corners[2][0]),
                                    (top + height, corners[2][1])):
                self.assertAlmostEqual(value, expected, delta=0.3)

    def test_polygons_of_one_object_are_united(self):
        """The left part of a plot is drawn in a photograph, and its right part in another one."""
        (left, low), (right, high) = PLOT[0], PLOT[2]
        images, annotations = [], []
        for number, (begin, end, name) in enumerate(((left, 0.02, "one"), (-0.03, right, "one"), (left, right, "two"))):
            images.append({"id": number, "file_name": names()[number], "width": WIDTH, "height": HEIGHT})
            corners = [pixel(x, y, CENTRES[number]) for x, y in ((begin, low), (end, low), (end, high), (begin, high))]
            annotations.append({"id": number, "image_id": number, "category_id": 3, "attributes": {"name": name},
                                "segmentation": [[value for corner in corners for value in corner]]})
        write(self.path("work", "drawn.json"), json.dumps(
            {"images": images, "annotations": annotations, "categories": [{"id": 3, "name": "coral"}]}))
        half = 0.5 * DISTANCE / FOCAL
        for join, joined in (("name", 2), ("overlap", 1)):
            said = self.succeeds(*self.project("from-photographs", "drawn.json", "--join", join)).stdout
            self.assertIn(f"3 labels of photographs are {joined} on the map", said)
            found = self.features()
            self.assertEqual(len(found), joined)
            self.assertEqual(found[0]["properties"]["photograph"], "; ".join(names()[:4 - joined]))
            (corners, *_), = found[0]["geometry"]["coordinates"]
            for axis, least, most in ((0, left, right), (1, -high, -low)):
                values = [corner[axis] for corner in corners]
                self.assertAlmostEqual(min(values), least, delta=half)
                self.assertAlmostEqual(max(values), most, delta=half)
            self.assertEqual({corner[2] for corner in corners}, {-DISTANCE})
        self.refuses("--join-overlap is only for --join overlap",
                     *self.project("from-photographs", "drawn.json", "--join", "name", "--join-overlap", "30"))

    def test_the_geopackage_has_a_layer_for_each_shape_and_is_read(self):
        self.succeeds(*self.project("from-map", "plots.geojson"))
        shutil.move(self.path("work", "out.json"), self.path("work", "seen.json"))
        self.succeeds(*self.project("from-photographs", "seen.json"))
        said = self.succeeds(*self.project("from-map", "out.gpkg")).stdout
        self.assertIn("6 of 6 labels are in 3 of 3 photographs", said)
        self.assertEqual(set(self.annotations("coral")), set(names()))
        self.assertEqual(set(self.annotations("alga")), set(names()))


class Errors(LabelsTest):
    def test_wrong_input_is_named_and_writes_nothing(self):
        inside = [10, 10, 60, 10, 60, 50]
        write(self.path("work", "away.geojson"), features(shape("Point", [50, 50])))
        write(self.path("work", "line.geojson"), features(shape("LineString", [[0, 0], [0.1, 0.1]])))
        for name, text in (("size", coco(width=50, segmentation=[inside])),
                           ("other", coco(file_name="no.png", segmentation=[inside])),
                           ("odd", coco(segmentation=[inside[1:]])), ("box", coco(bbox=[1, 1, 9, 9])),
                           ("text", "{}")):
            write(self.path("work", name + ".json"), text)
        before = files_below(self.work)
        for direction, labels, expected in (
                ("from-map", "away.geojson", "has no surface at any label"),
                ("from-map", "line.geojson", "has no layer with polygons or points"),
                ("from-map", "none.gpkg", "none.gpkg: "),
                ("from-photographs", "size.json", "it is 50 x 72 px, but the photograph is 96 x 72"),
                ("from-photographs", "other.json", "no photograph of the scene is named no.png"),
                ("from-photographs", "odd.json", "odd.json: annotations[0].segmentation[0] is [10,60,10,60,50], expected x, y, ... of three"),
                ("from-photographs", "box.json", "has neither polygon nor key point"),
                ("from-photographs", "text.json", "is no COCO file")):
            self.refuses(expected, *self.project(direction, labels))
        self.refuses("give either --from-map or --from-photographs", *self.command("ProjectLabels"))
        self.refuses("--masks is only for --from-map", *self.project("from-photographs", "size.json", "--masks", "m"))
        self.refuses("--least-part is only for --from-photographs",
                     *self.project("from-map", "plots.geojson", "--least-part", "1"))
        self.refuses("contradicts --map", *self.project("from-map", "plots.geojson", "--map", "plots.geojson"))
        os.rename(self.path("work", "size.json"), self.path("work", "out.json"))
        self.refuses("--output-file", *self.project("from-map", "out.json"))
        self.assertEqual(files_below(self.work) ^ before, {"size.json", "out.json"})


if __name__ == "__main__":
    main()
