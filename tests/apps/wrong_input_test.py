# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong input: one clear line, exit code 1, no crash, no partial output."""

import math
import os
import random
import re

import tiny_scene
from programs import ProgramTest, cloud_size, files_below, main, read, write
from readers import Dmap
from tiny_scene import TinyScene
from worlds import flat, housing, ply

DENSIFY = ("DensifyPointCloud", "--max-threads", "1", "--resolution-level", "0")


class InterfaceColmap(ProgramTest):
    def setUp(self):
        super().setUp()
        tiny_scene.write_colmap(self.path("colmap"))

    def convert(self, *arguments):
        return ("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("scene.mvs"), *arguments)

    def refuses_import(self, expected, *arguments, **options):
        self.refuses(expected, *self.convert(*arguments), **options)

    def test_the_model_itself_is_accepted(self):
        self.succeeds(*self.convert())
        self.assertIn("scene.mvs", files_below(self.folder))

    def test_options_that_are_not_built(self):
        self.refuses("not built", "InterfaceCOLMAP", "-i", self.path("colmap"), "-p", "a.ply")

    def test_no_model(self):
        for name in ("cameras", "images", "points3D"):
            path = self.path("colmap", "sparse", name + ".txt")
            content = read(path)
            os.remove(path)
            self.refuses_import("sparse")
            write(path, content)

    def test_images_that_do_not_fit(self):
        path = self.path("colmap", "images", "0001.png")
        write(path, tiny_scene.picture((0, 0, 0), 48, 48))
        self.refuses_import("0001.png: image is 48 x 48, but its camera is 96 x 72")
        os.remove(path)
        self.refuses_import("0001.png: image not found (--allow-missing continues without it)")
        said = self.succeeds(*self.convert("--allow-missing")).stdout
        self.assertRegex(said, "warning: .*0001.png: image not found; it is not used")
        self.assertRegex(said, "scene.mvs: 2 images, ")
        os.remove(self.path("scene.mvs"))
        write(path, b"")
        self.refuses_import("0001.png")
        self.refuses_import("no-such-folder", "--image-folder", "no-such-folder")

    def test_images_that_lie_about(self):
        # These images have another size, so that an import of them would fail.
        for image in ("0000.png", "0001.png", "0002.png"):
            write(self.path("images", image), tiny_scene.picture((0, 0, 0), 48, 48))
        here = ("-w", self.folder)
        result = self.succeeds(*self.convert(*here))
        self.assertIn(f"Images in {self.path('colmap', 'images')}", result.stdout)
        os.remove(self.path("scene.mvs"))
        self.refuses_import(self.path("images", "000"), "--image-folder", "images", *here)

    def test_ports_that_the_poses_were_solved_without(self):
        """COLMAP-Underwater's files hold ports whether or not the poses were solved with them. Only
        the tracks show the difference."""
        sparse = self.path("colmap", "sparse")
        camera = f"PINHOLE {tiny_scene.WIDTH} {tiny_scene.HEIGHT} " \
                 f"{tiny_scene.FOCAL} {tiny_scene.FOCAL} {tiny_scene.CX} {tiny_scene.CY}"
        # A port directly at the lens only multiplies the sines of angles by the index.
        write(os.path.join(sparse, "cameras.txt"), f"1 {camera} FLATPORT 0 0 1 0 0 1 1.333 1.333\n")
        warning = "the poses were computed without refraction"
        said = self.succeeds(*self.convert()).stdout
        self.assertIn("The points have an error of 0.000 px in air: " + warning, said)

        def through_the_port(u, v, point):
            x, y = (u - tiny_scene.CX) / tiny_scene.FOCAL, (v - tiny_scene.CY) / tiny_scene.FOCAL
            factor = 1.333 / math.sqrt(1 + (1 - 1.333 ** 2) * (x * x + y * y))
            return (tiny_scene.CX + factor * (u - tiny_scene.CX),
                    tiny_scene.CY + factor * (v - tiny_scene.CY), int(point))

        path = os.path.join(sparse, "images.txt")
        lines = read(path).decode().splitlines()
        for i in range(1, len(lines), 2):
            numbers = [float(number) for number in lines[i].split()]
            lines[i] = " ".join(str(number) for k in range(0, len(numbers), 3)
                                for number in through_the_port(*numbers[k:k + 3]))
        write(path, "\n".join(lines) + "\n")
        said = self.succeeds(*self.convert()).stdout
        self.assertIn("have ports: its points have an error of 0.000 px", said)
        self.assertNotIn(warning, said)

    def test_wrong_housings(self):
        path = self.path("housing.json")
        self.refuses_contents(path, self.convert("--housing", path), ("housing.json", "{"),
                              ("distance_m", housing(flat(distance_m=20))))


class Densify(TinyScene):
    def densified(self, *arguments):
        return self.command(*DENSIFY, *arguments)

    def refuses_scene(self, expected, *arguments, **options):
        return self.refuses(expected, *self.densified(*arguments), **options)

    def refuses_options(self, *cases):
        self.refuses_each(self.densified(), *cases)

    def test_the_scene_itself_is_accepted(self):
        self.succeeds(*self.densified("--number-views-fuse", "2"))
        self.assertIn("work/scene_dense.ply", files_below(self.folder))

    def test_command_line(self):
        self.refuses_options(
            ("iters", "--iters", "many"), ("--tower-mode", "--tower-mode", "9"),
            ("not built yet", "--sub-scene-area", "660000"), ("camera-model", "--camera-model", "fisheye"),
            ("housing", "--refractive"), ("housing file not found", "--refractive", "1"),
            ("--number-views-fuse -1", "--number-views-fuse", "-1"), ("--max-memory -1", "--max-memory", "-1"),
            *(("--roi-border", "--roi-border", border) for border in ("nan", "inf", "-inf")))

    def test_byte_order_marks(self):
        """A byte order mark at the start of a text file changes nothing."""
        mark = b"\xef\xbb\xbf"
        for option, text in (("--view-neighbors-file", b"0 1\n1 2\n2 1\n"),
                             ("--dense-config-file", b"Min Views Trust Point = 3\n")):
            clouds = []
            for before in (b"", mark):
                write(self.path("given.txt"), before + text)
                said = self.succeeds(*self.densified("--number-views-fuse", "2", option,
                                                    self.path("given.txt"))).stdout
                self.assertNotIn("given.txt", said)
                clouds.append(self.at("scene_dense.ply"))
            self.assertEqual(clouds[0], clouds[1], option)

    def test_wrong_scenes(self):
        whole = read(self.scene)
        self.refuses_contents(
            self.scene, self.densified(),
            *(("scene.mvs", whole[:length]) for length in (0, 11, len(whole) // 2, len(whole) - 1)),
            ("scene.mvs", b"MVSI\x07\0\0\0\0\0\0\0" + random.Random(2).randbytes(4000)),
            ("99", tiny_scene.mvs(self.images, version=99)), ("scene.mvs", tiny_scene.mvs(self.images, pose=3)),
            ("", tiny_scene.mvs(self.images[:1], centres=[(0, 0, 0)], points=[])))

    def test_a_folder_that_cannot_be_written(self):
        self.refuses("/proc", *DENSIFY, "-i", self.scene, "-w", "/proc")

    def test_too_little_memory(self):
        for least in ("1", "30"):
            said = self.refuses_scene(f"--max-memory {least}: ", "--max-memory", least)
        needed = re.search(r"needs (\d+)", said.stderr)[1]
        self.refuses_scene(needed, "--max-memory", int(needed) // 2)
        self.succeeds(*self.densified("--max-memory", needed))

    def test_full_disk_under_the_cloud(self):
        cloud = self.path("work", "scene_dense.ply")
        command = self.densified("--number-views-fuse", "1", "--postprocess-dmaps", "0")
        self.succeeds(*command)
        largest = max(os.path.getsize(self.path(name)) for name in files_below(self.folder)
                      if name != "work/scene_dense.ply")
        self.assertGreater(len(read(cloud)), largest + 1000)
        os.remove(cloud)
        self.refuses("scene_dense.ply: cannot be written: ", *command, file_size_limit=largest + 1000)

    def test_an_empty_cloud_is_a_warning(self):
        # The region shrinks to a millionth of its size, so that no point is left.
        said = self.succeeds(*self.densified("--estimate-roi", "1", "--roi-border", "1e-6")).stdout
        self.assertIn("The cloud is empty", said)
        self.assertEqual(cloud_size(self.at("scene_dense.ply")), 0)
        said = self.succeeds(*self.densified("--number-views-fuse", "0", "--crop-to-roi", "0")).stdout
        self.assertNotIn("The cloud is empty", said)
        merged = cloud_size(self.at("scene_dense.ply"))
        valid = sum(depth > 0 for name in files_below(self.path("work")) if name.endswith(".dmap")
                    for row in Dmap(read(self.path("work", name))).rows for depth in row)
        self.assertEqual(merged, valid)

    def test_tiles(self):
        self.refuses_options(
            *((name, f"--{name}", tiles) for name in ("tiles", "fusion-tiles") for tiles in ("0", "-1", "1001", "x")),
            *((f"--tile {tile}: ", "--tile", tile) for tile in (
                "x", "2", "/", "1/", "/4", "1/4/5", "a/4", "-1/4", "0/4", "3/2", "1/0", "1/1001", " 1/2")),
            *(("--tile 2/4: contradicts --tiles 3", "--tile", "2/4", name, "3")
              for name in ("--tiles", "--fusion-tiles")),
            ("--fusion-tiles 3: contradicts --tiles 2", "--fusion-tiles", "3", "--tiles", "2"),
            *((" ".join(tiles) + said, *tiles, *more) for tiles in (("--tile", "2/4"), ("--tiles", "4"))
              for said, *more in ((": needs fusion", "--fusion-mode", "1"), (": needs fusion", "--estimate-scale", "1"),
                                  (": contradicts --estimate-colors 1", "--estimate-colors", "1"),
                                  (": contradicts --estimate-normals 1", "--estimate-normals", "1"))),
            ("--tile 1/2: contradicts --pinhole-export", "--tile", "1/2", "--pinhole-export", self.path("pinholes")),
            ("depth map does not exist, and --tile makes no depth maps", "--tile", "1/2"))


class OtherPrograms(ProgramTest):
    def test_evaluation_of_a_cloud_elsewhere(self):
        for name, place in (("here.ply", 0), ("elsewhere.ply", 600000)):
            write(self.path(name), ply([(place, 0, 1), (place, 1, 1), (place, 0, 2)], [(0, 1, 2)]))
        for align in ("none", "icp"):
            self.refuses("do not have the same coordinates", "EvaluateReconstruction", "-i", self.path("elsewhere.ply"),
                         "-m", self.path("here.ply"), "--align", align)


if __name__ == "__main__":
    main()
