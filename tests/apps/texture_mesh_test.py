# SPDX-License-Identifier: GPL-3.0-or-later
"""TextureMesh on the wall of tiny_scene.py: names of files, formats, masks, wrong input."""

import os
import re

from programs import contents, files_below, main, png, run, write
from readers import Glb, png_rows
from tiny_scene import HEIGHT, WIDTH
from worlds import Wall, turned, wall


class TextureTest(Wall):
    def texture(self, *arguments):
        return self.command("TextureMesh", *arguments)

    def header(self, name):
        return self.at(name).split(b"end_header\n")[0].decode()

    def faces(self, name):
        return int(re.search("element face ([0-9]+)\n", self.header(name))[1])


class Files(TextureTest):
    def test_default_names_are_those_of_openmvs(self):
        self.assertEqual(self.makes(*self.texture())[0], {"scene_texture.ply", "scene_texture0.png"})
        header = self.header("scene_texture.ply")
        self.assertIn("comment TextureFile scene_texture0.png\n", header)
        self.assertIn("element face 288\n", header)
        self.assertNotIn("texnumber", header)

    def test_a_mesh_that_is_inside_out_is_told(self):
        told = f"warning: {self.mesh}: the mesh is inside out: the cameras see 100 % of its faces from behind"
        self.assertNotIn("inside out", self.succeeds(*self.texture()).stdout)
        vertices, faces = wall()
        self.put(vertices, turned(faces))
        self.assertIn(told, run(*self.texture()).stdout)

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
        made, _ = self.makes(*self.texture("-o", "out.mvs", "--export-type", "ply,obj,glb,gltf"))
        self.assertEqual(made, {"out.ply", "out.obj", "out.mtl", "out.glb", "out.gltf", "out.bin", "out0.png",
                                "out_material_0_map_Kd.png", "out_gltf0.png"})
        self.assertIn(b"mtllib out.mtl\n", self.at("out.obj"))
        self.assertIn(b"map_Kd out_material_0_map_Kd.png\n", self.at("out.mtl"))
        glb = Glb(self.at("out.glb"))
        self.assertEqual(len(glb.values(glb.json["meshes"][0]["primitives"][0]["indices"])), 3 * 288)

    def test_several_textures_have_numbers(self):
        self.succeeds(*self.texture("--max-texture-size", "64"))
        header = self.header("scene_texture.ply")
        self.assertGreater(len(re.findall("TextureFile scene_texture[0-9].png\n", header)), 1)
        self.assertIn("property int32 texnumber\n", header)

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
        made, said = self.makes(*self.texture("--tiles", "3", "--export-type", "ply,glb",
                                              "--cost-smoothness-ratio", "100"))
        self.assertEqual(made, self.tile_files(3, ".ply", ".glb", "0.png"))
        for name in self.tile_files(3, ".ply"):
            self.assertIn(f"comment TextureFile {name[:-4]}0.png\n", self.header(name))
        self.assertEqual(sum(map(self.faces, self.tile_files(3, ".ply"))), 288)
        self.assertIn("in 3 textures; 0 of 288 faces", said)

    def test_one_tile_is_the_default(self):
        self.succeeds(*self.texture())
        default = contents(self.work)
        self.succeeds(*self.texture("--tiles", "1"))
        self.assertEqual(contents(self.work), default)

    def test_a_tile_without_faces_leaves_no_file_of_another_run(self):
        vertices, faces = wall(cells=1)
        self.put(vertices, faces[:1])
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
        self.refuses_each(self.texture(), *((f"--tiles {value}: must be from 1 to 1000", "--tiles", value)
                                            for value in ("0", "1001")),
                          *(("--tiles", "--tiles", value) for value in ("-1", "x", "2.5")))

    def test_outputs_that_cannot_be_written(self):
        os.mkdir(self.path("work", "scene_texture.tile2-3.ply"))
        self.refuses_and_keeps("scene_texture.tile2-3.ply", *self.texture("--tiles", "3"))


class Colours(TextureTest):
    """--colors: red pictures of the wall in the place of the photographs."""

    def colors(self):
        samples, channels = png_rows(self.at("out0.png"))
        return {tuple(row[i:i + 3]) for row in samples for i in range(0, len(row), channels)}

    def test_the_texture_has_the_restored_colours(self):
        self.put_restored()
        self.succeeds(*self.texture("--colors", "restored", "-o", "out"))
        of_seen_faces = self.colors() - {(255, 127, 39)}
        self.assertGreater(len(of_seen_faces), 50)
        self.assertEqual({color[1:] for color in of_seen_faces}, {(0, 0)})
        self.succeeds(*self.texture("-o", "out"))
        self.assertGreater(len({color[1:] for color in self.colors()}), 50)

    def test_wrong_folders(self):
        self.refuses_and_keeps("--colors", *self.texture("--colors", "restored"))
        self.put_restored(height=HEIGHT - 1)
        self.refuses_and_keeps("0000.png: is 96x71, but its photograph", *self.texture("--colors", "restored"))
        self.put_restored()
        os.remove(self.path("work", "restored", "0001.png"))
        self.refuses_and_keeps("no colours for image", *self.texture("--colors", "restored"))
        self.put_restored()
        self.refuses_and_keeps("--output-file", *self.texture("--colors", "restored", "-o", "restored/000"))


class Masks(TextureTest):
    """Labels of all pixels of all images, beside the images."""

    def mask(self, *labels):
        for image, label in zip(self.images, labels):
            write(image + ".png", png([bytes([label]) * WIDTH] * HEIGHT))

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
        write(self.path("work", "views.txt"), "0001.png\n")
        self.succeeds(*self.texture("--views-file", "views.txt", "-o", "one"))
        self.mask(0, 255, 0)
        self.succeeds(*self.texture("--ignore-mask-label", "0", "-o", "two"))
        self.assertEqual(self.at("one0.png"), self.at("two0.png"))


class WrongInput(TextureTest):
    def test_a_mesh_that_no_camera_sees_from_outside(self):
        vertices, faces = wall(cells=2)
        self.put(vertices, turned(faces))
        self.refuses_and_keeps("no view sees a face of the mesh", *self.texture())

    def test_options_out_of_range(self):
        self.refuses_each(
            self.texture(), ("must be one or more of ply, obj, glb, gltf", "--export-type", "stl"),
            ("must be from 1e-06 to 1", "--decimate", "0"), ("must be from 0 to 1000", "--close-holes", "1001"),
            ("--virtual-face-images 3: not built yet", "--virtual-face-images", "3"),
            ("not built yet", "--orthographic-image-resolution", "100"),
            ("must be from 0 to", "--outlier-threshold", "2"),
            ("must be from 16 to 32768", "--max-texture-size", "4"),
            ("must be from 0 to 16777215", "--empty-color", "16777216"),
            ("must be from -2 to 65535", "--ignore-mask-label", "-3"),
            ("must be one of auto, pinhole, flatport", "--camera-model", "fisheye"),
            ("scene.housing.json", "--refractive"), *(("--max-memory", "--max-memory", limit) for limit in (20, 64)))

    def test_openmvs_scripts_run(self):
        self.succeeds(*self.texture("--decimate", "1", "--close-holes", "30", "--virtual-face-images",
                                    "0", "--patch-packing-heuristic", "103", "--cuda-device", "-2",
                                    "--global-seam-leveling", "1", "--local-seam-leveling", "0",
                                    "--texture-size-multiple", "16", "--empty-color", "255"))


if __name__ == "__main__":
    main()
