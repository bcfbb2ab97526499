# SPDX-License-Identifier: GPL-3.0-or-later
"""TextureMesh on the wall of tiny_scene.py: names of files, formats, masks, wrong input."""

import json
import os
import re
import struct

from programs import contents, files_below, grey_png, main, read, run, write
from tiny_scene import DISTANCE, HEIGHT, NAN, WIDTH, TinyScene


def mesh_ply(vertices, faces):
    """A PLY mesh in ascii."""
    lines = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", "property float x",
             "property float y", "property float z", f"element face {len(faces)}",
             "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(map(str, v)) for v in vertices]
    lines += [" ".join(map(str, (len(f), *f))) for f in faces]
    return "\n".join(lines) + "\n"


def wall(z=DISTANCE, cells=12, half=0.3):
    """A grid on the wall. Its outside looks at the cameras, to smaller z."""
    at = lambda i: -half + 2 * half * i / cells
    vertices = [(at(i), at(j), z) for j in range(cells + 1) for i in range(cells + 1)]
    faces = []
    for j in range(cells):
        for i in range(cells):
            a = j * (cells + 1) + i
            b, c, d = a + 1, a + cells + 2, a + cells + 1
            faces += [(a, d, c), (a, c, b)]
    return vertices, faces


class TextureTest(TinyScene):
    def setUp(self):
        super().setUp()
        self.mesh = self.path("work", "scene.ply")
        write(self.mesh, mesh_ply(*wall()))

    def texture(self, *arguments):
        return ("TextureMesh", "-i", self.scene, "-w", self.work, *arguments)

    def header(self, name):
        return read(self.path("work", name)).split(b"end_header\n")[0].decode()


class Files(TextureTest):
    def test_default_names_are_those_of_openmvs(self):
        before = files_below(self.work)
        self.succeeds(*self.texture())
        self.assertEqual(files_below(self.work) - before,
                         {"scene_texture.ply", "scene_texture0.png"})
        header = self.header("scene_texture.ply")
        self.assertIn("comment TextureFile scene_texture0.png\n", header)
        self.assertIn("element face 288\n", header)
        self.assertNotIn("texnumber", header)

    def test_other_dots_in_the_name_stay(self):
        self.succeeds(*self.texture("-o", "a.v2"))
        self.assertLess({"a.v2.ply", "a.v20.png"}, files_below(self.work))

    def test_a_mesh_that_is_inside_out_is_told(self):
        told = f"warning: {self.mesh}: the mesh is inside out: the cameras see 100 % of its faces from behind"
        self.assertNotIn("inside out", self.succeeds(*self.texture()).stdout)
        vertices, faces = wall()
        write(self.mesh, mesh_ply(vertices, [face[::-1] for face in faces]))
        ended = run(*self.texture())
        self.assertIn(told, ended.stdout)

    def test_missing_folders_are_made(self):
        self.succeeds(*self.texture("-o", "new/deep/out.ply"))
        self.assertLess({"new/deep/out.ply", "new/deep/out0.png"}, files_below(self.work))
        for folder in (".", "new/", "../"):
            self.refuses_and_keeps(f"--output-file {folder}: must be the name of a file",
                                   *self.texture("-o", folder))

    def test_a_run_keeps_the_textures_of_another_format(self):
        before = contents(self.work)
        kinds = ("ply", "obj", "glb", "gltf")
        for kind in kinds:
            self.succeeds(*self.texture("-o", "out", "--export-type", kind,
                                        "--sharpness-weight", str(kinds.index(kind))))
            after = contents(self.work)
            self.assertEqual({name: after[name] for name in before}, before)
            before = after

    def test_every_format_has_its_files(self):
        before = files_below(self.work)
        self.succeeds(*self.texture("-o", "out.mvs", "--export-type", "ply,obj,glb,gltf"))
        self.assertEqual(files_below(self.work) - before,
                         {"out.ply", "out.obj", "out.mtl", "out.glb", "out.gltf", "out.bin", "out0.png",
                          "out_material_0_map_Kd.png", "out_gltf0.png"})
        self.assertIn("mtllib out.mtl\n", read(self.path("work", "out.obj")).decode())
        self.assertIn("map_Kd out_material_0_map_Kd.png\n", read(self.path("work", "out.mtl")).decode())
        glb = read(self.path("work", "out.glb"))
        gltf = json.loads(glb[20:20 + struct.unpack_from("<I", glb, 12)[0]])
        indices = gltf["accessors"][gltf["meshes"][0]["primitives"][0]["indices"]]
        self.assertEqual(indices["count"], 3 * 288)

    def test_several_textures_have_numbers(self):
        self.succeeds(*self.texture("--max-texture-size", "64"))
        header = self.header("scene_texture.ply")
        self.assertGreater(len(re.findall("TextureFile scene_texture[0-9].png\n", header)), 1)
        self.assertIn("property int32 texnumber\n", header)

    def test_any_number_of_threads_gives_the_same_bytes(self):
        found = []
        for threads in (1, 2):
            self.succeeds(*self.texture("--max-threads", threads, "--export-type", "ply,glb"))
            found.append(contents(self.work))
        self.assertEqual(found[0], found[1])

    def test_a_limit_on_memory_does_not_change_the_bytes(self):
        self.succeeds(*self.texture("--export-type", "ply,glb"))
        free = contents(self.work)
        self.succeeds(*self.texture("--export-type", "ply,glb", "--max-memory", "90"))
        self.assertEqual(contents(self.work), free)
        for limit in ("20", "64"):
            self.refuses_and_keeps("--max-memory", *self.texture("--max-memory", limit))

    def test_the_views_file_names_images(self):
        write(self.path("work", "views.txt"), "# two of three\n0001.png\n2\n")
        self.succeeds(*self.texture("--views-file", "views.txt"))
        write(self.path("work", "views.txt"), "0001.png\n0007.png\n")
        self.refuses_and_keeps("views.txt: line 2: no image has the ID or the name 0007.png",
                               *self.texture("--views-file", "views.txt"))


