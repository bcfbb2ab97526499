# SPDX-License-Identifier: GPL-3.0-or-later
"""TransformScene moves scenes, clouds and meshes so that every view sees the same picture."""

import json
import os
import re

import tiny_scene
from programs import files_below, main, read, write
from readers import Mvs, Ply, png_size
from worlds import SHIFT, TURN, Wall, flat, housing, matrix_text, moved, ply, times

UTM = (512345.25, 5412345.5, 105.75)
CUBE = [(x, y, z) for z in (0.0, 1.0) for y in (0.0, 1.0) for x in (0.0, 1.0)]
CUBE_FACES = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2),
              (2, 4, 6), (1, 3, 5), (3, 7, 5)]


def inverse_text(scale=1, shift=SHIFT):
    back = tuple(zip(*TURN))
    return matrix_text(1 / scale, tuple(-a / scale for a in times(back, shift)), back)


class Transform(Wall):
    MESH = "mesh.ply"

    def setUp(self):
        super().setUp()
        self.cloud = self.path("work", "cloud.ply")
        points = [x for x, _ in tiny_scene.sparse_points()]
        write(self.cloud, ply([(*x, 0.0, 0.0, -1.0) for x in points],
                              more="".join(f"property float n{axis}\n" for axis in "xyz")))
        self.put(points, [(0, 1, 2), (2, 1, 3)])
        self.by("t.txt", matrix_text(2.5))

    def by(self, name, matrix):
        write(self.path(name), matrix)

    def transform(self, *arguments, scene="scene.mvs", output="moved.mvs"):
        return self.succeeds("TransformScene", "-i", scene, "-w", self.work, "-o", output, *arguments)

    def refused(self, expected, *arguments):
        self.refuses_and_keeps(expected, *self.command("TransformScene", "-o", "moved.mvs", *arguments))

    def port(self, port):
        write(self.path("work", "scene.housing.json"), housing(port))


