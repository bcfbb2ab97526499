# SPDX-License-Identifier: GPL-3.0-or-later
"""Wrong input: one clear line, exit code 1, no crash, no partial output."""

import math
import os
import random
import re

import tiny_scene
from programs import (ProgramTest, cloud_size, depth_rows, files_below, grey_png, main, read, run,
                      write)

DENSIFY = ("DensifyPointCloud", "--max-threads", "1")


class InterfaceColmap(ProgramTest):
    def setUp(self):
        super().setUp()
        tiny_scene.write_colmap(self.path("colmap"))

    def refuses_import(self, expected, *arguments, **options):
        self.refuses(expected, "InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                     self.path("scene.mvs"), *arguments, **options)

    def test_the_model_itself_is_accepted(self):
        self.succeeds("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("scene.mvs"))
        self.assertIn("scene.mvs", files_below(self.folder))

    def test_unknown_option(self):
        self.refuses_import("'--no-such-option'", "--no-such-option", "1")

    def test_options_that_are_not_built(self):
        self.refuses("not built", "InterfaceCOLMAP", "-i", self.path("colmap"), "-p", "a.ply")

    def test_no_model(self):
        for name in ("cameras", "images", "points3D"):
            path = self.path("colmap", "sparse", name + ".txt")
            content = read(path)
            os.remove(path)
            self.refuses_import("sparse")
            write(path, content)

    def test_truncated_and_garbage_models(self):
        rng = random.Random(1)
        for name in ("cameras.txt", "images.txt", "points3D.txt"):
            path = self.path("colmap", "sparse", name)
            content = read(path)
            cut = content.rindex(b" ")  # in the middle of the last record
            garbage = bytes(rng.randrange(1, 256) for _ in range(500))
            for wrong in (content[:cut], garbage, b"x y z\n"):
                write(path, wrong)
                result = run("InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                             self.path("scene.mvs"))
                said = f"{name}: {result.returncode} {result.stderr!r}"
                self.assertEqual(result.returncode, 1, said)
                self.assertIn(name, result.stderr, said)
                self.assertEqual(result.stderr.count("\n"), 1, said)
                self.assertNotIn("scene.mvs", files_below(self.folder), said)
            write(path, content)

    def test_wrong_values(self):
        cases = [("cameras.txt", b"1 PINHOLE 96 72 90.0", b"1 PINHOLE 96 72 0", "cameras"),
                 ("cameras.txt", b"90.0 90.0", b"nan 90.0", "cameras"),
                 ("cameras.txt", b"PINHOLE", b"NO_SUCH_MODEL", "NO_SUCH_MODEL"),
                 ("cameras.txt", b"1 PINHOLE", b"7 PINHOLE", "camera"),
                 ("images.txt", b"1 1 0 0 0", b"1 nan 0 0 0", "images"),
                 ("images.txt", b"1 1 0 0 0", b"1 0 0 0 0", "images")]
        for name, old, new, expected in cases:
            path = self.path("colmap", "sparse", name)
            content = read(path)
            self.assertIn(old, content)
            write(path, content.replace(old, new, 1))
            self.refuses_import(expected)
            write(path, content)

    def test_images_that_do_not_fit(self):
        path = self.path("colmap", "images", "0001.png")
        write(path, tiny_scene.picture((0, 0, 0), 48, 48))
        self.refuses_import("0001.png: image is 48 x 48, but its camera is 96 x 72")
        os.remove(path)
        self.refuses_import("0001.png")
        write(path, b"")
        self.refuses_import("0001.png")
        self.refuses_import("no-such-folder", "--image-folder", "no-such-folder")

    def test_images_that_lie_about(self):
        # These images have another size, so that an import of them would fail.
        for image in ("0000.png", "0001.png", "0002.png"):
            write(self.path("images", image), tiny_scene.picture((0, 0, 0), 48, 48))
        here = ("-w", self.folder)
        result = self.succeeds("InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                               self.path("scene.mvs"), *here)
        self.assertIn(f"Images in {self.path('colmap', 'images')}", result.stdout)
        os.remove(self.path("scene.mvs"))
        self.refuses_import(self.path("images", "000"), "--image-folder", "images", *here)

    def test_masks_that_do_not_fit(self):
        camera = "SIMPLE_RADIAL 96 72 90.0 48.0 36.0 -0.05"
        write(self.path("colmap", "sparse", "cameras.txt"), f"1 {camera}\n")
        write(self.path("colmap", "images", "0001.mask.png"), grey_png([bytes(72)] * 72))
        self.refuses_import("0001.mask.png: is 72x72, but its image is 96x72")

    def test_ports_that_the_poses_were_solved_without(self):
        """COLMAP-Underwater's files hold ports whether or not the poses were solved with them. Only
        the tracks show the difference."""
        sparse = self.path("colmap", "sparse")
        camera = f"PINHOLE {tiny_scene.WIDTH} {tiny_scene.HEIGHT} " \
                 f"{tiny_scene.FOCAL} {tiny_scene.FOCAL} {tiny_scene.CX} {tiny_scene.CY}"
        # A port directly at the lens only multiplies the sines of angles by the index.
        write(os.path.join(sparse, "cameras.txt"), f"1 {camera} FLATPORT 0 0 1 0 0 1 1.333 1.333\n")
        convert = ("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("scene.mvs"))
        warning = "the poses were computed without refraction"
        said = self.succeeds(*convert).stdout
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
        said = self.succeeds(*convert).stdout
        self.assertIn("have ports: its points have an error of 0.000 px", said)
        self.assertNotIn(warning, said)

    def test_wrong_housings(self):
        housing = self.path("housing.json")
        port = '{"type": "flat", "distance_m": %s, "thickness_m": 0.01, "normal": [0, 0, 1], ' \
               '"n_air": 1, "n_glass": 1.5, "n_water": %s}'
        whole = '{"version": 1, "ports": {"main": ' + port + '}, "default": "main"}'
        for text, expected in (("", "housing.json"), ("{", "housing.json"),
                               (whole % ("20", "1.33"), "distance_m"),
                               (whole % ("0.02", "0.5"), "n_water"),
                               (whole % ("0.02", '"wet"'), "n_water"),
                               ((whole % ("0.02", "1.33"))[:-1] + ', "colour": 3}', "colour"),
                               ((whole % ("0.02", "1.33")).replace('t": "main"', 't": "x"'), "x")):
            write(housing, text)
            self.refuses_import(expected, "--housing", housing)

    def test_water_surfaces_that_images_do_not_look_into(self):
        housing = self.path("lake.json")
        lake = '{"version": 1, "ports": {"lake": {"type": "water-surface", "normal": %s, ' \
               '"point_m": [0, 0, %s], "n_water": %s}}, "default": "lake"}'
        # The cameras look along +z from z = 0.
        for values, expected in (
                (("[0, 0, 1]", "-0.5", "1.33"),
                 "0000.png: its port 'lake': the camera's height over the water surface is -0.5 m"),
                (("[0, 0, 1]", "0", "1.33"), "water surface is 0 m"),
                (("[0, 0, -1]", "-0.5", "1.33"), "0000.png: its port 'lake': the camera looks away"),
                (("[0, 0, 0]", "0.5", "1.33"), "lake.json: housing.ports.lake.normal"),
                (("[0, 0, 1]", "0.5", "0.9"), "lake.json: housing.ports.lake.n_water is 0.9")):
            write(housing, lake % values)
            self.refuses_import(expected, "--housing", housing)
        write(housing, lake % ("[0, 0, 1]", "5", "1.33"))
        said = self.succeeds("InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                             self.path("scene.mvs"), "--housing", housing).stdout
        self.assertIn("lake.json: housing.ports.lake.point_m or normal is wrong: 180 of 180", said)
        write(housing, lake % ("[0, 0.1, 1]", "0.5", "1.33"))
        self.succeeds("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("scene.mvs"),
                      "--housing", housing)

    def test_unwritable_folders(self):
        write(self.path("a_file"), "")
        for output in ("/proc/scene.mvs", self.path("a_file", "scene.mvs")):
            self.refuses("", "InterfaceCOLMAP", "-i", self.path("colmap"), "-o", output)

    def test_full_disk(self):
        self.refuses_import("scene.mvs", file_size_limit=100)


class Densify(ProgramTest):
    def setUp(self):
        super().setUp()
        self.images = [self.path("images", name) for name in tiny_scene.names()]
        for path, centre in zip(self.images, tiny_scene.CENTRES):
            write(path, tiny_scene.picture(centre))
        self.scene = self.path("work", "scene.mvs")
        write(self.scene, tiny_scene.mvs(self.images))

    def refuses_scene(self, expected, *arguments, **options):
        return self.refuses(expected, *DENSIFY, "-i", self.scene, "-w", self.path("work"),
                            "--resolution-level", "0", *arguments, **options)

    def test_the_scene_itself_is_accepted(self):
        self.succeeds(*DENSIFY, "-i", self.scene, "-w", self.path("work"), "--resolution-level",
                      "0", "--number-views-fuse", "2")
        self.assertIn("work/scene_dense.ply", files_below(self.folder))

    def test_command_line(self):
        self.refuses_scene("'--no-such-option'", "--no-such-option", "1")
        self.refuses_scene("iters", "--iters", "many")
        self.refuses_scene("--tower-mode", "--tower-mode", "9")
        self.refuses_scene("not built yet", "--sub-scene-area", "660000")
        self.refuses_scene("camera-model", "--camera-model", "fisheye")
        self.refuses_scene("housing", "--refractive")
        self.refuses("no-such.mvs", *DENSIFY, "-i", self.path("no-such.mvs"), "-w",
                     self.path("work"))

    def test_byte_order_marks(self):
        """A byte order mark at the start of a text file changes nothing."""
        mark = b"\xef\xbb\xbf"
        run = (*DENSIFY, "-i", self.scene, "-w", self.path("work"), "--resolution-level", "0",
               "--number-views-fuse", "2")
        for option, text in (("--view-neighbors-file", b"0 1\n1 2\n2 1\n"),
                             ("--dense-config-file", b"Min Views Trust Point = 3\n")):
            clouds = []
            for before in (b"", mark):
                write(self.path("given.txt"), before + text)
                said = self.succeeds(*run, option, self.path("given.txt")).stdout
                self.assertNotIn("given.txt", said)
                clouds.append(read(self.path("work", "scene_dense.ply")))
            self.assertEqual(clouds[0], clouds[1], option)

    def test_truncated_scenes(self):
        whole = read(self.scene)
        lengths = sorted({0, 1, 3, 4, 8, 11, 12, 20, len(whole) - 1, len(whole) - 120} |
                         {len(whole) * i // 12 for i in range(12)})
        for length in lengths:
            write(self.scene, whole[:length])
            self.refuses_scene("scene.mvs")

    def test_garbage_scenes(self):
        rng = random.Random(2)
        garbage = bytes(rng.randrange(256) for _ in range(4000))
        for content in (garbage, b"MVSI" + garbage, b"MVSI\x07\0\0\0\0\0\0\0" + garbage,
                        b"MVS\0" + garbage, b"MVSI\x07\0\0\0\0\0\0\0" + b"\xff" * 4000):
            write(self.scene, content)
            self.refuses_scene("scene.mvs")
        write(self.scene, tiny_scene.mvs(self.images, version=99))
        self.refuses_scene("99")

    def test_wrong_values(self):
        nan = tiny_scene.NAN
        for wrong in ({"platform": 3}, {"camera": 3}, {"pose": 3}, {"view": 3},
                      {"k": (0, 0, 48, 0, 0, 36, 0, 0, 1)}, {"k": (nan, 0, 48, 0, 90, 36, 0, 0, 1)},
                      {"rotation": (nan,) * 9}, {"rotation": (1, 0, 0, 0, 1, 0, 0, 0, 2)},
                      {"centres": [(nan, 0, 0)] * 3}):
            write(self.scene, tiny_scene.mvs(self.images, **wrong))
            self.refuses_scene("scene.mvs")

    def test_scenes_too_small(self):
        write(self.scene, tiny_scene.mvs(self.images[:1], centres=[(0, 0, 0)], points=[]))
        self.refuses_scene("")

    def test_missing_image(self):
        os.remove(self.images[1])
        self.refuses_scene("0001.png")

    def test_truncated_image(self):
        content = read(self.images[1])
        for length in (0, 10, 100, len(content) // 2):
            write(self.images[1], content[:length])
            self.refuses_scene("0001.png")

    def test_image_of_another_shape(self):
        write(self.images[1], tiny_scene.picture((0, 0, 0), 72, 72))
        self.refuses_scene("0001.png")

    def test_mask_of_another_shape(self):
        for name in tiny_scene.names():
            write(self.path("images", name.replace(".png", ".mask.png")),
                  grey_png([bytes([1] * 48)] * 36))
        mask = self.path("images", "0001.mask.png")
        write(mask, grey_png([bytes([1] * 72)] * 72))
        self.refuses_scene(mask + ": is 72x72, but its image is 96x72", "--ignore-mask-label", "0")
        write(mask, grey_png([bytes([1] * 24)] * 18))  # smaller, of the same shape: accepted
        self.succeeds(*DENSIFY, "-i", self.scene, "-w", self.path("work"), "--resolution-level",
                      "0", "--iters", "1", "--geometric-iters", "0", "--ignore-mask-label", "0")

    def test_unwritable_folders(self):
        write(self.path("a_file"), "")
        for output in ("/proc/scene_dense.mvs", self.path("a_file", "scene_dense.mvs")):
            result = run(*DENSIFY, "-i", self.scene, "-w", self.path("work"), "-o", output,
                         "--iters", "1", "--geometric-iters", "0")
            said = f"exit code {result.returncode}, said: {result.stderr!r}"
            self.assertEqual(result.returncode, 1, said)
            self.assertEqual(result.stderr.count("\n"), 1, said)
            self.assertIn("scene_dense", result.stderr, said)
        self.refuses("", *DENSIFY, "-i", self.scene, "-w", "/proc")

    def test_full_disk(self):
        self.refuses_scene("dmap", file_size_limit=5000)

    def test_too_little_memory(self):
        self.refuses_scene("--max-memory -1", "--max-memory", "-1")
        for least in ("1", "30"):
            said = self.refuses_scene(f"--max-memory {least}: ", "--max-memory", least)
        needed = re.search(r"needs (\d+)", said.stderr)[1]
        self.refuses_scene(needed, "--max-memory", int(needed) // 2)
        self.succeeds(*DENSIFY, "-i", self.scene, "-w", self.path("work"), "--resolution-level",
                      "0", "--max-memory", needed)

    def test_full_disk_under_the_cloud(self):
        cloud = self.path("work", "scene_dense.ply")
        here = ("-i", self.scene, "-w", self.path("work"), "--resolution-level", "0",
                "--number-views-fuse", "1", "--postprocess-dmaps", "0")
        self.succeeds(*DENSIFY, *here)
        largest = max(os.path.getsize(self.path(name)) for name in files_below(self.folder)
                      if name != "work/scene_dense.ply")
        before = read(cloud)
        self.assertGreater(len(before), largest + 1000)
        os.remove(cloud)
        self.refuses("scene_dense.ply: cannot be written: ", *DENSIFY, *here,
                     file_size_limit=largest + 1000)

    def test_an_empty_cloud_is_a_warning(self):
        here = ("-i", self.scene, "-w", self.path("work"), "--resolution-level", "0")
        # The region shrinks to a millionth of its size, so that no point is left.
        said = self.succeeds(*DENSIFY, *here, "--estimate-roi", "1", "--roi-border", "1e-6").stdout
        self.assertIn("The cloud is empty", said)
        self.assertEqual(cloud_size(read(self.path("work", "scene_dense.ply"))), 0)
        said = self.succeeds(*DENSIFY, *here, "--number-views-fuse", "0",
                             "--crop-to-roi", "0").stdout
        self.assertNotIn("The cloud is empty", said)
        merged = cloud_size(read(self.path("work", "scene_dense.ply")))
        valid = sum(depth > 0 for name in files_below(self.path("work")) if name.endswith(".dmap")
                    for row in depth_rows(read(self.path("work", name))) for depth in row)
        self.assertEqual(merged, valid)

    def test_numbers_out_of_range(self):
        for border in ("nan", "inf", "-inf"):
            self.refuses_scene("--roi-border", "--roi-border", border)
        self.refuses_scene("--number-views-fuse -1", "--number-views-fuse", "-1")
        self.refuses_scene("housing file not found", "--refractive", "1")

    def test_tiles(self):
        for tiles in ("0", "-1", "1001", "x"):
            self.refuses_scene("fusion-tiles", "--fusion-tiles", tiles)
        for tile in ("x", "2", "/", "1/", "/4", "1/4/5", "a/4", "-1/4", "0/4", "3/2", "1/0",
                     "1/1001", " 1/2"):
            self.refuses_scene(f"--tile {tile}: ", "--tile", tile)
        self.refuses_scene("--tile 2/4: contradicts --fusion-tiles 3", "--tile", "2/4",
                           "--fusion-tiles", "3")
        for tiles in (("--tile", "2/4"), ("--fusion-tiles", "4")):
            said = " ".join(tiles)
            self.refuses_scene(f"{said}: needs fusion", *tiles, "--fusion-mode", "1")
            self.refuses_scene(f"{said}: needs fusion", *tiles, "--estimate-scale", "1")
            for option in ("--estimate-colors", "--estimate-normals"):
                self.refuses_scene(f"{said}: contradicts {option} 1", *tiles, option, "1")
        self.refuses_scene("--tile 1/2: contradicts --pinhole-export", "--tile", "1/2",
                           "--pinhole-export", self.path("pinholes"))
        self.refuses_scene("depth map does not exist, and --tile makes no depth maps", "--tile",
                           "1/2")

    def test_tiles_of_several_runs_are_joined(self):
        here = (*DENSIFY, "-i", self.scene, "-w", self.path("work"), "--resolution-level", "0",
                "--number-views-fuse", "2")
        cloud = self.path("work", "scene_dense.ply")
        self.succeeds(*here, "--fusion-tiles", "3")
        expected = read(cloud)
        self.assertGreater(cloud_size(expected), 100)
        os.remove(cloud)
        before = files_below(self.folder)
        for tile in ("3/3", "1/3", "2/3"):
            self.succeeds(*here, "--tile", tile)
        self.assertEqual(files_below(self.folder) - before,
                         {f"work/scene_dense.tile{i}-3.ply{end}" for i in (1, 2, 3)
                          for end in ("", ".json")})
        self.succeeds(*here, "--fusion-tiles", "3")
        self.assertEqual(read(cloud), expected)
        self.assertEqual(files_below(self.folder) - before, {"work/scene_dense.ply"})


class OtherPrograms(ProgramTest):
    def test_simulator(self):
        self.refuses("no-such-preset", "SimulateUnderwater", "--preset", "no-such-preset", "-o",
                     self.path("out"))
        self.refuses("'--no-such-option'", "SimulateUnderwater", "--no-such-option", "1")
        self.refuses("'closeup'", "SimulateUnderwater", "closeup", "-o", self.path("out"))

    def test_evaluation(self):
        write(self.path("garbage.ply"), b"ply\nformat binary\n\xff\xff")
        self.refuses("garbage.ply", "EvaluateReconstruction", "-i", self.path("garbage.ply"), "-m",
                     self.path("garbage.ply"))
        triangle = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                    "end_header\n{0} 0 1\n{0} 1 1\n{0} 0 2\n3 0 1 2\n")
        for name, place in (("here.ply", 0), ("elsewhere.ply", 600000)):
            write(self.path(name), triangle.format(place))
        for align in ("none", "icp"):
            self.refuses("do not have the same coordinates", "EvaluateReconstruction", "-i",
                         self.path("elsewhere.ply"), "-m", self.path("here.ply"), "--align", align)
        self.refuses("no-such.ply", "EvaluateReconstruction", "-i", self.path("no-such.ply"), "-m",
                     self.path("garbage.ply"))
        self.refuses("'--no-such-option'", "EvaluateReconstruction", "--no-such-option", "1")


if __name__ == "__main__":
    main()