class Tiles(TextureTest):
    """--tiles N: N meshes with textures of their own."""

    def tile_files(self, count, *extensions):
        return {f"scene_texture.tile{i + 1}-{count}{extension}"
                for i in range(count) for extension in extensions}

    def test_each_tile_has_its_files_and_its_faces(self):
        before = files_below(self.work)
        said = self.succeeds(*self.texture("--tiles", "3", "--export-type", "ply,glb",
                                           "--cost-smoothness-ratio", "100")).stdout
        self.assertEqual(files_below(self.work) - before,
                         self.tile_files(3, ".ply", ".glb", "0.png"))
        faces = 0
        for name in self.tile_files(3, ".ply"):
            header = self.header(name)
            self.assertIn(f"comment TextureFile {name[:-4]}0.png\n", header)
            faces += int(re.search("element face ([0-9]+)\n", header)[1])
        self.assertEqual(faces, 288)
        self.assertIn("in 3 textures; 0 of 288 faces", said)

    def test_one_tile_is_the_default(self):
        self.succeeds(*self.texture())
        default = contents(self.work)
        self.succeeds(*self.texture("--tiles", "1"))
        self.assertEqual(contents(self.work), default)

    def test_any_number_of_threads_gives_the_same_bytes(self):
        found = []
        for threads in (1, 2):
            self.succeeds(*self.texture("--max-threads", threads, "--tiles", "3"))
            found.append(contents(self.work))
        self.assertEqual(found[0], found[1])

    def test_a_tile_without_faces_leaves_no_file_of_another_run(self):
        vertices, faces = wall(cells=1)
        write(self.mesh, mesh_ply(vertices, faces[:1]))
        for name in self.tile_files(8, ".ply"):
            write(self.path("work", name), "old")
        said = self.succeeds(*self.texture("--tiles", "8")).stdout
        empty = said.count("not written: the tile has no faces")
        self.assertGreater(empty, 0)
        left = [name for name in files_below(self.work) if re.search("tile[0-9]-8.ply$", name)]
        self.assertEqual(len(left), 8 - empty)
        for name in left:
            self.assertIn("comment TextureFile", self.header(name))

    def test_wrong_values(self):
        for value in ("0", "1001"):
            self.refuses_and_keeps(f"--tiles {value}: must be from 1 to 1000",
                                   *self.texture("--tiles", value))
        for value in ("-1", "x", "2.5"):
            self.refuses_and_keeps("--tiles", *self.texture("--tiles", value))

    def test_inputs_are_not_overwritten(self):
        os.rename(self.mesh, self.path("work", "out.tile2-3.ply"))
        self.refuses_and_keeps("--output-file",
                               *self.texture("-m", "out.tile2-3.ply", "-o", "out", "--tiles", "3"))
        self.succeeds(*self.texture("-m", "out.tile2-3.ply", "-o", "out", "--tiles", "2"))

    def test_outputs_that_cannot_be_written(self):
        os.mkdir(self.path("work", "scene_texture.tile2-3.ply"))
        self.refuses_and_keeps("scene_texture.tile2-3.ply", *self.texture("--tiles", "3"))


