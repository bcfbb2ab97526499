# SPDX-License-Identifier: GPL-3.0-or-later
"""Properties that all programs have: --help, one line for wrong options, no folder of a refused run, the same
bytes for any number of threads and without standard streams, and one run for each output."""

import fcntl
import json
import math
import os
import shutil

from programs import BIN, contents, files_below, main, png, read, run, without_streams, write
from tiny_scene import CENTRES, DENSIFY, HEIGHT, WIDTH, picture
from worlds import Wall, cloud, matrix_text, ply, wall

# The wall is small and simple.
MORE = {"RefineMesh": ("--max-face-area", "0"), "ReconstructMesh": ("--remove-spurious", "0")}


class Programs(Wall):
    """The scene work/scene.mvs with a cloud beside it, and the mesh work/mesh.ply."""
    MESH = "mesh.ply"

    def setUp(self):
        super().setUp()
        self.cloud = self.path("work", "scene.ply")
        write(self.cloud, cloud([((0.01 * i, 0.02 * i, 1), [0, 1]) for i in range(9)]))
        write(self.path("work", "t.txt"), matrix_text())
        write(self.path("work", "map.geojson"), json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [
                [[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, -0.1]]]}}]}))
        write(self.path("work", "drawn.json"), json.dumps({
            "images": [{"id": 1, "file_name": "0001.png", "width": WIDTH, "height": HEIGHT}],
            "categories": [{"id": 1, "name": "coral"}], "annotations": [
                {"id": 1, "image_id": 1, "category_id": 1, "segmentation": [[20, 20, 60, 20, 60, 50]]}]}))

    def program(self, program, *arguments, mesh="mesh.ply"):
        return (program, "-i", "scene.mvs", "-w", self.work, *(("--mesh-file", mesh) if mesh else ()),
                *MORE.get(program, ()), *arguments)

    def commands(self):
        """A command of each program, with its outputs named `out`."""
        model = ("-i", self.path("colmap", "sparse"))
        here = ("-w", self.work)
        compare = ("CompareSurveys", "-i", "mesh.ply", "--other", "mesh.ply", *here, "-o", "out")
        return [("InterfaceCOLMAP", "-i", self.path("colmap"), *here, "-o", "out"),
                ("InterfaceCOLMAP", "-i", "scene.mvs", *here, "-o", "out"),
                ("AlignModel", *model, "--reference", *model[1:], "-o", self.path("work", "out")),
                (*DENSIFY[:1], *DENSIFY[3:], "-i", "scene.mvs", *here, "-o", "out"),
                self.program("ReconstructMesh", "-o", "out"),
                self.program("RefineMesh", "-o", "out"),
                self.program("TextureMesh", "-o", "out", "--export-type", "ply,glb"),
                self.program("TextureMesh", "-o", "out", "--tiles", "3"),
                self.program("MapSurface", "-o", "out", "--gsd", "0.02", "--hillshade", "--contours", "0.1",
                             "--preset", "archive", "--widths", "10"),
                (*compare, "--gsd", "0.02"),
                self.program("ProjectLabels", "--from-map", "map.geojson", "-o", "out"),
                self.program("ProjectLabels", "--from-photographs", "drawn.json", "-o", "out"),
                self.program("TransformScene", "-t", "t.txt", "-o", "out"),
                self.program("ViewScene", "--report", "out"),
                ("EvaluateReconstruction", "-i", self.mesh, "-m", self.mesh, "--samples", "100", "--json",
                 self.path("work", "out.json"))]


class Results(Programs):
    """What a program writes into the folder of the scene."""

    def taken_away(self, before):
        """The contents of the files that are not in `before`, which are removed."""
        found = {name: data for name, data in contents(self.work).items() if name not in before}
        for name in found:
            os.remove(self.path("work", name))
        shutil.rmtree(self.path("work", "out"), ignore_errors=True)
        return found

    def run_without(self, closed, *command):
        """Runs a program without these standard streams. Returns its exit code and its files."""
        before = files_below(self.work)
        ended = without_streams(closed, os.path.join(BIN, command[0]), *command[1:])
        return ended.returncode, self.taken_away(before)


