# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene photographed behind a flat port, behind a dome and in air. Five views of 320 x 240 of
the close-up scene, with true poses."""

import json
import os
import shutil

from programs import main, must, read, read_json, write
from readers import Dmap
from worlds import CLOSEUP, Simulated

DOME = ("--dome-radius", 0.05, "--dome-x", 0.003, "--dome-y", -0.004, "--dome-z", 0.006)
VIEWS = [f"{i:04}.jpg" for i in range(5)]
PORTS = ["flat", "dome", "none", "flat", "dome"]  # of the mixed scene's views
FULL = ("--resolution-level", 0, "--number-views-fuse", 2)
QUICK = ("--resolution-level", 1, "--min-resolution", 100, "--geometric-iters", 1)


class MixedPortsTest(Simulated):
    SCENE = CLOSEUP

    @classmethod
    def make(cls, folder):
        super().make(folder)
        cls.flat, cls.dome, cls.mixed = cls.truth, cls.at("dome"), cls.at("mixed")
        must("SimulateUnderwater", *CLOSEUP, *DOME, "--medium", "water", "-o", cls.dome)
        cls.make_mixed()

    @classmethod
    def make_mixed(cls):
        shutil.copytree(os.path.join(cls.flat, "sparse"), os.path.join(cls.mixed, "sparse"))
        os.mkdir(os.path.join(cls.mixed, "water"))
        source = {"flat": (cls.flat, "water"), "dome": (cls.dome, "water"), "none": (cls.flat, "air")}
        for view, port in zip(VIEWS, PORTS):
            shutil.copy(os.path.join(*source[port], view), os.path.join(cls.mixed, "water", view))
        ports = {name: read_json(folder, "housing.json")["ports"]["main"]
                 for name, folder in (("flat", cls.flat), ("dome", cls.dome))}
        write(os.path.join(cls.mixed, "housing.json"), json.dumps(
            {"version": 1, "ports": ports, "default": "none", "images": dict(zip(VIEWS, PORTS))}))

    def import_scene(self, truth, folder, model=None):
        self.imported(self.path(folder, "scene.mvs"), os.path.join(truth, "water"), model=model or truth,
                      port=("--housing", os.path.join(truth, "housing.json")))

    def densify(self, folder, *arguments):
        return self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(folder),
                             "--refractive", *arguments).stdout

    def result(self, truth, folder):
        """Median distance to the true surface [m], and recall at 4 mm, the width of one pixel."""
        report = self.evaluated("water", self.path(folder, "scene_dense.ply"), "--tolerance", "0.004", seen_from=truth)
        median, recall = report["accuracy"]["median"], report["scores"][0]["recall"]
        print(f"measured: {folder} median {1e3 * median:.3f} mm, recall {recall:.3f}")
        return median, recall

    def swap_kinds(self, folder):
        file = self.path(folder, "scene.housing.json")
        housing = read_json(file)
        swapped = {"flat": "dome", "dome": "flat", "none": "none"}
        housing["images"] = {view: swapped[port] for view, port in zip(VIEWS, PORTS)}
        write(file, json.dumps(housing))

    def test_a_mixed_scene_is_as_good_as_those_of_one_kind(self):
        results = {}
        for name, truth in (("flat", self.flat), ("dome", self.dome), ("mixed", self.mixed),
                            ("swapped", self.mixed)):
            self.import_scene(truth, name)
            if name == "swapped":
                self.swap_kinds(name)
            self.densify(name, *FULL)
            results[name] = self.result(truth, name)
        self.taken_up_again("mixed")
        (flat_median, flat_recall), (dome_median, dome_recall) = results["flat"], results["dome"]
        median, recall = results["mixed"]
        self.assertLess(median, 1.1 * max(flat_median, dome_median))
        # Fields of view depend on the ports, and so does the part of the scene that is seen twice.
        self.assertGreater(recall, 0.95 * min(flat_recall, dome_recall))
        # With flat port and dome swapped, the error is much larger.
        self.assertGreater(results["swapped"][0], 5 * median)

    def taken_up_again(self, folder):
        """Makes a map and the cloud again, by one thread, with the same bytes."""
        names = ("scene_dense.ply", "depth0001.dmap")
        before = [read(self.path(folder, name)) for name in names]
        for name in names:
            os.remove(self.path(folder, name))
        self.assertIn("4 maps existed already", self.densify(folder, *FULL, "--max-threads", 1))
        self.assertEqual([read(self.path(folder, name)) for name in names], before)

    def test_views_whose_sources_are_of_their_kind_have_the_maps_of_a_scene_of_that_kind(self):
        """Each view is matched with one view behind the same kind of port. The scene also holds
        images of other kinds."""
        write(self.path("neighbours.txt"), "0 3\n1 4\n3 0\n4 1\n")
        # Depth maps start from the sparse points. With 1, a point counts however many views see it,
        # so that all scenes start from the same points.
        write(self.path("dense.ini"), "Min Views Trust Point = 1\n")
        for name in ("mixed", "flat", "dome"):
            self.import_scene(getattr(self, name), name, model=self.flat)
            self.densify(name, *QUICK, "--view-neighbors-file", self.path("neighbours.txt"),
                         "--dense-config-file", self.path("dense.ini"))
        for view, port in enumerate(PORTS):
            if port == "none":
                continue
            found, alone = (Dmap(read(self.path(folder, f"depth{view:04}.dmap"))).rows
                            for folder in ("mixed", port))
            self.assertTrue(found == alone, view)
            self.assertGreater(sum(depth > 0 for row in found for depth in row), 5000)

    def test_the_published_methods_are_refused_in_one_line(self):
        self.import_scene(self.mixed, "scene")
        for option, reason in ((("--projection", "line-search"), "use the projection exact for domes"),
                               (("--warp", "homography"), "use the warp affine for images")):
            self.refuses(reason, "DensifyPointCloud", "-i", "scene.mvs", "-w", self.path("scene"),
                         "--refractive", *option)


if __name__ == "__main__":
    main()
