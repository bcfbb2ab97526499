# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes in UTM coordinates: every program gives the same result as near the origin."""

import json
import math
import os
import re
import struct
import tempfile

import tiny_scene
from places import (FAR, FAR_AND_ODD, added, centres_of, move_mesh, move_model, points_of, positions,
                    split_ply)
from programs import ProgramTest, cloud_size, main, read, run, write

QUICK = ("--resolution-level", "1", "--min-resolution", "100", "--geometric-iters", "1")


def share_near(points, others, within):
    """The fraction of `points` that have one of `others` closer than `within`."""
    cells = {}
    key = lambda p: tuple(math.floor(c / within) for c in p)
    for point in others:
        cells.setdefault(key(point), []).append(point)
    around = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
    near = sum(any(math.dist(p, q) < within for d in around
                   for q in cells.get(added(key(p), d), ())) for p in points)
    return near / len(points)


class BitForBit(ProgramTest):
    """Centres and points on a grid of 1/4096 m, cameras along the axes: the shift is exact."""

    def setUp(self):
        super().setUp()
        snap = lambda v: tuple(round(4096 * c) / 4096 for c in v)
        before = tiny_scene.CENTRES, tiny_scene.sparse_points
        snapped = [(snap(x), views) for x, views in tiny_scene.sparse_points()]
        tiny_scene.CENTRES = [snap(c) for c in before[0]]
        tiny_scene.sparse_points = lambda: snapped
        try:
            tiny_scene.write_colmap(self.path("near"))
        finally:
            tiny_scene.CENTRES, tiny_scene.sparse_points = before
        move_model(self.path("near", "sparse"), self.path("far", "sparse"), FAR)
        os.symlink(self.path("near", "images"), self.path("far", "images"))

    def make(self, name):
        self.succeeds("InterfaceCOLMAP", "-i", self.path(name))
        return self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(name),
                             "--resolution-level", "0", "--min-resolution", "48")

    def test_the_same_bytes(self):
        self.make("near")
        said = self.make("far").stdout
        self.assertNotIn("WARN", said.upper())
        self.assertFalse(os.path.exists(self.path("near", "scene.geo.json")))
        self.assertFalse(os.path.exists(self.path("near", "scene_dense.geo.json")))
        for name in ("scene.mvs", "scene_dense.mvs", "depth0000.dmap"):
            self.assertEqual(read(self.path("far", name)), read(self.path("near", name)), name)
        for name in ("scene.geo.json", "scene_dense.geo.json"):
            self.assertEqual(json.loads(read(self.path("far", name))),
                             {"version": 1, "geo_offset": list(FAR)})
        near = split_ply(read(self.path("near", "scene_dense.ply")))
        far = split_ply(read(self.path("far", "scene_dense.ply")))
        self.assertGreater(cloud_size(read(self.path("far", "scene_dense.ply"))), 500)
        self.assertEqual((near[0], None, near[2]), (far[0], near[1], far[2]))
        self.assertEqual(far[1], FAR)

    def test_doubles_are_in_the_world(self):
        self.make("far")
        local = positions(read(self.path("far", "scene_dense.ply")))
        self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path("far"),
                      "--resolution-level", "0", "--min-resolution", "48",
                      "--output-precision", "double")
        cloud = read(self.path("far", "scene_dense.ply"))
        self.assertIsNone(split_ply(cloud)[1])
        self.assertEqual(positions(cloud), local)
        self.refuses("--output-precision half: must be one of float, double", "DensifyPointCloud",
                     "-i", self.path("far", "scene.mvs"), "--output-precision", "half")

    def test_a_dense_scene_again(self):
        self.make("far")
        self.succeeds("DensifyPointCloud", "-i", "scene_dense.mvs", "-w", self.path("far"),
                      "--resolution-level", "0", "--min-resolution", "48", "-o", "again.mvs")
        self.assertEqual(split_ply(read(self.path("far", "again.ply"))),
                         split_ply(read(self.path("far", "scene_dense.ply"))))
        self.assertEqual(read(self.path("far", "again.geo.json")),
                         read(self.path("far", "scene.geo.json")))

    def test_an_older_offset_goes(self):
        self.make("far")
        self.succeeds("InterfaceCOLMAP", "-i", self.path("near"), "-o",
                      self.path("far", "scene.mvs"))
        self.assertFalse(os.path.exists(self.path("far", "scene.geo.json")))
        self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path("far"),
                      "--resolution-level", "0", "--min-resolution", "48")
        self.assertFalse(os.path.exists(self.path("far", "scene_dense.geo.json")))
        self.assertIsNone(split_ply(read(self.path("far", "scene_dense.ply")))[1])

    def test_a_scene_of_another_program(self):
        """Its poses are double, its points float. Reading moves both into a local frame."""
        folder = self.path("other")
        centres = [added(c, FAR) for c in tiny_scene.CENTRES]
        points = [(added(x, FAR), views) for x, views in tiny_scene.sparse_points()]
        for name, c, p in (("far", centres, points), ("near", None, None)):
            write(self.path("other", name + ".mvs"), tiny_scene.mvs(
                [self.path("near", "images", image) for image in tiny_scene.names()], centres=c,
                points=p))
            result = self.succeeds("DensifyPointCloud", "-i", name + ".mvs", "-w", folder,
                                   "--resolution-level", "0", "--min-resolution", "48")
            for file in os.listdir(folder):
                if ".dmap" in file:
                    os.remove(os.path.join(folder, file))
            said = result.stdout + result.stderr
            self.assertEqual("a resolution of only 0.25 m" in said, name == "far", said)
        self.assertEqual(json.loads(read(self.path("other", "far_dense.geo.json"))),
                         {"version": 1, "geo_offset": list(FAR)})
        near = read(self.path("other", "near_dense.ply"))
        far = read(self.path("other", "far_dense.ply"))
        self.assertEqual(split_ply(far)[1], FAR)
        self.assertGreater(cloud_size(far), 0.9 * cloud_size(near))


