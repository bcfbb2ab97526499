# SPDX-License-Identifier: GPL-3.0-or-later
"""TransformScene moves scenes, clouds and meshes so that every view sees the same picture."""

import json
import os
import re
import struct

import tiny_scene
from programs import files_below, main, read, write
from transform_case import (CUBE, CUBE_FACES, PORT, TURN, UTM, Mvs, Transform, ascii_ply, inverse_text,
                            matrix_text, moved, ply_points, times)


class Moves(Transform):
    def test_a_refused_command_leaves_no_folder(self):
        self.refuses("missing.mvs", "TransformScene", "-i", "missing.mvs", "-w", self.folder, "-t", self.path("t.txt"),
                     "-o", "new/dir/moved.mvs")
        self.assertFalse(os.path.exists(self.path("new")))

    def test_there_and_back(self):
        write(self.path("back.txt"), inverse_text(2.5))
        self.transform("-t", self.path("t.txt"), "-p", "cloud.ply", "-m", "mesh.ply")
        self.transform("-t", self.path("back.txt"), "-p", "moved.ply", "-m", "moved_mesh.ply",
                       scene="moved.mvs", output="again.mvs")
        before, after, again = (Mvs(self.at(name)) for name in ("scene.mvs", "moved.mvs",
                                                                "again.mvs"))
        for old, new, back in zip(before.poses, after.poses, again.poses):
            self.near(new[3], moved(old[3], 2.5), 1e-9)
            self.near(back[2] + back[3], old[2] + old[3], 1e-9)
        self.assertEqual(again.images, before.images)
        for name in ("cloud.ply", "mesh.ply"):
            there = "moved.ply" if name == "cloud.ply" else "moved_mesh.ply"
            old, new = ply_points(self.at(name))[0], ply_points(self.at(there))[0]
            back = ply_points(self.at(there.replace("moved", "again")))[0]
            self.assertEqual(len(new), len(old))
            for a, b, c in zip(old, new, back):
                self.near(c, a, 1e-6)  # float32 of a few metres
                for image in range(3):
                    self.near(after.pixel(image, b[:3]), before.pixel(image, a[:3]), 1e-4)
                if name == "cloud.ply":
                    self.near(b[3:], times(TURN, a[3:]), 1e-6)
        for a, b in zip(before.points, after.points):
            self.near(after.pixel(1, b), before.pixel(1, a), 1e-4)

    def test_far_away_and_back(self):
        """Poses in UTM are double; floats are near the origin, and the offset is in files."""
        write(self.path("t.txt"), matrix_text(1, UTM))
        write(self.path("back.txt"), inverse_text(1, UTM))
        said = self.transform("-t", self.path("t.txt"), "-p", "cloud.ply", "-m", "mesh.ply",
                              "--transform-out", self.path("out.txt"))
        self.assertNotIn("far from the origin", said.stdout + said.stderr)
        offset = json.loads(self.at("moved.geo.json"))["geo_offset"]
        self.near(offset, UTM, 20)
        before, after = Mvs(self.at("scene.mvs")), Mvs(self.at("moved.mvs"))
        for old, new in zip(before.poses, after.poses):
            expected = [a + (b - c) for a, b, c in zip(times(TURN, old[3]), UTM, offset)]
            self.near(new[3], expected, 5e-9)  # a double of 5e6 has steps of 1e-9
        for name, there in (("cloud.ply", "moved.ply"), ("mesh.ply", "moved_mesh.ply")):
            new, of_file = ply_points(self.at(there))
            self.assertEqual(list(of_file), offset)
            for a, b in zip(ply_points(self.at(name))[0], new):
                for image in range(3):
                    self.near(after.pixel(image, b[:3]), before.pixel(image, a[:3]), 1e-3)
        numbers = [float(word) for word in read(self.path("out.txt")).split()]
        self.near(numbers, [float(w) for w in matrix_text(1, UTM).split()] + [0, 0, 0, 1], 5e-9)
        self.transform("-t", self.path("back.txt"), "-p", "moved.ply", scene="moved.mvs",
                       output="again.mvs")
        self.assertFalse(os.path.exists(self.path("work", "again.geo.json")))
        for old, back in zip(before.poses, Mvs(self.at("again.mvs")).poses):
            self.near(back[2] + back[3], old[2] + old[3], 5e-9)
        back, of_file = ply_points(self.at("again.ply"))
        self.assertIsNone(of_file)
        for a, b in zip(ply_points(self.at("cloud.ply"))[0], back):
            self.near(a, b, 1e-5)

    def test_everything_else_in_a_ply_stays(self):
        mesh = ascii_ply("double", [(*x, 200, i / 8) for i, x in enumerate(CUBE)],
                         [(*face, 6, .1, .2, .3, .4, .5, .6, 7) for face in CUBE_FACES],
                         "property uchar red\nproperty float quality\n",
                         "property list uchar double texcoord\nproperty int texnumber\n",
                         "comment TextureFile a.png\n")
        write(self.mesh, mesh)
        self.transform("-t", self.path("t.txt"), "-m", "mesh.ply")
        head, body = self.at("moved_mesh.ply").split(b"end_header\n")
        self.assertIn(b"comment TextureFile a.png\n", head)
        rows = [struct.unpack_from("<3dBf", body, 29 * i) for i in range(8)]
        for i, (row, x) in enumerate(zip(rows, CUBE)):
            self.near(row[:3], moved(x, 2.5), 1e-12)
            self.assertEqual(row[3:], (200, i / 8))
        faces = [struct.unpack_from("<B3iB6di", body, 29 * 8 + 66 * i) for i in range(12)]
        self.assertEqual([face[:4] for face in faces], CUBE_FACES)
        self.assertEqual({face[4:] for face in faces}, {(6, .1, .2, .3, .4, .5, .6, 7)})
        self.assertEqual(len(body), 29 * 8 + 66 * 12)

    def test_shrunk_images(self):
        said = self.transform("--max-resolution", 48).stdout
        self.assertIn("3 of 3 images were shrunk", said)
        before, after = Mvs(self.at("scene.mvs")), Mvs(self.at("moved.mvs"))
        for (_, k, *pose), (size, small, *same), name in zip(before.poses, after.poses,
                                                             after.images):
            self.assertEqual(size, (48, 36))
            self.assertEqual(pose, same)
            for i in (0, 4):
                self.assertAlmostEqual(small[i], k[i] / 2, 9)
            for i in (2, 5):
                self.assertAlmostEqual(small[i] + 0.5, (k[i] + 0.5) / 2, 9)
            png = self.at(name)
            self.assertIn("images48", name)
            self.assertEqual(struct.unpack(">II", png[16:24]), (48, 36))
        self.succeeds("DensifyPointCloud", "-i", "moved.mvs", "-w", self.work, "--resolution-level",
                      0, "--min-resolution", 16)


