# SPDX-License-Identifier: GPL-3.0-or-later
"""Images with the same base name in several folders: an entry of a housing or lens file applies to
one image only, or is refused."""

import json
import os
import shutil

import tiny_scene
from programs import ProgramTest, files_below, main, read, write

FLAT = {"type": "flat", "distance_m": 0.02, "thickness_m": 0.01, "normal": [0, 0, 1], "n_glass": 1.5,
        "n_water": 1.33}
# These names replace 0000.png, 0001.png and 0002.png.
NAMES = ("cam0/0000.png", "cam1/0000.png", "cam1/0001.png")


class Base(ProgramTest):
    def setUp(self):
        super().setUp()
        self.make(NAMES)

    def make(self, names):
        shutil.rmtree(self.path("colmap"), ignore_errors=True)
        tiny_scene.write_colmap(self.path("colmap"))
        images = self.path("colmap", "images")
        os.rename(images, images + "0")
        text = read(self.path("colmap", "sparse", "images.txt")).decode()
        for i, (old, new) in enumerate(zip(tiny_scene.names(), names)):
            os.makedirs(os.path.dirname(os.path.join(images, new)), exist_ok=True)
            shutil.copy(os.path.join(images + "0", old), os.path.join(images, new))
            text = text.replace(f" 1 {old}\n", f" 1 {new}\n")
        write(self.path("colmap", "sparse", "images.txt"), text)

    def housing(self, images, default="none"):
        write(self.path("port.json"), json.dumps(
            {"version": 1, "ports": {"main": FLAT, "other": {**FLAT, "distance_m": 0.03}},
             "default": default, "images": images}))
        return "--housing", self.path("port.json")

    def command(self, *arguments):
        return ("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("scene.mvs"),
                *arguments)

    def ports(self):
        """The ports of self.names in the imported housing file; images without an entry get the
        default."""
        housing = json.loads(read(self.path("scene.housing.json")))
        return [housing.get("images", {}).get(name, housing["default"]) for name in self.names]

    def imported(self, names, images, default="none"):
        self.names = names
        self.make(names)
        self.succeeds(*self.command(*self.housing(images, default)))
        return self.ports()


class Names(Base):
    def test_a_base_name_of_several_images_is_refused(self):
        expected = (f"{self.path('port.json')}: housing.images.0000.png matches cam0/0000.png and "
                    "cam1/0000.png")
        for images in ({"0000.png": "main"}, {"0000.png": "none", "0001.png": "main"}):
            self.refuses(expected, *self.command(*self.housing(images, "other")))
        # Without a housing the import succeeds. A scene names images by their paths, so there the
        # base name is ambiguous, too.
        self.succeeds(*self.command())
        before = files_below(self.folder)
        self.refuses(f"{self.path('port.json')}: housing.images.0000.png matches ",
                     "DensifyPointCloud", "-i", self.path("scene.mvs"), "-w", self.folder,
                     *self.housing({"0000.png": "main"}))
        self.assertEqual(files_below(self.folder), before)

    def test_the_same_of_other_programs(self):
        port = self.housing({"0000.png": "main"})
        expected = "housing.images.0000.png matches cam0/0000.png and cam1/0000.png"
        self.refuses(expected, "RefinePoses", "-i", self.path("colmap"), "--lens",
                     self.path("colmap", "sparse"), "-o", self.path("out"), *port)

    def test_lens_files(self):
        self.succeeds(*self.command())
        write(self.path("scene.lenses.json"), json.dumps(
            {"version": 1, "lenses": {}, "default": "none", "images": {"0000.png": "none"}}))
        self.refuses(f"{self.path('scene.lenses.json')}: lenses.images.0000.png matches ",
                     "DensifyPointCloud", "-i", self.path("scene.mvs"), "-w", self.folder)

    def test_names_that_tell_images_apart(self):
        self.assertEqual(self.imported(NAMES, {"cam0/0000.png": "main", "0001.png": "other"}),
                         ["main", "none", "other"])
        # The first image has an entry of its own, so 0000.png can only mean the second image.
        self.assertEqual(self.imported(NAMES, {"cam0/0000.png": "none", "0000.png": "main"}),
                         ["none", "main", "none"])

    def test_a_whole_name_is_that_images_alone(self):
        names = ("0000.png", "cam1/0000.png", "cam1/0001.png")
        for default in ("none", "other"):
            self.assertEqual(self.imported(names, {"0000.png": "main"}, default),
                             ["main", default, default])
        densify = self.succeeds("DensifyPointCloud", "-i", self.path("scene.mvs"), "-w",
                                self.folder, "--refractive", "1", "--resolution-level", "0",
                                "--iters", "1", "--geometric-iters", "0").stdout
        self.assertIn("3 of 3 images behind a port", densify)


class Lines(Base):
    def test_lines_about_ports_name_file_field_and_value(self):
        """The warning about a port that reaches behind the scene."""
        self.make(NAMES)
        far = {**FLAT, "distance_m": 0.995, "thickness_m": 0.4}
        write(self.path("port.json"), json.dumps(
            {"version": 1, "ports": {"main": far}, "default": "main"}))
        said = self.succeeds(*self.command("--housing", self.path("port.json"))).stdout
        line = next(line for line in said.splitlines() if "before the glass" in line)
        self.assertIn(f"{self.path('port.json')}: housing.ports.main.thickness_m is 0.4,", line)


if __name__ == "__main__":
    main()
