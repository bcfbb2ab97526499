# SPDX-License-Identifier: GPL-3.0-or-later
"""RefinePoses: everything that --scale-from and the options of refinement name is used, refused, or
reported as not used."""

import json
import math
import os
import pathlib
import tempfile

from places import centres_of, image_lines, points_of
from programs import ProgramTest, files_below, main, read, run, write
from support import colmap_text


class Scales(ProgramTest):
    """RefinePoses with --scale-from that names images or points that are missing or left out."""

    @classmethod
    def setUpClass(cls):
        shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(shared.cleanup)
        cls.scene = os.path.join(shared.name, "scene")
        made = run("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views", 5,
                   "--width", 320, "--height", 240, "--samples", 1, "-o", cls.scene)
        assert made.returncode == 0, made.stderr
        cls.sparse = os.path.join(cls.scene, "few")
        colmap_text.copy(pathlib.Path(cls.scene, "sparse"), pathlib.Path(cls.sparse), lambda number: number % 6 == 0)
        cls.centres = centres_of(cls.sparse)
        cls.names = sorted(cls.centres)

    def model(self, spoiled):
        """A copy of the model in which the pixels of the image `spoiled` belong to the wrong
        points, so that RefinePoses leaves it out. An empty name spoils no image."""
        folder = self.path("model")
        for part in ("cameras.txt", "points3D.txt"):
            write(os.path.join(folder, part), read(os.path.join(self.sparse, part)))
        lines = []
        for pose, observations in image_lines(os.path.join(self.sparse, "images.txt")):
            words = observations.split(" ")
            if pose.endswith(" " + spoiled):
                half = len(words) // 6
                for k in (0, 1):
                    words[k::3] = words[k::3][half:] + words[k::3][:half]
            lines += [pose, " ".join(words)]
        write(os.path.join(folder, "images.txt"), "\n".join(lines) + "\n")
        return folder

    def command(self, model, out, *arguments):
        return ("RefinePoses", "-i", model, "--lens", self.sparse, "--housing",
                os.path.join(self.scene, "housing.json"), "-o", self.path(out), *arguments)

    def between_images(self, a, b):
        return f"images:{a},{b},{math.dist(self.centres[a], self.centres[b])!r}"

    def report(self, out):
        return json.loads(read(self.path(out, "report.json")))

    def assert_has_no_scale(self, result, out):
        self.assertIn("The model has no scale", result.stdout)
        self.assertIn("All lengths are unknown", result.stdout)
        self.assertNotIn("lengths are known", result.stdout)
        self.assertNotIn(" inf", result.stdout)
        self.assertIsNone(self.report(out)["scale_sigma"])
        self.assertIn("--scale-from", self.report(out)["unused"][0])

    def test_a_length_between_images_of_which_one_is_left_out(self):
        for spoiled in (self.names[0], self.names[2]):
            other = self.names[1]
            model = self.model(spoiled)
            for known in (self.between_images(spoiled, other), self.between_images(other, spoiled)):
                said = self.refuses("--scale-from " + known, *self.command(
                    model, "out", "--scale-from", known)).stderr
                self.assertIn(f"image '{spoiled}' is left out", said)
        result = self.succeeds(*self.command(model, "out", "--allow-missing", "--scale-from", known))
        self.assert_has_no_scale(result, "out")
        # The same model as without --scale-from: the bad image does not affect the initial scale.
        self.succeeds(*self.command(model, "without"))
        for name in ("images.txt", "points3D.txt", "cameras.txt"):
            self.assertEqual(read(self.path("out", "sparse", name)),
                             read(self.path("without", "sparse", name)), name)

    def test_a_length_between_points_of_which_one_is_left_out(self):
        places = points_of(self.sparse)
        good, bad = sorted(places)[:2]
        known = f"points:{good},{bad},{math.dist(places[good], places[bad])!r}"
        model = self.model("")
        lines = []
        for pose, observations in image_lines(os.path.join(self.sparse, "images.txt")):
            words = observations.split(" ")
            for i in range(0, len(words) - 2, 3):
                if words[i + 2] == str(bad):
                    words[i] = repr(320 - float(words[i]))
            lines += [pose, " ".join(words)]
        write(os.path.join(model, "images.txt"), "\n".join(lines) + "\n")
        said = self.refuses("--scale-from " + known, *self.command(
            model, "out", "--scale-from", known)).stderr
        self.assertRegex(said, f"point ({good}|{bad}) is left out")
        self.assert_has_no_scale(self.succeeds(*self.command(
            model, "out", "--allow-missing", "1", "--scale-from", known)), "out")

    def test_positions(self):
        spoiled = self.names[3]
        model = self.model(spoiled)
        for names in (self.names, self.names[1:4]):
            write(self.path("known.txt"), "".join(
                f"{name} " + " ".join(map(repr, self.centres[name])) + "\n" for name in names))
            command = self.command(model, "out", "--scale-from",
                                   "positions:" + self.path("known.txt"))
            if len(names) == 3:
                os.rename(self.path("out"), self.path("before"))
                self.assertIn(spoiled, self.refuses("--scale-from positions:", *command).stderr)
                self.assert_has_no_scale(self.succeeds(*command, "--allow-missing"), "out")
                continue
            said = self.succeeds(*command).stdout
            self.assertIn(f"the position of {spoiled}", said)
            self.assertIn("All lengths are known to", said)
            self.assertEqual(self.report("out")["unused"],
                             [f"--scale-from: the position of {spoiled}"])

    def with_positions(self, out, lines, *arguments):
        write(self.path("known.csv"), "\n".join(lines) + "\n")
        return self.command(self.sparse, out, "--scale-from", "positions:" + self.path("known.csv"),
                            *arguments)

    def test_positions_of_another_program(self):
        """Accuracies in the file replace --scale-sigma."""
        plain = [f"{name} {x!r} {y!r} {z!r}" for name, (x, y, z) in self.centres.items()]
        self.succeeds(*self.with_positions("plain", plain, "--scale-sigma", 0.05))
        lines = ["#Label,X/Easting,Y/Northing,Z/Altitude,Accuracy_(m)"] + [
            f"{name.rsplit('.')[0]},{x!r},{y!r},{z!r},0.05"
            for name, (x, y, z) in self.centres.items()]
        self.succeeds(*self.with_positions("metashape", lines))
        for name in files_below(self.path("plain")):
            self.assertEqual(read(self.path("metashape", name)), read(self.path("plain", name)), name)

    def test_wrong_positions(self):
        known = {name: list(place) for name, place in self.centres.items()}
        known[self.names[2]][0] += 50
        lines = [" ".join([name, *map(repr, place)]) for name, place in known.items()]
        said = self.succeeds(*self.with_positions("out", lines)).stdout
        expected = (f"the position of {self.names[2]} is 50 m from where the 4 positions that fit "
                    "together put it")
        self.assertIn(f"warning: {self.path('known.csv')}: {expected}", said)
        self.assertIn(f"--scale-from: {expected}", self.report("out")["unused"][0])
        # The result is that of a file without this position.
        rest = [line for line in lines if not line.startswith(self.names[2])]
        self.succeeds(*self.with_positions("without", rest))
        for name in ("images.txt", "points3D.txt"):
            self.assertEqual(read(self.path("out", "sparse", name)),
                             read(self.path("without", "sparse", name)), name)
        self.refuses("fit the mirror image of the cameras", *self.with_positions("mirrored", [
            f"{name} {x!r} {y!r} {-z!r}" for name, (x, y, z) in self.centres.items()]))

    def test_what_the_model_does_not_have(self):
        write(self.path("lost.txt"), "lost1.jpg 1 0 0\nlost2.jpg 2 0 1\nlost3.jpg 3 0 0\n")
        for known in (f"images:{self.names[0]},lost.jpg,1", "points:99999999,1,1",
                      f"images:{self.names[0]},with,commas.jpg,1",
                      "positions:" + self.path("lost.txt")):
            command = self.command(self.sparse, "out", "--scale-from", known)
            self.refuses("--scale-from ", *command)
            self.assert_has_no_scale(self.succeeds(*command, "--allow-missing"), "out")
            for name in files_below(self.path("out")):
                os.remove(self.path("out", name))

    def test_what_is_used_is_not_said_to_be_missing(self):
        known = self.between_images(self.names[0], self.names[4])
        plain = self.succeeds(*self.command(self.sparse, "out", "--scale-from", known))
        self.assertNotIn("not used", plain.stdout)
        report = self.report("out")
        self.assertEqual([key for key in report if key in ("unused", "standard_deviations")], [])
        self.assertLess(report["scale_sigma"], 0.01)
        self.succeeds(*self.command(self.sparse, "allowed", "--scale-from", known, "--allow-missing"))
        for name in files_below(self.path("out")):
            self.assertEqual(read(self.path("out", name)), read(self.path("allowed", name)), name)
        # The standard deviation is reported after the refined model.
        self.assertLess(plain.stdout.index("Refined model in"),
                        plain.stdout.index("All lengths are known"))

    def test_words_without_their_subject(self):
        dome = json.loads(read(os.path.join(self.scene, "housing.json")))
        name = next(iter(dome["ports"]))
        dome["ports"][name] = {"type": "dome", "center_m": [0, 0, 0.002], "inner_radius_m": 0.05,
                               "thickness_m": 0.007, "n_air": 1, "n_glass": 1.52, "n_water": 1.333}
        write(self.path("dome.json"), json.dumps(dome))
        mixed = json.loads(read(os.path.join(self.scene, "housing.json")))
        mixed["images"] = {self.names[0]: "none"}
        write(self.path("mixed.json"), json.dumps(mixed))
        known = ("--scale-from", self.between_images(self.names[1], self.names[4]))
        for expected, arguments in (
                ("--scale-sigma 0.1: is the standard deviation of --scale-from",
                 ("--scale-sigma", "0.1")),
                ("--normal-sigma 1: --refine none does not name normal",
                 ("--refine", "none", "--normal-sigma", "1")),
                ("--centre-sigma 1: --refine auto does not name centre", ("--centre-sigma", "1")),
                ("--distance-sigma 1e-320: must be 0, or 1e-12 or more",
                 ("--refine", "distance", "--distance-sigma", "1e-320")),
                ("--focal-sigma 0.1: --refine does not name focal",
                 ("--refine", "index", "--focal-sigma", "0.1")),
                ("--refine centre: there is a flat port", ("--refine", "centre")),
                ("--refine normal: there is a dome",
                 ("--refine", "normal", "--housing", self.path("dome.json"))),
                ("--refine index: there are images in air",
                 ("--refine", "index", "--housing", self.path("mixed.json")))):
            words = self.command(self.sparse, "out", *known[:0 if "--scale-sigma" in arguments else 2])
            if "--housing" in arguments:
                at = words.index("--housing")
                words = words[:at] + words[at + 2:]
            self.refuses(expected, *words, *arguments)


if __name__ == "__main__":
    main()
