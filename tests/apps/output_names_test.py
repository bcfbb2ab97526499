# SPDX-License-Identifier: GPL-3.0-or-later
"""The names of outputs: what belongs to a scene is kept, one rule for dots, the format that an
extension says, one run for each output, and nothing stale without a word."""

import fcntl
import json
import os
import re
import shutil
import struct
import subprocess
import time

from openmvs_chain_test import Glb
from openmvs_scene import ascii_ply
from programs import BIN, contents, files_below, grey_png, main, read, write
from texture_mesh_test import mesh_ply, wall
from tiny_scene import DENSIFY, TinyScene, mvs
from transform_case import SHIFT, matrix_text, moved

# The wall is small and simple.
MORE = {"RefineMesh": ("--max-face-area", "0"), "ReconstructMesh": ("--remove-spurious", "0")}
PORT = {"version": 1, "default": "main",
        "ports": {"main": {"type": "flat", "distance_m": 0.02, "thickness_m": 0.01, "n_glass": 1.5,
                           "n_water": 1.333}}}


class Wall(TinyScene):
    """The scene work/scene.mvs with a cloud beside it, and the mesh work/mesh.ply."""

    def setUp(self):
        super().setUp()
        self.cloud = self.path("work", "scene.ply")
        write(self.cloud, ascii_ply([((0.01 * i, 0.02 * i, 1), [0, 1]) for i in range(9)]))
        write(self.path("work", "mesh.ply"), mesh_ply(*wall()))
        write(self.path("work", "t.txt"), matrix_text())

    def command(self, program, *arguments, mesh="mesh.ply"):
        option = "--mesh-file" if mesh else None
        more = MORE.get(program, ())
        return (program, "-i", "scene.mvs", "-w", self.work, *((option, mesh) if mesh else ()),
                *more, *arguments)

    def new_files(self, *command, **options):
        """The files that the command writes, and the lines that it prints."""
        before = files_below(self.work)
        said = self.succeeds(*command, **options)
        return files_below(self.work) - before, said.stdout

    def at(self, *name):
        return read(self.path("work", *name))

    def faces(self, name):
        return int(re.search(rb"element face (\d+)", self.at(name))[1])


class FilesOfTheScene(Wall):
    def test_openmvs_s_own_naming_keeps_the_cloud(self):
        cloud = read(self.cloud)
        for program, suffix in (("ReconstructMesh", "_mesh"), ("RefineMesh", "_refine"),
                                ("TextureMesh", "_texture")):
            for output in ("scene.mvs", "scene", f"../{os.path.basename(self.work)}/scene.mvs"):
                with self.subTest(program=program, output=output):
                    made, said = self.new_files(*self.command(program, "-o", output))
                    self.assertIn(f"scene{suffix}.ply", made)
                    self.assertIn(f"the mesh is written to {self.work}/scene{suffix}.ply", said)
                    self.assertEqual(read(self.cloud), cloud)
                    for name in made:
                        os.remove(self.path("work", name))

    def test_other_formats_keep_the_name_of_openmvs(self):
        for program in ("RefineMesh", "TextureMesh"):
            made, _ = self.new_files(*self.command(program, "-o", "scene.mvs", "--export-type",
                                                   "glb"))
            self.assertEqual(made, {"scene.glb"})
            os.remove(self.path("work", "scene.glb"))

    def test_what_belongs_to_a_scene_is_never_an_output(self):
        for name in ("scene.housing.json", "scene.lenses.json", "scene.geo.json", "depth0001.dmap"):
            shutil.copyfile(self.cloud, self.path("work", name))
        for program in ("ReconstructMesh", "RefineMesh", "TextureMesh"):
            before = contents(self.work)
            for name in ("scene.geo.json", "scene.lenses.json", "scene.housing.json"):
                os.remove(self.path("work", name))
            self.refuses_and_keeps("scene.ply: is ", *self.command(program, "-o", "scene.ply"))
            for name, data in before.items():
                write(self.path("work", name), data)
        for name in ("scene.housing.json", "scene.lenses.json", "scene.geo.json"):
            self.refuses_and_keeps(name + ": is ", *self.command("TransformScene", "-t", "t.txt",
                                                                 "--transform-out", name))
            os.remove(self.path("work", name))
        for name in ("scene.ply", "depth0001.dmap", self.images[1]):
            self.refuses_and_keeps(name + ": is ", *self.command("TransformScene", "-t", "t.txt",
                                                                 "--transform-out", name))


