# SPDX-License-Identifier: GPL-3.0-or-later
"""The names of outputs: what belongs to a scene is kept, one rule for dots, the format that an
extension says, one run for each output, and nothing stale without a word."""

import os
import re
import shutil
import subprocess
import time

from every_program_test import Programs
from programs import BIN, files_below, main, read, write
from readers import Glb, Ply
from tiny_scene import mvs
from worlds import housing, moved, ply, wall

MESHES = ("ReconstructMesh", "RefineMesh", "TextureMesh")  # programs that write meshes


class Outputs(Programs):
    def removes(self, made):
        """Removes files of the scene's folder."""
        for name in made:
            os.remove(self.path("work", name))

    def faces(self, name):
        return int(re.search(rb"element face (\d+)", self.at(name))[1])


class FilesOfTheScene(Outputs):
    def test_openmvs_s_own_naming_keeps_the_cloud(self):
        cloud = read(self.cloud)
        for program, suffix in (("ReconstructMesh", "_mesh"), ("RefineMesh", "_refine"),
                                ("TextureMesh", "_texture")):
            for output in ("scene.mvs", "scene", f"../{os.path.basename(self.work)}/scene.mvs"):
                with self.subTest(program=program, output=output):
                    made, said = self.makes(*self.program(program, "-o", output))
                    self.assertIn(f"scene{suffix}.ply", made)
                    self.assertIn(f"the mesh is written to {self.work}/scene{suffix}.ply", said)
                    self.assertEqual(read(self.cloud), cloud)
                    self.removes(made)

    def test_other_formats_keep_the_name_of_openmvs(self):
        for program in ("RefineMesh", "TextureMesh"):
            made, _ = self.makes(*self.program(program, "-o", "scene.mvs", "--export-type", "glb"))
            self.assertEqual(made, {"scene.glb"})
            self.removes(made)


class OneRule(Outputs):
    """A known extension is replaced, every other dot belongs to the name."""

    def test_two_years_are_two_surveys(self):
        for year in ("reef.2024", "reef.2025"):
            made, _ = self.makes(*self.densify("-o", year))
            self.assertLessEqual({year + ".mvs", year + ".ply"}, made)
        for program in MESHES:
            made, _ = self.makes(*self.program(program, "-o", "mesh.2024"))
            self.assertIn("mesh.2024.ply", made)
            os.remove(self.path("work", "mesh.2024.ply"))
        made, _ = self.makes(*self.program("TransformScene", "-t", "t.txt", "-o", "moved.2024"))
        self.assertEqual(made, {"moved.2024.mvs", "moved.2024_mesh.ply"})
        made, _ = self.makes(*self.program("MapSurface", "-o", "map.2024", "--gsd", "0.02"))
        self.assertTrue(made and all(name.startswith("map.2024.") for name in made), made)

    def test_side_files_have_the_whole_name(self):
        write(self.path("housing.json"), housing())
        for year in ("reef.2024", "reef.2025"):
            made, _ = self.makes("InterfaceCOLMAP", "-i", self.path("colmap"), "--housing", self.path("housing.json"),
                                 "-w", self.work, "-o", year)
            self.assertEqual(made, {year + end for end in (".mvs", ".housing.json", ".lenses.json")})
        said = self.succeeds("TransformScene", "-i", "reef.2025.mvs", "-w", self.work, "-t", "t.txt").stdout
        self.assertIn("3 of 3 images behind a port", said)
        self.assertIn("reef.2025_transform.housing.json", files_below(self.work))

    def test_known_extensions_are_replaced(self):
        for name in ("a.mvs", "a.ply", "a.obj", "a.glb", "a.MVS"):
            made, _ = self.makes(*self.densify("-o", name))
            self.assertLessEqual({"a.mvs", "a.ply"}, made)
            os.remove(self.path("work", "a.mvs"))
            os.remove(self.path("work", "a.ply"))

    def test_a_name_that_cannot_be_read_again_is_refused(self):
        outputs = {
            "TextureMesh": ("-o",), "RefineMesh": ("-o",), "ReconstructMesh": ("-o",),
            "TransformScene": ("-o", "--transform-out"), "MapSurface": ("-o",),
            "ViewScene": ("--report",),
            "DensifyPointCloud": ("-o", "--report-file", "--plan", "--pinhole-export",
                                  "--output-view-neighbors-file")}
        for program, options in outputs.items():
            for option in (*options, "--log-file"):
                mesh = None if program == "DensifyPointCloud" else "mesh.ply"
                report = ("--report", "x") if program == "ViewScene" and option != "--report" else ()
                self.refuses_and_keeps("contains a control character", *self.program(
                    program, *report, option, "a\nb", mesh=mesh))
        for option in ("--json", "--error-cloud", "--picture", "--aligned", "--transform-out",
                       "--render-folder", "--error-mesh"):
            self.refuses_and_keeps("contains a control character", "EvaluateReconstruction", "-i",
                                   self.cloud, "-m", self.path("work", "mesh.ply"), option, "a\tb")
        self.refuses_and_keeps("control character", "InterfaceCOLMAP", "-i", self.path("colmap"),
                               "-o", "a\nb.mvs")
        shutil.copyfile(self.scene, self.path("work", "a\nb.mvs"))
        self.refuses_and_keeps("control character", "TextureMesh", "-i", "a\nb.mvs", "-w", self.work,
                               "-m", "mesh.ply")


