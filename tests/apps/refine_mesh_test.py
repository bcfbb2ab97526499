# SPDX-License-Identifier: GPL-3.0-or-later
"""RefineMesh: noisy meshes in air and under water, the options of OpenMVS, wrong input."""

import json
import os
import random
import struct

from openmvs_scene import Scene
from programs import contents, main, read, write


def ply(vertices, faces):
    """The bytes of a binary mesh."""
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
            "property float x\nproperty float y\nproperty float z\n"
            f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n")
    return (head.encode() + b"".join(struct.pack("<3f", *v) for v in vertices) +
            b"".join(struct.pack("<B3I", 3, *f) for f in faces))


def parts(data):
    """The vertices and faces of a mesh that our programs wrote."""
    head, body = data.split(b"end_header\n", 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in head.split(b"\n")
              if line.startswith(b"element")}
    vertices, faces = counts[b"vertex"], counts[b"face"]
    return ([struct.unpack_from("<3f", body, 12 * i) for i in range(vertices)],
            [struct.unpack_from("<3I", body, 12 * vertices + 13 * i + 1) for i in range(faces)])


class Refined(Scene):
    def setUp(self):
        super().setUp()
        self.truth_mesh = os.path.join(self.truth, "mesh.ply")

    def noisy(self, folder, noise=0.002):
        """Writes the meshed cloud with noise of the standard deviation `noise` [m]."""
        self.succeeds("ReconstructMesh", "-i", "scene_dense.mvs", "-w", folder, "-o", "start.ply")
        vertices, faces = parts(read(os.path.join(folder, "start.ply")))
        rng = random.Random(1)
        vertices = [tuple(x + rng.gauss(0, noise) for x in v) for v in vertices]
        write(os.path.join(folder, "start.ply"), ply(vertices, faces))

    def refine(self, folder, *arguments, result="refined.ply"):
        """Refines start.ply at the size of the images. Returns the output and the result."""
        said = self.succeeds("RefineMesh", "-i", "scene_dense.mvs", "-m", "start.ply", "-w", folder,
                             "-o", result, *arguments)
        return said.stdout, read(os.path.join(folder, result))

    def error(self, medium, file):
        """The median distance of the mesh to the true surface [m]."""
        report = self.path("report.json")
        port = ["--housing", os.path.join(self.truth, "housing.json")] if medium == "water" else []
        self.succeeds("EvaluateReconstruction", "-i", file, "-m", self.truth_mesh, "--cameras",
                      self.truth, *port, "--samples", 20000, "--json", report)
        with open(report) as text:
            return json.load(text)["accuracy"]["median"]

    def test_a_noisy_mesh_becomes_better_in_air_and_under_water(self):
        for medium in self.MEDIA:
            folder = self.copy(medium)
            self.noisy(folder)
            start = self.error(medium, os.path.join(folder, "start.ply"))
            said, _ = self.refine(folder, *(("--refractive",) if medium == "water" else ()))
            refined = self.error(medium, os.path.join(folder, "refined.ply"))
            self.assertLess(refined, 0.6 * start, medium)
            self.assertIn("vertices measured in", said)
        # The last folder is under water. Without the port, the photographs contradict each other.
        self.refine(folder, "--camera-model", "pinhole", result="ignored.ply")
        self.assertGreater(self.error("water", os.path.join(folder, "ignored.ply")), 1.5 * refined)

    def test_threads_and_memory_do_not_change_the_bytes(self):
        folder = self.copy("water")
        self.noisy(folder)
        _, two = self.refine(folder, "--max-threads", "2")
        _, one = self.refine(folder, "--max-threads", "1", "--max-memory", "160")
        self.assertEqual(one, two)
        self.refuses("--max-memory", "RefineMesh", "-i", "scene_dense.mvs", "-m", "start.ply", "-w",
                     folder, "-o", "small.ply", "--max-memory", "90")

    def test_options_of_openmvs(self):
        folder = self.copy("air")
        self.noisy(folder)
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
        self.assertLess(len(parts(other)[1]), 0.7 * len(parts(usual)[1]))

    def test_default_names(self):
        folder = self.copy("air")
        self.noisy(folder)
        os.rename(os.path.join(folder, "start.ply"), os.path.join(folder, "scene_mesh.ply"))
        os.rename(os.path.join(folder, "scene_dense.mvs"), os.path.join(folder, "scene_mesh.mvs"))
        self.succeeds("RefineMesh", "scene_mesh.mvs", "-w", folder, "--scales", "1")
        self.assertGreater(len(parts(read(os.path.join(folder, "scene_mesh_refine.ply")))[1]), 1000)

    def test_wrong_input(self):
        folder = self.copy("air")
        command = ("RefineMesh", "-i", "scene_dense.mvs", "-w", folder, "-m", "wrong.ply")
        wall = [(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
        behind = [(x, y, z + 100) for x, y, z in wall]
        for vertices, faces, expected in (
                (wall, [], "wrong.ply: the mesh has no faces"),
                (wall, [(0, 1, 2), (0, 2, 4)], "wrong.ply"),
                ([*wall[:3], (float("nan"), 0, 0)], [(0, 1, 2), (0, 2, 3)], "wrong.ply"),
                (behind, [(0, 1, 2)], "wrong.ply: no camera of")):
            write(os.path.join(folder, "wrong.ply"), ply(vertices, faces))
            before = contents(folder)
            self.refuses(expected, *command)
            self.assertEqual(contents(folder), before)
        good = ply(wall, [(0, 1, 2), (0, 2, 3)])
        for size in (0, 5, 100, len(good) - 1):
            write(os.path.join(folder, "wrong.ply"), good[:size])
            self.refuses("wrong.ply", *command)
        self.refuses("absent.ply", *command[:-1], "absent.ply")
        self.refuses("--scale-step 1.1", *command, "--scale-step", "1.1")
        self.refuses("--refractive", *command, "--refractive", "--camera-model", "pinhole")
        self.refuses("housing file not found", *command, "--refractive")
        self.refuses("--output-file", *command, "-o", "wrong.ply")
        self.refuses("--output-file ./: must be the name of a file", *command, "-o", "./")


if __name__ == "__main__":
    main()
