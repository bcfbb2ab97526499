# SPDX-License-Identifier: GPL-3.0-or-later
"""ReconstructMesh, RefineMesh, TextureMesh and MapSurface that are killed at several moments: each
output is complete or absent, and the next run writes the bytes of a run that was not killed."""

import os
import shutil
import signal
import subprocess
import time

from programs import BIN, contents, dead_process, files_below, main, must, read, write
from worlds import Densified

REFINE = ("--resolution-level", "1", "--min-resolution", "100", "-o", "refined.ply")


class Killed(Densified):
    """The folder under water also holds the mesh scene_dense_mesh.ply."""

    @classmethod
    def make(cls, folder):
        super().make(folder)
        must("ReconstructMesh", "-i", "scene_dense.mvs", "-w", cls.at("water"), "-d", "4")

    def start(self, folder, program, *arguments):
        return subprocess.Popen([os.path.join(BIN, program), "-i", "scene_dense.mvs", "-w", folder,
                                 *arguments], stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)

    def finish(self, folder, program, *arguments):
        """Runs the program to its end. Returns its output and the seconds that it took."""
        begin = time.monotonic()
        said = self.succeeds(program, "-i", "scene_dense.mvs", "-w", folder, *arguments).stdout
        return said, time.monotonic() - begin

    def two_copies(self, *leave_out):
        folder, other = self.copy("water", *leave_out), self.path("other")
        shutil.rmtree(other, ignore_errors=True)
        shutil.copytree(folder, other)
        return folder, other

    def killed_at_moments(self, folder, seconds, *command):
        """Kills a run after parts of `seconds`, again and again in the same folder. Yields after each
        kill."""
        killed = 0
        for part in (0.15, 0.5, 0.8, 0.95):
            process = self.start(folder, *command)
            try:
                process.wait(timeout=part * seconds)
            except subprocess.TimeoutExpired:
                process.kill()
            # A run may be faster than the first one, and end before it is killed.
            self.assertIn(process.wait(), (0, -signal.SIGKILL))
            killed += process.returncode != 0
            yield
        self.assertGreater(killed, 0)

    def check(self, folder, other, *command):
        """Compares runs in `folder` that are killed with a run in `other` that is not."""
        before = files_below(other)
        _, seconds = self.finish(other, *command)
        expected = contents(other)
        outputs = files_below(other) - before
        self.assertGreater(len(outputs), 0)
        for _ in self.killed_at_moments(folder, seconds, *command):
            for name in outputs & files_below(folder):
                self.assertEqual(read(os.path.join(folder, name)), expected[name], name)
                os.remove(os.path.join(folder, name))
        for name in outputs:  # as a process leaves them that is killed while it writes
            stem, extension = os.path.splitext(name)
            write(os.path.join(folder, f"{stem}.{dead_process()}.tmp{extension}"), b"half")
        self.finish(folder, *command)
        self.assertEqual(contents(folder), expected)

    def test_reconstruct(self):
        self.check(*self.two_copies("_mesh.ply"), "ReconstructMesh")

    def test_texture(self):
        self.check(*self.two_copies(), "TextureMesh", "-m", "scene_dense_mesh.ply", "--export-type",
                   "ply,glb", "--max-texture-size", "256")

    def test_map(self):
        folder, other = self.two_copies()
        for name in ("dem", "ortho", "views", "sigma"):  # the blocks of a map, as a killed process leaves them
            dead = dead_process()
            write(os.path.join(folder, f"map.{name}.{dead}.tmp.blocks.{dead}.tmp.tif"), b"half")
        self.check(folder, other, "MapSurface", "-m", "scene_dense_mesh.ply", "-o", "map")

    def test_refine(self):
        self.check(*self.two_copies(), "RefineMesh", "-m", "scene_dense_mesh.ply", *REFINE)


if __name__ == "__main__":
    main()
