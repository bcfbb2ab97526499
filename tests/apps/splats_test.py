# SPDX-License-Identifier: GPL-3.0-or-later
"""The COLMAP model of --pinhole-export, from which trainers of splats start: its files, its points against the
simulator's truth by a pinhole's projection, and restored colours."""

import json
import os
import re
import shutil
import struct
import subprocess
import unittest

from programs import files_below, main, must, png, read, write
from readers import ColmapModel, Mvs, png_rows, png_size, records, with_paths
from worlds import QUICK, Densified

RESTORED = (200, 90, 30)


class Trained(Densified):
    """The export work/pinholes of five views under water, and work/restored with pictures of one colour. The
    photographs are JPEGs whose names end in .tif: formats are recognised by contents, and an image is exported as
    PNG, which the tests can read, unless its name is that of a JPEG."""
    MEDIA = ("water",)

    @classmethod
    def make(cls, folder):
        super().make(folder)
        work = cls.at("work")
        for i in range(cls.VIEWS):
            shutil.copy(os.path.join(cls.truth, "water", f"{i:04}.jpg"), cls.at("water", f"{i:04}.tif"))
        shutil.copytree(cls.at("water"), work, ignore=shutil.ignore_patterns("depth*", "scene_dense*"))
        scene = os.path.join(work, "scene.mvs")
        write(scene, with_paths(read(scene), lambda path: os.path.basename(path).replace(".jpg", ".tif")))
        must("DensifyPointCloud", "-i", "scene.mvs", "-w", work, *QUICK, "--pinhole-export", "pinholes")
        cls.make_relative("work", "scene_dense.mvs")
        width, height = 320, 240
        for i in range(cls.VIEWS):  # of 8 and of 16 bits
            row = struct.pack(">3H", *(value << 8 | 77 for value in RESTORED)) if i % 2 else bytes(RESTORED)
            write(os.path.join(work, "restored", f"{i:04}.png"), png([row * width] * height, 2, 16 if i % 2 else 8))

    def export(self, *names):
        return self.at("work", "pinholes", *names)

    def model(self, folder=None):
        return ColmapModel(os.path.join(folder or self.export(), "colmap", "sparse", "0"))

    def labels(self, name):
        return png_rows(read(self.export("images", f"{name}.mask.png")))[0]


NAMES = [f"{i:04}.tif" for i in range(Trained.VIEWS)]


class Files(Trained):
    def test_lie_where_trainers_look(self):
        self.assertEqual(files_below(self.export("colmap")),
                         {f"sparse/0/{part}.bin" for part in ("cameras", "images", "points3D")}
                         | {f"{kind}/{name}.png" for kind in ("images", "masks") for name in NAMES})
        for name in NAMES:
            self.assertEqual(read(self.export("colmap", "images", f"{name}.png")),
                             read(self.export("images", f"{name}.png")))
        listed = json.loads(read(self.export("pinhole_export.json")))["files"]
        self.assertLess({f"colmap/{name}" for name in files_below(self.export("colmap"))}, set(listed))

    def test_masks_have_two_values(self):
        for name in NAMES:
            mask, channels = png_rows(read(self.export("colmap", "masks", f"{name}.png")))
            self.assertEqual(channels, 1)
            labels = self.labels(name)
            self.assertEqual({value for row in labels for value in row}, {0, 128, 255})
            self.assertEqual(mask, [bytes(255 if label else 0 for label in row) for row in labels])

    def test_references_hold(self):
        model = self.model()
        (key, (kind, width, height, _)), = model.cameras.items()
        self.assertEqual(kind, 1)  # PINHOLE
        self.assertEqual({key: image[3] for key, image in model.images.items()},
                         {i + 1: f"{name}.png" for i, name in enumerate(NAMES)})
        for _, _, camera, name, _ in model.images.values():
            self.assertEqual(camera, key)
            self.assertEqual(png_size(read(self.export("colmap", "images", name))), (width, height))
        found = [(image, i, seen[2]) for image, (*_, rows) in model.images.items() for i, seen in enumerate(rows)]
        self.assertEqual(sorted(found), sorted((image, i, key) for key, (*_, track) in model.points.items()
                                               for image, i in track))

    @unittest.skipUnless(shutil.which("colmap"), "COLMAP is not installed")
    def test_colmap_reads_the_model(self):
        ended = subprocess.run(["colmap", "model_analyzer", "--path", self.export("colmap", "sparse", "0")],
                               stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60, check=True)
        said = {key: int(value) for key, value in re.findall(r"([A-Z][a-zA-Z ]+): ([0-9]+)\s*$", ended.stdout, re.M)}
        model = self.model()
        seen = sum(len(image[4]) for image in model.images.values())
        self.assertEqual([said[key] for key in ("Cameras", "Registered images", "Points", "Observations")],
                         [1, self.VIEWS, len(model.points), seen])


