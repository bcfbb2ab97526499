# SPDX-License-Identifier: GPL-3.0-or-later
"""Files and images that could be confused: of two possible inputs, the program names the one that it reads. Also the
memory for an import of many cameras."""

import os
import subprocess
import sys

import tiny_scene
from programs import BIN, ProgramTest, main, png, write
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


if __name__ == "__main__":
    main()
