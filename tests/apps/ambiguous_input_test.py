# SPDX-License-Identifier: GPL-3.0-or-later
"""Files and images that could be confused: of two possible inputs, the program names the one that it reads, and it
never overwrites an input; an entry of a housing or lens file applies to one image only, or is refused. Also the
memory for an import of many cameras."""

import json
import os
import subprocess
import sys

import tiny_scene
from programs import BIN, ProgramTest, main, png, read, write
from worlds import flat, housing


class Import(ProgramTest):
    def setUp(self):
        super().setUp()
        tiny_scene.write_colmap(self.path("colmap"))

    def command(self, *arguments, output="scene.mvs"):
        return ("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path(output), *arguments)

    def imported(self, *arguments):
        return self.succeeds(*self.command(*arguments)).stdout

    def port(self, name, distance):
        """The option of a new housing file."""
        write(self.path(name), housing(flat(distance_m=distance)))
        return "--housing", self.path(name)

    def test_images_in_two_places(self):
        write(self.path("images", "0001.png"), b"")
        here = ("-w", self.folder)
        ours, other = self.path("colmap", "images"), self.path("images")
        self.assertNotIn("not in", self.imported(*here), "they hold no image of the model")
        write(self.path("images", "0000.png"), b"")
        self.assertIn(f"Images in {ours}/, not in {other}/, which also contains",
                      self.imported(*here))
        self.assertNotIn("not in", self.imported("-w", self.path("colmap")))

    def test_a_housing_beside_the_scene(self):
        port = self.port("port.json", 0.02)
        for _ in range(2):
            self.assertNotIn("differ", self.imported(*port))
        unused = f"{self.path('scene.housing.json')}: is not used ({{}} is used instead), and its ports differ"
        said = self.imported(*self.port("other.json", 0.03))
        self.assertIn(unused.format(self.path("other.json")), said)
        densify = ("DensifyPointCloud", "-i", self.path("scene.mvs"), "-w", self.folder, "--resolution-level", "0",
                   "--iters", "1", "--geometric-iters", "0", "--refractive", "1")
        self.assertNotIn("differ", self.succeeds(*densify).stdout)
        self.assertIn(unused.format(self.path("port.json")), self.succeeds(*densify, *port).stdout)

    def test_a_housing_and_a_model_with_ports(self):
        camera = f"PINHOLE {tiny_scene.WIDTH} {tiny_scene.HEIGHT} {tiny_scene.FOCAL} " \
                 f"{tiny_scene.FOCAL} {tiny_scene.CX} {tiny_scene.CY}"
        write(self.path("colmap", "sparse", "cameras.txt"),
              f"1 {camera} FLATPORT 0 0 1 0.02 0.01 1 1.5 1.33\n")
        self.assertNotIn("differ", self.imported(*self.port("port.json", 0.02)))
        self.assertIn("are used; the ports of the model in", self.imported(*self.port("port.json", 0.03)))



class ManyCameras(ProgramTest):
    WIDTH, HEIGHT, COUNT = 1200, 900, 12

    def peak_of_import(self, cameras):
        """Peak memory [bytes] of undistorting COUNT images that have `cameras` cameras."""
        folder = self.path(f"with_{cameras}")
        write(os.path.join(folder, "sparse", "cameras.txt"), "".join(
            f"{i + 1} SIMPLE_RADIAL {self.WIDTH} {self.HEIGHT} 1000 {self.WIDTH / 2} "
            f"{self.HEIGHT / 2} {-0.01 - 0.001 * i}\n" for i in range(cameras)))
        write(os.path.join(folder, "sparse", "images.txt"), "".join(
            f"{i + 1} 1 0 0 0 {-0.1 * i} 0 0 {i % cameras + 1} {i}.png\n\n"
            for i in range(self.COUNT)))
        write(os.path.join(folder, "sparse", "points3D.txt"), "")
        picture = png([bytes(3 * self.WIDTH)] * self.HEIGHT, 2)
        for i in range(self.COUNT):
            write(os.path.join(folder, "images", f"{i}.png"), picture)
        # RUSAGE_CHILDREN covers all children, so the import is the only child of another process.
        measure = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True, " \
                  "stdout=subprocess.DEVNULL); " \
                  "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
        said = subprocess.run([sys.executable, "-c", measure,
                               os.path.join(BIN, "InterfaceCOLMAP"), "-i", folder,
                               "--undistort", "1", "--max-threads", "1"],
                              check=True, stdout=subprocess.PIPE, text=True)
        return 1024 * int(said.stdout)

    def test_maps_are_in_memory_only_for_images_at_work(self):
        one_map = 8 * self.WIDTH * self.HEIGHT
        one, many = self.peak_of_import(1), self.peak_of_import(self.COUNT)
        self.assertLess(many - one, 2 * one_map, "all maps would be eleven more")


class Names(ProgramTest):
    """Images with the same base name in several folders, in place of 0000.png, 0001.png and 0002.png."""
    NAMES = ("cam0/0000.png", "cam1/0000.png", "cam1/0001.png")

    def setUp(self):
        super().setUp()
        tiny_scene.write_colmap(self.path("colmap"))
        text = read(self.path("colmap", "sparse", "images.txt")).decode()
        for old, new in reversed(list(zip(tiny_scene.names(), self.NAMES))):
            write(self.path("colmap", "images", new), read(self.path("colmap", "images", old)))
            text = text.replace(f" 1 {old}\n", f" 1 {new}\n")
        write(self.path("colmap", "sparse", "images.txt"), text)

    def port(self, images, default="none"):
        write(self.path("port.json"), housing(flat(), default, images=images))
        return "--housing", self.path("port.json")

    def command(self, *arguments):
        return ("InterfaceCOLMAP", "-i", self.path("colmap"), "--image-folder", self.path("colmap", "images"), "-o",
                self.path("scene.mvs"), *arguments)

    def test_a_base_name_of_several_images_is_refused(self):
        expected = f"{self.path('port.json')}: housing.images.0000.png matches "
        for images in ({"0000.png": "main"}, {"0000.png": "none", "0001.png": "main"}):
            self.refuses(expected + "cam0/0000.png and cam1/0000.png", *self.command(*self.port(images, "main")))
        port = self.port({"0000.png": "main"})
        self.refuses(expected + "cam0/0000.png and cam1/0000.png", "RefinePoses", "-i", self.path("colmap"), "--lens",
                     self.path("colmap", "sparse"), "-o", self.path("out"), *port)
        # Without a housing the import succeeds. A scene names images by their paths, so there the
        # base name is ambiguous, too, also in a lens file.
        self.succeeds(*self.command())
        densify = ("DensifyPointCloud", "-i", self.path("scene.mvs"), "-w", self.folder)
        self.refuses(expected, *densify, *port)
        write(self.path("scene.lenses.json"), json.dumps(
            {"version": 1, "lenses": {}, "default": "none", "images": {"0000.png": "none"}}))
        self.refuses(f"{self.path('scene.lenses.json')}: lenses.images.0000.png matches ", *densify)

    def test_names_that_tell_images_apart(self):
        # In the second file the first image has an entry of its own, so 0000.png can only mean the second image.
        for images, expected in (({"cam0/0000.png": "main"}, ["main", "none", "none"]),
                                 ({"cam0/0000.png": "none", "0000.png": "main"}, ["none", "main", "none"])):
            self.succeeds(*self.command(*self.port(images)))
            written = json.loads(read(self.path("scene.housing.json")))
            self.assertEqual([written["images"].get(name, written["default"]) for name in self.NAMES], expected)


if __name__ == "__main__":
    main()