class Formats(Outputs):
    """The extension of -o, and options of OpenMVS in any case."""

    def test_a_glb_is_a_glb(self):
        for program in ("ReconstructMesh", "RefineMesh"):
            made, _ = self.makes(*self.program(program, "-o", "m.glb"))
            self.assertEqual(made, {"m.glb"})
            self.succeeds(*self.program(program, "-o", "m.ply"))
            glb, mesh = Glb(self.at("m.glb")), Ply(self.at("m.ply"))
            primitive = glb.json["meshes"][0]["primitives"][0]
            self.assertEqual(list(glb.values(primitive["attributes"]["POSITION"])), [x for v in mesh.points for x in v])
            self.assertEqual(list(glb.values(primitive["indices"])), [i for face in mesh.triangles for i in face])
            glb.bounds(primitive)
            os.remove(self.path("work", "m.ply"))
            # Our own readers take it.
            self.succeeds("EvaluateReconstruction", "-i", self.path("work", "m.glb"), "-m",
                          self.path("work", "mesh.ply"), "--samples", "100")
            os.remove(self.path("work", "m.glb"))

    def test_a_textured_mesh_has_the_format_of_its_name(self):
        made, _ = self.makes(*self.program("TextureMesh", "-o", "t.glb"))
        self.assertEqual(made, {"t.glb"})

    def test_formats_that_are_not_written_are_refused(self):
        for program in ("ReconstructMesh", "RefineMesh"):
            self.refuses_and_keeps("must end in .ply, .obj or .glb",
                                   *self.program(program, "-o", "m.gltf"))
        for program in MESHES:
            self.refuses_and_keeps(".stl files are not written",
                                   *self.program(program, "-o", "m.stl"))

    def test_capitals(self):
        for program in MESHES:
            made, _ = self.makes(*self.program(program, "-o", "m", "--export-type", "OBJ"))
            self.assertIn("m.obj", made)
            self.removes(made)
        self.refuses_and_keeps("must be one of ply, obj, glb",
                               *self.program("RefineMesh", "--export-type", "STL"))