def shown_points(scene, labels):
    """The projections of a scene's points where the labels of its images, rows by image, are not 0: pixels by the
    number of the image in COLMAP and the point."""
    shown = {}
    for point, views in scene.points:
        for image in views:
            u, v, _ = scene.project(image, point)
            x, y = round(u), round(v)
            if 0 <= x < len(labels[image][0]) and 0 <= y < len(labels[image]) and labels[image][y][x]:
                shown[image + 1, point] = u + 0.5, v + 0.5
    return shown


def observations(model):
    """The pixels of a model's observations, as shown_points()."""
    return {(image, model.points[key][0]): (x, y)
            for image, (*_, rows) in model.images.items() for x, y, key in rows}


class Points(Trained):
    def test_are_those_that_the_images_show(self):
        """Each observation is the projection of its point, and all points that a picture shows are there: a scene
        keeps the views of a point, and the labels tell where a picture shows the photograph."""
        model, scene = self.model(), Mvs(read(self.export("scene.mvs")))
        shown = shown_points(scene, [self.labels(name) for name in NAMES])
        self.assertLess(len(shown), sum(len(views) for _, views in scene.points))
        found = observations(model)
        self.assertEqual(set(found), set(shown))
        for (image, point), pixel in found.items():
            # The rounding of poses in double, as quaternions in the model, is far below 1e-6 px; another convention of
            # pixels or poses is far above.
            self.near(pixel, shown[image, point], 1e-6)
            self.near(pixel, model.project(image, point)[:2], 1e-6)

    def true_colors(self):
        """The colours of the true surface at the points, which the photographs in the simulator's clear water show."""
        lines = [line.split() for line in records(os.path.join(self.truth, "sparse", "points3D.txt"))]
        single = struct.Struct("<3f")  # as scenes keep places
        return {single.unpack(single.pack(*map(float, words[1:4]))): tuple(map(int, words[4:7])) for words in lines}

    def test_lie_where_the_images_show_their_colours(self):
        """The true points, projected by the pinholes, meet the true colours of the surface. Displaced by a half
        pixel, or with another focal length, they do not."""
        model, truth = self.model(), self.true_colors()
        pictures = {key: png_rows(read(self.export("colmap", "images", image[3])))[0]
                    for key, image in model.images.items()}

        def difference(shift=(0, 0), zoom=1.0):
            differences = []
            for key, (_, _, camera, _, rows) in model.images.items():
                _, width, height, (_, _, cx, cy) = model.cameras[camera]
                for _, _, point in rows[::2]:
                    place = model.points[point][0]
                    u, v, _ = model.project(key, place)
                    x, y = cx + zoom * (u - cx) + shift[0] - 0.5, cy + zoom * (v - cy) + shift[1] - 0.5
                    if 0 <= x < width - 1 and 0 <= y < height - 1:
                        color = interpolated(pictures[key], x, y)
                        differences += [abs(a - b) for a, b in zip(color, truth[place])]
            return sum(differences) / len(differences)

        least = difference()
        # Photographs average the texture over a pixel. Grey levels of two places of the surface differ by 25.
        self.assertLess(least, 10)
        # The same places and pictures are compared, so the rounding of colours, below 0.5 in each of them, leaves far
        # less in the mean than these margins. 1 % of the focal length is up to 1.6 px at the edge of 320.
        for shift in ((0.5, 0), (-0.5, 0), (0, 0.5), (0, -0.5)):
            self.assertGreater(difference(shift), least + 0.5, shift)
        for zoom in (0.99, 1.01):
            self.assertGreater(difference(zoom=zoom), least + 1, zoom)

    def test_have_the_colours_of_the_images(self):
        truth = self.true_colors()
        model = self.model()
        differences = [abs(a - b) for place, color, *_ in model.points.values() for a, b in zip(color, truth[place])]
        self.assertLess(sum(differences) / len(differences), 10)  # see above
        pictures = {key: png_rows(read(self.export("colmap", "images", image[3])))[0]
                    for key, image in model.images.items()}
        for place, color, _, track in list(model.points.values())[::10]:
            seen = []
            for image, i in track:
                x, y = (round(value - 0.5) for value in model.images[image][4][i][:2])
                seen.append(pictures[image][y][3 * x:3 * x + 3])
            self.near(color, [sum(values) / len(seen) for values in zip(*seen)], 0.51)  # rounded


