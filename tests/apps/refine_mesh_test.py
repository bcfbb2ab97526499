# SPDX-License-Identifier: GPL-3.0-or-later
"""RefineMesh: noisy meshes in air and under water, the options of OpenMVS, wrong input."""

import os
import random

from programs import main, must, read, write
from readers import Ply
from worlds import Densified, binary_mesh


class Refined(Densified):
    """The shared folders also hold start.ply, the meshed cloud with noise of a standard deviation of 2 mm."""

    @classmethod
    def make(cls, folder):
        super().make(folder)
        for medium in cls.MEDIA:
            start = cls.at(medium, "start.ply")
            must("ReconstructMesh", "-i", "scene_dense.mvs", "-w", cls.at(medium), "-o", start)
            mesh, rng = Ply(read(start)), random.Random(1)
            write(start, binary_mesh([[x + rng.gauss(0, 0.002) for x in v] for v in mesh.points], mesh.triangles))

        for medium, *arguments in (("air",), ("water", "--refractive")):  # at the size of the images
            said = must("RefineMesh", "-i", "scene_dense.mvs", "-m", "start.ply", "-w", cls.at(medium), "-o",
                        "refined.ply", *arguments)
            assert "vertices measured in" in said, said

    def refine(self, folder, *arguments, result="other.ply"):
        """Refines start.ply. Returns the output and the result."""
        said = self.succeeds("RefineMesh", "-i", "scene_dense.mvs", "-m", "start.ply", "-w", folder,
                             "-o", result, *arguments)
        return said.stdout, read(os.path.join(folder, result))

    def error(self, medium, folder, name):
        """The median distance of the mesh to the true surface [m]."""
        return self.evaluated(medium, os.path.join(folder, name))["accuracy"]["median"]

    def faces(self, data):
        return len(Ply(data).faces)

    def test_a_noisy_mesh_becomes_better_in_air_and_under_water(self):
        for medium in self.MEDIA:
            start, refined = (self.error(medium, self.at(medium), name) for name in ("start.ply", "refined.ply"))
            self.assertLess(refined, 0.6 * start, medium)
        # The last scene is under water. Without the port, the photographs contradict each other.
        folder = self.copy("water")
        self.refine(folder, "--camera-model", "pinhole", result="ignored.ply")
        self.assertGreater(self.error("water", folder, "ignored.ply"), 1.5 * refined)

    def test_options_of_openmvs(self):
        folder = self.copy("air")
        quick = ("--resolution-level", "1", "--min-resolution", "100")
        said, usual = self.refine(folder, *quick)
        self.assertNotIn("without effect", said)
        defaults = ("--max-views", "8", "--decimate", "0", "--ensure-edge-size", "1",
                    "--max-face-area", "32", "--scales", "2", "--scale-step", "0.5",
                    "--alternate-pair", "0", "--regularity-weight", "0.2",
                    "--rigidity-elasticity-ratio", "0.9", "--gradient-step", "45.05",
                    "--planar-vertex-ratio", "0", "--reduce-memory", "1", "--cuda-device", "-2",
                    "--archive-type", "-1")
        said, same = self.refine(folder, *quick, *defaults)
        self.assertEqual(same, usual)
        self.assertEqual(said.count("without effect"), 1, said)
        for option, value in (("--scales", "1"), ("--alternate-pair", "1"), ("--max-views", "1"),
                              ("--regularity-weight", "2"), ("--max-face-area", "4"),
                              ("--decimate", "0.5")):
            _, other = self.refine(folder, *quick, option, value)
            self.assertNotEqual(other, usual, option)
        self.assertLess(self.faces(other), 0.7 * self.faces(usual))

    def test_default_names(self):
        folder = self.copy("air")
        os.rename(os.path.join(folder, "start.ply"), os.path.join(folder, "scene_mesh.ply"))
        os.rename(os.path.join(folder, "scene_dense.mvs"), os.path.join(folder, "scene_mesh.mvs"))
        self.succeeds("RefineMesh", "scene_mesh.mvs", "-w", folder, "--scales", "1")
        self.assertGreater(self.faces(read(os.path.join(folder, "scene_mesh_refine.ply"))), 1000)

    def test_wrong_input(self):
        self.folder = folder = self.copy("air")
        command = ("RefineMesh", "-i", "scene_dense.mvs", "-w", folder, "-m", "wrong.ply")
        write(os.path.join(folder, "wrong.ply"), binary_mesh([(-1, -1, 101), (1, -1, 101), (1, 1, 101)], [(0, 1, 2)]))
        self.refuses_and_keeps("wrong.ply: no camera of", *command)
        write(os.path.join(folder, "wrong.ply"), read(os.path.join(folder, "start.ply")))
        self.refuses_each(command, ("--scale-step 1.1", "--scale-step", "1.1"),
                          ("--refractive", "--refractive", "--camera-model", "pinhole"),
                          ("--max-memory", "--max-memory", "90"),
                          ("housing file not found", "--refractive"),
                          ("--output-file ./: must be the name of a file", "-o", "./"))


if __name__ == "__main__":
    main()
