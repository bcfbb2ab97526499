# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that could be confused: of two possible inputs, the program names the one that it reads,
and it never overwrites an input. Also the memory for an import of many cameras."""

import os
import subprocess
import sys

import tiny_scene
from programs import BIN, ProgramTest, files_below, main, read, write

PORT = '{"version": 1, "ports": {"main": {"type": "flat", "distance_m": %s, "thickness_m": 0.01, ' \
       '"normal": [0, 0, 1], "n_air": 1, "n_glass": 1.5, "n_water": 1.33}}, "default": "main"}'


class Import(ProgramTest):
    def setUp(self):
        super().setUp()
        tiny_scene.write_colmap(self.path("colmap"))

    def imported(self, *arguments):
        return self.succeeds("InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                             self.path("scene.mvs"), *arguments).stdout

    def test_a_stale_text_file_beside_a_model(self):
        """A cameras.bin alone, beside a complete model in text form, is named and not read."""
        text = self.imported()
        self.assertNotIn("differ", text)
        scene = read(self.path("scene.mvs"))
        sparse = self.path("colmap", "sparse")
        write(os.path.join(sparse, "cameras.bin"), b"stale")
        said = self.imported()
        self.assertIn("cameras.txt is read, as in COLMAP; ignored: cameras.bin", said)
        self.assertEqual(read(self.path("scene.mvs")), scene)

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
        write(self.path("port.json"), PORT % 0.02)
        self.assertNotIn("differ", self.imported("--housing", self.path("port.json")))
        self.assertNotIn("differ", self.imported("--housing", self.path("port.json")))
        write(self.path("other.json"), PORT % 0.03)
        said = self.imported("--housing", self.path("other.json"))
        self.assertIn(f"{self.path('scene.housing.json')}: is not used "
                      f"({self.path('other.json')} is used instead), and its ports differ", said)
        densify = ("DensifyPointCloud", "-i", self.path("scene.mvs"), "-w", self.folder,
                   "--resolution-level", "0", "--iters", "1", "--geometric-iters", "0",
                   "--refractive", "1")
        self.assertNotIn("differ", self.succeeds(*densify).stdout)
        said = self.succeeds(*densify, "--housing", self.path("port.json")).stdout
        self.assertIn(f"{self.path('scene.housing.json')}: is not used "
                      f"({self.path('port.json')} is used instead), and its ports differ", said)

    def test_a_housing_and_a_model_with_ports(self):
        camera = f"PINHOLE {tiny_scene.WIDTH} {tiny_scene.HEIGHT} {tiny_scene.FOCAL} " \
                 f"{tiny_scene.FOCAL} {tiny_scene.CX} {tiny_scene.CY}"
        write(self.path("colmap", "sparse", "cameras.txt"),
              f"1 {camera} FLATPORT 0 0 1 0.02 0.01 1 1.5 1.33\n")
        write(self.path("port.json"), PORT % 0.02)
        self.assertNotIn("differ", self.imported("--housing", self.path("port.json")))
        write(self.path("port.json"), PORT % 0.03)
        self.assertIn("are used; the ports of the model in",
                      self.imported("--housing", self.path("port.json")))

    def test_nothing_that_is_read_is_written_over(self):
        """Under any name: its own, that of a link, and that of a file written beside the scene."""
        sparse, images = self.path("colmap", "sparse"), self.path("colmap", "images")
        write(self.path("lake.housing.json"), PORT % 0.02)
        os.symlink(os.path.join(images, "0001.png"), self.path("symbolic.mvs"))
        os.link(os.path.join(sparse, "points3D.txt"), self.path("hard.mvs"))
        outputs = [os.path.join(sparse, name + ".txt") for name in ("cameras", "images", "points3D")]
        outputs += [os.path.join(images, "0000.png"), self.path("symbolic.mvs"),
                    self.path("hard.mvs"), self.path("lake.mvs")]
        before = {name: read(self.path(name)) for name in files_below(self.folder)}
        for output in outputs:
            self.refuses("--output-file " + output.replace("lake.mvs", "lake.housing.json"),
                         "InterfaceCOLMAP", "-i", self.path("colmap"), "-o", output, "--housing",
                         self.path("lake.housing.json"))
            self.assertEqual(before,
                             {name: read(self.path(name)) for name in files_below(self.folder)})

    def test_two_images_of_one_name(self):
        path = self.path("colmap", "sparse", "images.txt")
        write(path, read(path).replace(b"0002.png", b"./0001.png"))
        self.refuses("images 2 and 3 have the same name", "InterfaceCOLMAP", "-i",
                     self.path("colmap"), "-o", self.path("scene.mvs"))

    def test_two_images_that_undistort_to_one_name(self):
        tiny_scene.write_colmap(self.path("colmap"), f"SIMPLE_RADIAL {tiny_scene.WIDTH} "
                                f"{tiny_scene.HEIGHT} {tiny_scene.FOCAL} {tiny_scene.CX} "
                                f"{tiny_scene.CY} -0.05")
        path = self.path("colmap", "sparse", "images.txt")
        write(path, read(path).replace(b"0000.png", b"a.jpg").replace(b"0001.png", b"a.JPG"))
        for name in ("a.jpg", "a.JPG"):  # the content tells an image's format
            write(self.path("colmap", "images", name), tiny_scene.picture((0, 0, 0)))
        self.refuses("the images a.jpg and a.JPG would both be undistorted to",
                     "InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("scene.mvs"))
        self.assertNotIn("undistorted", os.listdir(self.folder))


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
        picture = tiny_scene.png(self.WIDTH, self.HEIGHT, [bytes(3 * self.WIDTH)] * self.HEIGHT)
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