def interpolated(rows, x, y):
    i, j = int(x), int(y)
    a, b = x - i, y - j
    at = lambda p, q: rows[q][3 * p:3 * p + 3]
    return [(p * (1 - a) + q * a) * (1 - b) + (r * (1 - a) + s * a) * b
            for p, q, r, s in zip(at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1))]


class Masked(Trained):
    """Masks that leave out the left half of the photographs. The pictures in place of the photographs are red there
    and green elsewhere, so that the colour of a pinhole's pixel tells which half of the photograph it shows."""

    def test_pixels_that_masks_leave_out_are_masked(self):
        self.folder = self.shared
        work = self.path("masked")
        self.addCleanup(shutil.rmtree, work, True)
        shutil.copytree(self.at("work"), work, ignore=shutil.ignore_patterns("pinholes", "other", "restored"))
        width, height = 320, 240
        for name in NAMES:
            number = name.removesuffix(".tif")
            write(os.path.join(work, "halves", f"{number}.png"),
                  png([bytes((200, 0, 0)) * (width // 2) + bytes((0, 200, 0)) * (width // 2)] * height, 2))
            write(os.path.join(work, "masks", f"{number}.png"),
                  png([bytes(width // 2) + bytes([1]) * (width // 2)] * height))
        self.said(work, *self.FUSE, "--mask-path", "masks", "--colors", "halves", "--estimate-colors", "0",
                  "--pinhole-export", "pinholes")
        export = os.path.join(work, "pinholes")
        masks = []
        for name in NAMES:
            rows = lambda *file: png_rows(read(os.path.join(export, *file)))[0]
            masks.append(rows("colmap", "masks", f"{name}.png"))
            colors, labels = rows("images", f"{name}.png"), rows("images", f"{name}.mask.png")
            wrong, counts = 0, {0: 0, 255: 0}
            for row, mask, label in zip(colors, masks[-1], labels, strict=True):
                for x, value in enumerate(mask):
                    red, green, _ = row[3 * x:3 * x + 3]
                    if label[x] and abs(red - green) > 20:  # else it is at the border of the halves
                        wrong += value != (255 if green > red else 0)
                        counts[value] += 1
                    elif not label[x]:
                        self.assertEqual(value, 0)
            self.assertEqual(wrong, 0)
            self.assertGreater(min(counts.values()), width * height // 4)
        model, scene = self.model(export), Mvs(read(os.path.join(export, "scene.mvs")))
        found = observations(model)
        self.assertEqual(set(found), set(shown_points(scene, masks)))
        self.assertLess(len(found), 0.8 * len(observations(self.model())))
        # Points at the border of the halves have mixed colours.
        self.assertGreater(sum(green > red for _, (red, green, _), *_ in model.points.values()),
                           0.98 * len(model.points))


class Restored(Trained):
    def setUp(self):
        super().setUp()
        self.folder = self.shared

    def test_colours_are_those_of_the_restored_photographs(self):
        said = self.said(self.at("work"), "--pinhole-export", "other", "--colors", "restored", "--estimate-colors", "0",
                         "-o", "other.mvs")
        other = self.at("work", "other")
        self.assertNotIn("--colors", said)  # it has an effect
        # The restored photographs replace colours alone.
        for file in ("depth0000.dmap", "scene.mvs", *(f"images/{name}.mask.png" for name in NAMES),
                     *(f"colmap/masks/{name}.png" for name in NAMES)):
            self.assertEqual(read(os.path.join(other, file)), read(self.export(file)), file)
        for name in NAMES:
            rows, _ = png_rows(read(os.path.join(other, "images", f"{name}.png")))
            for row, labels in zip(rows, self.labels(name), strict=True):
                for x, label in enumerate(labels):
                    # Towards its border, a picture may be mixed with the black around it.
                    if all(labels[max(x - 3, 0):x + 4]) and label == 255:
                        self.assertEqual(tuple(row[3 * x:3 * x + 3]), RESTORED)
        model = self.model(other)
        colors = [color for _, color, *_ in model.points.values()]
        # Near the border of a picture, a colour may be mixed with black: at most the 3 px above of 160 on each side.
        self.assertGreater(colors.count(RESTORED), 0.98 * len(colors))
        self.assertEqual({key: point[0] for key, point in model.points.items()},
                         {key: point[0] for key, point in self.model().points.items()})

    def test_their_folder_is_an_input(self):
        write(self.at("work", "restored", "pinhole_export.json"), "{}\n")  # as in an export
        self.refuses("contains inputs", *self.command(self.at("work"), "--pinhole-export", "restored", "--colors",
                                                      "restored"))
        os.remove(self.at("work", "restored", "pinhole_export.json"))


if __name__ == "__main__":
    main()
