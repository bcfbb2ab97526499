# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables that docs/paper/documents.py makes from the numbers of ReproducePaper, from numbers made here."""

import json
import pathlib
import subprocess
import sys
import unittest

from programs import main, new_folder

PAPER = pathlib.Path(__file__).resolve().parents[2] / "docs" / "paper"
sys.path.insert(0, str(PAPER))
import cells  # noqa: E402
import clouds  # noqa: E402
import reconstruction  # noqa: E402
import simulations  # noqa: E402


def results(experiment, parts):
    return {"experiment": experiment, "quick": False, "parts": parts}


class Cells(unittest.TestCase):
    def test_numbers_have_significant_digits_and_no_exponent(self):
        for value, text in ((0.26714, "0.267"), (0.0099996, "0.0100"), (24617.3, "24600"), (1.0, "1.00"),
                            (-0.00123456, "-0.00123"), (0, "0"), (float("inf"), "inf")):
            self.assertEqual(cells.significant(value), text)
        self.assertEqual(cells.significant(-0.000012345, 2), "-0.000012")

    def test_lengths_are_millimetres_and_shares_percent_or_a_dash(self):
        self.assertEqual([cells.millimetres(0.00087125), cells.percent(0.7416)], ["0.871", "74.2"])
        self.assertEqual([cells.millimetres(None), cells.percent(None)], ["-", "-"])

    def test_verdicts_say_yes_or_no(self):
        self.assertEqual(cells.verdicts(("at most 1", "0.5", True), ("at most 1", "2", False)),
                         "| asked | seen | met |\n|---|---|---|\n"
                         "| at most 1 | 0.5 | yes |\n| at most 1 | 2 | no |\n")

    def test_the_default_setup_is_a_row_of_each_series(self):
        camera = {"fov_degrees": 80, "distance": 0.02, "tilt_degrees": 0, "n_glass": 1.52, "n_water": 1.333}
        part = lambda result: {"inputs": {"setup": {"camera": camera, "plane_degrees": 0}}, "result": result}
        parts = {"setup2_default_9px": part("usual"), "setup2_distance_mm_2_9px": part("near"),
                 "setup2_n_water_1.34_9px": part("salty"), "setup1_fov_degrees_50_9px": part("other")}
        self.assertEqual(simulations.series_of(results("figure4", parts), 2, "_9px"),
                         {"distance_mm": [(2, "near"), (20, "usual")],
                          "n_water": [(1.333, "usual"), (1.34, "salty")]})
        self.assertEqual(simulations.value_title("n_water", 1.34), "refractive index of the water 1.34")
        self.assertEqual(simulations.value_title("tilt_degrees", 3.0), "interface tilt 3\u00b0")

    def test_titles_say_what_is_varied(self):
        for name, title in (("usual", "the usual case"), ("tilt_degrees_6", "tilt 6\u00b0"),
                            ("scale_2", "everything but the port, times 4"),
                            ("near_tilt_degrees_6", "everything but the port, times 0.5, and tilt 6\u00b0"),
                            ("reef", "scene 'reef' as it comes")):
            self.assertEqual(clouds.need_title(name), title)


class Completeness(unittest.TestCase):
    """`recall` of the places are complete that two cameras see; no place is seen by four."""

    def table(self, *recalls, **more):
        report = lambda recall: {
            "by_views": [{"recall": [recall]}, {"recall": [0.5]}, {"recall": [None]}],
            "scores": [{"precision": 0.875, "f_score": 0.8}], "accuracy": {"mean": 0.00125, "count": 1000},
            "gross": {"share": 0.01, "distance": 0.008}, "cpu_seconds": 60, **more}
        inputs = {"scene": ["--preset", "reef"], "medium": "water", "poses": "colmap", "tolerance": 0.005}
        parts = {f"seed{seed}": {"inputs": inputs, "result": report(recall)}
                 for seed, recall in zip((3, 8, 5), recalls)}
        return clouds.completeness(results("completeness_reef", parts))["completeness_reef.md"]

    def test_one_row_for_each_seed_and_their_median(self):
        table = self.table(0.2, 0.9, 0.3)
        self.assertTrue(table.startswith("reef, water, colmap poses, tolerance 5 mm; gross: beyond 8 mm\n"))
        for row in ("\n| 3 | 20.0 | 50.0 | - | 87.5 | 0.800 | 1.250 | 1.000 | 1000 | 60.0 |",
                    "\n| 8 | 90.0 |", "\n| 5 | 30.0 |", "\n| median | 30.0 | 50.0 | - |"):
            self.assertIn(row, table)

    def test_a_missing_number_does_not_count_for_the_median(self):
        table = self.table(0.2, None, 0.4)
        self.assertIn("\n| 8 | - | 50.0 |", table)
        self.assertIn("\n| median | 30.0 |", table)

    def test_columns_for_what_the_reports_hold(self):
        self.assertNotIn("density", self.table(0.5))
        table = self.table(0.5, strip={"ratio": 1.5})
        self.assertIn("density, most / least", table)
        self.assertIn("| 1.50 | 60.0 |", table)
        classes = [{"least": 2.8, "most": 5.7, "recall": [0.25]}, {"least": None, "recall": [None]}]
        self.assertIn("| seed | 2.8 to 5.7 px [%] | not thin [%] |", self.table(0.5, by_thickness=classes))


