# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in UTM coordinates: every program gives the same result as near the origin."""

import itertools
import json
import math
import os
import pathlib
import re
import unittest.mock

import tiny_scene
from places import FAR, FAR_AND_ODD, move_mesh, move_model
from programs import ProgramTest, main, must, read, read_json, write
from readers import Ply, added, centres_of, points_of
from support import colmap_text
from worlds import CLOSEUP, ROUGH, Simulated, geo_offset, housing, lake

QUICK = ("--resolution-level", "1", "--min-resolution", "100", "--geometric-iters", "1")


def share_near(points, others, within):
    """The fraction of `points` that have one of `others` closer than `within`."""
    cells = {}  # of twice the distance, so that the points closer than `within` are in 8 cells at most
    cell = lambda c: math.floor(c / (2 * within))
    for point in others:
        cells.setdefault(tuple(map(cell, point)), []).append(point)

    def has_near(p):
        around = itertools.product(*({cell(c - within), cell(c + within)} for c in p))
        return any(math.dist(p, q) < within for place in around for q in cells.get(place, ()))

    return sum(map(has_near, points)) / len(points)


class BitForBit(ProgramTest):
    """Centres and points on a grid of 1/4096 m, cameras along the axes: the shift is exact."""

    def setUp(self):
        super().setUp()
        snap = lambda v: tuple(round(4096 * c) / 4096 for c in v)
        snapped = [(snap(x), views) for x, views in tiny_scene.sparse_points()]
        with (unittest.mock.patch.object(tiny_scene, "CENTRES", [snap(c) for c in tiny_scene.CENTRES]),
              unittest.mock.patch.object(tiny_scene, "sparse_points", lambda: snapped)):
            tiny_scene.write_colmap(self.path("near"))
        move_model(self.path("near", "sparse"), self.path("far", "sparse"), FAR)
        os.symlink(self.path("near", "images"), self.path("far", "images"))

    def densify(self, name, scene, *arguments):
        return self.succeeds("DensifyPointCloud", "-i", scene, "-w", self.path(name), "--resolution-level", "0",
                             "--min-resolution", "48", *arguments)

    def ply(self, *name):
        return Ply(read(self.path(*name)))

    def check_offset(self, *name):
        self.assertEqual(read_json(self.path(*name)), json.loads(geo_offset(*FAR)))

    def make(self, name):
        self.succeeds("InterfaceCOLMAP", "-i", self.path(name))
        return self.densify(name, "scene.mvs")

    def test_the_same_bytes(self):
        self.make("near")
        said = self.make("far").stdout
        self.assertNotIn("WARN", said.upper())
        self.assertFalse(os.path.exists(self.path("near", "scene.geo.json")))
        self.assertFalse(os.path.exists(self.path("near", "scene_dense.geo.json")))
        for name in ("scene.mvs", "scene_dense.mvs", "depth0000.dmap"):
            self.assertEqual(read(self.path("far", name)), read(self.path("near", name)), name)
        for name in ("scene.geo.json", "scene_dense.geo.json"):
            self.check_offset("far", name)
        near, far = (self.ply(name, "scene_dense.ply") for name in ("near", "far"))
        self.assertGreater(len(far.points), 500)
        self.assertEqual((near.header, near.body), (far.header, far.body))
        self.assertEqual((near.offset, far.offset), (None, FAR))

    def test_doubles_are_in_the_world(self):
        self.make("far")
        local = self.ply("far", "scene_dense.ply").places
        self.densify("far", "scene.mvs", "--output-precision", "double")
        cloud = self.ply("far", "scene_dense.ply")
        self.assertIsNone(cloud.offset)
        self.assertEqual(cloud.places, local)
        self.refuses("--output-precision half: must be one of float, double", "DensifyPointCloud",
                     "-i", self.path("far", "scene.mvs"), "--output-precision", "half")

    def test_a_dense_scene_again(self):
        self.make("far")
        self.densify("far", "scene_dense.mvs", "-o", "again.mvs")
        again, first = (self.ply("far", name) for name in ("again.ply", "scene_dense.ply"))
        self.assertEqual((again.header, again.offset, again.body), (first.header, first.offset, first.body))
        self.assertEqual(read(self.path("far", "again.geo.json")), read(self.path("far", "scene.geo.json")))

    def test_an_older_offset_goes(self):
        self.make("far")
        self.succeeds("InterfaceCOLMAP", "-i", self.path("near"), "-o", self.path("far", "scene.mvs"))
        self.assertFalse(os.path.exists(self.path("far", "scene.geo.json")))
        self.densify("far", "scene.mvs")
        self.assertFalse(os.path.exists(self.path("far", "scene_dense.geo.json")))
        self.assertIsNone(self.ply("far", "scene_dense.ply").offset)


