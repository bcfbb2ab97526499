# SPDX-License-Identifier: GPL-3.0-or-later
"""--pinhole-export: which files are written, replaced and kept, and which exports are refused."""

import json
import os
import re
import shutil
import struct

from pinhole_scene import VIEWS, Exports, Reader, image_size
from programs import contents, files_below, main, read, run, write


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
        self.assertEqual(contents(self.export(work, "--max-threads", "1")),
                         {name: data.replace(self.at("work").encode(), work.encode())
                          for name, data in contents(self.at("work", "pinholes")).items()})

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
        found = contents(os.path.join(work, "pinholes"))
        self.assertEqual(found.pop("scene_mesh.ply"), b"mine\n")
        self.assertEqual(found["scene.ply"], read(self.at("work", "scene_dense.ply")))
        self.assertEqual(set(found), files_below(self.at("work", "pinholes")))

    def test_what_an_earlier_export_alone_had_goes(self):
        work = self.copy("work")
        offset = '{ "version": 1, "geo_offset": [534000, 3378500, 30] }\n'
        write(os.path.join(work, "scene.geo.json"), offset)
        folder = self.export(work, "--fusion-mode", "-1")
        first = contents(folder)
        self.assertIn("scene.geo.json", first)
        write(os.path.join(folder, "images", "notes.txt"), "mine\n")
        write(os.path.join(folder, "depth0009.dmap"), "of another program\n")
        write(os.path.join(folder, "depth0003.dmap"), "of another program\n")
        os.remove(os.path.join(work, "scene.geo.json"))
        for name in ("depth0001.dmap", "depth0003.dmap"):
            os.remove(os.path.join(work, name))
            os.remove(os.path.join(work, name + ".json"))

        command = self.command(work, "--pinhole-export", "pinholes", "--fusion-mode", "-1")
        before = contents(folder)
        self.assertEqual(run(*command, file_size_limit=20000).returncode, 1)
        self.assertEqual(contents(folder), before)  # the earlier export survives
        said = self.succeeds(*command).stdout
        self.assertEqual(said.count("depth0003.dmap: was changed after the earlier export"), 1)
        found = contents(folder)
        self.assertEqual(found.pop("images/notes.txt"), b"mine\n")
        for name in ("depth0009.dmap", "depth0003.dmap"):
            self.assertEqual(found.pop(name), b"of another program\n")
        shutil.rmtree(folder)
        self.assertEqual(found, contents(self.export(work, "--fusion-mode", "-1")))
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
        before = contents(folder)
        self.refuses(expected, *self.command(folder, *arguments))
        self.assertEqual(contents(folder), before)

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
        before = contents(work)
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
