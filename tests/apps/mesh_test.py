# SPDX-License-Identifier: GPL-3.0-or-later
"""ReconstructMesh: meshes in air and under water, the options of OpenMVS, wrong input."""

import os
import struct

from programs import main, must, read
from readers import Ply
from worlds import Densified


class Mesh(Densified):
    """The shared folders also hold the meshes that most cases compare with."""

    @classmethod
    def make(cls, folder):
        super().make(folder)
        for medium, port in (("air", ()), ("water", ("--refractive",))):
            must("ReconstructMesh", "-i", "scene_dense.mvs", "-w", cls.at(medium), *port)

    def meshed(self, folder, *arguments):
        return self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, *arguments).stdout

    def mesh(self, medium, *arguments):
        """A copy of the shared folder, meshed with these options."""
        folder = self.copy(medium, "_mesh.ply")
        self.meshed(folder, *arguments)
        return folder

    def ply(self, folder, name="scene_dense_mesh.ply"):
        return Ply(read(os.path.join(folder, name)))

    def distance(self, medium, folder):
        """The median distance of the mesh to the true surface [m]."""
        return self.evaluated(medium, os.path.join(folder, "scene_dense_mesh.ply"))["accuracy"]["median"]

    def test_the_mesh_is_on_the_surface_in_air_and_under_water(self):
        for medium in self.MEDIA:
            self.assertGreater(len(self.ply(self.at(medium)).faces), 1000)
            # The images have 320 x 240 pixels: a pixel is 2 to 3 mm wide on the surface.
            self.assertLess(self.distance(medium, self.at(medium)), 0.002)

    def test_options_of_openmvs(self):
        folder = self.mesh("air", "-p", "scene_dense.ply", "-o", "new/result.mvs", "-d", "4",
                           "--decimate", "0.5", "--smooth", "2", "--close-holes", "10", "-f", "1",
                           "--edge-length", "0", "--archive-type", "-1", "--cuda-device", "-2")
        few = self.ply(folder, "new/result.ply")
        self.meshed(folder, "-d", "4")
        self.assertLess(len(few.faces), 0.6 * len(self.ply(folder).faces))

    def test_obj_has_the_same_faces(self):
        folder = self.mesh("air", "--export-type", "obj")
        obj = read(os.path.join(folder, "scene_dense_mesh.obj")).decode().split("\n")
        expected = self.ply(self.at("air"))
        faces = [tuple(int(word) - 1 for word in line.split()[1:]) for line in obj if line.startswith("f ")]
        self.assertEqual(faces, expected.triangles)
        points = [tuple(float(word) for word in line.split()[1:]) for line in obj if line.startswith("v ")]
        for a, b in zip(points, expected.points, strict=True):
            self.assertEqual(struct.pack("<3f", *a), struct.pack("<3f", *b))

    def test_the_name_of_the_output_chooses_the_format(self):
        folder = self.mesh("air", "-o", "a.obj")
        self.assertTrue(read(os.path.join(folder, "a.obj")).startswith(b"v "))
        folder = self.mesh("air", "-o", "scan.v2")
        self.assertTrue(read(os.path.join(folder, "scan.v2.ply")).startswith(b"ply"))

    def test_without_a_cloud_the_points_of_the_scene_are_meshed(self):
        folder = self.copy("air", "scene_dense.ply")
        self.assertIn("Cloud scene_dense.mvs: ", self.meshed(folder))

    def test_a_mesh_is_cleaned(self):
        folder = self.copy("air")
        clean = ("--mesh-file", "scene_dense_mesh.ply", "-o", "clean")
        self.meshed(folder, *clean, "--target-face-num", "500")
        self.assertLess(abs(len(self.ply(folder, "clean.ply").faces) - 500), 60)
        faces = []
        for length in ("0.01", "0.02"):
            self.meshed(folder, *clean, "--edge-length", length)
            faces.append(len(self.ply(folder, "clean.ply").faces))
        # Half the length: four times as many faces, if the borders were the same.
        self.assertGreater(faces[0], 2.5 * faces[1])

    def marks(self, folder, name):
        """The marks of the faces of a mesh without texture; None if it has no marks."""
        mesh = self.ply(folder, name)
        return [face["unseen"][0] for face in mesh.faces] if "property uint8 unseen" in mesh.header else None

    def test_surface_that_no_two_cameras_see_is_removed_or_marked(self):
        folder = self.copy("water")
        self.assertIsNone(self.marks(folder, "scene_dense_mesh.ply"))
        self.meshed(folder, "-o", "closed", "--refractive", "--close-unseen", "1")
        marks = self.marks(folder, "closed.ply")
        self.assertGreater(sum(marks), 10)
        seen = len(self.ply(folder).faces)
        self.assertLessEqual(seen, len(marks) - sum(marks))
        self.assertGreater(seen, 0.9 * (len(marks) - sum(marks)))
        # The marks go through the other programs.
        inputs = ("-i", "scene_dense.mvs", "-w", folder, "--refractive")
        self.succeeds("RefineMesh", *inputs, "-m", "closed.ply", "-o", "fine", "--scales", "1")
        self.assertGreater(sum(self.marks(folder, "fine.ply")), 10)
        self.succeeds("TextureMesh", *inputs, "-m", "closed.ply", "-o", "painted")
        self.assertIn(b"property uint8 unseen\n", read(os.path.join(folder, "painted.ply")))
        said = self.succeeds("MapSurface", *inputs, "-m", "painted.ply", "-o", "map").stdout
        self.assertIn("faces are left out: they are marked as unseen", said)
        # Without them, the same mesh with other triangles has no marks.
        self.succeeds("RefineMesh", *inputs, "-m", "scene_dense_mesh.ply", "-o", "fine",
                      "--scales", "1")
        self.assertIsNone(self.marks(folder, "fine.ply"))

    def test_tiles_make_the_mesh_of_one_piece(self):
        folder = self.mesh("water", "--refractive", "--tiles", "3")
        at_once = read(os.path.join(folder, "scene_dense_mesh.ply"))
        self.assertLess(abs(len(Ply(at_once).faces) / len(self.ply(self.at("water")).faces) - 1), 0.01)
        self.assertLess(self.distance("water", folder), 0.002)
        self.assertEqual([name for name in os.listdir(folder) if "tiles" in name], [])

    COMMAND = ("ReconstructMesh", "-i", "scene_dense.mvs", "-w")

    def test_wrong_options_are_refused(self):
        self.refuses_each(
            (*self.COMMAND, self.copy("air")), ("--tiles 0", "--tiles", "0"), ("--tile 4/3", "--tile", "4/3"),
            ("--tile 1/1: there must be at least 2 tiles", "--tile", "1/1"),
            ("--tile 1/3: contradicts --tiles 4", "--tile", "1/3", "--tiles", "4"),
            ("--tiles 2: contradicts --decimate", "--tiles", "2", "--decimate", "0.5"),
            ("not built yet", "--split-max-area", "3"), ("--decimate 1.5", "--decimate", "1.5"),
            ("--export-type stl", "--export-type", "stl"), ("no.ply", "-p", "no.ply"),
            ("--max-memory", "--max-memory", "1"), ("housing", "--refractive"),
            ("--output-file new/: must be the name of a file", "-o", "new/"))


if __name__ == "__main__":
    main()