class Alignment(Transform):
    def write_reference(self, names=None, count=3, scale=2.5):
        names = names or [self.path("other", name) for name in tiny_scene.names()]
        centres = [moved(c, scale) for c in tiny_scene.CENTRES][:count]
        rotation = [x for column in zip(*TURN) for x in column]  # the pose of an unturned camera
        write(self.path("work", "reference.mvs"),
              tiny_scene.mvs(names[:count], centres=centres, rotation=rotation,
                             points=[(moved(x, scale), list(range(count)))
                                     for x, _ in tiny_scene.sparse_points()]))
        return centres, rotation

    def check(self, centres, within=1e-6):
        for pose, centre in zip(Mvs(self.at("moved.mvs")).poses, centres):
            self.near(pose[3], centre, within)

    def test_to_a_scene_by_name(self):
        centres, rotation = self.write_reference()
        said = self.transform("-a", "reference.mvs").stdout
        self.assertIn("Aligned by 3 images with the same names: scale 2.5", said)
        self.check(centres)
        for pose in Mvs(self.at("moved.mvs")).poses:
            self.near(pose[2], rotation, 1e-9)

    def test_to_a_scene_whose_images_have_another_order(self):
        names = [self.path("other", name) for name in tiny_scene.names()]
        centres, rotation = self.write_reference()
        order = (2, 0, 1)
        write(self.path("work", "reference.mvs"),
              tiny_scene.mvs([names[i] for i in order], centres=[centres[i] for i in order],
                             rotation=rotation))
        self.transform("-a", "reference.mvs")
        self.check(centres)

    def test_to_a_scene_by_order(self):
        centres, _ = self.write_reference(["x.png", "y.png", "z.png"])
        said = self.transform("-a", "reference.mvs").stdout
        self.assertIn("3 images in their order, because names do not match", said)
        self.check(centres)
        self.write_reference(["x.png", "y.png"], count=2)
        self.refused("reference.mvs: 0 of its images have the name of an image of the scene, and "
                     "it has 2 images, not 3", "-a", "reference.mvs")

    def test_to_positions(self):
        lines = [f"{name} {x!r} {y!r} {z!r}" for name, (x, y, z) in
                 zip(tiny_scene.names(), (moved(c, 2.5, UTM) for c in tiny_scene.CENTRES))]
        write(self.path("known.txt"), "\n".join(["# name x y z", *lines, "absent.jpg 1 2 3"]))
        said = self.transform("--positions", self.path("known.txt"))
        self.assertIn("known.txt:5: the scene has no image 'absent.jpg'", said.stdout + said.stderr)
        offset = json.loads(self.at("moved.geo.json"))["geo_offset"]
        self.check([[a - b for a, b in zip(moved(c, 2.5, UTM), offset)]
                    for c in tiny_scene.CENTRES])
        write(self.path("known.txt"), "\n".join([*lines, lines[0]]))
        self.refused("known.txt:4: 0000.png occurs twice", "--positions", self.path("known.txt"))
        write(self.path("known.txt"), "\n".join(lines[:2]))
        self.refused("known.txt: 2 common positions are too few", "--positions",
                     self.path("known.txt"))