class FarScene(Simulated):
    """The close-up scene at the origin and at two other places, with its cloud under water."""
    SCENE = ("--preset", "closeup", *ROUGH)
    SHIFTS = {"near": (0.0, 0.0, 0.0), "far": FAR, "odd": FAR_AND_ODD}

    @classmethod
    def make(cls, folder):
        super().make(folder)
        for name, shift in cls.SHIFTS.items():
            move_model(os.path.join(cls.truth, "sparse"), cls.at(name, "sparse"), shift)
            move_mesh(os.path.join(cls.truth, "mesh.ply"), cls.at(name, "mesh.ply"), shift)
            for said in (cls.imported(cls.at(name, "scene.mvs"), "water", model=cls.at(name)),
                         must("DensifyPointCloud", "-i", "scene.mvs", "-w", cls.at(name), "--refractive", *QUICK)):
                assert "resolution of only" not in said, said

    def back(self, name, places):
        """Places of the scene `name` in the frame of the scene near the origin."""
        shift = tuple(-c for c in self.SHIFTS[name])
        if isinstance(places, dict):
            return {key: added(place, shift) for key, place in places.items()}
        return [added(place, shift) for place in places]

    def same_places(self, found, wanted, within):
        self.assertEqual(found.keys(), wanted.keys())
        self.assertLess(max(math.dist(found[key], wanted[key]) for key in wanted), within)

    def evaluated(self, cloud, truth, *options):
        """The printed table, and the numbers of the JSON file."""
        result = self.succeeds(
            "EvaluateReconstruction", "-i", self.at(cloud), "-m", self.at(truth, "mesh.ply"), "--cameras",
            self.at(truth, "sparse"), *self.port("water"), "--tolerance", "0.002", "--samples", "10000", "--json",
            self.path("result.json"), *options, timeout=60)
        self.assertNotIn("resolution is only", result.stdout)
        return (re.findall(r"(?:points to|truth to|^2 +\d\.\d+ +\d\.).*", result.stdout, re.M),
                read_json(self.path("result.json")))

    def says_nearly_the_same(self, lines, others):
        """An odd shift changes the rounding of float and so the samples that are drawn. Numbers may
        differ by one unit of the last digit, or by 0.5 %."""
        for line, other in zip(lines, others):
            numbers = lambda text: [float(word) for word in text.split() if "." in word]
            for a, b in zip(numbers(line), numbers(other), strict=True):
                self.assertAlmostEqual(a, b, delta=max(0.00101, 0.005 * b), msg=(line, other))

    def test_the_same_cloud(self):
        """Equal up to the rounding of poses, which changes a cloud as much as a shift by 3 nm."""
        near = Ply(read(self.at("near", "scene_dense.ply"))).places
        self.assertGreater(len(near), 5000)
        for name in ("far", "odd"):
            moved = self.back(name, Ply(read(self.at(name, "scene_dense.ply"))).places)
            self.assertLess(abs(len(moved) - len(near)), 0.001 * len(near), name)
            self.assertGreater(share_near(moved, near, 1e-6), 0.5, name)  # the median point
            self.assertGreater(share_near(moved, near, 1e-3), 0.95, name)

    def test_evaluation_says_the_same(self):
        """Clouds are local with a geo_offset; the truth is in world coordinates in double."""
        table, numbers = self.evaluated("near/scene_dense.ply", "near")
        self.assertEqual(len(table), 3, table)
        for name in ("far", "odd"):
            result = self.evaluated(f"{name}/scene_dense.ply", name)[1]
            self.assertEqual(result["views"], 5)
            self.assertAlmostEqual(result["accuracy"]["mean"], numbers["accuracy"]["mean"], delta=2e-6)
            # The same cloud and truth at another place give the same digits.
            near = Ply(read(self.at("near", "scene_dense.ply")))
            offset = "comment geo_offset " + " ".join(map(repr, self.SHIFTS[name]))
            write(self.at(name, "moved.ply"), "\n".join(near.header[:2] + [offset] + near.header[2:]).encode()
                  + b"\nend_header\n" + near.body)
            moved = self.evaluated(f"{name}/moved.ply", name)[0]
            if name == "far":
                self.assertEqual(moved, table)
            self.says_nearly_the_same(moved, table)
        again = self.evaluated("far/moved.ply", "far", "--error-cloud", self.path("errors.ply"))
        self.assertEqual(again[0], table)
        self.assertEqual(Ply(read(self.path("errors.ply"))).offset, FAR)

    def test_a_mesh_is_evaluated_as_fast(self):
        table = self.evaluated("near/mesh.ply", "near")[0]
        for name in ("far", "odd"):
            self.says_nearly_the_same(self.evaluated(f"{name}/mesh.ply", name)[0], table)

    def test_alignment_goes_from_place_to_place(self):
        """--align centres moves a cloud at one place onto the truth at another place."""
        table = self.evaluated("near/scene_dense.ply", "near", "--align", "centres",
                               "--estimated", self.at("near", "sparse"))[1]["accuracy"]
        for cloud, truth in (("far", "near"), ("near", "odd"), ("odd", "far"), ("odd", "odd")):
            result = self.evaluated(f"{cloud}/scene_dense.ply", truth, "--align", "centres",
                                    "--estimated", self.at(cloud, "sparse"))[1]
            self.assertAlmostEqual(result["accuracy"]["mean"], table["mean"], delta=2e-6)
            self.assertLess(result["align"]["rms_residual"], 1e-8)
            # The transform maps world to world, so the image of a point near the cloud is known.
            rows = result["align"]["transform"]
            source = added(self.SHIFTS[cloud], (0.1, 0.2, 0.3))
            moved = [math.fsum([*(a * b for a, b in zip(row, source)), row[3]]) for row in rows[:3]]
            wanted = added(self.SHIFTS[truth], (0.1, 0.2, 0.3))
            self.assertLess(math.dist(moved, wanted), 1e-6, (cloud, truth))
        icp = self.evaluated("odd/scene_dense.ply", "odd", "--align", "icp", "--aligned",
                             self.path("aligned.ply"))[1]
        self.assertTrue(icp["align"]["converged"])
        offset = Ply(read(self.path("aligned.ply"))).offset
        self.assertEqual([x % 10 for x in offset], [0, 0, 0])
        self.assertLess(math.dist(offset, FAR_AND_ODD), 15)

    def test_float_truth_is_said_to_be_coarse(self):
        move_mesh(self.at("near", "mesh.ply"), self.path("coarse.ply"), FAR, "float")
        result = self.succeeds("EvaluateReconstruction", "-i", self.at("far", "scene_dense.ply"),
                               "-m", self.path("coarse.ply"), "--samples", "100")
        self.assertIn("coarse.ply: its coordinates are float32 values of about 3378", result.stdout +
                      result.stderr)

    def test_refined_poses(self):
        """The same model at every place, after the same number of iterations, give or take one."""
        centres = centres_of(self.at("near", "sparse"))
        first, *_, last = sorted(centres)
        known = f"images:{first},{last},{math.dist(centres[first], centres[last])!r}"
        models = {}
        for name in self.SHIFTS:
            said = self.refined(name, self.path(name), known, "-v", "3")
            self.assertNotIn("Not converged", said)
            report = read_json(self.path(name, "report.json"))
            sparse = self.path(name, "sparse")
            models[name] = (*(self.back(name, read_places(sparse)) for read_places in (centres_of, points_of)),
                            report["rms_after_px"], [int(n) for n in re.findall(r"(\d+) iterations", said)])
        near = models["near"]
        for name in ("far", "odd"):
            *places, rms, iterations = models[name]
            for a, b in zip(iterations, near[3], strict=True):
                self.assertLessEqual(abs(a - b), 1, (iterations, near[3]))
            self.assertAlmostEqual(rms, near[2], delta=1e-6)
            for found, wanted in zip(places, near):
                self.same_places(found, wanted, 1e-6)

    def refined(self, model, out, scale, *more):
        few = self.path("few", model)
        colmap_text.copy(pathlib.Path(self.at(model, "sparse")), pathlib.Path(few), lambda number: number % 32 == 0)
        return self.succeeds("RefinePoses", "-i", few, "--lens", os.path.join(self.truth, "sparse"),
                             *self.port("water"), "-o", out, "--scale-from", scale, *more).stdout

    def test_known_positions_place_a_model(self):
        """A model at any place is moved to the positions of a survey."""
        results = {}
        for name in ("near", "far"):
            survey = "".join(f"{image} {x!r} {y!r} {z!r}\n" for image, (x, y, z) in
                             centres_of(self.at(name, "sparse")).items())
            write(self.path(name + ".txt"), survey)
        for model, place in (("near", "near"), ("near", "far"), ("far", "far"), ("far", "near")):
            out = self.path(model + "-to-" + place)
            self.refined(model, out, "positions:" + self.path(place + ".txt"))
            results[model, place] = self.back(place, centres_of(os.path.join(out, "sparse")))
        for centres in results.values():
            self.same_places(centres, results["near", "near"], 1e-6)

    def test_aligned_models(self):
        for model, place in (("near", "odd"), ("odd", "near"), ("far", "odd")):
            out = self.path(model + "-to-" + place)
            said = self.succeeds("AlignModel", "-i", self.at(model, "sparse"), "--reference",
                                 self.at(place, "sparse"), "-o", out).stdout
            self.assertIn("RMS 0.000 mm, largest 0.000 mm", said)
            for read_places in (centres_of, points_of):
                self.same_places(read_places(out), read_places(self.at(place, "sparse")), 1e-8)


