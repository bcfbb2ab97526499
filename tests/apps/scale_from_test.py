# SPDX-License-Identifier: GPL-3.0-or-later
"""RefinePoses: everything that --scale-from and the options of refinement name is used, refused, or
reported as not used."""

import math
import os
import pathlib
import shutil

from programs import contents, main, read_json, write
from readers import centres_of, image_lines, points_of
from support import colmap_text
from worlds import CLOSEUP, FLAT, Simulated, housing

DOME = {"type": "dome", "center_m": [0, 0, 0.002], "inner_radius_m": 0.05, "thickness_m": 0.007, "n_air": 1,
        "n_glass": 1.52, "n_water": 1.333}


class Scales(Simulated):
    """RefinePoses with --scale-from that names images or points that are missing or left out, on few points."""
    SCENE = CLOSEUP

    @classmethod
    def make(cls, folder):
        super().make(folder)
        cls.sparse = cls.at("few")
        colmap_text.copy(pathlib.Path(cls.truth, "sparse"), pathlib.Path(cls.sparse), lambda number: number % 16 == 0)
        cls.centres = centres_of(cls.sparse)
        cls.names = sorted(cls.centres)

    def model(self, change):
        """A copy of the model, with `change`(name, words) of the observations (x, y, point) of each image."""
        folder = self.path("model")
        shutil.copytree(self.sparse, folder, dirs_exist_ok=True)
        lines = []
        for pose, observations in image_lines(os.path.join(self.sparse, "images.txt")):
            words = observations.split(" ")
            change(pose.split(" ")[-1], words)
            lines += [pose, " ".join(words)]
        write(os.path.join(folder, "images.txt"), "\n".join(lines) + "\n")
        return folder

    def spoiled(self, image):
        """A model in which the pixels of an image belong to the wrong points, so that RefinePoses leaves it out."""
        def change(name, words):
            half = len(words) // 6
            for k in (0, 1) if name == image else ():
                words[k::3] = words[k::3][half:] + words[k::3][:half]
        return self.model(change)

    def command(self, model, out, *arguments):
        return ("RefinePoses", "-i", model, "--lens", self.sparse, *self.port("water"), "-o", self.path(out),
                *arguments)

    def refined(self, out, *arguments, model=None):
        """The output of a run."""
        return self.succeeds(*self.command(model or self.sparse, out, *arguments)).stdout

    def between_images(self, a, b):
        return f"images:{a},{b},{math.dist(self.centres[a], self.centres[b])!r}"

    def report(self, out):
        return read_json(self.path(out, "report.json"))

    def has_no_scale(self, out, *arguments, model=None):
        said = self.refined(out, "--allow-missing", *arguments, model=model)
        self.assertIn("The model has no scale", said)
        self.assertIn("All lengths are unknown", said)
        self.assertNotRegex(said, "lengths are known| inf")
        self.assertIsNone(self.report(out)["scale_sigma"])
        self.assertIn("--scale-from", self.report(out)["unused"][0])

    def same_models(self, out, other):
        self.assertEqual(contents(self.path(out, "sparse")), contents(self.path(other, "sparse")))

    def test_a_length_between_images_of_which_one_is_left_out(self):
        for spoiled in (self.names[0], self.names[2]):
            other = self.names[1]
            model = self.spoiled(spoiled)
            for known in (self.between_images(spoiled, other), self.between_images(other, spoiled)):
                said = self.refuses("--scale-from " + known, *self.command(model, "out", "--scale-from", known)).stderr
                self.assertIn(f"image '{spoiled}' is left out", said)
        self.has_no_scale("out", "--scale-from", known, model=model)
        # The same model as without --scale-from: the bad image does not affect the initial scale.
        self.refined("without", model=model)
        self.same_models("out", "without")

    def test_a_length_between_points_of_which_one_is_left_out(self):
        places = points_of(self.sparse)
        good, bad = sorted(places)[:2]
        known = f"points:{good},{bad},{math.dist(places[good], places[bad])!r}"

        def change(_, words):
            for i in range(0, len(words) - 2, 3):
                if words[i + 2] == str(bad):
                    words[i] = repr(320 - float(words[i]))

        model = self.model(change)
        said = self.refuses("--scale-from " + known, *self.command(model, "out", "--scale-from", known)).stderr
        self.assertRegex(said, f"point ({good}|{bad}) is left out")
        self.has_no_scale("out", "--scale-from", known, model=model)

    def positions(self, places, form="{} {!r} {!r} {!r}", header=()):
        """The option of a file of positions by name."""
        lines = [*header, *(form.format(name, *place) for name, place in places.items())]
        write(self.path("known.csv"), "\n".join(lines) + "\n")
        return "--scale-from", "positions:" + self.path("known.csv")

    def test_a_position_of_an_image_that_is_left_out(self):
        spoiled = self.names[3]
        model = self.spoiled(spoiled)
        three = self.positions({name: self.centres[name] for name in self.names[1:4]})
        self.assertIn(spoiled, self.refuses("--scale-from positions:", *self.command(model, "out", *three)).stderr)
        self.has_no_scale("out", *three, model=model)
        said = self.refined("all", *self.positions(self.centres), model=model)
        self.assertIn(f"the position of {spoiled}", said)
        self.assertIn("All lengths are known to", said)
        self.assertEqual(self.report("all")["unused"], [f"--scale-from: the position of {spoiled}"])

    def test_positions_of_another_program(self):
        """Accuracies in the file replace --scale-sigma."""
        self.refined("plain", *self.positions(self.centres), "--scale-sigma", 0.05)
        self.refined("metashape", *self.positions(
            {name.rsplit(".")[0]: place for name, place in self.centres.items()}, "{},{!r},{!r},{!r},0.05",
            ["#Label,X/Easting,Y/Northing,Z/Altitude,Accuracy_(m)"]))
        self.assertEqual(contents(self.path("metashape")), contents(self.path("plain")))

    def test_wrong_positions(self):
        known = {name: list(place) for name, place in self.centres.items()}
        known[self.names[2]][0] += 50
        said = self.refined("out", *self.positions(known))
        expected = (f"the position of {self.names[2]} is 50 m from where the 4 positions that fit "
                    "together put it")
        self.assertIn(f"warning: {self.path('known.csv')}: {expected}", said)
        self.assertIn(f"--scale-from: {expected}", self.report("out")["unused"][0])
        # The result is that of a file without this position.
        del known[self.names[2]]
        self.refined("without", *self.positions(known))
        self.same_models("out", "without")
        mirrored = self.positions({name: (x, y, -z) for name, (x, y, z) in self.centres.items()})
        self.refuses("fit the mirror image of the cameras", *self.command(self.sparse, "mirrored", *mirrored))

    def test_what_the_model_does_not_have(self):
        lost = self.positions({f"lost{k}.jpg": (k, 0, k % 2) for k in (1, 2, 3)})[1]
        for known in (f"images:{self.names[0]},lost.jpg,1", "points:99999999,1,1",
                      f"images:{self.names[0]},with,commas.jpg,1", lost):
            self.refuses("--scale-from ", *self.command(self.sparse, "out", "--scale-from", known))
            self.has_no_scale("out", "--scale-from", known)
            shutil.rmtree(self.path("out"))

    def test_what_is_used_is_not_said_to_be_missing(self):
        known = ("--scale-from", self.between_images(self.names[0], self.names[4]))
        said = self.refined("out", *known)
        self.assertNotIn("not used", said)
        report = self.report("out")
        self.assertEqual([key for key in report if key in ("unused", "standard_deviations")], [])
        self.assertLess(report["scale_sigma"], 0.01)
        self.refined("allowed", *known, "--allow-missing")
        self.assertEqual(contents(self.path("out")), contents(self.path("allowed")))
        # The standard deviation is reported after the refined model.
        self.assertLess(said.index("Refined model in"), said.index("All lengths are known"))

    def test_words_without_their_subject(self):
        write(self.path("dome.json"), housing(DOME))
        write(self.path("mixed.json"), housing(FLAT, images={self.names[0]: "none"}))
        known = ("--scale-from", self.between_images(self.names[1], self.names[4]))
        refine = ("RefinePoses", "-i", self.sparse, "--lens", self.sparse, "-o", self.path("out"))
        port = self.port("water")
        self.refuses_each(
            refine, ("--scale-sigma 0.1: is the standard deviation of --scale-from", *port, "--scale-sigma", "0.1"),
            *((expected, *known, *(() if "--housing" in arguments else port), *arguments) for expected, *arguments in (
                ("--distance-sigma 1e-320: must be 0, or 1e-12 or more", "--refine", "distance", "--distance-sigma",
                 "1e-320"),
                ("--focal-sigma 0.1: --refine does not name focal", "--refine", "index", "--focal-sigma", "0.1"),
                ("--refine normal: there is a dome", "--refine", "normal", "--housing", self.path("dome.json")),
                ("--refine index: there are images in air", "--refine", "index", "--housing",
                 self.path("mixed.json")))))


if __name__ == "__main__":
    main()