CENTRES = [(0, 0, 0), (1, 0, 0.1), (2, 0.1, -0.1), (0, 1, 0.2), (1, 1.1, 0), (2, 1, 0.3), (0.1, 2, 0),
           (1, 2, -0.2)]


class Positions(Transform):
    """Files of positions of eight photographs, as users and other programs write them."""

    def setUp(self):
        super().setUp()
        self.names = [f"dive1/IMG_{i}.JPG" for i in range(8)]
        # The cameras look along the axis z, which is downwards in the positions.
        write(self.scene, tiny_scene.mvs([self.path(name) for name in self.names], centres=CENTRES))
        self.known = [(x, -y, -z) for x, y, z in CENTRES]

    def align(self, lines, *arguments):
        write(self.path("known.csv"), "\n".join(lines) + "\n")
        said = self.transform("--positions", self.path("known.csv"), *arguments)
        return said.stdout + said.stderr

    def lines(self, known, form="{} {} {} {}"):
        return [form.format(name, *place) for name, place in zip(self.names, known)]

    def check(self, expected, within=1e-9):
        for pose, centre in zip(Mvs(self.at("moved.mvs")).poses, expected):
            self.near(pose[3], centre, within)

    def test_labels_and_fields_of_other_programs(self):
        short = [name[6:-4] for name in self.names]
        for label, form in ((str, "{},{},{},{}"), (str.lower, "{};{};{};{}"),
                            (lambda name: name[:-4], "{}\t{}\t{}\t{}"),
                            (lambda name: "C:\\dive\\dive1\\" + name[6:], '"{}", {}, {}, {}'),
                            (lambda name: name[6:-4] + ".dng", "{} {} {} {} 0 0 0 0.01 0.02")):
            said = self.align([form.format(label(name), *place)
                               for name, place in zip(self.names, self.known)])
            self.assertIn("Aligned by 8 known positions: scale 1,", said)
            self.assertNotIn("has no image", said)
            self.check(self.known)
        said = self.align(["#Label,Y/Northing,X/Easting,Z/Altitude,Accuracy_(m),Error_(m)"]
                          + [f"{name},{y},{x},{z},0.01,0.3"
                             for name, (x, y, z) in zip(short, self.known)])
        self.assertNotIn("warning", said)
        self.check(self.known)
        said = self.align(["image;x;y;depth"] + [f"{name};{x};{y};{-z + 5}".replace(".", ",")
                                                 for name, (x, y, z) in zip(short, self.known)])
        self.assertIn("depths are positive downwards", said)
        self.check([(x, y, z - 5) for x, y, z in self.known])

    def test_degrees(self):
        lines = ["label,longitude,latitude,altitude"] + [
            f"{name},{16.5 + x / 65200!r},{54.25 + y / 111300!r},{z}"
            for name, (x, y, z) in zip(self.names, self.known)]
        said = self.align(lines, "--rigid")
        self.assertIn("WGS 84 / UTM zone 33N (EPSG:32633)", said)
        offset = json.loads(self.at("moved.geo.json"))["geo_offset"]
        # 597730.71, 6012375.70 is the first position by PROJ; the last digits are the convergence.
        moved_to = Mvs(self.at("moved.mvs")).poses[0][3]
        self.near([a + b for a, b in zip(moved_to, offset)], (597730.71, 6012375.70, 0), 0.05)

    def test_degrees_without_a_unit(self):
        lines = [f"{name} {16.5 + x / 65200!r} {54.25 + y / 111300!r} {z}"
                 for name, (x, y, z) in zip(self.names, self.known)]
        said = self.align(lines)
        self.assertIn("known.csv: no line states the unit of the positions; they fit the cameras as longitude "
                      "and latitude in degrees", said)
        self.assertIn("WGS 84 / UTM zone 33N (EPSG:32633)", said)

    def test_a_wrong_position_is_named_and_left_out(self):
        wrong = [list(place) for place in self.known]
        wrong[2][0] += 50
        for arguments in ((), ("--rigid",)):
            said = self.align(self.lines(wrong), *arguments)
            self.assertIn("warning: " + self.path("known.csv") + ": the position of "
                          + self.path(self.names[2]) + " is 50 m from where the 7 positions", said)
            self.assertIn("Aligned by 7 known positions: scale 1,", said)
            self.check(self.known)

    def test_a_wrong_position_off_the_line_of_the_others_is_named(self):
        line = [(float(k), 0.0 if k != 3 else 1.0, 0.001 * (k % 2)) for k in range(len(self.names))]
        write(self.scene, tiny_scene.mvs([self.path(name) for name in self.names], centres=line))
        said = self.align(self.lines(line))
        self.assertIn("Aligned by 8 known positions: scale 1,", said)
        wrong = [(x + 20 * (y > 0), y + 30 * (y > 0), z) for x, y, z in line]
        write(self.path("known.csv"), "\n".join(self.lines(wrong)))
        self.refused("known.csv: the position of " + self.path(self.names[3]) + " does not fit the 7 others that "
                     "are used, and these lie on one line", "--positions", self.path("known.csv"))

    def test_a_left_handed_frame_is_refused(self):
        for known in ([(x, y, -z) for x, y, z in self.known], [(y, x, z) for x, y, z in self.known]):
            write(self.path("known.csv"), "\n".join(self.lines(known)))
            for arguments in ((), ("--rigid",)):
                self.refused("depth, positive downwards (give the height), or the northing stands "
                             "before the easting", "--positions", self.path("known.csv"), *arguments)

    def test_a_left_handed_frame_of_a_plane_is_warned_of(self):
        level = [(x, y, 0) for x, y, _ in CENTRES]
        write(self.scene, tiny_scene.mvs([self.path(name) for name in self.names], centres=level))
        said = self.align(self.lines([(y, -x, 0) for x, y, _ in self.known]))
        self.assertNotIn("look up", said)
        said = self.align(self.lines([(x, y, -3) for x, y, _ in level]))
        self.assertNotIn("look up", said)  # the frame of the scene
        said = self.align(self.lines([(y, -x, -3) for x, y, _ in level]))
        self.assertIn("warning: " + self.path("known.csv") + ": all cameras look up", said)


