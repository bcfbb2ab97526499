# SPDX-License-Identifier: GPL-3.0-or-later
"""--pinhole-export: which files are written, replaced and kept, which exports are refused, and that programs
for pinhole cameras reach the quality of the refractive scene."""

import json
import os
import re
import shutil

from programs import cloud_size, contents, files_below, main, must, read, run, write
from readers import ColmapModel, Dmap, Mvs, Ply, png_size, with_paths
from worlds import QUICK, Densified, geo_offset

VIEWS = Densified.VIEWS


class Exports(Densified):
    """The folder `work` holds the scene under water, densified and exported to work/pinholes."""

    @classmethod
    def make(cls, folder):
        super().make(folder)
        shutil.copytree(cls.at("water"), cls.at("work"), ignore=shutil.ignore_patterns("depth*", "scene_dense*"))
        must("DensifyPointCloud", "-i", "scene.mvs", "-w", cls.at("work"), *QUICK, "--pinhole-export", "pinholes")
        cls.make_relative("work", "scene_dense.mvs")

    def copy(self, *names, leave_out=()):
        """A copy of a shared folder for one test, beside the shared folder."""
        self.folder = self.at("_".join(("copy", self._testMethodName, *names)))
        self.addCleanup(shutil.rmtree, self.folder, True)
        shutil.copytree(self.at(*names), self.folder, ignore=shutil.ignore_patterns("pinholes", *leave_out))
        return self.folder

    def export(self, folder, *arguments):
        self.said(folder, "--pinhole-export", "pinholes", *arguments)
        return os.path.join(folder, "pinholes")


OFFSET = (534000, 3378500, 30)