class Moves(Transform):
    def scenes(self, *names):
        return [Mvs(self.at(name)) for name in names]

    def same_pictures(self, before, after, old, new, within):
        """Each image shows the points `new` of the moved scene where it showed `old`."""
        for a, b in zip(old, new, strict=True):
            for image in range(3):
                self.near(after.project(image, b)[:2], before.project(image, a)[:2], within)

    def same_poses(self, before, again, within):
        for old, back in zip(before.cameras, again.cameras):
            self.near(back[2] + back[3], old[2] + old[3], within)

    def test_there_and_back(self):
        self.by("back.txt", inverse_text(2.5))
        self.transform("-t", self.path("t.txt"), "-p", "cloud.ply", "-m", "mesh.ply")
        self.transform("-t", self.path("back.txt"), "-p", "moved.ply", "-m", "moved_mesh.ply", scene="moved.mvs",
                       output="again.mvs")
        before, after, again = self.scenes("scene.mvs", "moved.mvs", "again.mvs")
        for old, new in zip(before.cameras, after.cameras):
            self.near(new[3], moved(old[3], 2.5), 1e-9)
        self.same_poses(before, again, 1e-9)
        self.assertEqual(again.names, before.names)
        for name, there in (("cloud.ply", "moved.ply"), ("mesh.ply", "moved_mesh.ply")):
            old, new, back = (Ply(self.at(file)) for file in (name, there, there.replace("moved", "again")))
            self.same_pictures(before, after, old.points, new.points, 1e-4)
            for a, c in zip(old.vertices, back.vertices, strict=True):
                self.near([c[key][0] for key in a], [a[key][0] for key in a], 1e-6)  # float32 of a few metres
        normals = [[[v[axis][0] for axis in ("nx", "ny", "nz")] for v in Ply(self.at(name)).vertices]
                   for name in ("cloud.ply", "moved.ply")]
        for a, b in zip(*normals, strict=True):
            self.near(b, times(TURN, a), 1e-6)
        self.same_pictures(before, after, *([x for x, _ in scene.points] for scene in (before, after)), 1e-4)

    def test_far_away_and_back(self):
        """Poses in UTM are double; floats are near the origin, and the offset is in files."""
        self.by("t.txt", matrix_text(1, UTM))
        self.by("back.txt", inverse_text(1, UTM))
        said = self.transform("-t", self.path("t.txt"), "-p", "cloud.ply", "-m", "mesh.ply",
                              "--transform-out", self.path("out.txt"))
        self.assertNotIn("far from the origin", said.stdout + said.stderr)
        offset = json.loads(self.at("moved.geo.json"))["geo_offset"]
        self.near(offset, UTM, 20)
        before, after = self.scenes("scene.mvs", "moved.mvs")
        for old, new in zip(before.cameras, after.cameras):
            expected = [a + (b - c) for a, b, c in zip(times(TURN, old[3]), UTM, offset)]
            self.near(new[3], expected, 5e-9)  # a double of 5e6 has steps of 1e-9
        for name, there in (("cloud.ply", "moved.ply"), ("mesh.ply", "moved_mesh.ply")):
            new = Ply(self.at(there))
            self.assertEqual(list(new.offset), offset)
            self.same_pictures(before, after, Ply(self.at(name)).points, new.points, 1e-3)
        numbers = [float(word) for word in read(self.path("out.txt")).split()]
        self.near(numbers, [float(w) for w in matrix_text(1, UTM).split()] + [0, 0, 0, 1], 5e-9)
        self.transform("-t", self.path("back.txt"), "-p", "moved.ply", scene="moved.mvs", output="again.mvs")
        self.assertFalse(os.path.exists(self.path("work", "again.geo.json")))
        self.same_poses(before, *self.scenes("again.mvs"), 5e-9)
        cloud, back = (Ply(self.at(name)) for name in ("cloud.ply", "again.ply"))
        self.assertIsNone(back.offset)
        for a, b in zip(cloud.vertices, back.vertices, strict=True):
            self.near([b[key][0] for key in a], [a[key][0] for key in a], 1e-5)

    def test_everything_else_in_a_ply_stays(self):
        self.put([(*x, 200, i / 8) for i, x in enumerate(CUBE)], CUBE_FACES, kind="double",
                 more="property uchar red\nproperty float quality\n",
                 face_more="property list uchar double texcoord\nproperty int texnumber\n",
                 face_values=(6, .1, .2, .3, .4, .5, .6, 7), comments="comment TextureFile a.png\n")
        self.transform("-t", self.path("t.txt"), "-m", "mesh.ply")
        self.assertIn(b"comment TextureFile a.png\n", self.at("moved_mesh.ply"))
        found = Ply(self.at("moved_mesh.ply"))
        for i, (point, vertex, x) in enumerate(zip(found.points, found.vertices, CUBE, strict=True)):
            self.near(point, moved(x, 2.5), 1e-12)
            self.assertEqual((vertex["red"], vertex["quality"]), ((200,), (i / 8,)))
        self.assertEqual(found.triangles, CUBE_FACES)
        for face in found.faces:
            self.assertEqual((face["texcoord"], face["texnumber"]), ((.1, .2, .3, .4, .5, .6), (7,)))

    def test_shrunk_images(self):
        said = self.transform("--max-resolution", 48).stdout
        self.assertIn("3 of 3 images were shrunk", said)
        before, after = self.scenes("scene.mvs", "moved.mvs")
        for (_, k, *pose), (size, small, *same), name in zip(before.cameras, after.cameras, after.names):
            self.assertEqual(size, (48, 36))
            self.assertEqual(pose, same)
            for i in (0, 4):
                self.assertAlmostEqual(small[i], k[i] / 2, 9)
            for i in (2, 5):
                self.assertAlmostEqual(small[i] + 0.5, (k[i] + 0.5) / 2, 9)
            self.assertIn("images48", name)
            self.assertEqual(png_size(self.at(name)), (48, 36))
        self.succeeds("DensifyPointCloud", "-i", "moved.mvs", "-w", self.work, "--resolution-level", 0,
                      "--min-resolution", 16)


class Aligned(Transform):
    def check(self, centres, within=1e-6):
        for pose, centre in zip(Mvs(self.at("moved.mvs")).cameras, centres):
            self.near(pose[3], centre, within)

    def aligned(self, lines, *arguments):
        """The output of an alignment to a file of positions."""
        write(self.path("known.csv"), "\n".join(lines) + "\n")
        said = self.transform("--positions", self.path("known.csv"), *arguments)
        return said.stdout + said.stderr

    def not_aligned(self, expected, lines, *arguments):
        write(self.path("known.csv"), "\n".join(lines) + "\n")
        self.refused(expected, "--positions", self.path("known.csv"), *arguments)

    def positions(self, *how):
        """Lines of the positions of the cameras, moved."""
        return [" ".join([name, *map(repr, moved(centre, *how))])
                for name, centre in zip(tiny_scene.names(), tiny_scene.CENTRES)]


