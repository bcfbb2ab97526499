# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole chain, from a scene of OpenMVS to a textured mesh, as OpenMVS's users run it."""

import array
import json
import math
import os
import re
import struct
import unittest
import zlib

from openmvs_scene import ascii_ply
from programs import ProgramTest, main, read, write
from transform_scene_test import Mvs

DATA = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[".."] * 3, "shared", "data",
                    "openmvs-files")


class Glb:
    """A binary glTF 2.0, read from the description of the format."""

    def __init__(self, data):
        magic, version, length, json_length, json_kind = struct.unpack_from("<4sIII4s", data)
        assert (magic, version, length, json_kind) == (b"glTF", 2, len(data), b"JSON")
        self.json = json.loads(data[20:20 + json_length])
        at = 20 + json_length
        binary_length, binary_kind = struct.unpack_from("<I4s", data, at)
        assert binary_kind == b"BIN\0" and at % 4 == 0 and at + 8 + binary_length == len(data)
        self.binary = data[at + 8:]

    def view(self, index):
        view = self.json["bufferViews"][index]
        begin = view.get("byteOffset", 0)
        assert begin % 4 == 0 and begin + view["byteLength"] <= len(self.binary)
        return self.binary[begin:begin + view["byteLength"]]

    def values(self, index):
        """The accessor's numbers, one after the other."""
        accessor = self.json["accessors"][index]
        result = array.array({5126: "f", 5125: "I"}[accessor["componentType"]],
                             self.view(accessor["bufferView"]))
        width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        assert len(result) == width * accessor["count"]
        return result


def png_pixels(data):
    """Width, height and the number of bytes of the unpacked rows of an 8-bit RGB PNG."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack_from(">IIBB", data, at + 8)
            assert (depth, color) == (8, 2)
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += 12 + length
    return width, height, len(zlib.decompress(packed))


@unittest.skipUnless(os.path.exists(os.path.join(DATA, "scene_v6.mvs")), "no scene_v6.mvs here")
class Chain(ProgramTest):
    """Four photographs of 640 x 479 pixels, matched and refined at half of this size."""

    def step(self, *command):
        return self.succeeds(*command, "-w", self.folder).stdout

    def median_distance(self, mesh):
        """Of the sparse points, which other software found, to the mesh."""
        points = Mvs(read(self.path("scene_dense.mvs"))).points
        write(self.path("sparse.ply"), ascii_ply([(x, []) for x in points], with_views=False))
        self.step("EvaluateReconstruction", "-i", "sparse.ply", "-m", mesh, "--samples", "1000",
                  "--json", "report.json")
        return json.loads(read(self.path("report.json")))["accuracy"]["median"]

    def check_glb(self, name, ply):
        """The faces and the extent are those of the PLY, and the file says no more than it has."""
        header, body = ply.split(b"end_header\n", 1)
        counts = [int(n) for n in re.findall(rb"element \w+ (\d+)\n", header)]
        glb = Glb(read(self.path(name)))
        primitives = glb.json["meshes"][0]["primitives"]
        low, high, faces = [math.inf] * 3, [-math.inf] * 3, 0
        for primitive in primitives:
            indices = glb.values(primitive["indices"])
            positions = glb.values(primitive["attributes"]["POSITION"])
            uv = glb.values(primitive["attributes"]["TEXCOORD_0"])
            self.assertLess(max(indices), len(positions) // 3)
            self.assertEqual(len(uv) // 2, len(positions) // 3)
            self.assertTrue(0 <= min(uv) and max(uv) <= 1)
            bounds = glb.json["accessors"][primitive["attributes"]["POSITION"]]
            for k in range(3):
                self.assertEqual(bounds["min"][k], min(positions[k::3]))
                self.assertEqual(bounds["max"][k], max(positions[k::3]))
                low[k] = min(low[k], bounds["min"][k])
                high[k] = max(high[k], bounds["max"][k])
            faces += len(indices) // 3
        self.assertEqual(faces, counts[1])
        vertices = array.array("f", body[:12 * counts[0]])
        self.assertEqual(low, [min(vertices[k::3]) for k in range(3)])
        self.assertEqual(high, [max(vertices[k::3]) for k in range(3)])
        for image in glb.json["images"]:
            width, height, size = png_pixels(glb.view(image["bufferView"]))
            self.assertEqual(size, height * (1 + 3 * width))

    def test_from_photographs_to_a_textured_mesh(self):
        os.symlink(os.path.join(DATA, "images"), self.path("images"))
        write(self.path("scene.mvs"), read(os.path.join(DATA, "scene_v6.mvs")))
        half = ("--resolution-level", "1", "--min-resolution", "320")
        self.step("DensifyPointCloud", "scene.mvs", *half)
        self.step("ReconstructMesh", "scene_dense.mvs", "-p", "scene_dense.ply")
        self.step("RefineMesh", "scene_dense.mvs", "-m", "scene_dense_mesh.ply", "-o",
                  "scene_dense_mesh_refine.mvs", *half)
        said = self.step("TextureMesh", "scene_dense.mvs", "-m", "scene_dense_mesh_refine.ply", "-o",
                         "scene_texture.mvs", "--export-type", "ply,obj,glb")
        unseen, all_faces = map(int, re.search(r"(\d+) of (\d+) faces are not seen", said).groups())
        self.assertLess(unseen, all_faces / 20)
        # Where the points are, at about 9 units from the cameras, a pixel of half size is 0.027 wide.
        for mesh in ("scene_dense_mesh.ply", "scene_dense_mesh_refine.ply"):
            self.assertLess(self.median_distance(mesh), 0.027)
        ply = read(self.path("scene_texture.ply"))
        self.check_glb("scene_texture.glb", ply)
        self.assertIn(f"element face {all_faces}\n".encode(), ply)
        self.assertEqual(len(re.findall(rb"^f ", read(self.path("scene_texture.obj")), re.M)),
                         all_faces)


if __name__ == "__main__":
    main()
