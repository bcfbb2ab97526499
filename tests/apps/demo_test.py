# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's tables, page and meshes, without the programs."""

import base64
import json
import unittest
import unittest.mock

from pipeline_folder import InFolder
from programs import main

from axial_pipeline import demo, demo_page, demo_runs, demo_table, truth
from axial_pipeline.programs import Programs


class Demo(InFolder):
    def test_a_depth_map_has_the_number_of_its_image(self):
        self.write("images.txt", "# 1 2 3\n6 1 0 0 0 0 0 0 1 0005.jpg\n"
                   "1 2 3 4 5 6 7 8 9\n7 1 0 0 0 0 0 0 1 0006.jpg\n\n")
        self.assertEqual(demo_runs.depth_map_of(self.folder, "0005.jpg"), "depth0005.dmap")
        self.assertIsNone(demo_runs.depth_map_of(self.folder, "0004.jpg"))

    def test_truth_is_made_once_by_each_program(self):
        programs, made = Programs(self.folder), self.folder / "made"
        script = 'while [ "$1" != -o ]; do shift; done; mkdir -p "$2"; echo >> ' + str(made)
        for version in ("1", "2"):
            self.put_script("SimulateUnderwater", f"{script} # {version}")
            for _ in range(2):
                truth.make_truth(programs, "reef", self.folder / "truth")
        self.assertEqual(made.read_text(), "\n\n")

    def test_the_tables_columns_are_aligned(self):
        row = {"mark": "(a)", "title": "In air", "points": 12345, "mean_m": 4e-4, "median_m": 3e-4,
               "rms_m": 5e-4, "tolerance_m": 0.002, "f_score": 0.8, "seconds": 9.5}
        lines = demo_table.text_table(
            demo_table.of_clouds([row, {**row, "title": "Elsewhere"}])).splitlines()
        self.assertEqual(len(lines), 4)
        self.assertEqual(len(set(map(len, lines))), 1)
        self.assertIn("12,345", lines[2])
        self.assertIn("F-score at 2 mm", lines[0])

    def write_run(self, run):
        """The results of a run, as the programs write them."""
        score = {"tolerance": 0.002, "precision": 0.9, "recall": 0.8, "f_score": 0.85}
        accuracy = {"count": 12345, "mean": 4e-4, "median": 3e-4, "rms": 5e-4}
        histogram = {"upper": 0.008, "counts": [9, 1], "beyond": 2}
        cloud = {"accuracy": accuracy, "scores": [score], "accuracy_histogram": histogram}
        seen = {"accuracy": accuracy, "scores": [score], "normals": {"within_10_20_30": [.7, .8, .9]}}
        mesh = {"seen": seen, "topology": {"vertices": 4567}, "render": {"psnr": 32.14}}
        for name, content in (
                ("evaluation.json", json.dumps(cloud)), ("evaluation-moved.json", json.dumps(cloud)),
                ("mesh.json", json.dumps(mesh)), ("seconds", "9.5\n"), ("mesh-seconds", "20\n"),
                ("evaluation.png", b"cloud"), ("depth-0000.png", b"depth"),
                ("rendered/0005.jpg", b"textured"), ("rendered/0005.errors.jpg", b"errors")):
            self.write(f"{run}/{name}", content)

    def test_the_page_holds_every_number_and_picture(self):
        for run in ("air", "refractive", "selfcalibrated"):
            self.write_run(run)
        photograph = self.write("water/0005.jpg", b"photograph")
        rows = demo_table.load(self.folder)
        lines = [*rows, demo_table.load_best_fit(self.folder)]
        meshes = demo_table.load_meshes(rows, demo.MESHES)
        self.write("refractive_page/index.html", "")
        self.write("surveys.change.json", json.dumps({"area_changed": 0.0123, "area_compared": 1}))
        page = demo_page.page(rows, lines, meshes, photograph,
                              demo_page.survey("refractive", self.folder), scene="closeup",
                              description="A scene.", size="half")
        for content in (b"cloud", b"depth", b"textured", b"errors", b"photograph"):
            self.assertIn(base64.b64encode(content).decode(), page)
        for number in ("12,345", "4,567", "32.1", "0.850", "70 %"):
            self.assertIn(f"<td>{number}</td>", page)
        self.assertIn('href="refractive_page/index.html"', page)
        self.assertIn("1.23 %", page)
        told = json.loads(demo_table.json_table(lines, meshes, "closeup", "half"))
        self.assertEqual([mesh["psnr_db"] for mesh in told["meshes"]], [32.14, 32.14])
        self.assertEqual(len(told["runs"]), 4)

    def test_one_view_is_left_out_of_texturing(self):
        commands = []
        with unittest.mock.patch.object(demo_runs, "shown", commands.append):
            made = demo_runs.Demo("closeup", "half", 0)
            made.work, made.data = self.folder, self.folder
            for name in ("0004", "0005", "0006"):
                self.write(f"water/{name}.jpg", "")
            self.write("refractive/scene_dense.mvs", "")
            made.make_mesh("refractive")
        self.assertEqual([command[0].name for command in commands],
                         ["ReconstructMesh", "RefineMesh", "TextureMesh"])
        self.assertTrue(all("--refractive" in command for command in commands))
        self.assertEqual((self.folder / "refractive/textured-views.txt").read_text(),
                         "0004.jpg\n0006.jpg\n")


if __name__ == "__main__":
    main()