class Alignment(Aligned):
    NAMES = [os.path.join("other", name) for name in tiny_scene.names()]

    def write_reference(self, names, order=(0, 1, 2)):
        """A scene of some of the moved cameras, in this order. Returns their centres and their rotation."""
        centres = [moved(c, 2.5) for c in tiny_scene.CENTRES]
        rotation = [x for column in zip(*TURN) for x in column]  # the pose of an unturned camera
        write(self.path("work", "reference.mvs"), tiny_scene.mvs(
            [self.path(names[i]) for i in order], centres=[centres[i] for i in order], rotation=rotation,
            points=[(moved(x, 2.5), list(range(len(order)))) for x, _ in tiny_scene.sparse_points()]))
        return centres, rotation

    def test_to_a_scene_by_name_in_any_order(self):
        for order in ((0, 1, 2), (2, 0, 1)):
            centres, rotation = self.write_reference(self.NAMES, order)
            said = self.transform("-a", "reference.mvs").stdout
            self.assertIn("Aligned by 3 images with the same names: scale 2.5", said)
            self.check(centres)
            for pose in Mvs(self.at("moved.mvs")).cameras:
                self.near(pose[2], rotation, 1e-9)

    def test_to_a_scene_by_order(self):
        centres, _ = self.write_reference(["x.png", "y.png", "z.png"])
        said = self.transform("-a", "reference.mvs").stdout
        self.assertIn("3 images in their order, because names do not match", said)
        self.check(centres)
        self.write_reference(["x.png", "y.png"], order=(0, 1))
        self.refused("reference.mvs: 0 of its images have the name of an image of the scene, and "
                     "it has 2 images, not 3", "-a", "reference.mvs")

    def test_to_positions(self):
        lines = self.positions(2.5, UTM)
        said = self.aligned(["# name x y z", *lines, "absent.jpg 1 2 3"])
        self.assertIn("known.csv:5: the scene has no image 'absent.jpg'", said)
        offset = json.loads(self.at("moved.geo.json"))["geo_offset"]
        self.check([[a - b for a, b in zip(moved(c, 2.5, UTM), offset)] for c in tiny_scene.CENTRES])
        self.not_aligned("known.csv:4: 0000.png occurs twice", [*lines, lines[0]])
        self.not_aligned("known.csv: 2 common positions are too few", lines[:2])


CENTRES = [(0, 0, 0), (1, 0, 0.1), (2, 0.1, -0.1), (0, 1, 0.2), (1, 1.1, 0), (2, 1, 0.3), (0.1, 2, 0),
           (1, 2, -0.2)]


class Positions(Aligned):
    """Files of positions of eight photographs, as users and other programs write them."""

    def setUp(self):
        super().setUp()
        self.names = [f"dive1/IMG_{i}.JPG" for i in range(8)]
        # The cameras look along the axis z, which is downwards in the positions.
        self.cameras(CENTRES)
        self.known = [(x, -y, -z) for x, y, z in CENTRES]

    def cameras(self, centres):
        write(self.scene, tiny_scene.mvs([self.path(name) for name in self.names], centres=centres))

    def lines(self, known, form="{} {} {} {}"):
        return [form.format(name, *place) for name, place in zip(self.names, known)]

    def test_degrees(self):
        said = self.aligned(["label,longitude,latitude,altitude"] + [
            f"{name},{16.5 + x / 65200!r},{54.25 + y / 111300!r},{z}"
            for name, (x, y, z) in zip(self.names, self.known)], "--rigid")
        self.assertIn("WGS 84 / UTM zone 33N (EPSG:32633)", said)
        offset = json.loads(self.at("moved.geo.json"))["geo_offset"]
        # 597730.71, 6012375.70 is the first position by PROJ; the last digits are the convergence.
        moved_to = Mvs(self.at("moved.mvs")).camera(0)[3]
        self.near([a + b for a, b in zip(moved_to, offset)], (597730.71, 6012375.70, 0), 0.05)

    def test_a_wrong_position_is_named_and_left_out(self):
        wrong = [list(place) for place in self.known]
        wrong[2][0] += 50
        for arguments in ((), ("--rigid",)):
            said = self.aligned(self.lines(wrong), *arguments)
            self.assertIn("warning: " + self.path("known.csv") + ": the position of "
                          + self.path(self.names[2]) + " is 50 m from where the 7 positions", said)
            self.assertIn("Aligned by 7 known positions: scale 1,", said)
            self.check(self.known, 1e-9)

    def test_a_left_handed_frame_is_refused(self):
        for known in ([(x, y, -z) for x, y, z in self.known], [(y, x, z) for x, y, z in self.known]):
            for arguments in ((), ("--rigid",)):
                self.not_aligned("depth, positive downwards (give the height), or the northing stands before the "
                                 "easting", self.lines(known), *arguments)

    def test_a_left_handed_frame_of_a_plane_is_warned_of(self):
        level = [(x, y, 0) for x, y, _ in CENTRES]
        self.cameras(level)
        self.assertNotIn("look up", self.aligned(self.lines([(y, -x, 0) for x, y, _ in self.known])))
        in_the_frame_of_the_scene = self.lines([(x, y, -3) for x, y, _ in level])
        self.assertNotIn("look up", self.aligned(in_the_frame_of_the_scene))
        said = self.aligned(self.lines([(y, -x, -3) for x, y, _ in level]))
        self.assertIn("warning: " + self.path("known.csv") + ": all cameras look up", said)


