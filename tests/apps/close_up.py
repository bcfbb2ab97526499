# SPDX-License-Identifier: GPL-3.0-or-later
"""Four views of 512 x 384 of the close-up scene, simulated once for all cases of a test class."""

import json
import os
import tempfile

from programs import ProgramTest, read, run

# The width of a pixel at the scene: the median distance (0.7 m) over the focal length (305 px).
GSD = 0.7 / 305
# Large enough to show differences in quality, small enough to run often.
QUICK = ("--resolution-level", "1", "--min-resolution", "200")
# Recall then has a standard deviation of 0.004. Errors use all points of the cloud.
RECALL_SAMPLES = 20000


class SceneTest(ProgramTest):
    """The close-up scene. SCENE holds further options of SimulateUnderwater."""
    SCENE = ()  # None: base class of other tests, without a scene

    @classmethod
    def setUpClass(cls):
        if cls.SCENE is None:
            return
        cls.shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.truth = os.path.join(cls.shared.name, "closeup")
        made = run("SimulateUnderwater", "--preset", "closeup", "--views", 4, "--width", 512,
                   "--height", 384, "--seed", 1, "--samples", 2, "--coarseness", 3, *cls.SCENE,
                   "-o", cls.truth)
        assert made.returncode == 0, made.stderr

    def import_scene(self, medium, folder, *arguments, housing=True):
        port = ["--housing", os.path.join(self.truth, "housing.json")]
        self.succeeds("InterfaceCOLMAP", "-i", self.truth, "--image-folder",
                      os.path.join(self.truth, medium), "-o", self.path(folder, "scene.mvs"),
                      *(port if medium == "water" and housing else []), *arguments)

    def densify(self, folder, *arguments):
        result = self.succeeds("DensifyPointCloud", "-i", "scene.mvs", "-w", self.path(folder),
                               *arguments)
        return result.stdout

    def evaluate(self, medium, folder):
        port = ["--housing", os.path.join(self.truth, "housing.json")] if medium == "water" else []
        self.succeeds("EvaluateReconstruction", "-i", self.path(folder, "scene_dense.ply"), "-m",
                      os.path.join(self.truth, "mesh.ply"), "--cameras",
                      os.path.join(self.truth, "sparse"), *port, "--tolerance", "0.002",
                      "--samples", RECALL_SAMPLES, "--json", self.path(folder, "evaluation.json"))
        return json.loads(read(self.path(folder, "evaluation.json")))
