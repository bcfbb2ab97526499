# SPDX-License-Identifier: GPL-3.0-or-later
"""--pinhole-export: programs for pinhole cameras reach the quality of the refractive scene."""

import json
import os
import re
import shutil
import struct
import tempfile

from programs import ProgramTest, cloud_size, depth_rows, files_below, main, read, run, write

VIEWS = 5
QUICK = ("--resolution-level", "1", "--min-resolution", "100", "--iters", "1",
         "--number-views-fuse", "2")


class Reader:
    """Reads a .mvs scene of version 7 field by field (docs/formats.md)."""

    def __init__(self, data):
        assert data[:8] == b"MVSI" + struct.pack("<I", 7)
        self.data, self.at = data, 12
        self.platforms = [self.platform() for _ in range(self.number("Q"))]
        self.images = [self.image() for _ in range(self.number("Q"))]
        self.points = [(self.numbers("3f"), [self.numbers("If")[0] for _ in range(self.number("Q"))])
                       for _ in range(self.number("Q"))]

    def numbers(self, kind):
        values = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += struct.calcsize("<" + kind)
        return values

    def number(self, kind):
        return self.numbers(kind)[0]

    def string(self):
        length = self.number("Q")
        self.at += length
        return self.data[self.at - length:self.at].decode()

    def platform(self):
        self.string()
        cameras = []
        for _ in range(self.number("Q")):
            self.string(), self.string()
            cameras.append((self.numbers("2I"), self.numbers("9d")))
            self.numbers("12d")
        return cameras, [(self.numbers("9d"), self.numbers("3d")) for _ in range(self.number("Q"))]

    def image(self):
        name, mask, ids = self.string(), self.string(), self.numbers("4I")
        self.numbers("3f")
        for _ in range(self.number("Q")):
            self.numbers("2I4f")
        return name, mask, ids

    def camera(self, image):
        """Size, K, R and C of an image; None if the image has no pose."""
        platform, camera, pose, _ = self.images[image][2]
        if pose == 0xFFFFFFFF:
            return None
        cameras, poses = self.platforms[platform]
        return *cameras[camera], *poses[pose]


def image_size(scene, image):
    return scene.camera(image)[0]


def project(camera, point):
    """The pixel (x, y) and the z-depth of a point."""
    _, k, r, c = camera
    x, y, z = (sum(r[3 * i + j] * (point[j] - c[j]) for j in range(3)) for i in range(3))
    return k[0] * x / z + k[2], k[4] * y / z + k[5], z


class Exports(ProgramTest):
    """The close-up scene under water, densified and exported once."""

    @classmethod
    def setUpClass(cls):
        if cls is Exports:
            return
        cls.shared = tempfile.TemporaryDirectory(prefix="axial_")
        cls.addClassCleanup(cls.shared.cleanup)
        cls.truth = cls.at("closeup")
        cls.must("SimulateUnderwater", "--preset", "closeup", "--coarseness", 4, "--views", VIEWS,
                 "--width", 320, "--height", 240, "--medium", "water", "--samples", 2, "--truth", 0,
                 "-o", cls.truth)
        cls.make_scene(cls.at("work"))
        cls.must(*cls.command(cls.at("work"), "--pinhole-export", "pinholes"))

    @classmethod
    def at(cls, *names):
        return os.path.join(cls.shared.name, *names)

    @classmethod
    def must(cls, *command):
        result = run(*command)
        assert result.returncode == 0, result.stderr
        return result.stdout

    @classmethod
    def make_scene(cls, folder):
        cls.must("InterfaceCOLMAP", "-i", cls.truth, "--image-folder",
                 os.path.join(cls.truth, "water"), "-o", os.path.join(folder, "scene.mvs"),
                 "--housing", os.path.join(cls.truth, "housing.json"))

    @staticmethod
    def command(folder, *arguments):
        return ("DensifyPointCloud", "-i", "scene.mvs", "-w", folder, *QUICK, *arguments)

    def copy(self, *names, leave_out=()):
        """A copy of a shared folder for one test. It lies beside the shared folder, because maps
        hold relative image paths."""
        target = self.at(f"copy_{self._testMethodName}")
        self.addCleanup(shutil.rmtree, target, True)
        shutil.copytree(self.at(*names), target,
                        ignore=shutil.ignore_patterns("pinholes", *leave_out))
        self.folder = target
        return target

    def contents(self, folder):
        return {name: read(os.path.join(folder, name)) for name in files_below(folder)}

    def export(self, folder, *arguments):
        self.succeeds(*self.command(folder, "--pinhole-export", "pinholes", *arguments))
        return os.path.join(folder, "pinholes")


