# SPDX-License-Identifier: GPL-3.0-or-later
"""Programs with little memory, pipes for files and long fields, and what killed programs leave behind."""

import os
import re
import struct
import subprocess

import tiny_scene
from programs import BIN, ProgramTest, contents, dead_process, files_below, main, new_folder, read, run, write
from tiny_scene import TinyScene
from worlds import Wall


class Pipes(TinyScene):
    def test_a_pipe_in_the_place_of_a_file_is_refused(self):
        """To open a pipe would wait for a writer, that is, for ever."""
        self.succeeds(*self.densify())
        for name in ("scene.mvs", "DensifyPointCloud.cfg", "depth0001.dmap"):
            path = self.path("work", name)
            if os.path.exists(path):
                os.remove(path)
            os.mkfifo(path)
            result = run(*self.densify("-c", "DensifyPointCloud.cfg") if name.endswith("cfg") else
                         self.densify(), timeout=60)
            if name.endswith("dmap"):
                self.assertIn(result.returncode, (0, 1))  # the map may be computed again
            else:
                self.assertEqual(result.returncode, 1, name)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
                self.assertIn(name, result.stderr)
            if os.path.exists(path):
                os.remove(path)
            write(self.scene, tiny_scene.mvs(self.images))


class LongFields(TinyScene):
    def test_errors_are_short_lines(self):
        """Every kind of file, with fields that are long or hold control characters."""
        sparse = self.path("colmap", "sparse")
        for field in ("x" * 5000, "x " * 2500, "\x01\x1b[2J" * 900, "\u20ac" * 3000):
            cases = [(self.path("a.ply"), f"ply\nformat {field} 1.0\nend_header\n",
                      ("EvaluateReconstruction", "-i", self.path("a.ply"), "-m", self.path("a.ply"))),
                     (os.path.join(sparse, "cameras.txt"), f"1 {field} 96 72 90 90 48 36\n",
                      ("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("a.mvs"))),
                     (self.path("a.json"), '{"version": 1, "ports": {}, "default": "%s"}'
                      % field.replace("\x01\x1b", "\\u0001\\u001b"),
                      self.densify("--refractive", "--housing", self.path("a.json"))),
                     (self.scene, tiny_scene.mvs([field] * 3), self.densify()),
                     (self.path("DensifyPointCloud.cfg"), f"{field} = 1\n", self.densify(
                         "-c", self.path("DensifyPointCloud.cfg")))]
            for path, data, command in cases:
                before = read(path) if os.path.exists(path) else None
                write(path, data)
                said = self.refuses("", *command).stderr
                self.assertLess(len(said.encode()), 540, said)
                self.assertFalse(re.search("[\\x00-\\x09\\x0b-\\x1f]", said), repr(said))
                if before is None:
                    os.remove(path)
                else:
                    write(path, before)


class LittleMemory(Wall):
    def test_is_one_line(self):
        """From too little memory for loading the libraries up to enough memory."""
        few, many = (*range(50, 112, 2), *range(120, 430, 60), 430), (*range(240, 330, 6), 3000)
        for steps, reason, *command in (
                (few, "out of memory|thread|pthread", *self.densify("-v", "0")),
                (few, "out of memory|thread|pthread", "InterfaceCOLMAP", "-i", self.path("colmap"), "-o",
                 self.path("a.mvs"), "-v", "0"),
                # Pictures need the image codecs, which are loaded late.
                (range(100, 440, 20), "imgcodecs.* cannot be loaded: |out of memory|thread", *self.densify("-v", "3")),
                (many, "^((?!TIFF|GDAL|VSI|CPL|Embree|bad_alloc).)*$", *self.command("MapSurface", "--max-threads",
                                                                                      1))):
            ends = []
            for megabytes in steps:
                ended = run(*command, address_space=megabytes * 1000000, timeout=60)
                said = f"{command[0]} with {megabytes} MB: {ended.returncode} {ended.stderr!r}"
                self.assertIn(ended.returncode, (0, 1, 127), said)  # 127: the loader failed
                ends.append(ended.returncode)
                if ended.returncode == 1:
                    # GDAL loads GnuTLS, which prints this line of its own before the program begins.
                    own = re.sub("^Error in GnuTLS initialization: .*\n", "", ended.stderr)
                    self.assertEqual(own.count("\n"), 1, said)
                    self.assertRegex(own, reason, said)
            self.assertIn(1, ends, command)
            self.assertEqual(ends[-1], 0, command)


class ManyObservations(ProgramTest):
    """A scene whose points take more memory than its pixels. Most points lie behind the cameras,
    where they take the same memory and less time."""

    @classmethod
    def setUpClass(cls):
        cls.work = new_folder(cls.addClassCleanup)
        image = os.path.join(cls.work, "a.png")
        write(image, tiny_scene.picture((0, 0, 0)))
        centres = [(0.01 * i, 0, 0) for i in range(40)]
        views = struct.pack("<Q", 20) + b"".join(struct.pack("<If", i, 0) for i in range(40))
        points = b"".join(struct.pack("<3f", 0.2 + 0.0001 * (i % 1000), 0.0001 * (i % 997),
                                      1 if i % 40 == 0 else -1)
                          + struct.pack("<Q", 20) + views[8 + 8 * (i % 20):8 + 8 * (i % 20 + 20)]
                          for i in range(120000))
        empty = tiny_scene.mvs([image] * 40, centres=centres, points=[])
        at = len(empty) - (8 + 40 + 16 * 8 + 9 * 8 + 6 * 8)  # offset of the number of points
        write(os.path.join(cls.work, "scene.mvs"),
              empty[:at] + struct.pack("<Q", 120000) + points + empty[at + 8:])

    def run_with(self, megabytes, *arguments):
        """The exit code, standard error and peak memory [MB] of a run."""
        with open(self.path("said"), "w+") as said:
            process = subprocess.Popen(
                [os.path.join(BIN, "DensifyPointCloud"), "-i", os.path.join(self.work, "scene.mvs"),
                 "-w", self.work, "--resolution-level", "2", "--iters", "1", "--geometric-iters",
                 "0", "-v", "0", "--max-memory", str(megabytes), *arguments],
                stdout=subprocess.DEVNULL, stderr=said)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            return process.returncode, said.read(), usage.ru_maxrss * 1024 / 1e6

    def is_refused(self, megabytes, *arguments):
        """Checks that the run ends before it takes memory. Returns what it says."""
        code, said, peak = self.run_with(megabytes, *arguments)
        self.assertEqual(code, 1, said)
        self.assertLess(peak, min(120, megabytes))
        return said

    def test_is_planned_before_it_is_taken(self):
        said = self.is_refused(150)
        self.assertIn("--max-memory 150: 150 MB are too little, this scene needs at least", said)
        needed = int(re.search(r"needs at least (\d+)", said)[1])
        code, said, peak = self.run_with(needed - 5)
        self.assertEqual(code, 1, said)
        self.assertLess(peak, needed - 5)
        code, said, peak = self.run_with(needed)
        self.assertEqual(code, 0, said)
        self.assertLess(peak, needed)
        self.assertGreater(peak, 0.6 * needed)

    def test_a_cloud_in_place_of_the_points_is_in_the_plan(self):
        count = 3000000
        header = ("ply\nformat binary_little_endian 1.0\n"
                  f"element vertex {count}\nproperty float x\nproperty float y\nproperty float z\n"
                  "property list uchar uint view_indices\nend_header\n")
        # Written in parts, because a child's peak memory includes its parent's memory at the fork.
        with open(self.path("cloud.ply"), "wb") as file:
            file.write(header.encode())
            for _ in range(count // 10000):
                file.write(struct.pack("<3fB2I", 0.2, 0.1, 1, 2, 0, 1) * 10000)
        self.assertIn("--max-memory 350: 350 MB are too little, this scene needs at least",
                      self.is_refused(350, "-p", self.path("cloud.ply")))
        self.is_refused(350, "-p", self.path("cloud.ply"), "--estimate-scale", "1", "-o", self.path("sizes.mvs"))


class Leftovers(TinyScene):
    def test_go_at_the_next_start(self):
        dead = dead_process()
        for place in ("work/scene_dense.{}.tmp.ply", "work/scene_dense.{}.tmp.mvs",
                      "work/depth0001.{}.tmp.dmap", "work/depth0001.dmap.{}.tmp.json",
                      "work/depth0001.{0}.tmp.{0}.tmp.dmap"):
            write(self.path(place.format(dead)), "half")
        kept = (f"work/other.{dead}.tmp.ply", f"work/scene_dense.{os.getpid()}.tmp.ply")
        for place in kept:
            write(self.path(place), "half")
        self.succeeds(*self.densify())
        left = {name for name in files_below(self.folder) if ".tmp" in name}
        self.assertEqual(left, set(kept))

    def test_of_an_export_that_was_taking_its_place(self):
        """Killed after it removed files of the earlier export, before it moved all of its own."""
        export = ("InterfaceCOLMAP", "-i", self.scene, "-o", self.path("out"))
        sparse = self.path("out", "sparse")
        self.succeeds(*export)
        whole = contents(sparse)
        for moved in range(len(whole)):
            staging = os.path.join(sparse, f"staging.{dead_process()}.tmp")
            os.mkdir(staging)
            for name in sorted(whole)[moved:]:
                os.rename(os.path.join(sparse, name), os.path.join(staging, name))
            write(os.path.join(sparse, "points3D.txt"), whole["points3D.txt"])
            self.succeeds(*export)
            self.assertEqual(contents(sparse), whole)

    def test_of_other_programs(self):
        dead = dead_process()
        sparse = self.path("colmap", "sparse")
        align = ("AlignModel", "-i", sparse, "--reference", sparse, "-o", self.path("b"))
        for command, place in (
                (("InterfaceCOLMAP", "-i", self.path("colmap"), "-o", self.path("a.mvs")), "a.{}.tmp.mvs"),
                (align, "b.{}.tmp/cameras.txt"), (align, "b/staging.{}.tmp/cameras.txt")):
            write(self.path(place.format(dead)), "half")
            self.succeeds(*command)
            self.assertEqual([name for name in files_below(self.folder) if ".tmp" in name], [])


if __name__ == "__main__":
    main()