class OneRule(Wall):
    """A known extension is replaced, every other dot belongs to the name."""

    def test_two_years_are_two_surveys(self):
        for year in ("reef.2024", "reef.2025"):
            made, _ = self.new_files(*DENSIFY, "-i", "scene.mvs", "-w", self.work, "-o", year)
            self.assertLessEqual({year + ".mvs", year + ".ply"}, made)
        for program in ("ReconstructMesh", "RefineMesh", "TextureMesh"):
            made, _ = self.new_files(*self.command(program, "-o", "mesh.2024"))
            self.assertIn("mesh.2024.ply", made)
            os.remove(self.path("work", "mesh.2024.ply"))
        made, _ = self.new_files(*self.command("TransformScene", "-t", "t.txt", "-o", "moved.2024"))
        self.assertEqual(made, {"moved.2024.mvs", "moved.2024_mesh.ply"})
        made, _ = self.new_files(*self.command("MapSurface", "-o", "map.2024", "--gsd", "0.02"))
        self.assertTrue(made and all(name.startswith("map.2024.") for name in made), made)

    def test_side_files_have_the_whole_name(self):
        housing = self.path("housing.json")
        write(housing, json.dumps(PORT))
        for year in ("reef.2024", "reef.2025"):
            made, _ = self.new_files("InterfaceCOLMAP", "-i", self.path("colmap"), "--housing",
                                     housing, "-w", self.work, "-o", year)
            self.assertEqual(made, {year + end for end in (".mvs", ".housing.json",
                                                           ".lenses.json")})
        said = self.succeeds("TransformScene", "-i", "reef.2025.mvs", "-w", self.work, "-t",
                             "t.txt").stdout
        self.assertIn("3 of 3 images behind a port", said)
        self.assertIn("reef.2025_transform.housing.json", files_below(self.work))

    def test_known_extensions_are_replaced(self):
        for name in ("a.mvs", "a.ply", "a.obj", "a.glb", "a.MVS"):
            made, _ = self.new_files(*DENSIFY, "-i", "scene.mvs", "-w", self.work, "-o", name)
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
                self.refuses_and_keeps("contains a control character", *self.command(
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


class Formats(Wall):
    """The extension of -o, and options of OpenMVS in any case."""

    def test_a_glb_is_a_glb(self):
        for program in ("ReconstructMesh", "RefineMesh"):
            made, _ = self.new_files(*self.command(program, "-o", "m.glb"))
            self.assertEqual(made, {"m.glb"})
            self.succeeds(*self.command(program, "-o", "m.ply"))
            glb = Glb(self.at("m.glb"))
            primitive = glb.json["meshes"][0]["primitives"][0]
            head, body = self.at("m.ply").split(b"end_header\n", 1)
            vertices, faces = (int(n) for n in re.findall(rb"element \w+ (\d+)\n", head))
            positions = glb.values(primitive["attributes"]["POSITION"])
            self.assertEqual(positions.tobytes(), body[:12 * vertices])
            self.assertEqual(glb.values(primitive["indices"]).tobytes(), b"".join(
                body[12 * vertices + 13 * k + 1:][:12] for k in range(faces)))
            bounds = glb.json["accessors"][primitive["attributes"]["POSITION"]]
            for k in range(3):
                self.assertEqual(bounds["min"][k], min(positions[k::3]))
                self.assertEqual(bounds["max"][k], max(positions[k::3]))
            os.remove(self.path("work", "m.ply"))
            # Our own readers take it.
            self.succeeds("EvaluateReconstruction", "-i", self.path("work", "m.glb"), "-m",
                          self.path("work", "mesh.ply"), "--samples", "100")
            os.remove(self.path("work", "m.glb"))

    def test_a_textured_mesh_has_the_format_of_its_name(self):
        made, _ = self.new_files(*self.command("TextureMesh", "-o", "t.glb"))
        self.assertEqual(made, {"t.glb"})

    def test_formats_that_are_not_written_are_refused(self):
        for program in ("ReconstructMesh", "RefineMesh"):
            self.refuses_and_keeps("must end in .ply, .obj or .glb",
                                   *self.command(program, "-o", "m.gltf"))
        for program in ("ReconstructMesh", "RefineMesh", "TextureMesh"):
            self.refuses_and_keeps(".stl files are not written",
                                   *self.command(program, "-o", "m.stl"))

    def test_capitals(self):
        for program in ("ReconstructMesh", "RefineMesh", "TextureMesh"):
            made, _ = self.new_files(*self.command(program, "-o", "m", "--export-type", "OBJ"))
            self.assertIn("m.obj", made)
            for name in made:
                os.remove(self.path("work", name))
        self.refuses_and_keeps("must be one of ply, obj, glb",
                               *self.command("RefineMesh", "--export-type", "STL"))


class OptionsOfOpenMvs(Wall):
    def test_a_mesh_is_simplified_before_it_is_textured(self):
        self.succeeds(*self.command("TextureMesh", "-o", "all", "--close-holes", "0"))
        said = self.succeeds(*self.command("TextureMesh", "-o", "half", "--decimate", "0.5",
                                           "--close-holes", "0")).stdout
        self.assertEqual(self.faces("all.ply"), 288)
        self.assertLess(abs(self.faces("half.ply") - 144), 6)
        self.assertNotIn("without effect", said)
        # The hole of two faces in the middle is closed only if this is asked for.
        vertices, faces = wall()
        write(self.path("work", "hole.ply"), mesh_ply(vertices, faces[:156] + faces[158:]))
        found = []
        for edges in ("0", "30"):
            self.succeeds(*self.command("TextureMesh", "-o", "closed", "--decimate", "0.99",
                                        "--close-holes", edges, mesh="hole.ply"))
            found.append(self.faces("closed.ply"))
        self.assertLess(found[0], found[1])

    def test_resolutions_of_one_size(self):
        self.succeeds(*self.command("RefineMesh", "-o", "once"))
        said = self.succeeds(*self.command("RefineMesh", "-o", "twice", "--scales", "2",
                                           "--scale-step", "1")).stdout
        self.assertIn("vertices measured", said)
        self.assertNotEqual(self.at("once.ply"), self.at("twice.ply"))
        self.refuses_and_keeps("--scale-step", *self.command("RefineMesh", "--scale-step", "1.1"))

    def test_a_moved_mesh_in_another_format(self):
        self.succeeds(*self.command("TransformScene", "-t", "t.txt", "-o", "moved"))
        head, body = self.at("moved_mesh.ply").split(b"end_header\n", 1)
        for kind in ("obj", "GLB"):
            made, _ = self.new_files(*self.command("TransformScene", "-t", "t.txt", "-o", "other",
                                                   "--export-type", kind))
            self.assertEqual(made, {"other.mvs", f"other_mesh.{kind.lower()}"})
            os.remove(self.path("work", "other.mvs"))
        expected = [moved(v) for v in wall()[0]]
        found = [tuple(map(float, line.split()[1:4])) for line in
                 self.at("other_mesh.obj").decode().splitlines() if line.startswith("v ")]
        for a, b in zip(found, expected, strict=True):
            self.assertLess(max(abs(p - q) for p, q in zip(a, b)), 1e-6)
        positions = Glb(self.at("other_mesh.glb")).values(0)
        self.assertEqual(len(positions), 3 * len(expected))
        self.succeeds(*self.command("TextureMesh", "-o", "textured"))
        made, _ = self.new_files(*self.command("TransformScene", "-t", "t.txt", "-o", "new",
                                               "--export-type", "gltf", mesh="textured.ply"))
        self.assertEqual(made, {"new.mvs", "new_mesh.gltf", "new_mesh.bin", "new_mesh_gltf0.png"})
        made, said = self.new_files(*self.command("TransformScene", "-o", "only.2024", "--export-type",
                                                  "glb", mesh="textured.ply"))
        self.assertEqual(made, {"only.2024_mesh.glb"})
        self.assertIn("only.2024_mesh.glb: converted mesh", said)
        self.assertEqual(len(Glb(self.at("only.2024_mesh.glb")).json["images"]), 1)
        made, _ = self.new_files(*self.command("TransformScene", "-o", "copy", "--export-type", "ply"))
        self.assertEqual(made, {"copy_mesh.ply"})
        head, body = self.at("copy_mesh.ply").split(b"end_header\n", 1)
        for i, vertex in enumerate(wall()[0]):
            for value, expected in zip(struct.unpack_from("<3f", body, 12 * i), vertex, strict=True):
                self.assertAlmostEqual(value, expected, 6)
        self.refuses_and_keeps("nothing to do", *self.command("TransformScene", "--export-type", "glb",
                                                              mesh=None))
        self.refuses_and_keeps("has no textures", *self.command(
            "TransformScene", "-t", "t.txt", "-o", "last", "--export-type", "gltf"))

    def test_points_on_the_mesh(self):
        area = 0.6 * 0.6
        for number, expected in (("-500", 500), ("1000", round(1000 * area))):
            made, said = self.new_files(*self.command("TransformScene", "-t", "t.txt", "-o", "moved",
                                                      "--sample-mesh", number))
            self.assertIn("moved_samples.ply", made)
            self.assertIn("moved_samples.ply: points on the mesh", said)
            head, body = self.at("moved_samples.ply").split(b"end_header\n", 1)
            count = int(re.search(rb"element vertex (\d+)", head)[1])
            self.assertLessEqual(abs(count - expected), 1)
            # On the plane z = 1, which the similarity moves.
            origin, normal = moved((0, 0, 1)), moved((0, 0, 1), shift=(0, 0, 0))
            for k in range(count):
                p = struct.unpack_from("<3f", body, 12 * k)
                off = sum((a - b) * n for a, b, n in zip(p, origin, normal))
                self.assertLess(abs(off), 1e-5)
            for name in made:
                os.remove(self.path("work", name))
        made, said = self.new_files(*self.command("TransformScene", "--sample-mesh", "-5"))
        self.assertEqual(made, {"scene_transform_samples.ply"})
        self.assertIn("scene_transform_samples.ply: points on the mesh", said)
        self.refuses_and_keeps("--sample-mesh needs --mesh-file",
                               *self.command("TransformScene", "--sample-mesh", "-5", mesh=None))
        made, said = self.new_files(*self.command("TransformScene", "-t", "t.txt", "-o", "plain",
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
        default, _ = self.new_files(*DENSIFY, "-i", "scene.mvs", "-w", self.work)
        cloud = self.at("scene_dense.ply")
        self.succeeds(*DENSIFY, "-i", "scene.mvs", "-w", self.work, "--estimate-roi", "1.1")
        self.assertEqual(self.at("scene_dense.ply"), cloud)
        self.refuses_and_keeps("--estimate-roi 1.3: must be 0, 1 or 2", *DENSIFY, "-i", "scene.mvs",
                               "-w", self.work, "--estimate-roi", "1.3")


class Stale(Wall):
    """Files of an earlier run that the new run does not renew."""

    def test_a_cloud_of_an_earlier_scene_is_named(self):
        for name in ("moved.ply", "moved_mesh.ply"):
            write(self.path("work", name), "old")
        said = self.succeeds(*self.command("TransformScene", "-t", "t.txt", "-o", "moved.mvs",
                                           mesh=None)).stdout
        for name in ("moved.ply", "moved_mesh.ply"):
            self.assertIn(f"warning: {self.work}/{name}: is older than moved.mvs", said)
            self.assertEqual(self.at(name), b"old")
        said = self.succeeds(*self.command("TransformScene", "-t", "t.txt", "-o", "moved.mvs", "-p",
                                           "scene.ply")).stdout
        self.assertNotIn("is older than", said)

    def test_tiles_of_another_number_are_named(self):
        for name in ("scene_texture.tile1-9.ply", "scene_texture.tile2-9.glb",
                     "scene_texture.tile2-90.png", "scene_texture.tilex-9.ply", "new.tile1-9.ply"):
            write(self.path("work", name), "old")
        # The wall is one part of a photograph, so that one of two tiles has all faces.
        for tiles, named in (("2", "tile1-9.ply and 1 more: "), ("1", "tile1-2.ply and 2 more: ")):
            said = self.succeeds(*self.command("TextureMesh", "--tiles", tiles)).stdout
            self.assertIn(f"warning: {self.work}/scene_texture.{named}", said)
        self.assertNotIn("another number", self.succeeds(
            *self.command("TextureMesh", "-o", "other", "--tiles", "2")).stdout)
        self.assertEqual(self.at("scene_texture.tile1-9.ply"), b"old")

    def test_tiles_of_a_cloud_are_removed(self):
        densify = (*DENSIFY, "-i", "scene.mvs", "-w", self.work)
        self.succeeds(*densify, "--fusion-mode", "1")
        for tile in ("1/2", "2/2", "1/3"):
            self.succeeds(*densify, "--tile", tile)
        changed = self.path("work", "scene_dense.tile2-2.ply")
        write(changed, read(changed) + b" ")
        tiles = lambda: {name for name in files_below(self.work) if ".tile" in name}
        self.assertEqual(len(tiles()), 6)
        said = self.succeeds(*densify, "--fusion-tiles", "4").stdout
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
        self.succeeds(*self.command("ReconstructMesh"))
        self.assertEqual({name for name in files_below(self.work) if "tiles" in name},
                         {"scene_mesh.tiles9/mine.txt", "scene_mesh.tiles/mine.txt"})

    def test_a_state_that_stays_after_an_error_is_named(self):
        """The output becomes a folder while the mesh is refined, so that it cannot be written."""
        output, state = (self.path("work", "refined.ply" + end) for end in ("", ".state"))
        command = self.command("RefineMesh", "-o", "refined.ply", "--scale-step", "1", "--scales",
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


class Rivals(Wall):
    """A second run on the output of a running one is told who writes it."""

    def held(self, name, how):
        lock = open(self.path("work", name + ".lock"), "w")
        self.addCleanup(lock.close)
        fcntl.flock(lock, how)
        lock.write(f"{os.getpid()} {os.uname().nodename} 2026-11-27 22:30:00\n")
        lock.flush()
        return lock

    def test_a_second_run_is_refused(self):
        who = (f"another run writes it: process {os.getpid()} on {os.uname().nodename}, since "
               "2026-11-27 22:30:00")
        for program, output in (("TextureMesh", "scene_texture.mvs"),
                                ("RefineMesh", "scene_refine.ply"),
                                ("ReconstructMesh", "scene_mesh.ply")):
            lock = self.held(output, fcntl.LOCK_EX)
            self.refuses_and_keeps(f"{output}: {who}", *self.command(program))
            lock.close()
            self.succeeds(*self.command(program))  # the file alone is no lock
            self.assertNotIn(output + ".lock", files_below(self.work))
        masks = ("InterfaceCOLMAP", "-i", self.path("colmap", "images"), "-w", self.work,
                 "--mask-path", self.path("mask.png"), "-o", "masks/")
        write(self.path("mask.png"), grey_png([bytes(96)] * 72))
        for output, command in (
                ("map.dem.tif", self.command("MapSurface", "-o", "map", "--gsd", "0.02")),
                ("surveys.change.difference.tif",
                 ("CompareSurveys", "-i", "mesh.ply", "--other", "mesh.ply", "-w", self.work, "-o",
                  "surveys")),
                ("page", self.command("ViewScene", "--report", "page/")),
                ("moved.mvs", self.command("TransformScene", "-t", "t.txt", "-o", "moved")),
                ("some.mvs", self.command("TransformScene", "--sample-mesh", "-5", "-o", "some")),
                ("made.mvs", ("InterfaceCOLMAP", "-i", self.path("colmap"), "-w", self.work, "-o",
                              "made")),
                ("sparse", ("InterfaceCOLMAP", "-i", "scene.mvs", "-w", self.work)),
                ("masks", masks)):
            lock = self.held(output, fcntl.LOCK_EX)
            self.refuses_and_keeps(f"{output}: {who}", *command)
            lock.close()
            self.succeeds(*command)
            self.assertNotIn(output + ".lock", files_below(self.work))
        densify = (*DENSIFY, "-i", "scene.mvs", "-w", self.work)
        lock = self.held("scene_dense.mvs", fcntl.LOCK_EX)
        self.refuses_and_keeps(who, *densify)
        lock.close()
        lock = self.held("depth_maps", fcntl.LOCK_EX)
        self.refuses_and_keeps(who, *densify, "-o", "other")

    def test_runs_for_parts_are_no_rivals(self):
        densify = (*DENSIFY, "-i", "scene.mvs", "-w", self.work)
        locks = [self.held(name, fcntl.LOCK_SH) for name in ("scene_dense.mvs", "depth_maps")]
        for part in ("1/2", "2/2"):
            self.succeeds(*densify, "--until", "maps", "--part", part)
        self.refuses_and_keeps("another run writes it", *densify)
        locks[0].close()
        self.succeeds(*densify)  # all maps exist: they are only read
        self.assertIn("depth_maps.lock", files_below(self.work))


if __name__ == "__main__":
    main()
