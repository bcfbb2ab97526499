# SPDX-License-Identifier: GPL-3.0-or-later
"""The notebook docs/python-tour.ipynb runs, and stores no output."""

import contextlib
import io
import json
import pathlib
import re
import unittest

import matplotlib

matplotlib.use("Agg")  # no window
NOTEBOOK = pathlib.Path(__file__).resolve().parents[2] / "docs/python-tour.ipynb"


class Tour(unittest.TestCase):
    def test_the_cells_run_one_after_the_other(self):
        notebook = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        names, said = {"__name__": "tour"}, io.StringIO()
        for number, cell in enumerate(cells):
            self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None), number)
            self.assertLess(len(cell["source"]), 20, number)
            with contextlib.redirect_stdout(said):
                exec(compile("".join(cell["source"]), f"cell {number}", "exec"), names)
        said = re.match(r"(\d+) points, median distance from the slope (\S+) m\n$", said.getvalue())
        points, distance = said.groups()
        self.assertGreater(int(points), 5000)
        # A pixel is 9 mm wide; matching finds a tenth of a pixel.
        self.assertLess(float(distance), 0.005)
        # Behind the port, a pinhole is wrong by pixels, and more at the corners than in the middle.
        self.assertGreater(names["error"][0, 0], names["error"][240, 320] + 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