class OptionsOfOpenMvs(Outputs):
    def test_a_mesh_is_simplified_before_it_is_textured(self):
        self.succeeds(*self.program("TextureMesh", "-o", "all", "--close-holes", "0"))
        said = self.succeeds(*self.program("TextureMesh", "-o", "half", "--decimate", "0.5",
                                           "--close-holes", "0")).stdout
        self.assertEqual(self.faces("all.ply"), 288)
        self.assertLess(abs(self.faces("half.ply") - 144), 6)
        self.assertNotIn("without effect", said)
        # The hole of two faces in the middle is closed only if this is asked for.
        vertices, faces = wall()
        write(self.path("work", "hole.ply"), ply(vertices, faces[:156] + faces[158:]))
        found = []
        for edges in ("0", "30"):
            self.succeeds(*self.program("TextureMesh", "-o", "closed", "--decimate", "0.99",
                                        "--close-holes", edges, mesh="hole.ply"))
            found.append(self.faces("closed.ply"))
        self.assertLess(found[0], found[1])

    def test_resolutions_of_one_size(self):
        self.succeeds(*self.program("RefineMesh", "-o", "once"))
        said = self.succeeds(*self.program("RefineMesh", "-o", "twice", "--scales", "2",
                                           "--scale-step", "1")).stdout
        self.assertIn("vertices measured", said)
        self.assertNotEqual(self.at("once.ply"), self.at("twice.ply"))
        self.refuses_and_keeps("--scale-step", *self.program("RefineMesh", "--scale-step", "1.1"))

    def test_a_moved_mesh_in_another_format(self):
        for kind in ("obj", "GLB"):
            made, _ = self.makes(*self.program("TransformScene", "-t", "t.txt", "-o", "other", "--export-type", kind))
            self.assertEqual(made, {"other.mvs", f"other_mesh.{kind.lower()}"})
            self.removes({"other.mvs"})
        expected = [moved(v) for v in wall()[0]]
        found = [tuple(map(float, line.split()[1:4])) for line in
                 self.at("other_mesh.obj").decode().splitlines() if line.startswith("v ")]
        for a, b in zip(found, expected, strict=True):
            self.near(a, b, 1e-6)
        positions = Glb(self.at("other_mesh.glb")).values(0)
        self.assertEqual(len(positions), 3 * len(expected))
        self.succeeds(*self.program("TextureMesh", "-o", "textured"))
        made, _ = self.makes(*self.program("TransformScene", "-t", "t.txt", "-o", "new",
                                               "--export-type", "gltf", mesh="textured.ply"))
        self.assertEqual(made, {"new.mvs", "new_mesh.gltf", "new_mesh.bin", "new_mesh_gltf0.png"})
        made, said = self.makes(*self.program("TransformScene", "-o", "only.2024", "--export-type",
                                                  "glb", mesh="textured.ply"))
        self.assertEqual(made, {"only.2024_mesh.glb"})
        self.assertIn("only.2024_mesh.glb: converted mesh", said)
        self.assertEqual(len(Glb(self.at("only.2024_mesh.glb")).json["images"]), 1)
        made, _ = self.makes(*self.program("TransformScene", "-o", "copy", "--export-type", "ply"))
        self.assertEqual(made, {"copy_mesh.ply"})
        for found, expected in zip(Ply(self.at("copy_mesh.ply")).points, wall()[0], strict=True):
            self.near(found, expected, 5e-7)
        self.refuses_and_keeps("nothing to do", *self.program("TransformScene", "--export-type", "glb",
                                                              mesh=None))
        self.refuses_and_keeps("has no textures", *self.program(
            "TransformScene", "-t", "t.txt", "-o", "last", "--export-type", "gltf"))

    def test_points_on_the_mesh(self):
        area = 0.6 * 0.6
        for number, expected in (("-500", 500), ("1000", round(1000 * area))):
            made, said = self.makes(*self.program("TransformScene", "-t", "t.txt", "-o", "moved",
                                                      "--sample-mesh", number))
            self.assertIn("moved_samples.ply", made)
            self.assertIn("moved_samples.ply: points on the mesh", said)
            points = Ply(self.at("moved_samples.ply")).points
            self.assertLessEqual(abs(len(points) - expected), 1)
            # On the plane z = 1, which the similarity moves.
            origin, normal = moved((0, 0, 1)), moved((0, 0, 1), shift=(0, 0, 0))
            for p in points:
                off = sum((a - b) * n for a, b, n in zip(p, origin, normal))
                self.assertLess(abs(off), 1e-5)
            self.removes(made)
        made, said = self.makes(*self.program("TransformScene", "--sample-mesh", "-5"))
        self.assertEqual(made, {"scene_transform_samples.ply"})
        self.assertIn("scene_transform_samples.ply: points on the mesh", said)
        self.refuses_and_keeps("--sample-mesh needs --mesh-file",
                               *self.program("TransformScene", "--sample-mesh", "-5", mesh=None))
        made, said = self.makes(*self.program("TransformScene", "-t", "t.txt", "-o", "plain",
                                                  "--sample-mesh", "-300000", mesh=None))
        self.assertEqual(made, {"plain.mvs"})
        self.assertIn("warning: --sample-mesh -300000: without effect without --mesh-file", said)

    def test_images_elsewhere(self):
        shutil.copytree(self.path("colmap", "images"), self.path("work", "images", "dive"))
        write(self.scene, mvs([f"/nowhere/dive/{os.path.basename(i)}" for i in self.images]))
        export = ("InterfaceCOLMAP", "-i", "scene.mvs", "-w", self.work, "-o", "out",
                  "--image-folder")
        said = self.succeeds(*export, "images").stdout
        self.assertIn(f"3 images below {self.work}/images", said)
        self.assertIn(" dive/0001.png\n", self.at("out", "sparse", "images.txt").decode())
        os.remove(self.path("work", "images", "dive", "0002.png"))
        said = self.succeeds(*export, "images").stdout
        self.assertIn("has no file for /nowhere/dive/0002.png", said)
        self.assertIn(" 0001.png\n", self.at("out", "sparse", "images.txt").decode())

    def test_options_of_2_4_are_named(self):
        for program, options in (
                ("DensifyPointCloud", ("--fusion-filter", "-t", "-d", "-m", "--crop-roi-file",
                                       "--export-dmaps", "--up-axis", "--normalize-coordinates",
                                       "--estimate-segmentation")),
                ("TransformScene", ("--invert-transform", "--convert")),
                ("InterfaceCOLMAP", ("--binary", "--no-points", "--common-intrinsics"))):
            for option in options:
                for value in (("2",), ()):
                    self.refuses_and_keeps(
                        f"{option}: an option of OpenMVS 2.4 that {program} does not have",
                        program, "-i", "scene.mvs", "-w", self.work, option, *value)
        self.refuses_and_keeps("unrecognised option '-t'", "TextureMesh", "-i", "scene.mvs", "-t")
        default, _ = self.makes(*self.densify())
        cloud = self.at("scene_dense.ply")
        self.succeeds(*self.densify("--estimate-roi", "1.1"))
        self.assertEqual(self.at("scene_dense.ply"), cloud)
        self.refuses_and_keeps("--estimate-roi 1.3: must be 0, 1 or 2", *self.densify("--estimate-roi", "1.3"))


