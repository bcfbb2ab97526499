# SPDX-License-Identifier: GPL-3.0-or-later
"""ReconstructMesh: meshes in air and under water, the options of OpenMVS, wrong input."""

import json
import os
import random
import struct

from openmvs_scene import Scene
from programs import main, read, write


class PlyMesh:
    """A mesh that our programs wrote: float positions and triangles."""

    def __init__(self, data):
        head, body = data.split(b"end_header\n", 1)
        counts = {line.split()[1]: int(line.split()[2]) for line in head.split(b"\n")
                  if line.startswith(b"element")}
        vertices, faces = counts[b"vertex"], counts[b"face"]
        self.vertices = [struct.unpack_from("<3f", body, 12 * i) for i in range(vertices)]
        self.faces = [struct.unpack_from("<3I", body, 12 * vertices + 13 * i + 1)
                      for i in range(faces)]


class Mesh(Scene):
    def mesh(self, medium, *arguments):
        folder = self.copy(medium)
        self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, *arguments)
        return folder

    def evaluated(self, medium, file):
        """The median distance of the mesh to the true surface [m]."""
        report = self.path("report.json")
        port = ["--housing", os.path.join(self.truth, "housing.json")] if medium == "water" else []
        self.succeeds("EvaluateReconstruction", "-i", file, "-m",
                      os.path.join(self.truth, "mesh.ply"), "--cameras", self.truth, *port,
                      "--samples", 20000, "--json", report)
        with open(report) as text:
            return json.load(text)["accuracy"]["median"]

    def test_the_mesh_is_on_the_surface_in_air_and_under_water(self):
        for medium in self.MEDIA:
            folder = self.mesh(medium, *(("--refractive",) if medium == "water" else ()))
            mesh = PlyMesh(read(os.path.join(folder, "scene_dense_mesh.ply")))
            self.assertGreater(len(mesh.faces), 1000)
            # The images have 320 x 240 pixels: a pixel is 2 to 3 mm wide on the surface.
            self.assertLess(self.evaluated(medium, os.path.join(folder, "scene_dense_mesh.ply")),
                            0.002)

    def test_one_thread_gives_the_same_bytes(self):
        folder = self.mesh("water", "--max-threads", "2")
        first = read(os.path.join(folder, "scene_dense_mesh.ply"))
        folder = self.mesh("water", "--max-threads", "1")
        self.assertEqual(read(os.path.join(folder, "scene_dense_mesh.ply")), first)

    def test_options_of_openmvs(self):
        folder = self.mesh("air", "-p", "scene_dense.ply", "-o", "new/result.mvs", "-d", "4",
                           "--decimate", "0.5", "--smooth", "2", "--close-holes", "10", "-f", "1",
                           "--edge-length", "0", "--archive-type", "-1", "--cuda-device", "-2")
        few = PlyMesh(read(os.path.join(folder, "new", "result.ply")))
        folder = self.mesh("air", "-d", "4")
        all_of_them = PlyMesh(read(os.path.join(folder, "scene_dense_mesh.ply")))
        self.assertLess(len(few.faces), 0.6 * len(all_of_them.faces))

    def test_obj_has_the_same_faces(self):
        folder = self.mesh("air", "--export-type", "obj")
        obj = read(os.path.join(folder, "scene_dense_mesh.obj")).decode().split("\n")
        folder = self.mesh("air")
        ply = PlyMesh(read(os.path.join(folder, "scene_dense_mesh.ply")))
        faces = [tuple(int(word) - 1 for word in line.split()[1:]) for line in obj
                 if line.startswith("f ")]
        self.assertEqual(faces, ply.faces)
        points = [tuple(float(word) for word in line.split()[1:]) for line in obj
                  if line.startswith("v ")]
        for a, b in zip(points, ply.vertices, strict=True):
            self.assertEqual(struct.pack("<3f", *a), struct.pack("<3f", *b))

    def test_the_name_of_the_output_chooses_the_format(self):
        folder = self.mesh("air", "-o", "a.obj")
        self.assertTrue(read(os.path.join(folder, "a.obj")).startswith(b"v "))
        folder = self.mesh("air", "-o", "scan.v2")
        self.assertTrue(read(os.path.join(folder, "scan.v2.ply")).startswith(b"ply"))

    def test_without_a_cloud_the_points_of_the_scene_are_meshed(self):
        folder = self.copy("air", "scene_dense.ply")
        said = self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder).stdout
        self.assertIn("Cloud scene_dense.mvs: ", said)

    def test_a_mesh_is_cleaned(self):
        folder = self.mesh("air")
        self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, "--mesh-file",
                      "scene_dense_mesh.ply", "-o", "half", "--target-face-num", "500")
        half = PlyMesh(read(os.path.join(folder, "half.ply")))
        self.assertLess(abs(len(half.faces) - 500), 60)

    def test_meshes_are_remeshed(self):
        folder = self.mesh("air", "--edge-length", "0.005")
        short = PlyMesh(read(os.path.join(folder, "scene_dense_mesh.ply")))
        folder = self.mesh("air")
        self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, "--mesh-file",
                      "scene_dense_mesh.ply", "-o", "long", "--edge-length", "0.01")
        long = PlyMesh(read(os.path.join(folder, "long.ply")))
        # Half the length: four times as many faces, if the borders were the same.
        self.assertGreater(len(short.faces), 2.5 * len(long.faces))

    @staticmethod
    def marks(data):
        """The marks of the faces of a mesh without texture; None if it has no marks."""
        head, body = data.split(b"end_header\n", 1)
        if b"property uint8 unseen\n" not in head:
            return None
        faces = int(head.split(b"element face ")[1].split(b"\n")[0])
        return body[len(body) - 14 * faces:][13::14]

    def test_surface_that_no_two_cameras_see_is_removed_or_marked(self):
        folder = self.mesh("water", "--refractive")
        seen = read(os.path.join(folder, "scene_dense_mesh.ply"))
        self.assertIsNone(self.marks(seen))
        self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, "-o", "closed",
                      "--refractive", "--close-unseen", "1")
        marks = self.marks(read(os.path.join(folder, "closed.ply")))
        self.assertGreater(sum(marks), 10)
        self.assertLessEqual(len(PlyMesh(seen).faces), len(marks) - sum(marks))
        self.assertGreater(len(PlyMesh(seen).faces), 0.9 * (len(marks) - sum(marks)))
        # The marks go through the other programs.
        inputs = ("-i", "scene_dense.mvs", "-w", folder, "--refractive")
        self.succeeds("RefineMesh", *inputs, "-m", "closed.ply", "-o", "fine", "--scales", "1")
        self.assertGreater(sum(self.marks(read(os.path.join(folder, "fine.ply")))), 10)
        self.succeeds("TextureMesh", *inputs, "-m", "closed.ply", "-o", "painted")
        self.assertIn(b"property uint8 unseen\n", read(os.path.join(folder, "painted.ply")))
        said = self.succeeds("MapSurface", *inputs, "-m", "painted.ply", "-o", "map").stdout
        self.assertIn("faces are left out: they are marked as unseen", said)
        # Without them, the same mesh with other triangles has no marks.
        self.succeeds("RefineMesh", *inputs, "-m", "scene_dense_mesh.ply", "-o", "fine",
                      "--scales", "1")
        self.assertIsNone(self.marks(read(os.path.join(folder, "fine.ply"))))

    def refused(self, folder, expected, *arguments):
        self.refuses(expected, "ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, *arguments)

    def test_tiles_make_the_mesh_of_one_piece(self):
        folder = self.mesh("water", "--refractive")
        file = os.path.join(folder, "scene_dense_mesh.ply")
        whole = PlyMesh(read(file))
        folder = self.mesh("water", "--refractive", "--tiles", "3")
        at_once = read(file)
        self.assertLess(abs(len(PlyMesh(at_once).faces) / len(whole.faces) - 1), 0.01)
        self.assertLess(self.evaluated("water", file), 0.002)
        self.assertEqual([name for name in os.listdir(folder) if "tiles" in name], [])
        # Tiles that other runs made, one of which was killed while it wrote.
        folder = self.copy("water")
        for tile in (3, 1):
            self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, "--refractive",
                          "--tile", f"{tile}/3")
        tiles = os.path.join(folder, "scene_dense_mesh.tiles3")
        tiles = os.path.join(tiles, *os.listdir(tiles))
        write(os.path.join(tiles, "mesh1.bin"), read(os.path.join(tiles, "mesh1.bin"))[:-100])
        self.assertFalse(os.path.exists(file))
        said = self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder,
                             "--refractive", "--tiles", "3").stdout
        self.assertEqual(read(file), at_once)
        self.assertIn("Tile 1 of 3", said)
        self.assertNotIn("Tile 3 of 3", said)

    def test_wrong_tiles_are_refused(self):
        folder = self.copy("air")
        self.refused(folder, "--tiles 0", "--tiles", "0")
        self.refused(folder, "--tile 4/3", "--tile", "4/3")
        self.refused(folder, "--tile 1/1: there must be at least 2 tiles", "--tile", "1/1")
        self.refused(folder, "--tile 1/3: contradicts --tiles 4", "--tile", "1/3", "--tiles", "4")
        self.refused(folder, "--tiles 2: contradicts --decimate", "--tiles", "2", "--decimate",
                     "0.5")
        cloud = os.path.join(folder, "scene_dense.ply")
        write(cloud, read(cloud)[:-1])
        self.refused(folder, "scene_dense.ply", "--tiles", "2")

    def test_wrong_input_is_refused_in_one_line(self):
        folder = self.copy("air")
        cloud = os.path.join(folder, "scene_dense.ply")
        good = read(cloud)
        header, body = good.split(b"end_header\n", 1)
        rng = random.Random(1)
        cuts = [0, 1, len(header) // 2, len(header) + 11, len(good) // 2, len(good) - 1]
        for content in [good[:cut] for cut in cuts] + [rng.randbytes(500), b"ply\n"]:
            write(cloud, content)
            self.refused(folder, "scene_dense.ply")
        write(cloud, good.replace(b"view_indices", b"view_indicez"))
        self.refused(folder, "have no views")
        write(cloud, good)
        self.refused(folder, "not built yet", "--split-max-area", "3")
        self.refused(folder, "--decimate 1.5", "--decimate", "1.5")
        self.refused(folder, "--export-type stl", "--export-type", "stl")
        self.refused(folder, "no.ply", "-p", "no.ply")
        self.refused(folder, "--max-memory", "--max-memory", "1")
        self.refused(folder, "housing", "--refractive")
        self.refused(folder, "is an input", "-o", "scene_dense.ply")
        self.refused(folder, "--output-file new/: must be the name of a file", "-o", "new/")

    def test_views_out_of_range_are_refused(self):
        folder = self.copy("air")
        cloud = os.path.join(folder, "scene_dense.ply")
        header = (b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                  b"property float z\nproperty list uchar uint view_indices\nend_header\n")
        write(cloud, header + b"0 0 1 1 0\n1 0 1 1 0\n0 1 1 1 0\n0 0 2 1 9\n")
        self.refused(folder, "point 3 names view 9")
        write(cloud, header + b"0 0 1 1 0\n1 0 1 1 0\n0 1 1 1 0\n1 1 1 1 0\n")
        self.refused(folder, "scene_dense.ply")


if __name__ == "__main__":
    main()
