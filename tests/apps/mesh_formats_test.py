# SPDX-License-Identifier: GPL-3.0-or-later
"""Every program that takes a mesh reads every format: a mesh gives the same result as the PLY file
with the same vertices and faces."""

import json
import os
import shutil
import struct

from programs import contents, main, read, write
from readers import Ply
from tiny_scene import TinyScene
from worlds import matrix_text, obj, ply, wall


def glb_bytes(gltf, binary):
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary))
            + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def gltf_parts(vertices, faces):
    """A glTF without textures, whose node moves the mesh back by what its vertices are shifted."""
    positions = b"".join(struct.pack("<3f", x, y, z + 2.0) for x, y, z in vertices)
    indices = b"".join(struct.pack("<3H", *face) for face in faces)
    view = lambda at, data: {"buffer": 0, "byteOffset": at, "byteLength": len(data)}
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "translation": [0, 0, -2]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": len(vertices), "type": "VEC3"},
                {"bufferView": 1, "componentType": 5123, "count": 3 * len(faces), "type": "SCALAR"}],
            "bufferViews": [view(0, positions), view(len(positions), indices)],
            "buffers": [{"byteLength": len(positions + indices)}]}, positions + indices


class Formats(TinyScene):
    """The wall as m.ply, without textures as m.obj, m.gltf with "the mesh.bin", and n.glb."""

    def setUp(self):
        super().setUp()
        vertices, faces = wall(cells=8, half=0.25)  # exact in float
        vertices = [(x, y, z + i * 7 % 3 / 64) for i, (x, y, z) in enumerate(vertices)]
        self.put("m.ply", ply(vertices, faces))
        self.put("m.obj", obj(vertices, faces))
        self.put("cloud.ply", ply(wall(cells=8, half=0.25)[0]))
        gltf, binary = gltf_parts(vertices, faces)
        self.put("n.glb", glb_bytes(gltf, binary))
        gltf["buffers"][0]["uri"] = "the%20mesh.bin"
        self.put("the mesh.bin", binary)
        self.put("m.gltf", json.dumps(gltf))

    def put(self, name, data):
        write(self.path("work", name), data)

    def outputs(self, program, mesh, option="-m", *arguments):
        """The files that the program makes from the mesh, and removes them."""
        name = "out.mvs" if program == "TransformScene" else "out"
        found, _ = self.new_files(self.work, *self.command(program, option, mesh, "-o", name, *arguments))
        self.assertTrue(found)
        for made in found:
            os.remove(self.path("work", made))
        return found

    def page(self, mesh):
        """The files of a page about the mesh and its textures."""
        page = self.path("page")
        self.succeeds(*self.command("ViewScene", "-p", "cloud.ply", "-m", mesh, "--report", page))
        found = {name: data for name, data in contents(page).items() if "mesh" in name or "texture" in name}
        self.assertTrue(found)
        shutil.rmtree(page)
        return found

    def moved_points(self, mesh):
        found = self.outputs("TransformScene", mesh, "-m", "-t", self.path("t.txt"))
        return Ply(found["out_mesh.ply"]).points


class Untextured(Formats):
    def test_every_format_gives_the_same(self):
        for program, *arguments in (("TextureMesh", "-m"), ("RefineMesh", "-m", "--max-views", 2, "--scales", 1),
                                    ("ReconstructMesh", "--mesh-file", "--remove-spurious", 0), ("MapSurface", "-m")):
            expected = self.outputs(program, "m.ply", *arguments)
            for mesh in ("m.obj", "m.gltf", "n.glb"):
                with self.subTest(program=program, mesh=mesh):
                    self.assertEqual(self.outputs(program, mesh, *arguments), expected)

    def test_transform_scene(self):
        write(self.path("t.txt"), matrix_text(2.5))
        expected = self.moved_points("m.ply")
        for mesh in ("m.obj", "m.gltf", "n.glb"):
            for a, b in zip(self.moved_points(mesh), expected, strict=True):
                self.near(a, b, 1e-6)

    def test_evaluate_reconstruction(self):
        reports = []
        for mesh, truth in (("m.ply", "m.ply"), ("m.obj", "m.gltf"), ("n.glb", "m.obj"),
                            ("m.gltf", "n.glb")):
            report = self.path("report.json")
            self.succeeds("EvaluateReconstruction", "-i", self.path("work", mesh), "-m",
                          self.path("work", truth), "--samples", 2000, "--json", report)
            reports.append(json.loads(read(report)))
            os.remove(report)
        self.assertEqual([report["accuracy"] for report in reports[1:]], 3 * [reports[0]["accuracy"]])

    def test_view_scene(self):
        pages = [self.page(mesh) for mesh in ("m.ply", "m.obj", "m.gltf", "n.glb")]
        self.assertEqual(pages[1:], 3 * [pages[0]])

    def test_files_of_the_mesh_are_not_replaced(self):
        self.put("y.gltf", self.at("m.gltf").replace(b"the%20mesh", b"x"))
        self.put("x.bin", self.at("the mesh.bin"))
        self.refuses_and_keeps("x.bin", *self.command("TextureMesh", "-m", "y.gltf", "-o", "x", "--export-type",
                                                      "gltf"))


class Textured(Formats):
    """The textured wall as TextureMesh writes it, and as a GLB with its picture beside it."""

    def setUp(self):
        super().setUp()
        self.succeeds(*self.command("TextureMesh", "-m", "m.ply", "-o", "t", "--export-type", "ply,obj,glb,gltf"))
        gltf = json.loads(self.at("t.gltf"))
        del gltf["buffers"][0]["uri"]
        self.put("e.glb", glb_bytes(gltf, self.at("t.bin")))

    def test_maps(self):
        maps = [self.outputs("MapSurface", mesh) for mesh in ("t.glb", "t.gltf", "e.glb")]
        self.assertEqual(maps[1:], 2 * [maps[0]])
        for mesh in ("t.ply", "t.obj"):  # texture coordinates differ by their rounding
            self.assertEqual(self.outputs("MapSurface", mesh)["out.dem.tif"], maps[0]["out.dem.tif"])

    def test_transform_scene_writes_a_textured_ply(self):
        write(self.path("t.txt"), matrix_text(2.5))
        for mesh in ("t.obj", "t.gltf", "e.glb"):
            found = self.outputs("TransformScene", mesh, "-m", "-t", self.path("t.txt"))
            self.assertLess({"out.mvs", "out_mesh.ply", "out_mesh0.png"}, set(found) | {""})
            self.assertIn(b"comment TextureFile out_mesh0.png\n", found["out_mesh.ply"])
        self.refuses_and_keeps("t_gltf0.png", *self.command("TransformScene", "-m", "e.glb", "-t", self.path("t.txt"),
                                                            "-o", "t.mvs", "--transform-out",
                                                            self.path("work", "t_gltf0.png")))

    def test_pages(self):
        self.assertEqual(self.page("t.gltf"), self.page("e.glb"))

    def test_their_pictures_are_not_replaced(self):
        self.put("u.gltf", self.at("t.gltf").replace(b'"t.bin"', b'"u.bin"'))
        self.put("u.bin", self.at("t.bin"))
        self.refuses_and_keeps("t_gltf0.png", *self.command("TextureMesh", "-m", "u.gltf", "-o", "t", "--export-type",
                                                            "gltf"))


if __name__ == "__main__":
    main()