class Files(Exports):
    def test_are_all_there_and_fit(self):
        folder = self.at("work", "pinholes")
        names = {f"images/{i:04}{end}" for i in range(VIEWS) for end in (".jpg", ".mask.png")}
        names |= {f"depth{i:04}.dmap{end}" for i in range(VIEWS) for end in ("", ".json")}
        self.assertEqual({name for name in files_below(folder) if not name.startswith("colmap/")},
                         names | {"scene.mvs", "scene.ply", "pinhole_export.json"})
        scene = Mvs(read(os.path.join(folder, "scene.mvs")))
        self.assertEqual(len(scene.platforms), 1)  # one lens and port: one pinhole
        for i, (name, mask, ids, camera) in enumerate(zip(scene.names, scene.masks, scene.ids, scene.cameras)):
            self.assertEqual((name, mask, ids[3]), (f"images/{i:04}.jpg", f"images/{i:04}.mask.png", i))
            self.assertEqual(png_size(read(os.path.join(folder, mask))), camera[0])
        listed = json.loads(read(os.path.join(folder, "pinhole_export.json")))["images"]
        self.assertEqual([entry["image"] for entry in listed], list(scene.names))
        self.assertTrue(all(0.6 < entry["exact_share"] < 1 for entry in listed), listed)

    def test_are_the_same_for_any_number_of_threads(self):
        exports = (self.export(self.copy("work"), "--max-threads", "1"), self.at("work", "pinholes"))
        # JSON files name the photographs by their absolute paths.
        self.assertEqual(*({name: re.sub(rb'"/[^"]*/', b'"', data) if name.endswith(".json") else data
                            for name, data in contents(export).items()} for export in exports))

    def test_the_option_changes_no_other_output(self):
        work = self.copy("work", leave_out=("depth*", "scene_dense*"))
        said = self.said(work)
        self.assertIn("--pinhole-export DIR", said.strip().splitlines()[-1])
        for name in ("scene_dense.ply", "depth0002.dmap"):
            self.assertEqual(read(os.path.join(work, name)), read(self.at("work", name)))
        self.assertEqual(*(with_paths(read(os.path.join(folder, "scene_dense.mvs")), os.path.basename)
                           for folder in (work, self.at("work"))))

    def test_an_earlier_export_is_replaced_and_other_files_stay(self):
        work = self.copy("work")
        write(os.path.join(work, "pinholes", "pinhole_export.json"), "{}\n")
        write(os.path.join(work, "pinholes", "scene.ply"), "old\n")
        write(os.path.join(work, "pinholes", "scene_mesh.ply"), "mine\n")
        self.export(work)
        found = contents(os.path.join(work, "pinholes"))
        self.assertEqual(found.pop("scene_mesh.ply"), b"mine\n")
        self.assertEqual(found["scene.ply"], read(self.at("work", "scene_dense.ply")))
        self.assertEqual(set(found), files_below(self.at("work", "pinholes")))

    def test_files_of_trainers_are_named(self):
        work = self.copy("work")
        command = ("--fusion-mode", "-1", "--pinhole-export", "pinholes")
        kept = "is not of this export and is kept"
        for _ in range(2):
            self.assertNotIn(kept, self.said(work, *command))
        names = [f"pinholes/colmap/{name}" for name in ("sparse/0/points3D.ply", "images_2/0000.jpg")]
        for name in names:
            write(os.path.join(work, name), "mine\n")
        self.assertIn(f"{names[1]}: {kept}, as are 1 other files", self.said(work, *command))
        self.assertEqual([read(os.path.join(work, name)) for name in names], [b"mine\n"] * 2)

    def test_an_earlier_export_survives_a_full_disk_and_a_damaged_list_is_named(self):
        work = self.copy("work")
        folder = self.export(work, "--fusion-mode", "-1")
        before = contents(folder)
        command = self.command(work, "--pinhole-export", "pinholes", "--fusion-mode", "-1")
        self.assertEqual(run(*command, file_size_limit=20000).returncode, 1)
        self.assertEqual(contents(folder), before)
        self.refuses_contents(os.path.join(folder, "pinhole_export.json"), command,
                              *(("pinhole_export.json", wrong) for wrong in ("", "[]", '{"files"')))

    def test_images_without_a_map_stay_under_their_indices(self):
        work = self.copy("work", leave_out=("depth0001.dmap*",))
        folder = self.export(work, "--fusion-mode", "-1")
        scene = Mvs(read(os.path.join(folder, "scene.mvs")))
        self.assertEqual([scene.camera(i) is None for i in range(VIEWS)], [i == 1 for i in range(VIEWS)])
        self.assertTrue(all(views and 1 not in views for _, views in scene.points))
        for images in ("images", "colmap/images"):
            self.assertFalse(os.path.exists(os.path.join(folder, images, "0001.jpg")))
        model = ColmapModel(os.path.join(folder, "colmap", "sparse", "0"))
        self.assertEqual(sorted(model.images), [1, 3, 4, 5])
        self.assertIn("4 of 4 images have a depth map", self.said(folder, "--fusion-mode", "-1"))

    def test_photographs_in_folders(self):
        work = self.copy("work", leave_out=("depth*", "scene_dense*"))
        changed = {f"{i:04}.jpg": f"cam{i % 2}/{i // 2:04}.jpg" for i in range(VIEWS)}
        for name, moved in changed.items():
            write(os.path.join(work, "photos", moved), read(os.path.join(self.truth, "water", name)))
        scene = os.path.join(work, "scene.mvs")
        write(scene, with_paths(read(scene), lambda path: "photos/" + changed[os.path.basename(path)]))
        folder = self.export(work)
        for name, moved in changed.items():
            mask = moved.replace(".jpg", ".png")
            for exported, expected in ((f"images/{moved}", f"images/{name}"),
                                       (f"colmap/images/{moved}", f"images/{name}"),
                                       (f"colmap/masks/{mask}", f"colmap/masks/{name.replace('.jpg', '.png')}")):
                self.assertEqual(read(os.path.join(folder, exported)), read(self.at("work", "pinholes", expected)))
        model = ColmapModel(os.path.join(folder, "colmap", "sparse", "0"))
        self.assertEqual([image[3] for image in model.images.values()], list(changed.values()))

    def assert_same_points(self, cloud, expected):
        """Positions may differ by rounding: a double has a resolution of 5e-10 m at these world coordinates."""
        self.assertEqual(cloud.header, expected.header)
        for point, other in zip(cloud.vertices, expected.vertices, strict=True):
            for axis in "xyz":
                (p,), (q,) = point.pop(axis), other[axis]
                self.assertAlmostEqual(p, q, delta=1e-9 + 1e-7 * abs(p))
            self.assertEqual(point, {name: value for name, value in other.items() if name not in "xyz"})

    def test_a_scene_far_from_its_world_s_origin(self):
        work = self.copy("work", leave_out=("depth*", "scene_dense*"))
        write(os.path.join(work, "scene.geo.json"), geo_offset(*OFFSET))
        expected = Ply(read(self.at("work", "scene_dense.ply")))
        for precision in ("float", "double"):
            folder = self.export(work, "--output-precision", precision)
            cloud = Ply(read(os.path.join(folder, "scene.ply")))
            self.assertEqual(cloud.offset, OFFSET)
            self.assert_same_points(cloud, expected)
            self.assertEqual(json.loads(read(os.path.join(folder, "scene.geo.json")))["geo_offset"], list(OFFSET))
            for name in ("scene.mvs", "images/0003.jpg", "depth0003.dmap", "colmap/sparse/0/images.bin",
                         "colmap/sparse/0/points3D.bin"):
                self.assertEqual(read(os.path.join(folder, name)),
                                 read(self.at("work", "pinholes", name)))


