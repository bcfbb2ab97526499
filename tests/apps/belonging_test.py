# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes, clouds, scenes and photographs that do not belong together, and photographs that programs
must find. The meshes are the true surfaces of the simulations."""

import os
import shutil

from programs import main, must, png, read, run, write
from readers import Ply
from worlds import Simulated, binary_mesh, geo_offset

SIZE = ("--views", "5", "--width", "320", "--height", "240", "--samples", "1")
TINY = ("--views", "1", "--width", "16", "--height", "12")  # where only the mesh matters
OFFSET = (534000.0, 3378500.0, 0.0)
GREY = png([b"\x80" * 320] * 240)


def moved_mesh(data, change):
    """A mesh with its positions changed, without comments."""
    mesh = Ply(data)
    return binary_mesh(map(change, mesh.points), mesh.triangles)


class Belonging(Simulated):
    SCENE = ()

    @classmethod
    def make(cls, folder):
        cls.shared = folder
        cls.truth = cls.simulated("one", "closeup", "6", SIZE)
        cls.imported(cls.at("one", "scene.mvs"), "water")

    @classmethod
    def simulated(cls, name, preset, coarseness, size):
        """The folder of a simulated scene."""
        must("SimulateUnderwater", "--preset", preset, "--coarseness", coarseness, *size, "--medium", "water",
             "--truth", "0", "-o", cls.at(name))
        return cls.at(name)

    def setUp(self):
        super().setUp()
        self.one = self.path("one")
        shutil.copytree(self.truth, self.one)
        self.mesh = self.path("one", "mesh.ply")
        os.mkdir(self.path("empty"))

    def photograph(self, number):
        return self.path("one", "water", f"{number:04}.jpg")

    def of_scene(self, program, *arguments):
        return (program, "-w", self.one, "-i", "scene.mvs", *arguments)

    def warnings(self, *command, **options):
        """Without that about parts of the true surface that are far from what the photographs see."""
        said = self.succeeds(*command, **options).stdout
        return [line.split("warning: ")[1] for line in said.split("\n")
                if "warning: " in line and "faces are left out: no camera sees them" not in line]

    def with_mesh(self, mesh):
        """The programs that take a scene and its mesh."""
        cloud = os.path.join(self.one, "mesh.ply")
        return [self.of_scene("TextureMesh", "-m", mesh, "-o", "new.glb", "--export-type", "glb"),
                self.of_scene("MapSurface", "-m", mesh, "-o", "new"),
                self.of_scene("ViewScene", "-p", cloud, "-m", mesh, "--report", "page")]

    def refuse_mesh(self, expected, mesh):
        for command in (*self.with_mesh(mesh), self.of_scene("RefineMesh", "-m", mesh, "-o", "new.ply")):
            self.refuses(expected, *command)


class Shapes(Belonging):
    @classmethod
    def make(cls, folder):
        super().make(folder)
        cls.other = os.path.join(cls.simulated("other", "reef", "4", TINY), "mesh.ply")

    def test_the_mesh_of_the_scene_raises_no_alarm(self):
        for command in self.with_mesh(self.mesh):
            self.assertEqual(self.warnings(*command, "--max-threads", "1"), [], command)

    def test_the_mesh_of_another_survey_is_refused(self):
        # One program, because the check tries all units and axes. The test of millimetres runs all
        # programs.
        self.refuses("other/mesh.ply: does not belong to " + self.path("one", "scene.mvs"),
                     *self.of_scene("MapSurface", "-m", self.other, "-o", "new"))

    def test_the_cloud_of_another_survey_is_refused(self):
        # The limit of a cloud is the distance between its points, so the cloud is denser than the mesh.
        cloud = os.path.join(self.simulated("dense", "reef", "2", TINY), "mesh.ply")
        for command in (self.of_scene("ReconstructMesh", "-p", cloud, "-o", "new.ply"),
                        self.of_scene("ViewScene", "-p", cloud, "--report", "page")):
            self.refuses("dense/mesh.ply: does not belong to", *command)

    def test_a_survey_with_the_scene_of_another_one_is_not_compared(self):
        self.refuses("other/mesh.ply: does not belong to", "CompareSurveys", "-i", self.other, "--other",
                     self.other, "--scene", self.path("one", "scene.mvs"), "-o", self.path("new"))

    def test_a_given_mesh_is_checked_before_it_is_cleaned(self):
        clean = lambda mesh: self.of_scene("ReconstructMesh", "--mesh-file", mesh, "-o", "clean.ply")
        self.assertEqual(self.warnings(*clean(self.mesh)), [])
        self.refuses("other/mesh.ply: does not belong to", *clean(self.other))

    def test_millimetres_are_named(self):
        large = self.path("large.ply")
        write(large, moved_mesh(read(self.mesh), lambda x: [1000 * value for value in x]))
        self.refuse_mesh("the mesh is 1000 times too large: is it in millimetres?", large)
        warnings = self.warnings(*self.of_scene("TransformScene", "--mesh-file", large, "--transform-file",
                                                self.identity(), "-o", "moved.mvs"))
        self.assertIn("is 1000 times too large", warnings[0])

    def identity(self):
        write(self.path("identity.txt"), "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n")
        return self.path("identity.txt")


class Offsets(Belonging):
    def setUp(self):
        super().setUp()
        write(self.path("one", "scene.geo.json"), geo_offset(*OFFSET))

    def test_a_mesh_that_lost_its_offset_is_local(self):
        # The scene is local, and states its offset. The mesh is local, and states none.
        for command in self.with_mesh(self.mesh):
            said = self.succeeds(*command).stdout
            self.assertIn("mesh.ply: states no offset; its coordinates count from the scene's offset 534000 "
                          "3378500 0", said, command)

    def test_no_camera_sees_a_mesh_at_another_place(self):
        far = self.path("far.ply")
        write(far, moved_mesh(read(self.mesh), lambda x: (x[0] + 5000, x[1], x[2])))
        self.refuse_mesh("far.ply: no camera of", far)

    def test_local_coordinates_in_a_reference_system_are_noticed(self):
        map_of = lambda: self.warnings(*self.of_scene("MapSurface", "-m", self.mesh, "-o", "new", "--epsg",
                                                      "32631", "--up", "0,0,1"))
        self.assertEqual(map_of(), [])
        os.remove(self.path("one", "scene.geo.json"))
        self.assertIn("--epsg 32631: the coordinates of", map_of()[0])


class Photographs(Belonging):
    def test_exchanged_photographs_are_named(self):
        shutil.move(self.photograph(1), self.path("a.jpg"))
        shutil.move(self.photograph(4), self.photograph(1))
        shutil.move(self.path("a.jpg"), self.photograph(4))
        for command in self.with_mesh(self.mesh):
            warnings = self.warnings(*command)
            self.assertEqual(len(warnings), 2, (command, warnings))
            for warning, number in zip(warnings, (1, 4)):
                self.assertTrue(warning.startswith(self.photograph(number) + ": the photograph does not show"),
                                warning)

    def test_blank_photographs_are_named_and_refused_if_all_are(self):
        write(self.photograph(2), GREY)
        self.assertIn(self.photograph(2) + ": the photograph is blank", self.warnings(*self.with_mesh(self.mesh)[0])[0])
        for number in range(5):
            write(self.photograph(number), GREY)
        for command in self.with_mesh(self.mesh):
            said = run(*command)
            self.assertEqual(said.returncode, 1, (command, said.stderr))
            self.assertIn("scene.mvs: 5 of 5 photographs are blank", said.stderr)

    def test_small_photographs_are_noticed_and_tiny_ones_refused(self):
        write(self.photograph(2), png([bytes(range(160))] * 120))
        warnings = self.warnings(*self.of_scene("DensifyPointCloud", "-o", "new.mvs"))
        self.assertTrue(any("0002.jpg: is 160x120, but its camera is 320x240: 1 of 5 photographs are smaller" in warning
                            for warning in warnings), warnings)
        write(self.photograph(2), png([b"\x80"]))
        for command in (*self.with_mesh(self.mesh), self.of_scene("DensifyPointCloud", "-o", "new2.mvs")):
            self.refuses("0002.jpg: is 1x1, too small for its camera, which is 320x240", *command)

    def test_ignored_ports_are_noticed(self):
        warnings = self.warnings(*self.of_scene("TextureMesh", "-m", self.mesh, "-o", "new.glb",
                                                "--camera-model", "pinhole"))
        self.assertIn("scene.housing.json: the ports of 5 images are ignored", warnings[0])


class Folders(Belonging):
    def test_photographs_are_found_above_the_scene(self):
        os.mkdir(self.path("one", "run"))
        for name in ("scene.mvs", "scene.housing.json", "scene.lenses.json"):
            shutil.copy(self.path("one", name), self.path("one", "run", name))
        scene = self.path("one", "run", "scene.mvs")
        for command in (("TextureMesh", "-i", scene, "-m", self.mesh, "-o", self.path("new.glb")),
                        ("MapSurface", "-i", scene, "-m", self.mesh, "-o", self.path("new")),
                        ("ViewScene", "-i", scene, "-p", self.mesh, "--report", self.path("page")),
                        ("DensifyPointCloud", "-i", scene, "-o", self.path("new.mvs")),
                        ("TransformScene", "-i", scene, "--max-resolution", "100", "-o", self.path("small.mvs"))):
            said = self.succeeds(*command, cwd=self.path("empty")).stdout
            self.assertIn(f"scene.mvs: the paths of its images start at {self.one}", said, command)


if __name__ == "__main__":
    main()