class FarScene(ProgramTest):
    """The close-up scene at the origin and at two other places."""
    SHIFTS = {"near": (0.0, 0.0, 0.0), "far": FAR, "odd": FAR_AND_ODD}

    @classmethod
    def setUpClass(cls):
        shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(shared.cleanup)
        cls.base = shared.name
        made = run("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views", 5,
                   "--width", 320, "--height", 240, "--samples", 1, "-o", cls.at("scene"))
        assert made.returncode == 0, made.stderr
        for name, shift in cls.SHIFTS.items():
            move_model(cls.at("scene", "sparse"), cls.at(name, "sparse"), shift)
            move_mesh(cls.at("scene", "mesh.ply"), cls.at(name, "mesh.ply"), shift)
            cls.make(name)

    @classmethod
    def at(cls, *parts):
        return os.path.join(cls.base, *parts)

    @classmethod
    def make(cls, name):
        """Makes the cloud under water, once for all cases."""
        for command in (("InterfaceCOLMAP", "-i", cls.at(name), "--image-folder",
                         cls.at("scene", "water"), "--housing", cls.at("scene", "housing.json"),
                         "-o", cls.at(name, "scene.mvs")),
                        ("DensifyPointCloud", "-i", "scene.mvs", "-w", cls.at(name),
                         "--refractive", *QUICK)):
            result = run(*command)
            assert result.returncode == 0, result.stderr
            assert "resolution of only" not in result.stdout, result.stdout

    def evaluated(self, cloud, truth, *options):
        """The printed table, and the numbers of the JSON file."""
        result = self.succeeds(
            "EvaluateReconstruction", "-i", self.at(cloud), "-m", self.at(truth, "mesh.ply"),
            "--cameras", self.at(truth, "sparse"), "--housing", self.at("scene", "housing.json"),
            "--tolerance", "0.002", "--samples", "10000", "--json", self.path("result.json"), *options, timeout=60)
        self.assertNotIn("resolution is only", result.stdout)
        return (re.findall(r"(?:points to|truth to|^2 +\d\.\d+ +\d\.).*", result.stdout, re.M),
                json.loads(read(self.path("result.json"))))

    def says_nearly_the_same(self, lines, others):
        """An odd shift changes the rounding of float and so the samples that are drawn. Numbers may
        differ by one unit of the last digit, or by 0.5 %."""
        for line, other in zip(lines, others):
            numbers = lambda text: [float(word) for word in text.split() if "." in word]
            for a, b in zip(numbers(line), numbers(other), strict=True):
                self.assertAlmostEqual(a, b, delta=max(0.00101, 0.005 * b), msg=(line, other))

    def test_the_same_cloud(self):
        """Equal up to the rounding of poses, which changes a cloud as much as a shift by 3 nm."""
        near = positions(read(self.at("near", "scene_dense.ply")))
        self.assertGreater(len(near), 5000)
        for name in ("far", "odd"):
            cloud = read(self.at(name, "scene_dense.ply"))
            back = tuple(-c for c in self.SHIFTS[name])
            moved = [added(x, back) for x in positions(cloud)]
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
            header, _, body = split_ply(read(self.at("near", "scene_dense.ply")))
            offset = "comment geo_offset " + " ".join(map(repr, self.SHIFTS[name]))
            write(self.at(name, "moved.ply"),
                  "\n".join(header[:2] + [offset] + header[2:]).encode() + body)
            moved = self.evaluated(f"{name}/moved.ply", name)[0]
            if name == "far":
                self.assertEqual(moved, table)
            self.says_nearly_the_same(moved, table)
        again = self.evaluated("far/moved.ply", "far", "--error-cloud", self.path("errors.ply"))
        self.assertEqual(again[0], table)
        self.assertEqual(split_ply(read(self.path("errors.ply")))[1], FAR)

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
        offset = split_ply(read(self.path("aligned.ply")))[1]
        self.assertEqual([x % 10 for x in offset], [0, 0, 0])
        self.assertLess(math.dist(offset, FAR_AND_ODD), 15)

    def test_float_truth_is_said_to_be_coarse(self):
        data = read(self.at("near", "mesh.ply"))
        end = data.index(b"end_header\n") + len(b"end_header\n")
        count = cloud_size(data)
        places = struct.unpack_from(f"<{3 * count}d", data, end)
        write(self.path("coarse.ply"), data[:end].replace(b"float64", b"float32") + struct.pack(
            f"<{3 * count}f", *(x + FAR[i % 3] for i, x in enumerate(places))) +
            data[end + 24 * count:])
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
        for name, shift in self.SHIFTS.items():
            said = self.succeeds(
                "RefinePoses", "-i", self.at(name), "--lens", self.at("scene", "sparse"),
                "--housing", self.at("scene", "housing.json"), "-o", self.path(name),
                "--scale-from", known, "-v", "3").stdout
            self.assertNotIn("Not converged", said)
            back = tuple(-c for c in shift)
            report = json.loads(read(self.path(name, "report.json")))
            iterations = [int(n) for n in re.findall(r"(\d+) iterations", said)]
            sparse = self.path(name, "sparse")
            models[name] = ({k: added(v, back) for k, v in centres_of(sparse).items()},
                            {k: added(v, back) for k, v in points_of(sparse).items()},
                            report["rms_after_px"], iterations)
        near = models["near"]
        for name in ("far", "odd"):
            model = models[name]
            self.assertEqual(len(model[3]), len(near[3]))
            for a, b in zip(model[3], near[3]):
                self.assertLessEqual(abs(a - b), 1, (model[3], near[3]))
            self.assertAlmostEqual(model[2], near[2], delta=1e-6)
            for k in (0, 1):
                self.assertEqual(model[k].keys(), near[k].keys())
                self.assertLess(max(math.dist(model[k][i], near[k][i]) for i in near[k]), 1e-6,
                                name)

    def test_known_positions_place_a_model(self):
        """A model at any place is moved to the positions of a survey."""
        results = {}
        for name in ("near", "far"):
            survey = "".join(f"{image} {x!r} {y!r} {z!r}\n" for image, (x, y, z) in
                             centres_of(self.at(name, "sparse")).items())
            write(self.path(name + ".txt"), survey)
        for model, place in (("near", "near"), ("near", "far"), ("far", "far"), ("far", "near")):
            out = self.path(model + "-to-" + place)
            self.succeeds("RefinePoses", "-i", self.at(model), "--lens",
                          self.at("scene", "sparse"), "--housing",
                          self.at("scene", "housing.json"), "-o", out, "--scale-from",
                          "positions:" + self.path(place + ".txt"))
            back = tuple(-c for c in self.SHIFTS[place])
            results[model, place] = {k: added(v, back) for k, v in
                                     centres_of(os.path.join(out, "sparse")).items()}
        wanted = results["near", "near"]
        for which, centres in results.items():
            self.assertLess(max(math.dist(centres[k], wanted[k]) for k in wanted), 1e-6, which)

    def test_aligned_models(self):
        for model, place in (("near", "odd"), ("odd", "near"), ("far", "odd")):
            out = self.path(model + "-to-" + place)
            said = self.succeeds("AlignModel", "-i", self.at(model, "sparse"), "--reference",
                                 self.at(place, "sparse"), "-o", out).stdout
            self.assertIn("RMS 0.000 mm, largest 0.000 mm", said)
            for read_model in (centres_of, points_of):
                moved, wanted = read_model(out), read_model(self.at(place, "sparse"))
                self.assertLess(max(math.dist(moved[k], wanted[k]) for k in wanted), 1e-8)


