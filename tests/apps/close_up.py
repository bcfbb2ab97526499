# SPDX-License-Identifier: GPL-3.0-or-later
"""Four views of 512 x 384 of the close-up scene, simulated once for all cases of a test class."""

from worlds import Simulated

FINE = ("--preset", "closeup", "--views", 4, "--width", 512, "--height", 384, "--seed", 1, "--samples", 2,
        "--coarseness", 3)
# The width of a pixel at the scene: the median distance (0.7 m) over the focal length (305 px).
GSD = 0.7 / 305
# Large enough to show differences in quality, small enough to run often.
QUICK = ("--resolution-level", "1", "--min-resolution", "200")
# Recall then has a standard deviation of 0.004. Errors use all points of the cloud.
RECALL_SAMPLES = 20000


class CloseUp(Simulated):
    """The folders of a case are below self.folder."""

    def import_scene(self, medium, folder, *arguments, port=None):
        self.imported(self.path(folder, "scene.mvs"), medium, *arguments, port=port)

    def command(self, folder, *arguments, scene="scene.mvs"):
        return ("DensifyPointCloud", "-i", scene, "-w", self.path(folder), *arguments)

    def densify(self, folder, *arguments, scene="scene.mvs"):
        return self.succeeds(*self.command(folder, *arguments, scene=scene)).stdout

    def scores(self, medium, folder):
        return self.evaluated(medium, self.path(folder, "scene_dense.ply"), "--tolerance", "0.002",
                              samples=RECALL_SAMPLES)