class Taken(Exports):
    """The export as input of a program for pinhole cameras: DensifyPointCloud without a housing."""

    def error_of(self, cloud):
        """Mean distance of the points to the true surface [mm], and the number of points."""
        report = os.path.join(os.path.dirname(cloud), "evaluation.json")
        self.succeeds("EvaluateReconstruction", "-i", cloud, "-m",
                      os.path.join(self.truth, "mesh.ply"), "--cameras",
                      os.path.join(self.truth, "sparse"), "--housing",
                      os.path.join(self.truth, "housing.json"), "--tolerance", "0.002", "--samples",
                      "10000", "--json", report)
        return 1000 * json.loads(read(report))["accuracy"]["mean"], cloud_size(read(cloud))

    def test_the_cloud_is_the_same(self):
        self.assertEqual(read(self.at("work", "pinholes", "scene.ply")),
                         read(self.at("work", "scene_dense.ply")))

    def test_fusing_the_depth_maps(self):
        folder = self.copy("work", "pinholes")
        maps = {name: data for name, data in self.contents(folder).items() if ".dmap" in name}
        self.assertEqual(len(maps), 2 * VIEWS)
        said = self.succeeds(*self.command(folder, "--fusion-mode", "-1")).stdout
        self.assertIn(f"{VIEWS} of {VIEWS} images have a depth map", said)
        self.assertEqual({n: d for n, d in self.contents(folder).items() if ".dmap" in n}, maps)
        error, points = self.error_of(os.path.join(folder, "scene_dense.ply"))
        refractive, refractive_points = self.error_of(self.at("work", "scene_dense.ply"))
        print(f"\nfused {error:.3f} mm, {points} points; refractive {refractive:.3f} mm, "
              f"{refractive_points}")
        # An exported depth interpolates three depths. The image has 0.8 times as many pixels.
        self.assertLess(error, 1.15 * refractive)
        self.assertGreater(points, 0.65 * refractive_points)

    def test_without_our_side_files(self):
        folder = self.copy("work", "pinholes", leave_out=("*.json",))
        said = self.succeeds(*self.command(folder, "--fusion-mode", "-1")).stdout
        self.assertIn(f"{VIEWS} by other programs", said)

    def test_matching_the_images_anew(self):
        folder = self.copy("work", "pinholes", leave_out=("*.dmap*",))
        self.succeeds(*self.command(folder))
        error, points = self.error_of(os.path.join(folder, "scene_dense.ply"))
        refractive, refractive_points = self.error_of(self.at("work", "scene_dense.ply"))
        # The photographs themselves, matched as if a pinhole camera had taken them.
        as_they_are = self.copy_of_photographs()
        ignored, _ = self.error_of(as_they_are)
        print(f"\nrematched {error:.3f} mm, {points} points; refractive {refractive:.3f} mm, "
              f"{refractive_points}; photographs taken for a pinhole's {ignored:.3f} mm")
        self.assertLess(error, 1.3 * refractive)
        self.assertGreater(points, 0.65 * refractive_points)
        self.assertGreater(ignored, 4 * refractive)

    def copy_of_photographs(self):
        folder = self.at("ignored")
        self.make_scene(folder)
        self.succeeds(*self.command(folder, "--camera-model", "pinhole"))
        return os.path.join(folder, "scene_dense.ply")

    def test_masks_leave_out_what_the_photograph_does_not_show(self):
        folder = self.copy("work", "pinholes", leave_out=("*.dmap*",))
        said = self.succeeds(*self.command(folder, "--ignore-mask-label", "0")).stdout
        self.assertNotIn("no mask", said)
        self.assertGreater(cloud_size(read(os.path.join(folder, "scene_dense.ply"))), 10000)

    def test_poses_and_maps_agree_with_the_points_of_the_scene(self):
        """The simulated points, which do not depend on depth maps, have the depths of the maps."""
        folder = self.at("work", "pinholes")
        scene = Reader(read(os.path.join(folder, "scene.mvs")))
        ratios, shown = [], 0
        for image in range(VIEWS):
            size = image_size(scene, image)
            rows = depth_rows(read(os.path.join(folder, f"depth{image:04}.dmap")))
            scale = len(rows[0]) / size[0], len(rows) / size[1]
            for point, views in scene.points:
                if image not in views:
                    continue
                # Points were observed in air, where the field of view is wider.
                u, v, z = project(scene.camera(image), point)
                x, y = round((u + 0.5) * scale[0] - 0.5), round((v + 0.5) * scale[1] - 0.5)
                if not (0 <= x < len(rows[0]) and 0 <= y < len(rows)):
                    continue
                shown += 1
                if rows[y][x] > 0:
                    ratios.append(rows[y][x] / z)
        self.assertGreater(len(ratios), 0.65 * shown)
        ratios.sort()
        self.assertAlmostEqual(ratios[len(ratios) // 2], 1, delta=0.002)
        self.assertGreater(ratios[len(ratios) // 10], 0.98)
        self.assertLess(ratios[len(ratios) * 9 // 10], 1.02)


class Files(Exports):
    def test_are_all_there_and_fit(self):
        folder = self.at("work", "pinholes")
        names = {f"images/{i:04}{end}" for i in range(VIEWS) for end in (".jpg", ".mask.png")}
        names |= {f"depth{i:04}.dmap{end}" for i in range(VIEWS) for end in ("", ".json")}
        self.assertEqual(files_below(folder),
                         names | {"scene.mvs", "scene.ply", "pinhole_export.json"})
        scene = Reader(read(os.path.join(folder, "scene.mvs")))
        self.assertEqual(len(scene.platforms), 1)  # one lens and port: one pinhole
        for i, (name, mask, ids) in enumerate(scene.images):
            self.assertEqual((name, mask, ids[3]), (f"images/{i:04}.jpg", f"images/{i:04}.mask.png", i))
            png = read(os.path.join(folder, mask))
            self.assertEqual(struct.unpack_from(">II", png, 16), image_size(scene, i))
        listed = json.loads(read(os.path.join(folder, "pinhole_export.json")))["images"]
        self.assertEqual([entry["image"] for entry in listed], [n for n, _, _ in scene.images])
        self.assertTrue(all(0.6 < entry["exact_share"] < 1 for entry in listed), listed)

    def test_are_the_same_for_any_number_of_threads(self):
        work = self.copy("work")
        self.assertEqual(self.contents(self.export(work, "--max-threads", "1")),
                         {name: data.replace(self.at("work").encode(), work.encode())
                          for name, data in self.contents(self.at("work", "pinholes")).items()})

    def test_the_option_changes_no_other_output(self):
        work = self.copy("work", leave_out=("depth*", "scene_dense*"))
        said = self.succeeds(*self.command(work)).stdout
        self.assertIn("--pinhole-export DIR", said.strip().splitlines()[-1])
        for name in ("scene_dense.ply", "scene_dense.mvs", "depth0002.dmap"):
            self.assertEqual(read(os.path.join(work, name)), read(self.at("work", name)))

    def test_an_earlier_export_is_replaced_and_other_files_stay(self):
        work = self.copy("work")
        write(os.path.join(work, "pinholes", "pinhole_export.json"), "{}\n")
        write(os.path.join(work, "pinholes", "scene.ply"), "old\n")
        write(os.path.join(work, "pinholes", "scene_mesh.ply"), "mine\n")
        self.export(work)
        contents = self.contents(os.path.join(work, "pinholes"))
        self.assertEqual(contents.pop("scene_mesh.ply"), b"mine\n")
        self.assertEqual(contents["scene.ply"], read(self.at("work", "scene_dense.ply")))
        self.assertEqual(set(contents), files_below(self.at("work", "pinholes")))

    def test_what_an_earlier_export_alone_had_goes(self):
        work = self.copy("work")
        offset = '{ "version": 1, "geo_offset": [534000, 3378500, 30] }\n'
        write(os.path.join(work, "scene.geo.json"), offset)
        folder = self.export(work, "--fusion-mode", "-1")
        first = self.contents(folder)
        self.assertIn("scene.geo.json", first)
        write(os.path.join(folder, "images", "notes.txt"), "mine\n")
        write(os.path.join(folder, "depth0009.dmap"), "of another program\n")
        write(os.path.join(folder, "depth0003.dmap"), "of another program\n")
        os.remove(os.path.join(work, "scene.geo.json"))
        for name in ("depth0001.dmap", "depth0003.dmap"):
            os.remove(os.path.join(work, name))
            os.remove(os.path.join(work, name + ".json"))

        command = self.command(work, "--pinhole-export", "pinholes", "--fusion-mode", "-1")
        before = self.contents(folder)
        self.assertEqual(run(*command, file_size_limit=20000).returncode, 1)
        self.assertEqual(self.contents(folder), before)  # the earlier export survives
        said = self.succeeds(*command).stdout
        self.assertEqual(said.count("depth0003.dmap: was changed after the earlier export"), 1)
        found = self.contents(folder)
        self.assertEqual(found.pop("images/notes.txt"), b"mine\n")
        for name in ("depth0009.dmap", "depth0003.dmap"):
            self.assertEqual(found.pop(name), b"of another program\n")
        shutil.rmtree(folder)
        self.assertEqual(found, self.contents(self.export(work, "--fusion-mode", "-1")))
        self.assertEqual(set(first) - set(found),
                         {"scene.geo.json"} | {name for i in ("0001", "0003") for name in (
                             f"images/{i}.jpg", f"images/{i}.mask.png", f"depth{i}.dmap",
                             f"depth{i}.dmap.json")})

    def test_a_list_of_an_earlier_export_that_is_none(self):
        work = self.copy("work")
        marker = os.path.join(work, "pinholes", "pinhole_export.json")
        for wrong in ("", "[]", '{"files"'):
            write(marker, wrong)
            self.refuses("pinhole_export.json", *self.command(work, "--pinhole-export", "pinholes"))
        write(os.path.join(work, "kept.txt"), "mine\n")
        write(marker, json.dumps({"files": {"../kept.txt": "x", "/kept": 3, "none": "x"}}))
        self.export(work)
        self.assertEqual(read(os.path.join(work, "kept.txt")), b"mine\n")

    def test_images_without_a_map_stay_under_their_indices(self):
        work = self.copy("work", leave_out=("depth0001.dmap*",))
        folder = self.export(work, "--fusion-mode", "-1")
        scene = Reader(read(os.path.join(folder, "scene.mvs")))
        self.assertEqual([scene.camera(i) is None for i in range(VIEWS)], [i == 1 for i in range(VIEWS)])
        self.assertTrue(all(views and 1 not in views for _, views in scene.points))
        self.assertFalse(os.path.exists(os.path.join(folder, "images", "0001.jpg")))
        said = self.succeeds(*self.command(folder, "--fusion-mode", "-1")).stdout
        self.assertIn("4 of 4 images have a depth map", said)

    def test_photographs_in_folders(self):
        work = self.copy("work", leave_out=("depth*", "scene_dense*"))
        old = read(os.path.join(work, "scene.mvs"))
        new, changed = old, {}
        for i in range(VIEWS):
            name = f"{i:04}.jpg"
            changed[name] = f"cam{i % 2}/{i // 2:04}.jpg"
            target = os.path.join(work, "photos", changed[name])
            os.makedirs(os.path.dirname(target), exist_ok=True)
            shutil.copy(os.path.join(self.truth, "water", name), target)
            path = re.search(rb"[^\0]*" + name.encode(), new)[0]
            before = struct.pack("<Q", len(path)) + path
            self.assertEqual(new.count(before), 1)
            after = f"photos/{changed[name]}".encode()
            new = new.replace(before, struct.pack("<Q", len(after)) + after)
        write(os.path.join(work, "scene.mvs"), new)
        folder = self.export(work)
        for name, moved in changed.items():
            self.assertEqual(read(os.path.join(folder, "images", moved)),
                             read(self.at("work", "pinholes", "images", name)))

    def assert_same_points(self, a, b):
        """Compares bodies of clouds. Positions may differ by rounding: a double has a resolution of
        5e-10 m at these world coordinates."""
        self.assertEqual(len(a), len(b))
        at = 0
        while at < len(a):
            for p, q in zip(struct.unpack_from("<3f", a, at), struct.unpack_from("<3f", b, at)):
                self.assertAlmostEqual(p, q, delta=1e-9 + 1e-7 * abs(p))
            end = at + 12 + 3 + 12 + 2 * (1 + 4 * a[at + 27])
            self.assertEqual(a[at + 12:end], b[at + 12:end])
            at = end

    def test_a_scene_far_from_its_world_s_origin(self):
        work = self.copy("work", leave_out=("depth*", "scene_dense*"))
        write(os.path.join(work, "scene.geo.json"),
              '{ "version": 1, "geo_offset": [534000, 3378500, 30] }\n')
        body = read(self.at("work", "scene_dense.ply")).split(b"end_header\n", 1)[1]
        for precision in ("float", "double"):
            folder = self.export(work, "--output-precision", precision)
            ply = read(os.path.join(folder, "scene.ply"))
            self.assertIn(b"comment geo_offset 534000 3378500 30\n", ply)
            self.assert_same_points(ply.split(b"end_header\n", 1)[1], body)
            self.assertEqual(json.loads(read(os.path.join(folder, "scene.geo.json")))["geo_offset"],
                             [534000, 3378500, 30])
            for name in ("scene.mvs", "images/0003.jpg", "depth0003.dmap"):
                self.assertEqual(read(os.path.join(folder, name)),
                                 read(self.at("work", "pinholes", name)))


class Refusals(Exports):
    def refused(self, expected, folder, *arguments):
        before = self.contents(folder)
        self.refuses(expected, *self.command(folder, *arguments))
        self.assertEqual(self.contents(folder), before)

    def test_scenes_of_pinholes(self):
        dry = self.copy("work", leave_out=("*.housing.json",))
        self.refused("has a port or a distorted lens", dry, "--pinhole-export", "pinholes")
        self.refused("has a port or a distorted lens", self.at("work", "pinholes"),
                     "--pinhole-export", "again")

    def test_cameras_taken_for_pinholes(self):
        self.refused("has a port or a distorted lens", self.copy("work"), "--pinhole-export",
                     "pinholes", "--camera-model", "pinhole")

    def test_folders_of_others_and_of_inputs(self):
        work = self.copy("work")
        write(os.path.join(work, "other", "notes.txt"), "mine\n")
        write(os.path.join(work, "a_file"), "mine\n")
        os.symlink(work, os.path.join(work, "link"))
        write(os.path.join(self.truth, "pinhole_export.json"), "{}\n")  # as in an export
        for folder, expected in (("other", "contains other files"), (".", "contains inputs"),
                                 ("link", "contains inputs"), ("a_file", "is a file"),
                                 ("a_file/below", "a_file"),
                                 (os.path.join(self.truth, "water"), "contains inputs"),
                                 (self.truth, "contains inputs")):
            self.refuses(expected, *self.command(work, "--pinhole-export", folder))
        self.assertEqual(read(os.path.join(work, "other", "notes.txt")), b"mine\n")

    def test_runs_that_make_no_cloud(self):
        work = self.copy("work")
        for arguments in (("--fusion-mode", "1"), ("--export-number-views", "3"),
                          ("--output-view-neighbors-file", "neighbours.txt")):
            self.refused("needs a cloud", work, "--pinhole-export", "pinholes", *arguments)

    def test_names_that_would_be_one(self):
        work = self.copy("work", leave_out=("depth*", "scene_dense*"))
        scene = read(os.path.join(work, "scene.mvs"))
        for i, name in enumerate(("a.jpg", "a.JPG", "a.png", "b.png", "c.png")):
            shutil.copy(os.path.join(self.truth, "water", f"{i:04}.jpg"), os.path.join(work, name))
            path = re.search(rb"[^\0]*" + f"{i:04}.jpg".encode(), scene)[0]
            scene = scene.replace(struct.pack("<Q", len(path)) + path,
                                  struct.pack("<Q", len(name)) + name.encode())
        write(os.path.join(work, "scene.mvs"), scene)
        self.refused("a.mask.png", work, "--pinhole-export", "pinholes")

    def test_a_full_disk_leaves_nothing(self):
        work = self.copy("work")
        before = self.contents(work)
        largest = max(len(data) for name, data in before.items() if not name.endswith(".ply"))
        result = run(*self.command(work, "--pinhole-export", "pinholes", "--fusion-mode", "-1"),
                     file_size_limit=10000)
        self.assertGreater(largest, 10000)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertFalse(os.path.exists(os.path.join(work, "pinholes")))
        self.assertEqual([n for n in files_below(work) if ".tmp" in n], [])


if __name__ == "__main__":
    main()
