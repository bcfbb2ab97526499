# SPDX-License-Identifier: GPL-3.0-or-later
"""InterfaceCOLMAP warns if port, lens, scale and poses do not belong together, and gives no warning
if they do. The tracks of the simulated scene are observations in air. The tests of diagnosis try each wrong
number."""

import json
import os
import pathlib

from programs import main, read_json, write
from support import colmap_text
from worlds import CLOSEUP, Simulated

WARNINGS = "do not fit together|photographs do not agree with|poses were computed without"


class Import(Simulated):
    SCENE = CLOSEUP

    def said(self, medium="water", housing=None, model=None, threads=0):
        """The output of an import. `housing`: changes to the true port; None: no housing."""
        port = ()
        if housing is not None:
            content = read_json(self.truth, "housing.json")
            content["ports"][content["default"]].update(housing)
            write(self.path("housing.json"), json.dumps(content))
            port = ("--housing", self.path("housing.json"))
        said = self.imported(self.path("scene.mvs"), medium, "--max-threads", threads, model=model, port=port)
        for name in ("scene.mvs", "scene.housing.json") if port else ("scene.mvs",):
            os.remove(self.path(name))
        return said

    def test_correct_scenes(self):
        self.assertNotRegex(self.said(housing={}), WARNINGS)
        self.assertNotRegex(self.said(medium="air"), WARNINGS)

    def test_correct_pairs_of_images(self):
        """No pair of images gives a warning, although the port moves points out of the images."""
        for first in range(4):
            model = self.path(f"pair{first}")
            colmap_text.copy(pathlib.Path(self.truth, "sparse"), pathlib.Path(model),
                             without=[f"{i:04}.jpg" for i in range(5) if i - first not in (0, 1)])
            self.assertNotRegex(self.said(housing={}, model=model), WARNINGS)

    def test_a_wrong_port_is_named_in_the_same_line_for_any_number_of_threads(self):
        said = [self.said(housing={"n_water": 1.49}, threads=threads) for threads in (1, 2, 5)]
        lines = {next(line.split("]", 1)[-1] for line in text.split("\n") if "n_water 1.49 " in line) for text in said}
        self.assertEqual(len(lines), 1, lines)

    def test_housings_that_photographs_do_not_have_or_lack(self):
        self.assertIn("The poses were computed without the port", self.said(medium="air", housing={}))
        self.assertIn("give the housing", self.said())


if __name__ == "__main__":
    main()