class WaterSurface(ProgramTest):
    """A housing file gives the water surface in world coordinates. It moves with the scene."""

    def test_the_same_ports(self):
        shared = self.path("scene")
        made = run("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views", 4,
                   "--width", 160, "--height", 120, "--samples", 1, "--medium", "air", "--truth",
                   "0", "-o", shared)
        self.assertEqual(made.returncode, 0, made.stderr)
        centres = centres_of(os.path.join(shared, "sparse"))
        lowest = min(c[2] for c in centres.values()) - 0.1
        for name, shift in (("near", (0, 0, 0)), ("odd", FAR_AND_ODD)):
            move_model(os.path.join(shared, "sparse"), self.path(name, "sparse"), shift)
            surface = {"type": "water-surface", "normal": [0.1, 0, -1],
                       "point_m": list(added((0, 0, lowest), shift)), "n_water": 1.333}
            write(self.path(name, "lake.json"), json.dumps(
                {"version": 1, "ports": {"lake": surface}, "default": "lake"}) + "\n")
            self.succeeds("InterfaceCOLMAP", "-i", self.path(name), "--image-folder",
                          os.path.join(shared, "air"), "--housing", self.path(name, "lake.json"),
                          "-o", self.path(name, "scene.mvs"))
            self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(name),
                          "--refractive", "--fusion-mode", "1", "--resolution-level", "0",
                          "--geometric-iters", "0")
            written = json.loads(read(self.path(name, "scene_dense.housing.json")))
            for a, b in zip(written["ports"]["lake"]["point_m"], surface["point_m"]):
                self.assertAlmostEqual(a, b, delta=1e-9)
        sides = [json.loads(read(self.path(name, "depth0000.dmap.json")))["port"]
                 for name in ("near", "odd")]
        self.assertAlmostEqual(sides[0]["distance_m"], sides[1]["distance_m"], delta=1e-7)
        self.assertGreater(sides[0]["distance_m"], 0.05)


if __name__ == "__main__":
    main()