class Masks(TextureTest):
    """Labels of all pixels of all images, beside the images."""

    def mask(self, *labels):
        for image, label in zip(self.images, labels):
            write(image + ".png", grey_png([bytes([label]) * WIDTH] * HEIGHT))

    def test_the_label_is_the_one_that_was_given(self):
        """OpenMVS 2.3 leaves out label 0 whatever label is given."""
        self.mask(3, 3, 3)
        self.refuses_and_keeps("no view sees a face of the mesh",
                               *self.texture("--ignore-mask-label", "3"))
        self.succeeds(*self.texture("--ignore-mask-label", "0"))

    def test_masks_can_be_off(self):
        self.mask(0, 0, 0)
        for label in ("-1", "-2"):
            self.succeeds(*self.texture("--ignore-mask-label", label))

    def test_only_views_without_the_label_are_used(self):
        self.succeeds(*self.texture("--views-file", write_views(self, "0001.png"), "-o", "one"))
        self.mask(0, 255, 0)
        self.succeeds(*self.texture("--ignore-mask-label", "0", "-o", "two"))
        self.assertEqual(read(self.path("work", "one0.png")), read(self.path("work", "two0.png")))


def write_views(test, *names):
    write(test.path("work", "views.txt"), "\n".join(names) + "\n")
    return "views.txt"


class WrongInput(TextureTest):
    def check(self, expected, vertices, faces):
        write(self.mesh, mesh_ply(vertices, faces))
        self.refuses_and_keeps(expected, *self.texture())

    def test_wrong_meshes(self):
        vertices, faces = wall(cells=2)
        self.check("scene.ply: the mesh has no faces", vertices, [])
        self.check("scene.ply: a face refers to vertex 9, but there are 9", vertices,
                   [*faces, (0, 1, 9)])
        self.check("scene.ply", [*vertices[:-1], (0, NAN, 1)], faces)
        self.check("scene.ply: vertex 8 has a coordinate larger than 1e+18",
                   [*vertices[:-1], (0, 1e20, 1)], faces)
        self.check("scene.ply: does not belong to", *wall(z=-1))
        self.check("no view sees a face of the mesh", vertices, [f[::-1] for f in faces])

    def test_files_that_are_no_meshes(self):
        good = read(self.mesh)
        for size in (0, 3, 100, len(good) // 2, len(good) - 20):
            write(self.mesh, good[:size])
            self.refuses_and_keeps("scene.ply", *self.texture())
        write(self.mesh, os.urandom(1000))
        self.refuses_and_keeps("scene.ply", *self.texture())
        os.remove(self.mesh)
        self.refuses_and_keeps("scene.ply", *self.texture())

    def test_missing_and_damaged_images(self):
        good = read(self.images[1])
        write(self.images[1], good[:len(good) // 2])
        self.refuses_and_keeps("0001.png", *self.texture())
        os.remove(self.images[1])
        self.refuses_and_keeps("0001.png", *self.texture())

    def test_options_out_of_range(self):
        for option, value, expected in (
                ("--export-type", "stl", "must be one or more of ply, obj, glb, gltf"),
                ("--decimate", "0", "must be from 1e-06 to 1"),
                ("--close-holes", "1001", "must be from 0 to 1000"),
                ("--virtual-face-images", "3", "--virtual-face-images 3: not built yet"),
                ("--orthographic-image-resolution", "100", "not built yet"),
                ("--outlier-threshold", "2", "must be from 0 to"),
                ("--max-texture-size", "4", "must be from 16 to 32768"),
                ("--empty-color", "16777216", "must be from 0 to 16777215"),
                ("--ignore-mask-label", "-3", "must be from -2 to 65535"),
                ("--camera-model", "fisheye", "must be one of auto, pinhole, flatport")):
            self.refuses_and_keeps(expected, *self.texture(option, value))
        self.refuses_and_keeps("scene.housing.json", *self.texture("--refractive"))

    def test_openmvs_scripts_run(self):
        self.succeeds(*self.texture("--decimate", "1", "--close-holes", "30", "--virtual-face-images",
                                    "0", "--patch-packing-heuristic", "103", "--cuda-device", "-2",
                                    "--global-seam-leveling", "1", "--local-seam-leveling", "0",
                                    "--texture-size-multiple", "16", "--empty-color", "255"))

    def test_inputs_are_not_overwritten(self):
        os.rename(self.mesh, self.path("work", "scene_texture.ply"))
        self.refuses_and_keeps("--output-file", *self.texture("-m", "scene_texture.ply"))
        os.link(self.images[0], self.path("work", "out0.png"))
        self.refuses_and_keeps("--output-file", *self.texture("-m", "scene_texture.ply", "-o", "out"))
        self.succeeds(*self.texture("-m", "scene_texture.ply", "-o", "other"))

    def test_help_without_input(self):
        self.assertEqual(run("TextureMesh").returncode, 1)
        self.assertEqual(run("TextureMesh", "--help").returncode, 0)


if __name__ == "__main__":
    main()
