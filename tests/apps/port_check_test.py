# SPDX-License-Identifier: GPL-3.0-or-later
"""InterfaceCOLMAP warns if port, lens, scale and poses do not belong together, and gives no warning
if they do. The tracks of the simulated scene are observations in air."""

import json
import os
import shutil
import tempfile

from programs import ProgramTest, main, read, run, write

WARNINGS = ("do not fit together", "photographs do not agree with", "poses were computed without")


class Import(ProgramTest):
    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.scene = os.path.join(cls.shared.name, "closeup")
        made = run("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views", 5,
                   "--width", 320, "--height", 240, "-o", cls.scene)
        assert made.returncode == 0, made.stderr

    def said(self, medium="water", housing=None, model=None, threads=0):
        """The output of an import. `housing`: changes to the true port; None: no housing."""
        arguments = []
        if housing is not None:
            content = json.loads(read(os.path.join(self.scene, "housing.json")))
            content["ports"][content["default"]].update(housing)
            write(self.path("housing.json"), json.dumps(content))
            arguments = ["--housing", self.path("housing.json")]
        return self.succeeds("InterfaceCOLMAP", "-i", model or self.scene, "--image-folder",
                             os.path.join(self.scene, medium), "-o", self.path("scene.mvs"),
                             "--max-threads", threads, *arguments).stdout

    def warns(self, expected, **situation):
        self.assertIn(expected, self.said(**situation))
        os.remove(self.path("scene.mvs"))

    def is_silent(self, **situation):
        said = self.said(**situation)
        for warning in WARNINGS:
            self.assertNotIn(warning, said)

    def with_focal(self, factor):
        model = self.path("model")
        shutil.copytree(os.path.join(self.scene, "sparse"), model)
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
        lines = {part: [line for line in read(os.path.join(self.scene, "sparse", part + ".txt"))
                        .decode().splitlines() if not line.startswith("#")]
                 for part in ("cameras", "images", "points3D")}
        images = list(zip(lines["images"][::2], lines["images"][1::2]))[first:first + 2]
        ids = {head.split()[0] for head, _ in images}
        points = []
        for words in map(str.split, lines["points3D"]):
            track = [pair for pair in zip(words[8::2], words[9::2]) if pair[0] in ids]
            if {image for image, _ in track} == ids:
                points.append((words[0], " ".join(words[:8] + [w for pair in track for w in pair])))
        kept = {point for point, _ in points}
        model = self.path(f"pair{first}")
        write(os.path.join(model, "cameras.txt"), "\n".join(lines["cameras"]) + "\n")
        write(os.path.join(model, "points3D.txt"), "\n".join(line for _, line in points) + "\n")
        text = ""
        for head, observations in images:
            words = observations.split()
            for k in range(2, len(words), 3):
                words[k] = words[k] if words[k] in kept else "-1"
            text += head + "\n" + " ".join(words) + "\n"
        write(os.path.join(model, "images.txt"), text)
        return model

    def test_correct_pairs_of_images(self):
        """No pair of images gives a warning, although the port moves points out of the images."""
        for first in range(4):
            self.is_silent(housing={}, model=self.pair_of(first))
            os.remove(self.path("scene.mvs"))
            os.remove(self.path("scene.housing.json"))

    def test_a_distance_ten_times_too_large(self):
        port = json.loads(read(os.path.join(self.scene, "housing.json")))["ports"]["main"]
        self.warns("distance is 10 times too large",
                   housing={"distance_m": 10 * port["distance_m"]})

    def test_a_normal_45_degrees_off(self):
        self.warns("normal, 45 degrees off", housing={"normal": [0.70710678, 0, 0.70710678]})

    def test_indices_that_water_does_not_have(self):
        self.warns("n_water 1 ", housing={"n_water": 1.0})
        os.remove(self.path("scene.housing.json"))
        self.warns("n_water 1.49 ", housing={"n_water": 1.49})

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