class Ports(Aligned):
    def moved_port(self):
        return json.loads(self.at("moved.housing.json"))["ports"]["main"]

    def test_a_scale_behind_a_port(self):
        self.port(flat(thickness_m=0.005))
        self.refused("the transformation has the scale 2.5, but the lengths of port 'main'", "-t", self.path("t.txt"))
        self.transform("-t", self.path("t.txt"), "--scale-ports")
        self.assertAlmostEqual(self.moved_port()["distance_m"], 0.05, 12)
        self.assertAlmostEqual(self.moved_port()["thickness_m"], 0.0125, 12)
        self.by("t.txt", matrix_text(1.0000001))
        self.transform("-t", self.path("t.txt"))
        self.assertEqual(self.moved_port()["distance_m"], 0.02)

    def test_a_water_surface_moves(self):
        self.port({"type": "water-surface", "normal": [0, 0, 1], "point_m": [0.5, 0, 0.25], "n_air": 1.0,
                   "n_water": 1.333})
        self.transform("-t", self.path("t.txt"))
        self.near(self.moved_port()["normal"], times(TURN, (0, 0, 1)), 1e-12)
        self.near(self.moved_port()["point_m"], moved((0.5, 0, 0.25), 2.5), 1e-12)

    def test_rigid_alignment(self):
        self.port(flat())
        self.not_aligned("the scale 1.01", self.positions(1.01))
        self.assertIn("scale 1,", self.aligned(self.positions(1.01), "--rigid"))


class Volume(Transform):
    def measured(self, said, what):
        return float(re.search(re.escape(what) + r": (\S+) m\^3", said)[1])

    def test_a_cube_on_a_ground(self):
        # The ground is 6 m x 6 m. The cube of 1 m stands on it, without a bottom; its sides and its
        # top look outwards. Up is -z, where the cameras are.
        ground = [(x, y, 5.0) for y in (-3.0, 3.0) for x in (-3.0, 3.0)]
        cube = [(x, y, 5.0 - z) for x, y, z in CUBE]
        faces = CUBE_FACES[:2] + [tuple(c + 4 for c in reversed(face)) for face in CUBE_FACES[2:]]
        self.put(ground + cube, faces)
        said = self.succeeds(*self.command("TransformScene", "-m", "mesh.ply", "--compute-volume", 1)).stdout
        # The foot of the sides is within the threshold and raises the fitted plane by 0.1 mm.
        self.assertAlmostEqual(self.measured(said, "Volume above the ground plane"), 1, 3)
        normal = re.search(r"normal \((\S+), (\S+), (\S+)\)", said).groups()
        self.near(map(float, normal), (0, 0, -1), 1e-3)
        self.assertNotIn("moved.mvs", files_below(self.work))
        said = self.transform("-t", self.path("t.txt"), "-m", "mesh.ply", "--compute-volume", 1,
                              "--up-axis", 0).stdout
        self.assertAlmostEqual(self.measured(said, "Volume above the ground plane") / 2.5 ** 3, 1, 3)
        self.refused("mesh.ply: it is not closed (8 border edges", "-m", "mesh.ply",
                     "--compute-volume", 1, "--plane-threshold", -1)

    def test_a_closed_mesh(self):
        self.put(CUBE, CUBE_FACES)
        said = self.transform("-t", self.path("t.txt"), "-m", "mesh.ply", "--compute-volume", 1,
                              "--plane-threshold", -1).stdout
        self.assertAlmostEqual(self.measured(said, "Volume that the mesh encloses"), 2.5 ** 3, 4)


if __name__ == "__main__":
    main()
