# SPDX-License-Identifier: GPL-3.0-or-later
"""report.html and report.pdf of apps/pipeline/reconstruct: their parts, when they are made, and how they print."""

import base64
import html.parser
import json
import os
import pathlib
import re
import unittest

from browser import CHROMIUM, Browser
from pipeline_folder import InFolder, options_of
from programs import main
from stand_ins import BROWSER, StandIns

from axial_pipeline import report_html, report_pdf, survey_facts, survey_report
from axial_pipeline.run_file import write_run
from axial_pipeline.steps import Step

REFINED = {
    "rms_after_px": 0.36, "observations_after": 120, "points_after": 40, "scale_sigma": 0.0048, "shape_sigma": None,
    "depth_sigma": 0, "images": [{"name": f"{i}.jpg", "observations": 20, "rms_after_px": 0.1 * i} for i in range(7)],
    "cameras": [{"id": 1, "free": [{"name": "index of water", "unit": "", "value": 1.335, "sigma": 0.0017,
                                    "before": 1.333, "sigma_before": 0.004, "decided_by": "photographs"}]}],
    "control": {"targets": 3, "observations": 12, "rms_px": 0.2, "left_out": ["/home/me/bars.txt:3: target 9: one photograph"],
                "bars": [{"name": "bar 1-2", "use": "check", "photographs": 4,
                          "length_m": {"residual": -0.000125, "expected_sigma": 0.00025}}], "points": []}}
HOUSING = {"ports": {"main": {"type": "flat", "distance_m": 0.02, "thickness_m": 0.014, "n_water": 1.333,
                              "sigma": {"distance_m": 0.0042}}}}
HEIGHTS = {"file": "data/heights-0000.js", "size": [2, 2], "place": [0, 4, 4, 3]}
SCENE = {"all_points": 5, "map": {"heights": HEIGHTS, "layers": [
    {"id": "height", "file": "maps/height.jpg", "place": [0, 4, 4, 3], "legend": {"low": -3, "high": -2}}]}}
EXTERNAL = re.compile(r"""(?:src|href)\s*=\s*["'](?!data:)|url\(|@import|<script""")


class Balanced(html.parser.HTMLParser):
    """Collects the text, and fails if an element is not closed."""

    EMPTY = {"meta", "img", "br"}

    def __init__(self, text):
        super().__init__()
        self.open, self.texts = [], []
        self.feed(text)
        assert not self.open, self.open

    def handle_starttag(self, tag, attributes):
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag

    def handle_data(self, data):
        self.texts.append(data.strip())