class Ports(Transform):
    def test_a_scale_behind_a_port(self):
        self.port(PORT)
        self.refused("the transformation has the scale 2.5, but the lengths of port 'main'", "-t",
                     self.path("t.txt"))
        self.transform("-t", self.path("t.txt"), "--scale-ports")
        port = json.loads(self.at("moved.housing.json"))["ports"]["main"]
        self.assertAlmostEqual(port["distance_m"], 0.05, 12)
        self.assertAlmostEqual(port["thickness_m"], 0.0125, 12)
        write(self.path("t.txt"), matrix_text(1.0000001))
        self.transform("-t", self.path("t.txt"))
        self.assertEqual(json.loads(self.at("moved.housing.json"))["ports"]["main"]["distance_m"],
                         0.02)

    def test_rigid_alignment(self):
        self.port(PORT)
        lines = [f"{name} {x} {y} {z}" for name, (x, y, z) in
                 zip(tiny_scene.names(), (moved(c, 1.01) for c in tiny_scene.CENTRES))]
        write(self.path("known.txt"), "\n".join(lines))
        self.refused("the scale 1.01", "--positions", self.path("known.txt"))
        said = self.transform("--positions", self.path("known.txt"), "--rigid").stdout
        self.assertIn("scale 1,", said)

    def test_a_water_surface_moves(self):
        surface = {"type": "water-surface", "normal": [0, 0, 1], "point_m": [0.5, 0, 0.25],
                   "n_air": 1.0, "n_water": 1.333}
        self.port(surface)
        self.transform("-t", self.path("t.txt"))
        found = json.loads(self.at("moved.housing.json"))["ports"]["main"]
        self.near(found["normal"], times(TURN, (0, 0, 1)), 1e-12)
        self.near(found["point_m"], moved((0.5, 0, 0.25), 2.5), 1e-12)


