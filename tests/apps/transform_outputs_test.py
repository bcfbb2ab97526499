# SPDX-License-Identifier: GPL-3.0-or-later
"""TransformScene writes all outputs or none, and refuses wrong input."""

import math
import os
import re

import tiny_scene
from programs import contents, files_below, main, read, write
from readers import Mvs
from transform_scene_test import CUBE, CUBE_FACES, Transform
from worlds import flat, ply


class Outputs(Transform):
    """An error leaves no output, and the files of an earlier run as they were."""

    def refused_and_nothing_changed(self, expected, *arguments):
        self.refused(expected, *arguments)  # into a new place
        self.assertFalse(os.path.exists(self.path("work", "images48")))
        for name in ("moved.mvs", "moved.ply", "moved_mesh.ply", "moved.housing.json", "out.txt",
                     os.path.join("images48", "0000.png")):
            write(self.path("work", name), "old")
        self.refused(expected, *arguments)

    def everything(self):
        self.port(flat())
        return ("-t", self.path("t.txt"), "--scale-ports", "-p", "cloud.ply", "-m", "mesh.ply",
                "--transform-out", self.path("work", "out.txt"), "--max-resolution", 48)

    def test_a_bad_mesh_after_a_good_cloud(self):
        write(self.mesh, read(self.mesh)[:-9])
        self.refused_and_nothing_changed("mesh.ply", *self.everything())

    def test_a_bad_image_after_good_images(self):
        image = self.images[-1]
        write(image, read(image)[:len(read(image)) // 2])  # the header of the file is good
        self.refused_and_nothing_changed(image, *self.everything())

    def test_a_volume_that_is_not_defined(self):
        self.refused_and_nothing_changed("mesh.ply: it is not closed", *self.everything(),
                                         "--compute-volume", 1, "--plane-threshold", -1)

    def test_files_of_an_earlier_run_are_replaced(self):
        arguments = self.everything()
        self.transform(*arguments)
        first = contents(self.work)
        for name in ("moved.mvs", "moved.ply", os.path.join("images48", "0001.png")):
            self.assertIn(name, first)
            write(self.path("work", name), "old")
        other = self.path("work", "images48", "other.txt")
        write(other, "not an image of this run")
        self.transform(*arguments)
        os.remove(other)
        self.assertEqual(contents(self.work), first)


class Textures(Transform):
    """A mesh that is written to another folder takes its textures along."""

    def setUp(self):
        super().setUp()
        write(self.path("work", "a.png"), b"first texture")
        write(self.path("work", "more", "b 2.png"), b"second texture")
        self.names("a.png", "more/b 2.png", "a.png")

    def names(self, *names):
        self.put(CUBE, CUBE_FACES, comments="".join(f"comment TextureFile {name}\n" for name in names))

    def moving(self, output="there/moved.mvs"):
        return self.command("TransformScene", "-t", self.path("t.txt"), "-m", "mesh.ply", "-o", output)

    def move(self, *output):
        return self.succeeds(*self.moving(*output))

    def refuses_move(self, expected):
        os.makedirs(self.path("work", "there"), exist_ok=True)
        self.refuses_and_keeps(expected, *self.moving())

    def test_textures_are_copied(self):
        self.move()
        names = re.findall(rb"comment TextureFile (.*)\n", self.at("there/moved_mesh.ply"))
        self.assertEqual(names, [b"a.png", b"more/b 2.png", b"a.png"])
        for name in names:
            self.assertEqual(self.at("there/" + name.decode()), self.at(name.decode()))
        first = contents(self.work)
        self.move()  # the copies are there already
        self.assertEqual(contents(self.work), first)

    def test_nothing_is_copied_within_a_folder(self):
        before = files_below(self.work)
        self.move("moved.mvs")
        self.assertEqual(files_below(self.work) - before, {"moved.mvs", "moved_mesh.ply"})
        os.symlink(self.work, self.path("work", "link"))
        self.move("link/again.mvs")
        self.assertEqual(files_below(self.work) - before,
                         {"moved.mvs", "moved_mesh.ply", "again.mvs", "again_mesh.ply"})

    def test_another_file_is_not_replaced(self):
        for name in ("a.png", "more/b 2.png"):
            with self.subTest(name=name):
                other = self.path("work", "there", name)
                write(other, b"another image")
                self.refuses_move(f"{other}: exists and differs from {self.path('work', name)}")
                self.assertEqual(read(other), b"another image")
                os.remove(other)

    def test_textures_that_cannot_be_copied(self):
        os.remove(self.path("work", "more", "b 2.png"))
        self.refuses_move(f"mesh.ply: its texture {self.path('work', 'more', 'b 2.png')} is missing")
        write(self.path("c.png"), b"texture")
        self.names("more/../../c.png")
        self.refuses_move("is outside of the folder of the mesh")
        self.names("./moved.mvs")
        write(self.path("work", "moved.mvs"), b"texture")
        self.refuses_move("moved.mvs: is also a file of --output-file")


class WrongInput(Transform):
    def test_refusals(self):
        t = ("-t", self.path("t.txt"))
        self.refuses_each(
            self.command("TransformScene", "-o", "moved.mvs"), ("nothing to do",),
            ("only one can be given", *t, "-a", "scene.mvs"),
            ("--compute-volume needs --mesh-file", "--compute-volume", 1),
            ("--transfer-texture-file x.ply: not built yet", *t, "--transfer-texture-file", "x.ply"),
            ("--sample-mesh needs --mesh-file", "--sample-mesh", 5), ("x.stl: not built yet", *t, "-m", "x.stl"),
            ("x.obj: not built yet", *t, "-p", "x.obj"), ("x.glb", *t, "-m", "x.glb"),
            ("missing.ply", *t, "-p", "missing.ply"), ("missing.txt", "-t", "missing.txt"),
            ("--up-axis 3: must be from 0 to 2", *t, "--up-axis", 3), 
            *((f"{output}: is also a file of --output-file", *t, "-m", "mesh.ply", "--transform-out", output)
              for output in ("moved.mvs", "moved_mesh.ply", "moved.housing.json")))
        self.refuses_and_keeps("--output-file", *self.command("TransformScene", "-o", "scene.mvs", *t))
        write(self.path("work", "bad.mvs"), tiny_scene.mvs(self.images, pose=0xFFFFFFFF))
        self.refuses_and_keeps("bad.mvs: no image is calibrated", "TransformScene", "-i", "bad.mvs", "-w", self.work,
                               "-o", "moved.mvs", *t, "-m", "mesh.ply")

    def test_matrices(self):
        for text, expected in (
                ("1 0 0 0 0 1 0 0 0 0 1", "contains 11 numbers"),
                ("1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2", "the last row is 0 0 0 2"),
                ("1 0 0 0 0 1 0 0 0 0 -1 0", "mirrors"),
                ("1 0 0 0 0 2 0 0 0 0 1 0", "is not a rotation"),
                ("1 0 0 0 0 0 0 0 0 0 0 0", "mirrors or flattens"),
                ("1 0 0 nan 0 1 0 0 0 0 1 0", "contains nan"), ("", "contains 0 numbers")):
            with self.subTest(text=text):
                self.by("t.txt", text)
                self.refused(expected, "-t", self.path("t.txt"))
        self.by("t.txt", "matrix: 1, 0, 0, 5; 0, 1, 0, 6;\n0, 0, 1, 7; 0, 0, 0, 1")
        self.transform("-t", self.path("t.txt"))
        self.near(Mvs(self.at("moved.mvs")).camera(0)[3],
                  [a + b for a, b in zip(tiny_scene.CENTRES[0], (5, 6, 7))], 1e-12)

    def test_clouds_and_meshes(self):
        move = self.command("TransformScene", "-o", "moved.mvs", "-t", self.path("t.txt"))
        good = read(self.cloud)
        self.refuses_contents(self.cloud, (*move, "-p", "cloud.ply"), ("cloud.ply", b"garbage"),
                              ("cloud.ply", good[:-9]), ("has no vertices", good.replace(b"vertex 60", b"vertex 0")),
                              ("vertex 0 has a position that is not finite", ply([(1.0, math.inf, 2.0)])))
        self.refuses_contents(self.mesh, (*move, "-m", "mesh.ply"), (
            "mesh.ply: a face refers to vertex", read(self.mesh).replace(b"3 2 1 3\n", b"3 2 1 60\n")))


if __name__ == "__main__":
    main()