class Parts(InFolder):
    """A finished run that is made of small files."""

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        for name, content in (("refined/report.json", REFINED), ("refined/housing.json", HOUSING)):
            self.write(f"out/{name}", json.dumps(content))
        self.write("out/refined/sparse/cameras.txt", "# cameras\n1 PINHOLE 480 360 286 286 240 180\n")
        self.write("out/scene_map.jpg", b"\xff\xd8picture")
        self.write("out/page/data/scene.js", f"axialData.scene({json.dumps(SCENE)});\n")
        heights = base64.b64encode(b"\0\0\1\0\2\0\0\1").decode()  # one of four places has no height
        self.write("out/page/data/heights-0000.js", f'axialData.put("heights",0,"{heights}");\n')
        self.write("out/logs/map.log", "10:00:00 [MapSurface] warning: /home/me/dive/a.ply: few <views>\n" * 2)
        self.todo = [Step("map", ["/opt/bin/MapSurface", "-i", "/home/me/dive/scene.mvs"], self.out),
                     Step("page", ["/opt/bin/ViewScene", "--images=/home/me/my dive/photographs"], self.out)]

    def page(self, **changes):
        given = options_of(**{"output": str(self.out), "until": "map", "scale_from": "", "lenses": ["lens"], **changes})
        return survey_report.page_of(given, self.out, self.todo, ["6 of 7 photographs have poses"])

    def texts(self, **changes):
        return Balanced(self.page(**changes)).texts

    def test_numbers_stand_with_their_units_and_errors(self):
        texts = self.texts(without="texture")
        for text in ("6 of 7 photographs have poses", "PINHOLE", "286, 286, 240, 180", "20 mm", "4.2 mm",
                     "1.335 ± 0.0017", "0.48 %", "not known", "taken as known", "-0.12", "0.25",
                     "bars.txt:3: target 9: one photograph", "4.00 m x 3.00 m", "-3.000 m to -2.000 m",
                     "75.0 % of the rectangle of the map have a height: 9.00 m² in the plane of the map",
                     "No length and no position was given: the scale comes from the refraction at the port alone.",
                     "map: a.ply: few <views> (2 times)", "The step texture was left out by --without."):
            self.assertIn(text, texts)
        self.assertIn("6.jpg", texts)  # the largest error
        self.assertNotIn("1.jpg", texts)

    def test_it_needs_no_other_file_and_names_no_folder(self):
        page = self.page()
        self.assertIsNone(EXTERNAL.search(page))
        self.assertIn(base64.b64encode(b"\xff\xd8picture").decode(), page)
        self.assertNotIn("/home/me", page)
        self.assertNotIn("/opt", page)

    def test_a_page_of_an_earlier_run_says_nothing(self):
        self.todo = self.todo[:1]
        texts = "".join(self.texts())
        self.assertNotIn("Size of the map", texts)
        self.assertNotIn("Points of the cloud", texts)

    def test_inputs_that_give_the_scale_are_named(self):
        """The only bar of the run is a check, which gives no scale."""
        self.assertIn("The scale was given by --scale-from positions:a.csv.",
                      self.texts(scale_from="positions:/home/me/a.csv"))
        control = {**REFINED["control"], "bars": [{**REFINED["control"]["bars"][0], "use": "adjusted"}]}
        self.write("out/refined/report.json", json.dumps({**REFINED, "control": control, "unused": ["bar 5-6: moved"]}))
        self.assertIn("The scale was given by bars and control points. Not used: bar 5-6: moved.", self.texts())

    def test_warnings_about_features_stand_once(self):
        self.write("out/logs/features.log", "10:00:00 [reconstruct] warning: a still region\n")
        self.todo.insert(0, Step("features", ["/opt/bin/colmap"], self.out))
        self.assertEqual(sum("a still region" in text for text in self.texts()), 1)

    def test_damaged_and_missing_files_leave_their_parts_out(self):
        self.write("out/page/data/scene.js", "axialData.scene({")
        self.write("out/refined/housing.json", "{")
        self.assertEqual(survey_facts.shown(self.out), {})
        self.assertNotIn("Size of the map", self.texts())

    def test_a_large_picture_is_named(self):
        self.write("out/scene_map.jpg", bytes(4_000_000))
        self.assertIn("Orthomosaic: see scene_map.jpg, which is too large for this report.", self.texts())

    def test_the_command_is_that_of_the_file_of_the_run(self):
        given = options_of(output=str(self.out), until="map", lenses=["lens"])
        write_run(self.out / "run.json", given, self.todo, self.out)
        command = json.loads((self.out / "run.json").read_text())["command"]
        self.assertIn(" ".join(map(report_html.word_without_folders, command)), self.texts())

    @unittest.skipUnless(CHROMIUM, "Chromium is not installed")
    def test_it_prints(self):
        page, pdf = self.write("report.html", self.page()), self.folder / "report.pdf"
        self.assertEqual(report_pdf.print_page(page, pdf, self.folder / "logs" / "report.log"), "")
        self.assertTrue(report_pdf.is_whole(pdf))
        self.assertIn(b"/Type /Page", pdf.read_bytes())
        browser = Browser(page.as_uri(), width=672, height=950)  # 178 mm, the width between the margins of A4
        self.addCleanup(browser.close)
        browser.wait_for("document.readyState === 'complete'")
        browser.send("Emulation.setEmulatedMedia", media="print")
        self.assertLessEqual(browser.value("document.documentElement.scrollWidth"), 672)
        self.assertEqual(browser.errors, [])


class InARun(StandIns):
    """When a run writes the report."""

    def pdf(self):
        return self.folder / "out" / "report.pdf"

    def test_it_is_printed_again_only_if_it_changed(self):
        self.assertIn(f"Report: {self.folder}/out/report.html", self.succeeds("--until", "cloud"))
        made = self.pdf().stat().st_mtime_ns
        self.succeeds("--until", "cloud")
        self.assertEqual(self.pdf().stat().st_mtime_ns, made)
        self.succeeds("--until", "mesh")
        self.assertNotEqual(self.pdf().stat().st_mtime_ns, made)
        self.pdf().unlink()
        self.succeeds("--until", "mesh")
        self.assertTrue(self.pdf().exists())

    def test_a_run_ends_well_without_a_pdf(self):
        for script, why in (("exit 3", "chromium: exit code 3, its output is in"), ("", "chromium: wrote no PDF")):
            self.put_script("chromium", script)
            said = self.succeeds("--until", "poses")
            self.assertIn(f"report.pdf was not made, report.html was: {why}", said)
            self.assertFalse(self.pdf().exists())
            self.assertTrue((self.folder / "out" / "report.html").exists())
        self.put_script("chromium", BROWSER)
        self.assertNotIn("was not made", self.succeeds("--until", "poses"))
        self.assertTrue(self.pdf().exists())

    def test_it_can_be_left_out(self):
        self.assertIn("report.md", self.succeeds("--until", "poses", "--without", "report"))
        self.assertFalse((self.folder / "out" / "report.html").exists())

    def test_files_of_the_user_are_kept(self):
        self.write("out/report.pdf")
        self.assertIn("report.pdf: no record of an earlier run names this file", self.refused("--until", "poses"))
        self.succeeds("--until", "poses", "--without", "report")
        self.assertEqual(self.pdf().read_text(), "mine")


class WithoutBrowser(InFolder):
    def test_the_package_is_named(self):
        path = os.environ["PATH"]
        self.addCleanup(os.environ.update, PATH=path)
        os.environ["PATH"] = str(self.folder)
        self.assertEqual(report_pdf.print_page(pathlib.Path("a"), pathlib.Path("b"), pathlib.Path("c")),
                         "chromium is not installed (Debian's package chromium)")


if __name__ == "__main__":
    main()