class SameBytes(Results):
    def test_for_any_number_of_threads_and_without_streams(self):
        for command in self.commands():
            with self.subTest(command=command):
                expected = self.run_without((), *command, "--max-threads", 2)
                self.assertEqual(expected[0], 0)
                self.assertTrue(expected[1])
                for closed, threads in (((1,), 1), ((0, 1, 2), 2)):
                    self.assertEqual(self.run_without(closed, *command, "--max-threads", threads), expected)
                self.assertEqual(self.run_without((0, 1, 2), *command, "--no-such-option", 1), (1, {}))


class FullDisk(Results):
    def test_old_files_stay_and_new_ones_are_complete_or_absent(self):
        for command in self.commands():
            with self.subTest(command=command):
                before = files_below(self.work)
                made, _ = self.new_files(self.work, *command)
                said = self.refuses_and_keeps("annot be written", *command,
                                              file_size_limit=min(map(len, made.values())) - 1).stderr
                self.assertEqual(".tmp" in said, command[0] == "RefineMesh", said)  # its state is named twice
                self.taken_away(before)
                ended = run(*command, file_size_limit=max(map(len, made.values())) - 1)
                self.assertEqual((ended.returncode, ended.stderr.count("\n")), (1, 1), ended.stderr)
                self.assertIn("annot be written", ended.stderr)
                for name, data in self.taken_away(before).items():
                    self.assertEqual(data, made[name], name)


class CommandLine(Programs):
    def test_help_and_wrong_options(self):
        for program, command in {command[0]: command for command in self.commands()}.items():
            with self.subTest(program=program):
                self.assertEqual(run(program).returncode, 1)
                self.assertEqual(run(program, "--help").returncode, 0)
                self.refuses_and_keeps("'--no-such-option'", *command, "--no-such-option", "1")

    def test_a_refused_command_leaves_no_folder(self):
        new = self.path("new", "deep", "out")
        write(self.path("a_file"), "")
        for command in self.commands():
            with self.subTest(command=command):
                self.refuses_and_keeps("missing.mvs", *self.changed(command, {"-i": self.path("missing.mvs"), "-o": new,
                                                                              "--report": new}))
                self.assertFalse(os.path.exists(self.path("new")))
                for folder in ("/proc", self.path("a_file")):
                    self.refuses_and_keeps(folder, *self.changed(command, dict.fromkeys(
                        ("-o", "--report", "--json"), os.path.join(folder, "out"))))

    def changed(self, command, values):
        """The command with these values of options."""
        return [command[0], *(values.get(before, word) for before, word in zip(command, command[1:]))]