class Stale(Outputs):
    """Files of an earlier run that the new run does not renew."""

    def test_a_cloud_of_an_earlier_scene_is_named(self):
        for name in ("moved.ply", "moved_mesh.ply"):
            write(self.path("work", name), "old")
        said = self.succeeds(*self.program("TransformScene", "-t", "t.txt", "-o", "moved.mvs",
                                           mesh=None)).stdout
        for name in ("moved.ply", "moved_mesh.ply"):
            self.assertIn(f"warning: {self.work}/{name}: is older than moved.mvs", said)
            self.assertEqual(self.at(name), b"old")
        said = self.succeeds(*self.program("TransformScene", "-t", "t.txt", "-o", "moved.mvs", "-p",
                                           "scene.ply")).stdout
        self.assertNotIn("is older than", said)

    def test_tiles_of_another_number_are_named(self):
        for name in ("scene_texture.tile1-9.ply", "scene_texture.tile2-9.glb",
                     "scene_texture.tile2-90.png", "scene_texture.tilex-9.ply", "new.tile1-9.ply"):
            write(self.path("work", name), "old")
        # The wall is one part of a photograph, so that one of two tiles has all faces.
        for tiles, named in (("2", "tile1-9.ply and 1 more: "), ("1", "tile1-2.ply and 2 more: ")):
            said = self.succeeds(*self.program("TextureMesh", "--tiles", tiles)).stdout
            self.assertIn(f"warning: {self.work}/scene_texture.{named}", said)
        self.assertNotIn("another number", self.succeeds(
            *self.program("TextureMesh", "-o", "other", "--tiles", "2")).stdout)
        self.assertEqual(self.at("scene_texture.tile1-9.ply"), b"old")

    def test_tiles_of_a_cloud_are_removed(self):
        densify = self.densify()
        self.succeeds(*densify, "--fusion-mode", "1")
        for tile in ("1/2", "2/2", "1/3"):
            self.succeeds(*densify, "--tile", tile)
        changed = self.path("work", "scene_dense.tile2-2.ply")
        write(changed, read(changed) + b" ")
        tiles = lambda: {name for name in files_below(self.work) if ".tile" in name}
        self.assertEqual(len(tiles()), 6)
        said = self.succeeds(*densify, "--tiles", "4").stdout
        self.assertEqual(tiles(), {"scene_dense.tile2-2.ply", "scene_dense.tile2-2.ply.json"})
        self.assertIn(f"warning: {changed}: of another number of tiles", said)
        os.remove(changed)
        self.assertNotIn("of another number", self.succeeds(*densify).stdout)

    def test_intermediate_tiles_of_a_mesh_are_removed(self):
        for tiles in ("4", "9"):
            origin = self.path("work", f"scene_mesh.tiles{tiles}", "0123456789abcdef" * 2)
            write(os.path.join(origin, "mesh1.bin"), "of a tile")
        write(self.path("work", "scene_mesh.tiles9", "mine.txt"), "mine")
        write(self.path("work", "scene_mesh.tiles", "mine.txt"), "mine")
        self.succeeds(*self.program("ReconstructMesh"))
        self.assertEqual({name for name in files_below(self.work) if "tiles" in name},
                         {"scene_mesh.tiles9/mine.txt", "scene_mesh.tiles/mine.txt"})

    def test_a_state_that_stays_after_an_error_is_named(self):
        """The output becomes a folder while the mesh is refined, so that it cannot be written."""
        output, state = (self.path("work", "refined.ply" + end) for end in ("", ".state"))
        command = self.program("RefineMesh", "-o", "refined.ply", "--scale-step", "1", "--scales",
                               "12")
        process = subprocess.Popen([os.path.join(BIN, command[0]), *command[1:]], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        while not os.path.exists(state) and process.poll() is None:
            time.sleep(0.002)
        os.makedirs(output, exist_ok=True)
        said, error = process.communicate()
        self.assertEqual(process.returncode, 1)
        self.assertEqual(error.count("\n"), 1)
        self.assertIn(f"warning: {state}: is kept: the same command continues from there", said)
        os.rmdir(output)
        self.assertIn("12 of 12 resolutions are done already", self.succeeds(*command).stdout)
        self.assertFalse(os.path.exists(state))


if __name__ == "__main__":
    main()
