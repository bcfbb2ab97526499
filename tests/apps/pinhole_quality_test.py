# SPDX-License-Identifier: GPL-3.0-or-later
"""--pinhole-export: programs for pinhole cameras reach the quality of the refractive scene."""

import json
import os

from pinhole_scene import VIEWS, Exports, Reader, image_size, project
from programs import cloud_size, contents, depth_rows, main, read


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
        maps = {name: data for name, data in contents(folder).items() if ".dmap" in name}
        self.assertEqual(len(maps), 2 * VIEWS)
        said = self.succeeds(*self.command(folder, "--fusion-mode", "-1")).stdout
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


if __name__ == "__main__":
    main()