class WrongClouds(Programs):
    def test_damaged_clouds_are_named(self):
        whole = read(self.cloud)
        for content in (b"", b"ply\n", whole[:len(whole) // 2], whole[:-1]):
            write(self.cloud, content)
            for tiles in ((), ("--tiles", 2)):
                command = self.program("ReconstructMesh", "-o", "out", *tiles, mesh=None)
                with self.subTest(size=len(content), tiles=tiles):
                    self.refuses_and_keeps("scene.ply", *command)


class WrongMeshes(Programs):
    """Programs that take a mesh name the file and its fault."""
    PROGRAMS = ("TextureMesh", "MapSurface", "RefineMesh", "CompareSurveys")

    def setUp(self):
        super().setUp()
        self.good = read(self.mesh)
        write(self.path("work", "right.ply"), self.good)

    def refused(self, expected, content, programs=PROGRAMS):
        write(self.mesh, content)
        for program in programs:
            command = (program, "-i", "right.ply", "--other", "mesh.ply", "-w", self.work) \
                if program == "CompareSurveys" else self.program(program)
            with self.subTest(expected=expected, program=program):
                self.refuses_and_keeps("mesh.ply" + expected, *command)

    def test_files_that_are_no_meshes(self):
        sizes = (0, 3, 100, len(self.good) // 2, len(self.good) - 20)
        for content in (*(self.good[:size] for size in sizes), os.urandom(1000)):
            self.refused("", content)

    def test_files_that_are_missing(self):
        os.rename(self.mesh, self.path("work", "other.ply"))
        for program in self.PROGRAMS[:3]:
            self.refuses_and_keeps("mesh.ply", *self.program(program))

    def test_faces_and_coordinates(self):
        vertices, faces = wall(cells=2)
        for expected, *mesh in (
                (": the mesh has no faces", vertices, []),
                (": a face refers to vertex 9, but there are 9", vertices, [*faces, (0, 1, 9)]),
                ("", [*vertices[:-1], (0, math.nan, 1)], faces)):
            self.refused(expected, ply(*mesh))
        self.refused(": vertex 8 has a coordinate larger than 1e+18", ply([*vertices[:-1], (0, 1e20, 1)], faces),
                     self.PROGRAMS[:1])
        self.refused(": does not belong to", ply(*wall(z=-1)), self.PROGRAMS[:3])


class WrongPhotographs(Programs):
    def test_each_program_names_the_file(self):
        image = self.images[1]
        whole = read(image)
        for content, expected in ((picture(CENTRES[1], 50, 72), "is 50x72, but its camera is 96x72"),
                                  (whole[:len(whole) // 2], ""), (b"", ""), (None, "")):
            os.remove(image) if content is None else write(image, content)
            for program in ("DensifyPointCloud", "RefineMesh", "TextureMesh", "MapSurface", "ViewScene"):
                command = self.densify() if program == "DensifyPointCloud" else self.program(program)
                if program == "ViewScene":
                    command += ("--report", "page")
                with self.subTest(program=program, expected=expected):
                    self.assertIn(expected, self.refuses_and_keeps("0001.png", *command).stderr)


class Rivals(Programs):
    """A second run on the output of a running one is told who writes it."""

    def held(self, name, how):
        lock = open(self.path("work", name + ".lock"), "w")
        self.addCleanup(lock.close)
        fcntl.flock(lock, how)
        lock.write(f"{os.getpid()} {os.uname().nodename} 2026-11-27 22:30:00\n")
        lock.flush()
        return lock

    def test_a_second_run_is_refused(self):
        who = (f"another run writes it: process {os.getpid()} on {os.uname().nodename}, since "
               "2026-11-27 22:30:00")
        masks = ("InterfaceCOLMAP", "-i", self.path("colmap", "images"), "-w", self.work,
                 "--mask-path", self.path("mask.png"), "-o", "masks/")
        write(self.path("mask.png"), png([bytes(96)] * 72))
        for output, command in (
                ("scene_texture.mvs", self.program("TextureMesh")), ("scene_refine.ply", self.program("RefineMesh")),
                ("scene_mesh.ply", self.program("ReconstructMesh")),
                ("map.dem.tif", self.program("MapSurface", "-o", "map", "--gsd", "0.02")),
                ("surveys.change.difference.tif",
                 ("CompareSurveys", "-i", "mesh.ply", "--other", "mesh.ply", "-w", self.work, "-o", "surveys")),
                ("page", self.program("ViewScene", "--report", "page/")),
                ("moved.mvs", self.program("TransformScene", "-t", "t.txt", "-o", "moved")),
                ("some.mvs", self.program("TransformScene", "--sample-mesh", "-5", "-o", "some")),
                ("cloud.las", ("TransformScene", "-i", "scene.ply", "-w", self.work, "-o", "cloud.las")),
                ("made.mvs", ("InterfaceCOLMAP", "-i", self.path("colmap"), "-w", self.work, "-o", "made")),
                ("sparse", ("InterfaceCOLMAP", "-i", "scene.mvs", "-w", self.work)), ("masks", masks)):
            lock = self.held(output, fcntl.LOCK_EX)
            self.refuses_and_keeps(f"{output}: {who}", *command)
            lock.close()
            self.succeeds(*command)  # the file alone is no lock
            self.assertNotIn(output + ".lock", files_below(self.work))
        lock = self.held("scene_dense.mvs", fcntl.LOCK_EX)
        self.refuses_and_keeps(who, *self.densify())
        lock.close()
        lock = self.held("depth_maps", fcntl.LOCK_EX)
        self.refuses_and_keeps(who, *self.densify("-o", "other"))

    def test_runs_for_parts_are_no_rivals(self):
        locks = [self.held(name, fcntl.LOCK_SH) for name in ("scene_dense.mvs", "depth_maps")]
        for part in ("1/2", "2/2"):
            self.succeeds(*self.densify("--until", "maps", "--part", part))
        self.refuses_and_keeps("another run writes it", *self.densify())
        locks[0].close()
        self.succeeds(*self.densify())  # all maps exist: they are only read
        self.assertIn("depth_maps.lock", files_below(self.work))


if __name__ == "__main__":
    main()