class Volume(Transform):
    def measured(self, said, what):
        return float(re.search(re.escape(what) + r": (\S+) m\^3", said)[1])

    def test_a_cube_on_a_ground(self):
        # The ground is 6 m x 6 m. The cube of 1 m stands on it, without a bottom; its sides and its
        # top look outwards. Up is -z, where the cameras are.
        ground = [(x, y, 5.0) for y in (-3.0, 3.0) for x in (-3.0, 3.0)]
        cube = [(x, y, 5.0 - z) for x, y, z in CUBE]
        faces = [(3, 0, 2, 1), (3, 1, 2, 3)] + [
            (3, *(c + 4 for c in reversed(face[1:]))) for face in CUBE_FACES[2:]]
        write(self.mesh, ascii_ply("float", ground + cube, faces))
        said = self.succeeds("TransformScene", "-i", "scene.mvs", "-w", self.work, "-m", "mesh.ply",
                             "--compute-volume", 1).stdout
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
        write(self.mesh, ascii_ply("float", CUBE, CUBE_FACES))
        said = self.transform("-t", self.path("t.txt"), "-m", "mesh.ply", "--compute-volume", 1,
                              "--plane-threshold", -1).stdout
        self.assertAlmostEqual(self.measured(said, "Volume that the mesh encloses"), 2.5 ** 3, 4)


if __name__ == "__main__":
    main()