class Refusals(Exports):
    def refused(self, expected, folder, *arguments):
        self.folder = folder
        self.refuses_and_keeps(expected, *self.command(folder, *arguments))

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
        names = ("a.jpg", "a.JPG", "a.png", "b.png", "c.png")
        for i, name in enumerate(names):
            shutil.copy(os.path.join(self.truth, "water", f"{i:04}.jpg"), os.path.join(work, name))
        scene = os.path.join(work, "scene.mvs")
        write(scene, with_paths(read(scene), lambda path: names[int(path[-8:-4])]))
        self.refused("a.mask.png", work, "--pinhole-export", "pinholes")


class Taken(Exports):
    """The export as input of a program for pinhole cameras: DensifyPointCloud without a housing."""

    def error_of(self, cloud):
        """Mean distance of the points to the true surface [mm], and the number of points."""
        report = self.evaluated("water", cloud, "--tolerance", "0.002", samples=10000)
        return 1000 * report["accuracy"]["mean"], cloud_size(read(cloud))

    def test_the_cloud_is_the_same(self):
        self.assertEqual(read(self.at("work", "pinholes", "scene.ply")),
                         read(self.at("work", "scene_dense.ply")))

    def test_fusing_the_depth_maps(self):
        folder = self.copy("work", "pinholes")
        maps = {name: data for name, data in contents(folder).items() if ".dmap" in name}
        self.assertEqual(len(maps), 2 * VIEWS)
        said = self.said(folder, "--fusion-mode", "-1")
        self.assertIn(f"{VIEWS} of {VIEWS} images have a depth map", said)
        self.assertEqual({n: d for n, d in contents(folder).items() if ".dmap" in n}, maps)
        error, points = self.error_of(os.path.join(folder, "scene_dense.ply"))
        refractive, refractive_points = self.error_of(self.at("work", "scene_dense.ply"))
        print(f"\nfused {error:.3f} mm, {points} points; refractive {refractive:.3f} mm, "
              f"{refractive_points}")
        # An exported depth interpolates three depths. The image has 0.8 times as many pixels.
        self.assertLess(error, 1.15 * refractive)
        self.assertGreater(points, 0.65 * refractive_points)

    def test_without_our_side_files(self):
        folder = self.copy("work", "pinholes", leave_out=("*.json",))
        said = self.said(folder, "--fusion-mode", "-1")
        self.assertIn(f"{VIEWS} by other programs", said)

    def test_matching_the_images_anew(self):
        folder = self.copy("work", "pinholes", leave_out=("*.dmap*",))
        self.said(folder)
        error, points = self.error_of(os.path.join(folder, "scene_dense.ply"))
        refractive, refractive_points = self.error_of(self.at("work", "scene_dense.ply"))
        # The photographs themselves, matched as if a pinhole camera had taken them.
        as_they_are = self.copy("work", leave_out=("depth*", "scene_dense*"))
        self.said(as_they_are, "--camera-model", "pinhole")
        ignored, _ = self.error_of(os.path.join(as_they_are, "scene_dense.ply"))
        print(f"\nrematched {error:.3f} mm, {points} points; refractive {refractive:.3f} mm, "
              f"{refractive_points}; photographs taken for a pinhole's {ignored:.3f} mm")
        self.assertLess(error, 1.3 * refractive)
        self.assertGreater(points, 0.65 * refractive_points)
        self.assertGreater(ignored, 4 * refractive)

    def test_masks_leave_out_what_the_photograph_does_not_show(self):
        folder = self.copy("work", "pinholes", leave_out=("*.dmap*",))
        said = self.said(folder, "--ignore-mask-label", "0")
        self.assertNotIn("no mask", said)
        self.assertGreater(cloud_size(read(os.path.join(folder, "scene_dense.ply"))), 10000)

    def test_poses_and_maps_agree_with_the_points_of_the_scene(self):
        """The simulated points, which do not depend on depth maps, have the depths of the maps."""
        folder = self.at("work", "pinholes")
        scene = Mvs(read(os.path.join(folder, "scene.mvs")))
        ratios, shown = [], 0
        for image in range(VIEWS):
            size = scene.camera(image)[0]
            rows = Dmap(read(os.path.join(folder, f"depth{image:04}.dmap"))).rows
            scale = len(rows[0]) / size[0], len(rows) / size[1]
            for point, views in scene.points:
                if image not in views:
                    continue
                # Points were observed in air, where the field of view is wider.
                u, v, z = scene.project(image, point)
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


if __name__ == "__main__":
    main()
