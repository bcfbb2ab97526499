# SPDX-License-Identifier: GPL-3.0-or-later
"""InterfaceCOLMAP warns if port, lens, scale and poses do not belong together, and gives no warning
if they do. The tracks of the simulated scene are observations in air."""

import json
import os
import pathlib
import shutil

from programs import main, read, write
from support import colmap_text
from worlds import CLOSEUP, Simulated

WARNINGS = ("do not fit together", "photographs do not agree with", "poses were computed without")


class Import(Simulated):
    SCENE = CLOSEUP

    def said(self, medium="water", housing=None, model=None, threads=0):
        """The output of an import. `housing`: changes to the true port; None: no housing."""
        port = ()
        if housing is not None:
            content = json.loads(read(os.path.join(self.truth, "housing.json")))
            content["ports"][content["default"]].update(housing)
            write(self.path("housing.json"), json.dumps(content))
            port = ("--housing", self.path("housing.json"))
        return self.imported(self.path("scene.mvs"), medium, "--max-threads", threads, model=model, port=port)

    def warns(self, expected, **situation):
        self.assertIn(expected, self.said(**situation))
        os.remove(self.path("scene.mvs"))

    def is_silent(self, **situation):
        said = self.said(**situation)
        for warning in WARNINGS:
            self.assertNotIn(warning, said)

    def with_focal(self, factor):
        model = self.path("model")
        shutil.copytree(os.path.join(self.truth, "sparse"), model)
        words = read(os.path.join(model, "cameras.txt")).decode().split()
        at = words.index("PINHOLE")
        camera = words[at - 1:]
        for k in (4, 5):
            camera[k] = repr(factor * float(camera[k]))
        write(os.path.join(model, "cameras.txt"), " ".join(camera) + "\n")
        return model

    def test_correct_scenes(self):
        self.is_silent(housing={})
        shutil.rmtree(self.folder)
        os.mkdir(self.folder)
        self.is_silent(medium="air")

    def pair_of(self, first):
        """The model of the images `first` and `first` + 1, with the points that both see."""
        model = self.path(f"pair{first}")
        colmap_text.copy(pathlib.Path(self.truth, "sparse"), pathlib.Path(model),
                         without=[f"{i:04}.jpg" for i in range(5) if i - first not in (0, 1)])
        return model

    def test_correct_pairs_of_images(self):
        """No pair of images gives a warning, although the port moves points out of the images."""
        for first in range(4):
            self.is_silent(housing={}, model=self.pair_of(first))
            os.remove(self.path("scene.mvs"))
            os.remove(self.path("scene.housing.json"))

    def test_wrong_ports(self):
        port = json.loads(read(os.path.join(self.truth, "housing.json")))["ports"]["main"]
        for expected, change in (("distance is 10 times too large", {"distance_m": 10 * port["distance_m"]}),
                                 ("normal, 45 degrees off", {"normal": [0.70710678, 0, 0.70710678]}),
                                 ("n_water 1 ", {"n_water": 1.0}), ("n_water 1.49 ", {"n_water": 1.49})):
            self.warns(expected, housing=change)
            os.remove(self.path("scene.housing.json"))

    def test_focal_lengths(self):
        for factor in (2, 1.333):
            self.warns("focal length", housing={}, model=self.with_focal(factor))
            shutil.rmtree(self.path("model"))

    def test_photographs_that_no_port_was_before(self):
        """Poses and photographs of a pinhole camera, with a housing. COLMAP's poses from
        photographs under water are solved without a port, too."""
        self.warns("The poses were computed without the port", medium="air", housing={})

    def test_a_housing_that_is_forgotten(self):
        self.warns("give the housing")

    def test_the_same_line_for_any_number_of_threads(self):
        wrong = {"n_water": 1.49}
        lines = {next(line.split("]", 1)[-1] for line in
                      self.said(housing=wrong, threads=threads).splitlines() if "n_water" in line)
                 for threads in (1, 2, 5)}
        self.assertEqual(len(lines), 1, lines)


if __name__ == "__main__":
    main()