class DepthMaps(unittest.TestCase):
    """Depth maps of three seeds. The rings of our method are shifted against those in air, those of the
    paper's method twice as far to the other side."""

    def setUp(self):
        self.maps = [{method: self.of(k, shift) for method, shift in (("air", 0), ("ours", 1), ("papers", -2))}
                     for k in range(3)]

    def of(self, k, shift):
        ring = lambda count, median: {"inner": 0.25, "outer": 0.5, "count": count, "median": median}
        place = lambda name, pixels, gross, mean: {"place": name, "truths": 2 * pixels, "pixels": pixels,
                                                   "gross": gross, "mean": mean, "median": mean / 2}
        return {"pixels": 20000, "median": (0.001, 0.004, 0.002)[k], "within": 0.75, "gross": 0.02,
                "mean": 0.003, "completeness": 0.9,
                "rings": [ring(9000, 1e-3 + shift * (1e-4, 5e-4, 2e-4)[k]),
                          ring(4999 if k == 1 else 9000, 1e-3 + shift * 7e-4),  # too few
                          ring(9000, 1e-3 - shift * 3e-4)],
                "places": [place("no texture", 4000, 0, 0.004), place("all else", 12000, 3000, 0.002)]}

    def test_seeds_are_combined_by_median(self):
        table = reconstruction.maps_table(self.maps)
        for title in ("in air", "refracted, our method", "refracted, the paper's method"):
            self.assertIn(f"\n| {title} | 20000 | 2.00 | 75.0 | 2.0 | 3.00 | 90.0 |", table)

    def test_rings_with_few_pixels_in_any_map_do_not_count(self):
        table = reconstruction.rings_table(self.maps)
        self.assertIn("| fewer than 5000 pixels | - | - | - |", table)
        self.assertIn("| +10.00 | +12.00 | +2.00 | +1.00, +5.00, +2.00 |", table)
        # The second ring, which is left out, has a difference of 7e-4.
        self.assertAlmostEqual(reconstruction.largest_ring_difference(self.maps), 3e-4, 12)

    def test_shares_are_of_all_places(self):
        table = reconstruction.places_table(self.maps)
        self.assertIn("| in air | no texture | 25.0 | - | - | - | - | - |", table)
        # The errors that are not gross: 9000 of 2 mm here, and 4000 of 4 mm at the other place.
        self.assertIn("| in air | all else | 75.0 | 50.0 | 1.00 | 25.0 | 2.00 | 52.9 |", table)


class Page(unittest.TestCase):
    """Tables in a page, with the results of figure 3."""

    def setUp(self):
        self.folder = pathlib.Path(new_folder(self.addCleanup))
        self.page = self.folder / "page.md"
        errors = {warp: [0.25, 77.7, -1] for warp in simulations.SHOWN_WARPS}
        parts = {f"setup{k}": {"inputs": {}, "result": {"texels_across": 1, "errors": errors}} for k in (1, 2)}
        (self.folder / "figure3.json").write_text(json.dumps(results("figure3", parts)))

    def documents(self, *arguments):
        return subprocess.run([sys.executable, "-B", PAPER / "documents.py", self.folder, "--tables",
                               *arguments], text=True, capture_output=True)

    def test_is_brought_up_to_date(self):
        self.page.write_text("before\n<!-- figure3.md -->\nold\n<!-- end -->\n"
                             "<!-- other.md -->\nkept\n<!-- end -->\n")
        done = self.documents("--page", self.page)
        self.assertEqual(done.returncode, 0, done.stderr)
        table = (self.folder / "figure3.md").read_text()
        self.assertIn("| 1 | the paper's | 39.0 | 77.7 |", table)
        self.assertEqual(self.page.read_text(), f"before\n<!-- figure3.md -->\n\n{table}\n<!-- end -->\n"
                                                "<!-- other.md -->\nkept\n<!-- end -->\n")

    def test_wrong_pages_are_refused_and_left_alone(self):
        for text, said in (("no table", "has no line such as '<!-- figure3"),
                           ("<!-- figure3.md -->\n", "has no '<!-- end -->'"),
                           ("<!-- figure3.md -->\n<!-- figure4.md -->\n<!-- end -->\n",
                            "has no '<!-- end -->'")):
            self.page.write_text(text)
            done = self.documents("--page", self.page)
            self.assertEqual(done.returncode, 1)
            self.assertIn(said, done.stderr)
            self.assertEqual(self.page.read_text(), text)
            self.assertFalse((self.folder / "figure3.md").exists())

    def test_numbers_that_are_not_there_are_named(self):
        self.assertIn("has no numbers of figure9", self.documents("figure9").stderr)


main()