class WaterSurface(Simulated):
    """A housing file gives the water surface in world coordinates. It moves with the scene."""
    SCENE = CLOSEUP

    def test_the_same_ports(self):
        sparse = os.path.join(self.truth, "sparse")
        lowest = min(c[2] for c in centres_of(sparse).values()) - 0.1
        for name, shift in (("near", (0, 0, 0)), ("odd", FAR_AND_ODD)):
            move_model(sparse, self.path(name, "sparse"), shift)
            surface = lake(added((0, 0, lowest), shift), (0.1, 0, -1))
            write(self.path(name, "lake.json"), housing(surface))
            self.imported(self.path(name, "scene.mvs"), "air", model=self.path(name),
                          port=("--housing", self.path(name, "lake.json")))
            self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(name), "--refractive",
                          "--fusion-mode", "1", "--resolution-level", "1", "--min-resolution", "100",
                          "--geometric-iters", "0")
            written = read_json(self.path(name, "scene_dense.housing.json"))
            for a, b in zip(written["ports"]["main"]["point_m"], surface["point_m"]):
                self.assertAlmostEqual(a, b, delta=1e-9)
        sides = [read_json(self.path(name, "depth0000.dmap.json"))["port"] for name in ("near", "odd")]
        self.assertAlmostEqual(sides[0]["distance_m"], sides[1]["distance_m"], delta=1e-7)
        self.assertGreater(sides[0]["distance_m"], 0.05)


if __name__ == "__main__":
    main()
